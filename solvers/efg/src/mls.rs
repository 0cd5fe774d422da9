//! Moving least squares at eight points at a time, one per lane: moment matrix, one factorisation, value and
//! gradient.
//!
//! With `p_I = p((x_I - x)/s)`, `A = sum_I w_I p_I p_I^T` and `c0 = A^-1 e0`, values are
//! `phi_I = c0.p_I w_I`. For gradients the basis is frozen at `x`: `c_a = A^-1 (e_a/s - A_,a c0)`,
//! `phi_I,a = c_a.p_I w_I + c0.p_I w_I,a`, with `A_,a c0` summed as a vector. Source: Belytschko, Krongauz,
//! Organ, Fleming and Krysl (1996), in local coordinates. For shape functions that leave a part of the
//! [`Moments`] to other functions, the remaining moments replace `e0` and their slopes replace `e_a/s`.

mod distances;

use lanes::{LANES, Lanes};
use shape::{Point3, Vector3};

use crate::basis::{PRODUCT, monomials, terms};
use crate::ellipsoid::Ellipsoid;
use crate::kernel::Kernel;
use crate::ldlt::{Ldlt, Matrices, norm};

/// Smallest pivot relative to its diagonal entry; rounding leaves 1e-16 if the neighbours do not span the
/// basis.
const PIVOT_TOLERANCE: f64 = 1e-10;

/// Largest accepted error of reproduction of the basis, in the 2-norm over its terms.
const REPRODUCTION_TOLERANCE: f64 = 1e-9;

/// A node and its support, adjacent in memory.
#[derive(Clone, Copy)]
pub(crate) struct Ball {
    pub(crate) at: [f64; 3],
    pub(crate) radius: f64,
}

impl Ball {
    /// Whether the support, `enlargement` times its radius, covers a point.
    #[inline(always)]
    pub(crate) fn covers(&self, x: &Point3, enlargement: f64) -> bool {
        let offset = [self.at[0] - x.x, self.at[1] - x.y, self.at[2] - x.z];
        let square = offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2];
        let radius = self.radius * enlargement;
        square < radius * radius
    }
}

/// Linear moments that the shape functions must have about the point `x`:
/// `values[i] = sum_I phi_I p_i(x_I - x)` and `slopes[i][a] = sum_I phi_I,a p_i(x_I - x)`, with the terms `p`
/// = 1, x, y, z and the axis `a`. Lengths are in metres.
#[derive(Clone, Copy)]
pub(crate) struct Moments {
    pub(crate) values: [f64; 4],
    pub(crate) slopes: [[f64; 3]; 4],
}

