//! Recovered stress: the smooth stress of a run, from the stress at its quadrature points, and the jump of
//! the method's own stress around the smooth stress.
//!
//! The true stress is smooth within one material, but a method's own stress jumps from element to element,
//! the more so the less accurate the method is. On a mesh that locks, the pressure changes its sign from cell
//! to cell. Around each node, a polynomial of the method's order (for the pressure a linear polynomial) is
//! fitted to the stress at the points in the node's support. The fits, weighted by the shape functions, are
//! the smooth stress (Zienkiewicz & Zhu 1992, Int. J. Numer. Meth. Eng. 33, 1331, and of elements 1987, 24,
//! 337). A fit uses one material only, because stress may jump at an interface.

use material::LinearElastic;
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;
use shape::{Matrix3, Point3, Vector3};

use super::quadrature_points::own_stress;
use crate::discretise::place;
use crate::measure::solved::Solved;

/// Coefficients of the first `M` of the terms 1, x, y, z, xx, yy, zz, yz, zx, xy for the stress components
/// `[xx, yy, zz, xy, yz, zx]`, a column for each term. Coordinates are relative to the patch size.
type Fit<const M: usize> = SMatrix<f64, 6, M>;

/// Number of terms of a linear fit.
const LINEAR: usize = 4;
/// Number of terms of a quadratic fit.
const QUADRATIC: usize = 10;
/// Regularisation added to the diagonal of the normal matrix, relative to the entry of the constant term.
/// Points in a plane do not determine a slope across the plane.
const RIDGE: f64 = 1e-6;
/// Number of passes, each of which fits the residual of the previous passes. From the third pass on, the
/// regularisation changes a slope by only 1e-15.
const PASSES: usize = 3;
/// Regularisation of the quadratic terms, which are fitted to the residual of the linear fit. Few points do
/// not distinguish these terms.
const QUADRATIC_RIDGE: f64 = 1e-3;

/// Energy at rounding level, relative to the energy of the largest displacement taken as a strain across the
/// body. A rigid motion has no more energy, and no stress. In free fall the gradients themselves are
/// rounding.
const ROUNDING: f64 = 1e-20;

/// Nodes that one task fits at least: some 0.1 ms.
const TOGETHER: usize = 64;

/// Fits of the stress in one state of a run.
pub(crate) struct Recovered<'a> {
    run: Solved<'a>,
    /// Nodal parameters of the state, m.
    u: &'a [Vector3],
    /// Stress at the quadrature points, Pa.
    own: Vec<Matrix3>,
    /// First region of the same material, for each region.
    alike: Vec<u16>,
    /// Fits around the nodes, for the first region of each material; `None` for nodes without points in the
    /// material.
    patches: Vec<Vec<Option<Patch>>>,
}

/// Polynomial fits around a node.
struct Patch {
    /// Linear fit.
    linear: Fit<LINEAR>,
    /// Quadratic part, for second-order methods.
    quadratic: Option<Box<Fit<QUADRATIC>>>,
    /// Scale of the coordinates, m.
    size: f64,
}

