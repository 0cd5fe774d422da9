//! Stability maps: a row for each method, a column for each value of an axis, and a colour for each verdict.

use records::cell::csv_line;
use records::store::slug;
use records::text::{short, significant};
use records::{Axis, AxisVerdict as Verdict, Trial};

use super::axes::TEXT;
use super::canvas::{Anchor, BLACK_INK, Canvas, Colour, GREY, text_width};
use super::figure::{Data, Figure};
use super::grid::{WIDTH, wrapped};
use crate::quantity::label_of_name;

const ROW: f64 = 15.0;
const TOP: f64 = 34.0;
const WHITE_INK: Colour = [0xff, 0xff, 0xff];

/// One figure per axis.
pub(super) fn maps(axes: &[Axis]) -> Vec<Figure> {
    let each = axes.iter().filter(|axis| !axis.trials.is_empty()).map(|axis| Figure {
        name: format!("stability-{}-{}", slug(&axis.case), slug(&axis.name)),
        title: format!("Where methods bend and break: {}, {}", axis.case, axis.name),
        caption: format!(
            "Numbers: {} in per cent; colours: classes of this error. Bold: at least twice the error at {}, where a \
             method bends; a result with {} % or more is wrong",
            label_of_name(&axis.judge),
            value(axis, axis.base),
            significant(100.0 * axis.wrong, 2),
        ),
        canvas: draw(axis),
        data: Data::Rows(csv(axis)),
    });
    each.collect()
}

/// A value of the axis with its unit.
fn value(axis: &Axis, v: f64) -> String {
    if axis.unit.is_empty() { short(v) } else { format!("{} {}", short(v), axis.unit) }
}

/// Colours of wrong or missing results: warned, refused, silent.
const BAD: [Colour; 3] = [[0xf0, 0xa2, 0x4a], [0xd8, 0xd8, 0xd8], [0xa5, 0x0f, 0x15]];
/// Colours of results that are not wrong, the best last.
const GOOD: [Colour; 3] = [[0xf7, 0xec, 0xb0], [0xd4, 0xe7, 0xf2], [0xa4, 0xcc, 0xe3]];

/// Colour of a class, by its index and the number of classes.
fn colour(class: usize, classes: usize) -> Colour {
    let good = classes - BAD.len();
    if class < good { GOOD[good - 1 - class] } else { BAD[class - good] }
}

fn csv(axis: &Axis) -> String {
    let mut out = csv_line(&["method", &axis.name, &axis.judge, "verdict", "reason"]);
    for trial in &axis.trials {
        let error = trial.error.map(|e| format!("{e:e}")).unwrap_or_default();
        let verdict = axis.verdict(trial).name();
        out.push_str(&csv_line(&[
            &trial.method,
            &format!("{:e}", trial.value),
            &error,
            verdict,
            &trial.reason,
        ]));
    }
    out
}

fn draw(axis: &Axis) -> Canvas {
    let methods = axis.methods();
    let left = 12.0 + methods.iter().map(|m| text_width(m, TEXT)).fold(40.0, f64::max).min(200.0);
    let width = (WIDTH - left - 6.0) / axis.values.len() as f64;
    let bottom = TOP + ROW * methods.len() as f64;
    let key = axis.classes();
    let notes = wrapped(&note(axis), WIDTH - 20.0);
    let mut canvas = Canvas::new(WIDTH, bottom + 34.0 + 12.0 * notes.len() as f64);
    let unit = if axis.unit.is_empty() { "1" } else { &axis.unit };
    canvas.bold((6.0, 12.0), &format!("{}: {} [{unit}]", axis.case, axis.name), TEXT, Anchor::Start);
    for (column, &v) in axis.values.iter().enumerate() {
        let x = left + column as f64 * width;
        let head = short(v);
        let size = TEXT.min(TEXT * (width - 3.0) / text_width(&head, TEXT));
        canvas.text((x + width / 2.0, TOP - 8.0), &head, size, BLACK_INK, Anchor::Middle);
        for (row, method) in methods.iter().enumerate() {
            let y = TOP + ROW * row as f64;
            if let Some(trial) = axis.trial(method, v) {
                fill(&mut canvas, (x, y, width - 1.0, ROW - 1.0), colour(axis.class(trial), key.len()));
                let at = (x + width / 2.0, y + ROW / 2.0);
                match axis.verdict(trial) {
                    Verdict::Silent => canvas.text(at, &number(trial), TEXT - 1.0, WHITE_INK, Anchor::Middle),
                    Verdict::Bends => canvas.bold(at, &number(trial), TEXT - 1.0, Anchor::Middle),
                    _ => canvas.text(at, &number(trial), TEXT - 1.0, BLACK_INK, Anchor::Middle),
                }
            }
        }
    }
    for (row, method) in methods.iter().enumerate() {
        let at = (left - 6.0, TOP + ROW * row as f64 + ROW / 2.0);
        canvas.text(at, method, TEXT, BLACK_INK, Anchor::End);
    }
    let mut x = 12.0;
    for (class, name) in key.iter().enumerate() {
        fill(&mut canvas, (x, bottom + 10.0, 12.0, 10.0), colour(class, key.len()));
        canvas.text((x + 16.0, bottom + 15.0), name, TEXT, BLACK_INK, Anchor::Start);
        x += 34.0 + text_width(name, TEXT);
    }
    for (i, line) in notes.iter().enumerate() {
        canvas.text((12.0, bottom + 34.0 + 12.0 * i as f64), line, TEXT, GREY, Anchor::Start);
    }
    canvas
}

fn note(axis: &Axis) -> String {
    format!(
        "Numbers: {} in per cent. Bold: at least twice the value at {} (the method bends). Wrong: {} % or more.",
        label_of_name(&axis.judge),
        value(axis, axis.base),
        significant(100.0 * axis.wrong, 2),
    )
}

fn fill(canvas: &mut Canvas, (x, y, width, height): (f64, f64, f64, f64), colour: Colour) {
    canvas.fill(&[(x, y), (x + width, y), (x + width, y + height), (x, y + height)], colour);
}

/// The error in per cent, in as few characters as possible.
fn number(trial: &Trial) -> String {
    match trial.error.map(|error| 100.0 * error) {
        None => "—".into(),
        Some(e) if e < 1e-3 => "0".into(),
        Some(e) if e >= 1e4 => ">9999".into(),
        Some(e) if e >= 100.0 => format!("{e:.0}"),
        Some(e) => significant(e, 2),
    }
}
