//! Boxes for dynamics, with their tables.

use fem::VolumeRule;
use geometry::generate::box_mesh;
use geometry::{CellKind, Mesh};
use material::Law;
use shape::VolumeRows;
use shape::{Curve, FixedDof, Point3, Vector3};
use statics::{
    Active, Curves, Inertia, LinearSystems, Mass, NewtonParams, Solid, SolidDilation, StaticProblem,
    TimeParams, TimeProblem,
};

/// A box with its tables.
pub struct Cuboid {
    /// The mesh.
    pub mesh: Mesh,
    /// Standard quadrature of the mesh.
    pub volume: VolumeRows,
}

impl Cuboid {
    /// Builds a box from the origin to `max`, in metres.
    pub fn new(kind: CellKind, max: [f64; 3], cells: [usize; 3]) -> Cuboid {
        let mesh = box_mesh(kind, Point3::origin(), Point3::from(max), cells, [1.0; 3], None).unwrap();
        let volume = fem::volume_rows(&mesh, &VolumeRule::STANDARD).unwrap();
        Cuboid { mesh, volume }
    }

    /// Reference positions, m.
    pub fn nodes(&self) -> &[Point3] {
        self.mesh.points()
    }

    /// Returns the exactly integrated consistent mass; `density` in kg/m^3.
    pub fn consistent(&self, density: f64) -> Mass {
        let fine = fem::volume_rows(&self.mesh, &VolumeRule::FINE).unwrap();
        Mass::consistent(&fine, &[density], &[]).unwrap()
    }

    /// Returns the row-sum lumped mass; `density` in kg/m^3.
    pub fn lumped(&self, density: f64) -> Mass {
        let mut nodal = vec![0.0; self.nodes().len()];
        for (q, w) in self.volume.weights().iter().enumerate() {
            let (nodes, values) = self.volume.rows().row(q);
            nodes.iter().zip(values).for_each(|(&i, n)| nodal[i as usize] += w * density * n);
        }
        Mass::lumped(&nodal).unwrap()
    }

    /// Prescribes the degrees of freedom for which `value` returns a displacement, m.
    pub fn constrained(&self, value: impl Fn(&Point3, usize) -> Option<f64>) -> Vec<FixedDof> {
        (0..self.nodes().len())
            .flat_map(|i| (0..3).map(move |axis| (i, axis)))
            .filter_map(|(i, axis)| {
                let value = value(&self.nodes()[i], axis)?;
                Some(FixedDof { node: i as u32, axis: axis as u8, value })
            })
            .collect()
    }

    /// Returns a field at the nodes.
    pub fn field(&self, value: impl Fn(&Point3) -> Vector3) -> Vec<Vector3> {
        self.nodes().iter().map(value).collect()
    }

    /// Returns a problem with these laws, without loads and tools.
    pub fn body<'a>(&'a self, laws: &'a [Law], fixed: &'a [FixedDof]) -> StaticProblem<'a> {
        let solid = Solid {
            volume: &self.volume,
            laws,
            region: &[],
            axes: &[],
            active: Active::default(),
            dilation: SolidDilation::Standard,
        };
        StaticProblem {
            nodes: self.nodes(),
            solid,
            loads: &[],
            following: &[],
            fixed,
            penalties: &[],
            contact: None,
            tools: &[],
            curves: Curves::all(Curve::at_once()),
            systems: LinearSystems::Factored,
        }
    }
}

/// Returns a dynamic problem without damping and relaxation.
pub fn moving<'a>(
    body: &'a StaticProblem<'a>,
    mass: &'a Mass,
    displacement: &'a [Vector3],
    velocity: &'a [Vector3],
) -> TimeProblem<'a> {
    let inertia = Some(Inertia { mass, damping: 0.0, stiffness_damping: 0.0, displacement, velocity });
    TimeProblem { body, inertia, relaxation: &[] }
}

/// Returns parameters for equal steps without error control.
pub fn params(end: f64, steps: usize, rho_inf: f64) -> TimeParams {
    TimeParams {
        end,
        steps,
        smallest: 1e-3,
        accuracy: None,
        rho_inf,
        alpha: None,
        newton: NewtonParams {
            tolerance: 1e-11,
            iterations: 20,
            chords: true,
            keeps: f64::INFINITY,
            loosest: Some(NewtonParams::LOOSEST),
        },
        augmentations: 0,
    }
}

/// Returns the length of the longest vector.
pub fn largest(v: &[Vector3]) -> f64 {
    v.iter().map(Vector3::norm).fold(0.0, f64::max)
}

/// Returns the largest distance between two fields.
pub fn distance(a: &[Vector3], b: &[Vector3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}
