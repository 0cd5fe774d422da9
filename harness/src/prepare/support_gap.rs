//! Displacement error at weakly constrained supports.

use geometry::Vector3;

use super::Prepared;

impl Prepared {
    /// Returns the RMS difference (m) between the displacement and the values of weak supports, over their
    /// surfaces and axes, and the area of these surfaces (m^2); `None` without weak supports.
    pub fn support_gap(&self, u: &[Vector3]) -> Option<[f64; 2]> {
        let weak = self.weak.iter().map(|w| (w.flux.at().rows(), w.flux.weights(), &w.values, w.axes));
        let held = self.penalties.iter().map(|h| (h.surface.rows(), h.surface.weights(), &h.values, h.axes));
        let (mut sum, mut area) = (0.0, 0.0);
        for (rows, weights, values, axes) in weak.chain(held) {
            for ((u, g), w) in rows.apply(u).iter().zip(values).zip(weights) {
                let off: f64 = (0..3).filter(|&axis| axes[axis]).map(|axis| (u - g)[axis].powi(2)).sum();
                sum += w * off;
                area += w;
            }
        }
        (area > 0.0).then(|| [(sum / area).sqrt(), area])
    }
}
