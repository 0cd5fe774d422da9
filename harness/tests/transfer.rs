//! Transfer schemes by name in a scene, with their settings.

mod common;

use cases::scene::{self, Scene};
use common::BLOCK;
use interp::Scheme;
use tissuebench_harness::outcome::{Metric, SchemeSettings, Transfer};
use tissuebench_harness::run::Repeats;
use tissuebench_harness::run::{Group, RunOptions};

/// Transfers the displacement of a cloud on the nodes of a mesh to the given targets, by the given schemes.
fn transfers(targets: &str, schemes: &[String]) -> Vec<Transfer> {
    let cloud = r#", { id = "efg", family = "efg", size = { cells = [4, 4, 2] }, kernel = "cubic-spline", support_scale = 1.6, basis = "linear", integration = { rule = "gauss", points = 4 }, essential = "penalty" }]"#;
    let list: Vec<String> =
        schemes.iter().map(|s| format!("{{ to = \"{targets}\", scheme = {s} }}")).collect();
    let text = format!(
        "{}{cloud}\nreference = {{ method = \"tet4\", size = {{ cells = [5, 5, 3] }} }}\n[output]\n\
         probes = [[\"9 mm\", \"11 mm\", \"7 mm\"], [\"41 mm\", \"11 mm\", \"7 mm\"]]\ntransfer = [{}]\n",
        BLOCK.trim_end().trim_end_matches(']'),
        list.join(", ")
    );
    let scene: Scene = scene::parse(&text, "transfer.toml").unwrap_or_else(|bad| panic!("{bad:?}"));
    let group = Group::new(&scene, None, Repeats { most: 1, seconds: 0.0 }).unwrap();
    let method = scene.methods.iter().find(|m| m.id == "efg").unwrap();
    let run = group.run(&group.scenario(method.clone(), 0), RunOptions::default());
    run.unwrap_or_else(|bad| panic!("{}", bad.failure)).transfers
}

fn value(metrics: &[Metric], name: &str) -> f64 {
    metrics.iter().find(|m| m.name() == name).unwrap_or_else(|| panic!("{name}")).value
}

#[test]
fn every_scheme_runs_by_its_name() {
    let known: Vec<&str> = interp::SCHEMES.iter().map(|entry| entry.name).collect();
    let list: Vec<String> = known.iter().map(|name| format!("\"{name}\"")).collect();
    let transfers = transfers("reference-nodes", &list);
    assert_eq!(transfers.len(), known.len() + 1, "and the cloud's own rows");
    for (transfer, scheme) in transfers.iter().zip(Scheme::all()) {
        assert_eq!(transfer.scheme, scheme.name());
        let linear = value(&transfer.metrics, "linear-rms");
        // The field is about 1e-3 m. Schemes that are not exact have errors of at least 1e-5 m on this cloud.
        assert_eq!(linear < 1e-15, scheme.exact_degree() >= Some(1), "{scheme:?}: {linear:e} m");
        assert!(value(&transfer.metrics, "rms") > 0.0);
        assert_eq!(value(&transfer.metrics, "outside"), 0.0, "{scheme:?}");
    }
}

#[test]
fn settings_reach_the_schemes_and_the_records() {
    let list = [
        "\"mls-modified\", support_scale = 1.8",
        "\"multiquadric\", shape = 0.5",
        "\"gaussian\", shape = 0.9, polynomial = false",
        "\"wendland-c2\", support_scale = 3",
        "\"wendland-c2\", support_scale = 3, polynomial = false",
        "\"natural-neighbour\"",
    ];
    let transfers = transfers("probes", &list.map(String::from));
    let settings: Vec<SchemeSettings> = transfers.iter().map(|t| t.settings).collect();
    let none = SchemeSettings::default();
    let scaled = |scale: f64| SchemeSettings { support_scale: Some(scale), ..none };
    assert_eq!(
        settings[..6],
        [
            scaled(1.8),
            SchemeSettings { shape: Some(0.5), ..none },
            SchemeSettings { shape: Some(0.9), polynomial: Some(false), ..none },
            SchemeSettings { polynomial: Some(true), ..scaled(3.0) },
            SchemeSettings { polynomial: Some(false), ..scaled(3.0) },
            none,
        ]
    );
    let linear: Vec<bool> = transfers[..6].iter().map(|t| value(&t.metrics, "linear-rms") < 1e-15).collect();
    assert_eq!(linear, [true, true, false, true, false, true]);
    // The second probe lies 1 mm outside the body.
    let outside: Vec<f64> = transfers[..6].iter().map(|t| value(&t.metrics, "outside")).collect();
    assert_eq!(outside, [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
}
