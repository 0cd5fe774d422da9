//! Quantities of a run beside the values that more shape functions predict.

use catalogue::metric::{self, Address};
use geometry::{Point3, Vector3};

use super::metrics::{Metric, push};

/// Saturation from which the coarser mesh is too coarse to tell: the more the prediction changes beyond, the
/// less is known, and the less it is corrected.
pub(crate) const SATURATED: f64 = 0.5;
/// Error of a quantity below which its saturation does not matter.
const SMALL: f64 = 0.005;
/// Part of a quantity below which a change from mesh to mesh is rounding.
const ROUNDING: f64 = 1e-9;

/// Quantities of a run beside their predictions.
#[derive(Clone, Debug)]
pub(crate) struct Estimates {
    /// Points of the compared displacement, m.
    pub(crate) points: Vec<Point3>,
    pub(crate) all: Vec<Estimated>,
}

/// A quantity of a run beside its prediction.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Estimated {
    /// The metrics of the relative error and of the saturation.
    of: [Address; 2],
    /// The metric of the predicted value, if it is reported.
    value: Option<Address>,
    /// Components in the run.
    own: Vec<f64>,
    /// Predicted components.
    predicted: Vec<f64>,
    /// Size to which errors are relative: that of the prediction unless set.
    scale: f64,
    /// Part of the error that the prediction shares with the run, if known.
    saturation: Option<f64>,
}

impl Estimates {
    /// Corrects the predictions by those on a coarser mesh. Returns the largest saturation with its metric,
    /// among quantities with an error that matters; `None` if there are none.
    pub(crate) fn correct(&mut self, coarser: &Estimates) -> Option<(Address, f64)> {
        let each = self.all.iter_mut().filter_map(|fine| {
            let coarse = coarser.all.iter().find(|coarse| coarse.of == fine.of)?;
            let saturation = fine.correct(coarse)?;
            (fine.relative() > SMALL).then_some((fine.of[1], saturation))
        });
        each.max_by(|(_, a), (_, b)| a.total_cmp(b))
    }

    /// Metrics of all quantities.
    pub(crate) fn metrics(&self) -> Vec<Metric> {
        let mut metrics = Vec::new();
        for estimated in &self.all {
            estimated.report(&mut metrics);
        }
        metrics
    }

    /// The estimated error of the displacement; 0 if unknown.
    pub(crate) fn of_displacement(&self) -> f64 {
        let found =
            self.all.iter().find(|estimated| *estimated.of[0].metric == metric::DISPLACEMENT_ESTIMATE);
        found.map_or(0.0, Estimated::relative)
    }
}

impl Estimated {
    /// Vectors beside their predictions, of which no value is reported. `of` are the metrics of the relative
    /// error and of the saturation.
    pub(crate) fn vectors(of: [Address; 2], own: &[Vector3], predicted: &[Vector3]) -> Estimated {
        let [own, predicted] = [own, predicted].map(|all| all.iter().flat_map(|v| [v.x, v.y, v.z]).collect());
        Estimated::new(of, None, own, predicted)
    }

    /// A number beside its prediction, which the metric `predicts` reports.
    pub(crate) fn value(of: [Address; 2], predicts: Address, own: f64, predicted: f64) -> Estimated {
        Estimated::new(of, Some(predicts), vec![own], vec![predicted])
    }

    fn new(of: [Address; 2], value: Option<Address>, own: Vec<f64>, predicted: Vec<f64>) -> Estimated {
        let scale = predicted.iter().map(|x| x * x).sum::<f64>().sqrt();
        Estimated { of, value, own, predicted, scale, saturation: None }
    }

    /// The same quantity with errors relative to `scale`.
    pub(crate) fn relative_to(self, scale: f64) -> Estimated {
        Estimated { scale, ..self }
    }

