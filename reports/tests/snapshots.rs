//! Tables against their stored form: words equal, numbers within one percent, never a NaN. Times are never stored.

mod common;

use insta::comparator::Comparator;
use insta::internals::SnapshotContents;
use insta::{Settings, Snapshot};
use reports::{render, write_run};

/// Words equal, numbers within one percent; a NaN matches nothing.
#[derive(Clone)]
struct OnePercent;

impl Comparator for OnePercent {
    fn matches(&self, reference: &Snapshot, test: &Snapshot) -> bool {
        match (reference.contents(), test.contents()) {
            (SnapshotContents::Text(a), SnapshotContents::Text(b)) => agree(&a.to_string(), &b.to_string()),
            _ => false,
        }
    }

    fn dyn_clone(&self) -> Box<dyn Comparator> {
        Box::new(self.clone())
    }
}

fn agree(reference: &str, test: &str) -> bool {
    let (a, b): (Vec<&str>, Vec<&str>) =
        (reference.split_whitespace().collect(), test.split_whitespace().collect());
    a.len() == b.len()
        && a.iter().zip(&b).all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(x), Ok(y)) => (x - y).abs() <= 0.01 * x.abs(),
            (Err(_), Err(_)) => a == b,
            _ => false,
        })
}

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
    let mut settings = Settings::clone_current();
    settings.set_comparator(Box::new(OnePercent));
    settings.bind(|| {
        for table in ["rms", "orders", "kidney"] {
            let text = std::fs::read_to_string(dir.path().join(format!("tables/{table}.md"))).unwrap();
            insta::assert_snapshot!(table, text);
        }
    });
}
