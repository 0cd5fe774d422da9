//! Displacements restricted to a few modes.
//!
//! ```text
//! Source      Galerkin's method: equilibrium is required of the forces along the modes alone.
//! Body        jittered box, every method without a pressure field, nu = 0.45; z = 0 clamped, a dead traction on the
//!             top in four steps.
//! Must hold   With the modes of the recorded states as basis, the path is that of the full method: the states are
//!             combinations of the modes, and their forces balance along every mode. With fewer modes the strain
//!             energy less the work of the load is larger, and falls with each further mode. Newton's iterations on
//!             the coefficients converge quadratically.
//! ```

use fem::SurfaceRule;
use integration::model::*;
use material::{Law, NeoHookean};
use shape::Vector3;
use statics::{
    Basis, LinearSystems, Load, NewtonParams, StaticParams, StaticPath, StaticProblem, solve_static,
};

/// Steps of the path.
const STEPS: usize = 4;

fn without_pressure() -> impl Iterator<Item = (geometry::CellKind, Projection)> {
    METHODS.into_iter().filter(|(_, projection)| *projection != Projection::Mixed)
}

fn recorded(problem: &StaticProblem, params: &StaticParams) -> (StaticPath, Vec<Vec<Vector3>>) {
    let mut states = Vec::new();
    let path = solve_static(problem, params, |_, rest| states.push(rest.u.to_vec())).unwrap();
    assert!(path.failure.is_none() && states.len() == STEPS);
    (path, states)
}

#[test]
fn modes_of_a_path_give_the_path_again_and_fewer_are_stiffer() {
    for method in without_pressure() {
        let model = Model::block(method, [3, 2, 2]);
        let top = fem::surface_rows(&model.mesh, &model.facets(&["z-max"]), &SurfaceRule::STANDARD).unwrap();
        let fixed = model.hold(&["z-min"], &[0, 1, 2], |_| Vector3::zeros());
        let law = Law::NeoHookean(NeoHookean::new(YOUNG, 0.45).unwrap());
        let values = vec![Vector3::new(0.04, 0.015, -0.03) * YOUNG; top.weights().len()];
        let loads = [Load::Traction { surface: &top, values }];
        let full = StaticProblem { fixed: &fixed, loads: &loads, ..model.problem(&law) };
        let params = steps(STEPS);
        let (path, states) = recorded(&full, &params);
        let forces = statics::nodal_forces(&model.volume, &loads).unwrap();
        let potential = |path: &StaticPath| {
            let work: f64 = forces.iter().zip(&path.u).map(|(f, u)| f.dot(u)).sum();
            path.steps.last().unwrap().energy - work
        };
        let mut last = f64::INFINITY;
        for count in 1..=STEPS {
            let basis = Basis::of_states(&model.volume, &states, count);
            assert_eq!(basis.len(), count, "{method:?}");
            let modal = StaticProblem { systems: LinearSystems::Modal(&basis), ..full.clone() };
            let (reduced, of_modes) = recorded(&modal, &params);
            let now = potential(&reduced);
            // The last modes lower the energy by less than its rounding.
            assert!(
                now < last || (now / last - 1.0).abs() < 1e-12,
                "{method:?}, {count} modes: {now} after {last}"
            );
            assert!(now >= potential(&path) * (1.0 + 1e-10), "{method:?}: less than the full method's");
            last = now;
            if count == STEPS {
                for (of_modes, state) in of_modes.iter().zip(&states) {
                    let largest = state.iter().map(Vector3::norm).fold(0.0, f64::max);
                    let off = of_modes.iter().zip(state).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
                    assert!(off < 1e-7 * largest, "{method:?}: {:e}", off / largest);
                }
            }
        }
    }
}

#[test]
fn iterations_on_coefficients_converge_quadratically() {
    let model = Model::block(METHODS[4], [3, 3, 3]);
    let top = fem::surface_rows(&model.mesh, &model.facets(&["z-max"]), &SurfaceRule::STANDARD).unwrap();
    let fixed = model.hold(&["z-min"], &[0, 1, 2], |_| Vector3::zeros());
    let law = Law::NeoHookean(NeoHookean::new(YOUNG, 0.45).unwrap());
    let values = vec![Vector3::new(0.04, 0.015, -0.03) * YOUNG; top.weights().len()];
    let loads = [Load::Traction { surface: &top, values }];
    let full = StaticProblem { fixed: &fixed, loads: &loads, ..model.problem(&law) };
    let (_, states) = recorded(&full, &steps(STEPS));
    let basis = Basis::of_states(&model.volume, &states, 3);
    let modal = StaticProblem { systems: LinearSystems::Modal(&basis), ..full };
    let params = steps(STEPS);
    let params = StaticParams { newton: NewtonParams { chords: false, ..params.newton }, ..params };
    let (path, _) = recorded(&modal, &params);
    let residuals =
        path.steps.iter().map(|step| step.iterations.iter().map(|i| i.residual).collect::<Vec<_>>());
    let mut pairs = 0;
    for residuals in residuals {
        for pair in residuals.windows(2).filter(|r| r[0] < 0.1 && r[0] > 1e-7) {
            assert!(pair[1] < 100.0 * pair[0].powi(2), "{:e} after {:e}", pair[1], pair[0]);
            pairs += 1;
        }
    }
    assert!(pairs >= 4, "only {pairs} pairs");
}
