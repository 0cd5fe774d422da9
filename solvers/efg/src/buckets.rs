//! Search for the supports that cover a point. In a uniform grid, each cell lists the nodes whose support
//! balls touch the cell, and a query reads one list. For few nodes, testing all nodes in lanes takes less
//! time than gathering those of a list.

use lanes::{LANES, Lanes};
use shape::Point3;

use crate::mls::Ball;

/// Number of nodes up to which all nodes are tested.
const FEW: usize = 128;
/// Cells per support radius: finer cells hold fewer false candidates but more entries in all. With 2 there
/// would be a sixth fewer candidates, and 23 bytes more for every integration point.
const CELLS_PER_RADIUS: f64 = 1.6;

pub(crate) enum Buckets {
    /// All balls by axis and radius, in groups of eight, padded with balls of zero radius.
    Few(Vec<[Lanes; 4]>),
    Grid(Grid),
}

pub(crate) struct Grid {
    origin: [f64; 3],
    inverse_size: f64,
    counts: [usize; 3],
    offsets: Vec<u32>,
    items: Vec<u32>,
}

impl Buckets {
    pub(crate) fn new(balls: &[Ball]) -> Buckets {
        if balls.len() > FEW {
            return Buckets::Grid(Grid::new(balls));
        }
        let side_by_side = |eight: &[Ball]| {
            let mut lanes = [[0.0; LANES]; 4];
            for (l, Ball { at: [x, y, z], radius }) in eight.iter().enumerate() {
                (lanes[0][l], lanes[1][l], lanes[2][l], lanes[3][l]) = (*x, *y, *z, *radius);
            }
            lanes
        };
        Buckets::Few(balls.chunks(LANES).map(side_by_side).collect())
    }

    /// Appends the nodes whose balls cover the point, in ascending order.
    #[inline(always)]
    pub(crate) fn find(&self, x: &Point3, balls: &[Ball], nodes: &mut Vec<u32>) {
        let first = nodes.len();
        let mut n = first;
        match self {
            Buckets::Few(eights) => {
                nodes.resize(first + eights.len() * LANES, 0);
                for (&eight, node) in eights.iter().zip((0..).step_by(LANES)) {
                    let mut these = [0; LANES];
                    for l in 0..LANES {
                        these[l] = node + l as u32;
                    }
                    n += keep(&these, &covered(eight, x), &mut nodes[n..n + LANES]);
                }
            }
            Buckets::Grid(grid) => {
                let candidates = grid.candidates(x);
                nodes.resize(first + candidates.len(), 0);
                let (groups, rest) = candidates.as_chunks::<LANES>();
                for these in groups {
                    n += keep(these, &covered(gathered(balls, these), x), &mut nodes[n..n + LANES]);
                }
                for &node in rest {
                    nodes[n] = node;
                    n += usize::from(balls[node as usize].covers(x, 1.0));
                }
            }
        }
        nodes.truncate(n);
    }
}

/// Returns the positions and radii of eight balls.
#[inline(always)]
fn gathered(balls: &[Ball], nodes: &[u32; LANES]) -> [Lanes; 4] {
    let mut lanes = [[0.0; LANES]; 4];
    for l in 0..LANES {
        let Ball { at: [x, y, z], radius } = balls[nodes[l] as usize];
        (lanes[0][l], lanes[1][l], lanes[2][l], lanes[3][l]) = (x, y, z, radius);
    }
    lanes
}

/// Returns 1 for each of eight balls that covers the point, and 0 for the others.
#[inline(always)]
fn covered([at_x, at_y, at_z, radius]: [Lanes; 4], x: &Point3) -> [u64; LANES] {
    let mut covered = [0; LANES];
    for l in 0..LANES {
        let ball = Ball { at: [at_x[l], at_y[l], at_z[l]], radius: radius[l] };
        covered[l] = u64::from(ball.covers(x, 1.0));
    }
    covered
}

