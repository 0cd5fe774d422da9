//! Support radii, by support scale or by the k-th neighbour.

use geometry::Search;
use rayon::prelude::*;
use shape::Point3;

use crate::error::EfgError;

/// Rule for the support radius of every node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Support {
    /// `R_I = factor * spacing_I`, with the local mean spacing at the node.
    Dilatation {
        /// Support scale, dimensionless, usually 1.2 to 3.
        factor: f64,
    },
    /// `R_I = factor * d_I`, with the distance `d_I` to the `count`-th nearest other node.
    Neighbours {
        /// Number of the neighbour, from 1.
        count: usize,
        /// Factor on the distance, dimensionless, usually 1.2 to 1.6.
        factor: f64,
    },
}

impl Support {
    /// Returns the support radii (m), one per node. `spacing` (m, one per node) is the spacing of the cloud;
    /// [`Support::Neighbours`] ignores it.
    ///
    /// # Errors
    /// A parameter out of range, a node that is not finite, fewer nodes than neighbours, a number of spacings
    /// that is not that of the nodes, or a radius that is not positive.
    pub fn radii(self, nodes: &[Point3], spacing: &[f64]) -> Result<Vec<f64>, EfgError> {
        self.check(nodes)?;
        let radii: Vec<f64> = match self {
            Support::Dilatation { factor } => {
                if spacing.len() != nodes.len() {
                    let (found, expected) = (spacing.len(), nodes.len());
                    return Err(EfgError::Length { what: "spacings", found, expected });
                }
                spacing.iter().map(|h| factor * h).collect()
            }
            Support::Neighbours { count, factor } => {
                let nodes_missing = |_| EfgError::TooFewNodes { found: nodes.len(), needed: count + 1 };
                let search = Search::new(nodes).map_err(nodes_missing)?;
                kth_distances(nodes, &search, count).into_iter().map(|d| factor * d).collect()
            }
        };
        check(&radii)?;
        Ok(radii)
    }

    /// Refuses invalid parameters and nodes.
    pub(crate) fn check(self, nodes: &[Point3]) -> Result<(), EfgError> {
        if let Some(node) = nodes.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
            return Err(EfgError::NotFinite { node });
        }
        let (Support::Dilatation { factor } | Support::Neighbours { factor, .. }) = self;
        if !(factor > 0.0 && factor.is_finite()) {
            let what = "support factor";
            return Err(EfgError::BadParameter { what, value: factor, allowed: "a positive number" });
        }
        match self {
            Support::Neighbours { count: 0, .. } => {
                let (what, value) = ("neighbour count", 0.0);
                Err(EfgError::BadParameter { what, value, allowed: "1 or more" })
            }
            Support::Neighbours { count, .. } if count >= nodes.len() => {
                Err(EfgError::TooFewNodes { found: nodes.len(), needed: count + 1 })
            }
            _ => Ok(()),
        }
    }
}

/// Refuses radii that are not positive numbers.
pub(crate) fn check(radii: &[f64]) -> Result<(), EfgError> {
    match radii.iter().position(|&r| !(r > 0.0 && r.is_finite())) {
        Some(node) => Err(EfgError::BadRadius { node, radius: radii[node] }),
        None => Ok(()),
    }
}

/// Returns the distance (m) from every node to its `count`-th nearest other node.
fn kth_distances(nodes: &[Point3], search: &Search, count: usize) -> Vec<f64> {
    // The first of the `count + 1` nodes is the node itself, at zero.
    let at = |node: &Point3| search.nearest(node, count + 1).last().map_or(0.0, |n| n.distance);
    nodes.par_iter().map(at).collect()
}
