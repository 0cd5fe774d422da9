//! RMS errors by direction, and transfer schemes: rows with a name each.

use std::collections::BTreeSet;

use super::axes::{Axis, Panel, TEXT};
use super::canvas::{Anchor, BLACK_INK, Canvas, Colour, GREY, PALE, text_width};
use super::grid::WIDTH;
use super::style::{legend, legend_height, styles};
use super::{Figure, representative};
use crate::paper::PUBLISHED;
use crate::select::{Run, groups, labels, series};
use crate::store::slug;
use crate::text::{significant, tick};

const ROW: f64 = 16.0;
/// Height of a row with several markers.
const LINE: f64 = 20.0;
const DIRECTIONS: [(&str, &str); 4] =
    [("rms-x", "RMS x [mm]"), ("rms-y", "RMS y [mm]"), ("rms-z", "RMS z [mm]"), ("rms", "RMS |u| [mm]")];

/// One figure per case that isn't a patch test: every run, or the finest of each series where those are too many.
pub(super) fn rms(runs: &[Run]) -> Vec<Figure> {
    let mut out = Vec::new();
    for case in groups(runs, |r| r.is.case.clone()) {
        let group = representative(case, 0.495);
        let mut rows: Vec<Run> = group.to_vec();
        if rows.len() > 24 {
            rows = series(group).iter().map(|s| s.finest().clone()).collect();
        }
        rows.retain(|r| DIRECTIONS.iter().any(|(q, _)| r.value(q).is_some_and(|v| v > 1e-12)));
        if !rows.is_empty() && !case[0].is.case.contains("patch") {
            out.push(rms_figure(&rows));
        }
    }
    out
}

fn rms_figure(rows: &[Run]) -> Figure {
    let is = rows[0].is;
    let kidney = is.case.contains("kidney");
    let named: Vec<_> = rows.iter().map(|r| (r.is.method.as_str(), r.is)).collect();
    let mut names = labels(&named);
    for (i, run) in rows.iter().enumerate() {
        if rows.iter().enumerate().any(|(j, _)| i != j && names[i] == names[j]) || run.name() == run.is.method
        {
            names[i] = format!("{}, {} nodes", names[i], run.is.nodes);
        }
    }
    let left = 10.0 + names.iter().map(|n| text_width(n, TEXT)).fold(40.0, f64::max).min(190.0);
    let width = (WIDTH - left - 6.0 - 3.0 * 10.0) / 4.0;
    let bottom = 28.0 + ROW * rows.len() as f64;
    let mut canvas = Canvas::new(WIDTH, bottom + if kidney { 24.0 } else { 8.0 });
    for (row, name) in names.iter().enumerate() {
        canvas.text((left - 6.0, 28.0 + ROW * (row as f64 + 0.5)), name, TEXT, BLACK_INK, Anchor::End);
    }
    for (column, (quantity, head)) in DIRECTIONS.iter().enumerate() {
        let x = left + column as f64 * (width + 10.0);
        let published = PUBLISHED.iter().find(|p| kidney && p.quantity == *quantity).map(|p| p.value);
        let value = |r: &Run| r.value(quantity);
        let largest = rows.iter().filter_map(value).chain(published).fold(0.0, f64::max);
        canvas.bold((x, 14.0), head, TEXT, Anchor::Start);
        canvas.line(&[(x, 24.0), (x, bottom)], GREY, 0.8);
        // Room for the number behind the longest bar.
        let scale = if largest > 0.0 { (width - 44.0) / largest } else { 0.0 };
        if let Some(at) = published.map(|p| x + p * scale) {
            canvas.dashed(&[(at, 24.0), (at, bottom)], [0xd5, 0x5e, 0x00], 1.1, &[3.0, 2.0]);
        }
        for (row, run) in rows.iter().enumerate() {
            let y = 28.0 + ROW * row as f64;
            let Some(v) = value(run) else {
                canvas.text((x + 3.0, y + ROW / 2.0), "—", TEXT, GREY, Anchor::Start);
                continue;
            };
            let end = x + v * scale;
            let colour: Colour = if run.is.family == "fem" { [0x00, 0x72, 0xb2] } else { [0x00, 0x9e, 0x73] };
            canvas.fill(&[(x, y + 3.0), (end, y + 3.0), (end, y + ROW - 3.0), (x, y + ROW - 3.0)], colour);
            let number = significant(v * 1e3, 2);
            let (right, middle) = (end + 4.0 + text_width(&number, TEXT), y + ROW / 2.0);
            // White behind the number where the published line runs through it.
            let (top, foot) = (middle - 5.0, middle + 5.0);
            canvas.fill(&[(end + 0.5, top), (right, top), (right, foot), (end + 0.5, foot)], [255, 255, 255]);
            canvas.text((end + 3.0, middle), &number, TEXT, BLACK_INK, Anchor::Start);
        }
    }
    if kidney {
        canvas.dashed(&[(10.0, bottom + 12.0), (30.0, bottom + 12.0)], [0xd5, 0x5e, 0x00], 1.1, &[3.0, 2.0]);
        canvas.text(
            (34.0, bottom + 12.0),
            "published RMS difference of EFG from FE (text)",
            TEXT,
            GREY,
            Anchor::Start,
        );
    }
    Figure {
        name: format!("rms-{}", slug(&is.case)),
        title: format!("RMS errors, {} (ν = {})", is.case, is.poisson),
        caption: "Root mean square of the displacement difference from the reference; finite elements blue, meshfree methods green".into(),
        canvas,
    }
}

