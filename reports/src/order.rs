//! Observed order of convergence and the grid convergence index.

/// Errors below this are rounding, not discretisation: they say nothing about an order.
pub(crate) const ROUNDING: f64 = 1e-11;

/// Two pairwise orders closer than this count as settled.
const SETTLED: f64 = 0.15;

/// What a series of errors says about its order.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// ln(e1/e2) / ln(h1/h2) of neighbouring levels, coarse to fine.
    pub pairs: Vec<f64>,
    /// Slope of ln e over ln h by least squares.
    pub fit: f64,
    /// Standard error of the slope; needs three levels.
    pub error: Option<f64>,
    /// Half width of its 95 % confidence band (Student's t, n - 2 degrees of freedom).
    pub band: Option<f64>,
    /// Whether the last two pairwise orders agree within 0.15; needs three levels.
    pub asymptotic: Option<bool>,
}

/// Order of `(h, error)` pairs, coarse to fine; `None` with fewer than two usable levels.
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
    let asymptotic = (n > 2).then(|| (pairs[n - 2] - pairs[n - 3]).abs() <= SETTLED);
    Some(Order { band: error.map(|e| e * student(n - 2)), pairs, fit, error, asymptotic })
}

/// Two-sided 95 % quantile of Student's t.
fn student(freedom: usize) -> f64 {
    let table = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228];
    table.get(freedom - 1).copied().unwrap_or(1.96 + 2.4 / freedom as f64)
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
    /// GCI32 / (r21^p GCI21): near 1 inside the asymptotic range.
    pub(crate) range: f64,
}

/// Grid convergence index of `(h, f)` pairs, coarse to fine (Celik et al., J. Fluids Eng. 130, 2008, steps 3 to 5; safety factor 1.25).
///
/// `None` with fewer than three levels, where `f` oscillates, or where no positive order exists.
pub(crate) fn grid_convergence(points: &[(f64, f64)]) -> Option<Gci> {
    let [.., (h3, f3), (h2, f2), (h1, f1)] = *points else { return None };
    let (r21, r32) = (h2 / h1, h3 / h2);
    let (e21, e32) = (f2 - f1, f3 - f2);
    let ratio = e32 / e21;
    let usable = r21 > 1.0
        && r32 > 1.0
        && ratio.is_finite()
        && ratio > 0.0
        && f1 != 0.0
        && e21.abs() > ROUNDING * f1.abs();
    if !usable {
        return None;
    }
    // p = |ln|e32/e21| + q(p)| / ln r21, q = ln((r21^p - 1)/(r32^p - 1)); constant r gives q = 0 at once.
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
    if !(p.is_finite() && p > 0.05) || ratio <= 1.0 && r21 == r32 {
        return None;
    }
    let gain = r21.powf(p) - 1.0;
    let fine = 1.25 * (e21 / f1).abs() / gain;
    let coarse = 1.25 * (e32 / f2).abs() / (r32.powf(p) - 1.0);
    Some(Gci { order: p, extrapolated: f1 - e21 / gain, fine, range: coarse / (r21.powf(p) * fine) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_gives_its_order() {
        let points: Vec<_> = [0.4, 0.2, 0.1, 0.05].iter().map(|&h: &f64| (h, 3.0 * h.powf(2.0))).collect();
        let order = observed(&points).unwrap();
        assert!((order.fit - 2.0).abs() < 1e-12 && order.error.unwrap() < 1e-12);
        assert_eq!(order.asymptotic, Some(true));
        assert!(order.pairs.iter().all(|p| (p - 2.0).abs() < 1e-12));
    }

    #[test]
    fn scatter_widens_the_band() {
        // By hand: x = ln h = (0, -1, -2), y = (0, -2, -3): slope 1.5, residuals (-1, 2, -1)/6, s = sqrt(1/6), se = sqrt(1/12).
        let e = std::f64::consts::E;
        let order = observed(&[(1.0, 1.0), (1.0 / e, e.powi(-2)), (e.powi(-2), e.powi(-3))]).unwrap();
        assert!((order.fit - 1.5).abs() < 1e-12, "{order:?}");
        assert!((order.error.unwrap() - (1.0f64 / 12.0).sqrt()).abs() < 1e-12, "{order:?}");
        assert!((order.band.unwrap() - 12.706 * (1.0f64 / 12.0).sqrt()).abs() < 1e-9);
        assert_eq!(order.asymptotic, Some(false));
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
            let gci = grid_convergence(&points).unwrap();
            assert!((gci.order - 1.7).abs() < 1e-6 && (gci.extrapolated - 2.0).abs() < 1e-6, "{gci:?}");
            let truth = 1.25 * (0.7 * 0.1f64.powf(1.7)) / points[2].1;
            assert!((gci.fine / truth - 1.0).abs() < 1e-5, "{gci:?} {truth}");
        }
        assert_eq!(grid_convergence(&[(0.4, 1.0), (0.2, 1.1), (0.1, 1.05)]), None);
        assert_eq!(grid_convergence(&[(0.4, 1.0), (0.2, 1.1), (0.1, 1.3)]), None);
    }
}
