//! Stored references (JSON) and accepted numbers (TOML).

use harness::run::Stored;
use records::{Record, RunSet};
use reports::baseline::Baseline;

pub(crate) fn run(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    if let Ok(mut stored) = Stored::parse(text) {
        let _ = stored.belongs("title = \"fuzz\"", &[]);
        let records = stored.records(&Record::default());
        if records.iter().all(|r| r.value.is_finite()) {
            let folder = tempfile::tempdir().expect("a folder for temporary files");
            let _ = records::write_run(folder.path(), &RunSet { records, ..RunSet::default() });
        }
        let other = stored.clone();
        stored.widen(&other);
    }
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let file = folder.path().join("baseline.toml");
    std::fs::write(&file, text).expect("a temporary file can be written");
    if let Ok(baseline) = Baseline::load(folder.path())
        && !baseline.runs.is_empty()
    {
        let _ = baseline.compare(&Baseline::default(), true);
        let written = folder.path().join("written");
        baseline.save(&written).expect("a temporary folder can be written");
        let again = Baseline::load(&written).expect("what is written can be read");
        assert_eq!(again.count(), baseline.count());
    }
}
