//! The smallest time within an error: a row for each method, a column for each case.

use crate::cheapest::{methods, problems, ratios};
use crate::fronts::wanted;
use crate::seconds::Seconds;
use crate::select::{Run, solved};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Table of every method on every case that it was run on.
pub(super) fn within(runs: &[Run]) -> Table {
    let problems = problems(&solved(runs));
    let unit = |by: Seconds| if by == Seconds::Cpu { "CPU s" } else { "s" };
    let heads: Vec<String> = problems.iter().map(|p| format!("{} [{}]", p.title, unit(p.by))).collect();
    let mut header = vec![("method", Words), ("reached", Words)];
    header.extend(heads.iter().map(|head| (head.as_str(), Number)));
    let within = wanted();
    let mut table = Table::new(
        "within",
        &format!("Cheapest within {within}"),
        &format!(
            "Time of the cheapest run of each method within {within} of the tool force of each case, or of the \
             displacement if no force is known. The error of a force is at least a third of the displacement error. \
             Reached: the number of cases that the method reached, of the cases in which it was run and that any \
             method reaches"
        ),
        &header,
    );
    for (label, _) in methods(&problems) {
        let (reached, of) = ratios(&problems, &label);
        let reached = format!("{} of {of}", reached.len());
        let mut row = vec![Cell::Text(&label), Cell::Text(&reached)];
        row.extend(problems.iter().map(|problem| {
            match problem.methods.iter().find(|m| m.label == label).map(|m| m.seconds) {
                None => Cell::Digits(None, 3),
                Some(None) => Cell::Named("not reached", f64::INFINITY),
                Some(seconds) => Cell::Digits(seconds, 3),
            }
        }));
        table.row(&row);
    }
    table
}