impl Moments {
    /// Moments of functions that reproduce linear fields without the help of finite elements.
    pub(crate) const COMPLETE: Moments = Moments {
        values: [1.0, 0.0, 0.0, 0.0],
        slopes: [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    };
}

/// Neighbours of eight points with derived quantities. Entry `k` of every list belongs to the `k`-th
/// neighbour of every point. The lists are reused from group to group, so the loop does not allocate.
#[derive(Default)]
pub(crate) struct Group {
    /// Number of neighbours of each point. All lists have the length of the longest, with zero weight beyond
    /// a point's own neighbours.
    counts: [usize; LANES],
    /// Offsets `x_I - x` by axis, m. Sums over offsets are scaled afterwards, once for all neighbours.
    offset: Vec<[Lanes; 3]>,
    /// Whether supports are ellipsoids.
    stretched: bool,
    /// `M_I (x_I - x)` of ellipsoids, 1/m: the direction in which the relative distance changes.
    normal: Vec<[Lanes; 3]>,
    /// Support radius (m), later `1/(d R)` (1/m^2). For an ellipsoid `1/q`. Zero at the node itself.
    chain: Vec<Lanes>,
    /// Relative distance `q = d/R`.
    relative: Vec<Lanes>,
    weight: Vec<Lanes>,
    /// `dw/dq`, later `-(dw/dq)/(d R) c0.p_I` (1/m^2), which times the offset is the contribution of the
    /// weight to the gradient. For an ellipsoid the factor is `-(dw/dq)/q c0.p_I`, and it multiplies the
    /// normal.
    slope: Vec<Lanes>,
    /// `c0.p_I`.
    fit: Vec<Lanes>,
    values: Vec<Lanes>,
    grads: Vec<[Lanes; 3]>,
    /// `s`, the largest support radius of a point's neighbours, m.
    scale: Lanes,
    moments: Matrices<4, 1>,
    moment_slopes: Matrices<4, 3>,
}

impl Group {
    /// Loads up to eight points with the neighbours whose supports, `enlargement` times their radii, cover
    /// them. `ellipsoids` is empty if the supports are balls.
    #[inline(always)]
    pub(crate) fn load<'a>(
        &mut self,
        points: impl Iterator<Item = (&'a Point3, &'a [u32])> + Clone,
        balls: &[Ball],
        ellipsoids: &[Ellipsoid],
        enlargement: f64,
    ) {
        self.counts = [0; LANES];
        for (count, (_, nodes)) in self.counts.iter_mut().zip(points.clone()) {
            *count = nodes.len();
        }
        let longest = self.longest();
        let lists = [&mut self.chain, &mut self.relative, &mut self.weight, &mut self.slope, &mut self.fit];
        for list in lists.into_iter().chain([&mut self.values]) {
            list.resize(longest, [0.0; LANES]);
        }
        for list in [&mut self.offset, &mut self.grads] {
            list.resize(longest, [[0.0; LANES]; 3]);
        }
        let (offset, chain) = (&mut self.offset[..longest], &mut self.chain[..longest]);
        let relative = &mut self.relative[..longest];
        for (l, (x, nodes)) in points.clone().enumerate() {
            for ((&node, offset), radius) in nodes.iter().zip(&mut *offset).zip(&mut *chain) {
                let ball = balls[node as usize];
                for axis in 0..3 {
                    offset[axis][l] = ball.at[axis] - x[axis];
                }
                radius[l] = ball.radius * enlargement;
            }
        }
        for l in 0..LANES {
            for k in self.counts[l]..longest {
                (offset[k][0][l], offset[k][1][l], offset[k][2][l], chain[k][l]) = (0.0, 0.0, 0.0, 0.0);
            }
        }
        let mut scale = [0.0; LANES];
        for k in 0..longest {
            let ([x, y, z], radius) = (offset[k], chain[k]);
            let (mut inverse, mut q) = ([0.0; LANES], [0.0; LANES]);
            for l in 0..LANES {
                let r = radius[l];
                scale[l] = if r > scale[l] { r } else { scale[l] };
                let square = x[l] * x[l] + y[l] * y[l] + z[l] * z[l];
                let product = square.sqrt() * r;
                // A quotient of selected numbers; a selected quotient would be compiled as a branch.
                let at_node = !(product > 0.0);
                inverse[l] = if at_node { 0.0 } else { 1.0 } / if at_node { 1.0 } else { product };
                // Rounding must not raise q above 1, because kernels written for q < 1 need not vanish there.
                q[l] = (square * inverse[l]).min(1.0);
            }
            (chain[k], relative[k]) = (inverse, q);
        }
        self.scale = scale;
        for l in 0..LANES {
            self.aim(l, &Moments::COMPLETE);
        }
        self.stretched = !ellipsoids.is_empty();
        if self.stretched {
            self.stretch(points, ellipsoids, enlargement);
        }
    }

    /// Sets the moments of a point's shape functions; [`Group::load`] sets [`Moments::COMPLETE`].
    #[inline(always)]
    pub(crate) fn aim(&mut self, lane: usize, moments: &Moments) {
        for i in 0..4 {
            self.moments[i][0][lane] = moments.values[i];
            for axis in 0..3 {
                self.moment_slopes[i][axis][lane] = moments.slopes[i][axis];
            }
        }
    }

    /// Returns the number of neighbours of a point.
    pub(crate) fn count(&self, lane: usize) -> usize {
        self.counts[lane]
    }

    fn longest(&self) -> usize {
        self.counts.into_iter().fold(0, usize::max)
    }

