//! Published numbers next to those of runs that match the published runs.

use catalogue::metric::{self, Metric};
use records::Family;

use super::claim::reproduced;
use super::named::Named;
use super::published::{Number, Ours, Published};
use crate::select::{Run, by_case};

impl Ours {
    /// SI value of a run, whose displacement after the transfer is that of `transferred`.
    fn of(&self, run: &Run, transferred: Option<&Run>) -> Option<f64> {
        let after = |quantity: &Named| transferred?.value(quantity.0);
        let all = |quantities: &[Named]| quantities.iter().map(after).collect::<Option<Vec<f64>>>();
        match self {
            Ours::Elements => Some(run.is.elements as f64).filter(|count| *count > 0.0),
            Ours::Time(phases) if phases == &["total"] => run.total(),
            Ours::Time(phases) => phases.iter().map(|phase| run.time(phase, "median")).sum(),
            Ours::Value(quantity) => run.value(quantity.0),
            Ours::Transferred(quantity) => after(quantity),
            Ours::LeastTransferred(quantities) => all(quantities)?.into_iter().reduce(f64::min),
            Ours::LargestTransferred(quantities) => all(quantities)?.into_iter().reduce(f64::max),
        }
    }
}

/// A published number with the computed number.
pub(crate) struct Pair<'a, 'r> {
    pub(crate) number: &'static Number,
    pub(crate) run: &'a Run<'r>,
    /// Computed value, SI.
    pub(crate) ours: Option<f64>,
}

impl Pair<'_, '_> {
    /// Ratio of the published to the computed number: for a time, the factor by which ours is faster.
    pub(crate) fn ratio(&self) -> Option<f64> {
        self.ours.filter(|ours| *ours > 0.0).map(|ours| self.number.published.value / ours)
    }
}

/// A published run, a run of ours that matches it, and all runs of the same case.
struct Match<'a, 'r> {
    published: &'static Published,
    run: &'a Run<'r>,
    case: &'a [Run<'r>],
}

impl<'a, 'r> Match<'a, 'r> {
    /// The displacement of the run after the published transfer scheme, compared with the secondary
    /// reference.
    fn transferred(&self) -> Option<&'a Run<'r>> {
        let scheme = self.published.transfer.as_ref()?;
        self.case.iter().find(|r| {
            r.is.family == Family::Interp
                && r.is.variant == *scheme
                && r.is.nodes == self.run.is.nodes
                && r.is.from.as_ref() == Some(&self.run.is.method)
                && r.is.kernel.as_ref() == Some(&self.run.is.variant)
                && r.value(&metric::BESIDE_RMS).is_some()
        })
    }
}

/// Runs of the reproduced cases that match a published run: every method of the same family and variant with
/// the same number of nodes within 2 %.
fn matches<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<Match<'a, 'r>> {
    let mut out = Vec::new();
    for case in by_case(runs) {
        for published in reproduced(case[0].is).into_iter().flat_map(|claim| &claim.run) {
            let like = |run: &&Run| {
                (run.is.family, &run.is.variant) == (published.family, &published.variant)
                    && run.is.nodes.abs_diff(published.nodes) * 50 <= published.nodes
            };
            let mut own: Vec<&Run> = Vec::new();
            for run in case.iter().filter(like) {
                if own.iter().all(|other| other.is.method != run.is.method) {
                    own.push(run);
                }
            }
            out.extend(own.into_iter().map(|run| Match { published, run, case }));
        }
    }
    out
}

/// Published numbers paired, case by case, with those of every run that matches the published run.
pub(crate) fn pairs<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<Pair<'a, 'r>> {
    let of = |found: Match<'a, 'r>| {
        let run = found.run;
        let transferred = found.transferred();
        let like = move |number: &&'static Number| number.needs.iter().all(|quantity| run.has(quantity.0));
        let numbers = found.published.number.iter().filter(like);
        numbers.map(move |number| Pair { number, run, ours: number.ours.of(run, transferred) })
    };
    matches(runs).into_iter().flat_map(of).collect()
}

/// Components of the published difference between a cloud, transferred to the finite-element nodes, and these
/// elements.
pub(crate) struct Split<'a, 'r> {
    /// Cloud of the published size.
    pub(crate) cloud: &'a Run<'r>,
    /// Field of the cloud after the published transfer scheme.
    transferred: &'a Run<'r>,
    /// Finite elements that the cloud is compared with.
    elements: &'a Run<'r>,
    /// Reference of the case, if it is among the runs.
    reference: Option<&'a str>,
}

/// Description of an RMS difference, and its x, y, z and magnitude, m.
pub(crate) type Part = (String, [Option<f64>; 4]);

impl Split<'_, '_> {
    /// The whole difference, the difference without the transfer, and the components: transfer,
    /// discretisation of the cloud, error of the elements. RMS values do not add up, because the underlying
    /// fields are correlated.
    pub(crate) fn parts(&self) -> [Part; 5] {
        let (cloud, elements) = (&self.cloud.is.method, &self.elements.is.method);
        let scheme = self.transferred.is.variant.replace('-', " ");
        let reference = self.reference.unwrap_or("the reference");
        let of = |run: &Run, of: &'static Metric| of.parts().map(|part| run.value(part));
        [
            (format!("{cloud} by {scheme}, from {elements}"), of(self.transferred, &metric::BESIDE_RMS)),
            (
                format!("{cloud} with its own shape functions, from {elements}"),
                of(self.cloud, &metric::BESIDE_RMS),
            ),
            (
                format!("transfer alone: {elements} at the nodes of {cloud} and back"),
                of(self.transferred, &metric::BESIDE_TRANSFER_RMS),
            ),
            (
                format!("discretisation: {cloud} with its own shape functions, from {reference}"),
                of(self.cloud, &metric::RMS),
            ),
            (format!("error of {elements}, from {reference}"), of(self.elements, &metric::RMS)),
        ]
    }
}

