//! Implicit Euler with a limited number of conjugate-gradient iterations, compared with the static solution.

use explicit::{ExplicitBody, FrameParams, Frames, Lumping, Prescribed, lumped_mass};
use geometry::CellKind;
use geometry::generate::box_mesh;
use integration::model::{Model, Projection, solve, steps};
use material::{Corotational, Law};
use shape::{Point3, Vector3};
use statics::{Load, StaticProblem};

/// Density, kg/m^3.
const DENSITY: f64 = 1100.0;

/// Beam of SOFA's validation on a coarse mesh, bent by its own weight: 2 MPa, nu .45, Rayleigh damping .1 /
/// .1.
#[test]
fn a_beam_comes_to_rest_at_the_static_solution_and_25_iterations_lag_behind() {
    let max = Point3::new(0.2, 0.02, 0.02);
    let mesh = box_mesh(CellKind::Hex8, Point3::origin(), max, [10, 2, 2], [1.0; 3], None).unwrap();
    let model = Model::new(mesh, Projection::Standard);
    let laws = [Law::Corotational(Corotational::new(2e6, 0.45).unwrap())];
    let fixed = model.hold(&["x-min"], &[0, 1, 2], |_| Vector3::zeros());
    let weight = vec![Vector3::new(0.0, 0.0, -9.81 * DENSITY); model.volume.weights().len()];
    let loads = [Load::Body { values: weight }];
    let problem = StaticProblem { fixed: &fixed, loads: &loads, ..model.problem(&laws[0]) };
    let exact = solve("beam", &problem, &steps(4)).u;
    let nodal = statics::nodal_forces(&model.volume, &loads).unwrap();

    let mass = lumped_mass(&model.volume, &[DENSITY], &[], Lumping::RowSum).unwrap();
    let held = |_: f64| 0.0;
    let prescribed: Vec<Prescribed> =
        fixed.iter().map(|dof| Prescribed { node: dof.node, axis: dof.axis, motion: &held }).collect();
    let body = ExplicitBody { volume: &model.volume, laws: &laws, region: &[], axes: &[], groups: None };
    let largest = exact.iter().map(Vector3::norm).fold(0.0, f64::max);
    let errors = |iterations: usize, frames: usize| {
        let params = FrameParams { dt: 0.02, damping: 0.1, inertia: true, sweeps: iterations };
        let mut run = Frames::conjugate_gradients(body, &mass, &prescribed, params, [1e-9, 0.1]).unwrap();
        for _ in 0..frames {
            run.step(&mut |_, f| f.iter_mut().zip(&nodal).for_each(|(f, load)| *f += load)).unwrap();
        }
        let gap = run.u().iter().zip(&exact).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        let residual = run.state().unwrap().residual;
        println!("{iterations} iterations, {frames} frames: {:e}, residual {residual:e}", gap / largest);
        gap / largest
    };
    let [solved, cut] = [1000, 25].map(|iterations| errors(iterations, 150));
    assert!(solved < 1e-6, "{solved:e}");
    assert!(cut > 0.5, "{cut:e}");
    // Stiffness-proportional damping makes the systems stiff: the beam creeps, and how far depends on
    // rounding.
    let later = errors(25, 600);
    assert!(later < 0.5 * cut, "{later:e} after {cut:e}");
}
