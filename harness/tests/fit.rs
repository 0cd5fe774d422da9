//! Fits of constants to measured curves: results, files, warnings, checks of a study, and refusals.

mod common;

use common::{assert_fails, inside, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

/// A block pulled by a traction, of which the length and one side are measured.
const SCENE: &str = r#"
title = "A pulled block" # a comment
body = { shape = "box", size = ["10 mm", "10 mm", "10 mm"] }
material = { law = "neo-hookean", young = "15 kPa", poisson = 0.4 }
support = [{ on = "x-min", fix = "x" }, { on = "y-min", fix = "y" }, { on = "z-min", fix = "z" }]
load = [{ on = "z-max", traction = ["0 Pa", "0 Pa", "6 kPa"] }]
procedure = { kind = "static", steps = 4 }
output = { means = [{ on = "z-max" }, { on = "x-max" }] }
method = [{ id = "hex8", family = "fem", element = "hex8", size = { cells = [1, 1, 1] } }]
check = [{ metric = "load-carried", at_least = 1 }]

[fit]
data = "curve.csv"
keys = ["material.young"]
check = [{ statistic = "value", key = "material.young", at_least = "19.99 kPa", at_most = "20.01 kPa" }]
"#;

fn json(dir: &TempDir, path: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(dir.path().join(path)).unwrap()).unwrap()
}

/// Writes the curve of the scene with other values, from the records of a run.
fn curve(dir: &TempDir, scene: &str, of: &str, set: &[&str]) {
    // The scene needs a curve before it can be read.
    write(dir, "curve.csv", "load-carried,mean-z [mm]\n0.25,1\n0.5,2\n0.75,3\n1,4\n");
    let file = write(dir, "truth.toml", scene);
    let set: Vec<&str> = set.iter().flat_map(|set| ["--set", set]).collect();
    let done = tissuebench(&[&["run", &file, "--once", "--out", &inside(dir, "truth")], &set[..]].concat());
    assert_eq!(done.code, 0, "{}", done.stderr);
    let rows = std::fs::read_to_string(dir.path().join("truth/records.csv")).unwrap();
    let mut rows = rows.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = rows.next().unwrap();
    let column = |name: &str| head.iter().position(|title| *title == name).unwrap();
    let (quantity, component, index) = (column("quantity"), column("component"), column("index"));
    let (step, value) = (column("step"), column("value"));
    let (name, rest) = of.split_once('-').unwrap();
    let (axis, number) = rest.split_once('-').unwrap_or((rest, "1"));
    let mut text = format!("load-carried,{of} [m]\n");
    for row in rows.filter(|row| row[quantity] == name && row[component] == axis && row[index] == number) {
        if let Ok(step) = row[step].parse::<f64>() {
            text += &format!("{},{}\n", step / 4.0, row[value]);
        }
    }
    assert_eq!(text.lines().count(), 5, "{text}");
    write(dir, "curve.csv", &text);
}

#[test]
fn a_fit_finds_the_truth_and_writes_a_scene_that_runs() {
    let dir = tempfile::tempdir().unwrap();
    curve(&dir, SCENE, "mean-z", &["material.young=20 kPa"]);
    let scene = write(&dir, "block.toml", SCENE);
    let out = inside(&dir, "out");
    let done = tissuebench(&["fit", &scene, "--out", &out]);
    assert_eq!(done.code, 0, "{}\n{}", done.stdout, done.stderr);
    assert!(
        done.stdout.contains("block hex8, mean displacement along z [mm] of 4 points"),
        "{}",
        done.stdout
    );
    assert!(!done.stdout.contains("warning"), "{}", done.stdout);
    let fit = json(&dir, "out/fit.json");
    let value = fit[0]["constants"][0]["value"].as_f64().unwrap();
    // Newton's tolerance of 1e-8 limits the differences.
    assert!((value / 20.0 - 1.0).abs() < 1e-6, "{fit}");
    for file in [
        "tables/fit.csv",
        "tables/fit-quality.csv",
        "figures/fit-block-hex8.png",
        "figures/fit-block-hex8.csv",
    ] {
        assert!(dir.path().join("out/report").join(file).exists(), "{file}");
    }
    let fitted = std::fs::read_to_string(dir.path().join("out/fitted.toml")).unwrap();
    assert!(
        fitted.contains("# a comment") && fitted.contains(&format!("young = \"{value} kPa\"")),
        "{fitted}"
    );
    let again = tissuebench(&["fit", &inside(&dir, "out/fitted.toml"), "--out", &inside(&dir, "again")]);
    assert_eq!(again.code, 0, "{}", again.stderr);
    // The fit is the same at any number of threads and runs at a time.
    let other =
        tissuebench(&["fit", &scene, "--out", &inside(&dir, "other"), "--jobs", "2", "--threads", "1"]);
    assert_eq!(other.code, 0, "{}", other.stderr);
    assert_eq!(json(&dir, "other/fit.json"), fit);
    let run = tissuebench(&["run", &scene]);
    assert!(run.stderr.contains("runs as written; tissuebench fit"), "{}", run.stderr);
}