/// Components of the difference for every run that was transferred like the published run.
pub(crate) fn splits<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<Split<'a, 'r>> {
    let of = |found: Match<'a, 'r>| {
        let zero = |quantity: &'static Metric| {
            let is = move |r: &&Run| r.is.family == Family::Fem && r.value(quantity) == Some(0.0);
            found.case.iter().find(is)
        };
        Some(Split {
            cloud: found.run,
            transferred: found.transferred()?,
            elements: zero(&metric::BESIDE_RMS)?,
            reference: zero(&metric::RMS).map(|run| run.is.method.as_str()),
        })
    };
    matches(runs).into_iter().filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use records::{Purpose, Record};

    use super::super::published::Printed;
    use super::*;
    use crate::blank::Blank as _;
    use crate::select::runs;

    fn record(case: &str, who: (&str, Family, &str), nodes: u64, quantity: &str, value: f64) -> Record {
        let (method, family, variant) = who;
        let from = (family == Family::Interp).then_some("efg-83");
        Record {
            case: case.into(),
            purpose: if case == "reading" { Purpose::Published } else { Purpose::Rough },
            published: "saghaei-2016".into(),
            method: method.into(),
            family,
            variant: variant.into(),
            from: from.map(String::from),
            kernel: from.map(|_| "cubic-spline".into()),
            nodes,
            value,
            ..Record::blank()
        }
        .named(quantity)
        .of_its_run()
    }

    const TET4: (&str, Family, &str) = ("tet4-1331", Family::Fem, "tet4");

    #[test]
    fn the_parts_of_the_difference_are_those_of_cloud_elements_and_transfer() {
        let fine = ("tet10", Family::Fem, "tet10");
        let efg = ("efg-83", Family::Efg, "cubic-spline");
        let transferred = ("inverse-distance", Family::Interp, "inverse-distance");
        let mut records = Vec::new();
        for case in ["reading", "other"] {
            for (axis, k) in [("-x", 1.0), ("-y", 2.0), ("-z", 3.0), ("", 4.0)] {
                let mut push = |who, nodes, name: &str, value: f64| {
                    records.push(record(case, who, nodes, &format!("{name}{axis}"), value * k));
                };
                push(TET4, 1331, "beside-rms", 0.0);
                push(TET4, 1331, "rms", 5e-4);
                push(fine, 9470, "rms", 0.0);
                push(fine, 9470, "beside-rms", 5e-4);
                push(efg, 83, "beside-rms", 2e-4);
                push(efg, 83, "rms", 4e-4);
                push(transferred, 83, "beside-rms", 1e-4);
                push(transferred, 83, "beside-transfer-rms", 3e-4);
            }
        }
        let runs = runs(&records);
        let splits = splits(&runs);
        assert_eq!(splits.len(), 1, "the published case alone");
        assert_eq!((splits[0].cloud.is.case.as_str(), splits[0].reference), ("reading", Some("tet10")));
        for (part, base) in splits[0].parts().iter().zip([1e-4, 2e-4, 3e-4, 4e-4, 5e-4]) {
            assert_eq!(part.1, [1.0, 2.0, 3.0, 4.0].map(|k| Some(base * k)), "{}", part.0);
        }
        // The published RMS is compared with the transferred field, not with the cloud's own.
        let pairs = pairs(&runs);
        let ours = |what: &str| pairs.iter().find(|p| p.number.what.starts_with(what)).unwrap().ours;
        assert_eq!(ours("RMS difference of EFG from FE in y"), Some(2e-4));
        assert_eq!(ours("least of the three"), Some(1e-4));
        assert_eq!(ours("largest of the three"), Some(1e-4 * 3.0));
        assert!(pairs.iter().all(|p| p.run.is.case == "reading"));
    }

    #[test]
    fn two_hours_of_contact_in_explicit_dynamics_are_compared_with_the_same() {
        let compared = |quantities: &[&str]| {
            let records: Vec<Record> =
                quantities.iter().map(|quantity| record("reading", TET4, 1331, quantity, 1.0)).collect();
            let runs = runs(&records);
            pairs(&runs).iter().filter(|pair| pair.number.published.value == 7200.0).count()
        };
        assert_eq!(compared(&["max-x", "time-steps"]), 0);
        assert_eq!(compared(&["max-x", "tool-force"]), 0);
        assert_eq!(compared(&["max-x", "tool-force", "time-steps"]), 1);
    }

    #[test]
    fn a_number_is_shown_as_it_is_printed() {
        let of = |text: &str| Printed::try_from(text.to_string());
        let printed = of("0.40 mm").unwrap();
        assert_eq!((printed.digits(), printed.unit(), printed.value), ("0.40", "mm", 0.4e-3));
        let count = of("6195").unwrap();
        assert_eq!((count.digits(), count.unit(), count.value), ("6195", "1", 6195.0));
        assert!(of("much").is_err() && of("2 hares").is_err());
    }
}
