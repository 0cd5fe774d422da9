//! Errors against an exact solution.

use cases::exact::Exact;
use material::{Law, LinearElastic, Material as _};
use shape::{Matrix3, Point3, Vector3, VolumeRows};
use statics::Body;

use super::mean_pressure::cauchy;
use crate::Failure;

/// Relative errors over the body. A norm whose exact value vanishes (the pressure of a traceless stress, the energy
/// of a rigid motion) is absent rather than divided by zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Norms {
    /// `|u_h - u| / |u|` in L2.
    pub l2: Option<f64>,
    /// `sqrt(int ds : C^-1 : ds / int s : C^-1 : s)`, `ds` the stress error: for a plain displacement method the
    /// energy norm of the strain error, with a volumetric projection the same with the projected pressure.
    pub energy: Option<f64>,
    /// `|p_h - p| / |p|` in L2, p the mean stress.
    pub pressure: Option<f64>,
    /// `|s_h - s| / |s|` in L2, over all components.
    pub stress: Option<f64>,
}

/// Sums of squares of an error and of what it is relative to.
#[derive(Default)]
struct Ratio {
    error: f64,
    exact: f64,
}

impl Ratio {
    fn add(&mut self, weight: f64, error: f64, exact: f64) {
        self.error += weight * error;
        self.exact += weight * exact;
    }

    /// Absent where the exact norm is rounding against `scale`, a sum of squares of the same unit.
    fn root(&self, scale: f64) -> Option<f64> {
        (self.exact > 1e-20 * scale && self.exact > 0.0).then(|| (self.error / self.exact).sqrt())
    }
}

/// `|u_h - u| / |u|` in L2 alone: what can be said where the stress is that of another law.
pub fn l2(fine: &VolumeRows, u: &[Vector3], exact: &dyn Exact) -> Option<f64> {
    let mut l2 = Ratio::default();
    for ((x, w), u) in fine.points().iter().zip(fine.weights()).zip(fine.rows().apply(u)) {
        let u_exact = exact.displacement(x);
        l2.add(*w, (u - u_exact).norm_squared(), u_exact.norm_squared());
    }
    l2.root(l2.exact)
}

/// `|s_h - s| / |s|` in L2 over the undeformed body, s the Cauchy stress of a solution at large strain. `fine` as in [`norms`].
/// Absent too where the body is folded at a point, at which a law has no stress: nearly incompressible clouds can be between the
/// points that they integrate at.
pub fn stress(
    laws: &[Law],
    fine: &VolumeRows,
    fine_region: &[u16],
    u: &[Vector3],
    exact: &dyn Exact,
) -> Option<f64> {
    let mut all = Ratio::default();
    let mut scale = 0.0;
    let gradients = fine.at().displacement_gradients(u);
    for (q, (x, w)) in fine.points().iter().zip(fine.weights()).enumerate() {
        if (Matrix3::identity() + gradients[q]).determinant() <= 0.0 {
            return None;
        }
        let law = &laws[fine_region.get(q).copied().unwrap_or(0) as usize];
        let s = exact.stress(x);
        all.add(*w, (cauchy(law, &gradients[q]) - s).norm_squared(), s.norm_squared());
        scale += w * law.mu().powi(2) * exact.gradient(x).norm_squared();
    }
    all.root(scale)
}

/// Errors of the parameters `u`. `fine` (with the region of each point) is a quadrature of higher order than the
/// solver's own; with a volumetric projection, whose pressure lives at the solver's points, stresses are compared
/// there.
pub fn norms(
    body: &Body,
    fine: &VolumeRows,
    fine_region: &[u16],
    u: &[Vector3],
    exact: &dyn Exact,
) -> Result<Norms, Failure> {
    let mut l2 = Ratio::default();
    let field = fine.rows().apply(u);
    let mut gradient_scale = 0.0;
    for (q, x) in fine.points().iter().enumerate() {
        let u_exact = exact.displacement(x);
        l2.add(fine.weights()[q], (field[q] - u_exact).norm_squared(), u_exact.norm_squared());
        gradient_scale += fine.weights()[q] * exact.gradient(x).norm_squared();
    }
    let (points, weights, region, stress) = if body.dilation.is_some() {
        let stress = statics::body_stress(body, u)?;
        (body.volume.points(), body.volume.weights(), body.region, stress)
    } else {
        let stress = statics::stress(fine.at(), u, body.materials, fine_region)?;
        (fine.points(), fine.weights(), fine_region, stress)
    };
    let (mut energy, mut pressure, mut all) = (Ratio::default(), Ratio::default(), Ratio::default());
    for (q, x) in points.iter().enumerate() {
        let law = &body.materials[region.get(q).copied().unwrap_or(0) as usize];
        let s = law.stress(&exact.gradient(x));
        let ds = stress[q] - s;
        let w = weights[q];
        energy.add(w, complementary(law, &ds), complementary(law, &s));
        pressure.add(w, (ds.trace() / 3.0).powi(2), (s.trace() / 3.0).powi(2));
        all.add(w, ds.norm_squared(), s.norm_squared());
    }
    let law = &body.materials[0];
    Ok(Norms {
        l2: l2.root(l2.exact),
        energy: energy.root(law.mu() * gradient_scale),
        pressure: pressure.root(all.exact),
        stress: all.root(law.mu().powi(2) * gradient_scale),
    })
}

