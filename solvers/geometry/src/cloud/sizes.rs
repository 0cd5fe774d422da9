//! How close nodes should stand so that their number is spent where an error is.

use crate::{Cloud, Point3, Search, SearchError};

/// Growth of the spacing per distance: over a support of three spacings by no more than twice.
const GROWTH: f64 = 0.3;

/// Relative spacing everywhere.
pub struct Sizes {
    search: Search,
    nodes: Vec<Point3>,
    /// At each node, m.
    sizes: Vec<f64>,
    /// Finest and coarsest, m.
    bounds: [f64; 2],
}

impl Sizes {
    /// From an error of first order at the nodes of a cloud, such as that of a gradient. With as many nodes as before, the mean
    /// square of an error `C h` is least with a spacing `h ~ C^(-2/5)`, as the number of nodes grows with `h^-3`. The coarsest is
    /// `ratio` times the finest at most, their geometric mean that of all nodes; spacings grow by 0.3 of the distance at most.
    pub fn new(cloud: &Cloud, error: &[f64], ratio: f64) -> Result<Sizes, SearchError> {
        let Cloud { points: nodes, spacing } = cloud;
        let largest = error.iter().zip(spacing).map(|(e, h)| e / h).fold(0.0, f64::max);
        // Where there is no error at all any spacing does.
        let constant = |e: f64, h: f64| if largest > 0.0 { (e / h / largest).max(1e-12) } else { 1.0 };
        let wanted: Vec<f64> = error.iter().zip(spacing).map(|(&e, &h)| constant(e, h).powf(-0.4)).collect();
        let middle = (wanted.iter().map(|h| h.ln()).sum::<f64>() / wanted.len() as f64).exp();
        let bounds = [middle / ratio.sqrt(), middle * ratio.sqrt()];
        let bounded = || wanted.iter().map(|h| h.clamp(bounds[0], bounds[1]));
        // A node fills about the cube of its spacing: in metres such that as many nodes fill the body as do now.
        let filled: f64 = bounded().zip(spacing).map(|(size, h)| (h / size).powi(3)).sum();
        let unit = (filled / nodes.len() as f64).cbrt();
        let metres: Vec<f64> = bounded().map(|size| size * unit).collect();
        let reached = |p: &Point3| {
            let grown = metres.iter().zip(nodes).map(|(h, other)| h + GROWTH * (p - other).norm());
            grown.fold(f64::INFINITY, f64::min)
        };
        let sizes = nodes.iter().map(reached).collect();
        Ok(Sizes {
            search: Search::new(nodes)?,
            nodes: nodes.clone(),
            sizes,
            bounds: bounds.map(|b| b * unit),
        })
    }

    /// Finest over coarsest spacing.
    pub fn finest(&self) -> f64 {
        self.bounds[0] / self.bounds[1]
    }

    /// Spacing at a point over the coarsest.
    pub fn at(&self, p: &Point3) -> f64 {
        let near = self.search.nearest_one(p);
        let grown = self.sizes[near] + GROWTH * (p - self.nodes[near]).norm();
        (grown / self.bounds[1]).clamp(self.finest(), 1.0)
    }
}
