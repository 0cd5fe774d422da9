//! Polynomials of one input that are orthonormal under its distribution: Legendre's for a range, Hermite's
//! for a normal distribution and for the logarithm of a lognormal one, and those of a truncated distribution
//! or of a list.

use nalgebra::Matrix4;

use crate::distribution::Distribution;
use crate::normal::density;

/// Largest degree of a polynomial.
pub(crate) const DEGREE: usize = 3;
/// Intervals of Simpson's rule for the moments of a truncated distribution.
const INTERVALS: usize = 2000;
/// Square of a polynomial's part that earlier ones lack, below which a list has too few values for it.
const NOTHING: f64 = 1e-10;

/// Orthonormal polynomials in `(germ - centre) / scale`.
#[derive(Clone, Debug)]
pub(crate) struct Basis {
    of: Distribution,
    centre: f64,
    scale: f64,
    /// Coefficients by degree and power.
    rows: [[f64; DEGREE + 1]; DEGREE + 1],
    /// Largest degree that the distribution distinguishes.
    pub(crate) degree: usize,
}

impl Basis {
    pub(crate) fn new(of: &Distribution) -> Basis {
        let (centre, scale, moments) = moments(of);
        // The Gram matrix of the powers is L L^T; the rows of L^-1 are the polynomials.
        let mut lower = Matrix4::<f64>::zeros();
        let mut rows = [[0.0; DEGREE + 1]; DEGREE + 1];
        let mut degree = 0;
        for i in 0..=DEGREE {
            for j in 0..i {
                let known: f64 = (0..j).map(|k| lower[(i, k)] * lower[(j, k)]).sum();
                lower[(i, j)] = (moments[i + j] - known) / lower[(j, j)];
            }
            let left = moments[2 * i] - (0..i).map(|k| lower[(i, k)].powi(2)).sum::<f64>();
            if left <= NOTHING {
                break;
            }
            lower[(i, i)] = left.sqrt();
            degree = i;
            rows[i][i] = 1.0;
            for j in 0..i {
                let part = lower[(i, j)];
                for k in 0..=j {
                    rows[i][k] -= part * rows[j][k];
                }
            }
            rows[i].iter_mut().for_each(|c| *c /= lower[(i, i)]);
        }
        Basis { of: of.clone(), centre, scale, rows, degree }
    }

    /// Values of the polynomials by degree; zero above the largest degree.
    pub(crate) fn at(&self, value: f64) -> [f64; DEGREE + 1] {
        let t = (self.of.germ(value) - self.centre) / self.scale;
        self.rows.map(|row| row.iter().rev().fold(0.0, |sum, c| sum * t + c))
    }
}

/// Centre and scale of a distribution's germ, and the moments of `(germ - centre) / scale`.
fn moments(of: &Distribution) -> (f64, f64, [f64; 2 * DEGREE + 1]) {
    let uniform = std::array::from_fn(|k| if k % 2 == 0 { 1.0 / (k + 1) as f64 } else { 0.0 });
    match (of, of.normal()) {
        (Distribution::Uniform { low, high }, _) => (0.5 * (low + high), 0.5 * (high - low), uniform),
        (_, Some((mean, sd, None))) => (mean, sd, [1.0, 0.0, 1.0, 0.0, 3.0, 0.0, 15.0]),
        (_, Some((mean, sd, Some([low, high])))) => {
            let (centre, scale) = (0.5 * (low + high), 0.5 * (high - low));
            // Relative to the largest density inside, which is that at the end nearest to the mean.
            let nearest = (mean.clamp(low, high) - mean) / sd;
            let weight =
                |t: f64| density((centre + scale * t - mean) / sd) / density(nearest).max(f64::MIN_POSITIVE);
            (centre, scale, simpson(weight))
        }
        (Distribution::List { values }, _) => {
            let count = values.len() as f64;
            let centre = values.iter().sum::<f64>() / count;
            let scale = values.iter().map(|v| (v - centre).abs()).fold(0.0, f64::max);
            let scale = if scale > 0.0 { scale } else { 1.0 };
            let power = |k: usize| values.iter().map(|v| ((v - centre) / scale).powi(k as i32)).sum::<f64>();
            (centre, scale, std::array::from_fn(|k| power(k) / count))
        }
        // `normal` knows all other distributions.
        _ => (0.0, 1.0, uniform),
    }
}

/// Moments of a density between -1 and 1, of which the factor is free.
fn simpson(density: impl Fn(f64) -> f64) -> [f64; 2 * DEGREE + 1] {
    let mut sums = [0.0; 2 * DEGREE + 1];
    for i in 0..=INTERVALS {
        let t = -1.0 + 2.0 * i as f64 / INTERVALS as f64;
        let factor = if i == 0 || i == INTERVALS { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
        let weight = factor * density(t);
        sums.iter_mut().enumerate().for_each(|(k, sum)| *sum += weight * t.powi(k as i32));
    }
    sums.map(|sum| sum / sums[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_orthonormal() {
        for (of, degree) in [
            (Distribution::Uniform { low: 3.0, high: 5.0 }, 3),
            (Distribution::Normal { mean: 1.0, sd: 2.0, within: Some([0.0, 1.5]) }, 3),
            (Distribution::Lognormal { mean: 1.0, sd: 0.5, within: Some([0.7, 4.0]) }, 3),
            (Distribution::List { values: vec![1.0, 2.0, 5.0] }, 2),
            (Distribution::List { values: vec![4.0] }, 0),
        ] {
            let basis = Basis::new(&of);
            assert_eq!(basis.degree, degree, "{of:?}");
            let count = 30_000;
            let mut gram = [[0.0; 4]; 4];
            for i in 0..count {
                let values = basis.at(of.quantile((f64::from(i) + 0.5) / f64::from(count)));
                for (a, b) in (0..=degree).flat_map(|a| (0..=degree).map(move |b| (a, b))) {
                    gram[a][b] += values[a] * values[b] / f64::from(count);
                }
            }
            for (a, b) in (0..=degree).flat_map(|a| (0..=degree).map(move |b| (a, b))) {
                let expected = if a == b { 1.0 } else { 0.0 };
                assert!((gram[a][b] - expected).abs() < 1e-4, "{of:?}: {a} {b} {}", gram[a][b]);
            }
        }
    }

    #[test]
    fn a_normal_distribution_has_hermite_polynomials() {
        let basis = Basis::new(&Distribution::Normal { mean: 1.0, sd: 2.0, within: None });
        let z: f64 = 0.7;
        let expected = [1.0, z, (z * z - 1.0) / 2f64.sqrt(), (z.powi(3) - 3.0 * z) / 6f64.sqrt()];
        assert!(basis.at(1.0 + 2.0 * z).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14));
    }
}
