//! Least squares for constants of a model that is costly to run, by Levenberg and Marquardt's method.
//!
//! A positive constant is fitted by its logarithm, so that its unit and its magnitude do not matter and it
//! stays positive. Derivatives are forward differences: all runs of a Jacobian are independent of each other,
//! and are handed to the caller together. The crate `levenberg-marquardt` knows neither bounds nor runs that
//! fail.

use nalgebra::{DMatrix, DVector};

use crate::confidence::{Confidence, DETERMINED, confidence};
use crate::constant::{Constant, Measured, felt, scaled};

/// Most Jacobians of a fit.
const MOST_ITERATIONS: usize = 30;
/// Most attempts to lower the squares by one Jacobian.
const MOST_ATTEMPTS: usize = 8;
/// Least part of the predicted fall of the squares for which a step is taken.
const LEAST_GAIN: f64 = 0.1;
/// Step of the differences once those of the requested step have led nowhere: contact that comes and goes
/// makes a model rough, and a longer step smooths it.
const LONGEST_STEP: f64 = 0.02;
/// Largest change of the logarithm of a constant in one iteration: a factor of four.
const LONGEST: f64 = 1.386_294_361_119_890_6;
/// Damping of the first step, relative to the squares of the columns of the Jacobian.
const DAMPING: f64 = 1e-3;
/// Least damping after steps that lowered the squares.
const LEAST_DAMPING: f64 = 1e-9;
/// Part of the residual that the Jacobian can still take away, over the standard deviation of a measurement,
/// below which a fit has converged: no constant would move by more than a hundredth of its own standard
/// error.
const CONVERGED: f64 = 0.01;
/// The same where no step lowers the squares any more.
const CLOSE: f64 = 0.2;
/// The same over the root of the sum of the squares of the data, for data without scatter.
const EXACT: f64 = 1e-7;

/// Values of a model at the data for each set of constants; `None` for a set at which it fails.
pub type Models = Vec<Option<Vec<f64>>>;

/// Result of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// Fitted values of the constants.
    pub values: Vec<f64>,
    /// Values of the model at the data.
    pub model: Vec<f64>,
    /// Number of Jacobians.
    pub iterations: usize,
    /// Number of runs of the model, those that failed included.
    pub runs: usize,
    /// Whether nothing is left that the Jacobian could take away from the residuals.
    pub converged: bool,
    /// Confidence in the constants.
    pub confidence: Confidence,
}

/// Reason why there is no fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FitError {
    /// The model fails at the start values.
    Start,
    /// The model fails on both sides of the current value of a constant, of which this is the index.
    Derivative(usize),
}

/// Fits the constants.
///
/// `run` returns the values of the model at the data for each set of constants, or `None` for a set at which
/// the model fails. `step` is the step of the differences: of the logarithm of a constant, or of a fraction
/// of its range. Numbers of rows have to exceed those of constants.
///
/// A step to constants at which the model fails is halved. A constant at a bound stays there while the
/// squares fall towards the outside.
///
/// # Errors
/// The model fails at the start, or on both sides of a constant.
pub fn fit(
    constants: &[Constant],
    data: Measured,
    step: f64,
    run: &mut dyn FnMut(&[Vec<f64>]) -> Models,
) -> Result<Fitted, FitError> {
    let mut of = Search { constants, data, step, run, runs: 0 };
    let mut theta = DVector::from_iterator(constants.len(), constants.iter().map(|c| c.forward(c.start)));
    let mut model = of.model(&theta).ok_or(FitError::Start)?;
    let mut damping = DAMPING;
    let mut iterations = 0;
    loop {
        iterations += 1;
        let jacobian = of.jacobian(&theta, &model)?;
        let residual = data.residual(&model);
        let free = of.free(&theta, &jacobian.tr_mul(&residual));
        let linear = Linear::new(jacobian, residual, free, data.length(), of.step);
        let found = of.descend(&theta, &model, &linear, &mut damping);
        (theta, model) = (found.theta, found.model);
        if found.stuck && of.step < LONGEST_STEP && iterations < MOST_ITERATIONS {
            (of.step, damping) = (LONGEST_STEP, DAMPING);
            continue;
        }
        if found.converged || found.stuck || iterations == MOST_ITERATIONS {
            let residual = data.residual(&model);
            let values: Vec<f64> = constants.iter().zip(theta.iter()).map(|(c, t)| c.value(*t)).collect();
            let jacobian = (&linear.jacobian, &residual, &linear.free[..]);
            let Search { runs, step, .. } = of;
            let confidence = confidence(constants, &theta, jacobian, data, step);
            let converged = found.converged;
            return Ok(Fitted { values, model, iterations, runs, converged, confidence });
        }
    }
}

