//! Strains and rotations beyond the validity of a small-strain law.

use geometry::{Matrix3, Point3, Vector3};
use material::Material as _;

use super::solved::Solved;

/// Principal strain above which a small-strain law is not valid. Engineering and true strain then differ by a
/// twentieth of the strain.
pub(super) const LARGE: f64 = 0.1;
/// Rotation above which a small-strain law is not valid, rad. A rigid rotation by `w` gives a false strain of
/// `w^2 / 2`, here 2 %.
pub(super) const TURNED: f64 = 0.2;

/// Relative rounding of an eigenvalue and of the norm.
const ROUNDING: f64 = 1e-12;

/// Largest strain or rotation in the body.
#[derive(Default)]
pub(super) struct Largest {
    /// Positive value: a principal strain in tension or compression, or an angle in rad.
    pub value: f64,
    /// Position of the integration point, m.
    pub at: Point3,
    /// Fraction of the volume in which the value exceeds its limit.
    pub share: f64,
}

/// Largest principal strain and largest rotation over all integration points with a small-strain law; `None`
/// without such a law. An exact solution of the linear equations assumes small strain itself, so results
/// compared with it are valid at any strain: `None` too.
pub(super) fn largest(run: &Solved) -> Option<[Largest; 2]> {
    let Solved { setup, prepared, solution, .. } = *run;
    let small = |q: usize| setup.is_linear() || setup.laws[prepared.volume.region(q)].is_small_strain();
    if setup.exact.is_some() || setup.contact.is_some() {
        return None;
    }
    let rows = &prepared.volume.rows;
    let [mut strain, mut turn] = [Largest::default(), Largest::default()];
    let mut met = false;
    for q in (0..rows.weights().len()).filter(|q| small(*q)) {
        met = true;
        let h = rows.at().displacement_gradient(q, &solution.u);
        let at = &rows.points()[q];
        let weight = rows.weights()[q];
        turn.add(rotation(&h), TURNED, at, weight);
        let tensor = (h + h.transpose()) * 0.5;
        // No principal strain exceeds the norm, which costs a tenth of the eigenvalues. Few points need
        // eigenvalues.
        if tensor.norm() * (1.0 + ROUNDING) >= strain.value.min(LARGE) {
            strain.add(tensor.symmetric_eigenvalues().amax(), LARGE, at, weight);
        }
    }
    let volume: f64 = rows.weights().iter().sum();
    [&mut strain, &mut turn].into_iter().for_each(|each| each.share /= volume);
    met.then_some([strain, turn])
}

/// Small rotation of a displacement gradient, half its curl, rad.
fn rotation(h: &Matrix3) -> f64 {
    0.5 * Vector3::new(h.m32 - h.m23, h.m13 - h.m31, h.m21 - h.m12).norm()
}

impl Largest {
    fn add(&mut self, value: f64, limit: f64, at: &Point3, weight: f64) {
        if value > self.value {
            (self.value, self.at) = (value, *at);
        }
        self.share += if value > limit { weight } else { 0.0 };
    }
}
