//! Which supports may cover a point? A uniform grid whose cells list the nodes whose support balls touch them.
//! A query reads one list: at 83 nodes it takes less time than descending a tree.

use shape::Point3;

/// Cells per support radius: finer cells hold fewer false candidates but more entries in all.
const CELLS_PER_RADIUS: f64 = 2.0;

pub(crate) struct Buckets {
    origin: [f64; 3],
    inverse_size: f64,
    counts: [usize; 3],
    offsets: Vec<u32>,
    items: Vec<u32>,
}

impl Buckets {
    /// Lists every ball in the cells it touches, by ascending node index.
    pub(crate) fn new(points: &[Point3], radii: &[f64]) -> Buckets {
        let bound = |axis: usize, sign: f64| {
            let ends = points.iter().zip(radii).map(|(p, r)| sign * p[axis] + r);
            sign * ends.fold(f64::NEG_INFINITY, f64::max)
        };
        let origin: [f64; 3] = std::array::from_fn(|a| bound(a, -1.0));
        let extent: [f64; 3] = std::array::from_fn(|a| bound(a, 1.0) - origin[a]);
        let mut size = radii.iter().sum::<f64>() / radii.len() as f64 / CELLS_PER_RADIUS;
        // A few nodes far from the rest must not make a grid of empty cells.
        let limit = (64 * points.len() + 4096) as f64;
        let cells = |size: f64| extent.iter().map(|e| (e / size).floor() + 1.0).product::<f64>();
        while cells(size) > limit {
            size *= 1.25;
        }
        let counts = extent.map(|e| (e / size).floor() as usize + 1);
        let mut grid =
            Buckets { origin, inverse_size: 1.0 / size, counts, offsets: Vec::new(), items: Vec::new() };
        grid.offsets = vec![0; counts.iter().product::<usize>() + 1];
        let mut entries = Vec::new();
        for (node, (point, &radius)) in points.iter().zip(radii).enumerate() {
            grid.for_each_touched(point, radius, |cell| entries.push((cell as u32, node as u32)));
        }
        for &(cell, _) in &entries {
            grid.offsets[cell as usize + 1] += 1;
        }
        for cell in 1..grid.offsets.len() {
            grid.offsets[cell] += grid.offsets[cell - 1];
        }
        let mut next = grid.offsets.clone();
        grid.items = vec![0; entries.len()];
        for (cell, node) in entries {
            let slot = &mut next[cell as usize];
            grid.items[*slot as usize] = node;
            *slot += 1;
        }
        grid
    }

    /// Nodes whose supports may cover the point, by ascending index; a superset of those that do.
    #[inline]
    pub(crate) fn candidates(&self, point: &Point3) -> &[u32] {
        let mut cell = 0;
        for axis in 0..3 {
            let at = (point[axis] - self.origin[axis]) * self.inverse_size;
            // A point beyond the outermost support is covered by none; a NaN fails the test, too.
            if !(at >= 0.0 && at < self.counts[axis] as f64) {
                return &[];
            }
            cell = cell * self.counts[axis] + at as usize;
        }
        &self.items[self.offsets[cell] as usize..self.offsets[cell + 1] as usize]
    }

    fn for_each_touched(&self, point: &Point3, radius: f64, mut visit: impl FnMut(usize)) {
        // In cell units, with a margin far above rounding.
        let radius = radius * self.inverse_size + 1e-9;
        let at: [f64; 3] = std::array::from_fn(|a| (point[a] - self.origin[a]) * self.inverse_size);
        let range = |a: usize| {
            let first = (at[a] - radius).floor().max(0.0) as usize;
            first..=((at[a] + radius).floor() as usize).min(self.counts[a] - 1)
        };
        let gap = |a: usize, cell: usize| (cell as f64 - at[a]).max(at[a] - cell as f64 - 1.0).max(0.0);
        for i in range(0) {
            let dx = gap(0, i);
            for j in range(1) {
                let dy = gap(1, j);
                for k in range(2) {
                    let dz = gap(2, k);
                    if dx * dx + dy * dy + dz * dz <= radius * radius {
                        visit((i * self.counts[1] + j) * self.counts[2] + k);
                    }
                }
            }
        }
    }
}
