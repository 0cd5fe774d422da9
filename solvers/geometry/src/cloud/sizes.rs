//! Graded spacing of nodes that concentrates them in regions of large error.

use super::Cloud;
use crate::Point3;
use crate::search::{Search, SearchError};

/// Largest growth of the spacing per distance. Over a support of three spacings the spacing at most doubles.
const GROWTH: f64 = 0.3;

/// Graded node spacing as a function of position, as a fraction of the coarsest spacing.
pub struct Sizes {
    search: Search,
    nodes: Vec<Point3>,
    /// Spacing at each node, m.
    sizes: Vec<f64>,
    /// Finest and coarsest spacing, m.
    bounds: [f64; 2],
}

impl Sizes {
    /// Computes spacings from an error of first order in the spacing, such as that of a gradient. `error` has
    /// one value per node of the cloud, in any unit. The density of nodes is proportional to `h^-3`. For a
    /// fixed number of nodes, the mean square of an error `C h` is therefore least with a spacing
    /// `h ~ C^(-2/5)`.
    ///
    /// These spacings are limited to a range around their geometric mean, from `1 / sqrt(ratio)` to
    /// `sqrt(ratio)` times this mean. Spacings grow by at most 0.3 of the distance.
    ///
    /// # Errors
    /// Nodes that cannot be searched.
    pub fn new(cloud: &Cloud, error: &[f64], ratio: f64) -> Result<Sizes, SearchError> {
        let Cloud { points: nodes, spacing } = cloud;
        let largest = error.iter().zip(spacing).map(|(e, h)| e / h).fold(0.0, f64::max);
        // Without any error the spacing is uniform.
        let constant = |e: f64, h: f64| if largest > 0.0 { (e / h / largest).max(1e-12) } else { 1.0 };
        let wanted: Vec<f64> = error.iter().zip(spacing).map(|(&e, &h)| constant(e, h).powf(-0.4)).collect();
        let middle = (wanted.iter().map(|h| h.ln()).sum::<f64>() / wanted.len() as f64).exp();
        let bounds = [middle / ratio.sqrt(), middle * ratio.sqrt()];
        let bounded = || wanted.iter().map(|h| h.clamp(bounds[0], bounds[1]));
        // A node fills about the cube of its spacing. The factor keeps the number of nodes that fill the
        // body.
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

    /// Ratio of the finest to the coarsest spacing.
    pub fn finest(&self) -> f64 {
        self.bounds[0] / self.bounds[1]
    }

    /// Spacing at a point (m) as a fraction of the coarsest spacing, from [`Sizes::finest`] to 1.
    pub fn at(&self, p: &Point3) -> f64 {
        let near = self.search.nearest_one(p);
        let grown = self.sizes[near] + GROWTH * (p - self.nodes[near]).norm();
        (grown / self.bounds[1]).clamp(self.finest(), 1.0)
    }
}
