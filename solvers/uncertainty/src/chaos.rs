//! Polynomial chaos: a result as a polynomial in the inputs, by least squares over the samples.

use nalgebra::{DMatrix, DVector};

use crate::basis::{Basis, DEGREE};
use crate::distribution::Distribution;

/// Samples over terms that a polynomial of degree 0 to 3 needs.
const SAMPLES_PER_TERM: [f64; DEGREE + 1] = [1.0, 1.3, 1.4, 2.0];
/// Part of a term that the terms before it leave over the samples, below which it is not determined.
const DETERMINED: f64 = 0.02;
/// Largest number of entries of the matrix of a fit (1.6 GB).
const MOST_ENTRIES: usize = 200_000_000;

/// A polynomial in the inputs, in terms that are orthonormal under their distributions.
#[derive(Clone, Debug)]
pub struct Chaos {
    bases: Vec<Basis>,
    /// Of each term the inputs that it has, with their degrees. The first term is constant.
    pub(crate) terms: Vec<Vec<(usize, usize)>>,
    pub(crate) coefficients: DVector<f64>,
    /// Total degree.
    pub degree: usize,
    /// `Q2`: 1 minus the mean square error of predicting each sample from all others, over the variance.
    pub q2: f64,
}

impl Chaos {
    /// The polynomial that predicts left-out samples best, among those of total degree 1 to 3 for which the
    /// samples suffice; `None` if they do not suffice for degree 1, if the results do not vary, or without
    /// inputs. Source: Blatman and Sudret (2010) for the error by leave-one-out.
    pub fn fit(inputs: &[Distribution], samples: &[Vec<f64>], results: &[f64]) -> Option<Chaos> {
        let bases: Vec<Basis> = inputs.iter().map(Basis::new).collect();
        let degrees = if inputs.is_empty() { 0..0 } else { 1..DEGREE + 1 };
        let fits = degrees.filter_map(|degree| of_degree(&bases, degree, samples, results));
        fits.max_by(|a, b| a.q2.total_cmp(&b.q2).then(b.degree.cmp(&a.degree)))
    }

    /// Values of the terms at the samples, a row for each.
    pub(crate) fn rows(&self, samples: &[Vec<f64>]) -> DMatrix<f64> {
        rows(&self.bases, &self.terms, samples)
    }

    /// Shares of each input in the variance of a polynomial with these coefficients: alone, and with all
    /// terms that the input is in. Zeros if the polynomial is constant.
    pub(crate) fn shares(&self, coefficients: &DVector<f64>) -> Vec<[f64; 2]> {
        let mut shares = vec![[0.0; 2]; self.bases.len()];
        let mut variance = 0.0;
        for (term, c) in self.terms.iter().zip(coefficients.iter()).skip(1) {
            variance += c * c;
            for (input, _) in term {
                shares[*input][0] += if term.len() == 1 { c * c } else { 0.0 };
                shares[*input][1] += c * c;
            }
        }
        let over = if variance > 0.0 { variance } else { 1.0 };
        shares.into_iter().map(|share| share.map(|part| part / over)).collect()
    }

    /// Variance of a polynomial with these coefficients.
    pub(crate) fn variance(coefficients: &DVector<f64>) -> f64 {
        coefficients.iter().skip(1).map(|c| c * c).sum()
    }
}

fn of_degree(bases: &[Basis], degree: usize, samples: &[Vec<f64>], results: &[f64]) -> Option<Chaos> {
    let most = (samples.len() as f64 / SAMPLES_PER_TERM[degree]) as usize;
    let most = most.min(MOST_ENTRIES / samples.len().max(1));
    let terms = terms(bases, degree, most)?;
    let matrix = rows(bases, &terms, samples);
    let results = DVector::from_row_slice(results);
    let decomposed = matrix.clone().qr();
    let (q, r) = (decomposed.q(), decomposed.r());
    // With orthonormal terms the diagonal is about the root of the number of samples. A small entry is a term
    // that the samples do not determine, such as that of a value of a list without a result.
    let least = DETERMINED * (samples.len() as f64).sqrt();
    if r.diagonal().iter().any(|entry| entry.abs() < least) {
        return None;
    }
    let coefficients = r.solve_upper_triangular(&q.tr_mul(&results))?;
    let residual = &results - &matrix * &coefficients;
    let left_out = (0..samples.len()).map(|i| {
        let leverage = q.row(i).norm_squared();
        (residual[i] / (1.0 - leverage)).powi(2)
    });
    let variance = results.add_scalar(-results.mean()).norm_squared();
    let q2 = 1.0 - left_out.sum::<f64>() / variance;
    (q2.is_finite() && coefficients.iter().all(|c| c.is_finite())).then_some(Chaos {
        bases: bases.to_vec(),
        terms,
        coefficients,
        degree,
        q2,
    })
}

fn rows(bases: &[Basis], terms: &[Vec<(usize, usize)>], samples: &[Vec<f64>]) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(samples.len(), terms.len());
    for (i, sample) in samples.iter().enumerate() {
        let values: Vec<_> = bases.iter().zip(sample).map(|(basis, value)| basis.at(*value)).collect();
        for (j, term) in terms.iter().enumerate() {
            matrix[(i, j)] = term.iter().map(|(input, degree)| values[*input][*degree]).product();
        }
    }
    matrix
}

/// All terms up to a total degree, the constant term first; `None` if there are more than `most`.
fn terms(bases: &[Basis], degree: usize, most: usize) -> Option<Vec<Vec<(usize, usize)>>> {
    let mut all = vec![Vec::new()];
    for (input, basis) in bases.iter().enumerate() {
        let before = all.len();
        for at in 0..before {
            let used: usize = all[at].iter().map(|(_, degree): &(usize, usize)| degree).sum();
            for own in 1..=basis.degree.min(degree - used) {
                let mut term = all[at].clone();
                term.push((input, own));
                all.push(term);
            }
            if all.len() > most {
                return None;
            }
        }
    }
    (all.len() <= most).then_some(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_are_all_of_a_total_degree() {
        let of = |count: usize| vec![Basis::new(&Distribution::Uniform { low: 0.0, high: 1.0 }); count];
        let count = |inputs, degree| terms(&of(inputs), degree, 10_000).map(|terms| terms.len());
        assert_eq!([count(5, 1), count(5, 2), count(5, 3), count(2, 3)], [6, 21, 56, 10].map(Some));
        assert_eq!(terms(&of(5), 2, 20), None);
    }
}
