//! Distributions of one input.

use serde::{Deserialize, Serialize};

use crate::normal::{below, quantile};

/// Distribution of an input, in the unit in which the input is given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Distribution {
    /// Every value between two ends is equally likely.
    Uniform {
        /// Lower end.
        low: f64,
        /// Upper end, above the lower end.
        high: f64,
    },
    /// Normal distribution.
    Normal {
        /// Mean, before truncation.
        mean: f64,
        /// Standard deviation, before truncation; above 0.
        sd: f64,
        /// Ends at which the distribution is cut off; `None` for all values.
        within: Option<[f64; 2]>,
    },
    /// Distribution of a positive value whose logarithm is normally distributed.
    Lognormal {
        /// Mean of the value itself, before truncation; above 0.
        mean: f64,
        /// Standard deviation of the value itself, before truncation; above 0.
        sd: f64,
        /// Ends at which the distribution is cut off, above 0; `None` for all values.
        within: Option<[f64; 2]>,
    },
    /// Some values, all equally likely.
    List {
        /// The values, at least one.
        values: Vec<f64>,
    },
}

impl Distribution {
    /// Value below which a value lies with the probability `u`, `0 < u < 1`.
    pub fn quantile(&self, u: f64) -> f64 {
        match self {
            Distribution::Uniform { low, high } => low + u * (high - low),
            Distribution::List { values } => {
                values[((u * values.len() as f64) as usize).min(values.len() - 1)]
            }
            Distribution::Normal { .. } => self.gaussian(u),
            Distribution::Lognormal { .. } => self.gaussian(u).exp(),
        }
    }

    /// The number in which results are polynomials: the value, or the logarithm of a lognormal value.
    pub(crate) fn germ(&self, value: f64) -> f64 {
        if matches!(self, Distribution::Lognormal { .. }) { value.ln() } else { value }
    }

    /// Mean and standard deviation of the normally distributed number, with the ends of its truncation;
    /// `None` for other distributions.
    pub(crate) fn normal(&self) -> Option<(f64, f64, Option<[f64; 2]>)> {
        match *self {
            Distribution::Normal { mean, sd, within } => Some((mean, sd, within)),
            Distribution::Lognormal { mean, sd, within } => {
                let variance = (sd / mean).powi(2).ln_1p();
                let ends = within.map(|ends| ends.map(f64::ln));
                Some((mean.ln() - 0.5 * variance, variance.sqrt(), ends))
            }
            _ => None,
        }
    }

    /// Probability of the values that a truncation keeps; 1 without one.
    pub fn kept(&self) -> f64 {
        let Some((mean, sd, Some([low, high]))) = self.normal() else { return 1.0 };
        let (a, b) = ((low - mean) / sd, (high - mean) / sd);
        if a > 0.0 { below(-a) - below(-b) } else { below(b) - below(a) }
    }

    /// Quantile of the normally distributed number.
    fn gaussian(&self, u: f64) -> f64 {
        let Some((mean, sd, within)) = self.normal() else { return 0.0 };
        let Some([low, high]) = within else { return mean + sd * quantile(u) };
        // On the side of the smaller tail, so that an interval far above the mean keeps its digits.
        let (a, b) = ((low - mean) / sd, (high - mean) / sd);
        let (a, b, u, sign) = if a > 0.0 { (-b, -a, 1.0 - u, -1.0) } else { (a, b, u, 1.0) };
        let inside = below(a) + u * (below(b) - below(a));
        (mean + sd * sign * quantile(inside)).clamp(low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_distribution() {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12 * (1.0 + b.abs());
        let uniform = Distribution::Uniform { low: 2.0, high: 4.0 };
        assert!(near(uniform.quantile(0.25), 2.5));
        let normal = Distribution::Normal { mean: 20.0, sd: 2.0, within: None };
        assert!(near(normal.quantile(0.975), 20.0 + 2.0 * 1.959_963_984_540_054));
        // ln 2 = sigma^2 for a standard deviation as large as the mean, so the median is mean / sqrt 2.
        let lognormal = Distribution::Lognormal { mean: 3.0, sd: 3.0, within: None };
        assert!(near(lognormal.quantile(0.5), 3.0 / 2f64.sqrt()));
        let list = Distribution::List { values: vec![1.0, 5.0] };
        assert_eq!([0.1, 0.49, 0.51, 0.99].map(|u| list.quantile(u)), [1.0, 1.0, 5.0, 5.0]);
    }

    #[test]
    fn a_truncated_distribution_stays_between_its_ends() {
        for (low, high) in [(-1.0, 1.0), (2.0, 2.5), (9.0, 10.0), (-8.0, 3.0)] {
            let of = Distribution::Normal { mean: 0.0, sd: 1.0, within: Some([low, high]) };
            let all: Vec<f64> = (1..100).map(|i| of.quantile(f64::from(i) / 100.0)).collect();
            assert!(all.iter().all(|x| (low..=high).contains(x)), "{low} {high}: {all:?}");
            assert!(all.windows(2).all(|w| w[0] < w[1]), "{low} {high}: {all:?}");
        }
        let of = Distribution::Normal { mean: 0.0, sd: 1.0, within: Some([0.0, 100.0]) };
        assert!((of.quantile(0.95) - 1.959_963_984_540_054).abs() < 1e-12);
        assert_eq!(of.kept(), 0.5);
        let far = Distribution::Normal { mean: 0.0, sd: 1.0, within: Some([40.0, 41.0]) };
        assert_eq!(far.kept(), 0.0);
    }
}
