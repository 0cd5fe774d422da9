//! Eigenvalues and principal axes of a symmetric 3 x 3 tensor.

use shape::Matrix3;

/// Returns the eigenvalues and orthonormal eigenvectors (columns) of a symmetric `A`, unordered, by cyclic
/// Jacobi rotations.
///
/// Errors are of the order of the rounding of `|A|`, also for equal eigenvalues: a tensor of 1e-10 is
/// resolved to 1e-26. NaN in the input gives NaN in the result. Source: Golub and Van Loan, Matrix
/// Computations, 4th ed., section 8.5.
pub(super) fn eigen(A: &Matrix3) -> ([f64; 3], Matrix3) {
    let mut a = *A;
    let mut axes = Matrix3::identity();
    let negligible = 0.125 * f64::EPSILON * a.norm();
    for _ in 0..16 {
        let mut rotated = false;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if !(a[(p, q)].abs() > negligible) {
                continue;
            }
            rotated = true;
            let r = 3 - p - q;
            let half = (a[(q, q)] - a[(p, p)]) / (2.0 * a[(p, q)]);
            let t = half.signum() / (half.abs() + (half * half + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            let shift = t * a[(p, q)];
            a[(p, p)] -= shift;
            a[(q, q)] += shift;
            a[(p, q)] = 0.0;
            // Only the upper triangle is updated.
            let (rp, rq) = (upper(r, p), upper(r, q));
            (a[rp], a[rq]) = (c * a[rp] - s * a[rq], s * a[rp] + c * a[rq]);
            for i in 0..3 {
                let (x, y) = (axes[(i, p)], axes[(i, q)]);
                axes[(i, p)] = c * x - s * y;
                axes[(i, q)] = s * x + c * y;
            }
        }
        if !rotated {
            break;
        }
    }
    ([a[(0, 0)], a[(1, 1)], a[(2, 2)]], axes)
}

fn upper(i: usize, j: usize) -> (usize, usize) {
    (i.min(j), i.max(j))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;
    use proptest::prelude::*;
    use shape::Vector3;

    proptest! {
        #[test]
        fn eigenvalues_and_axes_return_the_tensor(
            values in prop::array::uniform3(-1.0..1.0f64),
            turn in prop::array::uniform3(-3.0..3.0f64),
            (gap, exponent) in (prop::sample::select(vec![0.0, 1e-12, 1e-8, 1e-4, 1.0]), -12..1),
        ) {
            let scale = 10.0_f64.powi(exponent);
            let [a, b, c] = values;
            let mut values = [a * scale, (a + gap * b) * scale, (a + gap * c) * scale];
            let Q = Rotation3::new(Vector3::from(turn)).into_inner();
            let full = Q * Matrix3::from_diagonal(&values.into()) * Q.transpose();
            let A = (full + full.transpose()) * 0.5;
            let (mut found, axes) = eigen(&A);
            let back = axes * Matrix3::from_diagonal(&found.into()) * axes.transpose();
            // Rounding of a dozen rotations.
            prop_assert!((back - A).norm() <= 4e-15 * A.norm());
            prop_assert!((axes.transpose() * axes - Matrix3::identity()).norm() < 4e-15);
            values.sort_by(f64::total_cmp);
            found.sort_by(f64::total_cmp);
            for a in 0..3 {
                prop_assert!((values[a] - found[a]).abs() <= 4e-15 * A.norm());
            }
        }
    }

    #[test]
    fn zero_diagonal_and_not_a_number_come_to_an_end() {
        assert_eq!(eigen(&Matrix3::identity()), ([1.0; 3], Matrix3::identity()));
        assert!(eigen(&Matrix3::repeat(f64::NAN)).0.iter().all(|e| e.is_nan()));
        assert_eq!(eigen(&Matrix3::zeros()).0, [0.0; 3]);
    }
}
