//! Tables of errors and largest displacements of every run.

use records::text::ratio;

use super::{labelled, millimetres};
use crate::select::{Run, solved};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Table of relative L2, energy and pressure errors.
pub(super) fn relative(runs: &[Run]) -> Table {
    rows(
        runs,
        "errors",
        "Relative errors",
        "L2 norm of the displacement, energy norm and L2 norm of the pressure, each relative to the reference; ν is Poisson's ratio, h the mean node spacing",
        &[
            ("L2 [1]", "l2"),
            ("energy [1]", "energy"),
            ("pressure [1]", "pressure"),
            ("tip / exact [1]", "tip"),
        ],
        1.0,
        Cell::Scientific,
    )
}

/// Table of the RMS of the displacement error, by direction and of its magnitude.
pub(super) fn rms(runs: &[Run]) -> Table {
    rows(
        runs,
        "rms",
        "RMS errors",
        "Root mean square of the displacement difference from the reference, by direction and in magnitude",
        &[("RMS x [mm]", "rms-x"), ("RMS y [mm]", "rms-y"), ("RMS z [mm]", "rms-z"), ("RMS |u| [mm]", "rms")],
        1e3,
        Cell::Scientific,
    )
}

/// Table of the largest displacements, and of the largest error.
pub(super) fn maxima(runs: &[Run]) -> Table {
    rows(
        runs,
        "maxima",
        "Largest displacements",
        "Largest displacement at the end by direction and in magnitude, the largest magnitude over all recorded \
         states in dynamics, and the largest error of the magnitude",
        &[
            ("max x [mm]", "max-x"),
            ("max y [mm]", "max-y"),
            ("max z [mm]", "max-z"),
            ("max |u| [mm]", "max"),
            ("max over time [mm]", "max-over-time"),
            ("max error [mm]", "max-error"),
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
    columns: &[(&str, &str)],
    scale: f64,
    cell: impl Fn(Option<f64>) -> Cell<'static>,
) -> Table {
    let solved = solved(runs);
    let filled: Vec<&(&str, &str)> =
        columns.iter().filter(|(_, q)| solved.iter().any(|r| r.value(q).is_some())).collect();
    let mut header =
        vec![("case", Words), ("ν [1]", Number), ("method", Words), ("nodes", Number), ("h [mm]", Number)];
    header.extend(filled.iter().map(|(head, _)| (*head, Number)));
    let mut table = Table::new(name, title, caption, &header);
    for (run, label) in labelled(&solved) {
        let values: Vec<Option<f64>> = filled.iter().map(|(_, q)| run.value(q)).collect();
        if values.iter().all(Option::is_none) {
            continue;
        }
        let poisson = ratio(run.is.poisson);
        let mut cells = vec![
            Cell::Text(&run.is.case),
            Cell::Text(&poisson),
            Cell::Text(&label),
            Cell::Count(run.is.nodes),
            Cell::Digits(millimetres(Some(run.is.spacing)).filter(|h| *h > 0.0), 4),
        ];
        cells.extend(filled.iter().zip(&values).map(|((_, quantity), v)| match *quantity {
            // A ratio close to one is most readable in plain notation.
            "tip" => Cell::Digits(*v, 4),
            _ if name == "rms" && run.is_reference() => Cell::Named("reference", 0.0),
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
