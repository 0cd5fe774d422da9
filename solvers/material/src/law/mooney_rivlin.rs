//! Mooney-Rivlin law, split into shape and volume.

use catalogue::{Build, Dimension, Entry, Parameter, Problem, Range, Values};
use lanes::{LANES, madd};
use shape::Matrix3;

use super::linear::LinearElastic;
use super::moduli::{BULK, POISSON, YOUNG};
use crate::error::MaterialError;
use crate::kinematics::{Kinematics, add_left, add_right, cofactor, green_lagrange, tangent_of};
use crate::lane::invariants::piola;
use crate::lane::math::inverse_cbrt_less_1;
use crate::lane::{LaneStrain, Lanes};
use crate::material::{Material, Tangent};
use crate::separated::Separated;
use crate::volumetric::Volumetric;

/// Mooney-Rivlin law `W = C10 (J^(-2/3) I1 - 3) + C01 (J^(-4/3) I2 - 3) + (J - 1)^2 / D1` with
/// `2 (C10 + C01) = mu` and `D1 = 2 / kappa`; constants in Pa.
///
/// `I2 = ((tr C)^2 - tr C^2) / 2 = |cof F|^2`. For `C01 = 0` the law is the isochoric neo-Hookean law.
/// Source: Mooney (1940), Rivlin (1948); form as in the Abaqus Theory Guide, Hyperelastic material behavior.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MooneyRivlin {
    c10: f64,
    c01: f64,
    bulk: f64,
}

const SHARE: Parameter =
    Parameter::optional("share", Dimension::None, "fraction of the second constant, c01 / (c10 + c01)")
        .within(Range::Within(0.0, 1.0));

pub(super) const ENTRY: Entry<Build<MooneyRivlin>> = Entry {
    name: "mooney-rivlin",
    meaning: "C10 (J^(-2/3) I1 - 3) + C01 (J^(-4/3) I2 - 3) + (J - 1)^2 / D1: takes c10, c01 and bulk, or young, poisson and share",
    source: "Mooney (1940), Rivlin (1948); Abaqus Theory Guide, Hyperelastic material behavior",
    parameters: &[
        Parameter::optional("c10", Dimension::Pressure, "constant of the first invariant"),
        Parameter::optional("c01", Dimension::Pressure, "constant of the second invariant"),
        BULK.may_be_absent(),
        YOUNG.may_be_absent(),
        POISSON.may_be_absent(),
        SHARE,
    ],
    build,
};

fn build(values: &Values) -> Result<MooneyRivlin, Problem> {
    let [c10, c01, bulk] = ["c10", "c01", "bulk"].map(|name| values.get(name));
    let law = match ((c10, c01, bulk), ["young", "poisson", "share"].map(|name| values.get(name))) {
        ((Some(c10), Some(c01), Some(bulk)), [None, None, None]) => MooneyRivlin::new(c10, c01, bulk),
        ((None, None, None), [Some(young), Some(poisson), Some(share)]) => {
            MooneyRivlin::from_young(young, poisson, share)
        }
        _ => {
            let help = "give either c10, c01 and bulk, or young, poisson and share";
            return Err(Problem::new("does not have the constants of this law").help(help));
        }
    };
    law.map_err(|bad| match bad {
        MaterialError::Shear { .. } => Problem::new("does not give a positive shear modulus")
            .help("c10 + c01, which is half the shear modulus, must be positive")
            .of("c10"),
        bad => bad.into(),
    })
}

/// `J` and the two shape moduli `2 C10 J^(-2/3)`, `2 C01 J^(-4/3)`. They are computed by the logarithm and
/// are NaN for `J < 0`.
struct Moduli {
    J: f64,
    first: f64,
    second: f64,
}

impl MooneyRivlin {
    /// Builds the law from the constants (Pa; `C10 + C01` positive, either may be negative) and the bulk
    /// modulus (Pa, positive).
    pub fn new(c10: f64, c01: f64, bulk: f64) -> Result<MooneyRivlin, MaterialError> {
        let mu = 2.0 * (c10 + c01);
        if !(mu > 0.0 && mu.is_finite()) {
            return Err(MaterialError::Shear { mu });
        }
        if !(bulk > 0.0 && bulk.is_finite()) {
            return Err(MaterialError::Bulk { bulk });
        }
        Ok(MooneyRivlin { c10, c01, bulk })
    }

    /// Builds the law from Young's modulus (Pa), Poisson's ratio and the share `C01 / (C10 + C01)` of the
    /// second term, 0 to 1.
    pub fn from_young(young: f64, poisson: f64, share: f64) -> Result<MooneyRivlin, MaterialError> {
        let hooke = LinearElastic::new(young, poisson)?;
        if !(0.0..=1.0).contains(&share) {
            return Err(MaterialError::Share { share });
        }
        let half = 0.5 * hooke.mu();
        Ok(MooneyRivlin { c10: half * (1.0 - share), c01: half * share, bulk: hooke.bulk() })
    }

