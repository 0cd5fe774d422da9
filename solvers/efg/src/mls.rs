//! Moving least squares at one point: moment matrix, one factorisation, value and gradient.
//!
//! With `p_I = p((x_I - x)/s)`, `A = sum_I w_I p_I p_I^T` and `c0 = A^-1 e0`, values are `phi_I = c0.p_I w_I`.
//! Gradients hold the basis frozen at `x`: `c_a = A^-1 (e_a/s - A_,a c0)`, `phi_I,a = c_a.p_I w_I + c0.p_I w_I,a`,
//! with `A_,a c0` summed as a vector. Source: Belytschko, Krongauz, Organ, Fleming and Krysl (1996), in local coordinates.

use shape::{Point3, Vector3};

use crate::basis::terms;
use crate::kernel::Kernel;
use crate::ldlt::{Ldlt, norm};

/// Neighbours are worked through in groups of this many; sums keep one partial sum per place in the group, so that
/// their order, and with it the last bit, does not depend on the vector width of the machine.
const LANES: usize = 4;

/// Smallest pivot relative to its diagonal entry; rounding leaves 1e-16 where neighbours do not span the basis.
const PIVOT_TOLERANCE: f64 = 1e-10;

/// Largest error of reproduction of the basis at which a solution is accepted.
const REPRODUCTION_TOLERANCE: f64 = 1e-9;

/// Everything one point needs, reused from point to point: no allocation in the loop.
#[derive(Default)]
pub(crate) struct Workspace {
    /// Neighbours by ascending index.
    pub(crate) nodes: Vec<u32>,
    /// `phi_I`, one per neighbour.
    pub(crate) values: Vec<f64>,
    /// `grad phi_I` (1/m), one per neighbour; filled only when asked for.
    pub(crate) grads: Vec<Vector3>,
    /// Scaled offsets `(x_I - x)/s` by axis; this and the lists below are padded to whole lanes with zero weight.
    offset: [Vec<f64>; 3],
    relative: Vec<f64>,
    weight: Vec<f64>,
    /// `dw/dq`; then `-(dw/dq) s/(q R^2)` (1/m), which times the scaled offset is the gradient of the weight.
    slope: Vec<f64>,
    /// `1/(q R^2)` (1/m^2), or zero at the node itself.
    chain: Vec<f64>,
    scale: f64,
    staged: Vec<Staged>,
}

/// A candidate as first looked at.
#[derive(Clone, Copy, Default)]
struct Staged {
    offset: [f64; 3],
    square: f64,
    radius: f64,
    node: u32,
}

/// A node and its support, side by side in memory.
#[derive(Clone, Copy)]
pub(crate) struct Ball {
    pub(crate) at: [f64; 3],
    pub(crate) radius: f64,
}

