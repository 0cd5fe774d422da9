use nalgebra::Rotation3;
use proptest::prelude::*;
use shape::{Matrix3, Vector3};

use super::*;

fn matrix(h: [f64; 9]) -> Matrix3 {
    Matrix3::from_row_slice(&h)
}

pub(super) fn rotation(r: [f64; 3]) -> Matrix3 {
    Rotation3::new(Vector3::from(r)).into_inner()
}

/// Returns the displacement gradient of `F`.
#[allow(non_snake_case)]
pub(super) fn gradient(F: Matrix3) -> Matrix3 {
    F - Matrix3::identity()
}

pub(super) fn nonlinear(poisson: f64) -> impl Iterator<Item = Law> {
    laws(poisson).into_iter().filter(|law| !law.is_small_strain())
}

/// Gradients with singular values of `F` between about 0.55 and 1.6: away from `J = 0` and far from small
/// strain.
#[allow(non_snake_case)]
pub(super) fn finite() -> impl Strategy<Value = Matrix3> {
    (
        prop::array::uniform3(-0.6..0.5f64),
        prop::array::uniform3(-2.0..2.0f64),
        prop::array::uniform3(-2.0..2.0f64),
    )
        .prop_map(|(log_stretch, turn, axes)| {
            let U = Matrix3::from_diagonal(&Vector3::from(log_stretch).map(f64::exp));
            let N = rotation(axes);
            gradient(rotation(turn) * N * U * N.transpose())
        })
}

pub(super) const POISSON: std::ops::Range<f64> = -0.4..0.49;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    // Central differences with step d have the truncation error d^2 W'''/6 and the rounding error 1e-16 W/d.
    // For d = 1e-5 both are about 1e-10 of lambda + 2 mu times the largest higher derivative, about 100 at a
    // stretch of 0.55.
    #[test]
    fn stress_is_the_gradient_of_energy(H in finite(), poisson in POISSON) {
        let step = 1e-5;
        for law in laws(poisson) {
            let P = law.stress(&H);
            for n in 0..9 {
                let mut d = Matrix3::zeros();
                d[n] = step;
                let slope = (law.energy(&(H + d)) - law.energy(&(H - d))) / (2.0 * step);
                let error = (slope - P[n]).abs() / stiffness(&law);
                prop_assert!(error < 1e-8, "{}: {n}: {error:.2e}", law.name());
            }
        }
    }

    #[test]
    fn tangent_is_the_gradient_of_stress(H in finite(), poisson in POISSON) {
        let step = 1e-5;
        for law in laws(poisson) {
            let tangent = law.tangent(&H);
            for n in 0..9 {
                let mut d = Matrix3::zeros();
                d[n] = step;
                let slope = (law.stress(&(H + d)) - law.stress(&(H - d))) / (2.0 * step);
                for m in 0..9 {
                    let error = (slope[m] - tangent[(m, n)]).abs() / stiffness(&law);
                    prop_assert!(error < 1e-7, "{}: {m}, {n}: {error:.2e}", law.name());
                }
            }
        }
    }

    #[test]
    fn tangent_is_symmetric_and_the_same_with_and_without_the_stress(H in finite(), poisson in POISSON) {
        for law in laws(poisson) {
            let (P, tangent) = law.stress_and_tangent(&H);
            prop_assert_eq!(P, law.stress(&H));
            prop_assert_eq!(tangent, law.tangent(&H));
            let skew = (tangent - tangent.transpose()).norm();
            prop_assert!(skew < 1e-14 * tangent.norm(), "{}: {skew:.2e}", law.name());
        }
    }

    #[test]
    fn nonlinear_laws_are_objective(H in finite(), turn in prop::array::uniform3(-3.0..3.0f64), poisson in POISSON) {
        let Q = rotation(turn);
        let turned = gradient(Q * (Matrix3::identity() + H));
        for law in nonlinear(poisson) {
            let error = (law.energy(&turned) - law.energy(&H)).abs() / stiffness(&law);
            prop_assert!(error < 1e-13, "{}: energy {error:.2e}", law.name());
            let error = (law.stress(&turned) - Q * law.stress(&H)).norm() / stiffness(&law);
            prop_assert!(error < 1e-12, "{}: stress {error:.2e}", law.name());
        }
    }

    #[test]
    fn laws_are_isotropic(H in finite(), turn in prop::array::uniform3(-3.0..3.0f64), poisson in POISSON) {
        let Q = rotation(turn);
        let turned = gradient((Matrix3::identity() + H) * Q);
        for law in nonlinear(poisson) {
            let error = (law.energy(&turned) - law.energy(&H)).abs() / stiffness(&law);
            prop_assert!(error < 1e-13, "{}: energy {error:.2e}", law.name());
            let error = (law.stress(&turned) - law.stress(&H) * Q).norm() / stiffness(&law);
            prop_assert!(error < 1e-12, "{}: stress {error:.2e}", law.name());
        }
    }

    #[test]
    fn a_rotation_is_free_of_stress(turn in prop::array::uniform3(-3.0..3.0f64), poisson in POISSON) {
        let H = gradient(rotation(turn));
        for law in nonlinear(poisson) {
            let P = law.stress(&H).norm() / stiffness(&law);
            prop_assert!(P < 1e-14, "{}: {P:.2e}", law.name());
            let W = law.energy(&H).abs() / stiffness(&law);
            prop_assert!(W < 1e-15, "{}: {W:.2e}", law.name());
        }
    }

    #[test]
    fn kirchhoff_stress_is_symmetric(H in finite(), poisson in POISSON) {
        for law in nonlinear(poisson) {
            let tau = law.stress(&H) * (Matrix3::identity() + H).transpose();
            let skew = (tau - tau.transpose()).norm() / stiffness(&law);
            prop_assert!(skew < 1e-13, "{}: {skew:.2e}", law.name());
        }
    }

    // The remainder at |H| = 1e-10 is of second order, 1e-10 times at most about 100 (lambda / mu at nu =
    // 0.49). If formed from F, the stress would have an error of 1e-16 / 1e-10 times this factor: 1e-4.
    #[test]
    fn small_strain_keeps_its_digits(h in prop::array::uniform9(-1.0..1.0f64), poisson in POISSON) {
        let H = matrix(h) * 1e-10;
        let hooke = LinearElastic::new(20e3, poisson).unwrap();
        for law in nonlinear(poisson) {
            let P = LinearElastic::stress(&hooke, &H);
            let error = (law.stress(&H) - P).norm();
            prop_assert!(error <= 1e-7 * P.norm(), "{}: stress {error:.2e} of {:.2e}", law.name(), P.norm());
            let W = hooke.energy_density(&H);
            let error = (law.energy(&H) - W).abs();
            prop_assert!(error <= 1e-7 * W, "{}: energy {error:.2e} of {W:.2e}", law.name());
        }
    }
}

