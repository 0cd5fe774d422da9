//! Laws in the form that the kernels use.

use super::body::ExplicitBody;
use super::scalar::Scalar;
use lanes::on_path;
use material::lane::{LaneStrain, Real};
use material::{Law, Material, Volumetric, VolumetricForm};

/// Lame moduli of a neo-Hookean law, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moduli<T = f64> {
    pub mu: T,
    pub lambda: T,
}

impl Moduli {
    /// Rounds the moduli to the scalar of a kernel.
    pub fn of<T: Real>(self) -> Moduli<T> {
        Moduli { mu: T::of(self.mu), lambda: T::of(self.lambda) }
    }
}

/// Moduli of the volumetric energy `logarithmic / 2 (ln J)^2 + quadratic / 2 (J - 1)^2`, Pa.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct VolumeModuli {
    pub logarithmic: f64,
    pub quadratic: f64,
}

impl VolumeModuli {
    /// Returns the moduli of an energy; `None` if it is not of this form.
    fn of(volume: &Volumetric) -> Option<VolumeModuli> {
        let none = VolumeModuli::default();
        match volume.form {
            VolumetricForm::Quadratic => Some(VolumeModuli { quadratic: volume.bulk, ..none }),
            VolumetricForm::Logarithmic => Some(VolumeModuli { logarithmic: volume.bulk, ..none }),
            VolumetricForm::SimoTaylor => None,
        }
    }
}

/// Law of a region as the kernels run it: the neo-Hookean law inside their own loops, every other law by its
/// own lane code.
pub(super) enum LaneLaw {
    NeoHookean(Moduli),
    /// Any other law. With groups of points, the first part does not change with `J`, and the second is
    /// volumetric.
    Other(Law, VolumeModuli),
}

impl LaneLaw {
    /// Returns the laws of all regions of a body. Returns `None` if a law depends on directions, or if points
    /// share a dilation and a law does not split into a part for shape change and a volumetric energy of
    /// [`VolumeModuli`].
    pub fn of_regions(body: &ExplicitBody) -> Option<Vec<LaneLaw>> {
        if body.laws.iter().any(Law::has_axes) {
            return None;
        }
        let law = |law: &Law| match (law, body.groups) {
            (Law::NeoHookean(law), _) => {
                Some(LaneLaw::NeoHookean(Moduli { mu: law.mu(), lambda: law.lambda() }))
            }
            (law, None) => Some(LaneLaw::Other(law.clone(), VolumeModuli::default())),
            (law, Some(_)) => {
                let (shape, volume) = law.split()?;
                Some(LaneLaw::Other(shape, VolumeModuli::of(&volume)?))
            }
        };
        body.laws.iter().map(law).collect()
    }

    /// Returns the moduli `[mu, lambda, k]` (Pa) of the energy terms in the dilation `J` of a group,
    /// `-mu ln J + lambda (ln J)^2 / 2 + k (J - 1)^2 / 2`. `k` is zero for the neo-Hookean law, and `mu`
    /// for all other laws.
    pub fn of_group(&self) -> [f64; 3] {
        match self {
            LaneLaw::NeoHookean(moduli) => [moduli.mu, moduli.lambda, 0.0],
            LaneLaw::Other(_, volume) => [0.0, volume.logarithmic, volume.quadratic],
        }
    }
}

on_path! {
    /// Computes the stress of all lanes for each strain, Pa.
    pub(super) fn stress<; T: [Scalar]>(law: &Law, strains: &[LaneStrain<T>], p: &mut [[T::Lanes; 9]]) = stress_lanes
}

#[inline(always)]
fn stress_lanes<const FMA: bool, T: Scalar>(law: &Law, strains: &[LaneStrain<T>], p: &mut [[T::Lanes; 9]]) {
    T::stress::<FMA>(law, strains, p);
}

/// Computes `J_a^(2/3)` and `p_a = (1/V_a) dE/dJ_a` of one dilation group from its mean `J_a - 1`,
/// `B_a = sum share w mu b`, `1 / V_a`, and `sum share w` times the moduli of [`LaneLaw::of_group`].
#[inline(always)]
pub(super) fn close_group<const FMA: bool, T: Real>(
    j: T,
    b: T,
    per_volume: T,
    [mu, lambda, quadratic]: [T; 3],
) -> [T; 2] {
    let m = T::madd::<FMA>;
    let d = T::inverse_cbrt_less_1::<FMA>(j);
    // J^(2/3) - 1 = (1 + j) (1 + d) - 1.
    let sigma = m(j, d, j + d);
    let (y, s) = (T::ONE + d, T::ONE + sigma);
    let p = m(b, s, m(sigma, mu, lambda * T::ln_1p::<FMA>(j)));
    [s, m(quadratic, j * per_volume, p * (y * y * y) * per_volume)]
}
