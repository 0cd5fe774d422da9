//! The command line as scripts see it: stdout, stderr and exit codes of the built program.

mod common;

use common::{BLOCK, assert_fails, cases, tissuebench, without, write};
use serde_json::Value;

const KEYS: [&str; 18] = [
    "cpu_phases",
    "dofs",
    "elements",
    "format",
    "free_norm",
    "linear_solver",
    "method",
    "metrics",
    "nodes",
    "phases",
    "plan",
    "probes",
    "scene",
    "status",
    "supports",
    "tools",
    "warnings",
    "work",
];

#[test]
fn run_prints_one_object_per_method_and_nothing_else() {
    let done = tissuebench(&["run", &cases("first.toml"), "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let objects: Vec<Value> = done.stdout.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    let methods: Vec<&str> = objects.iter().map(|o| o["method"].as_str().unwrap()).collect();
    assert_eq!(methods, ["tet10", "efg"]);
    for object in &objects {
        let keys: Vec<&str> = object.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(keys, KEYS);
        assert_eq!((&object["scene"], &object["status"]), (&"first".into(), &"ok".into()));
        assert!(["nodes", "elements", "dofs"].iter().all(|key| object[key].as_u64().unwrap() > 0));
        assert_eq!(object["tools"], Value::Array(vec![]));
        for (name, metric) in object["metrics"].as_object().unwrap() {
            let metric = metric.as_object().unwrap();
            assert!(metric.len() == 2 && metric["unit"].is_string(), "{name}");
            assert!(metric["value"].as_f64().unwrap().is_finite(), "{name}");
        }
        // The load is 1 kPa on 40 x 40 mm, directed down.
        let load = &object["metrics"]["load-z"];
        assert!((load["value"].as_f64().unwrap() + 1.6).abs() < 1e-12 && load["unit"] == "N");
        // The run needs a few thousand numbers. Buffers that a library keeps for good are not counted.
        let memory = object["metrics"]["memory"]["value"].as_f64().unwrap();
        assert!(memory > 1e4 && memory < 2e8, "{memory} B");
        for phase in ["prepare", "assemble", "factor", "solve", "total"] {
            assert!(object["phases"][phase].as_f64().unwrap() > 0.0, "{phase}");
        }
        let probes = object["probes"].as_array().unwrap();
        assert_eq!(probes.len(), 1);
        let row = |key: &str| -> Vec<f64> {
            probes[0][key].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
        };
        assert_eq!(row("x"), [0.02, 0.02, 0.02]);
        let (u, stress) = (row("u"), row("stress"));
        assert_eq!((u.len(), stress.len()), (3, 6));
        // The displacement is about p h / E, less because of the fixed base. The stress under the load agrees
        // with the load to a tenth on these meshes.
        assert!(u[2] < -0.5e-3 && u[2] > -1e-3, "{u:?}");
        assert!((stress[2] + 1e3).abs() < 100.0, "{stress:?}");
        for stage in object["plan"].as_array().unwrap() {
            let keys: Vec<&str> = stage.as_object().unwrap().keys().map(String::as_str).collect();
            assert_eq!(keys, ["ran", "stage", "why"]);
            assert!(stage["ran"].is_boolean() && stage["why"].as_str().is_some_and(|why| !why.is_empty()));
        }
    }
}

#[test]
fn a_run_that_fails_says_so_on_both_streams() {
    let dir = tempfile::tempdir().unwrap();
    let free = write(&dir, "free.toml", &without(BLOCK, "support"));
    let done = tissuebench(&["run", &free, "--format", "json"]);
    assert_fails(&done, 3, "rigid motion");
    let object: Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!(object["status"], "could-not-run");
    assert!(object["message"].as_str().unwrap().contains("rigid motion"));
    // Solver and norm are known only for a run that solved.
    assert!(
        KEYS.iter().all(|&key| matches!(key, "free_norm" | "linear_solver") != object.get(key).is_some())
    );
}

#[test]
fn bad_usage_is_2() {
    let dir = tempfile::tempdir().unwrap();
    let block = write(&dir, "block.toml", BLOCK);
    for (args, says) in [
        (vec!["frobnicate"], "unrecognized subcommand"),
        (vec!["run"], "required arguments"),
        (vec!["run", &block, "--format", "yaml"], "yaml"),
        (vec!["--threads", "0", "run", &block], "--threads"),
        (vec!["verify", "--shard", "3/2"], "K/N"),
        (vec!["run", "no-such-scene.toml"], "no-such-scene.toml: can't be read"),
        (vec!["plan", "no-such-scene.toml"], "no-such-scene.toml: can't be read"),
        (vec!["verify", "no-such-study.toml"], "no-such-study.toml: can't be read"),
        (vec!["report", "no-such-results"], "no-such-results"),
        (vec!["run", &block, "--method", "nope"], "no method 'nope'; known methods are tet4"),
        (vec!["plan", &block, "--method", "nope"], "no method 'nope'; known methods are tet4"),
    ] {
        assert_fails(&tissuebench(&args), 2, says);
    }
}

#[test]
fn bad_scenes_are_2_and_name_their_line() {
    let dir = tempfile::tempdir().unwrap();
    for (name, from, to, line, says) in [
        ("unknown-key", "poisson", "poison", 3, "'material.poison'"),
        ("negative-modulus", "20 kPa", "-20 kPa", 3, "'material.young': '-20 kPa'"),
        ("incompressible", "0.3", "0.5", 3, "'material.poisson': '0.5'"),
        ("not-a-number", "0.3", "nan", 3, "'material.poisson': 'nan'"),
        ("no-unit", "\"20 kPa\"", "20", 3, "'material.young': '20' has no unit"),
        ("no-unit-in-quotes", "1 kPa", "1", 5, "'load[0].pressure': '1' has no unit"),
        ("wrong-unit", "20 kPa", "20 mm", 3, "'material.young': '20 mm'"),
        ("unknown-word", "\"tet4\", size", "\"tet5\", size", 6, "'method[0].element': 'tet5'"),
        ("not-toml", "material =", "material", 3, "not valid TOML"),
    ] {
        let text = BLOCK.replacen(from, to, 1);
        assert_ne!(text, BLOCK, "{name}");
        let path = write(&dir, &format!("{name}.toml"), &text);
        for command in ["run", "plan"] {
            let done = tissuebench(&[command, &path]);
            assert_fails(&done, 2, says);
            assert!(done.stderr.contains(&format!("{path}:{line}:")), "{name}: {}", done.stderr);
            assert!(done.stdout.is_empty(), "{name}: {}", done.stdout);
        }
    }
}

#[test]
fn a_support_that_touches_nothing_is_2() {
    let dir = tempfile::tempdir().unwrap();
    let path = write(&dir, "apart.toml", &BLOCK.replace("z == 0 mm", "z == 90 mm"));
    assert_fails(&tissuebench(&["run", &path]), 2, "z == 90 mm");
}

#[test]
fn sound_scenes_ahead_of_the_solvers_are_3() {
    let dir = tempfile::tempdir().unwrap();
    for (name, text, says) in [
        ("free", without(BLOCK, "support"), "rigid motion is left free: translation along x"),
        ("sliding", BLOCK.replace("\"xyz\"", "\"z\""), "rotation about z"),
    ] {
        let path = write(&dir, &format!("{name}.toml"), &text);
        assert_fails(&tissuebench(&["run", &path]), 3, says);
    }
    // The unchanged block runs: the refusals above are due to the changes.
    assert_eq!(tissuebench(&["run", &write(&dir, "block.toml", BLOCK)]).code, 0);
}

#[test]
fn a_plan_says_what_is_skipped_and_why() {
    let done = tissuebench(&["plan", &cases("first.toml")]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let (elements, cloud) =
        done.stdout.split_once("\nefg: 300 nodes, 900 displacement unknowns before supports\n").unwrap();
    for (method, word, stage, why) in [
        (elements, "skip", "contact search", "no tool in the scene"),
        (elements, "skip", "mass", "static"),
        (elements, "skip", "Newton iterations", "linear"),
        (elements, "skip", "transfer", "Kronecker basis: nodal values are displacements"),
        (elements, "skip", "elasticity tensor per region", "homogeneous material: one tensor"),
        (elements, "run", "supports by elimination", "Kronecker basis"),
        (elements, "run", "factorisation", "multigrid levels for conjugate gradients"),
        (cloud, "run", "factorisation", "one, for all load levels"),
        (cloud, "skip", "contact search", "no tool in the scene"),
        (cloud, "skip", "mass", "static"),
        (cloud, "skip", "Newton iterations", "linear"),
        (cloud, "run", "transfer", "own shape functions"),
        (elements, "skip", "neighbour search", "the nodes of an element are its neighbours"),
        (cloud, "run", "neighbour search", "300 nodes"),
        (cloud, "run", "weak supports", "Nitsche"),
        (cloud, "skip", "supports by elimination", "nodal parameters are not displacements"),
    ] {
        let fits = |line: &str| {
            let rest = line.trim_start().strip_prefix(word).map(str::trim_start);
            let tail = rest.and_then(|rest| rest.strip_prefix(stage));
            tail.is_some_and(|tail| tail.contains(why))
        };
        assert!(method.lines().any(fits), "{word} {stage}: {why}\n{method}");
    }
    // Two materials need a tensor each. At a Poisson's ratio near 1/2, the projection is not skipped because
    // of the ratio.
    let dir = tempfile::tempdir().unwrap();
    let soft = r#"region = [{ name = "soft", where = "x <= 20 mm", material = { law = "linear", young = "5 kPa", poisson = 0.3 } }]"#;
    let two = write(&dir, "two.toml", &format!("{BLOCK}\n{soft}\n"));
    let plan = tissuebench(&["plan", &two]).stdout;
    assert!(plan.contains("elasticity tensor per region  2 regions"), "{plan}");
    let plan = tissuebench(&["plan", &write(&dir, "block.toml", BLOCK)]).stdout;
    assert!(plan.contains("nu = 0.3 < 0.45 does not lock"), "{plan}");
}
