//! Confidence in fitted constants, from the Jacobian of the residuals at the fit.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::constant::{Constant, Measured, felt, scaled};
use crate::normal;

/// Smallest singular value of the scaled Jacobian, over the relative step of its differences, for which a
/// combination of constants is determined: the differences are known to about their step.
pub(crate) const DETERMINED: f64 = 2.0;
/// Part of a unit vector from which a constant belongs to a combination.
const BELONGS: f64 = 0.2;
/// Collinearity index from which constants are hard to distinguish (Brun, Reichert and Kuensch 2001: 10 to
/// 15).
const COLLINEAR: f64 = 15.0;
/// Residuals over the largest value of the data below which they are rounding.
const ROUNDING: f64 = 1e-5;

/// Confidence in fitted constants, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Confidence {
    /// Ends of the 95 % intervals; `None` for a constant on its bound, and for one that the data do not
    /// determine.
    pub intervals: Vec<Option<[f64; 2]>>,
    /// Whether each constant is on a bound.
    pub on_bound: Vec<bool>,
    /// Correlations of the constants; 0 with a constant on its bound.
    pub correlation: Vec<Vec<f64>>,
    /// Constants without influence on the data.
    pub without_influence: Vec<usize>,
    /// Constants that the data hardly distinguish.
    pub collinear: Option<Collinear>,
    /// Number of data minus number of constants that are not on a bound.
    pub freedom: usize,
    /// Root of the mean square of the residuals.
    pub rms: f64,
    /// Coefficient of determination, `1 - sum (r^2) / sum (y - mean y)^2`, weighted as the fit.
    pub r2: f64,
    /// Sum of the squares of the residuals over the stated standard deviations, over the degrees of freedom;
    /// `None` without stated standard deviations.
    pub chi2: Option<f64>,
    /// Standard score of the number of runs of residuals of one sign (Wald and Wolfowitz 1940). It is below
    /// -2.33 by chance in 1 % of all fits; minus infinity if eight or more all have one sign, which chance
    /// gives in 0.8 %; `None` if fewer do, or if all are rounding.
    pub runs_score: Option<f64>,
}

/// Constants whose columns of the Jacobian are nearly linearly dependent.
#[derive(Clone, Debug, PartialEq)]
pub struct Collinear {
    /// Indices of the constants, the largest part first.
    pub constants: Vec<usize>,
    /// Inverse of the smallest singular value of the Jacobian with columns of length 1.
    pub index: f64,
    /// Whether the data determine the combination at all.
    pub determined: bool,
}

