//! Tables of computed numbers next to the published ones.

use records::Family;

use super::millimetres;
use crate::published::{Publication, Published, read_as};
use crate::select::{Run, by_case};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// A published number with the computed one.
pub(crate) struct Pair<'a, 'r> {
    pub(crate) paper: &'static Published,
    pub(crate) run: &'a Run<'r>,
    /// Computed value, SI.
    pub(crate) ours: Option<f64>,
}

impl Pair<'_, '_> {
    /// Whether the number is a time.
    pub(crate) fn is_time(&self) -> bool {
        !["max-", "rms-", "elements"].iter().any(|start| self.paper.quantity.starts_with(start))
    }

    /// Ratio of the published to the computed time; `None` for other numbers.
    pub(crate) fn speed_up(&self) -> Option<f64> {
        self.ours.filter(|v| self.is_time() && *v > 0.0).map(|v| self.paper.value / v)
    }
}

/// Cases that reproduce a published one.
fn readings<'a, 'r>(runs: &'a [Run<'r>]) -> impl Iterator<Item = (&'static Publication, &'a [Run<'r>])> {
    by_case(runs).filter_map(|case| Some((read_as(case[0].is)?, case)))
}

/// Published numbers paired, case by case, with the runs that match the published discretisation best: finite
/// elements of each method with nearly the same number of nodes, and a cloud with the same number of nodes
/// (preferably with the same kernel).
pub(crate) fn pairs<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<Pair<'a, 'r>> {
    readings(runs).flat_map(|(publication, case)| of_case(publication, case)).collect()
}

fn near(run: &Run, nodes: u64) -> bool {
    run.is.nodes.abs_diff(nodes) * 50 <= nodes
}

fn of_case<'a, 'r>(publication: &'static Publication, case: &'a [Run<'r>]) -> Vec<Pair<'a, 'r>> {
    let mut fe: Vec<&Run> = Vec::new();
    for run in case.iter().filter(|r| r.is.family == Family::Fem && near(r, publication.fe_nodes)) {
        if fe.iter().all(|f| f.is.method != run.is.method) {
            fe.push(run);
        }
    }
    let clouds: Vec<&Run> =
        case.iter().filter(|r| r.is.family == Family::Efg && near(r, publication.efg_nodes)).collect();
    let efg = clouds.iter().find(|r| r.is.variant == publication.kernel).or(clouds.first());
    let mut out = Vec::new();
    for paper in publication.numbers {
        let matching: Vec<&Run> =
            if paper.family == Family::Fem { fe.clone() } else { efg.iter().map(|r| **r).collect() };
        out.extend(matching.into_iter().filter(|run| paper.is_of(run)).map(|run| Pair {
            paper,
            run,
            ours: ours(publication, case, run, paper.quantity),
        }));
    }
    out
}

/// Components of the published difference between a cloud, transferred to the finite-element nodes, and these
/// elements.
pub(crate) struct Split<'a, 'r> {
    /// Cloud of the published size.
    pub(crate) cloud: &'a Run<'r>,
    /// Field of the cloud after the transfer by inverse distance.
    pub(crate) carried: &'a Run<'r>,
    /// Finite elements that the cloud is compared with.
    pub(crate) elements: &'a Run<'r>,
    /// Reference of the case, if it is among the runs.
    pub(crate) reference: Option<&'a str>,
}

/// Description of an RMS difference, and its x, y, z and magnitude, m.
pub(crate) type Part = (String, [Option<f64>; 4]);

impl Split<'_, '_> {
    /// The whole difference, followed by its components: transfer, discretisation of the cloud, error of the
    /// elements. RMS values do not add up, because the underlying fields are correlated.
    pub(crate) fn parts(&self) -> [Part; 5] {
        let (cloud, elements) = (&self.cloud.is.method, &self.elements.is.method);
        let reference = self.reference.unwrap_or("the reference");
        let of =
            |run: &Run, name: &str| ["-x", "-y", "-z", ""].map(|axis| run.value(&format!("{name}{axis}")));
        [
            (format!("{cloud} by inverse distance, from {elements}"), of(self.carried, "beside-rms")),
            (format!("{cloud} with its own shape functions, from {elements}"), of(self.cloud, "beside-rms")),
            (
                format!("transfer alone: {elements} at the nodes of {cloud} and back"),
                of(self.carried, "beside-transfer-rms"),
            ),
            (
                format!("discretisation: {cloud} with its own shape functions, from {reference}"),
                of(self.cloud, "rms"),
            ),
            (format!("error of {elements}, from {reference}"), of(self.elements, "rms")),
        ]
    }
}

/// Every reproduced case in which a cloud of the published size was compared with the finite elements.
pub(crate) fn splits<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<Split<'a, 'r>> {
    let mut out: Vec<Split> = Vec::new();
    for (publication, case) in readings(runs) {
        let zero = |r: &&Run, quantity: &str| r.is.family == Family::Fem && r.value(quantity) == Some(0.0);
        let Some(elements) = case.iter().find(|r| zero(r, "beside-rms")) else { continue };
        let reference = case.iter().find(|r| zero(r, "rms")).map(|r| r.is.method.as_str());
        for cloud in case.iter().filter(|r| r.is.family == Family::Efg && near(r, publication.efg_nodes)) {
            if let Some(carried) =
                carried_as(publication, case, cloud).filter(|_| cloud.is.variant == publication.kernel)
            {
                out.push(Split { cloud, carried, elements, reference });
            }
        }
    }
    out
}

/// The field of a cloud after the published transfer scheme, compared with the published type of elements.
fn carried_as<'a, 'r>(publication: &Publication, case: &'a [Run<'r>], cloud: &Run) -> Option<&'a Run<'r>> {
    case.iter().find(|r| {
        r.is.family == Family::Interp
            && r.is.variant == publication.scheme
            && r.is.nodes == cloud.is.nodes
            && r.is.from.as_ref() == Some(&cloud.is.method)
            && r.is.kernel.as_ref() == Some(&cloud.is.variant)
            && r.value("beside-rms").is_some()
    })
}

fn ours(publication: &Publication, case: &[Run], run: &Run, quantity: &str) -> Option<f64> {
    // As published, the difference from the elements after the transfer; without this comparison, the error
    // against the reference.
    let carried = carried_as(publication, case, run);
    let rms = |q: &str| carried.map_or_else(|| run.value(q), |c| c.value(&format!("beside-{q}")));
    let directions = || ["rms-x", "rms-y", "rms-z"].map(rms).into_iter().collect::<Option<Vec<f64>>>();
    match quantity {
        "total" => run.total(),
        "elements" => Some(run.is.elements as f64).filter(|n| *n > 0.0),
        "rms-least" => directions().map(|d| d.into_iter().fold(f64::MAX, f64::min)),
        "rms-most" => directions().map(|d| d.into_iter().fold(0.0, f64::max)),
        q if q.starts_with("rms-") => rms(q),
        q if q.starts_with("max-") => run.value(q),
        phases => phases.split('+').map(|phase| run.time(phase, "median")).sum(),
    }
}

/// Table of published numbers: value, place, computed value and speed-up.
pub(super) fn beside_ours(runs: &[Run]) -> Table {
    let caption = "Published numbers with their place in the publication, and ours for the matching discretisation. \
                   The RMS compares EFG, transferred by inverse distance, with linear tetrahedra (with the case's \
                   reference if the study has no linear tetrahedra). Geometry and supports are our interpretation of \
                   the publication; load is the fraction of the published force that was reached. Solution times are \
                   compared with runs with contact only, and the times of finite elements with explicit dynamics only";
    let mut table = Table::new(
        "published",
        "Beside the publication",
        caption,
        &[
            ("number", Words),
            ("unit", Words),
            ("published", Number),
            ("place", Words),
            ("case", Words),
            ("our method", Words),
            ("nodes", Number),
            ("load [1]", Number),
            ("ours", Number),
            ("times faster [1]", Number),
        ],
    );
    for pair in pairs(runs) {
        let (unit, scale) = match pair.paper.quantity {
            "elements" => ("1", 1.0),
            _ if pair.is_time() => ("s", 1.0),
            _ => ("mm", 1e3),
        };
        let ours = match pair.paper.quantity {
            "elements" => pair.ours.map_or(Cell::Digits(None, 1), |n| Cell::Count(n as u64)),
            _ => Cell::Digits(pair.ours.map(|v| v * scale), 3),
        };
        table.row(&[
            Cell::Text(pair.paper.what),
            Cell::Text(unit),
            Cell::Digits(Some(pair.paper.value * scale), pair.paper.digits),
            Cell::Text(pair.paper.place),
            Cell::Text(&pair.run.is.case),
            Cell::Text(&pair.run.is.method),
            Cell::Count(pair.run.is.nodes),
            Cell::Digits(Some(pair.run.value("load-carried").unwrap_or(1.0)), 4),
            ours,
            Cell::Digits(pair.speed_up(), 2),
        ]);
    }
    table
}

/// Table of the published RMS difference and its components.
pub(super) fn rms_parts(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "published-rms",
        "Components of the difference between EFG and FE",
        "RMS over the nodes of the finite elements: the whole difference, the difference without the transfer, and \
         each part alone: the transfer of a known field, the discretisation of the cloud, and the error of the \
         elements. RMS values do not add up",
        &[
            ("case", Words),
            ("difference", Words),
            ("RMS x [mm]", Number),
            ("RMS y [mm]", Number),
            ("RMS z [mm]", Number),
            ("RMS |u| [mm]", Number),
        ],
    );
    for split in splits(runs) {
        for (what, [x, y, z, all]) in split.parts() {
            table.row(&[
                Cell::Text(&split.cloud.is.case),
                Cell::Text(&what),
                Cell::Digits(millimetres(x), 3),
                Cell::Digits(millimetres(y), 3),
                Cell::Digits(millimetres(z), 3),
                Cell::Digits(millimetres(all), 3),
            ]);
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blank::Blank as _;
    use crate::select::runs;
    use records::{Purpose, Record};

    fn record(
        case: &str,
        who: (&str, Family, &str, Option<&str>),
        nodes: u64,
        quantity: &str,
        value: f64,
    ) -> Record {
        let (method, family, variant, from) = who;
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
            quantity: quantity.into(),
            value,
            ..Record::blank()
        }
        .of_its_run()
    }

    #[test]
    fn the_parts_of_the_difference_are_those_of_cloud_elements_and_transfer() {
        let tet4 = ("tet4-1331", Family::Fem, "tet4", None);
        let fine = ("tet10", Family::Fem, "tet10", None);
        let efg = ("efg-83", Family::Efg, "cubic-spline", None);
        let carried = ("inverse-distance", Family::Interp, "inverse-distance", Some("efg-83"));
        let mut records = Vec::new();
        for case in ["reading", "other"] {
            for (axis, k) in [("-x", 1.0), ("-y", 2.0), ("-z", 3.0), ("", 4.0)] {
                let mut push = |who, nodes, name: &str, value: f64| {
                    records.push(record(case, who, nodes, &format!("{name}{axis}"), value * k));
                };
                push(tet4, 1331, "beside-rms", 0.0);
                push(tet4, 1331, "rms", 5e-4);
                push(fine, 9470, "rms", 0.0);
                push(fine, 9470, "beside-rms", 5e-4);
                push(efg, 83, "beside-rms", 2e-4);
                push(efg, 83, "rms", 4e-4);
                push(carried, 83, "beside-rms", 1e-4);
                push(carried, 83, "beside-transfer-rms", 3e-4);
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
        let rms = pairs.iter().find(|p| p.paper.quantity == "rms-y").unwrap();
        assert_eq!((rms.run.is.method.as_str(), rms.ours), ("efg-83", Some(2e-4)));
        assert!(pairs.iter().all(|p| p.run.is.case == "reading"));
    }
}
