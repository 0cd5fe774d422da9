//! Axes: coordinates of a chart with their ticks, and its frame.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use records::text::{power, tick};

use super::backend::Paths;
use super::drawing::{Area, Drawn, GREY, PALE, TEXT, bold, text, text_width};
use crate::plot::Scale;

/// A chart with its series.
pub(crate) type Chart<'a> = ChartContext<'a, Paths, Cartesian2d<Axis, Axis>>;

/// Room left of the frame for tick labels and the name of the axis.
pub(crate) const LEFT: i32 = 600;
/// Room left of the name of an axis.
const EDGE: i32 = 30;
/// Room right of the frame for a short label.
const RIGHT: i32 = 180;
/// Room above the frame for a title.
pub(crate) const ABOVE: i32 = 270;
/// Room below the frame for tick labels and the name of the axis.
pub(crate) const BELOW: i32 = 280;
/// Length of a tick; plotters writes its label twice as far from the frame.
const TICK: i32 = 30;

/// One axis.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    label: String,
    log: bool,
    low: f64,
    high: f64,
    /// Values and their texts. The key points of plotters are unsuitable: fewer than three on a short
    /// logarithmic axis, and compared with an absolute tolerance on a linear one.
    ticks: Vec<(f64, String)>,
    /// Short marks between the ticks.
    minor: Vec<f64>,
}

impl Axis {
    /// Creates a logarithmic axis that is slightly wider than its positive values.
    pub(crate) fn log(label: &str, values: impl Iterator<Item = f64>) -> Axis {
        let (mut low, mut high) = range(values.filter(|v| *v > 0.0 && v.is_finite())).unwrap_or((0.1, 1.0));
        let margin = (high / low).powf(0.06).max(1.15);
        (low, high) = (low / margin, high * margin);
        let (ticks, minor) = (log_ticks(low, high), minor(low, high));
        Axis { label: label.into(), log: true, low, high, ticks, minor }
    }

