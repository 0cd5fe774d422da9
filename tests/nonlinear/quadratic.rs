//! Newton's method converges quadratically.
//!
//! ```text
//! Source      the theorem of Newton and Kantorovich; Wriggers, Nonlinear Finite Element Methods (2008), ch.
//!             5.
//! Body        jittered box, every law, every method, nu = 0.45; z = 0 clamped.
//! Conditions  Dead tractions on the top that compress and shear it by about a tenth in two steps; or a plate
//!             that presses the whole top (sticking, or without friction), the middle of each step's
//!             iterations with all points in contact.
//! Must hold   Each pair of relative residuals obeys r1 <= 100 r0^2 while r0 is between 0.1 and 1e-7 (a
//!             linear rate of 0.1 would give 1e5). Over the pairs of all laws the exponent is at least 1.7.
//!             (The constant varies with the direction of the error, so three residuals of one solution do
//!             not suffice.) A linear law ends after one iteration.
//! ```

use contact::{ContactLaw, ContactSurface, Drive, DrivenTool, Plate, Tool, ToolShape};
use fem::SurfaceRule;
use integration::model::*;
use material::Material as _;
use shape::{Point3, Vector3};
use statics::{Load, NewtonParams, StaticParams, StaticPath, StaticProblem};

/// Returns parameters for two steps, in which every iteration has its own tangent.
fn newton_alone() -> StaticParams {
    let params = steps(2);
    StaticParams { newton: NewtonParams { chords: false, ..params.newton }, ..params }
}

/// Appends `(r0, r1)` of all steps with `r0` in range, and refuses pairs above the parabola.
fn collect(name: &str, path: &StaticPath, pairs: &mut Vec<(f64, f64)>) {
    for step in &path.steps {
        let residuals: Vec<f64> = step.iterations.iter().map(|i| i.residual).collect();
        for pair in residuals.windows(2).filter(|r| r[0] < 0.1 && r[0] > 1e-7) {
            assert!(pair[1] < 100.0 * pair[0].powi(2), "{name}: {:e} after {:e}", pair[1], pair[0]);
            pairs.push((pair[0], pair[1]));
        }
    }
}

/// Returns the slope of `ln r1` over `ln r0` by least squares.
fn exponent(pairs: &[(f64, f64)]) -> f64 {
    let count = pairs.len() as f64;
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(f).sum::<f64>() / count;
    let (x, y) = (mean(&|p| p.0.ln()), mean(&|p| p.1.ln()));
    mean(&|p| (p.0.ln() - x) * (p.1.ln() - y)) / mean(&|p| (p.0.ln() - x).powi(2))
}

#[test]
fn under_dead_loads() {
    for method in METHODS {
        let mut pairs = Vec::new();
        let model = Model::block(method, [2, 2, 2]);
        let surface =
            fem::surface_rows(&model.mesh, model.mesh.group("z-max").unwrap(), &SurfaceRule::STANDARD);
        let surface = surface.unwrap();
        let fixed = model.hold(&["z-min"], &[0, 1, 2], |_| Vector3::zeros());
        for law in laws(YOUNG, 0.45) {
            let name = format!("{method:?} {}", law.name());
            let values = vec![Vector3::new(0.04, 0.015, -0.03) * YOUNG; surface.weights().len()];
            let loads = [Load::Traction { surface: &surface, values }];
            let problem = StaticProblem { fixed: &fixed, loads: &loads, ..model.problem(&law) };
            let path = solve(&name, &problem, &newton_alone());
            collect(&name, &path, &mut pairs);
            if law.is_small_strain() {
                assert_eq!(path.steps[0].iterations.len(), 2, "{name}");
            }
        }
        let exponent = exponent(&pairs);
        assert!(pairs.len() >= 12, "{method:?}: only {} pairs of residuals", pairs.len());
        assert!(exponent >= 1.7, "{method:?}: exponent {exponent}");
    }
}

#[test]
fn under_a_plate() {
    for method in METHODS {
        let mut pairs = Vec::new();
        let model = Model::block(method, [2, 2, 2]);
        let surface =
            fem::surface_rows(&model.mesh, model.mesh.group("z-max").unwrap(), &SurfaceRule::STANDARD);
        let surface = surface.unwrap();
        let contact = ContactSurface::new(&surface);
        let fixed = model.hold(&["z-min"], &[0, 1, 2], |_| Vector3::zeros());
        for law in laws(YOUNG, 0.45) {
            for (kind, touch) in [
                ("slips", ContactLaw::frictionless(3e7).unwrap()),
                ("sticks", ContactLaw::coulomb(3e7, 100.0, 3e7).unwrap()),
            ] {
                let name = format!("{method:?} {} {kind}", law.name());
                // The plate moves obliquely downwards, so a sticking plate shears the body.
                let along = Vector3::new(0.6, 0.0, -0.8);
                let turn = Tool::turned_to(&-Vector3::z());
                let at = Point3::new(0.0, 0.0, SIZE.z);
                let plate = Tool::new(ToolShape::Plate(Plate), at, turn, along, touch).unwrap();
                let tools = [DrivenTool { tool: &plate, drive: Drive::Closure(5e-3) }];
                let problem = StaticProblem {
                    fixed: &fixed,
                    contact: Some(&contact),
                    tools: &tools,
                    ..model.problem(&law)
                };
                let path = solve(&name, &problem, &newton_alone());
                let all = surface.weights().len();
                if path.steps.iter().all(|s| s.tools[0].active == all) {
                    collect(&name, &path, &mut pairs);
                }
            }
        }
        let exponent = exponent(&pairs);
        assert!(pairs.len() >= 12, "{method:?}: only {} pairs of residuals", pairs.len());
        assert!(exponent >= 1.7, "{method:?}: exponent {exponent}");
    }
}
