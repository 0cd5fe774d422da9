//! A folder of results as left by an interrupted run or an editor, with any of its files replaced.

use std::fs;
use std::path::Path;

use reports::baseline::Baseline;

/// Starts a file in the input: `== records.csv`.
const MARK: &str = "== ";
/// Files of a folder of results, each with its smallest valid content.
const FILES: [(&str, &str); 8] = [
    ("records.csv", ""),
    ("provenance.json", include_str!("../inputs/provenance.json")),
    ("checks.json", "[]"),
    ("plans.json", "[]"),
    ("failures.json", "[]"),
    ("warnings.json", "[]"),
    ("axes.json", "[]"),
    ("fields/fuzz.json", ""),
];

pub(crate) fn run(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    fill(folder.path(), text);
    let Ok(run) = records::read_run(folder.path()) else { return };
    let baseline = Baseline::of(&run.records, "fuzz");
    assert!(baseline.compare(&baseline, true).changes.is_empty());
    // A run that was read and has distinct keys can be written and read again without a change.
    let other = folder.path().join("again");
    if records::write_run(&other, &run).is_ok() {
        let again = records::read_run(&other).expect("what is written can be read");
        assert_eq!((again.records.len(), again.checks), (run.records.len(), run.checks));
    }
}

/// Writes the files given in the input; other files have the content of a run without results.
fn fill(folder: &Path, text: &str) {
    fs::create_dir_all(folder.join("fields")).expect("a temporary folder can be written");
    let given = |name: &str| {
        let (_, behind) = text.split_once(&format!("{MARK}{name}\n"))?;
        Some(behind.split_once(&format!("\n{MARK}")).map_or(behind, |(own, _)| own))
    };
    for (name, plain) in FILES {
        let content = given(name).unwrap_or(plain);
        if name != "fields/fuzz.json" || !content.is_empty() {
            fs::write(folder.join(name), content).expect("a temporary file can be written");
        }
    }
}
