//! Factors of loads, supports and tools as functions of time.

use thiserror::Error;

/// Bisections for the time at which a smooth curve passes a factor: to the last digit.
const HALVINGS: usize = 60;

/// Factor of a condition as a function of time: given at some times, constant before the first and after the
/// last.
///
/// Time is the fraction of the loading in statics, and in seconds in dynamics.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Times and factors, in the order of time.
    points: Vec<[f64; 2]>,
    /// Whether the factor passes from point to point with zero speed and acceleration at both.
    smooth: bool,
}

/// Reason why points are not a curve.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum CurveError {
    /// No point is given.
    #[error("has no point")]
    Empty,
    /// A time or a factor is not finite.
    #[error("has a time or a factor that is not finite at index {index}")]
    NotFinite {
        /// Index of the point.
        index: usize,
    },
    /// A time is not after the one before it.
    #[error("has {time} after {before} at index {index}")]
    NotIncreasing {
        /// Index of the point.
        index: usize,
        /// Its time.
        time: f64,
        /// Time of the point before it.
        before: f64,
    },
}

impl Curve {
    /// Passes through `points`, each a time and a factor, along straight lines; or, if `smooth`, along
    /// `10 s^3 - 15 s^4 + 6 s^5`, `s` from 0 to 1 between two points, whose velocity and acceleration are
    /// continuous.
    ///
    /// # Errors
    /// No point, a number that is not finite, or times that do not increase.
    pub fn new(points: Vec<[f64; 2]>, smooth: bool) -> Result<Curve, CurveError> {
        if points.is_empty() {
            return Err(CurveError::Empty);
        }
        if let Some(index) = points.iter().position(|point| !point.iter().all(|x| x.is_finite())) {
            return Err(CurveError::NotFinite { index });
        }
        if let Some(index) = (1..points.len()).find(|&k| points[k][0] <= points[k - 1][0]) {
            let (time, before) = (points[index][0], points[index - 1][0]);
            return Err(CurveError::NotIncreasing { index, time, before });
        }
        Ok(Curve { points, smooth })
    }

    /// Is 1 from the start.
    pub fn at_once() -> Curve {
        Curve { points: vec![[0.0, 1.0]], smooth: false }
    }

    /// Grows in proportion to time from 0 to 1 over a positive duration. The velocity of driven supports
    /// jumps at the start and the end, which causes waves in a body with inertia.
    ///
    /// # Panics
    /// If the duration is not positive and finite.
    pub fn growth(over: f64) -> Curve {
        assert!(over > 0.0 && over.is_finite(), "a growth over {over} s");
        Curve { points: vec![[0.0, 0.0], [over, 1.0]], smooth: false }
    }

    /// Grows from 0 to 1 as [`Curve::growth`] does, with zero velocity and acceleration at the start and the
    /// end.
    ///
    /// # Panics
    /// If the duration is not positive and finite.
    pub fn smooth_growth(over: f64) -> Curve {
        Curve { smooth: true, ..Curve::growth(over) }
    }

    /// Times and factors of the points, in the order of time.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Whether velocity and acceleration are continuous: a smooth curve, or a constant.
    pub fn is_smooth(&self) -> bool {
        self.smooth || self.points.iter().all(|point| point[1] == self.points[0][1])
    }

    /// Returns the factor at a time.
    pub fn value(&self, time: f64) -> f64 {
        self.derivatives(time)[0]
    }

    /// Returns the factor at a time, with its first and second derivative. At a kink, derivatives are those
    /// just after it.
    pub fn derivatives(&self, time: f64) -> [f64; 3] {
        let after = self.points.partition_point(|point| point[0] <= time);
        if after == 0 || after == self.points.len() {
            let held = self.points[after.saturating_sub(1)][1];
            return [held, 0.0, 0.0];
        }
        let ([start, from], [end, to]) = (self.points[after - 1], self.points[after]);
        let (over, gain) = (end - start, to - from);
        let s = (time - start) / over;
        if !self.smooth {
            return [from + gain * s, gain / over, 0.0];
        }
        [
            from + gain * (s * s * s * (10.0 + s * (6.0 * s - 15.0))),
            gain * (30.0 * (s * (1.0 - s)).powi(2) / over),
            gain * (60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (over * over)),
        ]
    }

    /// Returns the curve with `by` added to all factors.
    pub fn plus(&self, by: f64) -> Curve {
        Curve { points: self.points.iter().map(|[time, factor]| [*time, factor + by]).collect(), ..*self }
    }

