//! Rules on the prism: a triangle rule times a Gauss-Legendre rule along z.

use super::Rule;
use super::gauss::gauss_legendre;
use super::simplex::tri;

/// (Points, points across the triangle, points along z) of every prism rule.
pub const PRISM_RULES: [(usize, usize, usize); 6] =
    [(1, 1, 1), (6, 3, 2), (9, 3, 3), (18, 6, 3), (21, 7, 3), (48, 12, 4)];

/// Returns the rule with this number of points on the triangle (0,0), (1,0), (0,1) between z = -1 and z = 1,
/// or
/// `None` if [`PRISM_RULES`] has no such rule. The weights sum to 1; the points of one triangle are adjacent.
pub fn prism(points: usize) -> Option<Rule<3>> {
    let (_, across, along) = PRISM_RULES.into_iter().find(|rule| rule.0 == points)?;
    let flat = tri(across)?;
    let (heights, weights) = gauss_legendre(along);
    let mut rule = Rule { points: Vec::new(), weights: Vec::new() };
    for (z, w) in heights.into_iter().zip(weights) {
        rule.points.extend(flat.points.iter().map(|&[x, y]| [x, y, z]));
        rule.weights.extend(flat.weights.iter().map(|area| area * w));
    }
    Some(rule)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::TRI_RULES;

    /// `x^a y^b z^c` over the prism is `a! b! / (a + b + 2)!` times `2 / (c + 1)` for even `c`, else 0.
    #[test]
    fn rules_are_exact_to_the_degrees_of_their_factors() {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for (points, across, along) in PRISM_RULES {
            let rule = prism(points).unwrap();
            assert_eq!((rule.len(), across * along), (points, points));
            let degree = TRI_RULES.iter().find(|rule| rule.0 == across).unwrap().1 as i32;
            for (a, b, c) in (0..=degree).flat_map(|a| {
                (0..=degree - a).flat_map(move |b| (0..2 * along as i32).map(move |c| (a, b, c)))
            }) {
                let sum = |[x, y, z]: &[f64; 3], w: &f64| w * x.powi(a) * y.powi(b) * z.powi(c);
                let found: f64 = rule.points.iter().zip(&rule.weights).map(|(p, w)| sum(p, w)).sum();
                let height = if c % 2 == 0 { 2.0 / f64::from(c + 1) } else { 0.0 };
                let exact = factorial(a) * factorial(b) / factorial(a + b + 2) * height;
                assert!((found - exact).abs() < 1e-15, "{points} points, {a} {b} {c}: {found} for {exact}");
            }
        }
        assert_eq!(prism(7), None);
    }
}