/// Transfer error by scheme: one panel per case, one marker per field or source.
pub(super) fn transfer(runs: &[Run]) -> Vec<Figure> {
    let schemes: Vec<Run> = runs.iter().filter(|r| r.is.family == "interp").cloned().collect();
    groups(&schemes, |r| r.is.case.clone()).into_iter().filter_map(transfer_figure).collect()
}

fn source(run: &Run) -> String {
    let field = run.is.parameter("field").map(|f| format!("{f} field"));
    field.or(run.is.parameter("from").map(|f| format!("from {f}"))).unwrap_or_else(|| "transfer".into())
}

fn transfer_figure(runs: &[Run]) -> Option<Figure> {
    let (quantity, label, scale) = [
        ("rms", "RMS error of the transfer [mm]", 1e3),
        ("l2", "relative L2 error of the transfer [1]", 1.0),
    ]
    .into_iter()
    .find(|(q, _, _)| runs.iter().any(|r| r.value(q).is_some()))?;
    let scheme = |r: &Run| {
        let own = |p: &&str| !p.is_empty() && !p.starts_with("from=") && !p.starts_with("field=");
        let settings: Vec<String> =
            r.is.parameters.split(';').filter(own).map(|p| p.replace('=', " ")).collect();
        if settings.is_empty() {
            r.is.variant.clone()
        } else {
            format!("{} ({})", r.is.variant, settings.join(", "))
        }
    };
    let names: Vec<String> = runs.iter().map(scheme).collect::<BTreeSet<_>>().into_iter().collect();
    let styles = styles(&runs.iter().map(|r| (source(r), false)).collect::<Vec<_>>());
    let raw: Vec<f64> = runs.iter().filter_map(|r| r.value(quantity)).map(|v| v * scale).collect();
    // Schemes that are exact to rounding would squeeze all others into a corner.
    let largest = raw.iter().copied().fold(0.0, f64::max).max(1e-9);
    let floor = 10f64.powf((largest * 1e-3).log10().floor());
    let values: Vec<f64> = raw.iter().map(|v| v.max(floor)).collect();
    let left = 14.0 + names.iter().map(|n| text_width(n, TEXT)).fold(40.0, f64::max).min(250.0);
    let bottom = 26.0 + LINE * names.len() as f64;
    let below = 34.0 + legend_height(&styles, WIDTH - 20.0);
    let mut canvas = Canvas::new(WIDTH, bottom + below + 18.0);
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
    let note = format!("Errors below {} are drawn at that value; the table has them all.", tick(floor));
    legend(&mut canvas, &styles, (12.0, bottom + 34.0), WIDTH - 20.0);
    canvas.text((12.0, bottom + below + 8.0), &note, TEXT, GREY, Anchor::Start);
    let case = &runs[0].is.case;
    Some(Figure {
        name: format!("transfer-{}", slug(case)),
        title: format!("Transfer schemes compared, {case}"),
        caption: "Error that carrying a field from the nodes to the target points adds by itself".into(),
        canvas,
    })
}
