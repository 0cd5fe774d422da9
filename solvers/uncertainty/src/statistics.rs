//! Statistics of a result over the samples of its inputs, with intervals of confidence.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::chaos::Chaos;
use crate::distribution::Distribution;
use crate::resample::{blocks, draws};
use crate::sequence::point;

/// Probabilities of the quantiles.
pub const LEVELS: [f64; 3] = [0.05, 0.5, 0.95];
/// `Q2` from which the statistics are those of the polynomial.
pub const LEAST_Q2: f64 = 0.99;
/// `Q2` from which the shares of the inputs are given.
const LEAST_SHARES: f64 = 0.9;
/// Samples of the polynomial for its quantiles.
const OF_CHAOS: u32 = 1 << 16;

/// A number with its 95 % interval of confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

/// Shares of one input in the variance of a result (Sobol indices).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Index {
    /// Share of the input alone.
    pub first: Estimate,
    /// Share of the input together with its interactions with others.
    pub total: Estimate,
}

/// Origin of statistics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Polynomial chaos of this degree.
    Chaos(usize),
    /// The samples themselves.
    Samples,
}

/// Statistics of a result.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistics {
    /// Origin of the mean, the standard deviation and the quantiles.
    pub source: Source,
    /// `Q2` of the best polynomial, which is below [`LEAST_Q2`] if the statistics are those of the samples;
    /// `None` if there is none.
    pub q2: Option<f64>,
    /// Mean.
    pub mean: Estimate,
    /// Standard deviation.
    pub sd: Estimate,
    /// Quantiles at [`LEVELS`].
    pub quantiles: [Estimate; 3],
    /// Shares of the inputs, in their order; empty if no polynomial fits.
    pub indices: Vec<Index>,
}

/// Statistics of the results of some samples; `None` for fewer than two.
pub fn statistics(inputs: &[Distribution], samples: &[Vec<f64>], results: &[f64]) -> Option<Statistics> {
    if results.len() < 2 {
        return None;
    }
    let chaos = Chaos::fit(inputs, samples, results);
    let resampled = chaos.as_ref().filter(|chaos| chaos.q2 >= LEAST_SHARES);
    let resampled = resampled.map(|chaos| coefficients(chaos, samples, results));
    let q2 = chaos.as_ref().map(|chaos| chaos.q2);
    let indices = match (&chaos, &resampled) {
        (Some(chaos), Some(resampled)) => indices(chaos, resampled),
        _ => Vec::new(),
    };
    match (&chaos, &resampled) {
        (Some(chaos), Some(resampled)) if chaos.q2 >= LEAST_Q2 => {
            let terms = of_chaos(inputs, chaos);
            let of = |c: &DVector<f64>| summary((&terms * c).as_mut_slice(), c[0], Chaos::variance(c).sqrt());
            let [mean, sd, quantiles @ ..] =
                with_intervals(of(&chaos.coefficients), resampled.iter().map(of));
            Some(Statistics { source: Source::Chaos(chaos.degree), q2, mean, sd, quantiles, indices })
        }
        _ => {
            let ends = blocks(results.len());
            let drawn = draws(ends.len() - 1).map(|times| {
                let repeat = |(block, times): (&[usize], &u32)| {
                    std::iter::repeat_n(&results[block[0]..block[1]], *times as usize).flatten().copied()
                };
                of_samples(ends.windows(2).zip(&times).flat_map(repeat).collect())
            });
            let [mean, sd, quantiles @ ..] = with_intervals(of_samples(results.to_vec()), drawn);
            Some(Statistics { source: Source::Samples, q2, mean, sd, quantiles, indices })
        }
    }
}

/// Quantiles at [`LEVELS`] as [`statistics`] takes them, without intervals; `None` for fewer than two
/// results.
pub fn quantiles(inputs: &[Distribution], samples: &[Vec<f64>], results: &[f64]) -> Option<[f64; 3]> {
    if results.len() < 2 {
        return None;
    }
    let mut numbers = match Chaos::fit(inputs, samples, results).filter(|chaos| chaos.q2 >= LEAST_Q2) {
        Some(chaos) => (of_chaos(inputs, &chaos) * &chaos.coefficients).as_slice().to_vec(),
        None => results.to_vec(),
    };
    Some(LEVELS.map(|level| quantile(&mut numbers, level)))
}

