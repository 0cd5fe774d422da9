//! The forms of weak supports against one another and against the traction of an affine field. A solution
//! would not show a wrong right-hand side, because refinement by the residual corrects it.

use algebra::{BlockPattern, Stiffness};
use fem::{SurfaceRule, VolumeRule};
use geometry::generate::{Jitter, box_mesh};
use geometry::{CellKind, Mesh};
use material::LinearElastic;
use shape::{DilationGroups, FluxRows, Matrix3, Point3, TraceRows, Vector3, VolumeRows};

use super::{Weak, WeakSupport, WeakTable};
use crate::body::LinearBody;
use crate::dilation::Projected;

struct Block {
    mesh: Mesh,
    volume: VolumeRows,
    flux: FluxRows,
    laws: [LinearElastic; 1],
}

impl Block {
    fn new() -> Block {
        let jitter = Some(Jitter { fraction: 0.2, seed: 3 });
        let max = Point3::new(0.04, 0.03, 0.02);
        let mesh = box_mesh(CellKind::Tet4, Point3::origin(), max, [3, 2, 2], [1.0; 3], jitter).unwrap();
        let volume = fem::volume_rows(&mesh, &VolumeRule::STANDARD).unwrap();
        let facets: Vec<_> =
            ["x-min", "z-max"].iter().flat_map(|s| mesh.group(s).unwrap().to_vec()).collect();
        let flux = fem::flux_rows(&mesh, &facets, &SurfaceRule::STANDARD).unwrap();
        Block { mesh, volume, flux, laws: [LinearElastic::new(20e3, 0.4).unwrap()] }
    }

    fn body<'a>(&'a self, dilation: Option<&'a DilationGroups>) -> LinearBody<'a> {
        let nodes = self.mesh.points();
        LinearBody { nodes, volume: &self.volume, materials: &self.laws, region: &[], dilation }
    }

    fn support<'a>(&'a self, axes: [bool; 3], method: Weak, trace: Option<&'a TraceRows>) -> WeakSupport<'a> {
        let values = self.flux.points().iter().map(affine).collect();
        WeakSupport { flux: &self.flux, axes, values, region: &[], method, h: 0.01, trace }
    }

    /// A trace built from the volume points in turn, two for each surface point.
    fn trace(&self) -> TraceRows {
        let (count, points) = (self.volume.weights().len(), self.flux.weights().len());
        let of = (0..2 * points).map(|k| (7 * k % count) as u32).collect();
        let coefficients = [0.25, 0.75].repeat(points);
        let offsets = (0..=points).map(|q| 2 * q).collect();
        TraceRows::new(count, offsets, of, coefficients, vec![0.004; points]).unwrap()
    }
}

fn gradient() -> Matrix3 {
    Matrix3::new(0.02, -0.01, 0.004, 0.007, -0.015, 0.011, -0.003, 0.006, 0.01)
}

fn affine(x: &Point3) -> Vector3 {
    gradient() * x.coords + Vector3::new(1e-4, -2e-4, 3e-4)
}

/// Returns `K u - factor f` from the matrix and the right-hand side of a table.
fn assembled(table: &WeakTable, u: &[Vector3], factor: f64) -> Vec<Vector3> {
    let of = table.incidence(u.len());
    let mut stiffness = Stiffness::zeros(BlockPattern::new(u.len(), &[(table.connectivity(), &of)]));
    table.add_stiffness(&mut stiffness, &of);
    let mut force = vec![Vector3::zeros(); u.len()];
    table.add_force(&of, &mut force);
    stiffness.multiply(u).iter().zip(&force).map(|(ku, f)| ku - f * factor).collect()
}

/// Returns the largest difference relative to the largest vector of `b`.
fn apart(a: &[Vector3], b: &[Vector3]) -> f64 {
    let largest = b.iter().fold(0.0f64, |l, b| l.max(b.norm()));
    a.iter().zip(b).fold(0.0f64, |l, (a, b)| l.max((a - b).norm())) / largest
}

fn nodal(mesh: &Mesh, of: impl Fn(&Point3) -> Vector3) -> Vec<Vector3> {
    mesh.points().iter().map(of).collect()
}

/// The residual is summed separately, from differences. It must equal the residual of the matrix and the
/// right-hand side.
#[test]
fn matrix_and_right_hand_side_make_the_residual() {
    let block = Block::new();
    let trace = block.trace();
    let groups = DilationGroups::nodal(&block.volume).unwrap();
    let u = nodal(&block.mesh, |x| affine(x) + Vector3::new(x.y * x.z, x.x * x.x, -x.x * x.y) * 0.3);
    let (nitsche, penalty) = (Weak::Nitsche { gamma: 8.0 }, Weak::Penalty { factor: 50.0 });
    let cases = [(nitsche, None, None), (nitsche, Some(&trace), Some(&groups)), (penalty, None, None)];
    for (method, trace, dilation) in cases {
        for axes in [[true; 3], [true, false, true]] {
            let body = block.body(dilation);
            let projected = Projected::new(&body, trace.iter().flat_map(|t| t.points().iter().copied()));
            let table = WeakTable::new(&block.support(axes, method, trace), &body, projected.as_ref());
            let mut residual = vec![Vector3::zeros(); u.len()];
            table.subtract_residual(&table.incidence(u.len()), &u, 0.7, &mut residual);
            let residual: Vec<Vector3> = residual.iter().map(|r| -r).collect();
            let off = apart(&assembled(&table, &u, 0.7), &residual);
            assert!(off < 1e-12, "{method:?} {axes:?}: {off:e}");
        }
    }
}

/// If the displacement equals the prescribed displacement, only the work of the exact traction remains of the
/// forms.
#[test]
fn the_prescribed_field_leaves_its_traction() {
    let block = Block::new();
    let body = block.body(None);
    let u = nodal(&block.mesh, affine);
    let stress = block.laws[0].stress(&gradient());
    for axes in [[true; 3], [false, true, true]] {
        let mut traction = vec![Vector3::zeros(); u.len()];
        for (q, n) in block.flux.normals().iter().enumerate() {
            let held = (stress * n).component_mul(&Vector3::from_fn(|a, _| f64::from(u8::from(axes[a]))));
            let (nodes, values) = block.flux.at().rows().row(q);
            for (&i, value) in nodes.iter().zip(values) {
                traction[i as usize] -= held * (value * block.flux.weights()[q]);
            }
        }
        let table = WeakTable::new(&block.support(axes, Weak::Nitsche { gamma: 8.0 }, None), &body, None);
        let off = apart(&assembled(&table, &u, 1.0), &traction);
        assert!(off < 1e-12, "{axes:?}: {off:e}");
    }
}

/// If the consistency terms are added back, only the stabilisation remains, equal to a penalty with the same
/// `beta`.
#[test]
fn consistency_is_all_that_parts_nitsche_from_a_penalty() {
    let block = Block::new();
    let body = block.body(None);
    let u = nodal(&block.mesh, |x| affine(x) * (1.0 + 40.0 * x.y));
    let law = &block.laws[0];
    let factor = 8.0 * (law.lambda() + 2.0 * law.mu()) / law.young();
    let forces = |method| {
        let table = WeakTable::new(&block.support([true, true, false], method, None), &body, None);
        let mut force = assembled(&table, &u, 0.0);
        table.add_consistency(&table.incidence(u.len()), &u, &mut force);
        force
    };
    let off = apart(&forces(Weak::Nitsche { gamma: 8.0 }), &forces(Weak::Penalty { factor }));
    assert!(off < 1e-12, "{off:e}");
}
