//! Contact patch test: a block compressed between flat plates.
//!
//! ```text
//! Source      Taylor & Papadopoulos (1991); Crisfield, Int. J. Numer. Meth. Engng 48 (2000).
//! Body        jittered box of 3 x 2 x 2 cells, every method; neo-Hookean.
//! Conditions  two plates move towards each other along z, by 1 and 3 mm; x = 0 and y = 0: no normal
//!             displacement.
//! Must hold   Without friction (nu = 0.45) the pressure is uniform over both faces, 1e-9. The penetration is
//!             p / k_n at every point for any penalty, so the penetrations of both plates are equal. With
//!             friction the same holds at nu = 0, where nothing slides. At nu = 0.45 the sides bulge,
//!             friction acts inwards and the pressure is not uniform. Forces and moments of both plates and
//!             of the symmetry planes still balance, and no traction leaves Coulomb's cone.
//! ```

use contact::{
    ContactCounts, ContactHistory, ContactLaw, ContactSurface, Drive, DrivenTool, Plate, Tool, ToolShape,
};
use fem::SurfaceRule;
use geometry::CellKind;
use geometry::generate::box_mesh;
use integration::model::*;
use material::{Law, NeoHookean};
use shape::{Point3, Vector3};
use statics::{LinearSystems, StaticParams, StaticPath, StaticProblem};

const PENALTY: f64 = 1e8;

/// Presses two plates at z = 0 and z = h together, by 1 and 3 mm, and returns the path and the plates.
fn press(model: &Model, law: &Law, touch: ContactLaw, name: &str) -> (StaticPath, Vec<Tool>) {
    press_by(model, law, touch, (name, LinearSystems::Factored), &steps(4))
}

