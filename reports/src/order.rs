//! Observed order of convergence and the grid convergence index.

/// Errors below this are dominated by rounding and show no order.
pub(crate) const ROUNDING: f64 = 1e-11;

/// Largest difference of two pairwise orders that count as settled.
const SETTLED: f64 = 0.15;
/// Largest deviation from 1 of the ratio of two grid convergence indices that agree with their order.
const IN_RANGE: f64 = 0.05;

/// Observed order of a series of errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// ln(e1/e2) / ln(h1/h2) of neighbouring levels, coarse to fine.
    pub pairs: Vec<f64>,
    /// Slope of ln e over ln h, by least squares.
    pub fit: f64,
    /// Standard error of the slope; requires three levels.
    pub error: Option<f64>,
    /// Half width of the slope's 95 % confidence band (Student's t, n - 2 degrees of freedom).
    pub band: Option<f64>,
    /// Verdict on the levels; requires three.
    pub verdict: Option<Verdict>,
}

/// Convergence behaviour of a series of levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Settled on an order: the last two pairs agree within 0.15, or the ratio of two grid convergence
    /// indices is 1 within 0.05.
    Asymptotic,
    /// Improving, at an order that still changes.
    NotYet,
    /// Improving and deteriorating alternately.
    Oscillatory,
    /// Deteriorating.
    Divergent,
}

impl Verdict {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Asymptotic => "asymptotic",
            Verdict::NotYet => "not yet",
            Verdict::Oscillatory => "oscillatory",
            Verdict::Divergent => "divergent",
        }
    }

    /// Verdict on the orders between neighbouring levels, from coarse to fine.
    fn of_pairs(pairs: &[f64]) -> Option<Verdict> {
        let [.., before, last] = *pairs else { return None };
        let worse = pairs.iter().filter(|p| **p <= 0.0).count();
        Some(match worse {
            0 if (last - before).abs() <= SETTLED => Verdict::Asymptotic,
            0 => Verdict::NotYet,
            // Errors grow from some level on to the last.
            _ if pairs[pairs.len() - worse..].iter().all(|p| *p <= 0.0) => Verdict::Divergent,
            _ => Verdict::Oscillatory,
        })
    }
}

/// Computes the order of `(h, error)` pairs, from coarse to fine; `None` with fewer than two usable levels.
pub fn observed(points: &[(f64, f64)]) -> Option<Order> {
    let mut logs: Vec<(f64, f64)> = Vec::new();
    for &(h, e) in points {
        let x = h.ln();
        if e > ROUNDING && x.is_finite() && e.is_finite() && logs.last().is_none_or(|l| x < l.0 - 1e-9) {
            logs.push((x, e.ln()));
        }
    }
    let n = logs.len();
    if n < 2 {
        return None;
    }
    let pairs: Vec<f64> = logs.windows(2).map(|w| (w[0].1 - w[1].1) / (w[0].0 - w[1].0)).collect();
    let mean = |f: fn(&(f64, f64)) -> f64| logs.iter().map(f).sum::<f64>() / n as f64;
    let (x, y) = (mean(|l| l.0), mean(|l| l.1));
    let sxx: f64 = logs.iter().map(|l| (l.0 - x).powi(2)).sum();
    let fit = logs.iter().map(|l| (l.0 - x) * (l.1 - y)).sum::<f64>() / sxx;
    let error = (n > 2).then(|| {
        let residual: f64 = logs.iter().map(|l| (l.1 - y - fit * (l.0 - x)).powi(2)).sum();
        (residual / (n - 2) as f64 / sxx).sqrt()
    });
    let verdict = Verdict::of_pairs(&pairs);
    Some(Order { band: error.map(|e| e * student(n - 2)), pairs, fit, error, verdict })
}

/// Two-sided 95 % quantile of Student's t.
fn student(freedom: usize) -> f64 {
    let table = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228];
    table.get(freedom - 1).copied().unwrap_or(1.96 + 2.4 / freedom as f64)
}

/// Result on the three finest levels of a functional.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) verdict: Verdict,
    /// The index, if the levels approach a limit from one side.
    pub(crate) index: Option<Gci>,
}

