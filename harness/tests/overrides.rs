//! `--set`, patterns of methods, quiet runs, interrupted runs, and the schemas of files that programs read.

mod common;

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

use common::{BLOCK, assert_fails, inside, objects, tissuebench, write};
use serde_json::Value;

#[test]
fn a_key_that_is_set_counts_as_that_of_the_file() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "block.toml", BLOCK);
    let changed = BLOCK.replace("20 kPa", "40 kPa").replace("cells = [2, 2, 1]", "cells = [2, 2, 2]");
    let changed = write(&dir, "changed.toml", &changed);
    let metrics = |args: &[&str]| {
        let done = tissuebench(&[&["run", "--once", "--format", "json"], args].concat());
        assert_eq!(done.code, 0, "{}", done.stderr);
        let mut metrics = objects(&done.stdout)[0]["metrics"].clone();
        metrics.as_object_mut().unwrap().retain(|name, _| !name.starts_with("memory"));
        metrics
    };
    let set = ["--set", "material.young=40 kPa", "--set", "method[tet4].size.cells=[2, 2, 2]"];
    assert_eq!(metrics(&[&[&scene[..]], &set[..]].concat()), metrics(&[&changed]));
    let out = inside(&dir, "out");
    let done = tissuebench(&[&["run", &scene, "--once", "--quiet", "--out", &out], &set[..]].concat());
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
    let text = std::fs::read_to_string(Path::new(&out).join("provenance.json")).unwrap();
    let provenance: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(provenance["set"][0], "material.young=40 kPa");
    assert_eq!(provenance["format"], 2);
    // A folder with a later format is refused.
    let later = text.replace("\"format\": 2", "\"format\": 1000");
    assert_ne!(later, text);
    std::fs::write(Path::new(&out).join("provenance.json"), later).unwrap();
    assert_fails(&tissuebench(&["report", &out]), 2, "has version 1000");
}

#[test]
fn a_wrong_override_is_named_as_it_was_given() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "block.toml", BLOCK);
    for (set, says) in [
        ("material.young=40", "--set material.young=40: key 'material.young': '40' has no unit"),
        ("materal.young=40 kPa", "--set materal.young=40 kPa: key 'materal'"),
        ("method[hex9].size.level=1", "[hex9] is out of range; the list has 1"),
        ("title.x=1", "is not a table"),
        ("material.poisson", "is not KEY=VALUE"),
    ] {
        for verb in ["run", "plan"] {
            assert_fails(&tissuebench(&[verb, &scene, "--set", set]), 2, says);
        }
    }
}

#[test]
fn methods_are_chosen_by_patterns() {
    let dir = tempfile::tempdir().unwrap();
    let more = "\"tet4\", size = { cells = [2, 2, 1] } },\n{ id = \"tet10\", family = \"fem\", element = \"tet10\", size = \
                { cells = [1, 1, 1] } }, { id = \"hex8\", family = \"fem\", element = \"hex8\", size";
    let scene = write(&dir, "block.toml", &BLOCK.replace("\"tet4\", size", more));
    let ids = |pattern: &str| {
        let done = tissuebench(&["run", &scene, "--once", "--format", "json", "--method", pattern]);
        objects(&done.stdout).iter().map(|o| o["method"].as_str().unwrap().to_string()).collect::<Vec<_>>()
    };
    assert_eq!(ids("tet*"), ["tet4", "tet10"]);
    assert_eq!(ids("hex8"), ["hex8"]);
    assert_fails(
        &tissuebench(&["run", &scene, "--method", "quad*"]),
        2,
        "no method 'quad*'; known methods are tet4",
    );
}

#[cfg(unix)]
#[test]
fn a_run_that_is_stopped_keeps_the_methods_that_have_ended() {
    let dir = tempfile::tempdir().unwrap();
    let more = "\"tet4\", size = { cells = [2, 2, 1] } },\n{ id = \"slow\", family = \"fem\", element = \"hex20\", size";
    let text = BLOCK
        .replace("\"tet4\", size", more)
        .replace("size = { cells = [2, 2, 1] } }]", "size = { cells = [60, 60, 30] } }]");
    let scene = write(&dir, "block.toml", &text);
    let out = inside(&dir, "out");
    let mut run = Command::new(env!("CARGO_BIN_EXE_tissuebench"))
        .args(["run", &scene, "--once", "--format", "json", "--out", &out])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The first object shows that the first method has ended.
    let mut first = String::new();
    BufReader::new(run.stdout.as_mut().unwrap()).read_line(&mut first).unwrap();
    let pid = run.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    let done = run.wait_with_output().unwrap();
    let stderr = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(5), "{stderr}");
    assert!(stderr.contains("interrupted before the end of slow"), "{stderr}");
    let failures = std::fs::read_to_string(Path::new(&out).join("failures.json")).unwrap();
    assert!(failures.contains("\"slow\"") && failures.contains("interrupted"), "{failures}");
    let records = std::fs::read_to_string(Path::new(&out).join("records.csv")).unwrap();
    assert!(records.contains("tet4") && !records.contains("slow"));
    assert_eq!(tissuebench(&["report", &out]).code, 0);
}

#[test]
fn what_programs_read_has_a_schema_with_its_version() {
    for (of, keys) in [
        ("run", vec!["format", "method", "metrics", "status", "warnings"]),
        ("events", vec!["at"]),
        ("provenance", vec!["format", "machine", "program", "scenes", "source"]),
    ] {
        let schema: Value = serde_json::from_str(&tissuebench(&["schema", of]).stdout).unwrap();
        assert!(keys.iter().all(|key| schema["properties"][key].is_object()), "{of}: {schema:#}");
    }
    let checks: Value = serde_json::from_str(&tissuebench(&["schema", "checks"]).stdout).unwrap();
    assert_eq!(checks["type"], "array");
    assert_fails(&tissuebench(&["schema", "pictures"]), 2, "pictures");
}
