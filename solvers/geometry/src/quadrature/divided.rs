//! Rules on equal parts of the reference triangle or square, for what changes within a face.

use super::Rule;

/// The rule on each of the `parts` x `parts` triangles into which equal steps along its edges divide the triangle.
pub fn divided_tri(rule: &Rule<2>, parts: usize) -> Rule<2> {
    let step = 1.0 / parts as f64;
    let mut out = Rule { points: Vec::new(), weights: Vec::new() };
    for row in 0..parts {
        for column in 0..parts - row {
            let (x, y) = (column as f64 * step, row as f64 * step);
            push(rule, [x, y], step, &mut out);
            // The one beside it, upside down.
            if column + row + 1 < parts {
                push(rule, [x + step, y + step], -step, &mut out);
            }
        }
    }
    out
}

/// The rule on each of the `parts` x `parts` squares into which equal steps along its edges divide the square.
pub fn divided_quad(rule: &Rule<2>, parts: usize) -> Rule<2> {
    let step = 1.0 / parts as f64;
    let mut out = Rule { points: Vec::new(), weights: Vec::new() };
    for row in 0..parts {
        for column in 0..parts {
            let middle = |k: usize| (2 * k + 1) as f64 * step - 1.0;
            push(rule, [middle(column), middle(row)], step, &mut out);
        }
    }
    out
}

/// The rule's points times `scale` from `origin` on.
fn push(rule: &Rule<2>, origin: [f64; 2], scale: f64, out: &mut Rule<2>) {
    out.points.extend(rule.points.iter().map(|p| [0, 1].map(|a| origin[a] + scale * p[a])));
    out.weights.extend(rule.weights.iter().map(|w| w * scale * scale));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::{quad, tri};

    /// `x^a y^b` over the triangle is `a! b! / (a + b + 2)!`.
    #[test]
    fn parts_integrate_what_the_whole_does() {
        for parts in 1..5 {
            let rule = divided_tri(&tri(3).unwrap(), parts);
            assert_eq!(rule.len(), 3 * parts * parts);
            assert!(rule.points.iter().all(|[x, y]| *x > 0.0 && *y > 0.0 && x + y < 1.0), "{parts}");
            let sum = |f: fn([f64; 2]) -> f64| -> f64 {
                rule.points.iter().zip(&rule.weights).map(|(p, w)| w * f(*p)).sum()
            };
            for (found, exact) in
                [(sum(|_| 1.0), 0.5), (sum(|[x, _]| x), 1.0 / 6.0), (sum(|[x, y]| x * y), 1.0 / 24.0)]
            {
                assert!((found - exact).abs() < 1e-15, "{parts}: {found} {exact}");
            }
            let rule = divided_quad(&quad(2), parts);
            assert_eq!(rule.len(), 4 * parts * parts);
            let sum: f64 = rule.points.iter().zip(&rule.weights).map(|([x, y], w)| w * x * x * y * y).sum();
            assert!((sum - 4.0 / 9.0).abs() < 1e-14, "{parts}: {sum}");
            assert!((rule.weights.iter().sum::<f64>() - 4.0).abs() < 1e-14);
        }
    }
}
