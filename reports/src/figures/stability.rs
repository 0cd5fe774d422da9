//! Stability maps: a row for each method, a column for each value of an axis, and a colour for each verdict.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use records::cell::csv_line;
use records::store::slug;
use records::text::{short, significant};
use records::{Axis, AxisVerdict as Verdict, Trial};

use super::drawing::{Drawing, TEXT, bold, text, text_width, widest};
use super::figure::{Data, Figure};
use super::grid::{WIDTH, with_foot};
use super::style::{self, Key};
use crate::quantity::label_of_name;

const ROW: i32 = 150;
const TOP: i32 = 340;

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
        drawing: draw(axis),
        data: Data::Rows(csv(axis)),
    });
    each.collect()
}

/// A value of the axis with its unit.
fn value(axis: &Axis, v: f64) -> String {
    if axis.unit.is_empty() { short(v) } else { format!("{} {}", short(v), axis.unit) }
}

/// Colours of wrong or missing results: warned, refused, silent.
const BAD: [RGBColor; 3] =
    [RGBColor(0xf0, 0xa2, 0x4a), RGBColor(0xd8, 0xd8, 0xd8), RGBColor(0xa5, 0x0f, 0x15)];
/// Colours of results that are not wrong, the best last.
const GOOD: [RGBColor; 3] =
    [RGBColor(0xf7, 0xec, 0xb0), RGBColor(0xd4, 0xe7, 0xf2), RGBColor(0xa4, 0xcc, 0xe3)];

/// Colour of a class, by its index and the number of classes.
fn colour(class: usize, classes: usize) -> RGBColor {
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

fn draw(axis: &Axis) -> Drawing {
    let methods = axis.methods();
    let left = 120 + widest(methods.iter()).min(2000);
    let width = (WIDTH - left - 60) / axis.values.len().max(1) as i32;
    let classes = axis.classes();
    let unit = if axis.unit.is_empty() { "1" } else { &axis.unit };
    let key = |(class, name): (usize, &String)| -> Key {
        let fill = colour(class, classes.len()).filled();
        (name.clone(), Rectangle::new([(120, 20), (240, style::ROW - 20)], fill).into_dyn())
    };
    let keys = classes.iter().enumerate().map(key).collect();
    with_foot(WIDTH, TOP + ROW * methods.len() as i32, keys, &note(axis), |area| {
        let title = format!("{}: {} [{unit}]", axis.case, axis.name);
        area.draw_text(&title, &bold(TEXT, HPos::Left), (60, 120))?;
        for (method, y) in methods.iter().zip((TOP..).step_by(ROW as usize)) {
            area.draw_text(method, &text(TEXT, HPos::Right), (left - 60, y + ROW / 2))?;
        }
        for (&v, x) in axis.values.iter().zip((left..).step_by(width as usize)) {
            let head = short(v);
            let size = TEXT * (f64::from(width - 30) / f64::from(text_width(&head, TEXT))).min(1.0);
            area.draw_text(&head, &text(size, HPos::Center), (x + width / 2, TOP - 80))?;
            for (method, y) in methods.iter().zip((TOP..).step_by(ROW as usize)) {
                let Some(trial) = axis.trial(method, v) else { continue };
                let fill = colour(axis.class(trial), classes.len()).filled();
                area.draw(&Rectangle::new([(x, y), (x + width - 10, y + ROW - 10)], fill))?;
                let style = match axis.verdict(trial) {
                    Verdict::Silent => text(TEXT - 10.0, HPos::Center).color(&WHITE),
                    Verdict::Bends => bold(TEXT - 10.0, HPos::Center),
                    _ => text(TEXT - 10.0, HPos::Center),
                };
                area.draw_text(&number(trial), &style, (x + width / 2, y + ROW / 2))?;
            }
        }
        Ok(())
    })
}

fn note(axis: &Axis) -> String {
    format!(
        "Numbers: {} in per cent. Bold: at least twice the value at {} (the method bends). Wrong: {} % or more.",
        label_of_name(&axis.judge),
        value(axis, axis.base),
        significant(100.0 * axis.wrong, 2),
    )
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
