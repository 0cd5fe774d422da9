//! Remedies ("ladder") at points whose neighbours do not determine the basis.

use shape::{Point3, Vector3};

use super::{Approximation, Chunk, LeastSquares};
use crate::basis::Basis;
use crate::coupling::Layer;
use crate::detour::Detour;
use crate::error::EfgError;
use crate::info::Outcome;
use crate::mls::{Group, Moments};
use crate::row_list::RowList;

/// Ratio of an enlarged support to the distance of the neighbour whose number is twice that of the basis
/// terms.
const BEYOND_NEIGHBOUR: f64 = 1.4;
/// Largest enlargement of supports; a point that needs more is not near the cloud.
const MOST_ENLARGEMENT: f64 = 3.0;
/// Regularisation of the quadratic block as a remedy, relative to the sum of the weights.
const REGULARISATION: f64 = 1e-7;
/// Regularisation of the linear block for neighbours in one plane: ten times the smallest pivot.
const FLAT: f64 = 1e-9;
/// Tolerance of the moments in this case, relative to the largest radius. Rounding leaves less for moments in
/// the plane.
const MISSED: f64 = 1e-6;

impl Approximation {
    /// Applies the remedies at the points of a chunk whose plain fit failed, and inserts their rows among the
    /// others.
    #[cold]
    pub(super) fn mend<const GRAD: bool>(
        &self,
        points: &[Point3],
        fit: &LeastSquares,
        chunk: &mut Chunk,
    ) -> Result<(), EfgError> {
        let plain = std::mem::take(&mut chunk.rows);
        let rows = &mut chunk.rows;
        for (q, x) in points.iter().enumerate() {
            if chunk.outcomes[q].condition < f64::INFINITY {
                let range = plain.range(q);
                rows.nodes.extend_from_slice(&plain.nodes[range.clone()]);
                rows.values.extend_from_slice(&plain.values[range.clone()]);
                rows.grads.extend_from_slice(if GRAD { &plain.grads[range] } else { &[] });
                rows.close();
            } else {
                let layer = chunk.layers.get(q);
                let cell = chunk.cells.get(q).copied();
                chunk.outcomes[q] = self.climb::<GRAD>(x, layer, cell, fit, &mut chunk.group, rows)?;
            }
        }
        Ok(())
    }

