//! Sample points of triangles, for distances between surfaces.

use rayon::prelude::*;

use crate::{Point3, Vector3};

/// Smallest number of points per parallel task.
const CHUNK: usize = 64;
/// Largest number of parts of an edge.
const MOST: usize = 32;

/// Corners, and for each triangle its centre and the points of a regular grid, at most `apart` (m) from each
/// other.
pub(crate) fn samples(points: &[Point3], triangles: &[[u32; 3]], apart: f64) -> Vec<Point3> {
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let mut samples: Vec<Point3> = used.iter().map(|&p| points[p as usize]).collect();
    for t in triangles {
        let [a, b, c] = t.map(|p| points[p as usize].coords);
        let mut add = |p: Vector3| samples.push(p.into());
        add((a + b + c) / 3.0);
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        let parts = ((longest / apart).ceil() as usize).clamp(1, MOST);
        for i in 0..=parts {
            for j in 0..=parts - i {
                let k = parts - i - j;
                // Corners are already included.
                if i.max(j).max(k) < parts {
                    add((a * i as f64 + b * j as f64 + c * k as f64) / parts as f64);
                }
            }
        }
    }
    samples
}

/// The largest distance of sample points, m.
pub(crate) fn farthest(samples: &[Point3], distance: &(dyn Fn(&Point3) -> f64 + Sync)) -> f64 {
    samples.par_iter().with_min_len(CHUNK).map(distance).reduce(|| 0.0, f64::max)
}