    /// Creates a linear axis around values, starting at zero if `from_zero`.
    pub(crate) fn linear(label: &str, values: impl Iterator<Item = f64>, from_zero: bool) -> Axis {
        let (mut low, mut high) = range(values.filter(|v| v.is_finite())).unwrap_or((0.0, 1.0));
        if from_zero {
            (low, high) = (low.min(0.0), high.max(0.0));
        }
        let span = if high > low { high - low } else { high.abs().max(1.0) };
        let raw = span / 4.0;
        let decade = 10f64.powf(raw.log10().floor());
        let step =
            [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().map(|s| s * decade).find(|s| *s >= raw).unwrap_or(raw);
        if !from_zero || low < 0.0 {
            low -= 0.06 * span;
        }
        high += 0.06 * span;
        let decimals = (0..6)
            .find(|d| ((step * 10f64.powi(*d)).round() - step * 10f64.powi(*d)).abs() < 1e-6)
            .unwrap_or(6);
        // Trailing decimals would take more room than an axis has.
        let text = |v: f64| if decimals < 5 { format!("{v:.*}", decimals as usize) } else { power(v) };
        let ticks = ((low / step).ceil() as i64..=(high / step).floor() as i64)
            .map(|i| (i as f64 * step, text(i as f64 * step)))
            .collect();
        Axis { label: label.into(), log: false, low, high, ticks, minor: Vec::new() }
    }

    /// Creates an axis of the given scale, from zero if it is linear.
    pub(crate) fn of(scale: &Scale, values: impl Iterator<Item = f64>) -> Axis {
        let label = scale.label();
        if scale.log { Axis::log(&label, values) } else { Axis::linear(&label, values, true) }
    }

    /// Creates an axis of named steps from zero, of length 1 (to the right) or -1 (downwards).
    pub(crate) fn named(names: impl ExactSizeIterator<Item = String>, step: f64) -> Axis {
        let end = step * names.len() as f64;
        let ticks = names.enumerate().map(|(k, name)| (step * (k as f64 + 0.5), name)).collect();
        let (low, high) = (end.min(0.0), end.max(0.0));
        Axis { label: String::new(), log: false, low, high, ticks, minor: Vec::new() }
    }

    /// Replaces the ticks.
    pub(crate) fn with_ticks(mut self, ticks: Vec<(f64, String)>) -> Axis {
        (self.ticks, self.minor) = (ticks, Vec::new());
        self
    }

    /// Removes the label, for an axis whose neighbour already has it.
    pub(crate) fn without_label(mut self) -> Axis {
        self.label.clear();
        self
    }

    /// Removes ticks whose texts would touch on a horizontal axis of the given length.
    fn spaced(mut self, length: i32) -> Axis {
        let places = self.ticks.iter().map(|(at, text)| (self.map(at, (0, length)), text_width(text, TEXT)));
        let mut has_room = apart(&places.collect::<Vec<_>>()).into_iter();
        self.ticks.retain(|_| has_room.next().unwrap_or(true));
        self
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    /// Values beyond the axis are placed at its ends.
    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let value = value.clamp(self.low, self.high);
        match self.log {
            true => LogCoord::from(self.range().log_scale()).map(&value, limit),
            false => RangedCoordf64::from(self.range()).map(&value, limit),
        }
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        match hint.weight().allow_light_points() {
            true => self.minor.clone(),
            false => self.ticks.iter().map(|tick| tick.0).collect(),
        }
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        self.ticks.iter().find(|tick| tick.0 == *value).map(|tick| tick.1.clone()).unwrap_or_default()
    }
}

/// Ticks with the coarsest steps that give three of them: decades, 1-3, 1-2-5 and ever finer. At most seven
/// decades are labelled.
fn log_ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    const STEPS: [&[f64]; 6] = [
        &[1.0],
        &[1.0, 3.0],
        &[1.0, 2.0, 5.0],
        &[1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0],
        &[1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0],
        &[1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.5, 2.8, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 9.0],
    ];
    let stride = ((high / low).log10() / 6.0).ceil().max(1.0) as i32;
    let mut ticks = Vec::new();
    for steps in STEPS {
        ticks.clear();
        for power in low.log10().floor() as i32..=high.log10().ceil() as i32 {
            if steps.len() > 1 || power.rem_euclid(stride) == 0 {
                ticks
                    .extend(steps.iter().map(|s| s * 10f64.powi(power)).filter(|v| (low..=high).contains(v)));
            }
        }
        if ticks.len() > 2 {
            break;
        }
    }
    // Labels of an axis are all plain numbers, or all powers of ten if a plain number would be long.
    let plain = ticks.iter().all(|v| (0.9e-3..1.1e3).contains(v));
    ticks.into_iter().map(|v| (v, if plain { tick(v) } else { power(v) })).collect()
}

/// Minor ticks at two to nine times every power of ten, or only at the powers on a long axis.
fn minor(low: f64, high: f64) -> Vec<f64> {
    let steps = if high < 1e5 * low { 1..10 } else { 1..2 };
    let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let all = powers.flat_map(|p| steps.clone().map(move |s| f64::from(s) * 10f64.powi(p)));
    all.filter(|v| (low..=high).contains(v)).collect()
}

/// Whether each text on a line has room, given its centre and width. If two would touch, the longer is
/// dropped.
fn apart(texts: &[(i32, i32)]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..texts.len()).collect();
    order.sort_by(|&a, &b| texts[a].1.cmp(&texts[b].1));
    let mut written = vec![false; texts.len()];
    for a in order {
        let (at, width) = texts[a];
        let touches = |b: usize| (at - texts[b].0).abs() < (width + texts[b].1) / 2 + 20;
        written[a] = !(0..texts.len()).any(|b| written[b] && touches(b));
    }
    written
}

fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, v| match range {
        None => Some((v, v)),
        Some((low, high)) => Some((low.min(v), high.max(v))),
    })
}

