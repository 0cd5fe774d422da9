#![allow(non_snake_case)] // K, D, M as in the formulas
//! Linear system of one Newton iteration: symbolic structure computed once, values at every iteration.

use algebra::{BlockPattern, Incidence, Stiffness, Symmetric};
use lanes::LanePath;
use rayon::prelude::*;
use shape::{Matrix3, Vector3};

use super::basis::Basis;
use super::energy::{Hessian, Internal};
use super::following::{FollowingLoad, Pressed};
use super::groups::Pairs;
use super::lanes::{BlockSum, Vector4, group_products, point_products};
use super::solid::{Solid, SolidDilation};
use super::sorted_rows::Sorted;

/// Index that marks a constrained degree of freedom among the unknowns.
pub(crate) const CONSTRAINED: usize = usize::MAX;

/// Number of gradients of points that the rows of a task traverse together. With the tangents of their points
/// they take at most 500 KB, which stay in the second-level cache.
const TILE: usize = 4096;

/// Shape values on a surface (or at the points of any quadrature that needs values only) with weights, ready
/// for assembly.
#[derive(Clone, Debug)]
pub(crate) struct SurfaceTable {
    pub rows: Sorted<f64>,
    pub weights: Vec<f64>,
    of_node: Incidence,
}

impl SurfaceTable {
    pub fn new(surface: &shape::SurfaceRows) -> SurfaceTable {
        SurfaceTable::weighted(surface.rows(), surface.weights().to_vec())
    }

    /// Builds a table of any shape values with separate weights.
    pub fn weighted(rows: &shape::Rows, weights: Vec<f64>) -> SurfaceTable {
        let sorted = Sorted::new((0..rows.len()).map(|q| {
            let (nodes, values) = rows.row(q);
            nodes.iter().copied().zip(values.iter().copied())
        }));
        let of_node = sorted.incidence(rows.node_count());
        SurfaceTable { rows: sorted, weights, of_node }
    }

    /// Builds a table with one point at each node: the shape value 1 and the given weight (kg for a mass).
    pub fn nodal(weights: Vec<f64>) -> SurfaceTable {
        let rows = Sorted::new((0..weights.len() as u32).map(|i| std::iter::once((i, 1.0))));
        let of_node = rows.incidence(weights.len());
        SurfaceTable { rows, weights, of_node }
    }

    /// Returns `sum_q w N_I^2` of every node.
    pub fn diagonal(&self, nodes: usize) -> Vec<f64> {
        let entry = |&(q, k): &(u32, u32)| self.weights[q as usize] * self.rows.data[k as usize].powi(2);
        (0..nodes).map(|i| self.of_node.of(i).iter().map(entry).sum()).collect()
    }

    /// Returns the displacement at the surface points, m.
    pub fn displacement(&self, u: &[Vector3]) -> Vec<Vector3> {
        (0..self.rows.len())
            .into_par_iter()
            .with_min_len(256)
            .map(|q| {
                let (nodes, values) = self.rows.row(q);
                nodes.iter().zip(values).map(|(&n, v)| u[n as usize] * *v).sum()
            })
            .collect()
    }

    /// Returns the nodal forces (N) of springs to the ground with the weights (N/m) as stiffness, at
    /// displacements `u` (m), and their energy, J.
    pub fn spring_forces(&self, u: &[Vector3]) -> (Vec<Vector3>, f64) {
        let at = self.displacement(u);
        let energy = at.iter().zip(&self.weights).map(|(at, w)| 0.5 * w * at.norm_squared()).sum();
        let mut force = vec![Vector3::zeros(); u.len()];
        self.add_force(&at, &mut force);
        (force, energy)
    }

    /// Adds the stiffness of these springs to row `i` of the lower triangle of a matrix.
    pub fn add_springs(&self, i: usize, slot: &[u32], row: &mut [Matrix3]) {
        for &(q, k) in self.of_node.of(i) {
            let (q, k) = (q as usize, k as usize);
            let stiffness = self.weights[q] * self.rows.data[k];
            for j in self.rows.offsets[q]..=k {
                let entry = stiffness * self.rows.data[j];
                let block = &mut row[slot[self.rows.nodes[j] as usize] as usize];
                (0..3).for_each(|a| block[(a, a)] += entry);
            }
        }
    }

