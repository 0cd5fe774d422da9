//! Boxes of tetrahedra, pressed from above and constrained below.
#![allow(dead_code)] // each bench uses its own part

use fem::{SurfaceRule, VolumeRule};
use geometry::generate::{Jitter, box_mesh};
use geometry::{CellKind, Mesh};
use material::LinearElastic;
use shape::{DilationGroups, SurfaceRows, VolumeRows};
use shape::{FixedDof, Point3};
use tissuebench_statics::{LinearBody, LinearProblem, Load};

pub struct Pressed {
    pub mesh: Mesh,
    pub volume: VolumeRows,
    pub top: SurfaceRows,
    pub fixed: Vec<FixedDof>,
    pub nodal: DilationGroups,
    pub material: [LinearElastic; 1],
}

impl Pressed {
    /// A cube of n^3 cells of six tet4, with `3 (n + 1)^3` degrees of freedom, `3 (n + 1)^2` of them
    /// constrained.
    pub fn new(n: usize) -> Pressed {
        Pressed::of(CellKind::Tet4, n)
    }

    /// The same cube with cells of another kind.
    pub fn of(kind: CellKind, n: usize) -> Pressed {
        let jitter = Some(Jitter { fraction: 0.1, seed: 1 });
        let max = Point3::new(0.04, 0.04, 0.04);
        let mesh = box_mesh(kind, Point3::origin(), max, [n; 3], [1.0; 3], jitter).unwrap();
        let volume = fem::volume_rows(&mesh, &VolumeRule::STANDARD).unwrap();
        let top = fem::surface_rows(&mesh, mesh.group("z-max").unwrap(), &SurfaceRule::STANDARD).unwrap();
        let constrained = mesh.facet_group_nodes(mesh.group("z-min").unwrap());
        let fixed = constrained
            .iter()
            .flat_map(|&node| (0..3).map(move |axis| FixedDof { node, axis, value: 0.0 }))
            .collect();
        let nodal = DilationGroups::nodal(&volume).unwrap();
        Pressed { mesh, volume, top, fixed, nodal, material: [LinearElastic::new(20e3, 0.495).unwrap()] }
    }

    pub fn body(&self, projected: bool) -> LinearBody<'_> {
        let dilation = projected.then_some(&self.nodal);
        LinearBody {
            nodes: self.mesh.points(),
            volume: &self.volume,
            materials: &self.material,
            region: &[],
            dilation,
        }
    }

    pub fn loads(&self) -> [Load<'_>; 1] {
        [Load::Pressure { surface: &self.top, values: vec![2e3; self.top.weights().len()] }]
    }

    pub fn problem<'a>(&'a self, loads: &'a [Load<'a>], projected: bool) -> LinearProblem<'a> {
        LinearProblem { body: self.body(projected), loads, fixed: &self.fixed, constraints: &[], weak: &[] }
    }
}