    /// Corrects the prediction by that on a coarser mesh, and returns the saturation.
    ///
    /// With the errors `e` of the run and `s e` of the prediction, both of the same order, the run changes by
    /// `e' - e` from mesh to mesh and the prediction by `s (e' - e)`. The distance between run and prediction
    /// is `(1 - s) e`. Smooth solutions have predictions of higher order and a smaller `s` on the finer mesh.
    fn correct(&mut self, coarser: &Estimated) -> Option<f64> {
        let moved = distance(&self.own, &coarser.own);
        if moved <= ROUNDING * self.scale {
            return None;
        }
        let saturation = distance(&self.predicted, &coarser.predicted) / moved;
        let beyond = beyond(saturation);
        for (predicted, own) in self.predicted.iter_mut().zip(&self.own) {
            *predicted += beyond * (*predicted - own);
        }
        self.saturation = Some(saturation);
        Some(saturation)
    }

    fn relative(&self) -> f64 {
        distance(&self.own, &self.predicted) / self.scale
    }

    /// Adds the metrics, without an error relative to zero.
    fn report(&self, metrics: &mut Vec<Metric>) {
        let (relative, [error, saturation]) = (self.relative(), self.of);
        if relative.is_finite() {
            push(metrics, error, relative);
        }
        if let Some(shared) = self.saturation {
            push(metrics, saturation, shared);
        }
        if let (Some(address), &[value]) = (self.value, &self.predicted[..]) {
            push(metrics, address, value);
        }
    }
}

/// Error of a prediction with this saturation, divided by its distance from the run.
fn beyond(saturation: f64) -> f64 {
    let counted = saturation.min(SATURATED * SATURATED / saturation);
    1.0 / (1.0 - counted) - 1.0
}

/// Corrects the prediction of a number by that on a coarser mesh, and returns it with its saturation, if
/// known. Both are a number in the run and its prediction.
pub(crate) fn corrected([own, predicted]: [f64; 2], coarser: [f64; 2]) -> (f64, Option<f64>) {
    let moved = (own - coarser[0]).abs();
    if moved <= ROUNDING * predicted.abs() {
        return (predicted, None);
    }
    let saturation = (predicted - coarser[1]).abs() / moved;
    (predicted + beyond(saturation) * (predicted - own), Some(saturation))
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn energy(own: f64, predicted: f64) -> Estimates {
        let of = [metric::STRAIN_ENERGY_ESTIMATE.whole(), metric::STRAIN_ENERGY_SATURATION.whole()];
        let estimated = Estimated::value(of, metric::STRAIN_ENERGY_PREDICTED.whole(), own, predicted);
        Estimates { points: Vec::new(), all: vec![estimated] }
    }

    /// Errors of both methods that are proportional to the spacing vanish from the corrected value.
    #[test]
    fn errors_of_the_same_order_are_found_whole() {
        let [run, prediction] = [|h: f64| 2.0 + h, |h: f64| 2.0 + 0.4 * h];
        let mut fine = energy(run(0.1), prediction(0.1));
        let (_, saturation) = fine.correct(&energy(run(0.2), prediction(0.2))).unwrap();
        assert!((saturation - 0.4).abs() < 1e-12, "{saturation}");
        let value =
            fine.metrics().into_iter().find(|m| *m.of.metric == metric::STRAIN_ENERGY_PREDICTED).unwrap();
        assert!((value.value - 2.0).abs() < 1e-12, "{}", value.value);
    }

    #[test]
    fn at_most_the_estimate_is_doubled() {
        let corrected = |coarser: f64| {
            let mut fine = energy(2.1, 2.0);
            let (_, saturation) = fine.correct(&energy(2.2, coarser)).unwrap();
            (saturation, 2.1 - fine.all[0].predicted[0])
        };
        let (at, most) = corrected(2.05);
        assert!((at - 0.5).abs() < 1e-9 && (most - 0.2).abs() < 1e-9, "{at} {most}");
        let (beyond, less) = corrected(1.0);
        assert!((beyond - 10.0).abs() < 1e-9 && (less - 0.1 / 0.975).abs() < 1e-9, "{beyond} {less}");
        assert_eq!(energy(2.0, 2.0).correct(&energy(2.0, 2.0)), None);
    }
}
