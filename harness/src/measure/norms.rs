//! Errors against an exact solution.

use cases::exact::Exact;
use material::{Law, LinearElastic, Material as _};
use shape::{Matrix3, Point3, Vector3, VolumeRows};

use super::solved::Solved;
use super::stress::{Recovered, own_stress};
use crate::discretise::region_at;

/// Relative errors over the body. If the exact value of a norm vanishes (the pressure of a traceless stress,
/// the energy of a rigid motion), the norm is absent instead of divided by zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Norms {
    /// `|u_h - u| / |u|` in L2.
    pub l2: Option<f64>,
    /// `sqrt(int ds : C^-1 : ds / int s : C^-1 : s)` with the stress error `ds`. For a plain displacement
    /// method this is the energy norm of the strain error; with a volumetric projection it includes the
    /// projected pressure.
    pub energy: Option<f64>,
    /// `|p_h - p| / |p|` in L2, p the mean of the recovered stress.
    pub pressure: Option<f64>,
    /// `|s_h - s| / |s|` in L2, over all components of the recovered stress.
    pub stress: Option<f64>,
}

/// Sums of squares of an error and of the exact field.
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

    /// Relative error; `None` if the exact norm is rounding compared with `scale`, a sum of squares of the
    /// same unit.
    fn root(&self, scale: f64) -> Option<f64> {
        (self.exact > 1e-20 * scale && self.exact > 0.0).then(|| (self.error / self.exact).sqrt())
    }
}

/// Errors of a run over `fine`, a quadrature of higher order than the solver's own, with the region of each
/// point. Solutions at large strain give their own Cauchy stress over the undeformed body, and no energy.
pub(super) fn norms(
    run: &Solved,
    recovered: Option<&Recovered>,
    fine: &VolumeRows,
    fine_region: &[u16],
    exact: &dyn Exact,
) -> Norms {
    let Solved { setup, solution, .. } = *run;
    let mut l2 = Ratio::default();
    for ((x, w), u) in fine.points().iter().zip(fine.weights()).zip(fine.rows().apply(&solution.u)) {
        let u_exact = exact.displacement(x);
        l2.add(*w, (u - u_exact).norm_squared(), u_exact.norm_squared());
    }
    let small = setup.laws.iter().all(Law::is_small_strain);
    let found = Norms { l2: l2.root(l2.exact), ..Norms::default() };
    let comparable = small || exact.is_large_strain();
    let Some(recovered) = recovered.filter(|_| comparable) else { return found };
    let (mut pressure, mut all, mut scale) = (Ratio::default(), Ratio::default(), 0.0);
    for (q, (x, &w)) in fine.points().iter().zip(fine.weights()).enumerate() {
        let region = fine_region.get(q).copied().unwrap_or(0);
        let law = &setup.materials[usize::from(region)];
        let gradient = exact.gradient(x);
        let s = if exact.is_large_strain() { exact.stress(x) } else { law.stress(&gradient) };
        let ds = recovered.at(x, region, fine.rows().row(q)) - s;
        pressure.add(w, (ds.trace() / 3.0).powi(2), (s.trace() / 3.0).powi(2));
        all.add(w, ds.norm_squared(), s.norm_squared());
        scale += w * law.mu().powi(2) * gradient.norm_squared();
    }
    let stress = all.root(scale);
    match exact.is_large_strain() {
        true => Norms { stress, ..found },
        false => Norms {
            energy: energy(run, fine, fine_region, exact),
            pressure: pressure.root(all.exact),
            stress,
            ..found
        },
    }
}

/// Energy norm of the stress error. For plain methods the stress follows from the law at the displacement
/// gradient over `fine`. Other methods use their own stress at their own points, between which much of the
/// strain would have no energy.
fn energy(run: &Solved, fine: &VolumeRows, fine_region: &[u16], exact: &dyn Exact) -> Option<f64> {
    let Solved { method, setup, prepared, solution } = *run;
    let volume = &prepared.volume;
    let own = volume.groups.is_some() || volume.pressure.is_some() || method.reduced;
    let (rows, region) = if own { (&volume.rows, &volume.region[..]) } else { (fine, fine_region) };
    let law = |q: usize| &setup.materials[region_at(region, q)];
    let stress = match own {
        true => own_stress(run, &solution.u, &solution.pressure, solution.time()),
        false => {
            let gradients = fine.at().displacement_gradients(&solution.u);
            gradients.iter().enumerate().map(|(q, h)| law(q).stress(h)).collect()
        }
    };
    let (mut ratio, mut scale) = (Ratio::default(), 0.0);
    for (q, (x, &w)) in rows.points().iter().zip(rows.weights()).enumerate() {
        let gradient = exact.gradient(x);
        let s = law(q).stress(&gradient);
        ratio.add(w, complementary(law(q), &(stress[q] - s)), complementary(law(q), &s));
        scale += w * law(q).mu() * gradient.norm_squared();
    }
    ratio.root(scale)
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

/// Errors of a field relative to the size of the reference field, dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relative {
    /// RMS of the difference's magnitude over the RMS magnitude of the reference.
    pub rms: f64,
    /// Largest difference over the reference's largest magnitude.
    pub max: f64,
    /// Error of the largest magnitude, wherever in each field it occurs.
    pub peak: f64,
}

/// Compares two fields at the same points; `None` if the reference vanishes.
pub fn relative(a: &[Vector3], reference: &[Vector3]) -> Option<Relative> {
    // A field's difference from zero is its own size.
    let size = |field: &[Vector3]| difference(field, &vec![Vector3::zeros(); field.len()]);
    let apart = difference(a, reference);
    let own = size(reference);
    (own.max > 0.0).then(|| Relative {
        rms: apart.rms_magnitude / own.rms_magnitude,
        max: apart.max / own.max,
        peak: (size(a).max / own.max - 1.0).abs(),
    })
}

/// Exact displacement (m) at points (m).
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
        // Differences of 3 and sqrt(20) for magnitudes of 0 and 4; the largest magnitude is 3 instead of 4.
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
