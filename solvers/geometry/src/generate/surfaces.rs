//! Names that the generated meshes give to the parts of their surfaces.

/// Of a box: its faces by axis and side.
pub const BOX: [&str; 6] = ["x-min", "x-max", "y-min", "y-max", "z-min", "z-max"];

/// Of a cylinder.
pub const CYLINDER: [&str; 3] = ["side", "bottom", "top"];

/// Of a ball and what is mapped from it, such as the kidney.
pub const BALL: [&str; 1] = ["surface"];

/// Further ones of half a kidney: the cut z = 0.
pub const HALF: [&str; 1] = ["symmetry"];

/// Of a sphere shell.
pub const SHELL: [&str; 2] = ["inner", "outer"];

/// Further ones of one octant of a shell: the cuts x = 0, y = 0 and z = 0.
pub const OCTANT: [&str; 3] = ["x-min", "y-min", "z-min"];
