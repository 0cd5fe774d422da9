//! Transfer schemes: one row each, with a marker for every field or source.

use std::collections::BTreeSet;

use catalogue::metric;
use records::Family;
use records::cell::csv_line;
use records::store::slug;
use records::text::tick;

use super::axes::{ABOVE, Axis, BELOW, framed};
use super::drawing::widest;
use super::figure::{Data, Figure};
use super::grid::{WIDTH, with_foot};
use super::style::{keys, styles};
use crate::findings::source;
use crate::select::{Run, by_case};

/// Height of a row with several markers.
const ROW: i32 = 200;

/// One panel per case, one marker per field or source.
pub(super) fn figures(runs: &[Run]) -> Vec<Figure> {
    let schemes: Vec<Run> = runs.iter().filter(|r| r.is.family == Family::Interp).cloned().collect();
    by_case(&schemes).filter_map(transfer_figure).collect()
}

fn transfer_figure(runs: &[Run]) -> Option<Figure> {
    let (quantity, label, scale) = [
        (&metric::RMS, "RMS error after the transfer, from the reference [mm]", 1e3),
        (&metric::L2, "relative L2 error after the transfer [1]", 1.0),
    ]
    .into_iter()
    .find(|(q, _, _)| runs.iter().any(|r| r.value(*q).is_some()))?;
    let scheme = |r: &Run| {
        // The kernel is that of the method whose field is transferred.
        let own = r.is.settings().into_iter().filter(|(name, _)| !["from", "kernel"].contains(name));
        let settings: Vec<String> = own.map(|(name, value)| format!("{name} {value}")).collect();
        if settings.is_empty() {
            r.is.variant.clone()
        } else {
            format!("{} ({})", r.is.variant, settings.join(", "))
        }
    };
    let names: Vec<String> = runs.iter().map(scheme).collect::<BTreeSet<_>>().into_iter().collect();
    let styles = styles(&runs.iter().map(|r| (source(r), Family::Interp)).collect::<Vec<_>>());
    let raw: Vec<f64> = runs.iter().filter_map(|r| r.value(quantity)).map(|v| v * scale).collect();
    // Schemes that are exact to rounding would squeeze all others into a corner.
    let largest = raw.iter().copied().fold(0.0, f64::max).max(1e-9);
    let floor = 10f64.powf((largest * 1e-3).log10().floor());
    let unit = if scale > 1.0 { " mm" } else { "" };
    let note = match raw.iter().any(|v| *v < floor) {
        true => {
            format!("Errors below {}{unit} are drawn at that value; the table lists all errors.", tick(floor))
        }
        false => String::new(),
    };
    let height = ABOVE + ROW * names.len() as i32 + BELOW;
    let drawing = with_foot(WIDTH, height, keys(&styles, false), &note, |area| {
        let x = Axis::log(label, raw.iter().map(|v| v.max(floor)));
        let y = Axis::named(names.iter().cloned(), -1.0);
        let mut chart = framed(area, 200 + widest(names.iter()), &runs[0].is.case, x, y)?;
        for (which, style) in styles.iter().enumerate() {
            // Markers of different sources stand below one another in a row.
            let aside = 0.45 * ((which as f64 + 0.5) / styles.len() as f64 - 0.5);
            let of_source = runs.iter().filter(|r| source(r) == style.label);
            let points = of_source.filter_map(|r| {
                let row = names.iter().position(|name| *name == scheme(r))?;
                Some(((r.value(quantity)? * scale).max(floor), -0.5 - row as f64 - aside))
            });
            style.marks(&mut chart, points)?;
        }
        Ok(())
    });
    let mut rows = csv_line(&["scheme", "source", label]);
    for run in runs {
        if let Some(v) = run.value(quantity) {
            rows.push_str(&csv_line(&[&scheme(run), &source(run), &format!("{:e}", v * scale)]));
        }
    }
    let case = &runs[0].is.case;
    Some(Figure {
        name: format!("transfer-{}", slug(case)),
        title: format!("Transfer schemes compared, {case}"),
        caption: "Error of the displacement at the target points after transfer by each scheme. For a prescribed \
                  field, this is the error of the transfer alone. For a method's result, the method's own error is \
                  included; own-rows (the method's own shape functions) shows the method's error alone. Several \
                  markers of one source in a row are different kernels and numbers of nodes"
            .into(),
        drawing,
        data: Data::Rows(rows),
    })
}
