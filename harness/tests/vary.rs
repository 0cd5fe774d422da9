//! Uncertain inputs: samples, their statistics, shares of a study, and refusals.

mod common;

use common::{assert_fails, inside, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

/// A block pulled by a traction: `u = t L / E`.
const SCENE: &str = r#"
title = "A pulled block"
body = { shape = "box", size = ["10 mm", "10 mm", "10 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3 }
support = [{ on = "x-min", fix = "x" }, { on = "y-min", fix = "y" }, { on = "z-min", fix = "z" }]
load = [{ on = "z-max", traction = ["0 Pa", "0 Pa", "1 kPa"] }]
output = { means = [{ on = "z-max" }] }
method = [{ id = "hex8", family = "fem", element = "hex8", size = { cells = [2, 2, 2] } }]
check = [{ metric = "mean-z", at_least = "0.4999 mm", at_most = "0.5001 mm" }]

[vary]
samples = 24
of = ["mean-z"]
keys = { "material.young" = { lognormal = { mean = "20 kPa", sd = "2 kPa" } }, "body.size[2]" = { uniform = ["9 mm", "11 mm"] } }
check = [{ metric = "mean-z", statistic = "first", key = "material.young", at_least = 0.74, at_most = 0.76 }]
"#;

fn json(dir: &TempDir, path: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(dir.path().join(path)).unwrap()).unwrap()
}

#[test]
fn samples_give_statistics_tables_and_figures() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "block.toml", SCENE);
    let out = inside(&dir, "out");
    let done = tissuebench(&["vary", &scene, "--out", &out]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stdout.contains("mean displacement along z [m]: 24 of 24 samples"), "{}", done.stdout);
    assert!(done.stdout.contains("by chaos of degree"), "{}", done.stdout);
    let samples = json(&dir, "out/samples.json");
    let all = samples[0]["samples"].as_array().unwrap();
    assert_eq!(all.len(), 24);
    // Each sample is the scene with its own values, in the units of the scene.
    for sample in all {
        let value = |at: usize| sample["values"][at].as_f64().unwrap();
        let (length, young) = (value(0), value(1));
        let expected = 1e-3 * length / young;
        assert!((sample["results"][0].as_f64().unwrap() / expected - 1.0).abs() < 1e-9, "{sample}");
    }
    for file in
        ["tables/uncertainty.csv", "tables/sobol-indices.csv", "figures/sobol-indices-block-hex8-mean-z.png"]
    {
        assert!(dir.path().join("out/report").join(file).exists(), "{file}");
    }
    // Samples are not runs of the case.
    let records = std::fs::read_to_string(dir.path().join("out/records.csv")).unwrap();
    assert!(records.lines().filter(|line| line.contains(",mean,")).count() <= 3, "{records}");
    // All are stored.
    let again = tissuebench(&["vary", &scene, "--out", &out, "--resume"]);
    assert!(
        again.stderr.contains("25 of 25 runs were taken from stored results") || again.code == 0,
        "{}",
        again.stderr
    );
    assert_eq!(json(&dir, "out/samples.json"), samples);
}

#[test]
fn shares_and_isolated_runs_of_a_study_give_the_samples_of_one_run() {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "block.toml", SCENE);
    let study = write(&dir, "study.toml", "title = \"Blocks\"\n[[run]]\nscene = \"block.toml\"\n");
    let verify = |more: &[&str], out: &str| {
        let out = inside(&dir, out);
        let done = tissuebench(&[&["verify", &study, "--out", &out], more].concat());
        assert_eq!(done.code, 0, "{}", done.stderr);
        done
    };
    verify(&[], "whole");
    let whole = json(&dir, "whole/samples.json");
    let again = verify(&["--resume"], "whole");
    assert!(again.stderr.contains("25 of 25 runs were taken from stored results"), "{}", again.stderr);
    verify(&["--isolate"], "isolated");
    assert_eq!(json(&dir, "isolated/samples.json"), whole);
    let shares = ["1/2", "2/2"].map(|share| {
        let out = inside(&dir, &format!("share-{}", &share[..1]));
        let done = tissuebench(&["verify", &study, "--out", &out, "--shard", share]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        out
    });
    let merged = tissuebench(&["merge", &inside(&dir, "merged"), &shares[0], &shares[1]]);
    assert_eq!(merged.code, 0, "{}", merged.stderr);
    assert_eq!(json(&dir, "merged/samples.json"), whole);
    let shared: Vec<usize> = ["share-1", "share-2"]
        .map(|share| {
            json(&dir, &format!("{share}/samples.json"))[0]["samples"].as_array().map_or(0, Vec::len)
        })
        .to_vec();
    assert_eq!(shared.iter().sum::<usize>(), 24);
    assert!(shared.iter().all(|count| (8..=16).contains(count)), "{shared:?}");
}

#[test]
fn bounds_on_statistics_can_fail() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "block.toml", &SCENE.replace("at_least = 0.74, ", "at_least = 0.754, "));
    let done = tissuebench(&["vary", &scene, "--out", &inside(&dir, "out")]);
    assert_fails(&done, 1, "FAILED: block hex8 mean-z first of material.young");
}

