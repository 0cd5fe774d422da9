//! A curve through the load steps of a run, interpolated between them.

/// A curve through points of increasing `x`.
///
/// Between two points it is the cubic with the slopes of parabolas through three points each (Catmull and Rom
/// 1974 for equal steps): its error falls by the cube of the step, that of a line by the square.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    points: Vec<(f64, f64)>,
    slopes: Vec<f64>,
}

/// The range of a curve that does not have a place.
#[derive(Debug, PartialEq)]
pub(super) struct Outside {
    pub(super) low: f64,
    pub(super) high: f64,
}

/// Part of its range by which a place may lie beyond an end: rounding of units.
const ROUNDING: f64 = 1e-9;

impl Curve {
    /// The curve through two or more points.
    ///
    /// # Errors
    /// Two neighbours whose `x` do not increase.
    pub(super) fn new(points: Vec<(f64, f64)>) -> Result<Curve, [f64; 2]> {
        if let Some(pair) = points.windows(2).find(|pair| !(pair[1].0 > pair[0].0)) {
            return Err([pair[0].0, pair[1].0]);
        }
        let steps: Vec<f64> = points.windows(2).map(|p| p[1].0 - p[0].0).collect();
        let chords: Vec<f64> = points.windows(2).zip(&steps).map(|(p, h)| (p[1].1 - p[0].1) / h).collect();
        let last = steps.len();
        let inside =
            |i: usize| (steps[i] * chords[i - 1] + steps[i - 1] * chords[i]) / (steps[i - 1] + steps[i]);
        let slope = |i: usize| match i {
            _ if last == 1 => chords[0],
            0 => 2.0 * chords[0] - inside(1),
            i if i == last => 2.0 * chords[last - 1] - inside(last - 1),
            i => inside(i),
        };
        let slopes = (0..=last).map(slope).collect();
        Ok(Curve { points, slopes })
    }

    pub(super) fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// Value at `x`.
    ///
    /// # Errors
    /// A place beyond the ends.
    pub(super) fn at(&self, x: f64) -> Result<f64, Outside> {
        let ends = || Some((self.points.first()?.0, self.points.last()?.0));
        let (low, high) = ends().unwrap_or((f64::NAN, f64::NAN));
        let slack = ROUNDING * (high - low);
        if !(x >= low - slack && x <= high + slack) {
            return Err(Outside { low, high });
        }
        let (i, t, h) = self.piece(x);
        let ((_, a), (_, b)) = (self.points[i], self.points[i + 1]);
        let (down, up) = (self.slopes[i] * h, self.slopes[i + 1] * h);
        let chord = b - a;
        Ok(a + t * chord + t * (1.0 - t) * ((1.0 - t) * (down - chord) - t * (up - chord)))
    }

    /// Distance of the curve from the line between the neighbours of `x`.
    pub(super) fn bend(&self, x: f64) -> f64 {
        let (i, t, _) = self.piece(x);
        let line = self.points[i].1 + t * (self.points[i + 1].1 - self.points[i].1);
        self.at(x).map_or(0.0, |y| (y - line).abs())
    }

    /// Index of the piece of `x`, the place in it from 0 to 1, and its length.
    fn piece(&self, x: f64) -> (usize, f64, f64) {
        let i = self.points.partition_point(|p| p.0 <= x).clamp(1, self.points.len() - 1) - 1;
        let h = self.points[i + 1].0 - self.points[i].0;
        (i, ((x - self.points[i].0) / h).clamp(0.0, 1.0), h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_meets_its_points_and_is_exact_for_parabolas() {
        let f = |x: f64| 1.0 + 2.0 * x - 3.0 * x * x;
        let xs = [0.0, 0.3, 1.0, 1.2, 2.0];
        let curve = Curve::new(xs.iter().map(|x| (*x, f(*x))).collect()).unwrap();
        for x in [0.0, 0.1, 0.3, 0.7, 1.1, 1.9, 2.0] {
            assert!((curve.at(x).unwrap() - f(x)).abs() < 1e-12, "{x}");
        }
        assert!((curve.bend(0.65) - 3.0 * 0.35 * 0.35).abs() < 1e-12 && curve.bend(1.0) < 1e-12);
        assert_eq!(curve.at(2.1), Err(Outside { low: 0.0, high: 2.0 }));
        assert!(curve.at(2.0 + 1e-12).is_ok() && curve.at(-0.1).is_err());
        let line = Curve::new(vec![(0.0, 1.0), (2.0, 5.0)]).unwrap();
        assert_eq!(line.at(0.5), Ok(2.0));
        assert_eq!(Curve::new(vec![(0.0, 1.0), (2.0, 5.0), (1.0, 6.0)]).unwrap_err(), [2.0, 1.0]);
    }
}