#[test]
fn a_study_checks_a_fit_isolated_or_not() {
    let dir = tempfile::tempdir().unwrap();
    curve(&dir, SCENE, "mean-z", &["material.young=20 kPa"]);
    write(&dir, "block.toml", SCENE);
    let study = write(&dir, "study.toml", "title = \"Blocks\"\n[[run]]\nscene = \"block.toml\"\n");
    let whole = tissuebench(&["verify", &study, "--out", &inside(&dir, "whole")]);
    assert_eq!(whole.code, 0, "{}", whole.stderr);
    let isolated = tissuebench(&["verify", &study, "--isolate", "--out", &inside(&dir, "isolated")]);
    assert_eq!(isolated.code, 0, "{}", isolated.stderr);
    assert_eq!(json(&dir, "isolated/fit.json"), json(&dir, "whole/fit.json"));
    write(&dir, "block.toml", &SCENE.replace("19.99 kPa", "20.005 kPa"));
    let failed = tissuebench(&["verify", &study, "--out", &inside(&dir, "failed")]);
    assert_fails(&failed, 1, "FAILED: block hex8 fit value of material.young");
    // Another curve is another fit.
    curve(&dir, SCENE, "mean-z", &["material.young=21 kPa"]);
    write(&dir, "block.toml", SCENE);
    let other = tissuebench(&["verify", &study, "--resume", "--out", &inside(&dir, "whole")]);
    assert_fails(&other, 1, "FAILED: block hex8 fit value of material.young");
}

#[test]
fn constants_that_only_their_ratio_determines_are_named() {
    let dir = tempfile::tempdir().unwrap();
    curve(&dir, SCENE, "mean-z", &["material.young=20 kPa"]);
    let keys = "keys = [\"material.young\", \"load[0].traction[2]\"]";
    let scene = SCENE
        .replace("keys = [\"material.young\"]", keys)
        .replace("check = [{ statistic", "# check = [{ statistic");
    let scene = write(&dir, "block.toml", &scene);
    let done = tissuebench(&["fit", &scene, "--out", &inside(&dir, "out")]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let warning = "warning: the curve does not distinguish material.young and load[0].traction[2]";
    assert!(done.stdout.contains(warning) && done.stdout.contains("correlation 1.0000"), "{}", done.stdout);
    assert!(done.stdout.contains("not determined"), "{}", done.stdout);
    let fit = json(&dir, "out/fit.json");
    let value = |k: usize| fit[0]["constants"][k]["value"].as_f64().unwrap();
    assert!((value(0) / value(1) / (20.0 / 6.0) - 1.0).abs() < 1e-5, "{fit}");
}

#[test]
fn bounds_wrong_models_and_failures_are_reported() {
    let dir = tempfile::tempdir().unwrap();
    curve(&dir, SCENE, "mean-z", &["material.young=20 kPa"]);
    let plain = SCENE.replace("check = [{ statistic", "# check = [{ statistic");
    let within = "keys = { \"material.young\" = { within = [\"10 kPa\", \"18 kPa\"] } }";
    let scene = write(&dir, "block.toml", &plain.replace("keys = [\"material.young\"]", within));
    let done = tissuebench(&["fit", &scene, "--out", &inside(&dir, "out")]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stdout.contains("material.young ends on its bound, 18 kPa"), "{}", done.stdout);
    // Stated deviations that the model misses by far.
    let file = dir.path().join("curve.csv");
    let rows = std::fs::read_to_string(&file).unwrap();
    let stated = rows
        .lines()
        .enumerate()
        .map(|(i, row)| row.to_string() + if i == 0 { ",sd [m]\n" } else { ",1e-6\n" });
    write(&dir, "curve.csv", &stated.collect::<String>());
    let done = tissuebench(&["fit", &scene, "--out", &inside(&dir, "out")]);
    assert!(done.stdout.contains("times the stated standard deviations"), "{}", done.stdout);
    // Data beyond the end of the loading.
    write(&dir, "curve.csv", &format!("{rows}1.2,0.006\n"));
    let scene = write(&dir, "block.toml", &plain);
    let done = tissuebench(&["fit", &scene, "--out", &inside(&dir, "out")]);
    assert_fails(
        &done,
        2,
        "has load-carried = 1.20000 1 in line 6, and the steps of the run cover 0 to 1.00000 1",
    );
    // A metric of the end only.
    write(&dir, "curve.csv", "load-carried,max [mm]\n0.5,1\n1,2\n");
    let done = tissuebench(&["fit", &scene, "--out", &inside(&dir, "out")]);
    assert_fails(&done, 2, "max has no history in the runs of this scene");
    // A start that does not run.
    write(&dir, "curve.csv", &rows);
    let few = ["--set", "procedure.iterations=1", "--out", &inside(&dir, "few")];
    let done = tissuebench(&[&["fit", &scene], &few[..]].concat());
    assert_eq!(done.code, 3, "{}", done.stderr);
    let without = write(&dir, "plain.toml", SCENE.split("[fit]").next().unwrap());
    assert_fails(&tissuebench(&["fit", &without, "--out", &inside(&dir, "plain")]), 2, "has no [fit]");
}
