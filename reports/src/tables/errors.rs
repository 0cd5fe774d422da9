//! Tables of errors and largest displacements of every run.

use catalogue::metric::{self, Address};
use records::text::ratio;

use crate::select::{Run, labelled, solved};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table, thousandths};

/// Table of relative L2, energy and pressure errors.
pub(super) fn relative(runs: &[Run]) -> Table {
    rows(
        runs,
        "errors",
        "Relative errors",
        "L2 norm of the displacement, energy norm and L2 norm of the pressure, each relative to the reference; ν is Poisson's ratio, h the mean node spacing",
        &[
            ("L2 [1]", metric::L2.whole()),
            ("energy [1]", metric::ENERGY.whole()),
            ("pressure [1]", metric::PRESSURE.whole()),
            ("tip / exact [1]", metric::TIP.whole()),
        ],
        1.0,
        Cell::Scientific,
    )
}

/// Table of the RMS of the displacement error, by direction and of its magnitude.
pub(super) fn rms(runs: &[Run]) -> Table {
    let [x, y, z, all] = metric::RMS.parts();
    rows(
        runs,
        metric::RMS.name,
        "RMS errors",
        "Root mean square of the displacement difference from the reference, by direction and in magnitude",
        &[("RMS x [mm]", x), ("RMS y [mm]", y), ("RMS z [mm]", z), ("RMS |u| [mm]", all)],
        1e3,
        Cell::Scientific,
    )
}

/// Table of the largest displacements, and of the largest error.
pub(super) fn maxima(runs: &[Run]) -> Table {
    let [x, y, z, max] = metric::MAX.parts();
    rows(
        runs,
        "maxima",
        "Largest displacements",
        "Largest displacement at the end by direction and in magnitude, the largest magnitude over all recorded \
         states in dynamics, and the largest error of the magnitude",
        &[
            ("max x [mm]", x),
            ("max y [mm]", y),
            ("max z [mm]", z),
            ("max |u| [mm]", max),
            ("max over time [mm]", metric::MAX_OVER_TIME.whole()),
            ("max error [mm]", metric::MAX_ERROR.whole()),
        ],
        1e3,
        |v| Cell::Digits(v, 4),
    )
}

/// A table with a row for every solver run that has at least one of the quantities, without empty columns.
fn rows(
    runs: &[Run],
    name: &'static str,
    title: &str,
    caption: &str,
    columns: &[(&str, Address)],
    scale: f64,
    cell: impl Fn(Option<f64>) -> Cell<'static>,
) -> Table {
    let solved = solved(runs);
    let filled: Vec<&(&str, Address)> =
        columns.iter().filter(|(_, of)| solved.iter().any(|r| r.value(*of).is_some())).collect();
    let mut header =
        vec![("case", Words), ("ν [1]", Number), ("method", Words), ("nodes", Number), ("h [mm]", Number)];
    header.extend(filled.iter().map(|(head, _)| (*head, Number)));
    let mut table = Table::new(name, title, caption, &header);
    for (run, label) in labelled(&solved) {
        let values: Vec<Option<f64>> = filled.iter().map(|(_, of)| run.value(*of)).collect();
        if values.iter().all(Option::is_none) {
            continue;
        }
        let poisson = ratio(run.is.poisson);
        let mut cells = vec![
            Cell::Text(&run.is.case),
            Cell::Text(&poisson),
            Cell::Text(&label),
            Cell::Count(run.is.nodes),
            Cell::Digits(thousandths(Some(run.is.spacing)).filter(|h| *h > 0.0), 4),
        ];
        cells.extend(filled.iter().zip(&values).map(|((_, of), v)| match of.metric {
            // A ratio close to one is most readable in plain notation.
            metric if *metric == metric::TIP => Cell::Digits(*v, 4),
            metric if *metric == metric::RMS && run.is_reference() => Cell::Named("reference", 0.0),
            _ => cell(v.map(|v| v * scale)),
        }));
        table.row(&cells);
    }
    table
}

#[cfg(test)]
mod tests {
    use crate::fronts::tests::run;
    use crate::select::runs;
    use records::Family;

    #[test]
    fn the_reference_has_its_name_in_place_of_an_error() {
        let of = |name, error: f64| {
            run((name, Family::Fem), 100, 1.0, &[("rms", 1e-3 * error), ("relative-rms", error)])
        };
        let table = super::rms(&runs(&[of("tet10", 0.0), of("tet4", 0.25)].concat()));
        let last = |row: &Vec<&str>| row[row.len() - 1].to_string();
        assert_eq!(table.shown().iter().map(last).collect::<Vec<_>>(), ["2.500e-1", "reference"]);
        assert!(table.csv().ends_with(",0e0\n"), "{}", table.csv());
    }
}