    /// Applies the remedies at a point whose plain fit failed, and appends its row.
    fn climb<const GRAD: bool>(
        &self,
        x: &Point3,
        layer: Option<&Layer>,
        cell: Option<u32>,
        asked: &LeastSquares,
        group: &mut Group,
        rows: &mut RowList,
    ) -> Result<Outcome, EfgError> {
        let needed = asked.basis.terms();
        let counts = |node: &u32| layer.is_none_or(|layer| self.counts_in(*node, layer));
        let detours = self.detours(x, cell);
        let relative = |node: u32| match detours.get(node as usize) {
            Some(longer) => self.relative(node, x) + longer / self.radius(node as usize),
            None => self.relative(node, x),
        };
        let enlargement =
            enlargement(relative, (0..self.supports.balls.len() as u32).filter(counts), 2 * needed);
        let covers = |&node: &u32| match self.supports.ellipsoids.is_empty() && detours.is_empty() {
            true => self.supports.balls[node as usize].covers(x, enlargement),
            false => relative(node) < enlargement,
        };
        let nodes: Vec<u32> = (0..self.supports.balls.len() as u32).filter(counts).filter(covers).collect();
        let found = nodes.len();
        group.load(
            std::iter::once((x, &nodes[..])),
            &self.supports.balls,
            &self.supports.ellipsoids,
            enlargement,
        );
        if !detours.is_empty() {
            let longer = |&node: &u32| detours[node as usize] / (self.radius(node as usize) * enlargement);
            let detour = |node| Detour { longer: longer(node), slope: Vector3::zeros() };
            group.bend(std::iter::once(&nodes.iter().map(detour).collect::<Vec<_>>()[..]));
        }
        let moments = layer.map_or(Moments::COMPLETE, |layer| layer.moments);
        group.aim(0, &moments);
        let rungs: &[(Basis, f64)] = match asked.basis {
            // Next to elements the required moments may lie in the plane of the neighbours. A regularised fit
            // then suffices.
            Basis::Linear if layer.is_some_and(|layer| !layer.is_empty()) => {
                &[(Basis::Linear, 0.0), (Basis::Linear, FLAT)]
            }
            Basis::Linear => &[(Basis::Linear, 0.0)],
            Basis::Quadratic => &[
                (Basis::Quadratic, asked.mu),
                (Basis::Quadratic, asked.mu.max(REGULARISATION)),
                (Basis::Linear, 0.0),
            ],
        };
        for &(basis, mu) in rungs {
            if let Some(condition) = self.fit::<GRAD>(&LeastSquares { basis, mu, ..*asked }, group)[0] {
                if mu == FLAT && self.missed(x, &nodes, group, &moments) > MISSED {
                    continue;
                }
                let first = rows.values.len();
                rows.nodes.extend_from_slice(&nodes);
                rows.close();
                rows.values.resize(first + found, 0.0);
                rows.grads.resize(if GRAD { first + found } else { 0 }, Vector3::zeros());
                let grads = if GRAD { &mut rows.grads[first..] } else { &mut [] };
                group.store(0, &mut rows.values[first..], grads);
                return Ok(Outcome {
                    neighbours: found as u32,
                    condition,
                    enlarged: enlargement > 1.0,
                    regularised: mu > asked.mu,
                    reduced: basis != asked.basis,
                });
            }
        }
        let point = *x;
        if found < Basis::Linear.terms() {
            Err(EfgError::TooFewNeighbours { point, found, needed, enlargement })
        } else {
            Err(EfgError::SingularMoment { point, found, needed, enlargement })
        }
    }

    /// Returns the error of the moments of the first point of a group, relative to the largest radius.
    fn missed(&self, x: &Point3, nodes: &[u32], group: &Group, moments: &Moments) -> f64 {
        let mut values = vec![0.0; nodes.len()];
        group.store(0, &mut values, &mut []);
        let mut left = moments.values;
        let mut scale = 0.0_f64;
        for (&node, value) in nodes.iter().zip(&values) {
            let e = self.nodes[node as usize] - x;
            scale = scale.max(self.supports.balls[node as usize].radius);
            left.iter_mut().zip([1.0, e.x, e.y, e.z]).for_each(|(left, p)| *left -= value * p);
        }
        left[0].abs().max(left[1..].iter().fold(0.0, |most, l| l.abs().max(most)) / scale)
    }

    /// Returns the detours from a point to all nodes, m. The list is empty for a body without gaps.
    fn detours(&self, x: &Point3, cell: Option<u32>) -> Vec<f64> {
        let (Some(gaps), Some(cell)) = (&self.gaps, cell) else { return Vec::new() };
        gaps.detours(
            x,
            cell,
            &self.nodes[..self.supports.balls.len()],
            MOST_ENLARGEMENT * self.supports.widest(),
        )
    }
}

/// Returns the factor on all support radii at which `count` of the nodes (all, if there are fewer) cover a
/// point with a margin, from their relative distances.
fn enlargement(relative: impl Fn(u32) -> f64, nodes: impl Iterator<Item = u32>, count: usize) -> f64 {
    let mut ratios: Vec<f64> = nodes.map(relative).collect();
    let Some(last) = count.min(ratios.len()).checked_sub(1) else { return 1.0 };
    let (_, &mut ratio, _) = ratios.select_nth_unstable_by(last, f64::total_cmp);
    (BEYOND_NEIGHBOUR * ratio).clamp(1.0, MOST_ENLARGEMENT)
}