/// Creates a chart with a frame, ticks, labels and a title, and the given room left of its frame.
pub(super) fn framed<'a>(area: &Area, left: i32, title: &str, x: Axis, y: Axis) -> Drawn<Chart<'a>> {
    let x = x.spaced(area.dim_in_pixel().0 as i32 - left - RIGHT);
    let labels = (x.label.clone(), y.label.clone());
    let mut chart = ChartBuilder::on(area)
        .margin_top(ABOVE)
        .margin_right(RIGHT)
        .x_label_area_size(BELOW)
        .margin_left(EDGE)
        .y_label_area_size(left - EDGE)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .x_desc(labels.0)
        .y_desc(labels.1)
        .label_style(text(TEXT, HPos::Center))
        .axis_style(GREY.stroke_width(8))
        .bold_line_style(PALE.stroke_width(5))
        .light_line_style(TRANSPARENT)
        .set_all_tick_mark_size(TICK)
        .draw()?;
    // The mesh of plotters has no short marks between the ticks, and a caption is centred on the whole area.
    let (x, y) = (chart.as_coord_spec().x_spec(), chart.as_coord_spec().y_spec());
    let below = x.minor.iter().map(|at| (chart.backend_coord(&(*at, y.low)), (0, TICK / 2)));
    let beside = y.minor.iter().map(|at| (chart.backend_coord(&(x.low, *at)), (-TICK / 2, 0)));
    for (from, step) in below.chain(beside) {
        let mark = [from, (from.0 + step.0, from.1 + step.1)];
        area.use_screen_coord().draw(&PathElement::new(mark, GREY.stroke_width(4)))?;
    }
    area.draw_text(title, &bold(TEXT, HPos::Left), (left, ABOVE - 80))?;
    Ok(chart)
}

#[cfg(test)]
mod tests {
    use super::{Axis, apart, log_ticks, minor};

    #[test]
    fn texts_that_would_touch_give_way_to_shorter_ones() {
        assert_eq!(apart(&[(0, 300), (200, 160), (450, 200), (800, 160)]), [false, true, true, true]);
        assert_eq!(apart(&[(0, 300), (260, 160)]), [true, true]);
    }

    #[test]
    fn every_logarithmic_axis_has_three_ticks() {
        let texts = |low, high| log_ticks(low, high).into_iter().map(|t| t.1).collect::<Vec<_>>();
        assert_eq!(texts(1e-4, 2.0), ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "1"]);
        assert_eq!(texts(2.5e-4, 0.02), ["3×10⁻⁴", "10⁻³", "3×10⁻³", "10⁻²"]);
        assert_eq!(texts(9e-4, 0.2), ["0.001", "0.01", "0.1"]);
        assert_eq!(texts(200.0, 2e6), ["10³", "10⁴", "10⁵", "10⁶"]);
        assert_eq!(texts(0.025, 1.4), ["0.03", "0.1", "0.3", "1"]);
        assert_eq!(texts(2.3, 13.0), ["3", "4", "6", "8", "10"]);
        assert_eq!(texts(230.0, 650.0), ["300", "400", "600"]);
        assert_eq!(texts(2.1, 5.8), ["2.5", "3", "4", "5"]);
        assert_eq!(texts(4.0, 9.0), ["4", "6", "8"]);
    }

    #[test]
    fn between_ticks_are_the_multiples_of_the_powers_of_ten() {
        let near = |found: Vec<f64>, expected: &[f64]| {
            found.len() == expected.len()
                && found.iter().zip(expected).all(|(f, e)| (f / e - 1.0).abs() < 1e-12)
        };
        assert!(near(minor(0.045, 0.35), &[0.05, 0.06, 0.07, 0.08, 0.09, 0.1, 0.2, 0.3]));
        assert!(near(minor(0.9e-6, 1.1), &[1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0]));
    }

    #[test]
    fn a_linear_axis_of_tiny_values_has_short_texts() {
        let texts = |high| {
            let axis = Axis::linear("", [0.0, high].into_iter(), true);
            axis.ticks.iter().map(|t| t.1.clone()).collect::<Vec<_>>()
        };
        assert_eq!(texts(2.4e-5), ["0", "10⁻⁵", "2×10⁻⁵"]);
        assert_eq!(texts(0.01), ["0.0000", "0.0025", "0.0050", "0.0075", "0.0100"]);
    }

    #[test]
    fn a_narrow_axis_still_names_its_values() {
        assert!((1..60).all(|i| log_ticks(i as f64, 1.4 * i as f64).len() > 1));
    }
}
