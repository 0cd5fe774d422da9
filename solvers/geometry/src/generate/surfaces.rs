//! Names of the facet groups of the generated meshes.

/// Facet groups of a box: its faces by axis and side.
pub const BOX: [&str; 6] = ["x-min", "x-max", "y-min", "y-max", "z-min", "z-max"];

/// Facet groups of a cylinder: the curved side, and the faces z = 0 and z = height.
pub const CYLINDER: [&str; 3] = ["side", "bottom", "top"];

/// Facet groups of a ball and of bodies mapped from a ball, such as the kidney: the curved surface.
pub const BALL: [&str; 1] = ["surface"];

/// Additional facet groups of half a kidney: the cut z = 0.
pub const HALF: [&str; 1] = ["symmetry"];

/// Facet groups of a ventricle: the cut, and the inner and the outer wall.
pub const VENTRICLE: [&str; 3] = ["base", "inner", "outer"];

/// Facet groups of a sphere shell: the inner and the outer sphere.
pub const SHELL: [&str; 2] = ["inner", "outer"];

/// Additional facet groups of one octant of a shell: the cuts x = 0, y = 0 and z = 0.
pub const OCTANT: [&str; 3] = ["x-min", "y-min", "z-min"];