impl<'a> Recovered<'a> {
    /// Fits the stress of a state with nodal parameters `u` (m) and, if there is a pressure field, its
    /// parameters (Pa), at a time of [`own_stress`]. `None` for viscoelastic tissue, whose stress depends on its history, which is
    /// followed at quadrature points only.
    pub fn new(run: &Solved<'a>, u: &'a [Vector3], parameters: &[f64], time: f64) -> Option<Recovered<'a>> {
        if run.setup.relaxes() {
            return None;
        }
        let own = own_stress(run, u, parameters, time);
        let alike = run.setup.alike();
        let mut recovered = Recovered { run: *run, u, own, alike, patches: Vec::new() };
        recovered.patches =
            (0..recovered.alike.len()).map(|material| recovered.of_material(material)).collect();
        Some(recovered)
    }

    /// Smooth stress (Pa) at a point (m) of a region; `row` has the nodes and shape function values at the
    /// point.
    pub fn at(&self, x: &Point3, region: u16, row: (&[u32], &[f64])) -> Matrix3 {
        self.blended(x, region, row, Patch::at)
    }

    /// Average of the fits around a point, weighted by the shape function values.
    fn blended(
        &self,
        x: &Point3,
        region: u16,
        row: (&[u32], &[f64]),
        value: impl Fn(&Patch, &Vector3) -> Matrix3,
    ) -> Matrix3 {
        let material = self.alike[usize::from(region)];
        let (mut sum, mut whole) = (Matrix3::zeros(), 0.0);
        for (&node, phi) in row.0.iter().zip(row.1) {
            if let Some(patch) = &self.patches[usize::from(material)][node as usize] {
                sum += value(patch, &(x - self.run.method.nodes()[node as usize])) * phi.abs();
                whole += phi.abs();
            }
        }
        // In a region thinner than the point spacing, a node may have no points in its support.
        if whole > 0.0 { sum / whole } else { self.own[self.nearest(x, material)] }
    }

    /// Stress jump `|s* - s| / sqrt(|s|^2 + |s* - s|^2)` in the energy norm of the materials at small strain,
    /// 0 to 1, and the quadrature point (m) that contributes most; `None` without stress. Here s* is of
    /// linear fits, whatever the method, because quadratic fits follow the jumps.
    pub fn jump(&self) -> Option<(f64, Point3)> {
        let volume = &self.run.prepared.volume.rows;
        let largest = self.u.iter().map(|u| u.norm_squared()).fold(0.0, f64::max);
        let (low, high) = place::bounds(self.run.method.mesh());
        let as_strain = largest / (high - low).norm_squared();
        let (mut own, mut off, mut scale) = (0.0, 0.0, 0.0);
        let mut most = (0.0, Point3::origin());
        for (q, ((stress, w), x)) in self.own.iter().zip(volume.weights()).zip(volume.points()).enumerate() {
            let region = self.region(q);
            let material = &self.run.setup.materials[usize::from(region)];
            let smooth = self.blended(x, region, volume.rows().row(q), Patch::linear_at);
            own += w * energy(material, stress);
            let part = w * energy(material, &(smooth - stress));
            off += part;
            if part > most.0 {
                most = (part, *x);
            }
            scale +=
                w * material.mu() * (volume.at().displacement_gradient(q, self.u).norm_squared() + as_strain);
        }
        (own > ROUNDING * scale).then(|| ((off / (own + off)).sqrt(), most.1))
    }

    fn region(&self, q: usize) -> u16 {
        self.run.prepared.volume.region.get(q).copied().unwrap_or(0)
    }

    /// Fits of the material whose first region is `material`; empty for other regions.
    fn of_material(&self, material: usize) -> Vec<Option<Patch>> {
        if usize::from(self.alike[material]) != material {
            return Vec::new();
        }
        let rows = self.run.prepared.volume.rows.rows();
        let nodes = self.run.method.nodes();
        let own = |q: &usize| usize::from(self.alike[usize::from(self.region(*q))]) == material;
        let entries = |q: usize| {
            let (nodes, values) = rows.row(q);
            nodes
                .iter()
                .zip(values)
                .filter(|(_, phi)| **phi != 0.0)
                .map(move |(&a, phi)| (a as usize, q, phi.abs()))
        };
        let near = || (0..rows.len()).filter(own).flat_map(entries);
        // The points near each node, one node after another: a list for each node would take twice the
        // memory.
        let mut starts = vec![0; nodes.len() + 1];
        near().for_each(|(a, ..)| starts[a + 1] += 1);
        for a in 0..nodes.len() {
            starts[a + 1] += starts[a];
        }
        let mut points = vec![(0, 0.0); starts[nodes.len()]];
        let mut next = starts.clone();
        for (a, q, phi) in near() {
            points[next[a]] = (q, phi);
            next[a] += 1;
        }
        let of = |(a, node): (usize, &Point3)| {
            let points = &points[starts[a]..starts[a + 1]];
            (!points.is_empty()).then(|| self.fitted(node, points))
        };
        nodes.par_iter().enumerate().with_min_len(TOGETHER).map(of).collect()
    }

    /// Least-squares polynomials for the stress at some points, weighted by volume and shape function value.
    fn fitted(&self, node: &Point3, points: &[(usize, f64)]) -> Patch {
        let volume = &self.run.prepared.volume.rows;
        let from = |q: usize| volume.points()[q] - node;
        let size = points.iter().map(|&(q, _)| from(q).norm()).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        let at = |&(q, phi): &(usize, f64)| (basis(&from(q), size), volume.weights()[q] * phi);
        let bases: Vec<(Basis, f64)> = points.iter().map(at).collect();
        let mut left: Vec<SMatrix<f64, 1, 6>> =
            points.iter().map(|&(q, _)| components(&self.own[q])).collect();
        // The mean is fitted first; otherwise its rounding would become a slope across a plane.
        let mean = nearest_fit::<1>(&bases, &mut left, 0.0, 1);
        let mut linear = nearest_fit::<LINEAR>(&bases, &mut left, RIDGE, PASSES);
        linear.set_column(0, &(mean + linear.column(0)));
        let second = self.run.method.order == 2;
        let quadratic =
            second.then(|| Box::new(nearest_fit::<QUADRATIC>(&bases, &mut left, QUADRATIC_RIDGE, 1)));
        Patch { linear, quadratic, size }
    }

    /// Index of the quadrature point of a material nearest to `x`.
    fn nearest(&self, x: &Point3, material: u16) -> usize {
        let points = self.run.prepared.volume.rows.points();
        let far = |q: &usize| (points[*q] - x).norm_squared();
        let inside = (0..points.len()).filter(|&q| self.alike[usize::from(self.region(q))] == material);
        inside.min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0)
    }
}

