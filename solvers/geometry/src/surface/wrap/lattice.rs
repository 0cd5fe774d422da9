//! Lattice of points inside and outside of triangles.

use rayon::prelude::*;

use super::error::WrapProblem;
use crate::Point3;
use crate::surface::winding::Winding;

/// Largest number of points.
const MOST: f64 = 5e7;
/// Distance of the lattice's ends from the triangles, in cells. Round numbers would put faces of boxes on
/// points.
const MARGIN: f64 = 1.37;
/// Number of layers per parallel task.
const LAYERS: usize = 16;
/// Distance from the triangles, over the radius of a region, up to which the distance is searched.
const SEARCHED: f64 = 8.0;

/// Winding number above which a point is inside, and above which bodies overlap at it.
const INSIDE: f64 = 0.5;
const TWICE: f64 = 1.5;

/// A point of the lattice, along x, y and z.
pub(super) type Key = [usize; 3];

/// Points of a cubic lattice around triangles.
pub(super) struct Lattice {
    low: Point3,
    /// Distance of neighbours, m.
    size: f64,
    /// Number of points along x, y and z.
    pub(super) count: Key,
    /// Number of bodies around each point: 0, 1, or 2 and more.
    bodies: Vec<u8>,
}

impl Lattice {
    /// Lays the lattice over the triangles. Points at its ends are outside.
    pub(super) fn new(winding: &Winding, size: f64) -> Result<Lattice, WrapProblem> {
        if !(size > 0.0 && size.is_finite()) {
            return Err(WrapProblem::Size { size });
        }
        let [low, high] = winding.tree().bounds();
        let extent = high - low;
        if size >= extent.min() {
            return Err(WrapProblem::Coarse { size, narrowest: extent.min() });
        }
        let cells = extent.map(|length| (length / size + 2.0 * MARGIN).ceil());
        let points = cells.add_scalar(1.0).product();
        if points > MOST {
            return Err(WrapProblem::Fine { size, points, least: size * (1.05 * points / MOST).cbrt() });
        }
        let count: Key = cells.map(|cells| cells as usize + 1).into();
        let low = low.map(|x| x - MARGIN * size);
        let mut lattice = Lattice { low, size, count, bodies: Vec::new() };
        let mut bodies = vec![0; count[0] * count[1] * count[2]];
        let layer = count[0] * count[1];
        bodies.par_chunks_mut(LAYERS * layer).enumerate().for_each(|(slab, bodies)| {
            let first = LAYERS * slab;
            let from = [1, 1, first.max(1)];
            let to = [count[0] - 2, count[1] - 2, (first + LAYERS - 1).min(count[2] - 2)];
            if from[2] <= to[2] {
                lattice.fill(winding, [from, to], first * layer, bodies);
            }
        });
        lattice.bodies = bodies;
        Ok(lattice)
    }

    /// Counts the bodies around the points of a region, from one corner to the other. `bodies` begins at the
    /// point `first`.
    ///
    /// The winding number is harmonic away from the triangles. In a ball without triangles it changes by less
    /// than `3 r / (d - r)` times its bound, over a distance `r` from the centre of a ball of the radius `d`.
    fn fill(&self, winding: &Winding, [from, to]: [Key; 2], first: usize, bodies: &mut [u8]) {
        let (a, b) = (self.place(from), self.place(to));
        let (middle, radius) = (nalgebra::center(&a, &b), 0.5 * (b - a).norm());
        if from == to {
            bodies[self.number(from) - first] = around(winding.at(&middle));
            return;
        }
        let searched = SEARCHED * radius;
        let distance = winding.tree().closest(&middle, searched).map_or(searched, |c| c.square.sqrt());
        // The bound is 1: in the ball, winding numbers lie in an interval of length 2.
        if distance > 4.0 * radius {
            let number = winding.at(&middle);
            let change = 3.0 * radius / (distance - radius);
            if [INSIDE, TWICE].iter().all(|bound| (number - bound).abs() > change) {
                self.points([from, to], |point| bodies[point - first] = around(number));
                return;
            }
        }
        let spans: Key = std::array::from_fn(|a| to[a] - from[a]);
        let axis = (0..3).max_by_key(|&a| spans[a]).unwrap_or(0);
        let (mut end, mut start) = (to, from);
        end[axis] = from[axis] + spans[axis] / 2;
        start[axis] = end[axis] + 1;
        self.fill(winding, [from, end], first, bodies);
        self.fill(winding, [start, to], first, bodies);
    }

    /// Whether a point is inside.
    pub(super) fn is_inside(&self, number: usize) -> bool {
        self.bodies[number] > 0
    }

    /// Points at which bodies overlap.
    pub(super) fn doubled(&self) -> impl Iterator<Item = Point3> {
        let doubled = self.bodies.iter().enumerate().filter(|(_, bodies)| **bodies > 1);
        doubled.map(|(number, _)| self.place(self.key(number)))
    }

    fn points(&self, [from, to]: [Key; 2], mut each: impl FnMut(usize)) {
        for k in from[2]..=to[2] {
            for j in from[1]..=to[1] {
                (from[0]..=to[0]).for_each(|i| each(self.number([i, j, k])));
            }
        }
    }

    /// Position of a point, m.
    pub(super) fn place(&self, key: Key) -> Point3 {
        self.low + nalgebra::Vector3::from(key.map(|x| x as f64 * self.size))
    }

    /// Index of a point.
    pub(super) fn number(&self, [i, j, k]: Key) -> usize {
        i + self.count[0] * (j + self.count[1] * k)
    }

    /// The point of an index.
    pub(super) fn key(&self, number: usize) -> Key {
        let [x, y, _] = self.count;
        [number % x, number / x % y, number / (x * y)]
    }
}

/// Number of bodies around a position with this winding number.
fn around(winding: f64) -> u8 {
    u8::from(winding > INSIDE) + u8::from(winding > TWICE)
}