struct Search<'a> {
    constants: &'a [Constant],
    data: Measured<'a>,
    step: f64,
    run: &'a mut dyn FnMut(&[Vec<f64>]) -> Models,
    runs: usize,
}

/// Constants and model after the attempts with one Jacobian.
struct Descent {
    theta: DVector<f64>,
    model: Vec<f64>,
    converged: bool,
    /// Whether no attempt lowered the squares.
    stuck: bool,
}

impl Search<'_> {
    fn at(&mut self, thetas: &[DVector<f64>]) -> Models {
        if thetas.is_empty() {
            return Vec::new();
        }
        self.runs += thetas.len();
        let values = |theta: &DVector<f64>| {
            self.constants.iter().zip(theta.iter()).map(|(c, t)| c.value(*t)).collect()
        };
        (self.run)(&thetas.iter().map(values).collect::<Vec<_>>())
    }

    fn model(&mut self, theta: &DVector<f64>) -> Option<Vec<f64>> {
        self.at(std::slice::from_ref(theta)).pop().flatten()
    }

    /// Derivatives of the residuals, a column for each constant. A constant that cannot go up is moved down.
    fn jacobian(&mut self, theta: &DVector<f64>, model: &[f64]) -> Result<DMatrix<f64>, FitError> {
        // Within the bounds, where the model has its values.
        let moved = |k: usize, step: f64| {
            let [low, high] = self.constants[k].bounds();
            let mut theta = theta.clone();
            theta[k] = (theta[k] + step).clamp(low, high);
            theta
        };
        let own = |k: usize| {
            let [low, high] = self.constants[k].bounds();
            let up = theta[k] + self.step <= high || high - theta[k] >= theta[k] - low;
            if up { self.step } else { -self.step }
        };
        let mut steps: Vec<f64> = (0..theta.len()).map(own).collect();
        let mut found = self.at(&steps.iter().enumerate().map(|(k, s)| moved(k, *s)).collect::<Vec<_>>());
        let failed: Vec<usize> = (0..theta.len()).filter(|&k| found[k].is_none()).collect();
        failed.iter().for_each(|&k| steps[k] = -steps[k]);
        let again = self.at(&failed.iter().map(|&k| moved(k, steps[k])).collect::<Vec<_>>());
        failed.iter().zip(again).for_each(|(&k, model)| found[k] = model);
        let here = self.data.residual(model);
        let mut jacobian = DMatrix::zeros(here.len(), theta.len());
        for (k, model) in found.iter().enumerate() {
            let length = moved(k, steps[k])[k] - theta[k];
            let model = model.as_ref().filter(|_| length != 0.0).ok_or(FitError::Derivative(k))?;
            jacobian.set_column(k, &((self.data.residual(model) - &here) / length));
        }
        Ok(jacobian)
    }

    /// Constants that are not held by a bound, towards whose outside the squares fall.
    fn free(&self, theta: &DVector<f64>, slope: &DVector<f64>) -> Vec<usize> {
        let is_free = |&k: &usize| {
            let [low, high] = self.constants[k].bounds();
            !(theta[k] <= low && slope[k] > 0.0 || theta[k] >= high && slope[k] < 0.0)
        };
        (0..theta.len()).filter(is_free).collect()
    }

    /// Lowers the squares along damped steps, `(J^T J + damping D^2) step = -J^T r` with the lengths `D` of
    /// the columns of `J` (Marquardt 1963). A step is taken if it lowers the squares by a tenth of what the
    /// Jacobian predicts: longer ones pass over the minimum to where the model hardly changes.
    fn descend(&mut self, theta: &DVector<f64>, model: &[f64], of: &Linear, damping: &mut f64) -> Descent {
        let before = of.residual.norm_squared();
        let scatter = match self.data.sd {
            Some(_) => 1.0,
            None => (before / (of.residual.len() - of.free.len()) as f64).sqrt(),
        };
        let rest = of.rest();
        let short = rest <= CONVERGED * scatter + EXACT * self.data.length();
        let mut part = 1.0;
        for _ in 0..if short { 1 } else { MOST_ATTEMPTS } {
            let next = self.step_from(theta, of, *damping, part);
            let expected = before - (&of.residual + &of.jacobian * (&next - theta)).norm_squared();
            let tried = self.model(&next);
            let lower = tried.as_ref().map(|model| before - self.data.residual(model).norm_squared());
            let least = if short { 0.0 } else { LEAST_GAIN * expected.max(0.0) };
            match (tried, lower) {
                (Some(model), Some(lower)) if lower >= least => {
                    *damping = (*damping * if lower > 0.5 * expected { 0.1 } else { 1.0 }).max(LEAST_DAMPING);
                    return Descent { theta: next, model, converged: short, stuck: false };
                }
                (None, _) => part *= 0.5,
                _ => *damping = (*damping * 10.0).max(DAMPING),
            }
        }
        // Close to the minimum the scatter of the runs may hide what is left.
        let converged = short || rest <= CLOSE * scatter;
        Descent { theta: theta.clone(), model: model.to_vec(), converged, stuck: !converged }
    }

    /// Part of the damped step, within the bounds.
    fn step_from(&self, theta: &DVector<f64>, of: &Linear, damping: f64, part: f64) -> DVector<f64> {
        let mut next = theta.clone();
        let mut along = of.along.clone();
        for (a, sigma) in along.iter_mut().zip(of.sigma.iter()) {
            *a *= -sigma / (sigma * sigma + damping);
        }
        let mut step = of.v.tr_mul(&along).component_div(&of.lengths);
        let longest = of.felt.iter().zip(step.iter()).map(|(&k, s)| {
            let most = if self.constants[k].is_logarithmic() { LONGEST } else { 0.5 };
            s.abs() / most
        });
        step *= part / longest.fold(1.0, f64::max);
        for (&k, s) in of.felt.iter().zip(step.iter()) {
            let [low, high] = self.constants[k].bounds();
            next[k] = (theta[k] + s).clamp(low, high);
        }
        next
    }
}