/// Moves the covering nodes to the front of `room` and returns their number. Every candidate is written:
/// about half are rejected, and a branch would be mispredicted.
#[inline(always)]
fn keep(nodes: &[u32; LANES], covered: &[u64; LANES], room: &mut [u32]) -> usize {
    let mut kept = 0;
    for l in 0..LANES {
        // At most `l` nodes are kept so far, so the remainder equals `kept` and avoids the bounds check.
        room[kept % LANES] = nodes[l];
        kept += covered[l] as usize;
    }
    kept
}

impl Grid {
    /// Lists every ball in the cells it touches, in ascending order of nodes.
    fn new(balls: &[Ball]) -> Grid {
        let bound = |axis: usize, sign: f64| {
            let ends = balls.iter().map(|ball| sign * ball.at[axis] + ball.radius);
            sign * ends.fold(f64::NEG_INFINITY, f64::max)
        };
        let origin: [f64; 3] = std::array::from_fn(|a| bound(a, -1.0));
        let extent: [f64; 3] = std::array::from_fn(|a| bound(a, 1.0) - origin[a]);
        let mut size =
            balls.iter().map(|ball| ball.radius).sum::<f64>() / balls.len() as f64 / CELLS_PER_RADIUS;
        // Prevents a huge grid of empty cells if a few nodes are far from the rest.
        let limit = (64 * balls.len() + 4096) as f64;
        let cells = |size: f64| extent.iter().map(|e| (e / size).floor() + 1.0).product::<f64>();
        while cells(size) > limit {
            size *= 1.25;
        }
        let counts = extent.map(|e| (e / size).floor() as usize + 1);
        let mut grid =
            Grid { origin, inverse_size: 1.0 / size, counts, offsets: Vec::new(), items: Vec::new() };
        grid.offsets = vec![0; counts.iter().product::<usize>() + 1];
        let mut entries = Vec::new();
        for (node, ball) in balls.iter().enumerate() {
            grid.for_each_touched(ball, |cell| entries.push((cell as u32, node as u32)));
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

    /// Returns the nodes whose supports may cover the point, in ascending order: a superset of the covering
    /// nodes.
    #[inline]
    fn candidates(&self, point: &Point3) -> &[u32] {
        let mut cell = 0;
        for axis in 0..3 {
            let at = (point[axis] - self.origin[axis]) * self.inverse_size;
            // A point beyond all supports is covered by none; NaN also fails the test.
            if !(at >= 0.0 && at < self.counts[axis] as f64) {
                return &[];
            }
            cell = cell * self.counts[axis] + at as usize;
        }
        &self.items[self.offsets[cell] as usize..self.offsets[cell + 1] as usize]
    }

    fn for_each_touched(&self, ball: &Ball, mut visit: impl FnMut(usize)) {
        // Cell units, with a margin far above rounding.
        let radius = ball.radius * self.inverse_size + 1e-9;
        let at: [f64; 3] = std::array::from_fn(|a| (ball.at[a] - self.origin[a]) * self.inverse_size);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_find_the_balls_that_cover() {
        let at = |i: usize, c: f64| (i as f64 * c).fract();
        let place = |i: usize| [at(i, 0.754_877), at(i, 0.569_84), at(i, 0.317_8)];
        // The number is not a multiple of eight.
        let balls: Vec<Ball> =
            (0..83).map(|i| Ball { at: place(i), radius: 0.2 + 0.01 * (i % 7) as f64 }).collect();
        let few = Buckets::new(&balls);
        let grid = Buckets::Grid(Grid::new(&balls));
        assert!(matches!(few, Buckets::Few(_)));
        let mut total = 0;
        for x in (100..400).map(|i| Point3::from(place(i).map(|c| 1.6 * c - 0.3))) {
            let covering: Vec<u32> = (0..83).filter(|&n| balls[n as usize].covers(&x, 1.0)).collect();
            for buckets in [&few, &grid] {
                let mut nodes = vec![7];
                buckets.find(&x, &balls, &mut nodes);
                assert_eq!(nodes[1..], covering);
            }
            total += covering.len();
        }
        assert!((200..600).contains(&total), "{total}");
    }
}
