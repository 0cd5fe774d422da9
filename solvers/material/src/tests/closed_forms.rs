use shape::{Matrix3, Vector3};

use super::*;

const YOUNG: f64 = 20e3;

fn near(value: f64, exact: f64, law: &Law) {
    // Both sides are exact formulas, so only rounding differs.
    let error = (value - exact).abs() / stiffness(law);
    assert!(error < 1e-14, "{}: {value} for {exact}, {error:.2e}", law.name());
}

/// Returns `P` at `F = diag(a, b, c)`.
#[allow(non_snake_case)]
fn stretched(law: &Law, a: f64, b: f64, c: f64) -> Matrix3 {
    let P = law.stress(&Matrix3::from_diagonal(&Vector3::new(a - 1.0, b - 1.0, c - 1.0)));
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        assert_eq!((P[(i, j)], P[(j, i)]), (0.0, 0.0), "{}", law.name());
    }
    P
}

#[test]
fn equal_stretch_in_all_directions() {
    for poisson in [0.0, 0.3, 0.49] {
        for s in [0.6_f64, 0.95, 1.0 + 1e-9, 1.7] {
            for law in laws(poisson) {
                let (mu, lambda, bulk) = (law.mu(), law.lambda(), law.bulk());
                let exact = match law {
                    Law::LinearElastic(_) => 3.0 * bulk * (s - 1.0),
                    Law::SaintVenantKirchhoff(_) => 1.5 * bulk * s * (s * s - 1.0),
                    Law::NeoHookean(_) => mu * (s - 1.0 / s) + 3.0 * lambda * s.ln() / s,
                    Law::Hencky(_) => 3.0 * bulk * s.ln() / s,
                    Law::NeoHookeanIsochoric(_) | Law::MooneyRivlin(_) | Law::Ogden(_) => {
                        bulk * (s.powi(3) - 1.0) * s * s
                    }
                    Law::WithVolumetric(ref law) => match law.volume().form {
                        VolumetricForm::Quadratic => bulk * (s.powi(3) - 1.0) * s * s,
                        VolumetricForm::Logarithmic => 3.0 * bulk * s.ln() / s,
                        VolumetricForm::SimoTaylor => 0.5 * bulk * (s.powi(5) - 1.0 / s),
                    },
                    #[allow(unreachable_patterns)]
                    // Laws without a closed form here are covered by the properties.
                    _ => continue,
                };
                let P = stretched(&law, s, s, s);
                for i in 0..3 {
                    near(P[(i, i)], exact, &law);
                }
            }
        }
    }
}

#[test]
fn uniaxial_strain() {
    for poisson in [0.0, 0.3, 0.49] {
        for l in [0.4_f64, 0.95, 1.0 + 1e-9, 1.7] {
            for law in laws(poisson) {
                let (mu, lambda, bulk) = (law.mu(), law.lambda(), law.bulk());
                let volume = bulk * (l - 1.0);
                let exact = match law {
                    Law::LinearElastic(_) => (lambda + 2.0 * mu) * (l - 1.0),
                    Law::SaintVenantKirchhoff(_) => (lambda + 2.0 * mu) * l * (l * l - 1.0) / 2.0,
                    Law::NeoHookean(_) => mu * (l - 1.0 / l) + lambda * l.ln() / l,
                    Law::Hencky(_) => (lambda + 2.0 * mu) * l.ln() / l,
                    Law::MooneyRivlin(_) => {
                        // Slopes of l^(-2/3) (l^2 + 2) and l^(-4/3) (2 l^2 + 1).
                        let first = 4.0 / 3.0 * (l.cbrt() - l.powf(-5.0 / 3.0));
                        let second = 4.0 / 3.0 * (l.powf(-1.0 / 3.0) - l.powf(-7.0 / 3.0));
                        0.5 * mu * ((1.0 - SECOND) * first + SECOND * second) + volume
                    }
                    Law::Ogden(_) => {
                        let term = |(share, alpha): (f64, f64)| {
                            let power = l.powf(2.0 / 3.0 * alpha) - l.powf(-alpha / 3.0);
                            2.0 * share * mu / alpha * 2.0 / 3.0 * power / l
                        };
                        OGDEN.map(term).iter().sum::<f64>() + volume
                    }
                    Law::NeoHookeanIsochoric(_) => {
                        mu * l.powf(-2.0 / 3.0) * (l - (l * l + 2.0) / (3.0 * l)) + volume
                    }
                    #[allow(unreachable_patterns)] // as above
                    _ => continue,
                };
                near(stretched(&law, l, 1.0, 1.0)[(0, 0)], exact, &law);
            }
        }
    }
}

