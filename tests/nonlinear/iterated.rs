//! Tangents that are iterated with multigrid.
//!
//! ```text
//! Source      none: the same problem with a factor of every tangent
//! Body        jittered box, tet10, hex8 with one dilation per element, tet4 with one per node; neo-Hookean
//! Conditions  two rough plates move by 1 and 3 mm; no normal displacement at x = 0 and y = 0
//! Must hold   Forces, displacements and reported stability agree with those of factors (1e-8), with fewer
//!             levels and factors than tangents (nu = 0.45 and 0.495), and with the same bits for any number
//!             of threads. Iterations that do not converge, and tangents that are not definite, lead to
//!             factors, and so to the same end.
//! ```

use contact::ContactLaw;
use geometry::CellKind;
use integration::model::*;
use material::{Law, NeoHookean};
use statics::{LinearSystems, NewtonParams, StaticParams, StaticPath};

use crate::contact_patch::press_by;

/// Presses a body between rough plates in four steps.
fn press(model: &Model, poisson: f64, iterates: bool) -> StaticPath {
    let law = Law::NeoHookean(NeoHookean::new(YOUNG, poisson).unwrap());
    let rough = ContactLaw::coulomb(1e7, 0.15, 1e6).unwrap();
    let linear = fem::linear_nodes(&model.mesh).unwrap();
    let linear = linear.as_ref();
    let systems = if iterates { LinearSystems::Iterated { linear } } else { LinearSystems::Factored };
    let newton = NewtonParams { tolerance: 1e-10, ..steps(4).newton };
    let params = StaticParams { newton, ..steps(4) };
    press_by(model, &law, rough, (&format!("nu = {poisson}"), systems), &params).0
}

/// Asserts that two paths have the same steps, forces and ends.
fn assert_same(name: &str, a: &StaticPath, b: &StaticPath) {
    assert_eq!(a.steps.len(), b.steps.len(), "{name}");
    for (a, b) in a.steps.iter().zip(&b.steps) {
        assert_eq!((a.stable, a.gave_way), (b.stable, b.gave_way), "{name}: {:?}", b.iterations);
        for (a, b) in a.tools.iter().zip(&b.tools) {
            let gap = (a.force - b.force).norm() / a.force.norm();
            assert!(gap < 1e-8, "{name}: {} {}", a.force, b.force);
        }
    }
    let far = a.u.iter().zip(&b.u).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(far < 1e-8 * 3e-3, "{name}: {far}");
}

#[test]
fn iterations_lead_to_the_same_end() {
    let tet10 = ((CellKind::Tet10, Projection::Standard), [6, 4, 3], 0.45);
    let hex8 = ((CellKind::Hex8, Projection::Element), [10, 8, 5], 0.495);
    let tet4 = ((CellKind::Tet4, Projection::Nodal), [10, 8, 5], 0.495);
    for (method, cells, poisson) in [tet10, hex8, tet4] {
        let model = Model::block(method, cells);
        let [factored, iterated] = [false, true].map(|iterates| press(&model, poisson, iterates));
        assert_same(&format!("{method:?}"), &factored, &iterated);
        assert!(iterated.steps.iter().all(|step| step.stable));
        let work = iterated.work;
        assert!(work.factorisations < work.assemblies && work.inner > 0, "{method:?}: {work:?}");
    }
}

#[test]
fn iterations_of_a_nearly_incompressible_body_lead_to_the_same_end() {
    // Many tangents on the way are not definite.
    let model = Model::block((CellKind::Hex8, Projection::Element), [10, 8, 5]);
    let [factored, iterated] = [false, true].map(|iterates| press(&model, 0.4999, iterates));
    assert_same("nu = 0.4999", &factored, &iterated);
}

#[test]
fn iterations_have_the_same_bits_for_any_number_of_threads() {
    let model = Model::block((CellKind::Tet4, Projection::Nodal), [10, 8, 5]);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| press(&model, 0.49, true).u)
    };
    assert!(with(1) == with(2));
}

#[test]
fn iterations_that_do_not_converge_lead_to_a_factor() {
    // Displacements alone, a million times stiffer in volume than in shear.
    let model = Model::block((CellKind::Hex8, Projection::Standard), [10, 8, 5]);
    let [factored, iterated] = [false, true].map(|iterates| press(&model, 0.4999995, iterates));
    assert_same("hex8", &factored, &iterated);
    // Levels are built anew after each equilibrium, and a factor follows.
    assert!(iterated.work.factorisations > factored.work.factorisations, "{:?}", iterated.work);
}