    /// `C10`, Pa.
    pub fn c10(&self) -> f64 {
        self.c10
    }

    /// `C01`, Pa.
    pub fn c01(&self) -> f64 {
        self.c01
    }

    /// Returns the law with the slopes of an energy as constants (Pa), which need not be positive.
    pub(super) fn with_slopes([c10, c01]: [f64; 2], bulk: f64) -> MooneyRivlin {
        MooneyRivlin { c10, c01, bulk }
    }

    fn moduli(&self, k: &Kinematics) -> Moduli {
        let a = (-2.0 / 3.0 * k.ln_j()).exp();
        Moduli { J: 1.0 + k.j, first: 2.0 * self.c10 * a, second: 2.0 * self.c01 * a * a }
    }

    /// Returns `F S` with
    /// `S = 2 C10 J^(-2/3) (I - I1/3 C^-1) + 2 C01 J^(-4/3) (I1 I - C - 2/3 I2 C^-1) + kappa J (J - 1) C^-1`.
    ///
    /// In terms of `E` and `D = I - C^-1` both brackets are sums of small terms: `D - 2/3 tr(E) C^-1` and
    /// `2 (tr(E) I - E + D) - 2/3 (I2 - 3) C^-1`.
    fn stress_at(&self, H: &Matrix3, k: &Kinematics, m: &Moduli) -> Matrix3 {
        let I = Matrix3::identity();
        let E = green_lagrange(H);
        let cof = cofactor(&E);
        let (one, two) = (E.trace(), cof.trace());
        let three = E.column(0).dot(&cof.column(0));
        // J^2 - 1 = 2 I_E + 4 II_E + 8 III_E and cof C = (1 + 2 I_E) I - 2 E + 4 cof E.
        let D = (E * 2.0 - cof * 4.0 + I * (4.0 * two + 8.0 * three)) / (m.J * m.J);
        let inverse = m.second * 8.0 / 3.0 * (one + two) + m.first * 2.0 / 3.0 * one - self.bulk * m.J * k.j;
        let S = D * (m.first + 2.0 * m.second) + (I * one - E) * (2.0 * m.second) - (I - D) * inverse;
        S + H * S
    }

    /// Returns the tangent, the sum of the following terms with `G = F^-T`, `B = F F^T`, `C = F^T F`,
    /// `Q = 2 (I1 F - B F) = dI2/dF`, `a = 2 C10 J^(-2/3)` and `h = 2 C01 J^(-4/3)`:
    ///
    /// ```text
    /// a (delta_ik delta_jl - 2/3 (F_ij G_kl + G_ij F_kl) + 2/9 I1 G_ij G_kl + I1/3 G_il G_kj)
    /// h (I1 delta_ik delta_jl - delta_ik C_jl - B_ik delta_jl - F_il F_kj + 2 F_ij F_kl
    ///    - 2/3 (Q_ij G_kl + G_ij Q_kl) + 8/9 I2 G_ij G_kl + 2/3 I2 G_il G_kj)
    /// kappa (J (2 J - 1) G_ij G_kl - J (J - 1) G_il G_kj)
    /// ```
    fn tangent_at(&self, k: &Kinematics, m: &Moduli) -> Tangent {
        let (F, G) = (&k.F, &k.G);
        let (a, h, J) = (m.first, m.second, m.J);
        let (B, C) = (F * F.transpose(), F.transpose() * F);
        let I1 = 3.0 + k.i1;
        let I2 = 3.0 + k.i2();
        let Q = (F * I1 - B * F) * 2.0;
        let swap = a * I1 / 3.0 + h * I2 * 2.0 / 3.0 - self.bulk * J * k.j;
        let outer = a * I1 * 2.0 / 9.0 + h * I2 * 8.0 / 9.0 + self.bulk * J * (J + k.j);
        // Terms paired with G: outer G x G - 2/3 ((a F + h Q) x G + G x (a F + h Q)) = X x G + G x X.
        let X = G * (0.5 * outer) - (F * a + Q * h) * (2.0 / 3.0);
        let mut tangent = tangent_of(|i, j, k, l| {
            swap * G[(i, l)] * G[(k, j)] - h * F[(i, l)] * F[(k, j)]
                + X[(i, j)] * G[(k, l)]
                + G[(i, j)] * X[(k, l)]
                + 2.0 * h * F[(i, j)] * F[(k, l)]
        });
        add_right(&mut tangent, &(Matrix3::identity() * (a + h * I1) - C * h));
        add_left(&mut tangent, &(B * -h));
        tangent
    }
}

impl Material for MooneyRivlin {
    fn energy(&self, H: &Matrix3) -> f64 {
        let k = Kinematics::new(H);
        3.0 * (self.c10 * k.ln_i1_bar().exp_m1() + self.c01 * k.ln_i2_bar().exp_m1())
            + 0.5 * self.bulk * k.j * k.j
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let k = Kinematics::new(H);
        self.stress_at(H, &k, &self.moduli(&k))
    }

