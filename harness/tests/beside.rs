//! Comparisons other than with the reference: with another method, or with the same cloud under another
//! integration rule.

mod common;

use cases::scene::{self, Scene};
use common::BLOCK;
use tissuebench_harness::outcome::{Metric, Outcome};
use tissuebench_harness::run::Repeats;
use tissuebench_harness::run::{Group, RunOptions};

const CLOUD: &str = r#", { id = "efg", family = "efg", size = { cells = [3, 3, 2] }, kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = { rule = "gauss", points = 4 }, essential = "penalty" }]
output = { transfer = { to = "reference-nodes", scheme = "inverse-distance" }, beside = "tet4" }
"#;

fn outcomes(reference: &str) -> Vec<Outcome> {
    split(reference, None)
}

fn split(reference: &str, points: Option<usize>) -> Vec<Outcome> {
    let text = format!("{}{CLOUD}reference = {reference}\n", BLOCK.trim_end().trim_end_matches(']'));
    let scene: Scene = scene::parse(&text, "beside.toml").unwrap();
    let group = Group::new(&scene, None, Repeats { most: 1, seconds: 0.0 }).unwrap();
    let extras = RunOptions {
        split: points.map(|points| scene::Integration::Gauss { points }),
        ..RunOptions::default()
    };
    let run = |m: &scene::Method| group.run(&group.scenario(m.clone(), 0), extras);
    scene.methods.iter().map(|m| run(m).unwrap_or_else(|bad| panic!("{}", bad.failure))).collect()
}

fn value(metrics: &[Metric], name: &str) -> f64 {
    metrics.iter().find(|m| m.name() == name).unwrap_or_else(|| panic!("{name}")).value
}

#[test]
fn beside_the_reference_itself_both_differences_are_one() {
    let runs = outcomes(r#"{ method = "tet4" }"#);
    for run in &runs {
        for name in ["rms-x", "rms-y", "rms-z", "rms"] {
            let one = value(&run.metrics, name);
            let other = value(&run.metrics, &format!("beside-{name}"));
            assert_eq!(one, other, "{} {name}", run.identity.method);
            assert_eq!(one == 0.0, run.identity.method == "tet4", "{} {name}", run.identity.method);
        }
    }
    let efg = runs.iter().find(|r| r.identity.method == "efg").unwrap();
    let tet4 = runs.iter().find(|r| r.identity.method == "tet4").unwrap();
    for name in ["relative-rms", "relative-max", "peak-error"] {
        assert_eq!(value(&tet4.metrics, name), 0.0, "{name}");
    }
    // The reference's largest displacement is that of tet4.
    let of = |run: &Outcome, name: &str| value(&run.metrics, name);
    let peak = (of(efg, "max") / of(tet4, "max") - 1.0).abs();
    assert!(peak > 0.0 && (of(efg, "peak-error") - peak).abs() < 1e-12);
    let largest = of(efg, "max-error") / of(tet4, "max");
    assert!((of(efg, "relative-max") / largest - 1.0).abs() < 1e-12);
    let carried = &efg.transfers[0].metrics;
    for axis in ["-x", "-y", "-z", ""] {
        let of = |name: &str| value(carried, &format!("{name}{axis}"));
        assert_eq!(of("rms"), of("beside-rms"));
        assert_eq!(of("transfer-only-rms"), of("beside-transfer-rms"));
        assert!(of("beside-transfer-rms") > 0.0);
    }
}

#[test]
fn a_finer_reference_leaves_the_difference_to_the_other_method() {
    let (one, two) = (
        outcomes(r#"{ method = "tet4" }"#),
        outcomes(r#"{ method = "tet4", size = { cells = [6, 6, 4] } }"#),
    );
    // The comparison points depend on the reference's nodes. At its own nodes tet4 is still compared with
    // itself.
    let efg = |runs: &[Outcome]| runs.iter().find(|r| r.identity.method == "efg").unwrap().clone();
    let (one, two) = (efg(&one), efg(&two));
    assert_ne!(value(&one.metrics, "rms"), value(&two.metrics, "rms"));
    let (rms, beside) = (value(&two.metrics, "rms"), value(&two.metrics, "beside-rms"));
    let apart = value(&two.transfers[0].metrics, "beside-rms");
    assert!(rms > 0.0 && beside > 0.0 && rms != beside && apart != beside, "{rms} {beside} {apart}");
}

#[test]
fn integrated_alike_there_is_no_error_of_integration_and_all_is_discretisation() {
    let runs = split(r#"{ method = "tet4", size = { cells = [6, 6, 4] } }"#, Some(4));
    let of = |method: &str| runs.iter().find(|r| r.identity.method == method).unwrap();
    for axis in ["-x", "-y", "-z", ""] {
        let of = |name: &str| value(&of("efg").metrics, &format!("{name}{axis}"));
        assert_eq!((of("integration-rms"), of("discretisation-rms")), (0.0, of("rms")));
    }
    assert_eq!(of("tet4").metric("integration-rms"), None, "elements have one rule");
}

#[test]
fn four_points_are_nearer_to_fourteen_and_these_to_forty_six() {
    let apart = |points: usize| {
        let runs = split(r#"{ method = "tet4", size = { cells = [6, 6, 4] } }"#, Some(points));
        let efg = runs.iter().find(|r| r.identity.method == "efg").unwrap();
        let of = |name: &str| value(&efg.metrics, name);
        let (rms, left, rule) = (of("rms"), of("discretisation-rms"), of("integration-rms"));
        // The differences of three fields satisfy the triangle inequality.
        assert!(rms <= left + rule && left <= rms + rule && rule <= rms + left, "{rms} {left} {rule}");
        (rule, left)
    };
    let ((one, _), (fourteen, coarse), (most, fine)) = (apart(1), apart(14), apart(46));
    assert!(one > 2.0 * most, "one point is far from four: {one} {most}");
    assert!(fourteen > 0.0 && (coarse - fine).abs() < 0.2 * most, "{fourteen} {most}: {coarse} {fine}");
}