    /// Fits the `M`-term basis over the loaded neighbours: values, and gradients if `GRAD`. Returns the
    /// condition number of each matrix in the 1-norm, or `None` if it is singular to working precision.
    ///
    /// `PRODUCTS` is the number of monomials of twice the degree of the basis, `FLOWS` that of one more than
    /// the degree. `mu` regularises the quadratic block: `A + mu A_00 diag(0, .., 0, 1, .., 1)`, independent
    /// of scale and exact for linear fields at any `mu` (Joldes et al. 2015, modified MLS). For the linear
    /// basis, `mu` regularises the linear block.
    #[inline(always)]
    pub(crate) fn fit<const M: usize, const PRODUCTS: usize, const FLOWS: usize, const GRAD: bool>(
        &mut self,
        kernel: Kernel,
        mu: f64,
    ) -> [Option<f64>; LANES] {
        let longest = self.longest();
        self.weigh(kernel);
        let weight = &self.weight[..longest];
        let offset = &self.offset[..longest];

        let mut sums = [[0.0; LANES]; PRODUCTS];
        // The 35 sums of the quadratic basis exceed the number of registers (32 of AVX-512), and sums that
        // spill are stored at every neighbour. Two passes, of 20 and of 15 sums, take two thirds of the time.
        add_products::<PRODUCTS, 0, FLOWS>(&mut sums, weight, offset);
        add_products::<PRODUCTS, FLOWS, PRODUCTS>(&mut sums, weight, offset);
        let powers = powers::<M>(&self.scale);
        let mut a = [[[0.0; LANES]; M]; M];
        for i in 0..M {
            for j in 0..M {
                for l in 0..LANES {
                    a[i][j][l] = sums[PRODUCT[i][j]][l] * (powers[i][l] * powers[j][l]);
                }
            }
        }
        for i in if M > 4 { 4 } else { 1 }..M {
            for l in 0..LANES {
                a[i][i][l] += mu * a[0][0][l];
            }
        }
        let ldlt = Ldlt::new(&a, PIVOT_TOLERANCE);
        let mut right = [[[0.0; LANES]]; M];
        for i in 0..4 {
            for l in 0..LANES {
                right[i][0][l] = self.moments[i][0][l] * powers[i][l];
            }
        }
        let mut c0 = right;
        ldlt.solve(&mut c0);
        let condition = conditions(&a, &right, &c0, &ldlt);
        if GRAD {
            self.with_gradients::<M, FLOWS>(&ldlt, &c0, &powers, mu);
        } else {
            let values = &mut self.values[..longest];
            let c = scaled(&c0, &powers);
            for k in 0..longest {
                let (w, [x, y, z]) = (weight[k], offset[k]);
                let mut value = [0.0; LANES];
                for l in 0..LANES {
                    value[l] = w[l] * dot(&c, 0, l, &terms([x[l], y[l], z[l]]));
                }
                values[k] = value;
            }
        }
        condition
    }

    /// Computes the weights and their slopes.
    #[inline(always)]
    fn weigh(&mut self, kernel: Kernel) {
        let longest = self.longest();
        kernel.eval_all(
            self.relative[..longest].as_flattened(),
            self.weight[..longest].as_flattened_mut(),
            self.slope[..longest].as_flattened_mut(),
        );
        for l in 0..LANES {
            for k in self.counts[l]..longest {
                (self.weight[k][l], self.slope[k][l]) = (0.0, 0.0);
            }
        }
    }

