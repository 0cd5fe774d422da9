//! Reports on faulty scenes and studies: every file of `tests/bad`, most of them with many faults.
//!
//! `INSTA_UPDATE=always cargo test -p tissuebench-cases --test scene bad` stores the current reports; `git
//! diff` shows the changes.

use std::path::{Path, PathBuf};

use tissuebench_cases::scene::{ErrorKind, SceneError, load, load_study};

/// All errors in a scene or study, and all parts of a valid scene that no solver supports.
fn errors(path: &Path) -> Vec<SceneError> {
    if path.file_name().unwrap().to_string_lossy().starts_with("study") {
        return load_study(path).err().unwrap_or_default();
    }
    let (errors, kind) = match load(path) {
        Err(errors) => (errors, ErrorKind::Invalid),
        Ok(scene) => (scene.unavailable(), ErrorKind::NotAvailable),
    };
    assert!(errors.iter().all(|error| error.kind == kind), "{}: {errors:?}", path.display());
    errors
}

#[test]
fn every_fault_is_reported_with_its_line_its_key_and_the_fix() {
    // Tests run in the folder of the crate, so the reports have relative paths.
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir("tests/bad").unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.is_file());
    paths.extend(["tests/bad/no-such.toml", "scenes/kidney/kidney-1331.msh"].map(PathBuf::from));
    paths.sort();
    let mut report = String::new();
    for path in &paths {
        let errors = errors(path);
        assert!(!errors.is_empty(), "{} is accepted", path.display());
        errors.iter().for_each(|error| report += &format!("{error}\n"));
    }
    insta::assert_snapshot!("bad", report.replace('\\', "/"));
}
