//! Meshes with all their projections, every law, and static solutions that must reach the full load.

use fem::VolumeRule;
use geometry::generate::{Jitter, box_mesh};
use geometry::{CellKind, Facet, Mesh};
use material::Law;
use shape::{DilationGroups, HourglassModulus, Rows, VolumeRows};
use shape::{FixedDof, Point3, Vector3};
use statics::{
    Active, Curves, LinearSystems, NewtonParams, Solid, SolidDilation, StaticParams, StaticPath,
    StaticProblem, solve_static,
};

/// Treatment of the volume change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// No projection.
    Standard,
    /// One dilation for each element.
    Element,
    /// One dilation for each node.
    Nodal,
    /// A pressure field of its own.
    Mixed,
    /// One point for each element, hence one dilation, and hourglass control.
    OnePoint,
}

/// A mesh with the tables of one method.
pub struct Model {
    /// The mesh.
    pub mesh: Mesh,
    /// Quadrature of the method.
    pub volume: VolumeRows,
    groups: Option<DilationGroups>,
    pressure: Option<Rows>,
}

/// All methods: standard elements, and the remedies for volumetric locking with their elements.
pub const METHODS: [(CellKind, Projection); 9] = [
    (CellKind::Tet4, Projection::Standard),
    (CellKind::Tet10, Projection::Standard),
    (CellKind::Hex8, Projection::Standard),
    (CellKind::Hex20, Projection::Standard),
    (CellKind::Hex8, Projection::Element),
    (CellKind::Tet10, Projection::Element),
    (CellKind::Tet4, Projection::Nodal),
    (CellKind::Tet10, Projection::Mixed),
    (CellKind::Hex8, Projection::OnePoint),
];

impl Model {
    /// Builds the tables of a projection.
    pub fn new(mesh: Mesh, projection: Projection) -> Model {
        let rule = VolumeRule::STANDARD;
        let volume = match projection {
            Projection::OnePoint => fem::uniform_rows(&mesh, 0.05, HourglassModulus::PWave).unwrap(),
            _ => fem::volume_rows(&mesh, &rule).unwrap(),
        };
        let groups = match projection {
            Projection::Element => Some(fem::element_dilation(&mesh, &rule).unwrap()),
            Projection::Nodal => Some(DilationGroups::nodal(&volume).unwrap()),
            _ => None,
        };
        let pressure =
            (projection == Projection::Mixed).then(|| fem::pressure_rows(&mesh, &rule, &[]).unwrap());
        Model { mesh, volume, groups, pressure }
    }

    /// Builds a box of 40 x 30 x 20 mm, with inner nodes shifted by up to 0.2 of their spacing.
    pub fn block((kind, projection): (CellKind, Projection), cells: [usize; 3]) -> Model {
        let jitter = Some(Jitter { fraction: 0.2, seed: 7 });
        Model::new(box_mesh(kind, Point3::origin(), SIZE, cells, [1.0; 3], jitter).unwrap(), projection)
    }

    /// Returns the projection in the form of a solid.
    pub fn dilation(&self) -> SolidDilation<'_> {
        match (&self.groups, &self.pressure) {
            (Some(groups), _) => SolidDilation::Groups(groups),
            (_, Some(rows)) => SolidDilation::Mixed(rows),
            _ => SolidDilation::Standard,
        }
    }

    /// Returns a problem with one law, without loads, supports and tools.
    pub fn problem<'a>(&'a self, law: &'a Law) -> StaticProblem<'a> {
        StaticProblem {
            nodes: self.mesh.points(),
            solid: Solid {
                volume: &self.volume,
                laws: std::slice::from_ref(law),
                region: &[],
                axes: &[],
                active: Active::default(),
                dilation: self.dilation(),
            },
            loads: &[],
            following: &[],
            fixed: &[],
            penalties: &[],
            contact: None,
            tools: &[],
            curves: Curves::proportional(),
            systems: LinearSystems::Factored,
        }
    }

    /// Returns the facets of some sides.
    pub fn facets(&self, sides: &[&str]) -> Vec<Facet> {
        sides.iter().flat_map(|s| self.mesh.group(s).unwrap().to_vec()).collect()
    }

    /// Prescribes the `axes` of the nodes on some sides by a displacement field, m.
    pub fn hold(&self, sides: &[&str], axes: &[u8], field: impl Fn(&Point3) -> Vector3) -> Vec<FixedDof> {
        (self.mesh.facet_group_nodes(&self.facets(sides)).into_iter())
            .flat_map(|node| {
                let u = field(&self.mesh.points()[node as usize]);
                axes.iter().map(move |&axis| FixedDof { node, axis, value: u[axis as usize] })
            })
            .collect()
    }

    /// Constrains the normal displacement on the three planes x, y, z = 0.
    pub fn walls(&self) -> Vec<FixedDof> {
        ["x-min", "y-min", "z-min"]
            .iter()
            .zip(0..)
            .flat_map(|(side, axis)| self.hold(&[side], &[axis], |_| Vector3::zeros()))
            .collect()
    }

    /// Returns the largest distance between `u` and a field over the nodes, relative to the field's largest
    /// value.
    pub fn error(&self, u: &[Vector3], field: impl Fn(&Point3) -> Vector3) -> f64 {
        let exact: Vec<Vector3> = self.mesh.points().iter().map(field).collect();
        let largest = exact.iter().map(Vector3::norm).fold(0.0, f64::max);
        u.iter().zip(&exact).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest
    }
}

/// Far corner of [`Model::block`], m.
pub const SIZE: Point3 = Point3::new(0.04, 0.03, 0.02);
/// Facet groups of a box.
pub const ALL_SIDES: [&str; 6] = ["x-min", "x-max", "y-min", "y-max", "z-min", "z-max"];
/// Young's modulus, Pa.
pub const YOUNG: f64 = 20e3;

/// Returns every law, with the same small-strain limit.
pub fn laws(young: f64, poisson: f64) -> Vec<Law> {
    Law::all(young, poisson).unwrap()
}

/// Returns parameters for equal steps with a relative residual of 1e-11.
pub fn steps(steps: usize) -> StaticParams {
    StaticParams {
        steps,
        smallest: 1.0 / 64.0,
        newton: NewtonParams {
            tolerance: 1e-11,
            iterations: 30,
            chords: true,
            keeps: f64::INFINITY,
            loosest: Some(NewtonParams::LOOSEST),
        },
        augmentations: 0,
        limit_within: None,
    }
}

/// Solves up to the full load, or panics with the failure.
pub fn solve(name: &str, problem: &StaticProblem, params: &StaticParams) -> StaticPath {
    let path = solve_static(problem, params, |_, _| {}).unwrap_or_else(|e| panic!("{name}: {e}"));
    if let Some(failure) = &path.failure {
        panic!("{name}: {failure}");
    }
    path
}
