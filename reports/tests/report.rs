//! A run written, read back and rendered.

mod common;

use std::fs;
use std::path::Path;

use reports::{ReportError, read_run, render, write_run};

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

#[test]
fn a_run_survives_its_folder() {
    let dir = tempfile::tempdir().unwrap();
    let mut set = common::study();
    write_run(dir.path(), &set).unwrap();
    let back = read_run(dir.path()).unwrap();
    set.records.sort_by(|a, b| a.order(b));
    assert_eq!(back, set);
}

#[test]
fn the_same_records_give_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let mut set = common::study();
    write_run(&dir.path().join("run"), &set).unwrap();
    let first = render(&dir.path().join("run"), &dir.path().join("one")).unwrap();
    // Another order of arrival must not show.
    set.records.reverse();
    write_run(&dir.path().join("run2"), &set).unwrap();
    let second = render(&dir.path().join("run2"), &dir.path().join("two")).unwrap();
    assert_eq!(first.files.len(), second.files.len());
    for (a, b) in first.files.iter().zip(&second.files) {
        assert_eq!(a.file_name(), b.file_name());
        assert!(fs::read(a).unwrap() == fs::read(b).unwrap(), "{} differs", a.display());
    }
    for file in ["records.csv", "records.parquet", "checks.csv", "provenance.json"] {
        let read = |run: &str| fs::read(dir.path().join(run).join(file)).unwrap();
        assert!(read("run") == read("run2"), "{file} differs");
    }
    if let Ok(keep) = std::env::var("KEEP_REPORT") {
        render(&dir.path().join("run"), Path::new(&keep)).unwrap();
    }
}
