//! Gauss-Legendre rules and their tensor products.

use super::Rule;

/// Points (ascending, in [-1, 1]) and weights (sum 2) of the `n`-point Gauss-Legendre rule, exact to degree
/// `2 n - 1`. Newton's method finds the roots of the Legendre polynomial from Chebyshev-like first guesses.
/// The halves are mirrored, so the rule is symmetric to the last bit. Empty for `n = 0`.
pub fn gauss_legendre(n: usize) -> (Vec<f64>, Vec<f64>) {
    let mut points = vec![0.0; n];
    let mut weights = vec![0.0; n];
    for i in 0..n.div_ceil(2) {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        for _ in 0..100 {
            let (p, dp) = legendre(n, x);
            let step = p / dp;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        if 2 * i + 1 == n {
            x = 0.0;
        }
        let (_, dp) = legendre(n, x);
        let weight = 2.0 / ((1.0 - x * x) * dp * dp);
        points[i] = -x;
        points[n - 1 - i] = x;
        weights[i] = weight;
        weights[n - 1 - i] = weight;
    }
    (points, weights)
}

/// `P_n(x)` and its derivative, by the three-term recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut here) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
    }
    (here, n as f64 * (x * here - before) / (x * x - 1.0))
}

/// `n x n x n` Gauss points on the cube [-1, 1]^3, exact to degree `2 n - 1` in each coordinate; x runs
/// fastest.
pub fn hex(n: usize) -> Rule<3> {
    let (x, w) = gauss_legendre(n);
    let mut rule = Rule { points: Vec::with_capacity(n * n * n), weights: Vec::with_capacity(n * n * n) };
    for k in 0..n {
        for j in 0..n {
            for i in 0..n {
                rule.points.push([x[i], x[j], x[k]]);
                rule.weights.push(w[i] * w[j] * w[k]);
            }
        }
    }
    rule
}

/// `n x n` Gauss points on the square [-1, 1]^2, exact to degree `2 n - 1` in each coordinate; x runs
/// fastest.
pub fn quad(n: usize) -> Rule<2> {
    let (x, w) = gauss_legendre(n);
    let mut rule = Rule { points: Vec::with_capacity(n * n), weights: Vec::with_capacity(n * n) };
    for j in 0..n {
        for i in 0..n {
            rule.points.push([x[i], x[j]]);
            rule.weights.push(w[i] * w[j]);
        }
    }
    rule
}