/// Does the same as [`press`] with any solver of the linear systems and any step parameters.
pub fn press_by(
    model: &Model,
    law: &Law,
    touch: ContactLaw,
    (name, systems): (&str, LinearSystems),
    params: &StaticParams,
) -> (StaticPath, Vec<Tool>) {
    let surface = fem::surface_rows(&model.mesh, &model.mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
    let contact = ContactSurface::new(&surface);
    let plates: Vec<Tool> = [(0.0, 1.0), (SIZE.z, -1.0)]
        .map(|(z, sign)| {
            let along = Vector3::z() * sign;
            let at = Point3::new(0.5 * SIZE.x, 0.5 * SIZE.y, z);
            Tool::new(ToolShape::Plate(Plate), at, Tool::turned_to(&along), along, touch).unwrap()
        })
        .into();
    let tools: Vec<DrivenTool> = (plates.iter().zip([1e-3, 3e-3]))
        .map(|(tool, closure)| DrivenTool { tool, drive: Drive::Closure(closure) })
        .collect();
    let mut fixed = model.hold(&["x-min"], &[0], |_| Vector3::zeros());
    fixed.extend(model.hold(&["y-min"], &[1], |_| Vector3::zeros()));
    let problem = StaticProblem {
        fixed: &fixed,
        contact: Some(&contact),
        tools: &tools,
        systems,
        ..model.problem(law)
    };
    (solve(name, &problem, params), plates)
}

/// Returns the normal pressures of both plates at the end, point by point, Pa.
fn pressures(model: &Model, path: &StaticPath, plates: &[Tool]) -> Vec<f64> {
    let surface = fem::surface_rows(&model.mesh, &model.mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
    let contact = ContactSurface::new(&surface);
    (plates.iter().zip(&path.steps.last().unwrap().tools))
        .flat_map(|(plate, state)| {
            let history = ContactHistory::new(plate, surface.weights().len());
            let mut counts = ContactCounts::default();
            let found = contact.evaluate(plate, state.closure, &path.u, &history, &mut counts);
            found.unwrap().unwrap().pressures().to_vec()
        })
        .collect()
}

/// Returns the relative range of the pressures.
fn spread(pressures: &[f64]) -> f64 {
    let (low, high) = pressures.iter().fold((f64::INFINITY, 0.0f64), |(l, h), p| (l.min(*p), h.max(*p)));
    (high - low) / high
}

#[test]
fn pressure_between_flat_plates_is_uniform() {
    let rough = ContactLaw::coulomb(PENALTY, 0.3, PENALTY).unwrap();
    for method in METHODS {
        let model = Model::block(method, [3, 2, 2]);
        for (poisson, touch) in [(0.45, ContactLaw::frictionless(PENALTY).unwrap()), (0.0, rough)] {
            let name = format!("{method:?}, nu {poisson}");
            let law = Law::NeoHookean(NeoHookean::new(YOUNG, poisson).unwrap());
            let (path, plates) = press(&model, &law, touch, &name);
            let pressures = pressures(&model, &path, &plates);
            assert!(spread(&pressures) < 1e-9, "{name}: pressures differ by {:e}", spread(&pressures));
            let [below, above] = path.steps.last().unwrap().tools[..] else { panic!("{name}") };
            let force = pressures[0] * SIZE.x * SIZE.y;
            for (state, sign) in [(below, -1.0), (above, 1.0)] {
                let gap = (state.force - Vector3::z() * (sign * force)).norm() / force;
                assert!(gap < 1e-9, "{name}: force {} for {force}", state.force);
                assert!((state.penetration * PENALTY / pressures[0] - 1.0).abs() < 1e-9, "{name}");
            }
        }
    }
}

/// Full steps alone would cycle between sticking and sliding points here and never progress.
#[test]
fn the_mixed_method_starts_under_stiff_friction() {
    let model = Model::new(
        box_mesh(CellKind::Tet10, Point3::origin(), SIZE, [2, 2, 1], [1.0; 3], None).unwrap(),
        Projection::Mixed,
    );
    let rough = ContactLaw::coulomb(5e9, 0.3, 1e9).unwrap();
    for poisson in [0.45, 0.495] {
        let law = Law::NeoHookean(NeoHookean::new(YOUNG, poisson).unwrap());
        let path = press(&model, &law, rough, &format!("nu {poisson}")).0;
        let [below, above] = path.steps.last().unwrap().tools[..] else { panic!("nu {poisson}") };
        let gap = (below.force.z + above.force.z).abs() / above.force.z;
        assert!(gap < 1e-9, "nu {poisson}: {} {}", below.force, above.force);
        // There is a solve for every assembly and for every trial judged by it, and a force evaluation for
        // every state.
        let moved = path.steps.iter().flat_map(|s| &s.iterations).filter(|i| i.length > 0.0).count() as u64;
        let cut = path.steps.iter().flat_map(|s| &s.iterations).any(|i| i.length > 0.0 && i.length < 1.0);
        let work = path.work;
        assert!(cut && work.factorisations >= work.assemblies, "{work:?}");
        assert!(work.solves > work.assemblies && work.forces > work.assemblies, "{work:?}");
        // Full steps were tried first and failed; they are counted too.
        assert!(work.assemblies > moved, "{work:?} for {moved}");
    }
}

#[test]
fn friction_holds_the_sides_and_forces_balance() {
    for method in METHODS {
        let model = Model::block(method, [3, 2, 2]);
        let name = format!("{method:?}");
        let law = Law::NeoHookean(NeoHookean::new(YOUNG, 0.45).unwrap());
        let free = press(&model, &law, ContactLaw::frictionless(PENALTY).unwrap(), &name).0;
        let rough = press(&model, &law, ContactLaw::coulomb(PENALTY, 0.3, 0.1 * PENALTY).unwrap(), &name).0;
        let force = |path: &StaticPath, k: usize| path.steps.last().unwrap().tools[k].force;
        let (below, above) = (force(&rough, 0), force(&rough, 1));
        // The symmetry planes carry forces along x and y; no other support carries z.
        assert!((below.z + above.z).abs() < 1e-9 * above.z, "{name}: {below} {above}");
        // The tissue moves outwards along +x and +y and drags the plates along, inside the cone.
        for force in [below, above] {
            let sideways = force.x.hypot(force.y);
            assert!(force.x > 0.0 && force.y > 0.0, "{name}: {force}");
            assert!(sideways > 0.05 * above.z && sideways <= 0.3 * above.z, "{name}: {force}");
        }
        // Friction makes the block stiffer, but less so than sides that never slip.
        let bonded =
            press(&model, &law, ContactLaw::coulomb(PENALTY, 100.0, 0.1 * PENALTY).unwrap(), &name).0;
        let [free, rough, bonded] = [&free, &rough, &bonded].map(|p| force(p, 1).z);
        assert!(1.01 * free < rough && 1.01 * rough < bonded, "{name}: {free} {rough} {bonded}");
    }
}
