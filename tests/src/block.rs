//! A jittered box with its tables, and affine fields on the box.

use fem::{SurfaceRule, VolumeRule};
use geometry::generate::{Jitter, box_mesh};
use geometry::{CellKind, Facet, Mesh};
use material::LinearElastic;
use shape::{FixedDof, Matrix3, Point3, Vector3};
use shape::{FluxRows, SurfaceRows, VolumeRows};
use statics::LinearBody;

/// Facet groups of a box.
pub const SIDES: [&str; 6] = ["x-min", "x-max", "y-min", "y-max", "z-min", "z-max"];

/// A jittered box with its tables.
pub struct Block {
    /// The mesh.
    pub mesh: Mesh,
    /// Standard quadrature of the mesh.
    pub volume: VolumeRows,
}

impl Block {
    /// Builds a jittered box of 40 x 30 x 20 mm.
    pub fn new(kind: CellKind, cells: [usize; 3]) -> Block {
        let jitter = Some(Jitter { fraction: 0.2, seed: 7 });
        let max = Point3::new(0.04, 0.03, 0.02);
        let mesh = box_mesh(kind, Point3::origin(), max, cells, [1.0; 3], jitter).unwrap();
        let volume = fem::volume_rows(&mesh, &VolumeRule::STANDARD).unwrap();
        Block { mesh, volume }
    }

    /// Returns a body with these laws, without projection.
    pub fn body<'a>(&'a self, materials: &'a [LinearElastic]) -> LinearBody<'a> {
        LinearBody { nodes: self.mesh.points(), volume: &self.volume, materials, region: &[], dilation: None }
    }

    /// Returns the facets of some sides.
    pub fn facets(&self, sides: &[&str]) -> Vec<Facet> {
        sides.iter().flat_map(|s| self.mesh.group(s).unwrap().to_vec()).collect()
    }

    /// Returns the surface quadrature of some sides.
    pub fn surface(&self, sides: &[&str]) -> SurfaceRows {
        fem::surface_rows(&self.mesh, &self.facets(sides), &SurfaceRule::STANDARD).unwrap()
    }

    /// Returns shape values and gradients on some sides.
    pub fn flux(&self, sides: &[&str]) -> FluxRows {
        fem::flux_rows(&self.mesh, &self.facets(sides), &SurfaceRule::STANDARD).unwrap()
    }

    /// Returns the nodes on some sides.
    pub fn nodes_of(&self, sides: &[&str]) -> Vec<u32> {
        self.mesh.facet_group_nodes(&self.facets(sides))
    }

    /// Prescribes `field` (m) along all three axes at the nodes on `sides`.
    pub fn fix(&self, sides: &[&str], field: impl Fn(&Point3) -> Vector3) -> Vec<FixedDof> {
        self.nodes_of(sides)
            .into_iter()
            .flat_map(|node| {
                let u = field(&self.mesh.points()[node as usize]);
                (0..3).map(move |axis| FixedDof { node, axis, value: u[axis as usize] })
            })
            .collect()
    }

    /// Returns the largest distance between `u` and `field` over the nodes, relative to the field's largest
    /// value.
    pub fn error(&self, u: &[Vector3], field: impl Fn(&Point3) -> Vector3) -> f64 {
        let exact: Vec<Vector3> = self.mesh.points().iter().map(field).collect();
        let largest = exact.iter().map(Vector3::norm).fold(0.0, f64::max);
        u.iter().zip(&exact).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest
    }
}

/// Soft tissue: E = 20 kPa, nu = 0.3.
pub fn soft() -> LinearElastic {
    LinearElastic::new(20e3, 0.3).unwrap()
}

/// Returns a displacement gradient without special properties.
pub fn gradient() -> Matrix3 {
    Matrix3::new(0.02, -0.01, 0.004, 0.007, -0.015, 0.011, -0.003, 0.006, 0.01)
}

/// The affine field of [`gradient`], with a translation, m.
pub fn affine(x: &Point3) -> Vector3 {
    gradient() * x.coords + Vector3::new(1e-4, -2e-4, 3e-4)
}
