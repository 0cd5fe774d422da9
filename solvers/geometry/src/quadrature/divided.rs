//! Rules on equal parts of the reference triangle or square, for integrands that vary within a face.

use super::Rule;

/// Division of a face into equal parts, n along each edge, and the location of the points on them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parts {
    /// The rule's points, which lie inside, on each part.
    Inside(usize),
    /// The corners of each part, including corners of the face and points on its edges.
    Corners(usize),
}

impl Parts {
    /// The undivided face.
    pub const WHOLE: Parts = Parts::Inside(1);

    /// Returns the rule on the divided reference triangle. `rule` is the rule on an undivided triangle, which
    /// is applied to each part ([`Parts::Inside`]) or ignored ([`Parts::Corners`]).
    pub fn tri(self, rule: &Rule<2>) -> Rule<2> {
        match self {
            Parts::Inside(1) => rule.clone(),
            Parts::Inside(parts) => divided_tri(rule, parts),
            Parts::Corners(parts) => corners(parts, |i, j| {
                let on_edges = [i == 0, j == 0, i + j == parts].into_iter().filter(|on| *on).count();
                // Each of the adjacent triangles (one, three or six) contributes a third of its area.
                let around = [6.0, 3.0, 1.0].get(on_edges).filter(|_| i + j <= parts)?;
                Some(([i, j].map(|k| k as f64 / parts as f64), around / 6.0))
            }),
        }
    }

    /// Returns the rule on the divided reference square. `rule` is the rule on an undivided square, used as
    /// in [`Parts::tri`].
    pub fn quad(self, rule: &Rule<2>) -> Rule<2> {
        match self {
            Parts::Inside(1) => rule.clone(),
            Parts::Inside(parts) => divided_quad(rule, parts),
            Parts::Corners(parts) => corners(parts, |i, j| {
                let around = |k: usize| if k == 0 || k == parts { 1.0 } else { 2.0 };
                Some(([i, j].map(|k| 2.0 * k as f64 / parts as f64 - 1.0), around(i) * around(j)))
            }),
        }
    }
}

/// Points on a lattice of `parts` steps along each axis. `at` returns the weights relative to the square of
/// the step.
fn corners(parts: usize, at: impl Fn(usize, usize) -> Option<([f64; 2], f64)>) -> Rule<2> {
    let mut out = Rule { points: Vec::new(), weights: Vec::new() };
    for (j, i) in (0..=parts).flat_map(|j| (0..=parts).map(move |i| (j, i))) {
        if let Some((point, weight)) = at(i, j) {
            out.points.push(point);
            out.weights.push(weight / (parts * parts) as f64);
        }
    }
    out
}

/// Applies the rule to each of the `parts` x `parts` triangles of a triangle with equally divided edges.
fn divided_tri(rule: &Rule<2>, parts: usize) -> Rule<2> {
    let step = 1.0 / parts as f64;
    let mut out = Rule { points: Vec::new(), weights: Vec::new() };
    for row in 0..parts {
        for column in 0..parts - row {
            let (x, y) = (column as f64 * step, row as f64 * step);
            push(rule, [x, y], step, &mut out);
            // The adjacent triangle, upside down.
            if column + row + 1 < parts {
                push(rule, [x + step, y + step], -step, &mut out);
            }
        }
    }
    out
}

/// Applies the rule to each of the `parts` x `parts` squares of a square with equally divided edges.
fn divided_quad(rule: &Rule<2>, parts: usize) -> Rule<2> {
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

/// Appends the rule, scaled by `scale` and moved to `origin`.
fn push(rule: &Rule<2>, origin: [f64; 2], scale: f64, out: &mut Rule<2>) {
    out.points.extend(rule.points.iter().map(|p| [0, 1].map(|a| origin[a] + scale * p[a])));
    out.weights.extend(rule.weights.iter().map(|w| w * scale * scale));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::{quad, tri};

    #[test]
    fn corners_of_parts_integrate_linear_fields() {
        for parts in 1..5 {
            let Rule { points, weights } = Parts::Corners(parts).tri(&tri(3).unwrap());
            assert_eq!(points.len(), (parts + 1) * (parts + 2) / 2);
            assert!([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].iter().all(|corner| points.contains(corner)));
            let sum = |axis: usize| points.iter().zip(&weights).map(|(p, w)| w * p[axis]).sum::<f64>();
            assert!((weights.iter().sum::<f64>() - 0.5).abs() < 1e-15, "{parts}");
            assert!((0..2).all(|axis| (sum(axis) - 1.0 / 6.0).abs() < 1e-15), "{parts}");
            let Rule { points, weights } = Parts::Corners(parts).quad(&quad(2));
            assert!(points.len() == (parts + 1).pow(2) && points.contains(&[1.0, -1.0]));
            let sum: f64 = points.iter().zip(&weights).map(|([x, y], w)| w * (1.0 + x) * (1.0 + y)).sum();
            assert!((sum - 4.0).abs() < 1e-14, "{parts}: {sum}");
        }
    }

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
