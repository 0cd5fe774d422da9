//! Quadrature rules on the reference tetrahedron, triangle, cube and square.
//!
//! Simplex rules are fully symmetric, so that an integral does not depend on the order in which a cell lists its
//! corners; all weights are positive and all points lie strictly inside. Cube and square rules are tensor products
//! of Gauss-Legendre. Weights sum to the measure of the reference cell.

mod gauss;
mod simplex;

pub use gauss::{gauss_legendre, hex, quad};
pub use simplex::{TET_RULES, TRI_RULES, tet, tri};

/// Points and weights on a reference cell of dimension `D`.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule<const D: usize> {
    /// Positions in reference coordinates: unit simplex (first `D` of the barycentric coordinates belonging to
    /// corners 1, 2, ..) or `[-1, 1]^D`.
    pub points: Vec<[f64; D]>,
    /// One weight per point; they sum to the reference measure (tetrahedron 1/6, triangle 1/2, cube 8, square 4).
    pub weights: Vec<f64>,
}

impl<const D: usize> Rule<D> {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.weights.len()
    }

    /// True without points.
    pub fn is_empty(&self) -> bool {
        self.weights.is_empty()
    }
}

impl Rule<2> {
    /// A rule of the reference triangle in each of its four parts of half the size: where an integrand is no polynomial, such as near a
    /// singular corner, more points help where a higher degree does not.
    pub fn halved_triangle(&self) -> Rule<2> {
        // Corners at the origin, at (1/2, 0) and at (0, 1/2), and the middle one, turned round.
        let map = |[s, t]: [f64; 2]| {
            let (s, t) = (0.5 * s, 0.5 * t);
            [[s, t], [s + 0.5, t], [s, t + 0.5], [0.5 - s, 0.5 - t]]
        };
        let each = |part: usize| self.points.iter().map(move |&x| (part, x));
        let points = (0..4).flat_map(each).map(|(part, x)| map(x)[part]).collect();
        let weights = (0..4).flat_map(|_| self.weights.iter().map(|w| 0.25 * w)).collect();
        Rule { points, weights }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integrals of s^a t^b up to the rule's degree stay what they are, and those beyond come nearer.
    #[test]
    fn quarters_integrate_the_same_polynomials() {
        let integral = |rule: &Rule<2>, a: i32, b: i32| -> f64 {
            rule.points.iter().zip(&rule.weights).map(|(x, w)| w * x[0].powi(a) * x[1].powi(b)).sum()
        };
        let triangle = tri(6).unwrap();
        for (a, b) in [(0, 0), (1, 0), (0, 3), (2, 2), (1, 3)] {
            let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
            let exact = factorial(a) * factorial(b) / factorial(a + b + 2);
            assert!((integral(&triangle.halved_triangle(), a, b) - exact).abs() < 1e-15, "{a} {b}");
        }
        let exact = 1.0 / 110.0;
        let error = |rule: &Rule<2>| (integral(rule, 9, 0) - exact).abs();
        assert!(error(&triangle.halved_triangle()) < 0.1 * error(&triangle));
    }
}
