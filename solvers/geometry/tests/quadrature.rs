//! Every quadrature rule: exact moments, symmetry and the signs of its weights.

use tissuebench_geometry::quadrature::{Rule, TET_RULES, TRI_RULES, gauss_legendre, hex, quad, tet, tri};

fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}

/// Largest relative error over all monomials of total degree up to `degree` on the unit simplex.
fn simplex_error<const D: usize>(rule: &Rule<D>, degree: usize) -> f64 {
    let mut worst: f64 = 0.0;
    for code in 0..(degree + 1).pow(D as u32) {
        let exponents: [usize; D] = std::array::from_fn(|d| code / (degree + 1).pow(d as u32) % (degree + 1));
        let total: usize = exponents.iter().sum();
        if total > degree {
            continue;
        }
        let exact = exponents.iter().map(|&e| factorial(e)).product::<f64>() / factorial(total + D);
        let found: f64 = (rule.points.iter().zip(&rule.weights))
            .map(|(x, w)| w * (0..D).map(|d| x[d].powi(exponents[d] as i32)).product::<f64>())
            .sum();
        worst = worst.max((found / exact - 1.0).abs());
    }
    worst
}

#[test]
fn simplex_rules_are_exact_to_their_degree_and_no_further() {
    for (points, degree) in TET_RULES {
        let rule = tet(points).unwrap();
        assert_eq!(rule.len(), points);
        let good = simplex_error(&rule, degree);
        let bad = simplex_error(&rule, degree + 1);
        // Rounding of the tabulated digits: 1e-16 per parameter, times the degree.
        assert!(good < 3e-14, "tet {points}: error {good:e} at degree {degree}");
        assert!(bad > 1e-6, "tet {points}: degree {degree} is understated ({bad:e})");
    }
    for (points, degree) in TRI_RULES {
        let rule = tri(points).unwrap();
        assert_eq!(rule.len(), points);
        let good = simplex_error(&rule, degree);
        let bad = simplex_error(&rule, degree + 1);
        assert!(good < 3e-14, "tri {points}: error {good:e} at degree {degree}");
        assert!(bad > 1e-6, "tri {points}: degree {degree} is understated ({bad:e})");
    }
    assert!(tet(11).is_none() && tet(0).is_none() && tri(2).is_none());
}

#[test]
fn weights_are_positive_and_points_inside() {
    for (points, _) in TET_RULES {
        let rule = tet(points).unwrap();
        assert!(rule.weights.iter().all(|&w| w > 0.0), "tet {points}");
        assert!(rule.points.iter().all(|x| x.iter().all(|&v| v > 0.0) && x.iter().sum::<f64>() < 1.0));
    }
    for (points, _) in TRI_RULES {
        let rule = tri(points).unwrap();
        assert!(rule.weights.iter().all(|&w| w > 0.0), "tri {points}");
        assert!(rule.points.iter().all(|x| x.iter().all(|&v| v > 0.0) && x.iter().sum::<f64>() < 1.0));
    }
}

/// A function without symmetry: an asymmetric rule gives different values for different corner orders.
fn uneven(l: &[f64]) -> f64 {
    l.iter().enumerate().map(|(i, v)| ((i + 1) as f64 * v).powi(9)).sum::<f64>() + (3.0 * l[0] - l[1]).exp()
}

#[test]
fn simplex_rules_do_not_depend_on_the_order_of_corners() {
    for (points, _) in TET_RULES {
        let rule = tet(points).unwrap();
        let value = |order: [usize; 4]| -> f64 {
            (rule.points.iter().zip(&rule.weights))
                .map(|(x, w)| {
                    let l = [1.0 - x[0] - x[1] - x[2], x[0], x[1], x[2]];
                    w * uneven(&order.map(|i| l[i]))
                })
                .sum()
        };
        let first = value([0, 1, 2, 3]);
        for order in [[1, 0, 2, 3], [1, 2, 3, 0], [3, 2, 1, 0], [2, 0, 3, 1]] {
            assert!((value(order) / first - 1.0).abs() < 1e-13, "tet {points} {order:?}");
        }
    }
    for (points, _) in TRI_RULES {
        let rule = tri(points).unwrap();
        let value = |order: [usize; 3]| -> f64 {
            (rule.points.iter().zip(&rule.weights))
                .map(|(x, w)| {
                    let l = [1.0 - x[0] - x[1], x[0], x[1]];
                    w * uneven(&order.map(|i| l[i]))
                })
                .sum()
        };
        let first = value([0, 1, 2]);
        for order in [[1, 0, 2], [1, 2, 0], [2, 1, 0]] {
            assert!((value(order) / first - 1.0).abs() < 1e-13, "tri {points} {order:?}");
        }
    }
}

#[test]
fn gauss_legendre_is_exact_to_degree_2n_minus_1() {
    for n in 1..=20 {
        let (x, w) = gauss_legendre(n);
        let moment =
            |degree: usize| -> f64 { x.iter().zip(&w).map(|(x, w)| w * x.powi(degree as i32)).sum::<f64>() };
        for degree in 0..2 * n {
            let exact = if degree % 2 == 0 { 2.0 / (degree + 1) as f64 } else { 0.0 };
            assert!((moment(degree) - exact).abs() < 1e-14, "n = {n}, degree {degree}: {}", moment(degree));
        }
        // The first moment that is not exact, from the norm of P_n: 2^(2n+1) n!^4 / ((2n+1) (2n)!^2).
        let gap = 2f64.powi(2 * n as i32 + 1) * factorial(n).powi(4)
            / ((2 * n + 1) as f64 * factorial(2 * n).powi(2));
        let found = 2.0 / (2 * n + 1) as f64 - moment(2 * n);
        assert!((found - gap).abs() < 1e-14 + 1e-6 * gap, "n = {n}: {found:e}, {gap:e}");
        assert!(x.windows(2).all(|p| p[0] < p[1]));
    }
    assert!(gauss_legendre(0).0.is_empty());
}

#[test]
fn tensor_rules_integrate_products() {
    let rule = hex(3);
    let value: f64 = (rule.points.iter().zip(&rule.weights))
        .map(|(x, w)| w * x[0].powi(4) * x[1].powi(2) * (1.0 + x[2].powi(5)))
        .sum();
    assert!((value - 2.0 / 5.0 * 2.0 / 3.0 * 2.0).abs() < 1e-15);
    assert!((quad(4).weights.iter().sum::<f64>() - 4.0).abs() < 1e-14);
    assert_eq!((hex(3).len(), quad(4).len(), hex(0).is_empty()), (27, 16, true));
}
