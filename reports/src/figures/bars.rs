//! RMS errors by direction: one row per run, and one scale for all columns.

use catalogue::metric;
use records::cell::csv_line;
use records::store::slug;
use records::text::significant;

use super::axes::TEXT;
use super::canvas::{Anchor, BLACK_INK, Canvas, Colour, GREY, text_width};
use super::figure::{Data, Figure};
use super::grid::WIDTH;
use crate::appearance::Look;
use crate::claims::reproduced;
use crate::select::{Run, competing, kernels, labels, representative, series};

const ROW: f64 = 16.0;
const TOP: f64 = 42.0;
const DIRECTIONS: [&str; 4] = ["RMS x [mm]", "RMS y [mm]", "RMS z [mm]", "RMS |u| [mm]"];
/// Error in mm below which a difference is rounding.
const NOTHING: f64 = 1e-9;

/// A row: name, four values (mm) and colour.
type Row = (String, [Option<f64>; 4], Colour);

/// One figure per case except patch tests: every run of the usual kernel, or only the finest of each series
/// if there are too many.
pub(super) fn rms(runs: &[Run]) -> Vec<Figure> {
    competing(runs).filter_map(|case| figure(representative(case, 0.495))).collect()
}

fn figure(group: &[Run]) -> Option<Figure> {
    let is = group[0].is;
    let (usual, compared) = kernels(&series(group));
    let many = usual.iter().map(|s| s.runs.len()).sum::<usize>() > 24;
    let names = labels(usual.iter().map(|s| s.is()));
    let mut rows: Vec<Row> = Vec::new();
    for (series, name) in usual.iter().zip(names) {
        let runs = if many { std::slice::from_ref(series.finest()) } else { &series.runs[..] };
        for run in runs {
            let values = metric::RMS.parts().map(|part| run.value(part).map(|v| v * 1e3));
            // An error of exactly zero belongs to the reference itself.
            if values.iter().flatten().any(|v| *v > 0.0) {
                let colour = Look::of(&name, run.is.family).colour;
                rows.push((format!("{name}, {} nodes", run.is.nodes), values, colour));
            }
        }
    }
    if rows.iter().all(|r| r.1.iter().flatten().all(|v| *v < NOTHING)) {
        return None;
    }
    let published = reproduced(is)
        .map(|claim| metric::BESIDE_RMS.parts().map(|part| claim.transferred(part).map(|value| value * 1e3)));
    rows.extend(published.map(|values| ("published, between its methods".into(), values, GREY)));
    let mut caption = String::from(
        "Root mean square of the displacement difference from the reference, with one scale for all columns and one \
         colour per method",
    );
    if published.is_some() {
        caption += "; grey: the difference between the publication's own methods";
    }
    if usual.iter().map(|s| s.runs.len()).sum::<usize>() > 24 {
        caption += "; the finest run of each method";
    }
    if let Some(reference) = group.iter().find(|r| r.is_reference()) {
        caption += &format!("; the reference, {}, has no error and no row", reference.name());
    }
    if !compared.is_empty() {
        caption += "; other kernels are in the table";
    }
    Some(Figure {
        name: format!("rms-{}", slug(&is.case)),
        title: format!("RMS errors, {} (ν = {})", is.case, is.poisson),
        caption,
        canvas: draw(&format!("{}, ν = {}", is.case, is.poisson), &rows),
        data: Data::Rows(csv(&rows)),
    })
}

fn csv(rows: &[Row]) -> String {
    let mut out = csv_line(&[&["run"], &DIRECTIONS[..]].concat());
    for (name, values, _) in rows {
        let values = values.map(|v| v.map(|v| format!("{v:e}")).unwrap_or_default());
        out.push_str(&csv_line(&[&[name.as_str()], &values.each_ref().map(String::as_str)[..]].concat()));
    }
    out
}

fn draw(title: &str, rows: &[Row]) -> Canvas {
    let left = 12.0 + rows.iter().map(|r| text_width(&r.0, TEXT)).fold(40.0, f64::max).min(240.0);
    let width = (WIDTH - left - 6.0 - 3.0 * 8.0) / 4.0;
    let bottom = TOP + ROW * rows.len() as f64;
    let mut canvas = Canvas::new(WIDTH, bottom + 8.0);
    canvas.bold((6.0, 12.0), title, TEXT, Anchor::Start);
    let largest = rows.iter().flat_map(|r| r.1).flatten().fold(NOTHING, f64::max);
    // Room for the number after the longest bar.
    let scale = (width - 46.0) / largest;
    for (column, head) in DIRECTIONS.iter().enumerate() {
        let x = left + column as f64 * (width + 8.0);
        canvas.bold((x, 28.0), head, TEXT, Anchor::Start);
        canvas.line(&[(x, TOP - 4.0), (x, bottom)], GREY, 0.8);
        for (row, (name, values, colour)) in rows.iter().enumerate() {
            let y = TOP + ROW * row as f64;
            if column == 0 {
                canvas.text((left - 6.0, y + ROW / 2.0), name, TEXT, BLACK_INK, Anchor::End);
            }
            let (end, number, ink) = match values[column] {
                None => (x, "—".to_string(), GREY),
                Some(v) if v < NOTHING => (x, "rounding".to_string(), GREY),
                Some(v) => (x + v * scale, significant(v, 2), BLACK_INK),
            };
            if end > x {
                canvas
                    .fill(&[(x, y + 3.0), (end, y + 3.0), (end, y + ROW - 3.0), (x, y + ROW - 3.0)], *colour);
            }
            canvas.text((end + 3.0, y + ROW / 2.0), &number, TEXT, ink, Anchor::Start);
        }
    }
    canvas
}
