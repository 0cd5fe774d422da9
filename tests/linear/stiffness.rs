//! The assembled matrix: definition, rigid modes, energy, and reproducible bits.

use algebra::Stiffness;
use fem::VolumeRule;
use geometry::CellKind;
use integration::block::{Block, SIDES, affine, soft};
use material::LinearElastic;
use nalgebra::DMatrix;
use proptest::prelude::*;
use shape::DilationGroups;
use shape::{FixedDof, Matrix3, Vector3};
use statics::{LinearBody, LinearProblem, Load, Weak, WeakSupport, assemble, strain_energy};

fn matrix(body: &LinearBody) -> Stiffness {
    let nodes = body.nodes.len() as u32;
    let fixed: Vec<_> =
        (0..nodes).flat_map(|node| (0..3).map(move |axis| FixedDof { node, axis, value: 0.0 })).collect();
    let problem = LinearProblem { body: *body, loads: &[], fixed: &fixed, constraints: &[], weak: &[] };
    assemble(&problem).unwrap().stiffness().clone()
}

fn dense(k: &Stiffness) -> DMatrix<f64> {
    let n = k.pattern().node_count();
    let mut out = DMatrix::zeros(3 * n, 3 * n);
    for i in 0..n {
        let (columns, blocks) = k.row(i);
        for (&j, block) in columns.iter().zip(blocks) {
            let j = j as usize;
            out.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(block);
            out.fixed_view_mut::<3, 3>(3 * j, 3 * i).copy_from(&block.transpose());
        }
    }
    out
}

/// Computes `B^T C B` with 6-vectors of strain, independently of the assembly.
fn voigt(body: &LinearBody) -> DMatrix<f64> {
    let n = body.nodes.len();
    let mut k = DMatrix::zeros(3 * n, 3 * n);
    for q in 0..body.volume.weights().len() {
        let law = body.material(q);
        let mut c = DMatrix::<f64>::zeros(6, 6);
        for i in 0..3 {
            for j in 0..3 {
                c[(i, j)] = law.lambda();
            }
            c[(i, i)] += 2.0 * law.mu();
            c[(3 + i, 3 + i)] = law.mu();
        }
        let (nodes, grads) = body.volume.row(q);
        let mut b = DMatrix::<f64>::zeros(6, 3 * n);
        for (&node, g) in nodes.iter().zip(grads) {
            let at = 3 * node as usize;
            for a in 0..3 {
                b[(a, at + a)] += g[a];
                let (x, y) = ((a + 1) % 3, (a + 2) % 3);
                b[(3 + a, at + x)] += g[y];
                b[(3 + a, at + y)] += g[x];
            }
        }
        k += b.transpose() * c * b * body.volume.weights()[q];
    }
    k
}

#[test]
fn equals_the_textbook_matrix_with_two_regions() {
    for kind in CellKind::ALL {
        let block = Block::new(kind, [2, 2, 1]);
        let materials = [soft(), LinearElastic::new(3e6, 0.45).unwrap()];
        let region: Vec<u16> = block.volume.points().iter().map(|x| u16::from(x.y > 0.015)).collect();
        let body = LinearBody { region: &region, ..block.body(&materials) };
        let ours = dense(&matrix(&body));
        let theirs = voigt(&body);
        assert!((&ours - &theirs).norm() < 1e-13 * theirs.norm(), "{}", kind.name());
    }
}

#[test]
fn assembly_is_the_weak_form_with_every_projection() {
    for kind in CellKind::ALL {
        let block = Block::new(kind, [2, 2, 1]);
        let materials = [soft(), LinearElastic::new(3e6, 0.45).unwrap()];
        let region: Vec<u16> = block.volume.points().iter().map(|x| u16::from(x.y > 0.015)).collect();
        let element = fem::element_dilation(&block.mesh, &VolumeRule::STANDARD).unwrap();
        let nodal = match kind {
            CellKind::Tet4 => Some(DilationGroups::nodal(&block.volume).unwrap()),
            _ => None,
        };
        for dilation in [None, Some(&element), nodal.as_ref()] {
            let body = LinearBody { region: &region, dilation, ..block.body(&materials) };
            let fast = dense(&matrix(&body));
            let plain = statics::plain::stiffness(&body);
            assert!((&fast - &plain).norm() < 1e-14 * plain.norm(), "{}", kind.name());
        }
    }
}

/// Groups of a single point are equivalent to no projection.
#[test]
fn groups_of_single_points_change_nothing() {
    let block = Block::new(CellKind::Hex8, [2, 2, 1]);
    let materials = [soft(), LinearElastic::new(3e6, 0.45).unwrap()];
    let points = block.volume.weights().len();
    let region: Vec<u16> = (0..points).map(|q| (q % 2) as u16).collect();
    let body = LinearBody { region: &region, ..block.body(&materials) };
    let alone =
        DilationGroups::new(points, (0..=points).collect(), (0..points as u32).collect(), vec![1.0; points])
            .unwrap();
    let plain = dense(&matrix(&body));
    let projected = dense(&matrix(&LinearBody { dilation: Some(&alone), ..body }));
    assert!((&plain - &projected).norm() < 1e-13 * plain.norm());
}