/// Confidence at `theta`, by the Jacobian of the free constants.
pub(crate) fn confidence(
    constants: &[Constant],
    theta: &DVector<f64>,
    (jacobian, residual, free): (&DMatrix<f64>, &DVector<f64>, &[usize]),
    data: Measured,
    step: f64,
) -> Confidence {
    let (rows, count) = (residual.len(), constants.len());
    let freedom = rows - free.len();
    let weights = |i: usize| data.sd.map_or(1.0, |sd| 1.0 / sd[i].powi(2));
    let values = || data.values.iter().enumerate();
    let whole: f64 = values().map(|(i, _)| weights(i)).sum();
    let mean = values().map(|(i, y)| weights(i) * y).sum::<f64>() / whole;
    let spread: f64 = values().map(|(i, y)| weights(i) * (y - mean).powi(2)).sum();
    let squares = residual.norm_squared();
    let chi2 = data.sd.map(|_| squares / freedom as f64);
    let (variance, factor) = match data.sd {
        Some(_) => (1.0, normal::quantile(0.975)),
        None => (squares / freedom as f64, student(freedom)),
    };
    let mut of = Confidence {
        intervals: vec![None; count],
        on_bound: (0..count).map(|k| constants[k].bounds().contains(&theta[k])).collect(),
        correlation: (0..count).map(|i| (0..count).map(|j| f64::from(i == j)).collect()).collect(),
        without_influence: Vec::new(),
        collinear: None,
        freedom,
        rms: rms(residual, data.sd),
        r2: 1.0 - squares / spread,
        chi2,
        runs_score: runs_score(residual, data.length() / (rows as f64).sqrt()),
    };
    let felt_by = felt(jacobian, free, data.length());
    of.without_influence = free.iter().filter(|k| !felt_by.contains(k)).copied().collect();
    if felt_by.is_empty() {
        return of;
    }
    let (scaled, lengths) = scaled(jacobian, &felt_by);
    let svd = scaled.svd(false, true);
    let Some(v) = &svd.v_t else { return of };
    let sigma = &svd.singular_values;
    let inverse = DMatrix::from_fn(felt_by.len(), felt_by.len(), |i, j| {
        let terms = sigma.iter().enumerate().map(|(m, s)| v[(m, i)] * v[(m, j)] / s.max(1e-12).powi(2));
        terms.sum::<f64>()
    });
    let mut undetermined = vec![false; felt_by.len()];
    for (m, s) in sigma.iter().enumerate() {
        let parts = || (0..felt_by.len()).filter(|&i| v[(m, i)].abs() > BELONGS);
        let determined = *s > DETERMINED * step;
        if !determined {
            parts().for_each(|i| undetermined[i] = true);
        }
        if *s < 1.0 / COLLINEAR && of.collinear.as_ref().is_none_or(|known| 1.0 / s > known.index) {
            let mut parts: Vec<usize> = parts().collect();
            // Equal parts keep the order of the constants.
            parts.sort_by_key(|&i| std::cmp::Reverse((v[(m, i)].abs() / ROUNDING).round() as u64));
            let constants = parts.iter().map(|&i| felt_by[i]).collect();
            of.collinear = Some(Collinear { constants, index: 1.0 / s, determined });
        }
    }
    for (i, &k) in felt_by.iter().enumerate() {
        for (j, &l) in felt_by.iter().enumerate() {
            of.correlation[k][l] = inverse[(i, j)] / (inverse[(i, i)] * inverse[(j, j)]).sqrt();
        }
        let half = factor * (variance * inverse[(i, i)]).sqrt() / lengths[i];
        let ends = [theta[k] - half, theta[k] + half].map(|theta| constants[k].back(theta));
        let known = !undetermined[i] && !of.on_bound[k];
        of.intervals[k] = (known && ends.iter().all(|end| end.is_finite())).then_some(ends);
    }
    of
}

/// Value that a t-distributed number exceeds with a probability of 2.5 %.
fn student(freedom: usize) -> f64 {
    let of = StudentsT::new(0.0, 1.0, freedom as f64);
    of.map_or_else(|_| normal::quantile(0.975), |of| of.inverse_cdf(0.975))
}

/// Root of the mean square of the residuals, in the unit of the data.
fn rms(residual: &DVector<f64>, sd: Option<&[f64]>) -> f64 {
    let each = residual.iter().enumerate().map(|(i, r)| (r * sd.map_or(1.0, |sd| sd[i])).powi(2));
    (each.sum::<f64>() / residual.len() as f64).sqrt()
}

/// Standard score of the number of runs of one sign; `size` is the root mean square of the data.
fn runs_score(residual: &DVector<f64>, size: f64) -> Option<f64> {
    if residual.norm() / (residual.len() as f64).sqrt() < ROUNDING * size {
        return None;
    }
    let signs: Vec<bool> = residual.iter().filter(|r| **r != 0.0).map(|r| *r > 0.0).collect();
    let runs = 1.0 + signs.windows(2).filter(|pair| pair[0] != pair[1]).count() as f64;
    let (n, above) = (signs.len() as f64, signs.iter().filter(|sign| **sign).count() as f64);
    if n >= 8.0 && (above == 0.0 || above == n) {
        return Some(f64::NEG_INFINITY);
    }
    let mean = 2.0 * above * (n - above) / n + 1.0;
    let variance = (mean - 1.0) * (mean - 2.0) / (n - 1.0);
    (variance > 0.0).then(|| (runs - mean) / variance.sqrt())
}