    /// Computes values and gradients from the factors and `c0`.
    #[inline(always)]
    fn with_gradients<const M: usize, const FLOWS: usize>(
        &mut self,
        ldlt: &Ldlt<M>,
        c0: &Matrices<M, 1>,
        powers: &[Lanes; M],
        mu: f64,
    ) {
        let longest = self.longest();
        let c = scaled(c0, powers);
        let (flows, spread) =
            if self.stretched { self.stretched_flows(&c) } else { self.flows::<M, FLOWS>(&c) };
        let mut ca = [[[0.0; LANES]; 3]; M];
        for i in 0..M {
            for axis in 0..3 {
                for l in 0..LANES {
                    let extra = if i < 4 { 0.0 } else { mu * spread[axis][l] * c0[i][0][l] };
                    let slope = if i < 4 { self.moment_slopes[i][axis][l] * powers[i][l] } else { 0.0 };
                    ca[i][axis][l] = slope - (flows[i][axis][l] * powers[i][l] + extra);
                }
            }
        }
        ldlt.solve(&mut ca);
        let ca = scaled(&ca, powers);
        let (weight, slope, offset) =
            (&self.weight[..longest], &self.slope[..longest], &self.offset[..longest]);
        let direction = if self.stretched { &self.normal[..longest] } else { offset };
        let grads = &mut self.grads[..longest];
        for k in 0..longest {
            let (w, [x, y, z], flow, along) = (weight[k], offset[k], slope[k], direction[k]);
            let mut grad = [[0.0; LANES]; 3];
            for l in 0..LANES {
                let p = terms([x[l], y[l], z[l]]);
                for axis in 0..3 {
                    grad[axis][l] = w[l] * dot(&ca, axis, l, &p) + flow[l] * along[axis][l];
                }
            }
            grads[k] = grad;
        }
    }

    /// Computes the values, and the derivative of the moment matrix times `c0`, by term and axis; `spread` is
    /// that of `A_00` alone.
    #[inline(always)]
    fn flows<const M: usize, const FLOWS: usize>(
        &mut self,
        c: &Matrices<M, 1>,
    ) -> (Matrices<M, 3>, [Lanes; 3]) {
        let longest = self.longest();
        let (weight, chain) = (&self.weight[..longest], &self.chain[..longest]);
        let (slope, fit, values) =
            (&mut self.slope[..longest], &mut self.fit[..longest], &mut self.values[..longest]);
        let offset = &self.offset[..longest];
        // A_,a c0: the basis is frozen, so only the weights change with x; grad w_I = -(dw/dq)/(d R) (x_I -
        // x).
        let (mut sums, mut spread) = ([[0.0; LANES]; FLOWS], [[0.0; LANES]; 3]);
        for k in 0..longest {
            let (w, [x, y, z]) = (weight[k], offset[k]);
            let (dw, inverse) = (slope[k], chain[k]);
            let (mut of_point, mut value, mut flow) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
            for l in 0..LANES {
                let at = [x[l], y[l], z[l]];
                let fit = dot(c, 0, l, &terms(at));
                let g = -dw[l] * inverse[l];
                of_point[l] = fit;
                value[l] = w[l] * fit;
                flow[l] = g * fit;
                for axis in 0..3 {
                    spread[axis][l] += g * at[axis];
                }
                add_to_lane::<FLOWS, 0, FLOWS>(&mut sums, l, &monomials(flow[l], at));
            }
            (fit[k], values[k], slope[k]) = (of_point, value, flow);
        }
        let mut flows = [[[0.0; LANES]; 3]; M];
        for i in 0..M {
            for axis in 0..3 {
                flows[i][axis] = sums[PRODUCT[i][axis + 1]];
            }
        }
        (flows, spread)
    }

    /// Computes [`Group::flows`] for weights that change along the normals of ellipsoids. Normals are not
    /// monomials, so separate sums are needed.
    #[inline(always)]
    fn stretched_flows<const M: usize>(&mut self, c: &Matrices<M, 1>) -> (Matrices<M, 3>, [Lanes; 3]) {
        let longest = self.longest();
        let mut flows = [[[0.0; LANES]; 3]; M];
        let mut spread = [[0.0; LANES]; 3];
        for k in 0..longest {
            let (w, [x, y, z], normal) = (self.weight[k], self.offset[k], self.normal[k]);
            let (dw, inverse) = (self.slope[k], self.chain[k]);
            let (mut of_point, mut value, mut flow) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
            for l in 0..LANES {
                let p = terms([x[l], y[l], z[l]]);
                let fit = dot(c, 0, l, &p);
                let g = -dw[l] * inverse[l];
                of_point[l] = fit;
                value[l] = w[l] * fit;
                flow[l] = g * fit;
                for axis in 0..3 {
                    spread[axis][l] += g * normal[axis][l];
                    for i in 0..M {
                        flows[i][axis][l] += flow[l] * normal[axis][l] * p[i];
                    }
                }
            }
            (self.fit[k], self.values[k], self.slope[k]) = (of_point, value, flow);
        }
        (flows, spread)
    }