/// Terms of the polynomial at many samples, a row for each.
fn of_chaos(inputs: &[Distribution], chaos: &Chaos) -> DMatrix<f64> {
    let points: Vec<Vec<f64>> = (0..OF_CHAOS).map(|index| point(inputs, index)).collect();
    chaos.rows(&points)
}

/// Mean, standard deviation and quantiles of some numbers.
fn of_samples(mut results: Vec<f64>) -> [f64; 5] {
    let count = results.len() as f64;
    let mean = results.iter().sum::<f64>() / count;
    let squares: f64 = results.iter().map(|v| (v - mean).powi(2)).sum();
    summary(&mut results, mean, (squares / (count - 1.0)).sqrt())
}

fn summary(results: &mut [f64], mean: f64, sd: f64) -> [f64; 5] {
    let [low, median, high] = LEVELS.map(|level| quantile(results, level));
    [mean, sd, low, median, high]
}

/// Quantile of some numbers, between the nearest two; reorders the numbers.
///
/// # Panics
/// No numbers.
fn quantile(numbers: &mut [f64], level: f64) -> f64 {
    let at = level * (numbers.len() - 1) as f64;
    let (_, below, rest) = numbers.select_nth_unstable_by(at as usize, f64::total_cmp);
    let above = rest.iter().copied().fold(f64::INFINITY, f64::min);
    if rest.is_empty() { *below } else { *below + at.fract() * (above - *below) }
}

/// Numbers with the ends between which 95 % of their resamples lie.
fn with_intervals<const N: usize>(values: [f64; N], drawn: impl Iterator<Item = [f64; N]>) -> [Estimate; N] {
    let drawn: Vec<[f64; N]> = drawn.collect();
    std::array::from_fn(|k| {
        let mut own: Vec<f64> = drawn.iter().map(|one| one[k]).chain([values[k]]).collect();
        Estimate { value: values[k], low: quantile(&mut own, 0.025), high: quantile(&mut own, 0.975) }
    })
}

/// Coefficients of the polynomial for each resample, to first order in the number of times that a sample is
/// drawn: `c + (A^T A)^-1 sum of (times - 1) A_i e_i` with the errors `e_i` of predicting each sample from
/// all others (the estimator HC3 of MacKinnon and White 1985). Fitted anew, most resamples of few samples
/// would leave terms undetermined: they have two thirds of the samples.
fn coefficients(chaos: &Chaos, samples: &[Vec<f64>], results: &[f64]) -> Vec<DVector<f64>> {
    let matrix = chaos.rows(samples);
    let decomposed = matrix.clone().qr();
    let (q, r) = (decomposed.q(), decomposed.r());
    let residual = DVector::from_row_slice(results) - &matrix * &chaos.coefficients;
    let error = |i: usize| residual[i] / (1.0 - q.row(i).norm_squared());
    let errors = DVector::from_iterator(results.len(), (0..results.len()).map(error));
    let ends = blocks(results.len());
    let part = |block: &[usize]| {
        let (first, count) = (block[0], block[1] - block[0]);
        matrix.rows(first, count).tr_mul(&errors.rows(first, count))
    };
    let parts: Vec<DVector<f64>> = ends.windows(2).map(part).collect();
    let drawn = draws(parts.len()).filter_map(|times| {
        let mut sum = DVector::zeros(matrix.ncols());
        for (part, times) in parts.iter().zip(times) {
            sum += part * (f64::from(times) - 1.0);
        }
        Some(&chaos.coefficients + r.solve_upper_triangular(&r.tr_solve_upper_triangular(&sum)?)?)
    });
    drawn.collect()
}

/// Shares of the inputs. An interval is that of the resamples, wider by the part of the variance that the
/// polynomial leaves unexplained, which may belong to any input.
fn indices(chaos: &Chaos, resampled: &[DVector<f64>]) -> Vec<Index> {
    let values = chaos.shares(&chaos.coefficients);
    let drawn: Vec<Vec<[f64; 2]>> = resampled.iter().map(|c| chaos.shares(c)).collect();
    let unexplained = 1.0 - chaos.q2;
    let wider = |of: Estimate| {
        let (low, high) = ((of.low - unexplained).max(0.0), (of.high + unexplained).min(1.0));
        Estimate { low, high, ..of }
    };
    let each = values.iter().enumerate().map(|(input, shares)| {
        let [first, total] = with_intervals(*shares, drawn.iter().map(|one| one[input])).map(wider);
        Index { first, total }
    });
    each.collect()
}