/// Grid convergence index of a functional on the three finest levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gci {
    /// Apparent order p.
    pub(crate) order: f64,
    /// Richardson's extrapolated value.
    pub(crate) extrapolated: f64,
    /// Index of the fine grid, relative: 1.25 |(f1 - f2)/f1| / (r21^p - 1).
    pub(crate) fine: f64,
    /// Index of the next coarser grid: 1.25 |(f2 - f3)/f2| / (r32^p - 1).
    pub(crate) coarse: f64,
    /// Ratio r21^p GCI21 / GCI32, near 1 in the asymptotic range.
    pub(crate) range: f64,
}

/// Computes the grid convergence index of `(h, f)` pairs, from coarse to fine (Celik et al., J. Fluids Eng.
/// 130, 2008, steps 3 to 5; safety factor 1.25). Returns `None` with fewer than three levels, or if the
/// finest two agree to rounding.
pub(crate) fn grid_convergence(points: &[(f64, f64)]) -> Option<Outcome> {
    let [.., (h3, f3), (h2, f2), (h1, f1)] = *points else { return None };
    let (r21, r32) = (h2 / h1, h3 / h2);
    let (e21, e32) = (f2 - f1, f3 - f2);
    let ratio = e32 / e21;
    let usable = r21 > 1.0 && r32 > 1.0 && ratio.is_finite() && f1 != 0.0 && e21.abs() > ROUNDING * f1.abs();
    if !usable {
        return None;
    }
    if ratio <= 0.0 {
        // Alternating changes approach a limit as long as they shrink.
        let verdict = if ratio < -1.0 { Verdict::Oscillatory } else { Verdict::Divergent };
        return Some(Outcome { verdict, index: None });
    }
    let order = apparent_order(ratio, r21, r32);
    if !(order.is_finite() && order > 0.05) || ratio <= 1.0 && r21 == r32 {
        return Some(Outcome { verdict: Verdict::Divergent, index: None });
    }
    let gain = r21.powf(order) - 1.0;
    let fine = 1.25 * (e21 / f1).abs() / gain;
    let coarse = 1.25 * (e32 / f2).abs() / (r32.powf(order) - 1.0);
    let range = r21.powf(order) * fine / coarse;
    let verdict = if (range - 1.0).abs() <= IN_RANGE { Verdict::Asymptotic } else { Verdict::NotYet };
    let index = Gci { order, extrapolated: f1 - e21 / gain, fine, coarse, range };
    Some(Outcome { verdict, index: Some(index) })
}