    /// Writes the values of a point, and its gradients (1/m) if there is room for them.
    #[inline(always)]
    pub(crate) fn store(&self, lane: usize, values: &mut [f64], grads: &mut [Vector3]) {
        for (value, of_lanes) in values.iter_mut().zip(&self.values) {
            *value = of_lanes[lane];
        }
        for (grad, [x, y, z]) in grads.iter_mut().zip(&self.grads) {
            *grad = Vector3::new(x[lane], y[lane], z[lane]);
        }
    }
}

/// Returns `s` to the minus degree of each term, which converts sums over offsets to sums over scaled
/// offsets.
#[inline(always)]
fn powers<const M: usize>(scale: &Lanes) -> [Lanes; M] {
    let mut powers = [[1.0; LANES]; M];
    for i in 1..M {
        for l in 0..LANES {
            let inverse = 1.0 / scale[l];
            powers[i][l] = if i < 4 { inverse } else { inverse * inverse };
        }
    }
    powers
}

/// Multiplies every row by its power, which converts coefficients of scaled offsets to those of offsets.
#[inline(always)]
fn scaled<const M: usize, const K: usize>(c: &Matrices<M, K>, powers: &[Lanes; M]) -> Matrices<M, K> {
    let mut scaled = *c;
    for i in 0..M {
        for k in 0..K {
            for l in 0..LANES {
                scaled[i][k][l] *= powers[i][l];
            }
        }
    }
    scaled
}

/// Returns the product of a column in a lane with the terms.
#[inline(always)]
fn dot<const M: usize, const K: usize>(c: &Matrices<M, K>, column: usize, l: usize, p: &[f64; M]) -> f64 {
    let mut sum = 0.0;
    for i in 0..M {
        sum += c[i][column][l] * p[i];
    }
    sum
}

/// Adds the weighted monomials from `FIRST` to `END` of all neighbours.
#[inline(always)]
fn add_products<const N: usize, const FIRST: usize, const END: usize>(
    sums: &mut [Lanes; N],
    weight: &[Lanes],
    offset: &[[Lanes; 3]],
) {
    let mut local = *sums;
    for (&w, &[x, y, z]) in weight.iter().zip(offset) {
        // The compiler knows that local numbers do not overlap; otherwise the loop over lanes would not be
        // vectorised.
        for l in 0..LANES {
            add_to_lane::<N, FIRST, END>(&mut local, l, &monomials(w[l], [x[l], y[l], z[l]]));
        }
    }
    *sums = local;
}

#[inline(always)]
fn add_to_lane<const N: usize, const FIRST: usize, const END: usize>(
    sums: &mut [Lanes; N],
    l: usize,
    terms: &[f64; N],
) {
    for n in FIRST..END {
        sums[n][l] += terms[n];
    }
}

/// Returns the condition number of each matrix, or `None` if `c0` is invalid.
#[inline(always)]
fn conditions<const M: usize>(
    a: &Matrices<M, M>,
    right: &Matrices<M, 1>,
    c0: &Matrices<M, 1>,
    ldlt: &Ldlt<M>,
) -> [Option<f64>; LANES] {
    let mut residual = [0.0; LANES];
    for i in 0..M {
        let mut row = right[i][0].map(|r| -r);
        for j in 0..M {
            for l in 0..LANES {
                row[l] += a[i][j][l] * c0[j][0][l];
            }
        }
        for l in 0..LANES {
            // NaN must be detected: a sum of squares keeps NaN, a maximum would not.
            residual[l] += row[l] * row[l];
        }
    }
    let norm = norm(a);
    let inverse_norm = ldlt.inverse_norm();
    let mut conditions = [None; LANES];
    for l in 0..LANES {
        if ldlt.is_sound(l) && residual[l] < REPRODUCTION_TOLERANCE * REPRODUCTION_TOLERANCE {
            conditions[l] = Some(norm[l] * inverse_norm[l]);
        }
    }
    conditions
}
