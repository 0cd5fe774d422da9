//! Displacement error at weakly constrained supports.

use geometry::Vector3;

use super::Prepared;

impl Prepared {
    /// Returns the RMS difference (m) between the displacement and the values of weak supports at the end, over their
    /// surfaces and axes, and the area of these surfaces (m^2); `None` without weak supports that act throughout.
    pub fn support_gap(&self, u: &[Vector3]) -> Option<[f64; 2]> {
        let weak = self.weak.iter().map(|w| (w.flux.at().rows(), w.flux.weights(), &w.values, w.axes));
        let held = self.penalties.iter().map(|h| (h.surface.rows(), h.surface.weights(), &h.values, h.axes));
        let own = &self.own_curves;
        let (mut sum, mut area) = (0.0, 0.0);
        for (index, (rows, weights, values, axes)) in weak.chain(held).enumerate() {
            if matches!(own.weak_during.get(index), Some(Some(_))) {
                continue;
            }
            let factor = own.at_end(&own.weak, index);
            for ((u, g), w) in rows.apply(u).iter().zip(values).zip(weights) {
                let off: f64 =
                    (0..3).filter(|&axis| axes[axis]).map(|axis| (u - g * factor)[axis].powi(2)).sum();
                sum += w * off;
                area += w;
            }
        }
        (area > 0.0).then(|| [(sum / area).sqrt(), area])
    }
}
