//! An estimate of a run's error from its own stress, with nothing to compare it to.
//!
//! Stress is smooth inside one material, and a method's stress is the less so the worse it is: it jumps from element to element,
//! and a mesh that locks has a pressure that changes its sign from one cell to the next. Around each node a linear polynomial is
//! fitted to the stress at the points that the node reaches; the fits, weighted by the shape functions, are the smooth stress, and
//! its distance from the method's own is the estimate (Zienkiewicz & Zhu 1992, Int. J. Numer. Meth. Eng. 33, 1331, and of
//! elements 1987, 24, 337). A fit sees one material only: across a border stress may jump.

use material::LinearElastic;
use nalgebra::{Matrix4, SMatrix};
use shape::{Matrix3, Point3, Rows, Vector3};

use super::Solved;
use super::own_stress::OwnStress;
use crate::discretise::place;

/// `s = [xx, yy, zz, xy, yz, zx]` of the fit's constant and of its slopes along x, y, z per patch size.
type Fit = SMatrix<f64, 4, 6>;

/// Added to the slopes' part of the normal matrix, over its constant's: what lies in a plane has no slope across it.
const RIDGE: f64 = 1e-8;

/// Energy that is rounding, over that of the largest displacement taken as a strain across the body: a rigid motion has no more, and
/// no stress to tell. In free fall the gradients themselves are rounding.
const ROUNDING: f64 = 1e-20;

/// `|s* - s| / sqrt(|s|^2 + |s* - s|^2)` in the energy norm of the materials at small strain, 0 to 1; `None` without stress, and of
/// tissue that relaxes, whose stress is that of its past.
pub(super) fn stress_jump(run: &Solved) -> Option<f64> {
    let Solved { setup, prepared, solution, method } = *run;
    if setup.relaxes() {
        return None;
    }
    let volume = &prepared.volume;
    let gradients = volume.rows.at().displacement_gradients(&solution.u);
    let stress = OwnStress::new(&setup.laws, prepared, &gradients, &solution.pressure).everywhere();
    let region = |q: usize| volume.region.get(q).map_or(0, |&r| usize::from(r));
    let points = Points {
        x: volume.rows.points(),
        rows: volume.rows.rows(),
        weights: volume.rows.weights(),
        stress: &stress,
    };
    let largest = solution.u.iter().map(|u| u.norm_squared()).fold(0.0, f64::max);
    let (low, high) = place::bounds(method.mesh());
    let as_strain = largest / (high - low).norm_squared();
    let (mut own, mut off, mut scale) = (0.0, 0.0, 0.0);
    for (at, material) in setup.materials.iter().enumerate() {
        let inside: Vec<usize> = (0..stress.len()).filter(|&q| region(q) == at).collect();
        let smooth = points.smooth(method.nodes(), &inside);
        for (&q, smooth) in inside.iter().zip(&smooth) {
            own += points.weights[q] * energy(material, &stress[q]);
            off += points.weights[q] * energy(material, &(smooth - stress[q]));
            scale += points.weights[q] * material.mu() * (gradients[q].norm_squared() + as_strain);
        }
    }
    (own > ROUNDING * scale).then(|| (off / (own + off)).sqrt())
}

/// `s : C^-1 : s`, J/m^3.
fn energy(material: &LinearElastic, s: &Matrix3) -> f64 {
    let mean = s.trace() / 3.0;
    let deviator = s - Matrix3::identity() * mean;
    deviator.norm_squared() / (2.0 * material.mu()) + mean * mean / material.bulk()
}

/// Stress at the points of a quadrature.
struct Points<'a> {
    x: &'a [Point3],
    rows: &'a Rows,
    weights: &'a [f64],
    stress: &'a [Matrix3],
}

impl Points<'_> {
    /// The smooth stress at the points `inside`, of these points alone.
    fn smooth(&self, nodes: &[Point3], inside: &[usize]) -> Vec<Matrix3> {
        let mut patches: Vec<Vec<(usize, f64)>> = vec![Vec::new(); nodes.len()];
        for &q in inside {
            let (near, values) = self.rows.row(q);
            for (&a, phi) in near.iter().zip(values).filter(|(_, phi)| **phi != 0.0) {
                patches[a as usize].push((q, phi.abs()));
            }
        }
        let mut sum = vec![(Matrix3::zeros(), 0.0); self.stress.len()];
        for (node, patch) in nodes.iter().zip(&patches).filter(|(_, patch)| !patch.is_empty()) {
            let size = patch.iter().map(|&(q, _)| (self.x[q] - node).norm()).fold(0.0, f64::max);
            let basis = |q: usize| {
                let r: Vector3 = (self.x[q] - node) / size.max(f64::MIN_POSITIVE);
                nalgebra::Vector4::new(1.0, r.x, r.y, r.z)
            };
            let fit = self.fit(patch, basis);
            for &(q, phi) in patch {
                let s = fit.transpose() * basis(q);
                let s = Matrix3::new(s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]);
                sum[q].0 += s * phi;
                sum[q].1 += phi;
            }
        }
        inside.iter().map(|&q| sum[q].0 / sum[q].1).collect()
    }

    /// The linear polynomial nearest to the stress of a patch, by volume and shape value.
    fn fit(&self, patch: &[(usize, f64)], basis: impl Fn(usize) -> nalgebra::Vector4<f64>) -> Fit {
        let (mut matrix, mut right) = (Matrix4::zeros(), Fit::zeros());
        for &(q, phi) in patch {
            let (p, s, w) = (basis(q), &self.stress[q], self.weights[q] * phi);
            matrix += p * p.transpose() * w;
            let s =
                SMatrix::<f64, 1, 6>::new(s[(0, 0)], s[(1, 1)], s[(2, 2)], s[(0, 1)], s[(1, 2)], s[(2, 0)]);
            right += p * s * w;
        }
        for k in 1..4 {
            matrix[(k, k)] += RIDGE * matrix[(0, 0)];
        }
        match matrix.cholesky() {
            Some(factor) => factor.solve(&right),
            // Of one point: its own stress.
            None => Fit::from_fn(|k, c| if k == 0 { right[(0, c)] / matrix[(0, 0)] } else { 0.0 }),
        }
    }
}
