//! Comparison of tables with stored tables: words must be equal, numbers must agree within one percent, and
//! NaN never matches. `reports/tests/snapshots.rs`, which uses the same file, shows that the comparison can
//! fail.

use insta::comparator::Comparator;
use insta::internals::SnapshotContents;
use insta::{Settings, Snapshot};

/// Comparator with equal words and numbers within one percent; NaN matches nothing.
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

/// Whether two tables agree, word by word.
pub fn agree(reference: &str, test: &str) -> bool {
    let (a, b): (Vec<&str>, Vec<&str>) =
        (reference.split_whitespace().collect(), test.split_whitespace().collect());
    a.len() == b.len()
        && a.iter().zip(&b).all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(x), Ok(y)) => (x - y).abs() <= 0.01 * x.abs(),
            (Err(_), Err(_)) => a == b,
            _ => false,
        })
}

/// Runs a test whose snapshots are compared within one percent.
pub fn within_one_percent(test: impl FnOnce()) {
    let mut settings = Settings::clone_current();
    settings.set_comparator(Box::new(OnePercent));
    settings.bind(test);
}