    /// Adds the nodal forces `sum_q w N t` of a traction to `force`.
    pub fn add_force(&self, traction: &[Vector3], force: &mut [Vector3]) {
        force.par_iter_mut().with_min_len(64).enumerate().for_each(|(i, force)| {
            for &(q, k) in self.of_node.of(i) {
                let q = q as usize;
                *force += traction[q] * (self.weights[q] * self.rows.data[k as usize]);
            }
        });
    }
}

/// Stiffness of the surfaces of a system.
#[derive(Default)]
pub(crate) struct SurfaceStiffness {
    /// By surface, for every point, N/m: `-w dt/dx` with the weight `w`, the traction `t` and the position
    /// `x`.
    pub blocks: Vec<Vec<Matrix3>>,
    /// By load on the deformed surface.
    pub pressed: Vec<Pressed>,
}

/// Skew part of a tangent.
pub(crate) struct Skew {
    /// (surface, point, block in N/m) for every sliding point.
    points: Vec<(usize, usize, Matrix3)>,
    /// Pairs of nodes i <= j under a load on the deformed surface, each with its block (N/m).
    pairs: Vec<([u32; 2], Matrix3)>,
}

impl Skew {
    /// Whether the tangent is symmetric.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty() && self.pairs.is_empty()
    }
}

/// Structure of the system of a solid with loaded or constrained surfaces.
pub(crate) struct System<'a> {
    solid: Solid<'a>,
    pub pairs: Option<Pairs>,
    /// Gradients, 1/m, each padded with a zero.
    points: Sorted<Vector4>,
    points_of: Incidence,
    groups_of: Option<Incidence>,
    /// For each pressure node, its pairs (point, value).
    pressure_of: Vec<Vec<(u32, f64)>>,
    pub surfaces: Vec<SurfaceTable>,
    /// Springs of hourglass control, whose nodes at each point are those of the solid's points.
    pub springs: Option<SurfaceTable>,
    following: &'a [FollowingLoad],
    /// The last assembled tangent of the displacements.
    pub stiffness: Stiffness,
    /// Index of each degree of freedom among the unknowns, [`CONSTRAINED`] if prescribed; pressures follow.
    pub place: Vec<usize>,
    /// Number of free displacement degrees of freedom, or of modes.
    pub free: usize,
    /// Scale of the pressure unknowns, Pa. Unscaled pressure entries of the matrix are 1e-15 of a stiffness,
    /// and the static regularisation would swamp them.
    pub pressure_scale: f64,
    /// Whether the tangent is assembled transposed.
    pub transposed: bool,
    /// Modes whose coefficients are the unknowns; `None` for the free degrees of freedom.
    basis: Option<&'a Basis>,
}

