//! RMS errors by direction: one row per run, and one scale for all columns.

use catalogue::metric;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use records::cell::csv_line;
use records::store::slug;
use records::text::significant;

use super::drawing::{BLACK_INK, Drawing, GREY, TEXT, bold, text, widest};
use super::figure::{Data, Figure};
use super::grid::WIDTH;
use crate::appearance::Look;
use crate::claims::reproduced;
use crate::select::{Run, competing, kernels, labels, representative, series};

const ROW: i32 = 160;
const TOP: i32 = 420;
/// Room for the number after the longest bar.
const NUMBER: i32 = 540;
const DIRECTIONS: [&str; 4] = ["RMS x [mm]", "RMS y [mm]", "RMS z [mm]", "RMS |u| [mm]"];
/// Error in mm below which a difference is rounding.
const NOTHING: f64 = 1e-9;

/// A row: name, four values (mm) and colour.
type Row = (String, [Option<f64>; 4], RGBColor);

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
        drawing: draw(&format!("{}, ν = {}", is.case, is.poisson), &rows),
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

fn draw(title: &str, rows: &[Row]) -> Drawing {
    let left = 120 + widest(rows.iter().map(|row| &row.0)).min(2400);
    let width = (WIDTH - left - 60) / DIRECTIONS.len() as i32;
    let bottom = TOP + ROW * rows.len() as i32;
    let largest = rows.iter().flat_map(|r| r.1).flatten().fold(NOTHING, f64::max);
    let scale = f64::from(width - NUMBER) / largest;
    Drawing::new(WIDTH, bottom + 80, |page| {
        page.draw_text(title, &bold(TEXT, HPos::Left), (60, 120))?;
        for (column, head) in DIRECTIONS.iter().enumerate() {
            let x = left + column as i32 * width;
            page.draw_text(head, &bold(TEXT, HPos::Left), (x, TOP - 140))?;
            page.draw(&PathElement::new([(x, TOP - 40), (x, bottom)], GREY.stroke_width(8)))?;
            for ((name, values, colour), y) in rows.iter().zip((TOP..).step_by(ROW as usize)) {
                if column == 0 {
                    page.draw_text(name, &text(TEXT, HPos::Right), (left - 60, y + ROW / 2))?;
                }
                let (length, number, shade) = match values[column] {
                    None => (0, "—".to_string(), GREY),
                    Some(v) if v < NOTHING => (0, "rounding".to_string(), GREY),
                    Some(v) => ((v * scale) as i32, significant(v, 2), BLACK_INK),
                };
                page.draw(&Rectangle::new([(x, y + 30), (x + length, y + ROW - 30)], colour.filled()))?;
                let style = TextStyle { color: shade.to_backend_color(), ..text(TEXT, HPos::Left) };
                page.draw_text(&number, &style, (x + length + 30, y + ROW / 2))?;
            }
        }
        Ok(())
    })
}
