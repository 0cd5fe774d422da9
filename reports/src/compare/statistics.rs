//! Robust means with their confidence. Times have outliers, which are mostly upwards.

/// A mean with its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate {
    pub(super) mean: f64,
    /// Standard error of the mean.
    pub(super) error: f64,
    /// Degrees of freedom of the standard error.
    pub(super) freedom: usize,
}

impl Estimate {
    /// Half width of the band that contains the mean with probability `1 - risk`.
    pub(super) fn band(&self, risk: f64) -> f64 {
        student(self.freedom, risk) * self.error
    }
}

/// Fraction of the values trimmed at either end.
const TRIMMED: f64 = 0.2;

/// Mean of the values without a fifth at either end, with its standard error (Tukey and McLaughlin 1963; Yuen
/// 1974). `None` for fewer than four values.
pub(super) fn trimmed_mean(values: &[f64]) -> Option<Estimate> {
    let n = values.len();
    if n < 4 {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let cut = (TRIMMED * n as f64) as usize;
    let (low, high) = (sorted[cut], sorted[n - 1 - cut]);
    let kept = n - 2 * cut;
    let mean = sorted[cut..n - cut].iter().sum::<f64>() / kept as f64;
    // For the spread, a trimmed value is replaced by the nearest value that is kept.
    let winsorised = |v: &f64| v.clamp(low, high);
    let middle = sorted.iter().map(winsorised).sum::<f64>() / n as f64;
    let squares: f64 = sorted.iter().map(|v| (winsorised(v) - middle).powi(2)).sum();
    let error = (squares / (kept * (kept - 1)) as f64).sqrt();
    Some(Estimate { mean, error, freedom: kept - 1 })
}

/// Median; 0 for no values.
pub(super) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    match sorted.len() {
        0 => 0.0,
        n if n % 2 == 1 => sorted[n / 2],
        n => 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]),
    }
}

/// Robust standard deviation of the values about 0: 1.4826 times the median of their absolute values.
pub(super) fn scale(values: &[f64]) -> f64 {
    let sizes: Vec<f64> = values.iter().map(|v| v.abs()).collect();
    1.4826 * median(&sizes)
}

/// Two-sided quantile of Student's t, whose absolute value is exceeded with probability `risk`.
pub(super) fn student(freedom: usize, risk: f64) -> f64 {
    let n = freedom.max(1) as f64;
    // Gamma((n + 1) / 2) / Gamma(n / 2), by recurrence from one degree of freedom.
    let mut ratio = 1.0 / std::f64::consts::PI.sqrt();
    for k in 1..freedom {
        ratio = 0.5 * k as f64 / ratio;
    }
    let density =
        |t: f64| ratio / (n * std::f64::consts::PI).sqrt() * (1.0 + t * t / n).powf(-0.5 * (n + 1.0));
    // Probability of both tails beyond t, by Simpson's rule from 0.
    let beyond = |t: f64| {
        let steps = 2000;
        let h = t / steps as f64;
        let weight = |k: usize| if k == 0 || k == steps { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
        1.0 - 2.0 * h / 3.0 * (0..=steps).map(|k| weight(k) * density(k as f64 * h)).sum::<f64>()
    };
    let (mut low, mut high) = (0.0, 1000.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if beyond(middle) > risk { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        for (freedom, risk, expected) in
            [(1, 0.05, 12.706), (2, 0.05, 4.303), (4, 0.01, 4.604), (10, 0.05, 2.228), (30, 0.01, 2.750)]
        {
            let found = student(freedom, risk);
            assert!((found - expected).abs() < 1e-3 * expected, "{freedom} {risk}: {found}");
        }
    }

    #[test]
    fn an_outlier_moves_nothing() {
        let values = [0.9, 1.0, 1.1, 1.0, 1000.0, 0.95, 1.05, 1.0, 1.0, 1.0];
        let found = trimmed_mean(&values).unwrap();
        assert!((found.mean - 1.0).abs() < 0.02 && found.error < 0.05, "{found:?}");
        assert_eq!(found.freedom, 5);
        assert!(trimmed_mean(&values[..3]).is_none());
    }

    #[test]
    fn medians_and_scales() {
        assert_eq!((median(&[]), median(&[3.0, 1.0, 2.0]), median(&[4.0, 1.0])), (0.0, 2.0, 2.5));
        assert!((scale(&[-1.0, 1.0, 2.0]) - 1.4826).abs() < 1e-12);
    }
}