/// `F = I + gamma e_x (x) e_y`; `J = 1`, so the Cauchy stress is `P F^T`.
#[test]
fn simple_shear() {
    for poisson in [0.0, 0.3, 0.49] {
        for gamma in [1e-9, 0.2, 1.5_f64] {
            for law in laws(poisson) {
                let (mu, lambda) = (law.mu(), law.lambda());
                let mut H = Matrix3::zeros();
                H[(0, 1)] = gamma;
                let P = law.stress(&H);
                let cauchy = P * (Matrix3::identity() + H).transpose();
                let square = gamma * gamma;
                // Shear stress and first normal stress difference.
                let (shear, normal) = match law {
                    Law::LinearElastic(_) => {
                        near(P[(0, 1)], mu * gamma, &law);
                        continue;
                    }
                    Law::SaintVenantKirchhoff(_) => {
                        let shear = mu * gamma + (0.5 * lambda + mu) * gamma * square;
                        near(P[(0, 1)], shear, &law);
                        let s22 = (0.5 * lambda + mu) * square;
                        near(P[(1, 1)], s22, &law);
                        near(P[(2, 2)], 0.5 * lambda * square, &law);
                        // sigma_11 - sigma_22 = S_11 + 2 gamma S_12 + gamma^2 S_22 - S_22.
                        let normal = 0.5 * lambda * square + 2.0 * mu * square + square * s22 - s22;
                        (shear, normal)
                    }
                    Law::NeoHookean(_) | Law::NeoHookeanIsochoric(_) | Law::MooneyRivlin(_) => {
                        // sigma_22 - sigma_33 distinguishes the terms: 2 C01 (1 - (1 + gamma^2)).
                        let second = if matches!(law, Law::MooneyRivlin(_)) { SECOND } else { 0.0 };
                        near(cauchy[(1, 1)] - cauchy[(2, 2)], -second * mu * square, &law);
                        (mu * gamma, mu * square)
                    }
                    // Principal stretches l and 1/l, ln l = asinh(gamma / 2); the axis of l is at half the
                    // angle with tangent 2 / gamma.
                    Law::Hencky(_) | Law::Ogden(_) => {
                        let e = (0.5 * gamma).asinh();
                        let half = match law {
                            Law::Hencky(_) => 2.0 * mu * e,
                            _ => {
                                OGDEN.map(|(s, alpha)| 2.0 * s * mu / alpha * (alpha * e).sinh()).iter().sum()
                            }
                        };
                        let length = (4.0 + square).sqrt();
                        (half * 2.0 / length, 2.0 * half * gamma / length)
                    }
                    #[allow(unreachable_patterns)] // as above
                    _ => continue,
                };
                near(cauchy[(0, 1)], shear, &law);
                near(cauchy[(0, 0)] - cauchy[(1, 1)], normal, &law);
            }
        }
    }
}

/// The nominal stress of a bar with `nu = 0` has its largest compression, `E / (3 sqrt 3)`, at
/// `l = 1 / sqrt 3`.
#[test]
fn saint_venant_kirchhoff_softens_in_compression() {
    let law = Law::SaintVenantKirchhoff(SaintVenantKirchhoff::new(YOUNG, 0.0).unwrap());
    let bound = YOUNG / (3.0 * 3.0_f64.sqrt());
    for n in 1..1000 {
        let push = -stretched(&law, f64::from(n) / 1000.0, 1.0, 1.0)[(0, 0)];
        assert!(push <= bound * (1.0 + 1e-15), "{n}: {push} Pa above {bound} Pa");
    }
    near(stretched(&law, 1.0 / 3.0_f64.sqrt(), 1.0, 1.0)[(0, 0)], -bound, &law);
    assert!(bound < 0.193 * YOUNG);
}

#[test]
fn constants_of_abaqus_are_those_of_the_moduli() {
    let law = NeoHookeanIsochoric::new(30e3, 0.25).unwrap();
    // mu = 12 kPa, kappa = 20 kPa.
    assert!((law.c10() - 6e3).abs() < 1e-9);
    assert!((law.d1() - 1e-4).abs() < 1e-18);
}

/// A bar with free sides has `tau = E ln l` along its axis and zero stress across, for side stretches of
/// `l^(-nu)`.
#[test]
fn hencky_bar_under_uniaxial_stress() {
    for poisson in [0.0, 0.3, 0.49] {
        let law = Law::Hencky(Hencky::new(YOUNG, poisson).unwrap());
        for l in [0.4_f64, 0.9, 1.8] {
            let side = l.powf(-poisson);
            let P = stretched(&law, l, side, side);
            near(P[(0, 0)], YOUNG * l.ln() / l, &law);
            near(P[(1, 1)], 0.0, &law);
        }
    }
}
