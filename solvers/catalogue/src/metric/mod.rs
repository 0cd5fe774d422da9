//! Metrics: every number that is recorded, checked or drawn, with an explanation.

mod address;
mod definition;
mod entries;

pub use address::{Address, address, find, named};
pub use definition::{Kind, Metric, Needs, Shape};
pub use entries::*;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_metric_has_one_name_a_label_and_a_meaning() {
        for (i, metric) in METRICS.iter().enumerate() {
            assert!(!metric.label.is_empty() && !metric.meaning.is_empty(), "{}", metric.name);
            assert!(METRICS[..i].iter().all(|other| other.name != metric.name), "{} twice", metric.name);
        }
    }
}