impl<'a> System<'a> {
    pub fn new(
        solid: Solid<'a>,
        constrained: &[bool],
        surfaces: Vec<SurfaceTable>,
        following: &'a [FollowingLoad],
    ) -> System<'a> {
        let nodes = solid.node_count();
        let rows = solid.volume.rows();
        let points = Sorted::new((0..rows.len()).map(|q| {
            let (nodes, grads) = solid.volume.row(q);
            nodes.iter().copied().zip(grads.iter().map(|g| g.push(0.0)))
        }));
        let points_of = points.incidence(nodes);
        let pairs = solid.pairs();
        let groups = pairs.as_ref().map(Pairs::connectivity);
        let groups_of = groups.map(|groups| Incidence::new(nodes, groups, 0..groups.offsets.len() - 1));
        let mut pressure_of = vec![Vec::new(); solid.pressure_count()];
        if let SolidDilation::Mixed(pressure) = solid.dilation {
            for q in 0..pressure.len() {
                let (nodes, values) = pressure.row(q);
                nodes
                    .iter()
                    .zip(values)
                    .filter(|(_, v)| **v != 0.0)
                    .for_each(|(&m, &v)| pressure_of[m as usize].push((q as u32, v)));
            }
        }
        let mut tables = vec![(points.connectivity(), &points_of)];
        tables.extend(groups.zip(groups_of.as_ref()));
        tables.extend(surfaces.iter().map(|s| (s.rows.connectivity(), &s.of_node)));
        tables.extend(following.iter().map(FollowingLoad::pattern));
        let stiffness = Stiffness::zeros(BlockPattern::new(nodes, &tables));
        let mut free = 0;
        let place = constrained
            .iter()
            .map(|&constrained| {
                if constrained {
                    return CONSTRAINED;
                }
                free += 1;
                free - 1
            })
            .collect();
        System {
            solid,
            pairs,
            points,
            points_of,
            groups_of,
            pressure_of,
            surfaces,
            springs: None,
            following,
            stiffness,
            place,
            free,
            pressure_scale: 1.0,
            transposed: false,
            basis: None,
        }
    }

    /// Makes the coefficients of modes the unknowns.
    pub fn restricted(self, basis: Option<&'a Basis>) -> System<'a> {
        System { free: basis.map_or(self.free, Basis::len), basis, ..self }
    }

    /// Number of unknowns: free displacements and pressures.
    pub fn dim(&self) -> usize {
        self.free + self.pressure_of.len()
    }

    /// Returns the internal nodal forces `sum_q (w P) grad N`, N.
    pub fn internal_force(&self, internal: &Internal) -> Vec<Vector3> {
        (0..self.solid.node_count())
            .into_par_iter()
            .with_min_len(8)
            .map(|i| {
                (self.points_of.of(i).iter())
                    .map(|&(q, k)| internal.stress[q as usize] * self.points.data[k as usize].xyz())
                    .sum()
            })
            .collect()
    }

    /// Returns the derivative of the energy with respect to each pressure parameter, m^3.
    pub fn pressure_gradient(&self, internal: &Internal) -> Vec<f64> {
        (self.pressure_of.iter())
            .map(|seen| seen.iter().map(|&(q, v)| v * internal.misfit[q as usize]).sum())
            .collect()
    }

    /// Assembles the tangent of the displacements from the second derivatives `hessian` of the energy and the
    /// symmetric part of the stiffness of the surfaces. Point `q` of surface `s` adds `N_I N_J D` to the
    /// block of the nodes I and J, with the symmetric part `D` of `surface.blocks[s][q]`.
    pub fn assemble(&mut self, hessian: &Hessian, surface: &SurfaceStiffness) {
        let System { pairs, points, points_of, groups_of, surfaces, springs, following, stiffness, .. } =
            self;
        let groups = pairs.as_ref().map(Pairs::connectivity).zip(groups_of.as_ref());
        let path = LanePath::best();
        let gather = |seen: &[(u32, u32)], slot: &[u32], sums: &mut [BlockSum]| {
            point_products(path, points, &hessian.point, seen, slot, sums);
        };
        let all = 0..points.len();
        let per_tile = TILE * points.len() / points.nodes.len().max(1) + 1;
        stiffness.by_tiles(points_of, &[all], per_tile, BlockSum::ZERO, gather, |_, i, slot, sums, row| {
            if let Some((nodes, of)) = groups {
                group_products(path, nodes, &hessian.groups, of.of(i), slot, sums);
            }
            for (block, sum) in row.iter_mut().zip(sums) {
                *block = std::mem::replace(sum, BlockSum::ZERO).block();
            }
            if let Some(springs) = &*springs {
                springs.add_springs(i, slot, row);
            }
            for (table, blocks) in surfaces.iter().zip(&surface.blocks) {
                for &(q, k) in table.of_node.of(i) {
                    let (q, k) = (q as usize, k as usize);
                    let D = (blocks[q] + blocks[q].transpose()) * (0.5 * table.rows.data[k]);
                    if D == Matrix3::zeros() {
                        continue;
                    }
                    for j in table.rows.offsets[q]..=k {
                        row[slot[table.rows.nodes[j] as usize] as usize] += D * table.rows.data[j];
                    }
                }
            }
            for (pressure, pressed) in following.iter().zip(&surface.pressed) {
                pressure.symmetric_part(pressed, i, |j, block| row[slot[j as usize] as usize] += block);
            }
        });
    }

    /// Returns the upper triangle of the assembled tangent over the free degrees of freedom, followed by the
    /// pressures.
    pub fn reduced(&mut self, hessian: &Hessian) -> Symmetric {
        let mut matrix = Symmetric::displacements(&self.stiffness, &self.place, self.free);
        let nodes = self.solid.node_count();
        let mut sum = vec![Vector3::zeros(); nodes];
        let mut pressure_sum = vec![0.0; self.pressure_of.len()];
        let SolidDilation::Mixed(pressure) = self.solid.dilation else { return matrix };
        for (m, seen) in self.pressure_of.iter().enumerate() {
            let (mut touched, mut partners) = (Vec::new(), Vec::new());
            for &(q, v) in seen {
                let q = q as usize;
                let (B, c) = &hessian.pressure[q];
                let (row, grads) = self.points.row(q);
                for (&node, g) in row.iter().zip(grads) {
                    touched.push(node);
                    sum[node as usize] += B * g.xyz() * v;
                }
                let (row, values) = pressure.row(q);
                for (&other, w) in row.iter().zip(values).filter(|(o, w)| **o as usize <= m && **w != 0.0) {
                    partners.push(other);
                    pressure_sum[other as usize] -= c * v * w;
                }
            }
            touched.sort_unstable();
            touched.dedup();
            for node in touched {
                let value = std::mem::replace(&mut sum[node as usize], Vector3::zeros());
                for a in 0..3 {
                    let at = self.place[3 * node as usize + a];
                    if at != CONSTRAINED {
                        matrix.rows.push(at);
                        matrix.values.push(value[a]);
                    }
                }
            }
            partners.sort_unstable();
            partners.dedup();
            for other in partners {
                matrix.rows.push(self.free + other as usize);
                matrix.values.push(std::mem::take(&mut pressure_sum[other as usize]));
            }
            matrix.offsets.push(matrix.rows.len());
            matrix.vertices.push(matrix.offsets.len() - 1);
        }
        let largest = |values: &[f64]| values.iter().fold(0.0f64, |l, v| l.max(v.abs()));
        let (stiffness, coupling) = matrix.values.split_at(matrix.offsets[self.free]);
        let scale = largest(stiffness) / largest(coupling);
        self.pressure_scale = if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        for j in self.free..matrix.dim() {
            for k in matrix.offsets[j]..matrix.offsets[j + 1] {
                let both = matrix.rows[k] >= self.free;
                matrix.values[k] *= if both { self.pressure_scale.powi(2) } else { self.pressure_scale };
            }
        }
        matrix
    }

    /// Returns the skew part of the stiffness of the surfaces.
    pub fn skew(&self, surface: &SurfaceStiffness) -> Skew {
        let half = if self.transposed { -0.5 } else { 0.5 };
        let of_table = |(s, blocks): (usize, &Vec<Matrix3>)| {
            let skew = move |(q, block): (usize, &Matrix3)| (s, q, (block - block.transpose()) * half);
            blocks
                .iter()
                .enumerate()
                .map(skew)
                .filter(|point| point.2 != Matrix3::zeros())
                .collect::<Vec<_>>()
        };
        let pressed = self.following.iter().zip(&surface.pressed);
        let pairs = pressed.flat_map(|(pressure, pressed)| pressure.skew_part(pressed));
        let turned = |(nodes, block): (_, Matrix3)| (nodes, if self.transposed { -block } else { block });
        Skew {
            points: surface.blocks.iter().enumerate().flat_map(of_table).collect(),
            pairs: pairs.map(turned).collect(),
        }
    }

    /// Adds the product with the skew part of a tangent to `out`, N.
    pub fn add_skew(&self, skew: &Skew, u: &[Vector3], out: &mut [Vector3]) {
        for &(s, q, block) in &skew.points {
            let (nodes, values) = self.surfaces[s].rows.row(q);
            let at: Vector3 = nodes.iter().zip(values).map(|(&node, v)| u[node as usize] * *v).sum();
            let force = block * at;
            nodes.iter().zip(values).for_each(|(&node, v)| out[node as usize] += force * *v);
        }
        for &([i, j], block) in &skew.pairs {
            let (i, j) = (i as usize, j as usize);
            out[i] += block * u[j];
            if i != j {
                out[j] -= block.transpose() * u[i];
            }
        }
    }

    /// Returns the entries `(row, column, value)` of the skew part of a tangent, to be added to the symmetric
    /// matrix.
    pub fn entries(&self, skew: &Skew) -> Vec<(usize, usize, f64)> {
        let mut entries = Vec::new();
        let mut add = |i: u32, j: u32, block: &Matrix3, [vi, vj]: [f64; 2]| {
            let diagonal = [(0, 0), (1, 1), (2, 2)].into_iter().filter(|at| block[*at] != 0.0);
            for (a, b) in [(0, 1), (0, 2), (1, 2), (1, 0), (2, 0), (2, 1)].into_iter().chain(diagonal) {
                let (row, column) = (self.place[3 * i as usize + a], self.place[3 * j as usize + b]);
                if row != CONSTRAINED && column != CONSTRAINED {
                    entries.push((row, column, block[(a, b)] * vi * vj));
                }
            }
        };
        for (s, q, block) in &skew.points {
            let (nodes, values) = self.surfaces[*s].rows.row(*q);
            for (&i, vi) in nodes.iter().zip(values) {
                for (&j, vj) in nodes.iter().zip(values) {
                    add(i, j, block, [*vi, *vj]);
                }
            }
        }
        for &([i, j], block) in &skew.pairs {
            add(i, j, &block, [1.0; 2]);
            if i != j {
                add(j, i, &-block.transpose(), [1.0; 2]);
            }
        }
        entries
    }

    /// Returns the vector of unknowns: the free components of the nodal vectors `nodal`, or their parts along
    /// the modes, then the values
    /// `pressure`, one per pressure parameter. Nothing is multiplied by [`System::pressure_scale`].
    pub fn gather(&self, nodal: &[Vector3], pressure: &[f64]) -> Vec<f64> {
        if let Some(basis) = self.basis {
            return basis.project(nodal);
        }
        let mut out = vec![0.0; self.dim()];
        for (dof, &at) in self.place.iter().enumerate().filter(|(_, at)| **at != CONSTRAINED) {
            out[at] = nodal[dof / 3][dof % 3];
        }
        out[self.free..].copy_from_slice(pressure);
        out
    }

    /// Adds `factor` times the increments `step` of the unknowns to the nodal vectors `nodal` and the values
    /// `pressure`; the inverse of [`System::gather`]. Constrained components remain unchanged.
    pub fn scatter_add(&self, step: &[f64], factor: f64, nodal: &mut [Vector3], pressure: &mut [f64]) {
        if let Some(basis) = self.basis {
            return basis.add_to(step, factor, nodal);
        }
        for (dof, &at) in self.place.iter().enumerate().filter(|(_, at)| **at != CONSTRAINED) {
            nodal[dof / 3][dof % 3] += factor * step[at];
        }
        for (p, s) in pressure.iter_mut().zip(&step[self.free..]) {
            *p += factor * s;
        }
    }

    /// Returns the nodal forces `K du` (N) of the increments `du` (m) of the constrained degrees of
    /// freedom, to be subtracted from the right-hand side of the free degrees of freedom.
    pub fn held_part(&self, step: &[Vector3]) -> Vec<Vector3> {
        self.stiffness.multiply(step)
    }

    /// Subtracts the volume changes (m^3) due to the increments `step` (m) of the constrained degrees of
    /// freedom from the right-hand side `right` of the pressures.
    pub fn subtract_held_pressure(&self, hessian: &Hessian, step: &[Vector3], right: &mut [f64]) {
        if right.is_empty() {
            return;
        }
        let of_point: Vec<f64> = (hessian.pressure.iter().enumerate())
            .map(|(q, (B, _))| {
                let (nodes, grads) = self.points.row(q);
                nodes.iter().zip(grads).map(|(&n, g)| (B * g.xyz()).dot(&step[n as usize])).sum()
            })
            .collect();
        for (right, seen) in right.iter_mut().zip(&self.pressure_of) {
            *right -= seen.iter().map(|&(q, v)| v * of_point[q as usize]).sum::<f64>();
        }
    }
}