    /// Returns the times at which the factor passes from one side of a value to the other, in order.
    pub fn passes(&self, factor: f64) -> Vec<f64> {
        let pieces = self.points.windows(2).map(|pair| (pair[0], pair[1]));
        let passing = pieces.filter(|([_, from], [_, to])| (from - factor) * (to - factor) < 0.0);
        let time = |([start, from], [end, to]): ([f64; 2], [f64; 2])| {
            if !self.smooth {
                return start + (factor - from) / (to - from) * (end - start);
            }
            let (mut low, mut high) = (start, end);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                *(if (self.value(middle) < factor) == (from < to) { &mut low } else { &mut high }) = middle;
            }
            0.5 * (low + high)
        };
        passing.map(time).collect()
    }

    /// Returns the largest factor.
    pub fn largest(&self) -> f64 {
        self.points.iter().map(|point| point[1]).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns the largest mean speed between two points.
    pub fn steepest(&self) -> f64 {
        let speeds = self.points.windows(2).map(|pair| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]));
        speeds.fold(0.0, |most, speed| most.max(speed.abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn up_and_down(smooth: bool) -> Curve {
        Curve::new(vec![[0.5, 0.0], [1.0, 2.0], [3.0, -1.0]], smooth).unwrap()
    }

    #[test]
    fn a_curve_passes_a_factor_at_these_times() {
        let up_and_down = up_and_down(false);
        let near = |found: Vec<f64>, expected: &[f64]| {
            assert_eq!(found.len(), expected.len(), "{found:?}");
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?}");
        };
        near(up_and_down.passes(0.5), &[0.625, 2.0]);
        near(up_and_down.passes(-0.5), &[8.0 / 3.0]);
        near(up_and_down.passes(2.5), &[]);
        near(Curve::smooth_growth(2.0).passes(0.5), &[1.0]);
        let smooth = Curve::smooth_growth(2.0);
        assert!((smooth.value(smooth.passes(0.2)[0]) - 0.2).abs() < 1e-14);
    }

    #[test]
    fn derivatives_are_those_of_the_value() {
        // The fourth derivative of the steepest piece is 1e4 1/s^4, so that differences are off by h^2 / 6 of it.
        let h = 1e-5;
        let curves = [
            Curve::at_once(),
            Curve::growth(2.0),
            Curve::smooth_growth(2.0),
            up_and_down(false),
            up_and_down(true),
        ];
        for curve in curves {
            for t in [0.3, 0.9, 1.7, 2.5, 3.5] {
                let [value, first, second] = curve.derivatives(t);
                let (up, down) = (curve.derivatives(t + h), curve.derivatives(t - h));
                assert_eq!(value, curve.value(t));
                assert!(((up[0] - down[0]) / (2.0 * h) - first).abs() < 1e-6, "{curve:?} {t}");
                assert!(((up[1] - down[1]) / (2.0 * h) - second).abs() < 1e-6, "{curve:?} {t}");
            }
        }
    }

    #[test]
    fn a_smooth_curve_has_no_kink() {
        let curve = Curve::smooth_growth(2.0);
        assert_eq!(curve.derivatives(0.0), [0.0; 3]);
        assert_eq!(curve.derivatives(2.0), [1.0, 0.0, 0.0]);
        let [value, first, second] = curve.derivatives(2.0 - 1e-6);
        assert!((value - 1.0).abs() < 1e-15 && first < 1e-11 && second.abs() < 2e-5);
        assert!((curve.value(1.0) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn a_curve_passes_through_its_points_and_is_constant_outside() {
        for smooth in [false, true] {
            let curve = up_and_down(smooth);
            for (time, factor) in
                [(0.0, 0.0), (0.5, 0.0), (0.75, 1.0), (1.0, 2.0), (2.0, 0.5), (3.0, -1.0), (9.0, -1.0)]
            {
                assert!((curve.value(time) - factor).abs() < 1e-15, "{time}");
            }
            assert_eq!((curve.steepest(), curve.largest()), (4.0, 2.0));
        }
    }

    #[test]
    fn points_in_disorder_are_refused() {
        let refused = |points: &[[f64; 2]]| Curve::new(points.to_vec(), false).unwrap_err();
        assert_eq!(refused(&[]), CurveError::Empty);
        assert_eq!(refused(&[[0.0, 1.0], [1.0, f64::NAN]]), CurveError::NotFinite { index: 1 });
        let error = refused(&[[0.0, 1.0], [1.0, 2.0], [1.0, 0.0]]);
        assert_eq!(error, CurveError::NotIncreasing { index: 2, time: 1.0, before: 1.0 });
    }
}
