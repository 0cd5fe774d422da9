//! Evidence for a reviewer and the description of a folder of results, after every command that writes one.

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use common::{PRESSED, assert_fails, cases, inside, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

/// A patch test with a bound that cannot hold, an exact solution at two levels, and a block between plates
/// with a probe outside of it.
fn study(dir: &TempDir) -> String {
    let block =
        PRESSED.replace("[[\"20 mm\", \"20 mm\", \"20 mm\"]] }", "[[\"20 mm\", \"20 mm\", \"21 mm\"]] }");
    assert_ne!(block, PRESSED);
    let block = write(dir, "pressed.toml", &block);
    let (patch, bending) = (cases("patch-displacement.toml"), cases("pure-bending.toml"));
    let text = format!(
        r#"title = "For a reviewer"

[[run]]
scene = '{patch}'
methods = ["tet4"]

[[run.check]]
metric = "l2"
at_least = 1

[[run]]
scene = '{bending}'
methods = ["hex8-mean"]
levels = [1, 2]
poisson = [0.3]

[[run.check]]
metric = "order-l2"
at_least = 0.5

[[run]]
scene = '{block}'
methods = ["hex8"]
"#
    );
    write(dir, "study.toml", &text)
}

/// Sizes of all files below a folder, by their relative paths, without locks.
fn sizes(root: &Path, dir: &Path, found: &mut BTreeMap<String, u64>) {
    for entry in fs::read_dir(dir).unwrap().map(|entry| entry.unwrap()) {
        let name = entry.path().strip_prefix(root).unwrap().to_str().unwrap().to_string();
        match entry.metadata().unwrap() {
            of if of.is_dir() => sizes(root, &entry.path(), found),
            of if !name.starts_with('.') => assert!(found.insert(name, of.len()).is_none()),
            _ => {}
        }
    }
}

/// Asserts that the description lists every file of a folder once, with its size.
#[track_caller]
fn assert_described(out: &str) {
    let mut expected = BTreeMap::new();
    sizes(Path::new(out), Path::new(out), &mut expected);
    assert!(expected.remove("ro-crate-metadata.json").is_some(), "{out} is not described");
    let text = fs::read_to_string(Path::new(out).join("ro-crate-metadata.json")).unwrap();
    let graph: Value = serde_json::from_str(&text).unwrap();
    let mut found = BTreeMap::new();
    for file in graph["@graph"].as_array().unwrap().iter().filter(|of| of["@type"] == "File") {
        let name = file["name"].as_str().unwrap().to_string();
        let size = file["contentSize"].as_str().unwrap().parse::<u64>().unwrap();
        assert!(found.insert(name.clone(), size).is_none(), "{name} twice");
    }
    assert_eq!(found, expected);
}

#[test]
fn a_reviewer_sees_what_passed_what_failed_and_what_is_blank() {
    let dir = tempfile::tempdir().unwrap();
    let (study, out) = (study(&dir), inside(&dir, "results"));
    let done = tissuebench(&["verify", &study, "--out", &out, "--quiet"]);
    assert_eq!(done.code, 1, "{}", done.stderr);
    assert_described(&out);
    let read = |end: &str| fs::read_to_string(format!("{out}/report/credibility.{end}")).unwrap();
    let text = read("md");
    // The overview has a row for each factor; each section has evidence or a blank.
    let sections: Vec<&str> = text.split("\n### ").skip(1).collect();
    assert_eq!(sections.len(), 19);
    for section in &sections {
        assert!(section.contains("> **Blank: "), "{section}");
    }
    let has = |words: &str| assert!(text.contains(words), "no '{words}' in {text}");
    has("| fail | patch-displacement | affine, patch | linear elasticity | tet4 |");
    has("| pass | pure-bending | pure-bending | linear elasticity | hex8-mean |");
    has("| probe-outside | pressed | hex8 |");
    has("| law | neo-hookean | pressed |");
    has("| stage | contact search | pressed |");
    // The failed check and the warning name their runs as the records do.
    let records = fs::read_to_string(format!("{out}/records.csv")).unwrap();
    for word in ["| fail | patch-displacement | tet4", "| probe-outside |"] {
        let row = text.lines().find(|line| line.starts_with(word)).unwrap();
        let run = row.trim_end_matches(" |").rsplit(' ').next().unwrap();
        assert!(run.len() == 16 && records.contains(run), "{row}");
    }
    // The same records give the same document.
    assert_eq!(tissuebench(&["report", &out]).code, 0);
    assert_eq!(read("md"), text);
    assert_described(&out);
    let file = write(&dir, "statements.toml", "use_error = \"Two of us checked each input.\"\n");
    assert_eq!(tissuebench(&["report", &out, "--statements", &file]).code, 0);
    assert!(read("html").contains("<p>Two of us checked each input.</p>"));
    assert!(!read("md").contains("Blank: use_error"));
    assert_described(&out);
    let wrong = write(&dir, "wrong.toml", "\nuse_eror = \"\"\n");
    let done = tissuebench(&["report", &out, "--statements", &wrong]);
    assert_fails(&done, 2, "wrong.toml: line 2: use_eror: is no factor; did you mean 'use_error'?");
}

#[test]
fn every_command_describes_the_folder_that_it_leaves() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir);
    let [whole, one, two, merged, single] =
        ["whole", "one", "two", "merged", "single"].map(|name| inside(&dir, name));
    let verify = |out: &str, options: &[&str]| {
        tissuebench(&[&["verify", &study, "--quiet", "--out", out], options].concat())
    };
    let junit = format!("{whole}/junit.xml");
    assert_eq!(verify(&whole, &[]).code, 1);
    assert_described(&whole);
    assert_eq!(verify(&whole, &["--resume", "--junit", &junit]).code, 1);
    assert_described(&whole);
    assert_eq!(verify(&whole, &["--join"]).code, 1);
    assert_described(&whole);
    verify(&one, &["--shard", "1/2"]);
    verify(&two, &["--shard", "2/2"]);
    assert_eq!(tissuebench(&["merge", &merged, &one, &two]).code, 1);
    for out in [&one, &two, &merged] {
        assert_described(out);
    }
    let scene = inside(&dir, "pressed.toml");
    assert_eq!(tissuebench(&["run", &scene, "--once", "--method", "hex8", "--out", &single]).code, 0);
    assert_described(&single);
    // A report elsewhere leaves the folder as it is.
    let elsewhere = inside(&dir, "elsewhere");
    assert_eq!(tissuebench(&["report", &single, "--out", &elsewhere]).code, 0);
    assert_described(&single);
}
