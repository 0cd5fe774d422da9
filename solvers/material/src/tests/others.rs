//! Properties of the laws that have no moduli in common with the others: laws of directions and of foams.

use std::f64::consts::PI;

use proptest::prelude::*;
use shape::{Matrix3, Vector3};

use super::properties::{finite, gradient, rotation};
use super::*;
use crate::at_point::AtPoint;
use crate::material::Tangent;

/// Angle and dispersion of two families of fibres, and stretch at which fibres are straight.
const ANGLE: f64 = 0.7;
const DISPERSION: f64 = 0.15;
const STRAIGHT: f64 = 1.2;

/// Laws with moduli of their own, in every form of their volumetric energy; the axes do not matter to those
/// of foams.
fn others() -> Vec<Law> {
    let laws: Vec<Law> = vec![
        Guccione::new(2e3, [2.0, 0.5, 1.0], 50e3).unwrap().into(),
        BlatzKo::new(20e3, 0.25).unwrap().into(),
        BlatzKo::new(20e3, 0.0).unwrap().into(),
        Hyperfoam::new(&[[3e3, 2.5, 0.2], [2e3, -1.5, 0.0]]).unwrap().into(),
        Hyperfoam::new(&[[3e3, 6.8, 0.0]]).unwrap().with_volume(7e3).unwrap().into(),
        PorousNeoHookean::new(20e3, 0.1).unwrap().into(),
        HolzapfelOgden::new([2e3, 0.5], [8e3, 0.7], [3e3, 0.4], [1e3, 0.6], 50e3).unwrap().into(),
        HolzapfelGasserOgden::new(2e3, [6e3, 0.6], ANGLE, DISPERSION, 50e3).unwrap().into(),
        TransIsoMooneyRivlin::new([1e3, 4e2], [2e3, 3.0, 9e3], STRAIGHT, 50e3).unwrap().into(),
        TransIsoNeoHookean::new([3e3, 0.3], [2e3, 3.0, 9e3], STRAIGHT).unwrap().into(),
    ];
    let forms: Vec<Law> = laws.iter().flat_map(other_volumes).collect();
    laws.into_iter().chain(forms).collect()
}

/// Returns the distance of a state in the axes of the material from the nearest state in which the tangent of
/// a law jumps: fibres at rest length, or straight.
fn distance_to_jump(law: &Law, H: &Matrix3) -> f64 {
    let F = Matrix3::identity() + H;
    let square = |x: f64, y: f64| (F * Vector3::new(x, y, 0.0)).norm_squared();
    let stretches = match law.name() {
        "holzapfel-ogden" => vec![square(1.0, 0.0) - 1.0, square(0.0, 1.0) - 1.0],
        "holzapfel-gasser-ogden" => [ANGLE, -ANGLE]
            .map(|at| {
                let mean =
                    DISPERSION * F.norm_squared() + (1.0 - 3.0 * DISPERSION) * square(at.cos(), at.sin());
                mean - 1.0
            })
            .to_vec(),
        "trans-iso-mooney-rivlin" => {
            let l = square(1.0, 0.0).sqrt() / F.determinant().cbrt();
            vec![l - 1.0, l - STRAIGHT]
        }
        "trans-iso-neo-hookean" => {
            let l = square(1.0, 0.0).sqrt();
            vec![l - 1.0, l - STRAIGHT]
        }
        _ => vec![],
    };
    stretches.into_iter().fold(f64::INFINITY, |least, q| least.min(q.abs()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    // As for the isotropic laws: central differences with step 1e-5, relative to the stiffness at the state.
    #[test]
    fn stress_and_tangent_are_derivatives(H in finite(), axes in prop::array::uniform3(-2.0..2.0f64)) {
        let (Q, step) = (rotation(axes), 1e-5);
        for law in others() {
            if distance_to_jump(&law, &(Q.transpose() * H * Q)) < 1e-3 {
                continue;
            }
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
            // The axes may turn about the fibre, of which two families of fibres and sheets allow half a turn
            // only. They may take half a turn about every axis.
            let about = if law.has_sheets() { PI } else { about };
            for spin in [[about, 0.0, 0.0], [0.0, PI, 0.0], [0.0, 0.0, PI]] {
                let spin = rotation(spin);
                let at = AtPoint::new(&law, Some(&spin));
                prop_assert!((at.stress(&H) - law.stress(&H)).norm() < 1e-12 * scale);
            }
        }
    }

    #[test]
    fn small_strain_keeps_its_digits(h in prop::array::uniform9(-1.0..1.0f64)) {
        let H = Matrix3::from_row_slice(&h) * 1e-10;
        for law in others() {
            // At the state itself: fibres in compression have another tangent than those at rest.
            let tangent = law.tangent(&H);
            let P = Matrix3::from_column_slice((tangent * crate::split::flat(&H)).as_slice());
            prop_assert!((law.stress(&H) - P).norm() <= 1e-7 * P.norm());
            let W = 0.5 * P.dot(&H);
            prop_assert!((law.energy(&H) - W).abs() <= 1e-7 * W);
        }
    }
}

#[test]
fn a_body_at_rest_or_turned_has_no_stress() {
    let turned = gradient(rotation([0.3, -0.7, 1.1]));
    for law in others() {
        assert_eq!((law.energy(&Matrix3::zeros()), law.stress(&Matrix3::zeros())), (0.0, Matrix3::zeros()));
        let scale = stiffness(&law);
        assert!(law.stress(&turned).norm() < 1e-14 * scale && law.energy(&turned) < 1e-15 * scale);
    }
}

/// The modulus that scales time steps and penalties is half the largest stiffness among deviatoric strains at
/// rest.
#[test]
fn shear_modulus_of_fibres_is_the_largest_at_rest() {
    let fibres = [
        HolzapfelOgden::new([2e3, 0.5], [8e3, 0.7], [3e3, 0.4], [1e3, 0.6], 50e3).unwrap().into(),
        HolzapfelOgden::new([2e3, 0.5], [5e2, 0.7], [0.0, 1.0], [9e3, 0.6], 50e3).unwrap().into(),
        HolzapfelGasserOgden::new(2e3, [6e3, 0.6], ANGLE, DISPERSION, 50e3).unwrap().into(),
        HolzapfelGasserOgden::new(2e3, [6e3, 0.6], 0.1, 0.0, 50e3).unwrap().into(),
        TransIsoMooneyRivlin::new([1e3, 4e2], [2e3, 3.0, 9e3], STRAIGHT, 50e3).unwrap().into(),
        // A shear modulus of 1 kPa.
        TransIsoNeoHookean::new([450e3 / 151.0, 148.0 / 302.0], [2e3, 3.0, 9e3], STRAIGHT).unwrap().into(),
    ];
    for law in fibres {
        let law: Law = law;
        let unit = crate::split::flat(&Matrix3::identity()) / 3f64.sqrt();
        let deviatoric = Tangent::identity() - unit * unit.transpose();
        let of_shape = deviatoric * law.tangent(&Matrix3::zeros()) * deviatoric;
        let largest = 0.5 * of_shape.symmetric_eigenvalues().max();
        assert!((law.mu() - largest).abs() < 1e-12 * largest, "{}: {} {largest}", law.name(), law.mu());
        assert!((law.bulk() - 50e3).abs() < 1e-9, "{}", law.name());
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