impl Patch {
    /// Stress at `r` (m) from the node. In nearly incompressible second-order elements the pressure
    /// alternates from point to point: a linear fit averages it, a quadratic fit follows it (errors of tet10
    /// in a thick sphere: 1.8 and 3.6 %). The quadratic part is therefore used for the deviator only.
    fn at(&self, r: &Vector3) -> Matrix3 {
        let linear = self.linear_at(r);
        let Some(quadratic) = &self.quadratic else { return linear };
        let more = tensor(&value(quadratic, basis(r, self.size).as_slice()));
        linear + more - Matrix3::identity() * (more.trace() / 3.0)
    }

    /// Stress of the linear fit at `r` (m) from the node.
    fn linear_at(&self, r: &Vector3) -> Matrix3 {
        let r = r / self.size;
        tensor(&value(&self.linear, &[1.0, r.x, r.y, r.z]))
    }
}

type Basis = SVector<f64, QUADRATIC>;

fn basis(r: &Vector3, size: f64) -> Basis {
    let r = r / size;
    let [x, y, z] = [r.x, r.y, r.z];
    Basis::from([1.0, x, y, z, x * x, y * y, z * z, y * z, z * x, x * y])
}

/// Value of a fit by its terms. This and the sums of [`nearest_fit`] are loops because products of nalgebra
/// have strides known only at run time, and took a sixth of the time of a cantilever's run.
fn value<const M: usize>(fit: &Fit<M>, terms: &[f64]) -> SVector<f64, 6> {
    let mut value = SVector::zeros();
    for (m, term) in terms.iter().enumerate() {
        for k in 0..6 {
            value[k] += fit[(k, m)] * term;
        }
    }
    value
}

/// Weighted least-squares polynomial of the first `M` terms for the residuals `left`, from which the
/// polynomial is then subtracted.
fn nearest_fit<const M: usize>(
    bases: &[(Basis, f64)],
    left: &mut [SMatrix<f64, 1, 6>],
    ridge: f64,
    passes: usize,
) -> Fit<M> {
    let mut matrix = SMatrix::<f64, M, M>::zeros();
    for (p, w) in bases {
        for a in 0..M {
            for b in 0..M {
                matrix[(b, a)] += p[b] * p[a] * w;
            }
        }
    }
    for k in 1..M {
        matrix[(k, k)] += ridge * matrix[(0, 0)];
    }
    let mut fit = Fit::<M>::zeros();
    // There is no factor if the points have no weight.
    let Some(factor) = matrix.cholesky() else { return fit };
    for _ in 0..passes {
        let mut right = SMatrix::<f64, M, 6>::zeros();
        for ((p, w), s) in bases.iter().zip(left.iter()) {
            for k in 0..6 {
                for a in 0..M {
                    right[(a, k)] += p[a] * s[k] * w;
                }
            }
        }
        let more = factor.solve(&right);
        for ((p, _), s) in bases.iter().zip(left.iter_mut()) {
            for k in 0..6 {
                s[k] -= (0..M).map(|a| p[a] * more[(a, k)]).sum::<f64>();
            }
        }
        fit += more.transpose();
    }
    fit
}

fn components(s: &Matrix3) -> SMatrix<f64, 1, 6> {
    SMatrix::from([[s[(0, 0)]], [s[(1, 1)]], [s[(2, 2)]], [s[(0, 1)]], [s[(1, 2)]], [s[(2, 0)]]])
}

fn tensor(s: &SVector<f64, 6>) -> Matrix3 {
    Matrix3::new(s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2])
}

/// `s : C^-1 : s`, J/m^3.
fn energy(material: &LinearElastic, s: &Matrix3) -> f64 {
    let mean = s.trace() / 3.0;
    let deviator = s - Matrix3::identity() * mean;
    deviator.norm_squared() / (2.0 * material.mu()) + mean * mean / material.bulk()
}