#[test]
fn laws_have_hookes_tangent_and_no_stress_at_rest() {
    for poisson in [-0.4, 0.0, 0.3, 0.49] {
        let hooke = Material::tangent(&LinearElastic::new(20e3, poisson).unwrap(), &Matrix3::zeros());
        for law in laws(poisson) {
            assert_eq!(law.stress(&Matrix3::zeros()), Matrix3::zeros(), "{}", law.name());
            assert_eq!(law.energy(&Matrix3::zeros()), 0.0, "{}", law.name());
            let error = (law.tangent(&Matrix3::zeros()) - hooke).norm() / hooke.norm();
            assert!(error < 1e-14, "{}, nu = {poisson}: {error:.2e}", law.name());
            let bulk = 20e3 / (3.0 * (1.0 - 2.0 * poisson));
            assert!((law.bulk() - bulk).abs() < 1e-13 * bulk, "{}", law.name());
        }
    }
}

#[test]
fn the_linear_law_is_not_objective() {
    // For a rotation by 90 degrees about z, eps = diag(-1, -1, 0), so P = -2 mu eps - 2 lambda I.
    let law = LinearElastic::new(20e3, 0.25).unwrap();
    let H = gradient(rotation([0.0, 0.0, std::f64::consts::FRAC_PI_2]));
    let P = LinearElastic::stress(&law, &H);
    let expected = -2.0 * (law.lambda() + law.mu());
    assert!((P[(0, 0)] - expected).abs() < 1e-12 * expected.abs(), "{P}");
}

