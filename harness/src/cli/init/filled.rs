//! The body as a grid of points. It serves to find a side with an end that a plate can press, and the height
//! of the constrained part at the opposite end.

use clap::ValueEnum;
use geometry::Point3;
use rayon::prelude::*;

use super::args::Side;
use super::organ::Organ;

/// Number of points along each axis.
const GRID: usize = 24;
/// Number of point layers in the end of the body on one side.
const END: usize = 2;
/// Smallest fraction of the body in a blunt end; the cap of a ball has 2 %, the tip of a cone 0.06 %.
const BLUNT: f64 = 0.012;
/// Smallest fraction of an end directly above the constrained part. The rest overhangs and bends away.
const BACKED: f64 = 0.5;
/// Smallest ratio of breadth to length of the body between an end and the constrained part. A more slender
/// body buckles.
const STOUT: f64 = 0.2;
/// Smallest fraction of the body that is constrained.
const HELD: f64 = 0.08;

/// Marks of the grid points inside the body, in its bounding box, and the grid spacing along each axis, m.
pub(super) struct Filled {
    inside: Vec<bool>,
    steps: [f64; 3],
}

impl Filled {
    pub fn new(organ: &Organ) -> Filled {
        let at = |k: usize, axis: usize| {
            organ.bounds[0][axis] + organ.extent(axis) * (k as f64 + 0.5) / GRID as f64
        };
        let point = |k: usize| Point3::new(at(k % GRID, 0), at(k / GRID % GRID, 1), at(k / GRID / GRID, 2));
        let inside = |k: usize| organ.surface.signed_distance(&point(k)) < 0.0;
        let inside = (0..GRID.pow(3)).into_par_iter().map(inside).collect();
        Filled { inside, steps: [0, 1, 2].map(|axis| organ.extent(axis) / GRID as f64) }
    }

    /// Whether a point is inside. `layer` is counted from `side`; `place` is the position in the layer.
    fn has(&self, side: Side, layer: usize, place: [usize; 2]) -> bool {
        let axis = side.axis();
        let mut k = [0; 3];
        k[axis] = if side.sign() > 0.0 { GRID - 1 - layer } else { layer };
        (k[(axis + 1) % 3], k[(axis + 2) % 3]) = (place[0], place[1]);
        self.inside[k[0] + GRID * (k[1] + GRID * k[2])]
    }

    /// Returns the number of inside points in a layer.
    fn count(&self, side: Side, layer: usize) -> usize {
        places().filter(|&place| self.has(side, layer, place)).count()
    }

    fn all(&self) -> f64 {
        self.inside.iter().filter(|inside| **inside).count().max(1) as f64
    }

    /// Returns the constrained fraction of the height, at the end opposite to `side`: `least`, or more if
    /// that contains little of the body.
    pub fn held(&self, side: Side, least: f64) -> f64 {
        let mut sum = 0.0;
        let layers = (0..GRID).rev().take_while(|&layer| {
            sum += self.count(side, layer) as f64;
            sum < HELD * self.all()
        });
        least.max((layers.count() + 1) as f64 / GRID as f64)
    }

    /// Returns the fraction of the body in the end of a side, the fraction of that end above the constrained
    /// part, and the ratio of breadth to length between the two.
    fn end(&self, side: Side, held: f64) -> [f64; 3] {
        let pressed: usize = (0..END).map(|layer| self.count(side, layer)).sum();
        let ground = GRID - (held * GRID as f64).round() as usize;
        let ends: Vec<[usize; 2]> =
            places().filter(|&place| (0..END).any(|layer| self.has(side, layer, place))).collect();
        let stands =
            |place: &&[usize; 2]| (END - 1..=ground.min(GRID - 1)).all(|k| self.has(side, k, **place));
        let backed = ends.iter().filter(stands).count();
        let axis = side.axis();
        let narrowest = (END - 1..ground).map(|layer| self.count(side, layer)).min().unwrap_or(0) as f64;
        let breadth = (narrowest * self.steps[(axis + 1) % 3] * self.steps[(axis + 2) % 3]).sqrt();
        let stout = breadth / (ground as f64 * self.steps[axis]);
        [pressed as f64 / self.all(), backed as f64 / ends.len().max(1) as f64, stout]
    }

    /// Returns the sides from best to worst for the plate. Sides with a blunt end, supported by the
    /// constrained part and not slender, come first in their usual order.
    pub fn sides(&self, least: f64) -> Vec<Side> {
        let quality = |side: &Side| {
            let [pressed, backed, stout] = self.end(*side, self.held(*side, least));
            (pressed / BLUNT).min(1.0) * (backed / BACKED).min(1.0) * (stout / STOUT).min(1.0)
        };
        let mut all: Vec<(f64, Side)> =
            Side::value_variants().iter().map(|side| (quality(side), *side)).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.into_iter().map(|(_, side)| side).collect()
    }
}

fn places() -> impl Iterator<Item = [usize; 2]> {
    (0..GRID * GRID).map(|k| [k % GRID, k / GRID])
}