impl Workspace {
    /// Collects those candidates whose support, `enlargement` times its radius, covers `x`.
    #[inline(always)]
    pub(crate) fn gather(
        &mut self,
        x: &Point3,
        candidates: impl ExactSizeIterator<Item = u32>,
        balls: &[Ball],
        enlargement: f64,
    ) {
        self.staged.resize(candidates.len(), Staged::default());
        let mut n = 0;
        for node in candidates {
            let Ball { at, radius } = balls[node as usize];
            let radius = radius * enlargement;
            let offset = [at[0] - x.x, at[1] - x.y, at[2] - x.z];
            let square = offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2];
            // Written always, counted if covered: about half of the candidates are not, and a branch would be mispredicted.
            self.staged[n] = Staged { offset, square, radius, node };
            n += usize::from(square < radius * radius);
        }
        let staged = &self.staged[..n];
        let padded = n.next_multiple_of(LANES);
        self.nodes.resize(n, 0);
        for list in self.offset.iter_mut().chain([&mut self.relative, &mut self.chain]) {
            list.resize(padded, 0.0);
        }
        let [ox, oy, oz] = &mut self.offset;
        let (ox, oy, oz) = (&mut ox[..padded], &mut oy[..padded], &mut oz[..padded]);
        let (nodes, relative, chain) =
            (&mut self.nodes[..n], &mut self.relative[..padded], &mut self.chain[..padded]);
        let mut scale = 0.0;
        for s in staged {
            scale = if s.radius > scale { s.radius } else { scale };
        }
        self.scale = scale;
        let inverse = 1.0 / scale;
        for (k, s) in staged.iter().enumerate() {
            nodes[k] = s.node;
            (ox[k], oy[k], oz[k]) = (s.offset[0] * inverse, s.offset[1] * inverse, s.offset[2] * inverse);
            (relative[k], chain[k]) = (s.square, s.radius);
        }
        for k in n..padded {
            (ox[k], oy[k], oz[k], relative[k], chain[k]) = (0.0, 0.0, 0.0, 1.0, 1.0);
        }
        for (relative, chain) in relative.iter_mut().zip(chain) {
            let inverse_radius = 1.0 / *chain;
            // Rounding must not lift q beyond 1, where kernels written for q < 1 need not vanish.
            let q = (relative.sqrt() * inverse_radius).min(1.0);
            *relative = q;
            *chain = if q > 0.0 { inverse_radius * inverse_radius / q } else { 0.0 };
        }
    }

    /// Fits the `M`-term basis over the neighbours gathered: values, and gradients if `GRAD`. `mu` regularises the
    /// quadratic block: `A + mu A_00 diag(0, .., 0, 1, .., 1)`, free of scale, exact for linear fields at any `mu`
    /// (Joldes et al. 2015, modified MLS). Returns the condition number of the matrix in the 1-norm, or `None`
    /// if it is singular to working precision.
    #[inline(always)]
    pub(crate) fn fit<const M: usize, const GRAD: bool>(&mut self, kernel: Kernel, mu: f64) -> Option<f64> {
        let n = self.nodes.len();
        if n == 0 {
            return None;
        }
        let padded = n.next_multiple_of(LANES);
        self.weight.resize(padded, 0.0);
        self.slope.resize(padded, 0.0);
        kernel.eval_all(&self.relative[..n], &mut self.weight[..n], &mut self.slope[..n]);
        self.weight[n..padded].fill(0.0);
        self.slope[n..padded].fill(0.0);
        let (weight, slope) = (&self.weight[..padded], &mut self.slope[..padded]);
        let [ox, oy, oz] = &self.offset;
        let (ox, oy, oz) = (&ox[..padded], &oy[..padded], &oz[..padded]);

        let a = moment::<M>(weight, ox, oy, oz, mu);
        let ldlt = Ldlt::new(&a, PIVOT_TOLERANCE)?;
        let mut c0 = [[0.0]; M];
        c0[0][0] = 1.0;
        ldlt.solve(&mut c0);
        let mut column = [0.0; M];
        for i in 0..M {
            column[i] = c0[i][0];
        }
        let c0 = column;
        for i in 0..M {
            let residual = (0..M).map(|j| a[i][j] * c0[j]).sum::<f64>() - f64::from(i == 0);
            // A NaN must not pass.
            if residual.abs().partial_cmp(&REPRODUCTION_TOLERANCE) != Some(std::cmp::Ordering::Less) {
                return None;
            }
        }
        let condition = norm(&a) * ldlt.inverse_norm();

        self.values.resize(padded, 0.0);
        let values = &mut self.values[..padded];
        if !GRAD {
            for k in 0..padded {
                values[k] = weight[k] * dot(&c0, &terms([ox[k], oy[k], oz[k]]));
            }
            self.values.truncate(n);
            return Some(condition);
        }

        // grad w_I = dw/dq (x - x_I)/(d R) = -(dw/dq) s/(q R^2) times the scaled offset.
        for (slope, chain) in slope.iter_mut().zip(&self.chain) {
            *slope *= -self.scale * chain;
        }
        let inverse = 1.0 / self.scale;
        let mut ca = derivative_moment::<M>(slope, ox, oy, oz, &c0, mu);
        for i in 0..M {
            for axis in 0..3 {
                ca[i][axis] = (if i == axis + 1 { inverse } else { 0.0 }) - ca[i][axis];
            }
        }
        ldlt.solve(&mut ca);
        self.grads.resize(padded, Vector3::zeros());
        let grads = &mut self.grads[..padded];
        for k in 0..padded {
            let p = terms::<M>([ox[k], oy[k], oz[k]]);
            let c = dot(&c0, &p);
            values[k] = weight[k] * c;
            let mut g = [0.0; 3];
            for i in 0..M {
                for axis in 0..3 {
                    g[axis] += ca[i][axis] * p[i];
                }
            }
            let along = slope[k] * c;
            grads[k] = Vector3::new(
                weight[k] * g[0] + along * ox[k],
                weight[k] * g[1] + along * oy[k],
                weight[k] * g[2] + along * oz[k],
            );
        }
        self.values.truncate(n);
        self.grads.truncate(n);
        Some(condition)
    }
}

