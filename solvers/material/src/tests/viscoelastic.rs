use proptest::prelude::*;
use shape::Matrix3;

use super::properties::{POISSON, finite, gradient, nonlinear, rotation};
use super::*;

fn prony() -> Prony {
    Prony::new(&[(0.3, 0.05), (0.25, 1.0)]).unwrap()
}

/// Returns `S_dev` and the history of points that were loaded from rest to `H` in 0.2 s.
fn loaded(law: &Law, H: &Matrix3) -> (Matrix3, Vec<Matrix3>) {
    let mut history = vec![Matrix3::zeros(); 2];
    let S = deviator(&law.stress(H), H);
    prony().step(0.2).unwrap().advance(&Matrix3::zeros(), &S, &mut history);
    (S, history)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn deviator_is_the_pull_back_of_kirchhoffs(H in finite(), poisson in POISSON) {
        let F = Matrix3::identity() + H;
        for law in nonlinear(poisson) {
            let P = law.stress(&H);
            let tau = P * F.transpose();
            let pushed = F * deviator(&P, &H) * F.transpose();
            let error = (pushed - (tau - Matrix3::identity() * (tau.trace() / 3.0))).norm() / stiffness(&law);
            prop_assert!(error < 1e-13, "{}: {error:.2e}", law.name());
        }
    }

    #[test]
    fn relaxed_tangent_is_the_gradient_of_the_relaxed_stress(
        (before, H) in (finite(), finite()), poisson in POISSON, dt in 0.001..10.0f64,
    ) {
        let step = prony().step(dt).unwrap();
        for law in nonlinear(poisson) {
            let (old, history) = loaded(&law, &before);
            let carried = step.carried(&old, &history);
            let relaxed = |H: &Matrix3| relaxed_stress_and_tangent(&law, H, &step, &carried);
            let (P, tangent) = relaxed(&H);

            // P itself from its parts.
            let elastic = law.stress(&H);
            let F = Matrix3::identity() + H;
            let S = deviator(&elastic, &H);
            let parts = elastic - F * S + F * step.stress(&old, &S, &history);
            let error = (P - parts).norm() / stiffness(&law);
            prop_assert!(error < 1e-12, "{}: {error:.2e}", law.name());

            for n in 0..9 {
                let mut d = Matrix3::zeros();
                d[n] = 1e-5;
                let slope = (relaxed(&(H + d)).0 - relaxed(&(H - d)).0) / 2e-5;
                let error = (slope - Matrix3::from_column_slice(tangent.column(n).as_slice())).norm();
                // Truncation error, as for the elastic tangents.
                prop_assert!(error < 1e-7 * stiffness(&law), "{}: {n}: {error:.2e}", law.name());
            }

            let coupled = matches!(
                law,
                Law::SaintVenantKirchhoff(_)
                    | Law::NeoHookean(_)
                    | Law::BlatzKo(_)
                    | Law::Hyperfoam(_)
                    | Law::Corotational(_)
                    | Law::StableNeoHookean(_)
            );
            let skew = (tangent - tangent.transpose()).norm() / tangent.norm();
            prop_assert!(coupled || skew < 1e-13, "{}: {skew:.2e}", law.name());
        }
    }

    #[test]
    fn relaxed_stress_is_objective(
        (before, H) in (finite(), finite()), turn in prop::array::uniform3(-3.0..3.0f64), poisson in POISSON,
    ) {
        let step = prony().step(0.3).unwrap();
        let Q = rotation(turn);
        let turned = gradient(Q * (Matrix3::identity() + H));
        for law in nonlinear(poisson) {
            let (old, history) = loaded(&law, &before);
            let carried = step.carried(&old, &history);
            let P = relaxed_stress_and_tangent(&law, &H, &step, &carried).0;
            let turned_P = relaxed_stress_and_tangent(&law, &turned, &step, &carried).0;
            let error = (turned_P - Q * P).norm() / stiffness(&law);
            prop_assert!(error < 1e-12, "{}: {error:.2e}", law.name());
        }
    }

    /// A sudden load has an elastic response; after an infinite step the shear modulus is `g_inf mu`.
    #[test]
    fn ends_of_the_time_scale(H in finite(), poisson in POISSON) {
        let at_rest = [Matrix3::zeros(); 2];
        for law in nonlinear(poisson) {
            let at = |dt: f64| {
                let step = prony().step(dt).unwrap();
                let carried = step.carried(&Matrix3::zeros(), &at_rest);
                relaxed_stress_and_tangent(&law, &H, &step, &carried)
            };
            let (P, tangent) = law.stress_and_tangent(&H);
            prop_assert!((at(0.0).0 - P).norm() < 1e-14 * stiffness(&law));
            prop_assert!((at(0.0).1 - tangent).norm() < 1e-13 * stiffness(&law));
            if matches!(law, Law::NeoHookeanIsochoric(_)) {
                // C10 times g_inf, with the same bulk modulus.
                let mu = law.mu() * prony().relaxed();
                let bulk = law.bulk();
                let soft = MooneyRivlin::new(0.5 * mu, 0.0, bulk).unwrap();
                prop_assert!((at(f64::INFINITY).0 - soft.stress(&H)).norm() < 1e-12 * stiffness(&law));
            }
        }
    }
}
