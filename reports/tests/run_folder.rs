//! A run written to its folder and read again.

mod common;

use std::fs;

use records::{Record, RunSet, read_run, write_run};

#[test]
fn a_run_survives_its_folder() {
    let dir = tempfile::tempdir().unwrap();
    let mut set = common::study();
    write_run(dir.path(), &set).unwrap();
    let back = read_run(dir.path()).unwrap();
    set.records.sort_by(|a, b| a.order(b));
    assert_eq!(back, set);
    // A second run in the same folder leaves nothing of the first.
    set.fields.truncate(1);
    write_run(dir.path(), &set).unwrap();
    assert_eq!(read_run(dir.path()).unwrap(), set);
}

#[test]
fn values_carry_no_thread_count_but_times_do() {
    let dir = tempfile::tempdir().unwrap();
    let mut set = common::study();
    let table = |set: &RunSet, name: &str| -> Vec<String> {
        write_run(&dir.path().join(name), set).unwrap();
        fs::read_to_string(dir.path().join(name).join("records.csv"))
            .unwrap()
            .lines()
            .map(str::to_string)
            .collect()
    };
    let two = table(&set, "two");
    set.provenance.machine.threads = 1;
    let one = table(&set, "one");
    assert!(
        two[0].starts_with("run,case,purpose,published,method,series,family,variant,basis,support_scale"),
        "{}",
        two[0]
    );
    assert!(two[0].ends_with("commit,rustc,profile,cpu,model,instructions,threads"), "{}", two[0]);
    let (mut same, mut other) = (0, 0);
    for (a, b) in one.iter().zip(&two) {
        // The time of a step is model time.
        let measured = a.contains(",time,") && !a.contains("grasp") || a.contains(",memory,");
        assert_eq!(a != b, measured, "{a}\n{b}");
        if measured { other += 1 } else { same += 1 }
    }
    assert!(same > 1000 && other > 1000);
}

#[test]
fn no_number_is_recorded_twice() {
    let dir = tempfile::tempdir().unwrap();
    let mut set = common::study();
    let again = set.records[7].clone();
    set.records.push(Record { value: 1.5 * again.value, ..again.clone() });
    let message = write_run(dir.path(), &set).unwrap_err().to_string();
    assert!(message.contains("was recorded twice") && message.contains(&again.quantity), "{message}");
    // The same number of another run, step, mode or repeat is not a duplicate.
    let last = set.records.len() - 1;
    for other in [
        Record { run: "another".into(), ..again.clone() },
        Record { component: "radial".into(), ..again.clone() },
        Record { index: Some(2), ..again.clone() },
        Record { step: Some(1), ..again.clone() },
        Record { mode: Some(1), ..again.clone() },
        Record { statistic: "repeat".into(), repeat: Some(1), ..again.clone() },
    ] {
        set.records[last] = other;
        write_run(dir.path(), &set).unwrap();
    }
}

#[test]
fn numbers_that_are_none_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    for bad in [f64::NAN, f64::INFINITY] {
        let mut set = common::study();
        set.records[7].value = bad;
        let message = write_run(dir.path(), &set).unwrap_err().to_string();
        assert!(
            message.contains("is not a finite number") && message.contains(&set.records[7].quantity),
            "{message}"
        );
        let mut set = common::study();
        set.checks[0].value = Some(bad);
        assert!(write_run(dir.path(), &set).is_err());
    }
    let mut set = common::study();
    set.fields[0].triangles[0][0] = 1_000_000;
    assert!(write_run(dir.path(), &set).unwrap_err().to_string().contains("names point 1000000"));
    let mut set = common::study();
    set.fields[0].displacement.pop();
    assert!(write_run(dir.path(), &set).is_err());
    let mut set = common::study();
    set.fields[1].method = set.fields[0].method.to_uppercase();
    assert!(write_run(dir.path(), &set).unwrap_err().to_string().contains("already has the file name"));
}

#[test]
fn a_folder_that_is_no_run_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let message = read_run(dir.path()).unwrap_err().to_string();
    assert!(message.contains("provenance.json"), "{message}");
    write_run(dir.path(), &common::study()).unwrap();
    fs::write(dir.path().join("records.csv"), "not a table").unwrap();
    let message = read_run(dir.path()).unwrap_err().to_string();
    assert!(message.contains("records.csv"), "{message}");
    write_run(dir.path(), &common::study()).unwrap();
    fs::write(dir.path().join("checks.json"), "[{").unwrap();
    let message = read_run(dir.path()).unwrap_err().to_string();
    assert!(message.contains("checks.json"), "{message}");
}

/// A spreadsheet evaluates no text of any record, and every text is read back unchanged.
#[test]
fn texts_that_are_formulas_are_guarded_in_every_column() {
    let dir = tempfile::tempdir().unwrap();
    let names = serde_json::to_value(Record::default()).unwrap();
    let mut columns = 0;
    for name in names.as_object().unwrap().keys() {
        for text in ["=1+1", "+a", "-a", "@a", "'=1+1", "a"] {
            let mut value = names.clone();
            value[name] = text.into();
            // A numeric field accepts no text.
            let Ok(record) = serde_json::from_value::<Record>(value) else { continue };
            let set = RunSet { records: vec![record], ..common::study() };
            write_run(dir.path(), &set).unwrap();
            let csv = std::fs::read_to_string(dir.path().join("records.csv")).unwrap();
            let mut cells = csv.lines().flat_map(|line| line.split(','));
            let run = |cell: &&str| cell.starts_with(['=', '+', '-', '@']) && cell.parse::<f64>().is_err();
            assert_eq!(cells.find(run), None, "{name}");
            assert_eq!(read_run(dir.path()).unwrap().records, set.records, "{name}");
            columns += 1;
        }
    }
    assert!(columns > 6 * 20, "{columns}");
}
