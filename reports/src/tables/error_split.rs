//! Errors of clouds taken apart: reference, discretisation, integration, transfer.

use super::{labelled, millimetres};
use crate::record::Family;
use crate::select::Run;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};
use crate::text::ratio;

/// What the error of a cloud is made of, RMS in metres. RMS do not add up, as the fields behind them are no strangers to each other.
pub(crate) struct Parts<'a, 'r> {
    pub(crate) run: &'a Run<'r>,
    /// The run's name, with the settings that tell it from its namesakes.
    pub(crate) label: String,
    /// Of what it is compared with: 0 where that is exact, or else how far the nearest elements of the case are from it.
    reference: Option<f64>,
    /// The same cloud, finely integrated, from the reference.
    pub(crate) discretisation: f64,
    /// The cloud from itself, finely integrated.
    pub(crate) integration: f64,
    /// The cloud carried over by inverse distance, the published scheme, from its own shape functions.
    transfer: Option<f64>,
    total: Option<f64>,
}

impl Parts<'_, '_> {
    /// Cells to integrate over for each node.
    pub(crate) fn cells(&self) -> f64 {
        self.run.is.elements as f64 / self.run.is.nodes as f64
    }

    /// Whether integration is the larger part.
    pub(crate) fn badly_integrated(&self) -> bool {
        self.integration > self.discretisation
    }
}

/// Every cloud that was solved with its own rule and with a fine one.
pub(crate) fn parts<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<Parts<'a, 'r>> {
    let clouds = labelled(runs).into_iter().filter(|(run, _)| run.is.family == Family::Efg);
    clouds
        .filter_map(|(run, label)| {
            let same =
                |r: &&Run| r.is.case == run.is.case && r.is.poisson.to_bits() == run.is.poisson.to_bits();
            let elements = runs.iter().filter(same).filter(|r| r.is.family == Family::Fem);
            let from_reference = elements.filter_map(|r| r.value("rms")).filter(|rms| *rms > 0.0);
            let exact = run.value("l2").map(|_| 0.0);
            let carried = runs.iter().filter(same).find(|r| {
                (r.is.variant.as_str(), r.is.nodes) == ("inverse-distance", run.is.nodes)
                    && r.is.from.as_ref() == Some(&run.is.method)
                    && r.is.kernel.as_ref() == Some(&run.is.variant)
            });
            Some(Parts {
                run,
                label,
                reference: exact.or_else(|| from_reference.reduce(f64::min)),
                discretisation: run.value("discretisation-rms")?,
                integration: run.value("integration-rms")?,
                transfer: carried.and_then(|r| r.value("transfer-rms")),
                total: run.value("rms"),
            })
        })
        .collect()
}

/// The table.
pub(super) fn error_split(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "error-split",
        "What the errors of clouds are made of",
        "RMS of the displacement. Discretisation is the same cloud, finely integrated, from the reference; integration is the cloud from itself, finely \
         integrated; transfer is the cloud carried over by inverse distance from its own shape functions; the whole is the cloud with its own shape \
         functions from the reference. The reference's own error is 0 where it is exact, and is reported elsewhere by the elements nearest to it. RMS do not \
         add up",
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
        let of = |value: Option<f64>| Cell::Digits(millimetres(value), 3);
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
    use crate::record::Record;
    use crate::select::runs;

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
            quantity: quantity.into(),
            value,
            ..Record::blank()
        }
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
        // A cloud that was not integrated twice is none of them.
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