/// Apparent order: the solution of `p = |ln(e32/e21) + q(p)| / ln r21`, `q = ln((r21^p - 1)/(r32^p - 1))`.
/// Constant refinement gives q = 0 at once.
fn apparent_order(ratio: f64, r21: f64, r32: f64) -> f64 {
    let mut p = ratio.ln().abs() / r21.ln();
    for _ in 0..200 {
        let q = if p > 1e-12 { ((r21.powf(p) - 1.0) / (r32.powf(p) - 1.0)).ln() } else { 0.0 };
        let next = (ratio.ln() + q).abs() / r21.ln();
        let done = (next - p).abs() < 1e-12;
        p = next;
        if done {
            break;
        }
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_gives_its_order() {
        let points: Vec<_> = [0.4, 0.2, 0.1, 0.05].iter().map(|&h: &f64| (h, 3.0 * h.powf(2.0))).collect();
        let order = observed(&points).unwrap();
        assert!((order.fit - 2.0).abs() < 1e-12 && order.error.unwrap() < 1e-12);
        assert_eq!(order.verdict, Some(Verdict::Asymptotic));
        assert!(order.pairs.iter().all(|p| (p - 2.0).abs() < 1e-12));
    }

    #[test]
    fn scatter_widens_the_band() {
        // Computed by hand: x = ln h = (0, -1, -2), y = (0, -2, -3), slope 1.5, residuals (-1, 2, -1)/6, s =
        // sqrt(1/6), se = sqrt(1/12).
        let e = std::f64::consts::E;
        let order = observed(&[(1.0, 1.0), (1.0 / e, e.powi(-2)), (e.powi(-2), e.powi(-3))]).unwrap();
        assert!((order.fit - 1.5).abs() < 1e-12, "{order:?}");
        assert!((order.error.unwrap() - (1.0f64 / 12.0).sqrt()).abs() < 1e-12, "{order:?}");
        assert!((order.band.unwrap() - 12.706 * (1.0f64 / 12.0).sqrt()).abs() < 1e-9);
        assert_eq!(order.verdict, Some(Verdict::NotYet));
    }

    #[test]
    fn rounding_and_single_levels_have_no_order() {
        assert_eq!(observed(&[(0.2, 1e-15), (0.1, 3e-15)]), None);
        assert_eq!(observed(&[(0.2, 1e-3)]), None);
        assert_eq!(observed(&[(0.2, 1e-3), (0.2, 1e-4)]), None);
    }

    #[test]
    fn gci_recovers_order_and_limit() {
        for levels in [[0.4, 0.2, 0.1], [0.5, 0.3, 0.1]] {
            let points: Vec<_> = levels.iter().map(|&h: &f64| (h, 2.0 - 0.7 * h.powf(1.7))).collect();
            let gci = grid_convergence(&points).unwrap().index.unwrap();
            assert!((gci.order - 1.7).abs() < 1e-6 && (gci.extrapolated - 2.0).abs() < 1e-6, "{gci:?}");
            let truth = 1.25 * (0.7 * 0.1f64.powf(1.7)) / points[2].1;
            assert!((gci.fine / truth - 1.0).abs() < 1e-5, "{gci:?} {truth}");
        }
        let verdict = |f: [f64; 3]| {
            let outcome = grid_convergence(&[(0.4, f[0]), (0.2, f[1]), (0.1, f[2])]).unwrap();
            (outcome.verdict, outcome.index.is_some())
        };
        assert_eq!(verdict([1.0, 1.1, 1.05]), (Verdict::Oscillatory, false));
        assert_eq!(verdict([1.0, 1.05, 0.95]), (Verdict::Divergent, false), "alternates, and grows");
        assert_eq!(verdict([1.0, 1.1, 1.3]), (Verdict::Divergent, false));
        assert_eq!(grid_convergence(&[(0.4, 1.0), (0.2, 1.1)]), None);
    }

    /// Slater (NASA Glenn), Examining spatial (grid) convergence: total pressure recovery of an inlet on
    /// three grids. The published program works in single precision. Its order is 1.78618, whereas these
    /// digits give 1.78617, and its indices differ by a few millionths.
    #[test]
    fn the_inlet_of_nasa_to_its_digits() {
        let outcome = grid_convergence(&[(4.0, 0.96178), (2.0, 0.96854), (1.0, 0.97050)]).unwrap();
        let gci = outcome.index.unwrap();
        let near = |found: f64, wanted: f64, digit: f64| {
            assert!((found - wanted).abs() <= 0.5 * digit, "{found} {wanted}")
        };
        near(gci.order, 1.78618, 3e-5);
        near(gci.extrapolated, 0.971300, 1e-6);
        near(100.0 * gci.fine, 0.103080, 6e-6);
        near(100.0 * gci.coarse, 0.356244, 2e-5);
        near(gci.range, 0.997980, 1e-6);
        assert_eq!(outcome.verdict, Verdict::Asymptotic);
    }

    #[test]
    fn verdicts_of_errors() {
        let verdict = |errors: &[f64]| {
            let points: Vec<_> =
                errors.iter().enumerate().map(|(k, &e)| (0.5f64.powi(k as i32), e)).collect();
            observed(&points).unwrap().verdict
        };
        assert_eq!(verdict(&[1.0, 0.25]), None);
        assert_eq!(verdict(&[1.0, 0.25, 0.06, 0.015]), Some(Verdict::Asymptotic));
        assert_eq!(verdict(&[1.0, 0.8, 0.3, 0.05]), Some(Verdict::NotYet));
        assert_eq!(verdict(&[1.0, 0.3, 0.4, 0.1]), Some(Verdict::Oscillatory));
        assert_eq!(verdict(&[1.0, 0.3, 0.4, 0.5]), Some(Verdict::Divergent));
    }
}