#[test]
fn a_sample_that_the_scene_refuses_is_named_with_the_remedy() {
    let dir = tempfile::tempdir().unwrap();
    let normal = "\"material.poisson\" = { normal = { mean = 0.45, sd = 0.05 } }, ";
    let scene = write(&dir, "block.toml", &SCENE.replace("keys = { ", &format!("keys = {{ {normal}")));
    let done = tissuebench(&["vary", &scene, "--out", &inside(&dir, "out")]);
    assert_fails(&done, 2, "key 'vary.keys.material.poisson'");
    assert!(done.stderr.contains("of 24 the value material.poisson = 0.5"), "{}", done.stderr);
    assert!(done.stderr.contains("within = [low, high]"), "{}", done.stderr);
    let cut = normal.replace("} }", "}, within = [0.4, 0.49] }");
    let scene = write(&dir, "block.toml", &SCENE.replace("keys = { ", &format!("keys = {{ {cut}")));
    let done = tissuebench(&["vary", &scene, "--out", &inside(&dir, "out")]);
    assert_eq!(done.code, 0, "{}", done.stderr);
}

#[test]
fn a_sample_that_fails_is_counted_and_no_other_is_lost() {
    let dir = tempfile::tempdir().unwrap();
    let scene = SCENE
        .replace("law = \"linear\"", "law = \"neo-hookean\"")
        .replace("output =", "procedure = { kind = \"static\", steps = 2, iterations = 40 }\noutput =")
        .replace("\"1 kPa\"] }]", "\"-8 kPa\"] }]");
    // One iteration is too few at large strain.
    let keys = "keys = { \"procedure.iterations\" = { list = [1, 20, 40] }, ";
    let scene = scene
        .replace("keys = { ", keys)
        .replace("at_least = \"0.4999 mm\", at_most = \"0.5001 mm\"", "at_most = \"0 mm\"");
    let scene = scene.replace("at_least = 0.74, at_most = 0.76", "at_most = 1");
    let scene = write(&dir, "block.toml", &scene);
    let done = tissuebench(&["vary", &scene, "--out", &inside(&dir, "out")]);
    assert!(done.stdout.contains("16 of 24 samples"), "{}\n{}", done.stdout, done.stderr);
    let table = std::fs::read_to_string(dir.path().join("out/report/tables/uncertainty.csv")).unwrap();
    assert!(table.lines().nth(1).unwrap().contains(",24,8,"), "{table}");
}

#[test]
fn a_run_of_a_scene_with_uncertain_inputs_runs_it_as_written() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "block.toml", SCENE);
    let done = tissuebench(&["run", &scene]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stderr.contains("runs as written; tissuebench vary"), "{}", done.stderr);
    let plain = write(&dir, "plain.toml", SCENE.split("[vary]").next().unwrap());
    assert_fails(&tissuebench(&["vary", &plain, "--out", &inside(&dir, "out")]), 2, "has no [vary]");
    let few = tissuebench(&["vary", &scene, "--samples", "3", "--out", &inside(&dir, "out")]);
    assert_fails(&few, 2, "give 20 to 100000");
}

/// A block bent by a shear, of which the coarsest mesh has an error of a tenth, as large as the spread.
#[test]
fn the_first_method_that_is_fine_enough_is_sampled() {
    let dir = tempfile::tempdir().unwrap();
    let method = |element: &str, n: usize| {
        format!(
            "{{ id = \"{element}-{n}\", family = \"fem\", element = \"{element}\", size = {{ cells = [{n}, {n}, {n}] }} }},"
        )
    };
    let methods = [method("hex8", 2), method("hex8", 4), method("hex20", 4), method("hex20", 6)].concat();
    let scene = format!(
        "title = \"A bent block\"\n\
         body = {{ shape = \"box\", size = [\"10 mm\", \"10 mm\", \"10 mm\"] }}\n\
         material = {{ law = \"linear\", young = \"20 kPa\", poisson = 0.3 }}\n\
         support = [{{ on = \"z-min\", fix = \"xyz\" }}]\n\
         load = [{{ on = \"z-max\", traction = [\"1 kPa\", \"0 Pa\", \"0 Pa\"] }}]\n\
         output = {{ estimate = true }}\nmethod = [{methods}]\n\
         [vary]\nsamples = 24\nof = [\"strain-energy\"]\n\
         keys = {{ \"material.young\" = {{ normal = {{ mean = \"20 kPa\", sd = \"6 kPa\" }}, within = [\"10 kPa\", \"30 kPa\"] }} }}\n"
    );
    let scene = write(&dir, "bent.toml", &scene);
    let done = tissuebench(&["vary", &scene, "--fine-enough", "--out", &inside(&dir, "out")]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stderr.contains("hex8-2: the numerical error is"), "{}", done.stderr);
    let samples = json(&dir, "out/samples.json");
    assert_eq!(samples.as_array().unwrap().len(), 1);
    let taken = samples[0]["method"].as_str().unwrap();
    assert_eq!(taken, "hex20-4", "{}", done.stderr);
    assert!(done.stderr.contains("hex20-4 is fine enough"), "{}", done.stderr);
    let without = tissuebench(&[
        "vary",
        &scene,
        "--set",
        "output.estimate=false",
        "--fine-enough",
        "--out",
        &inside(&dir, "out"),
    ]);
    assert_fails(&without, 2, "needs output.estimate = true");
}