/// The linear problem of one Jacobian.
struct Linear {
    jacobian: DMatrix<f64>,
    residual: DVector<f64>,
    /// Constants that no bound holds.
    free: Vec<usize>,
    /// Those of them with an influence on the data, whose columns are scaled to length 1.
    felt: Vec<usize>,
    lengths: DVector<f64>,
    sigma: DVector<f64>,
    v: DMatrix<f64>,
    /// Residual along the left singular vectors; zero along combinations that the data do not determine, so
    /// that the constants stay at their start along these.
    along: DVector<f64>,
}

impl Linear {
    fn new(
        jacobian: DMatrix<f64>,
        residual: DVector<f64>,
        free: Vec<usize>,
        length: f64,
        step: f64,
    ) -> Linear {
        let felt = felt(&jacobian, &free, length);
        let count = felt.len();
        let (scaled, lengths) = scaled(&jacobian, &felt);
        // A matrix without columns has no decomposition.
        let svd = (count > 0).then(|| scaled.svd(true, true));
        let found = svd.and_then(|svd| Some((svd.u?.tr_mul(&residual), svd.singular_values, svd.v_t?)));
        let none = || (DVector::zeros(0), DVector::zeros(0), DMatrix::zeros(0, count));
        let (mut along, sigma, v) = found.unwrap_or_else(none);
        along
            .iter_mut()
            .zip(sigma.iter())
            .filter(|(_, s)| **s <= DETERMINED * step)
            .for_each(|(a, _)| *a = 0.0);
        Linear { jacobian, residual, free, felt, lengths, sigma, v, along }
    }

    /// Length of the part of the residual that the Jacobian can still take away.
    fn rest(&self) -> f64 {
        self.along.norm()
    }
}
