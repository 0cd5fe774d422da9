//! Properties of the laws that have no moduli in common with the others: laws of directions and of foams.

use proptest::prelude::*;
use shape::{Matrix3, Vector3};

use super::properties::{finite, gradient, rotation};
use super::*;
use crate::at_point::AtPoint;

/// Laws with moduli of their own; the axes do not matter to those of foams.
fn others() -> Vec<Law> {
    vec![
        Guccione::new(2e3, [2.0, 0.5, 1.0], 50e3).unwrap().into(),
        BlatzKo::new(20e3, 0.25).unwrap().into(),
        BlatzKo::new(20e3, 0.0).unwrap().into(),
        Hyperfoam::new(&[[3e3, 2.5, 0.2], [2e3, -1.5, 0.0]]).unwrap().into(),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    // As for the isotropic laws: central differences with step 1e-5, relative to the stiffness at the state.
    #[test]
    fn stress_and_tangent_are_derivatives(H in finite(), axes in prop::array::uniform3(-2.0..2.0f64)) {
        let (Q, step) = (rotation(axes), 1e-5);
        for law in others() {
            let law = AtPoint::new(&law, Some(&Q));
            let (P, tangent) = law.stress_and_tangent(&H);
            let scale = tangent.norm();
            prop_assert_eq!((P, tangent), (law.stress(&H), law.tangent(&H)));
            prop_assert!((tangent - tangent.transpose()).norm() < 1e-13 * scale);
            for n in 0..9 {
                let mut d = Matrix3::zeros();
                d[n] = step;
                let slope = (law.energy(&(H + d)) - law.energy(&(H - d))) / (2.0 * step);
                prop_assert!((slope - P[n]).abs() < 1e-7 * scale, "{n}: {slope} {}", P[n]);
                let slope = (law.stress(&(H + d)) - law.stress(&(H - d))) / (2.0 * step);
                for m in 0..9 {
                    prop_assert!((slope[m] - tangent[(m, n)]).abs() < 1e-7 * scale, "{m} {n}");
                }
            }
        }
    }

    #[test]
    fn turning_the_body_or_the_axes_with_it_changes_nothing(
        H in finite(),
        turn in prop::array::uniform3(-3.0..3.0f64),
        about in -3.0..3.0f64,
    ) {
        let R = rotation(turn);
        for law in others() {
            let scale = law.tangent(&H).norm();
            // Objectivity, and a body turned together with its axes.
            let turned = gradient(R * (Matrix3::identity() + H));
            prop_assert!((law.energy(&turned) - law.energy(&H)).abs() < 1e-12 * scale);
            prop_assert!((law.stress(&turned) - R * law.stress(&H)).norm() < 1e-12 * scale);
            let both = gradient((Matrix3::identity() + H) * R.transpose());
            let at = AtPoint::new(&law, Some(&R));
            prop_assert!((at.energy(&both) - law.energy(&H)).abs() < 1e-12 * scale);
            prop_assert!((at.stress(&both) - law.stress(&H) * R.transpose()).norm() < 1e-12 * scale);
            // The axes may turn about the fibre.
            let spin = rotation([about, 0.0, 0.0]);
            let at = AtPoint::new(&law, Some(&spin));
            prop_assert!((at.stress(&H) - law.stress(&H)).norm() < 1e-12 * scale);
        }
    }

    #[test]
    fn small_strain_keeps_its_digits(h in prop::array::uniform9(-1.0..1.0f64)) {
        let H = Matrix3::from_row_slice(&h) * 1e-10;
        for law in others() {
            let tangent = law.tangent(&Matrix3::zeros());
            let P = Matrix3::from_column_slice((tangent * crate::split::flat(&H)).as_slice());
            prop_assert!((law.stress(&H) - P).norm() <= 1e-7 * P.norm());
            let W = 0.5 * P.dot(&H);
            prop_assert!((law.energy(&H) - W).abs() <= 1e-7 * W);
        }
    }
}

#[test]
fn an_isotropic_law_ignores_its_axes() {
    let Q = rotation([0.3, -0.7, 1.1]);
    let H = gradient(Matrix3::from_diagonal(&Vector3::new(1.2, 0.9, 1.05)));
    let foam = BlatzKo::new(20e3, 0.25).unwrap().into();
    for law in laws(0.3).into_iter().chain([foam]) {
        assert_eq!(AtPoint::new(&law, Some(&Q)).stress(&H), law.stress(&H), "{}", law.name());
    }
}
