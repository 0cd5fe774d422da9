//! Stress in lanes against the scalar laws.

use lanes::LANES;
use proptest::prelude::*;
use shape::{Matrix3, Vector3};

use super::properties::{POISSON, finite, gradient, rotation};
use super::*;
use crate::lane::LaneStrain;

/// Returns the largest difference over eight points, with and without fused products.
fn difference(law: &Law, at: &[Matrix3; LANES]) -> f64 {
    let mut worst = 0.0_f64;
    for fused in [false, true] {
        let mut strain = LaneStrain::ZERO;
        let mut p = [[f64::NAN; LANES]; 9];
        for (l, H) in at.iter().enumerate() {
            let h = std::array::from_fn(|k| H[(k / 3, k % 3)]);
            if fused { strain.set::<true>(l, &h) } else { strain.set::<false>(l, &h) }
        }
        if fused {
            law.stress_lanes::<true>(&strain, &mut p)
        } else {
            law.stress_lanes::<false>(&strain, &mut p)
        }
        for (l, H) in at.iter().enumerate() {
            let found = Matrix3::from_fn(|i, j| p[3 * i + j][l]);
            let error = (found - law.stress(H)).norm();
            assert!(error.is_finite(), "{}: {found}", law.name());
            worst = worst.max(error);
        }
    }
    worst
}

fn eight(first: &Matrix3) -> [Matrix3; LANES] {
    std::array::from_fn(|l| first * (1.0 - 0.1 * l as f64))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn lanes_are_the_scalar_law(H in finite(), poisson in POISSON) {
        for law in laws(poisson) {
            let size = eight(&H).iter().map(|H| law.stress(H).norm()).fold(stiffness(&law), f64::max);
            let error = difference(&law, &[H; LANES]) / size;
            prop_assert!(error < 1e-14, "{}: {error:.2e}", law.name());
        }
    }

    // The error is relative to any strain of this size: 1e-13 of the strain, and as much of the rotation,
    // whose rounding appears as strain.
    #[test]
    fn lanes_keep_the_digits_of_small_strain(
        h in prop::array::uniform9(-1.0..1.0f64),
        exponent in -12..-1,
        poisson in POISSON,
    ) {
        let H = Matrix3::from_row_slice(&h) * 10f64.powi(exponent);
        for law in laws(poisson) {
            let error = difference(&law, &eight(&H)) / (stiffness(&law) * H.norm());
            prop_assert!(error < 1e-14, "{}: {error:.2e}", law.name());
        }
    }

    // Equal stretches and rotated stretches, over all lengths of the logarithm's series and beyond.
    #[test]
    fn lanes_know_no_special_stretches(
        stretch in 0.5..1.9f64,
        gap in prop::sample::select(vec![0.0, 1e-15, 1e-12, 1e-8, 1e-4, 1e-2]),
        turn in prop::array::uniform3(-2.0..2.0f64),
        poisson in POISSON,
    ) {
        let Q = rotation(turn);
        let other = stretch.powf(-0.5);
        let U = Matrix3::from_diagonal(&Vector3::new(stretch, other, other * (1.0 + gap)));
        let H = gradient(Q * U * Q.transpose());
        for law in laws(poisson) {
            let size = stiffness(&law).max(law.stress(&H).norm());
            let error = difference(&law, &[H; LANES]) / size;
            prop_assert!(error < 1e-14, "{}: {error:.2e}", law.name());
        }
    }

    // The sum of the parts is the whole energy, and the first part does not depend on J.
    #[test]
    fn laws_that_split_do_so(H in finite(), poisson in POISSON, swell in 0.7..1.4f64) {
        for law in laws(poisson) {
            let Some((shape, volume)) = law.split() else { continue };
            let at = |H: &Matrix3| {
                (shape.energy(H), volume.derivatives(volume_change(H))[0])
            };
            let (of_shape, of_volume) = at(&H);
            let error = (of_shape + of_volume - law.energy(&H)).abs() / stiffness(&law);
            prop_assert!(error < 1e-14, "{}: {error:.2e}", law.name());
            let swollen = gradient((Matrix3::identity() + H) * swell);
            let error = (at(&swollen).0 - of_shape).abs() / stiffness(&law);
            prop_assert!(error < 1e-13, "{}: {error:.2e}", law.name());
        }
    }
}
