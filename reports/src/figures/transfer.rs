//! Transfer schemes: one row each, with a marker for every field or source.

use std::collections::BTreeSet;

use catalogue::metric;
use records::Family;
use records::cell::csv_line;
use records::store::slug;
use records::text::tick;

use super::axes::{Axis, Panel, TEXT};
use super::canvas::{Anchor, BLACK_INK, Canvas, GREY, PALE, text_width};
use super::figure::{Data, Figure};
use super::grid::WIDTH;
use super::style::{legend, legend_height, styles};
use crate::findings::source;
use crate::select::{Run, by_case};

/// Height of a row with several markers.
const LINE: f64 = 20.0;

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
    let values: Vec<f64> = raw.iter().map(|v| v.max(floor)).collect();
    let left = 14.0 + names.iter().map(|n| text_width(n, TEXT)).fold(40.0, f64::max);
    let bottom = 26.0 + LINE * names.len() as f64;
    let below = 34.0 + legend_height(&styles, WIDTH - 20.0);
    let floored = raw.iter().any(|v| *v < floor);
    let mut canvas = Canvas::new(WIDTH, bottom + below + if floored { 18.0 } else { 6.0 });
    let rows = Axis::linear("", [0.0, 1.0].into_iter(), true).with_ticks(Vec::new());
    let panel =
        Panel { frame: (left, 22.0, WIDTH - 16.0, bottom), x: Axis::log(label, values.into_iter()), y: rows };
    panel.draw(&mut canvas, &runs[0].is.case);
    for (row, name) in names.iter().enumerate() {
        let y = 24.0 + LINE * (row as f64 + 0.5);
        canvas.text((left - 8.0, y), name, TEXT, BLACK_INK, Anchor::End);
        canvas.line(&[(left, y), (WIDTH - 16.0, y)], PALE, 0.5);
    }
    for run in runs {
        let (Some(v), Some(row)) = (run.value(quantity), names.iter().position(|n| *n == scheme(run))) else {
            continue;
        };
        let x = panel.at((v * scale).max(floor), 0.0).0;
        if let Some(which) = styles.iter().position(|s| s.label == source(run)) {
            let aside = 4.5 * (which as f64 - 0.5 * (styles.len() as f64 - 1.0))
                / (styles.len() as f64 / 2.0).max(1.0);
            styles[which].mark(&mut canvas, (x, 24.0 + LINE * (row as f64 + 0.5) + aside));
        }
    }
    legend(&mut canvas, &styles, (12.0, bottom + 34.0), WIDTH - 20.0, false);
    if floored {
        let unit = if scale > 1.0 { " mm" } else { "" };
        let note = format!(
            "Errors below {}{unit} are drawn at that value; the table lists all errors.",
            tick(floor)
        );
        canvas.text((12.0, bottom + below + 8.0), &note, TEXT, GREY, Anchor::Start);
    }
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
        canvas,
        data: Data::Rows(rows),
    })
}