/// `s : C^-1 : s = |dev s|^2 / 2 mu + p^2 / kappa`, twice the complementary energy density, Pa.
fn complementary(law: &LinearElastic, s: &Matrix3) -> f64 {
    let p = s.trace() / 3.0;
    (s - Matrix3::identity() * p).norm_squared() / (2.0 * law.mu()) + p * p / law.bulk()
}

/// Root mean square per direction and of the magnitude, and maximum, of the difference of two fields (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// RMS of x, y and z.
    pub rms: [f64; 3],
    /// RMS of the magnitude: `sqrt(mean |a - b|^2)`.
    pub rms_magnitude: f64,
    /// Largest magnitude.
    pub max: f64,
}

/// Compares two fields at the same points.
pub fn difference(a: &[Vector3], b: &[Vector3]) -> Difference {
    assert_eq!(a.len(), b.len(), "fields at the same points");
    let mut squares = [0.0; 3];
    let mut max = 0.0f64;
    for (a, b) in a.iter().zip(b) {
        let d = a - b;
        for axis in 0..3 {
            squares[axis] += d[axis] * d[axis];
        }
        max = max.max(d.norm());
    }
    let n = a.len() as f64;
    Difference {
        rms: squares.map(|s| (s / n).sqrt()),
        rms_magnitude: (squares.iter().sum::<f64>() / n).sqrt(),
        max,
    }
}

/// Errors of a field over the size of the one it is compared with, dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relative {
    /// RMS of the difference's magnitude over that of the reference.
    pub rms: f64,
    /// Largest difference over the reference's largest magnitude.
    pub max: f64,
    /// Error of the largest magnitude, wherever each field has its own.
    pub peak: f64,
}

/// Compares two fields at the same points; nothing where the reference vanishes.
pub fn relative(a: &[Vector3], reference: &[Vector3]) -> Option<Relative> {
    // A field's difference from nothing is its own size.
    let size = |field: &[Vector3]| difference(field, &vec![Vector3::zeros(); field.len()]);
    let (apart, own) = (difference(a, reference), size(reference));
    (own.max > 0.0).then(|| Relative {
        rms: apart.rms_magnitude / own.rms_magnitude,
        max: apart.max / own.max,
        peak: (size(a).max / own.max - 1.0).abs(),
    })
}

/// The exact displacement at points.
pub fn exact_at(exact: &dyn Exact, points: &[Point3]) -> Vec<Vector3> {
    points.iter().map(|x| exact.displacement(x)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_told_per_direction() {
        let a = [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 2.0, 0.0)];
        let d = difference(&a, &[Vector3::zeros(); 2]);
        assert_eq!(d.rms, [0.5f64.sqrt(), 2.0f64.sqrt(), 0.0]);
        assert_eq!(d.rms_magnitude, 2.5f64.sqrt());
        assert_eq!(d.max, 2.0);
    }

    #[test]
    fn a_relative_error_is_of_the_reference() {
        let a = [Vector3::new(3.0, 0.0, 0.0), Vector3::new(0.0, 2.0, 0.0)];
        let reference = [Vector3::new(0.0, 0.0, 0.0), Vector3::new(0.0, 0.0, 4.0)];
        let r = relative(&a, &reference).unwrap();
        // Differences of 3 and sqrt(20) beside magnitudes of 0 and 4; the largest magnitude is 3 instead of 4.
        assert!((r.rms - (29.0f64 / 16.0).sqrt()).abs() < 1e-15);
        assert!((r.max - 20f64.sqrt() / 4.0).abs() < 1e-15);
        assert_eq!(r.peak, 0.25);
        assert_eq!(relative(&a, &[Vector3::zeros(); 2]), None);
    }

    #[test]
    fn complementary_energy_is_the_stress_against_its_strain() {
        let law = LinearElastic::new(20e3, 0.3).unwrap();
        let h = Matrix3::new(1e-3, 4e-4, 0.0, 2e-4, -5e-4, 1e-4, 0.0, 3e-4, 2e-4);
        let s = law.stress(&h);
        let direct = s.component_mul(&h).sum();
        assert!((complementary(&law, &s) - direct).abs() < 1e-12 * direct);
    }
}
