//! A free body has exactly six rigid modes with any approximation.

mod common;

use common::*;
use efg::{Approximation, Basis, CubicSpline, Kernel, Support, WendlandC2};
use fem::VolumeRule;
use geometry::{CellKind, Mesh, cloud_from_mesh};
use nalgebra::DMatrix;
use shape::Vector3;
use shape::{DilationGroups, VolumeRows};
use statics::{LinearBody, LinearProblem};

/// Returns the stiffness of the free body. The six constraints are only needed by the assembly and do not
/// change it.
fn stiffness(
    mesh: &Mesh,
    volume: &VolumeRows,
    dilation: Option<&DilationGroups>,
    poisson: f64,
) -> DMatrix<f64> {
    let materials = [tissue(poisson)];
    let body = LinearBody { nodes: mesh.points(), volume, materials: &materials, region: &[], dilation };
    let fixed = six_holds(mesh, |_| Vector3::zeros());
    let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &[], weak: &[] };
    let assembled = statics::assemble(&problem).unwrap();
    let n = mesh.points().len();
    let mut dense = DMatrix::zeros(3 * n, 3 * n);
    for i in 0..n {
        let (columns, blocks) = assembled.stiffness().row(i);
        for (&j, block) in columns.iter().zip(blocks) {
            let (i, j) = (3 * i, 3 * j as usize);
            dense.fixed_view_mut::<3, 3>(j, i).copy_from(&block.transpose());
            dense.fixed_view_mut::<3, 3>(i, j).copy_from(block);
        }
    }
    dense
}

fn check(name: &str, mesh: &Mesh, k: &DMatrix<f64>) {
    let scale = k.amax();
    assert!((k - k.transpose()).amax() <= 1e-14 * scale, "{name}: not symmetric");
    for mode in 0..6 {
        let axis = Vector3::ith(mode % 3, 1.0);
        let motion = |x: &shape::Point3| {
            if mode < 3 { axis } else { axis.cross(&(x - mesh.points()[0])) / 0.02 }
        };
        let u = DMatrix::from_iterator(
            k.nrows(),
            1,
            mesh.points().iter().flat_map(|x| motion(x).iter().copied().collect::<Vec<_>>()),
        );
        let force = (k * u).amax() / scale;
        assert!(force < 1e-13, "{name}: rigid mode {mode} meets a force of {force:e}");
    }
    let mut eigen: Vec<f64> = k.clone().symmetric_eigenvalues().iter().copied().collect();
    eigen.sort_by(f64::total_cmp);
    let largest = eigen[eigen.len() - 1];
    assert!(eigen[5].abs() < 1e-12 * largest, "{name}: fewer than six modes: {:e}", eigen[5]);
    assert!(eigen[0] > -1e-12 * largest, "{name}: negative eigenvalue {:e}", eigen[0]);
    assert!(eigen[6] > 1e-7 * largest, "{name}: a seventh mode: {:e} of {largest:e}", eigen[6]);
}

#[test]
fn six_for_every_element() {
    for kind in CellKind::ALL {
        let mesh = jittered_box(kind, if kind.order() == 1 { 2 } else { 1 });
        let volume = fem::volume_rows(&mesh, &VolumeRule::STANDARD).unwrap();
        for poisson in [0.3, 0.495] {
            check(kind.name(), &mesh, &stiffness(&mesh, &volume, None, poisson));
            if kind.order() == 1 {
                let mean = fem::element_dilation(&mesh, &VolumeRule::STANDARD).unwrap();
                check(kind.name(), &mesh, &stiffness(&mesh, &volume, Some(&mean), poisson));
                let nodal = DilationGroups::nodal(&volume).unwrap();
                check(kind.name(), &mesh, &stiffness(&mesh, &volume, Some(&nodal), poisson));
            }
        }
    }
}

/// The motion `2 (a . x) x - |x|^2 a` is conformal: its strain is the pure dilation `2 a . x`. In a single
/// layer across `a`, one mean dilation per quadratic cell does not resist this motion, and nothing else does.
#[test]
fn a_single_layer_of_quadratic_cells_with_mean_dilation_has_a_seventh() {
    let mesh = jittered_box(CellKind::Hex20, 1);
    let volume = fem::volume_rows(&mesh, &VolumeRule::STANDARD).unwrap();
    let mean = fem::element_dilation(&mesh, &VolumeRule::STANDARD).unwrap();
    let count = |dilation| {
        let eigen = stiffness(&mesh, &volume, dilation, 0.3).symmetric_eigenvalues();
        eigen.iter().filter(|e| e.abs() < 1e-12 * eigen.max()).count()
    };
    assert_eq!((count(None), count(Some(&mean))), (6, 7));
}

#[test]
fn six_for_every_integration_of_a_cloud() {
    let mesh = jittered_box(CellKind::Tet4, 2);
    let cloud = cloud_from_mesh(&mesh);
    for (kernel, dilatation) in [
        (Kernel::CubicSpline(CubicSpline), 1.2),
        (Kernel::CubicSpline(CubicSpline), 1.6),
        (Kernel::WendlandC2(WendlandC2), 1.6),
    ] {
        let radii = Support::Dilatation { factor: dilatation }.radii(&cloud.points, &cloud.spacing).unwrap();
        let mls = Approximation::new(cloud.points.clone(), radii, kernel, Basis::Linear).unwrap();
        let (gauss, _) = efg::gauss_rows(&mls, &mesh, 4).unwrap();
        let (smoothed, _) = efg::smoothed_rows(&mls, &mesh, efg::Smoothing::Constant, 1).unwrap();
        let (consistent, _) = efg::smoothed_rows(&mls, &mesh, efg::Smoothing::Linear, 6).unwrap();
        let (nodal, _) = efg::node_smoothed_rows(&mls, &mesh, 0.0, 1).unwrap();
        let (stabilised, _) = efg::node_smoothed_rows(&mls, &mesh, 0.05, 1).unwrap();
        for (name, volume) in [
            ("gauss", &gauss),
            ("cell-smoothed", &smoothed),
            ("cell-smoothed to second order", &consistent),
            ("node-smoothed", &nodal),
            ("node-smoothed, stabilised", &stabilised),
        ] {
            let nodal = DilationGroups::nodal(volume).unwrap();
            for dilation in [None, Some(&nodal)] {
                let name =
                    format!("{name}, {}, {dilatation}, projected {}", kernel.name(), dilation.is_some());
                check(&name, &mesh, &stiffness(&mesh, volume, dilation, 0.3));
            }
        }
    }
}