#[test]
fn beyond_inversion_the_laws_with_a_logarithm_are_not_finite() {
    let H = Matrix3::from_diagonal(&Vector3::new(-2.5, 0.1, 0.2));
    for law in nonlinear(0.3) {
        let finite = law.energy(&H).is_finite() || law.stress(&H).iter().any(|p| p.is_finite());
        let polynomial = ["saint-venant-kirchhoff", "stable-neo-hookean"].contains(&law.name());
        assert_eq!(finite, polynomial, "{}", law.name());
    }
}

/// Checks that two laws written in different invariants are the same function.
fn same(a: &dyn Material, b: &dyn Material, H: &Matrix3) -> Result<(), TestCaseError> {
    let scale = a.lambda().abs() + 2.0 * a.mu();
    prop_assert!((a.energy(H) - b.energy(H)).abs() < 1e-13 * scale);
    prop_assert!((a.stress(H) - b.stress(H)).norm() < 1e-12 * scale);
    prop_assert!((a.tangent(H) - b.tangent(H)).norm() < 1e-11 * scale);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn ogden_holds_the_laws_of_exponent_two(H in finite(), poisson in POISSON) {
        let hooke = LinearElastic::new(20e3, poisson).unwrap();
        let (mu, bulk) = (hooke.mu(), hooke.bulk());
        let neo = NeoHookeanIsochoric::new(20e3, poisson).unwrap();
        same(&neo, &Ogden::new(&[(mu, 2.0)], bulk).unwrap(), &H)?;
        same(&neo, &MooneyRivlin::from_young(20e3, poisson, 0.0).unwrap(), &H)?;
        let mooney = MooneyRivlin::from_young(20e3, poisson, 0.4).unwrap();
        same(&mooney, &Ogden::new(&[(0.6 * mu, 2.0), (-0.4 * mu, -2.0)], bulk).unwrap(), &H)?;
    }

    // For stretches that differ by d, the tangent equals that for equal stretches up to O(d), and the stress
    // follows it up to O(d^2). A division by the difference would leave an error of 1e-16 / d.
    #[test]
    fn equal_stretches_are_no_special_case(
        (stretch, other) in (0.6..1.7f64, 0.6..1.7f64),
        turn in prop::array::uniform3(-2.0..2.0f64),
        poisson in POISSON,
        all in prop::bool::ANY,
    ) {
        let Q = rotation(turn);
        let at = |d: f64| {
            let third = if all { stretch * (1.0 - 0.6 * d) } else { other };
            let stretches = Vector3::new(stretch, stretch * (1.0 + d), third);
            gradient(Q * Matrix3::from_diagonal(&stretches) * Q.transpose())
        };
        for law in nonlinear(poisson) {
            let (P, tangent) = law.stress_and_tangent(&at(0.0));
            for d in [1e-4, 1e-8, 1e-12, 1e-15] {
                let (near_P, near_tangent) = law.stress_and_tangent(&at(d));
                let error = (near_tangent - tangent).norm() / tangent.norm();
                prop_assert!(error < 20.0 * d + 1e-13, "{}, {d:e}: tangent {error:.2e}", law.name());
                let step = at(d) - at(0.0);
                let step = nalgebra::SVector::<f64, 9>::from_column_slice(step.as_slice());
                let foreseen = P + Matrix3::from_column_slice((tangent * step).as_slice());
                let error = (near_P - foreseen).norm() / tangent.norm();
                prop_assert!(error < 20.0 * d * d + 1e-14, "{}, {d:e}: stress {error:.2e}", law.name());
            }
            // For exactly equal stretches, the tangent is still the gradient of the stress.
            let H = at(0.0);
            for n in 0..9 {
                let mut d = Matrix3::zeros();
                d[n] = 1e-5;
                let slope = (law.stress(&(H + d)) - law.stress(&(H - d))) / 2e-5;
                let error = (slope - Matrix3::from_column_slice(tangent.column(n).as_slice())).norm();
                prop_assert!(error < 1e-8 * tangent.norm(), "{}: {n}: {error:.2e}", law.name());
            }
        }
    }
}

#[test]
fn names_are_those_of_the_entries() {
    for law in laws(0.3) {
        assert_eq!(LAWS.iter().filter(|entry| entry.name == law.name()).count(), 1, "{}", law.name());
    }
    for entry in LAWS {
        assert_eq!(LAWS.iter().filter(|other| other.name == entry.name).count(), 1, "{}", entry.name);
    }
}
