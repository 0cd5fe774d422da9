//! Agreement of plans and counters: a skipped stage does nothing, and a stage that runs does something.

mod common;

use std::collections::BTreeSet;
use std::path::Path;

use cases::scene::{self, Scene};
use common::{BLOCK, PRESSED, cases, inside, moving, write};
use tissuebench_harness::outcome::Counters;
use tissuebench_harness::outcome::Outcome;
use tissuebench_harness::run::Repeats;
use tissuebench_harness::run::{Group, RunOptions};
use tissuebench_harness::study::StudyPlan;
use tissuebench_harness::study::VerifyArgs;

fn runs(scene: &Scene, repeats: usize) -> Vec<Outcome> {
    let group = Group::new(scene, None, Repeats { most: repeats, seconds: 60.0 }).unwrap();
    let run = |m: &scene::Method| group.run(&group.scenario(m.clone(), 0), RunOptions::default());
    scene.methods.iter().map(|m| run(m).unwrap_or_else(|bad| panic!("{}", bad.failure))).collect()
}

/// Compares every stage with its counter; returns the pairs (stage, ran).
fn check(outcome: &Outcome) -> BTreeSet<(&'static str, bool)> {
    let who = format!("{} {}", outcome.identity.case, outcome.identity.method);
    for stage in outcome.plan.stages() {
        let count = outcome.counters.of(stage.stage);
        assert_eq!(count > 0, stage.ran, "{who}: {stage:?}, counted {count}");
    }
    outcome.plan.stages().iter().map(|stage| (stage.stage.name(), stage.ran)).collect()
}

/// Scene with features that no small scene of the project has: two materials, multipliers, a method as
/// reference, a transfer scheme.
fn all_at_once() -> Scene {
    let parts = [
        BLOCK.trim_end_matches("]\n"),
        r#", { id = "efg", family = "efg", size = { cells = [4, 4, 2] }, kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = { rule = "gauss", points = 4 }, essential = "multipliers" }]
"#,
        r#"region = [{ name = "soft", where = "x <= 20 mm", material = { law = "linear", young = "5 kPa", poisson = 0.3 } }]
"#,
        r#"reference = { method = "tet4", size = { cells = [4, 4, 2] } }
"#,
        r#"output = { transfer = { to = "reference-nodes", scheme = "shepard" } }
"#,
    ];
    scene::parse(&parts.concat().replace("where = \"z == 0 mm\"", "on = \"z-min\""), "all-at-once.toml")
        .unwrap()
}

#[test]
fn what_a_plan_skips_is_not_done_and_what_it_runs_is() {
    let mut met = BTreeSet::new();
    for name in [
        "bar-wave-explicit",
        "bar-wave-implicit",
        "cantilever",
        "cloud-cost",
        "compression",
        "first",
        "modes-cube",
        "patch-displacement",
        "patch-large-strain",
        "patch-traction",
        "plates",
        "punch",
        "pure-bending",
        "quadratic-patch",
        "relaxation",
        "rigid-motion",
        "saint-venant",
        "thick-sphere",
    ] {
        let scene = scene::load(Path::new(&cases(&format!("{name}.toml")))).unwrap();
        runs(&scene, 1).iter().for_each(|outcome| met.extend(check(outcome)));
    }
    runs(&all_at_once(), 1).iter().for_each(|outcome| met.extend(check(outcome)));
    let rubbed = PRESSED.replace("/mm\"", "/mm\", friction = 0.1, stick = \"1 MPa/mm\"");
    let moved = moving(PRESSED);
    for text in [PRESSED, rubbed.as_str(), moved.as_str()] {
        let scene = scene::parse(text, "pressed.toml").unwrap();
        runs(&scene, 1).iter().for_each(|outcome| met.extend(check(outcome)));
    }
    // Each stage that may run or be skipped occurred in both states.
    for stage in [
        "refinement",
        "supports",
        "volumetric projection",
        "elasticity tensor per region",
        "supports by elimination",
        "weak supports",
        "transfer",
        "transfer schemes",
        "Newton iterations",
        "contact search",
        "friction history",
        "mass",
        "stiffness",
        "factorisation",
        "time steps",
    ] {
        assert!(met.contains(&(stage, true)) && met.contains(&(stage, false)), "{stage}: {met:?}");
    }
}

#[test]
fn a_plan_told_beforehand_is_that_of_the_run() {
    let load = |name| scene::load(Path::new(&cases(name))).unwrap();
    for scene in [load("first.toml"), load("pure-bending.toml"), all_at_once()] {
        let name = scene.file();
        let before = Group::unreferenced(&scene, Repeats { most: 1, seconds: 0.0 }).unwrap();
        let group = Group::new(&scene, None, Repeats { most: 1, seconds: 0.0 }).unwrap();
        for method in scene.methods.iter().take(2) {
            let (told, size) = before.plan(&before.scenario(method.clone(), 0)).unwrap();
            let outcome = group.run(&group.scenario(method.clone(), 0), RunOptions::default()).unwrap();
            assert_eq!(told, outcome.plan, "{name}");
            assert_eq!((size.nodes, size.elements), (outcome.size.nodes, outcome.size.elements), "{name}");
        }
    }
}

