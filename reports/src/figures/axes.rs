//! Axes: mapping from values to paper, ticks and frame.

use records::text::{power, tick};

use super::canvas::{Anchor, BLACK_INK, Canvas, GREY, PALE, text_width};

/// Size of ordinary text, points.
pub(crate) const TEXT: f64 = 9.0;

/// One axis.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    label: String,
    log: bool,
    low: f64,
    high: f64,
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

    /// Tick values with their texts.
    pub(crate) fn ticks(&self) -> &[(f64, String)] {
        &self.ticks
    }

    pub(crate) fn low(&self) -> f64 {
        self.low
    }

    pub(crate) fn high(&self) -> f64 {
        self.high
    }

    fn fraction(&self, value: f64) -> f64 {
        if self.log {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
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
fn apart(texts: &[(f64, f64)]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..texts.len()).collect();
    order.sort_by(|&a, &b| texts[a].1.total_cmp(&texts[b].1));
    let mut written = vec![false; texts.len()];
    for a in order {
        let (at, width) = texts[a];
        let touches = |b: usize| (at - texts[b].0).abs() < (width + texts[b].1) / 2.0 + 2.0;
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

/// A framed plot.
#[derive(Clone, Debug)]
pub(crate) struct Panel {
    /// Left, top, right, bottom of the frame, points.
    pub(crate) frame: (f64, f64, f64, f64),
    pub(crate) x: Axis,
    pub(crate) y: Axis,
}

impl Panel {
    /// Position on paper of a pair of values. Values beyond an axis are placed on the frame.
    pub(crate) fn at(&self, x: f64, y: f64) -> (f64, f64) {
        let (left, top, right, bottom) = self.frame;
        let (fx, fy) = (self.x.fraction(x).clamp(0.0, 1.0), self.y.fraction(y).clamp(0.0, 1.0));
        (left + fx * (right - left), bottom - fy * (bottom - top))
    }

    /// Draws grid, frame, ticks, axis labels and title.
    pub(crate) fn draw(&self, canvas: &mut Canvas, title: &str) {
        let (left, top, right, bottom) = self.frame;
        let across = |(value, text): &(f64, String)| (self.at(*value, self.y.low).0, text_width(text, TEXT));
        let places: Vec<(f64, f64)> = self.x.ticks.iter().map(across).collect();
        for (((at, _), _), (_, text)) in
            places.iter().zip(apart(&places)).zip(&self.x.ticks).filter(|((_, has_room), _)| *has_room)
        {
            canvas.line(&[(*at, top), (*at, bottom)], PALE, 0.5);
            canvas.line(&[(*at, bottom), (*at, bottom + 3.0)], BLACK_INK, 0.6);
            canvas.text((*at, bottom + 9.5), text, TEXT, BLACK_INK, Anchor::Middle);
        }
        for value in &self.x.minor {
            let (at, _) = self.at(*value, self.y.low);
            canvas.line(&[(at, bottom), (at, bottom + 1.5)], GREY, 0.4);
        }
        for (value, text) in &self.y.ticks {
            let (_, at) = self.at(self.x.low, *value);
            canvas.line(&[(left, at), (right, at)], PALE, 0.5);
            canvas.line(&[(left - 3.0, at), (left, at)], BLACK_INK, 0.6);
            canvas.text((left - 5.0, at), text, TEXT, BLACK_INK, Anchor::End);
        }
        for value in &self.y.minor {
            let (_, at) = self.at(self.x.low, *value);
            canvas.line(&[(left - 1.5, at), (left, at)], GREY, 0.4);
        }
        canvas.line(&[(left, top), (left, bottom), (right, bottom)], GREY, 0.8);
        canvas.text(((left + right) / 2.0, bottom + 22.0), &self.x.label, TEXT, BLACK_INK, Anchor::Middle);
        if !self.y.label.is_empty() {
            let widest = self.y.ticks.iter().map(|(_, text)| text_width(text, TEXT)).fold(0.0, f64::max);
            let aside = (widest + 11.0).clamp(46.0, 54.0);
            canvas.vertical((left - aside, (top + bottom) / 2.0), &self.y.label, TEXT);
        }
        canvas.bold((left, top - 8.0), title, TEXT, Anchor::Start);
    }
}

#[cfg(test)]
mod tests {
    use super::{Axis, apart, log_ticks, minor};

    #[test]
    fn texts_that_would_touch_give_way_to_shorter_ones() {
        assert_eq!(
            apart(&[(0.0, 30.0), (20.0, 16.0), (45.0, 20.0), (80.0, 16.0)]),
            [false, true, true, true]
        );
        assert_eq!(apart(&[(0.0, 30.0), (26.0, 16.0)]), [true, true]);
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
            axis.ticks().iter().map(|t| t.1.clone()).collect::<Vec<_>>()
        };
        assert_eq!(texts(2.4e-5), ["0", "10⁻⁵", "2×10⁻⁵"]);
        assert_eq!(texts(0.01), ["0.0000", "0.0025", "0.0050", "0.0075", "0.0100"]);
    }

    #[test]
    fn a_narrow_axis_still_names_its_values() {
        assert!((1..60).all(|i| log_ticks(i as f64, 1.4 * i as f64).len() > 1));
    }
}