#[inline(always)]
fn dot<const M: usize>(a: &[f64; M], b: &[f64; M]) -> f64 {
    let mut sum = 0.0;
    for i in 0..M {
        sum += a[i] * b[i];
    }
    sum
}

/// The terms at `LANES` neighbours, term by term.
#[inline(always)]
fn lane_terms<const M: usize>(x: &[f64], y: &[f64], z: &[f64]) -> [[f64; LANES]; M] {
    let mut all = [[0.0; LANES]; M];
    for lane in 0..LANES {
        let p = terms::<M>([x[lane], y[lane], z[lane]]);
        for i in 0..M {
            all[i][lane] = p[i];
        }
    }
    all
}

#[inline(always)]
fn lane_sum(lanes: &[f64; LANES]) -> f64 {
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3])
}

/// Moment matrix `A = sum w p p^T`, (M, M), dimensionless, regularised by `mu`.
#[inline(always)]
fn moment<const M: usize>(weight: &[f64], ox: &[f64], oy: &[f64], oz: &[f64], mu: f64) -> [[f64; M]; M] {
    let mut sums = [[[0.0; LANES]; M]; M];
    let groups = weight
        .chunks_exact(LANES)
        .zip(ox.chunks_exact(LANES))
        .zip(oy.chunks_exact(LANES).zip(oz.chunks_exact(LANES)));
    for ((w, x), (y, z)) in groups {
        let p = lane_terms::<M>(x, y, z);
        for i in 0..M {
            for j in 0..=i {
                for lane in 0..LANES {
                    sums[i][j][lane] += w[lane] * p[i][lane] * p[j][lane];
                }
            }
        }
    }
    let mut a = [[0.0; M]; M];
    for i in 0..M {
        for j in 0..=i {
            a[i][j] = lane_sum(&sums[i][j]);
            a[j][i] = a[i][j];
        }
    }
    let extra = mu * a[0][0];
    for i in 4..M {
        a[i][i] += extra;
    }
    a
}

/// `A_,a c0` for the three axes, (M, 3), 1/m: the basis frozen, so that only the weights change with `x`.
#[inline(always)]
fn derivative_moment<const M: usize>(
    slope: &[f64],
    ox: &[f64],
    oy: &[f64],
    oz: &[f64],
    c0: &[f64; M],
    mu: f64,
) -> [[f64; 3]; M] {
    let mut sums = [[[0.0; LANES]; 3]; M];
    let mut weight_sums = [[0.0; LANES]; 3];
    let groups = slope
        .chunks_exact(LANES)
        .zip(ox.chunks_exact(LANES))
        .zip(oy.chunks_exact(LANES).zip(oz.chunks_exact(LANES)));
    for ((g, x), (y, z)) in groups {
        let p = lane_terms::<M>(x, y, z);
        let offset = [p[1], p[2], p[3]];
        let mut fit = [0.0; LANES];
        for i in 0..M {
            for lane in 0..LANES {
                fit[lane] += c0[i] * p[i][lane];
            }
        }
        for axis in 0..3 {
            for lane in 0..LANES {
                let change = g[lane] * offset[axis][lane];
                weight_sums[axis][lane] += change;
                for i in 0..M {
                    sums[i][axis][lane] += change * fit[lane] * p[i][lane];
                }
            }
        }
    }
    let mut r = [[0.0; 3]; M];
    for axis in 0..3 {
        for i in 0..M {
            r[i][axis] = lane_sum(&sums[i][axis]);
        }
        let extra = mu * lane_sum(&weight_sums[axis]);
        for i in 4..M {
            r[i][axis] += extra * c0[i];
        }
    }
    r
}
