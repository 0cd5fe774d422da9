//! Components of the errors of clouds: reference, discretisation, integration, transfer.

use catalogue::metric;
use records::Family;
use records::text::ratio;

use crate::select::{Run, labelled};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table, thousandths};

/// Components of the error of a cloud, RMS in m. They do not add up, because the underlying fields are
/// correlated.
pub(crate) struct Parts<'a, 'r> {
    pub(crate) run: &'a Run<'r>,
    /// Name of the run, with the settings that distinguish it from runs of the same name.
    pub(crate) label: String,
    /// Error of the reference: 0 if it is exact, otherwise the distance from it to the closest elements of
    /// the case.
    reference: Option<f64>,
    /// Distance between the finely integrated cloud and the reference.
    pub(crate) discretisation: f64,
    /// Distance between the cloud and the same cloud finely integrated.
    pub(crate) integration: f64,
    /// Distance between the cloud transferred by inverse distance, the published scheme, and its own shape
    /// functions.
    transfer: Option<f64>,
    total: Option<f64>,
}

impl Parts<'_, '_> {
    /// Integration cells per node.
    pub(crate) fn cells(&self) -> f64 {
        self.run.is.elements as f64 / self.run.is.nodes as f64
    }

    /// Whether the integration error is larger than the discretisation error.
    pub(crate) fn badly_integrated(&self) -> bool {
        self.integration > self.discretisation
    }
}

/// Components for every cloud that was solved with its own rule and with a fine rule.
pub(crate) fn parts<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<Parts<'a, 'r>> {
    let clouds = labelled(runs).into_iter().filter(|(run, _)| run.is.family == Family::Efg);
    clouds
        .filter_map(|(run, label)| {
            let same =
                |r: &&Run| r.is.case == run.is.case && r.is.poisson.to_bits() == run.is.poisson.to_bits();
            let elements = runs.iter().filter(same).filter(|r| r.is.family == Family::Fem);
            let from_reference = elements.filter_map(|r| r.value(&metric::RMS)).filter(|rms| *rms > 0.0);
            let exact = run.value(&metric::L2).map(|_| 0.0);
            let carried = runs.iter().filter(same).find(|r| {
                (r.is.variant.as_str(), r.is.nodes) == ("inverse-distance", run.is.nodes)
                    && r.is.from.as_ref() == Some(&run.is.method)
                    && r.is.kernel.as_ref() == Some(&run.is.variant)
            });
            Some(Parts {
                run,
                label,
                reference: exact.or_else(|| from_reference.reduce(f64::min)),
                discretisation: run.value(&metric::DISCRETISATION_RMS)?,
                integration: run.value(&metric::INTEGRATION_RMS)?,
                transfer: carried.and_then(|r| r.value(&metric::TRANSFER_RMS)),
                total: run.value(&metric::RMS),
            })
        })
        .collect()
}

/// Table of the error components.
pub(super) fn error_split(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "error-split",
        "Components of the errors of clouds",
        "RMS differences of the displacement. Discretisation: the finely integrated cloud, from the reference. \
         Integration: the cloud, from the same cloud finely integrated. Transfer: the cloud after transfer by inverse \
         distance, from its own shape functions. Whole: the cloud with its own shape functions, from the reference. \
         Reference: the reference's own error, 0 if exact, otherwise estimated by the elements nearest to the \
         reference. RMS values do not add up",
        &[
            ("case", Words),
            ("ν [1]", Number),
            ("method", Words),
            ("nodes", Number),
            ("cells per node [1]", Number),
            ("reference [mm]", Number),
            ("discretisation [mm]", Number),
            ("integration [mm]", Number),
            ("transfer [mm]", Number),
            ("whole [mm]", Number),
        ],
    );
    for part in parts(runs) {
        let of = |value: Option<f64>| Cell::Digits(thousandths(value), 3);
        table.row(&[
            Cell::Text(&part.run.is.case),
            Cell::Text(&ratio(part.run.is.poisson)),
            Cell::Text(&part.label),
            Cell::Count(part.run.is.nodes),
            Cell::Digits(Some(part.cells()), 2),
            of(part.reference),
            of(Some(part.discretisation)),
            of(Some(part.integration)),
            of(part.transfer),
            of(part.total),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blank::Blank as _;
    use crate::select::runs;
    use records::Record;

    fn record(who: (&str, Family, &str, Option<&str>), nodes: u64, quantity: &str, value: f64) -> Record {
        let (method, family, variant, from) = who;
        Record {
            case: "block".into(),
            method: method.into(),
            series: method.into(),
            family,
            variant: variant.into(),
            from: from.map(String::from),
            kernel: from.map(|_| "cubic-spline".into()),
            nodes,
            elements: 10 * nodes,
            value,
            ..Record::blank()
        }
        .named(quantity)
        .of_its_run()
    }

    #[test]
    fn parts_are_those_of_the_cloud_and_the_reference_is_as_good_as_the_elements_nearest_to_it() {
        let efg = ("gauss", Family::Efg, "cubic-spline", None);
        let smoothed = ("smoothed", Family::Efg, "cubic-spline", None);
        let carried = ("inverse-distance", Family::Interp, "inverse-distance", Some("gauss"));
        let mut records = Vec::new();
        for (who, nodes, rms) in [("tet10", 900, 0.0), ("hex20", 300, 2e-5), ("hex8", 100, 7e-5)] {
            records.push(record((who, Family::Fem, who, None), nodes, "rms", rms));
        }
        for (who, nodes, integration, discretisation) in
            [(efg, 83, 1e-4, 4e-4), (efg, 332, 3e-4, 2e-4), (smoothed, 83, 5e-4, 4e-4)]
        {
            records.push(record(who, nodes, "integration-rms", integration));
            records.push(record(who, nodes, "discretisation-rms", discretisation));
            records.push(record(who, nodes, "rms", 4.5e-4));
        }
        records.push(record(carried, 83, "transfer-rms", 6e-4));
        // A cloud that was integrated only once is not included.
        records.push(record(("other", Family::Efg, "cubic-spline", None), 83, "rms", 1e-4));
        let runs = runs(&records);
        let parts = parts(&runs);
        let listed: Vec<_> = parts.iter().map(|p| (p.label.as_str(), p.run.is.nodes, p.transfer)).collect();
        assert_eq!(listed, [("gauss", 83, Some(6e-4)), ("gauss", 332, None), ("smoothed", 83, None)]);
        assert_eq!(parts.iter().map(Parts::badly_integrated).collect::<Vec<_>>(), [false, true, true]);
        assert!(
            parts.iter().all(|p| p.reference == Some(2e-5) && p.total == Some(4.5e-4) && p.cells() == 10.0)
        );
        let mut exact = records.clone();
        exact.push(record(efg, 83, "l2", 0.01));
        let runs = crate::select::runs(&exact);
        assert_eq!(super::parts(&runs)[0].reference, Some(0.0));
    }
}
