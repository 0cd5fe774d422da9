//! Tables compared with stored snapshots: equal words, numbers within one per cent, and no NaN. Times are
//! never stored.

mod common;
#[path = "../../tests/common/one_percent.rs"]
mod one_percent;

use one_percent::{agree, within_one_percent};
use records::write_run;
use tissuebench_reports::render;

#[test]
fn the_comparator_can_fail() {
    assert!(agree("| tet4 | 1.000e-6 |", "| tet4 | 1.009e-6 |"));
    assert!(!agree("| tet4 | 1.000e-6 |", "| tet4 | 1.011e-6 |"));
    assert!(!agree("| tet4 | 1.000e-6 |", "| tet10 | 1.000e-6 |"));
    assert!(!agree("| tet4 | NaN |", "| tet4 | NaN |"));
    assert!(!agree("| tet4 | 1 |", "| tet4 | — |"));
    assert!(!agree("| tet4 | 1 |", "| tet4 |"));
}

#[test]
fn tables_keep_their_numbers() {
    let dir = tempfile::tempdir().unwrap();
    let mut set = common::study();
    set.records.retain(|r| r.case == "thick-sphere" || r.case == "kidney-paper");
    set.records.retain(|r| !r.is_measured());
    write_run(dir.path(), &set).unwrap();
    render(dir.path(), dir.path()).unwrap();
    within_one_percent(|| {
        for table in ["rms", "orders", "published"] {
            let text = std::fs::read_to_string(dir.path().join(format!("tables/{table}.md"))).unwrap();
            insta::assert_snapshot!(table, text);
        }
    });
}
