//! A strut that snaps through under a dead load.
//!
//! ```text
//! Source      the von Mises truss, one half: with the apex at height z, Green's strain (z^2 - h^2) / (2 L^2) and one
//!             stress along the strut, P(z) = E A z (h^2 - z^2) / (2 L^3) down; its limit is E A h^3 / (3 sqrt(3) L^3)
//!             at z = h / sqrt(3), and beyond it the next equilibrium is far below z = -h.
//! Body        a bar of 100 x 10 x 10 mm, rising by 10 mm; St. Venant-Kirchhoff, nu = 0; 10 x 2 x 1 hex20.
//! Conditions  hinges in the middle of both ends: the foot held, the apex free along y; 0.5 and 1.5 times the limit load on
//!             the apex, dead, in 4 steps.
//! Must hold   below the limit the strut stays up, above it hangs at the other equilibrium, where its tangent is definite
//!             again. A force on a line presses the hinges in: within 4 % of h.
//! ```

use fem::SurfaceRule;
use geometry::CellKind;
use geometry::generate::box_mesh;
use mechanics::*;

use crate::common::*;

const LENGTH: f64 = 0.1;
const DEPTH: f64 = 0.01;
const RISE: f64 = 0.01;

/// Height of the apex under `factor` times the limit load, m.
fn apex(factor: f64) -> f64 {
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
    let held = |nodes: &[u32], axes: &[u8]| -> Vec<FixedDof> {
        nodes
            .iter()
            .flat_map(|&node| axes.iter().map(move |&axis| FixedDof { node, axis, value: 0.0 }))
            .collect()
    };
    let everywhere: Vec<u32> = (0..model.mesh.points().len() as u32).collect();
    let fixed = [held(&foot, &[0, 1]), held(&top, &[0]), held(&everywhere, &[2])].concat();
    let limit = YOUNG * (RISE / LENGTH).powi(3) / (3.0 * 3f64.sqrt());
    let end = fem::surface_rows(&model.mesh, &model.facets(&["x-max"]), &SurfaceRule::STANDARD).unwrap();
    let values = vec![Vector3::new(0.0, -factor * limit, 0.0); end.weights().len()];
    let loads = [Load::Traction { surface: &end, values }];
    let law = Law::SaintVenantKirchhoff(SaintVenantKirchhoff::new(YOUNG, 0.0).unwrap());
    let problem = StaticProblem { loads: &loads, fixed: &fixed, ..model.problem(&law) };
    let path = solve(&format!("{factor} of the limit"), &problem, &steps(4));
    let last = path.steps.last().unwrap().iterations.iter().rev().nth(1).unwrap();
    assert!(last.definite, "{factor} of the limit: the end is not stable");
    RISE + path.u[top[0] as usize].y
}

#[test]
fn struts_snap_through_beyond_the_limit_load() {
    // Heights over the rise, of c = z - z^3 with c = factor * 2 / (3 sqrt 3): the root above the limit's place, and the
    // one below -1, by Newton's method.
    for (factor, start) in [(0.5, 1.0), (1.5, -1.5)] {
        let load = factor * 2.0 / (3.0 * 3f64.sqrt());
        let exact = (0..50).fold(start, |z: f64, _| z - (z - z.powi(3) - load) / (1.0 - 3.0 * z * z));
        let found = apex(factor) / RISE;
        assert!(
            (found - exact).abs() < 0.04,
            "{factor} of the limit: apex at {found} of the rise, {exact} expected"
        );
    }
}