#[test]
fn six_rigid_modes_and_no_more() {
    for kind in CellKind::ALL {
        // With fewer hexahedra the test fails: one mean dilation per cell in a row of hex20 admits conformal
        // quadratic fields, whose strain is a dilation linear in x.
        let block = Block::new(kind, [2, 2, 2]);
        let material = [soft()];
        let element = fem::element_dilation(&block.mesh, &VolumeRule::STANDARD).unwrap();
        for dilation in [None, Some(&element)] {
            let k = dense(&matrix(&LinearBody { dilation, ..block.body(&material) }));
            let mut e: Vec<f64> = k.symmetric_eigenvalues().iter().copied().collect();
            e.sort_by(f64::total_cmp);
            let top = e[e.len() - 1];
            assert!(e[5].abs() < 1e-13 * top, "{}: {:e}", kind.name(), e[5] / top);
            assert!(e[6] > 1e-4 * top, "{}: {:e}", kind.name(), e[6] / top);
        }
    }
}

#[test]
fn energy_is_half_u_k_u() {
    let block = Block::new(CellKind::Tet4, [3, 2, 2]);
    let materials = [soft(), LinearElastic::new(3e6, 0.49).unwrap()];
    let region: Vec<u16> = block.volume.points().iter().map(|x| u16::from(x.x > 0.02)).collect();
    let nodal = DilationGroups::nodal(&block.volume).unwrap();
    for dilation in [None, Some(&nodal)] {
        let body = LinearBody { region: &region, dilation, ..block.body(&materials) };
        let u: Vec<Vector3> = body
            .nodes
            .iter()
            .map(|x| affine(x) + Vector3::new(x.y * x.z, x.x * x.x, x.x * x.y * 3.0))
            .collect();
        let ku = matrix(&body).multiply(&u);
        let half: f64 = 0.5 * u.iter().zip(&ku).map(|(a, b)| a.dot(b)).sum::<f64>();
        let energy = strain_energy(&body, &u).unwrap();
        assert!((half - energy).abs() < 1e-12 * energy, "{half} {energy}");
    }
}

#[test]
fn same_bits_with_one_and_two_threads() {
    let block = Block::new(CellKind::Tet4, [7, 6, 5]);
    let material = [LinearElastic::new(20e3, 0.49).unwrap()];
    let nodal = DilationGroups::nodal(&block.volume).unwrap();
    let body = LinearBody { dilation: Some(&nodal), ..block.body(&material) };
    let flux = block.flux(&["z-min"]);
    let surface = block.surface(&["z-max"]);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let loads = [Load::Pressure { surface: &surface, values: vec![2e3; surface.weights().len()] }];
            let values = vec![Vector3::zeros(); flux.weights().len()];
            let method = Weak::Nitsche { gamma: 50.0 };
            let weak = [WeakSupport {
                flux: &flux,
                axes: [true; 3],
                values,
                region: &[],
                method,
                h: 0.004,
                trace: None,
            }];
            let problem = LinearProblem { body, loads: &loads, fixed: &[], constraints: &[], weak: &weak };
            let assembled = assemble(&problem).unwrap();
            let k = assembled.stiffness().clone();
            (k, assembled.factor().unwrap().solve(1.0).unwrap())
        })
    };
    let one = run(1);
    for threads in [2, 2, 3] {
        // PartialEq on f64 detects any differing bit (except the sign of a zero).
        assert!(run(threads) == one);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    /// For any affine field in any material, the forces of the field vanish at inner nodes, sum to zero, have
    /// no moment, and equal those of the boundary traction.
    #[test]
    fn affine_fields_are_in_equilibrium(
        h in prop::array::uniform9(-1.0..1.0f64),
        young in 1.0..1e6f64,
        poisson in -0.5..0.495f64,
        kind in prop::sample::select(CellKind::ALL.to_vec()),
    ) {
        let block = Block::new(kind, [2, 2, 2]);
        let material = [LinearElastic::new(young, poisson).unwrap()];
        let body = block.body(&material);
        let h = Matrix3::from_row_slice(&h);
        let u: Vec<Vector3> = body.nodes.iter().map(|x| h * x.coords).collect();
        let internal = matrix(&body).multiply(&u);
        let surface = block.surface(&SIDES);
        let stress = material[0].stress(&h);
        let mut boundary = vec![Vector3::zeros(); u.len()];
        for q in 0..surface.weights().len() {
            let (nodes, values) = surface.rows().row(q);
            for (&node, v) in nodes.iter().zip(values) {
                boundary[node as usize] += stress * surface.normals()[q] * (v * surface.weights()[q]);
            }
        }
        let scale = internal.iter().map(|f| f.norm()).fold(0.0, f64::max) + 1e-3 * stress.norm();
        for (a, b) in internal.iter().zip(&boundary) {
            prop_assert!((a - b).norm() < 1e-11 * scale, "{} {}", a, b);
        }
        let resultant: Vector3 = internal.iter().sum();
        let moment: Vector3 = internal.iter().zip(body.nodes).map(|(f, x)| x.coords.cross(f)).sum();
        prop_assert!(resultant.norm() < 1e-12 * scale && moment.norm() < 1e-12 * scale);
    }
}
