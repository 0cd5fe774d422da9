//! Snap-through of a strut under a dead load.
//!
//! ```text
//! Source      the von Mises truss, one half. With the apex at height z, Green's strain (z^2 - h^2) / (2 L^2)
//!             and a uniaxial stress along the strut, P(z) = E A z (h^2 - z^2) / (2 L^3) downwards. Its limit
//!             is E A h^3 / (3 sqrt(3) L^3) at z = h / sqrt(3); beyond it the next equilibrium is far below z
//!             = -h.
//! Body        a bar of 100 x 10 x 10 mm, rising by 10 mm; St. Venant-Kirchhoff, nu = 0; 10 x 2 x 1 hex20.
//! Conditions  hinges in the middle of both ends: the foot constrained, the apex free along y; 0.5 and 1.5
//!             times the limit load on the apex, dead, in 4 steps.
//! Must hold   Below the limit the strut stays up. Above, it hangs at the other equilibrium, where its
//!             tangent is definite again. A force on a line indents the hinges: within 4 % of h. A search for
//!             the limit finds it within 2 % of the value that follows from the height at half the limit.
//! ```

use fem::SurfaceRule;
use geometry::CellKind;
use geometry::generate::box_mesh;
use integration::model::*;
use material::{Law, SaintVenantKirchhoff};
use shape::{FixedDof, Point3, Vector3};
use statics::{Load, NewtonParams, StaticParams, StaticPath, StaticProblem};

const LENGTH: f64 = 0.1;
const DEPTH: f64 = 0.01;
const RISE: f64 = 0.01;

/// Returns the path under `factor` times the limit load, and the height of the apex at its end, m.
fn strut(factor: f64, params: &StaticParams) -> (StaticPath, f64) {
    let (low, high) = (Point3::new(0.0, -0.5 * DEPTH, 0.0), Point3::new(LENGTH, 0.5 * DEPTH, DEPTH));
    let flat = box_mesh(CellKind::Hex20, low, high, [10, 2, 1], [1.0; 3], None).unwrap();
    let (sin, cos) = (RISE / LENGTH, (1.0 - (RISE / LENGTH).powi(2)).sqrt());
    let hinge = |x: f64| -> Vec<u32> {
        let on = |p: &Point3| (p.x - x).abs() < 1e-9 && p.y.abs() < 1e-9;
        (0u32..).zip(flat.points()).filter(|(_, p)| on(p)).map(|(i, _)| i).collect()
    };
    let (foot, top) = (hinge(0.0), hinge(LENGTH));
    assert_eq!((foot.len(), top.len()), (3, 3));
    let mesh = flat.moved(|p| Point3::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y, p.z)).unwrap();
    let model = Model::new(mesh, Projection::Standard);
    let constrained = |nodes: &[u32], axes: &[u8]| -> Vec<FixedDof> {
        nodes
            .iter()
            .flat_map(|&node| axes.iter().map(move |&axis| FixedDof { node, axis, value: 0.0 }))
            .collect()
    };
    let everywhere: Vec<u32> = (0..model.mesh.points().len() as u32).collect();
    let fixed =
        [constrained(&foot, &[0, 1]), constrained(&top, &[0]), constrained(&everywhere, &[2])].concat();
    let limit = YOUNG * (RISE / LENGTH).powi(3) / (3.0 * 3f64.sqrt());
    let end = fem::surface_rows(&model.mesh, &model.facets(&["x-max"]), &SurfaceRule::STANDARD).unwrap();
    let values = vec![Vector3::new(0.0, -factor * limit, 0.0); end.weights().len()];
    let loads = [Load::Traction { surface: &end, values }];
    let law = Law::SaintVenantKirchhoff(SaintVenantKirchhoff::new(YOUNG, 0.0).unwrap());
    let problem = StaticProblem { loads: &loads, fixed: &fixed, ..model.problem(&law) };
    let path = solve(&format!("{factor} of the limit"), &problem, params);
    let height = RISE + path.u[top[0] as usize].y;
    (path, height)
}

#[test]
fn struts_snap_through_beyond_the_limit_load() {
    // Heights relative to the rise solve c = z - z^3 with c = factor * 2 / (3 sqrt 3): the root above the
    // height of the limit, and the root below -1, by Newton's method.
    for (factor, start, keeps) in [(0.5, 1.0, f64::INFINITY), (1.5, -1.5, f64::INFINITY), (1.5, -1.5, 0.0)] {
        let load = factor * 2.0 / (3.0 * 3f64.sqrt());
        let exact = (0..50).fold(start, |z: f64, _| z - (z - z.powi(3) - load) / (1.0 - 3.0 * z * z));
        let params = StaticParams { newton: NewtonParams { keeps, ..steps(4).newton }, ..steps(4) };
        let (path, height) = strut(factor, &params);
        assert!(path.steps.last().unwrap().stable, "{factor} of the limit: the end is not stable");
        let found = height / RISE;
        assert!(
            (found - exact).abs() < 0.04,
            "{factor} of the limit: apex at {found} of the rise, {exact} expected"
        );
    }
}

#[test]
fn the_limit_load_is_found_where_it_is_sought() {
    // The hinges make the strut softer than in theory, by a factor that follows from the height at half the
    // limit.
    let height = strut(0.5, &steps(4)).1 / RISE;
    let limit = 0.5 / (1.5 * 3f64.sqrt() * (height - height.powi(3)));
    // The last value is below the smallest step, a 64th of a quarter, halved once.
    for within in [0.2, 0.01, 1e-4] {
        let (path, _) = strut(1.5, &StaticParams { limit_within: Some(within), ..steps(4) });
        let gave_way = path.steps.iter().position(|step| step.gave_way).expect("it gives way");
        assert!(path.steps[..gave_way].iter().all(|step| step.stable));
        let [below, above] = [gave_way - 1, gave_way].map(|k| 1.5 * path.steps[k].time);
        assert!(above - below <= 1.5 * f64::max(within, 2.0 / 256.0), "{below} to {above}");
        assert!(below < 1.02 * limit && above > 0.98 * limit, "{below} to {above}, not {limit} of the limit");
    }
}
