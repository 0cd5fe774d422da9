//! Snapshots of the texts that users read: lists, help, plans, the JSON of a run, messages.
//!
//! `INSTA_UPDATE=always cargo test -p tissuebench-harness --test snapshots` stores the current output; `git
//! diff` shows the changes.

mod common;

use std::path::Path;
use std::process::Command;

use common::{BLOCK, PRESSED, moving};
use serde_json::Value;
use tempfile::TempDir;

/// Output of a command in a folder, and its exit code if it fails.
fn printed(folder: &Path, args: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tissuebench"));
    let output = command.args(args).current_dir(folder).env_remove("COLUMNS").output().unwrap();
    let [stdout, stderr] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert!(!stderr.contains("panicked"), "{args:?}: {stderr}");
    let code = output.status.code().unwrap();
    let end = if code == 0 { String::new() } else { format!("exit code {code}\n") };
    let text = format!("{stdout}{stderr}{end}");
    text.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// Creates a temporary folder with files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, text)| std::fs::write(dir.path().join(name), text).unwrap());
    dir
}

#[test]
fn the_list_names_everything() {
    insta::assert_snapshot!("list", printed(folder(&[]).path(), &["list"]));
}

#[test]
fn every_verb_has_help() {
    let dir = folder(&[]);
    let verbs = [
        "init",
        "import",
        "run",
        "pick",
        "fields",
        "plan",
        "verify",
        "report",
        "baseline",
        "claims",
        "reference",
        "export",
        "adapter",
        "list",
        "schema",
        "mesh",
    ];
    let further = [
        vec!["mesh", "info"],
        vec!["mesh", "make"],
        vec!["mesh", "convert"],
        vec!["adapter", "check"],
        vec!["adapter", "run"],
    ];
    let all = std::iter::once(vec![]).chain(verbs.map(|verb| vec![verb])).chain(further);
    let help = |verb: Vec<&str>| {
        let text = printed(dir.path(), &[&verb[..], &["--help"]].concat());
        format!("## tissuebench {} --help\n\n{text}", verb.join(" "))
    };
    let text: Vec<String> = all.map(help).collect();
    insta::assert_snapshot!("help", text.join("\n"));
}

#[test]
fn each_procedure_has_a_plan() {
    let squeezed = PRESSED.replace("kind = \"static\", steps = 2", "KIND");
    let two = |text: &str| {
        text.lines()
            .filter(|l| !l.contains("mixed") && !l.contains("tet4-nodal"))
            .map(|l| format!("{l}\n"))
            .collect::<String>()
    };
    let dense = |text: &str| text.replace("poisson = 0.45", "poisson = 0.45, density = \"1000 kg/m^3\"");
    let block = |kind: &str| format!("{BLOCK}procedure = {{ kind = \"{kind}\" }}\n");
    let free = BLOCK.lines().filter(|l| !l.starts_with("load")).map(|l| format!("{l}\n")).collect::<String>();
    let vibrating = free
        .replace("poisson = 0.3", "poisson = 0.3, density = \"1000 kg/m^3\"")
        .replace("element = \"tet4\"", "element = \"tet4\", mass = \"lumped\"");
    let implicit = dense(&two(&squeezed))
        .replace("KIND", "kind = \"implicit-dynamic\", duration = \"20 ms\", steps = 4");
    for (kind, text) in [
        ("prepare", block("prepare")),
        ("linear", block("linear")),
        ("modes", format!("{vibrating}procedure = {{ kind = \"modes\" }}\n")),
        ("static", two(PRESSED)),
        ("explicit", moving(&two(PRESSED))),
        ("implicit-dynamic", implicit),
    ] {
        let dir = folder(&[("scene.toml", &text)]);
        insta::assert_snapshot!(format!("plan-{kind}"), printed(dir.path(), &["plan", "scene.toml"]));
    }
}

#[test]
fn a_run_prints_its_object() {
    let dir = folder(&[("block.toml", BLOCK)]);
    let text = printed(dir.path(), &["run", "block.toml", "--format", "json"]);
    let mut object: Value = serde_json::from_str(&text).unwrap();
    object["metrics"]["memory"]["value"] = "[of the machine]".into();
    // The value is known only on Linux.
    object["metrics"].as_object_mut().unwrap().remove("memory-process");
    // A residual at rounding level differs between processors.
    object["metrics"]["residual"]["value"] = "[rounding]".into();
    for phases in ["phases", "cpu_phases"] {
        object[phases]
            .as_object_mut()
            .unwrap()
            .values_mut()
            .for_each(|time| *time = "[of the machine]".into());
    }
    rounded(&mut object);
    insta::assert_snapshot!("run", serde_json::to_string_pretty(&object).unwrap());
}

/// Rounds every number to four digits, and numbers at rounding level to zero.
fn rounded(value: &mut Value) {
    match value {
        Value::Number(number) if number.is_f64() => {
            let number = number.as_f64().unwrap();
            *value = if number.abs() < 1e-9 { 0.0 } else { format!("{number:.3e}").parse().unwrap() }.into();
        }
        Value::Array(values) => values.iter_mut().for_each(rounded),
        Value::Object(values) => values.values_mut().for_each(rounded),
        _ => {}
    }
}

/// Faults of a scene: a description, and the text that is replaced in a valid scene. Faults that are found
/// while reading are in `cases/tests/bad`.
const SCENES: [(&str, &str, &str); 3] = [
    ("a support that touches nothing", "z == 0 mm", "z == 90 mm"),
    ("a body that can move", "fix = \"xyz\"", "fix = \"z\""),
    (
        "mistakes in several parts",
        "young = \"20 kPa\", poisson = 0.3 }\nsupport = [{ where = \"z == 0 mm\"",
        "young = 20, poisson = 0.3 }\nsupport = [{ on = \"zmin\"",
    ),
];

#[test]
fn mistakes_in_a_scene_are_explained() {
    let mut text = String::new();
    for (what, from, to) in SCENES {
        let scene = BLOCK.replacen(from, to, 1);
        assert_ne!(scene, BLOCK, "{what}");
        let dir = folder(&[("scene.toml", &scene)]);
        text += &format!("## {what}\n\n{}\n", printed(dir.path(), &["run", "scene.toml"]));
    }
    insta::assert_snapshot!("bad-scenes", text);
}

#[test]
fn a_mistake_in_a_study_is_explained() {
    let study = "title = \"Blocks\"\n[[run]]\nscene = \"block.toml\"\nmethods = [\"tet10\"]\n";
    let dir = folder(&[("block.toml", BLOCK), ("study.toml", study)]);
    insta::assert_snapshot!("bad-study", printed(dir.path(), &["verify", "study.toml", "--out", "out"]));
}

#[test]
fn mistakes_on_the_command_line_are_explained() {
    let dir = folder(&[("block.toml", BLOCK), ("organ.msh", "$MeshFormat\n")]);
    let mut text = String::new();
    for line in [
        "",
        "frobnicate",
        "run",
        "run block.toml --format yaml",
        "run block.toml --method tet5",
        "run no-such-scene.toml",
        "run block.toml --threads 0",
        "run block.toml --out block.toml",
        "run organ.msh",
        "list files",
        "verify no-such-study.toml",
        "verify --shard 3/2",
        "report no-such-results",
        "list lawz",
        "mesh info no-such-mesh.msh",
        "mesh info block.toml",
        "baseline no-such-results --check",
    ] {
        let args: Vec<&str> = line.split_whitespace().collect();
        text += &format!("## tissuebench {line}\n\n{}\n", printed(dir.path(), &args));
    }
    insta::assert_snapshot!("bad-command-lines", text);
}