#[test]
fn a_run_factors_once_however_often_it_is_timed() {
    let scene = scene::load(Path::new(&cases("first.toml"))).unwrap();
    let (once, often) = (runs(&scene, 1), runs(&scene, 4));
    for (once, often) in once.iter().zip(&often) {
        assert_eq!((once.counters.assemblies, once.counters.factorisations, once.counters.solves), (1, 1, 1));
        assert_eq!(once.counters, often.counters);
    }
    // Loads need only values. Gradients are evaluated only on weakly imposed supports.
    let [elements, cloud] = [once[0].counters, once[1].counters];
    assert!(elements.surface_rows > 0 && elements.flux_rows == 0, "{elements:?}");
    assert!(cloud.surface_rows > 0 && cloud.flux_rows > 0 && cloud.multiplier_rows == 0, "{cloud:?}");
}

#[test]
fn a_tool_out_of_reach_is_skipped_by_every_search() {
    // A ball that ends 20 mm above the block.
    let far = format!(
        r#"{BLOCK}procedure = {{ kind = "static" }}
tool = [{{ name = "ball", shape = "sphere", radius = "5 mm", at = ["20 mm", "20 mm", "50 mm"], along = [0, 0, -1], drive = {{ closure = "5 mm" }}, penalty = "5 MPa/mm" }}]
"#
    );
    for (text, skips) in [(PRESSED, false), (far.as_str(), true)] {
        let scene = scene::parse(text, "pressed.toml").unwrap();
        for outcome in runs(&scene, 1) {
            let work = outcome.counters;
            let tools = scene.tools.len() as u64;
            assert!(work.contact_evaluations >= tools * work.newton_iterations, "{work:?}");
            assert_eq!(work.contact_skips, if skips { work.contact_evaluations } else { 0 }, "{work:?}");
            assert!(work.friction_points == 0 && work.contact_points > 0, "{work:?}");
            // An iteration solves once, with its own tangent or with the previous tangent.
            assert!(work.newton_iterations > 0 && work.solves >= work.newton_iterations, "{work:?}");
            assert!(work.factorisations > 0 && work.factorisations >= work.assemblies, "{work:?}");
        }
    }
}

/// Counters of a study of one run.
fn work(study: &str, dir: &tempfile::TempDir, resume: bool) -> Counters {
    let plan = StudyPlan::new(scene::load_study(Path::new(study)).unwrap()).unwrap();
    let out = inside(dir, "out").into();
    let args = VerifyArgs { resume, out, ..VerifyArgs::of(Path::new(study)) };
    let finished = plan.execute(&args);
    assert!(finished.ran == 1 && finished.failed.is_empty() && !finished.set.records.is_empty());
    finished.counters
}

#[test]
fn stored_runs_do_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let reference = r#"reference = { method = "tet4", size = { cells = [4, 4, 2] } }"#;
    let scene = write(&dir, "block.toml", &format!("{BLOCK}\n{reference}\n"));
    let study = write(&dir, "study.toml", &format!("title = \"One\"\n[[run]]\nscene = '{scene}'\n"));
    // Four solutions: the method, its reference, and for the reference's own error a coarser mesh and
    // second-order elements.
    assert_eq!(work(&study, &dir, false).factorisations, 4);
    assert_eq!(work(&study, &dir, true), Counters::default());
    assert_eq!(work(&study, &dir, false).factorisations, 4);
}

#[test]
fn stored_runs_are_kept_until_a_shared_method_of_their_scene_changes() {
    let dir = tempfile::tempdir().unwrap();
    let shared = "[[method]]\nid = 'fine'\nfamily = 'fem'\nelement = 'tet4'\nsize = { cells = [4, 4, 2] }\n";
    let other = "[[method]]\nid = 'hex8'\nfamily = 'fem'\nelement = 'hex8'\n";
    write(&dir, "methods.toml", shared);
    let taken = BLOCK.replace("method = [", "reference = { method = 'fine' }\nmethod = [{ use = 'fine' }, ");
    let scene = write(&dir, "block.toml", &format!("methods_from = 'methods.toml'\n{taken}"));
    let study = format!("title = 'One'\n[[run]]\nscene = '{scene}'\nmethods = ['tet4']\n");
    let study = write(&dir, "study.toml", &study);
    assert_eq!(work(&study, &dir, true).factorisations, 4);
    assert_eq!(work(&study, &dir, true), Counters::default());
    // The scene does not use the changed method.
    write(&dir, "methods.toml", &format!("{shared}{other}"));
    assert_eq!(work(&study, &dir, true), Counters::default());
    // The scene uses the changed method as its reference.
    write(&dir, "methods.toml", &shared.replace("[4, 4, 2]", "[6, 6, 3]"));
    assert_eq!(work(&study, &dir, true).factorisations, 4);
}
