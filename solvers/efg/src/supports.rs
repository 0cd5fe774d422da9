//! Supports of the nodes of a cloud.

use shape::Vector3;

use crate::ellipsoid::Ellipsoid;
use crate::mls::Ball;

/// Supports of all nodes: balls, or ellipsoids within the balls.
pub(crate) struct Supports {
    pub(crate) balls: Vec<Ball>,
    /// Supports adapted to the cloud; empty if the balls are the supports.
    pub(crate) ellipsoids: Vec<Ellipsoid>,
}

impl Supports {
    /// Returns the radius of a node's ball, m; zero for a node after those of the cloud.
    pub(crate) fn radius(&self, node: usize) -> f64 {
        self.balls.get(node).map_or(0.0, |ball| ball.radius)
    }

    /// Returns the largest support radius, m.
    pub(crate) fn widest(&self) -> f64 {
        self.balls.iter().map(|ball| ball.radius).fold(0.0, f64::max)
    }

    /// Returns the length of an offset (m), relative to the extent of the node's support in its direction.
    pub(crate) fn length(&self, node: u32, e: &Vector3) -> f64 {
        match self.ellipsoids.get(node as usize) {
            Some(ellipsoid) => ellipsoid.square((*e).into()).max(0.0).sqrt(),
            None => e.norm() / self.balls[node as usize].radius,
        }
    }
}
