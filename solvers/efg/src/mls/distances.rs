//! Relative distances in other metrics than those of balls, and the directions in which they grow.

use lanes::LANES;
use shape::Point3;

use super::Group;
use crate::detour::Detour;
use crate::ellipsoid::Ellipsoid;

impl Group {
    /// Computes relative distances and their directions in the metrics of ellipsoids.
    #[inline(always)]
    pub(super) fn stretch<'a>(
        &mut self,
        points: impl Iterator<Item = (&'a Point3, &'a [u32])>,
        ellipsoids: &[Ellipsoid],
        enlargement: f64,
    ) {
        let longest = self.longest();
        self.normal.resize(longest, [[0.0; LANES]; 3]);
        let shrunk = 1.0 / (enlargement * enlargement);
        for (l, (_, nodes)) in points.enumerate() {
            for ((&node, offset), normal) in nodes.iter().zip(&self.offset).zip(&mut self.normal) {
                let along = ellipsoids[node as usize].normal([offset[0][l], offset[1][l], offset[2][l]]);
                for axis in 0..3 {
                    normal[axis][l] = along[axis] * shrunk;
                }
            }
        }
        for k in 0..longest {
            let ([x, y, z], [nx, ny, nz]) = (self.offset[k], self.normal[k]);
            let (mut inverse, mut q) = ([0.0; LANES], [0.0; LANES]);
            for l in 0..LANES {
                let square = nx[l] * x[l] + ny[l] * y[l] + nz[l] * z[l];
                let root = square.max(0.0).sqrt();
                let at_node = !(root > 0.0);
                inverse[l] = if at_node { 0.0 } else { 1.0 } / if at_node { 1.0 } else { root };
                q[l] = root.min(1.0);
            }
            (self.chain[k], self.relative[k]) = (inverse, q);
        }
    }

    /// Adds the detours to the distances of the neighbours, with one list for each loaded point.
    #[inline(always)]
    pub(crate) fn bend<'a>(&mut self, detours: impl Iterator<Item = &'a [Detour]> + Clone) {
        if detours.clone().flatten().all(|detour| detour.longer == 0.0) {
            return;
        }
        if !self.stretched {
            self.normals_of_balls();
        }
        for (l, of_point) in detours.enumerate() {
            for (k, detour) in of_point.iter().enumerate().filter(|(_, detour)| detour.longer > 0.0) {
                let chain = self.chain[k][l];
                let q = (self.relative[k][l] + detour.longer).min(1.0);
                for (axis, normal) in self.normal[k].iter_mut().enumerate() {
                    normal[l] = q * (normal[l] * chain - detour.slope[axis]);
                }
                (self.chain[k][l], self.relative[k][l]) = (1.0 / q, q);
            }
        }
    }

    /// Converts balls to ellipsoids.
    fn normals_of_balls(&mut self) {
        let longest = self.longest();
        self.normal.resize(longest, [[0.0; LANES]; 3]);
        for k in 0..longest {
            for l in 0..LANES {
                let square = self.chain[k][l] * self.relative[k][l];
                for axis in 0..3 {
                    self.normal[k][axis][l] = self.offset[k][axis][l] * square;
                }
                let q = self.relative[k][l];
                self.chain[k][l] = if q > 0.0 { 1.0 / q } else { 0.0 };
            }
        }
        self.stretched = true;
    }
}
