//! The depth of a wall by Laplace's equation.
//!
//! ```text
//! Source      t = ln(r / a) / ln(b / a) between two coaxial cylinders.
//! Must hold   errors of order 2 for linear elements and clouds, and of order 3 for quadratic elements.
//! ```

use efg::{Approximation, Basis, CubicSpline, Kernel, Smoothing, Support};
use geometry::generate::box_mesh;
use geometry::{CellKind, Mesh, cloud_from_mesh};
use shape::{FluxRows, Point3, Vector3, VolumeRows};
use statics::{LaplaceProblem, solve_laplace};

const INNER: f64 = 0.01;
const OUTER: f64 = 0.02;

/// A quarter of a tube, `cells` through its wall.
fn tube(kind: CellKind, cells: usize) -> Mesh {
    let max = Point3::new(1.0, 1.0, 1.0);
    let unit = box_mesh(kind, Point3::origin(), max, [cells, 2 * cells, 1], [1.0; 3], None).unwrap();
    let at = |x: &Point3| {
        let (r, angle) = (INNER + x.x * (OUTER - INNER), std::f64::consts::FRAC_PI_2 * x.y);
        Point3::new(r * angle.cos(), r * angle.sin(), 0.008 / cells as f64 * x.z)
    };
    unit.moved(at).unwrap()
}

/// Root mean squares of the errors of the depth and of its gradient times the thickness.
fn errors(volume: &VolumeRows, field: &[f64]) -> [f64; 2] {
    let mut sums = [0.0; 3];
    for (q, (x, w)) in volume.points().iter().zip(volume.weights()).enumerate() {
        let (nodes, values) = volume.rows().row(q);
        let t: f64 = nodes.iter().zip(values).map(|(&node, value)| value * field[node as usize]).sum();
        let grads = nodes.iter().zip(volume.row(q).1);
        let gradient: Vector3 = grads.map(|(&node, grad)| grad * field[node as usize]).sum();
        let (r, scale) = (x.x.hypot(x.y), (OUTER / INNER).ln());
        let exact = Vector3::new(x.x, x.y, 0.0) / (r * r * scale);
        sums[0] += w * (t - (r / INNER).ln() / scale).powi(2);
        sums[1] += w * (gradient - exact).norm_squared() * (OUTER - INNER).powi(2);
        sums[2] += w;
    }
    [sums[0], sums[1]].map(|sum| (sum / sums[2]).sqrt())
}

fn of_elements(kind: CellKind, cells: usize) -> [f64; 2] {
    let mesh = tube(kind, cells);
    let volume = fem::volume_rows(&mesh, &fem::VolumeRule::STANDARD).unwrap();
    let side = |name: &str| mesh.facet_group_nodes(mesh.group(name).unwrap());
    let ends = [(side("x-min"), 0.0), (side("x-max"), 1.0)];
    let fixed: Vec<(u32, f64)> =
        ends.into_iter().flat_map(|(nodes, value)| nodes.into_iter().map(move |n| (n, value))).collect();
    let problem = LaplaceProblem { volume: &volume, fixed: &fixed, surfaces: &[], stabilisation: 1.0 };
    errors(&volume, &solve_laplace(&problem).unwrap())
}

fn of_cloud(cells: usize) -> [f64; 2] {
    let mesh = tube(CellKind::Tet4, cells);
    let cloud = cloud_from_mesh(&mesh);
    let radii = Support::Dilatation { factor: 1.6 }.radii(&cloud.points, &cloud.spacing).unwrap();
    let mls =
        Approximation::new(cloud.points, radii, Kernel::CubicSpline(CubicSpline), Basis::Linear).unwrap();
    let (volume, _) = efg::smoothed_rows(&mls, &mesh, Smoothing::Linear, 6).unwrap();
    let surface =
        |name: &str| -> FluxRows { efg::flux_rows(&mls, &mesh, mesh.group(name).unwrap(), 6).unwrap().0 };
    let surfaces = [(surface("x-min"), 0.0), (surface("x-max"), 1.0)];
    let stabilisation = 100.0 * cells as f64 / (OUTER - INNER);
    let problem = LaplaceProblem { volume: &volume, fixed: &[], surfaces: &surfaces, stabilisation };
    errors(&volume, &solve_laplace(&problem).unwrap())
}

/// Orders between two meshes whose sizes differ by two.
fn orders(coarse: [f64; 2], fine: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|k| (coarse[k] / fine[k]).log2())
}

#[test]
fn the_depth_of_a_tube_converges_with_its_order() {
    let kinds = [
        (CellKind::Tet4, 2.0, 1.0),
        (CellKind::Hex8, 2.0, 1.0),
        (CellKind::Wedge6, 2.0, 1.0),
        (CellKind::Tet10, 3.0, 2.0),
        (CellKind::Hex20, 3.0, 2.0),
        (CellKind::Wedge15, 3.0, 2.0),
    ];
    for (kind, of_depth, of_gradient) in kinds {
        let [coarse, fine] = [4, 8].map(|cells| of_elements(kind, cells));
        let [depth, gradient] = orders(coarse, fine);
        println!("{kind:?}: {fine:?}, orders {depth:.2} and {gradient:.2}");
        assert!(depth > of_depth - 0.15 && gradient > of_gradient - 0.15, "{kind:?}: {depth} {gradient}");
        assert!(fine[0] < 1e-3 && fine[1] < 0.05, "{kind:?}: {fine:?}");
    }
    let [coarse, fine] = [4, 8].map(of_cloud);
    let [depth, gradient] = orders(coarse, fine);
    println!("cloud: {fine:?}, orders {depth:.2} and {gradient:.2}");
    assert!(depth > 1.7 && gradient > 0.85, "cloud: {depth} {gradient}");
    assert!(fine[0] < 2e-3 && fine[1] < 0.05, "cloud: {fine:?}");
}