    fn tangent(&self, H: &Matrix3) -> Tangent {
        let k = Kinematics::new(H);
        self.tangent_at(&k, &self.moduli(&k))
    }

    fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
        let k = Kinematics::new(H);
        let m = self.moduli(&k);
        (self.stress_at(H, &k, &m), self.tangent_at(&k, &m))
    }

    /// Computes `P = (a + 2 h) (F - F^-T) + (kappa (J - 1) - (a i1 + 2 h i2) / (3 J)) cof F + h (i1 F - F D)`
    /// with `D = C - I`, `i1 = tr D`, `i2 = I2 - 3 = 2 i1 + II(D)`, `a = 2 C10 J^(-2/3)` and
    /// `h = 2 C01 J^(-4/3)`.
    #[inline(always)]
    fn stress_lanes<const FMA: bool>(&self, strain: &LaneStrain, p: &mut [Lanes; 9]) {
        let m = madd::<FMA>;
        let (first, second) = (2.0 * self.c10, 2.0 * self.c01);
        for l in 0..LANES {
            let (h, (x, minors)) = (strain.lane(l), strain.invariants(l));
            let dot = |i: usize, j: usize| {
                let sum = h[3 * i + j] + h[3 * j + i];
                m(h[i], h[j], m(h[3 + i], h[3 + j], m(h[6 + i], h[6 + j], sum)))
            };
            let (xx, yy, zz) = (dot(0, 0), dot(1, 1), dot(2, 2));
            let (xy, xz, yz) = (dot(0, 1), dot(0, 2), dot(1, 2));
            let i1 = xx + yy + zz;
            let minor = m(xx, yy, m(xx, zz, yy * zz)) - m(xy, xy, m(xz, xz, yz * yz));
            let i2 = m(2.0, i1, minor);
            let y = 1.0 + inverse_cbrt_less_1::<FMA>(x.j);
            let square = y * y;
            let (a, b) = (first * square, second * (square * square));
            let per_j = square * y;
            let volume = m(self.bulk, x.j, per_j * (-1.0 / 3.0) * m(a, i1, 2.0 * b * i2));
            let shape = m(2.0, b, a);
            let [on_h, on_cof, on_i] = x.combined::<FMA>(shape, shape * per_j, volume);
            let stress = piola::<FMA, _>(&h, minors, [m(b, i1, on_h), on_cof, m(b, i1, on_i)]);
            let (xx, yy, zz, xy, xz, yz) = (b * xx, b * yy, b * zz, b * xy, b * xz, b * yz);
            let d = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
            for i in 0..3 {
                for j in 0..3 {
                    let of_h =
                        m(h[3 * i], d[0][j], m(h[3 * i + 1], d[1][j], m(h[3 * i + 2], d[2][j], d[i][j])));
                    p[3 * i + j][l] = stress[3 * i + j] - of_h;
                }
            }
        }
    }

    fn split(&self) -> Option<(MooneyRivlin, Volumetric)> {
        let volume = Volumetric::quadratic(self.bulk);
        Some((MooneyRivlin { bulk: 0.0, ..*self }, volume))
    }

    fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
        Some(Separated::of_volume(Volumetric::quadratic(Material::bulk(self)), theta_minus_1))
    }

    fn mu(&self) -> f64 {
        2.0 * (self.c10 + self.c01)
    }

    fn lambda(&self) -> f64 {
        self.bulk - 4.0 / 3.0 * (self.c10 + self.c01)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_constants_are_refused() {
        assert_eq!(MooneyRivlin::new(1.0, -2.0, 3.0).unwrap_err(), MaterialError::Shear { mu: -2.0 });
        assert!(matches!(MooneyRivlin::new(f64::NAN, 1.0, 3.0), Err(MaterialError::Shear { .. })));
        assert_eq!(MooneyRivlin::new(1.0, 0.0, 0.0).unwrap_err(), MaterialError::Bulk { bulk: 0.0 });
        for share in [-0.1, 1.1, f64::NAN] {
            assert!(matches!(MooneyRivlin::from_young(1.0, 0.3, share), Err(MaterialError::Share { .. })));
        }
        assert_eq!(
            MooneyRivlin::from_young(1.0, 0.5, 0.1).unwrap_err(),
            MaterialError::Poisson { poisson: 0.5 }
        );
    }

    #[test]
    fn constants_follow_from_moduli_and_share() {
        // mu = 12 kPa, kappa = 20 kPa; the second term has a quarter of mu/2.
        let law = MooneyRivlin::from_young(30e3, 0.25, 0.25).unwrap();
        let same = MooneyRivlin::new(4.5e3, 1.5e3, 20e3).unwrap();
        assert!((law.c10 - same.c10).abs() < 1e-9 && (law.c01 - same.c01).abs() < 1e-9);
        assert!((law.bulk - same.bulk).abs() < 1e-9);
    }
}
