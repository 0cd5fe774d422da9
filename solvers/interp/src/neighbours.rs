//! Search for the nearest nodes of a target, by ascending distance, then by ascending index.

use geometry::Search;
use shape::Point3;

use crate::error::InterpError;

/// Refuses coordinates that are not finite.
pub(crate) fn check_finite(nodes: &[Point3], targets: &[Point3]) -> Result<(), InterpError> {
    for (what, points) in [("node", nodes), ("target", targets)] {
        if let Some(index) = points.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
            return Err(InterpError::NotFinite { what, index });
        }
    }
    Ok(())
}

/// Refuses a cloud smaller than `needed`.
pub(crate) fn check_count(scheme: &'static str, found: usize, needed: usize) -> Result<(), InterpError> {
    if found < needed { Err(InterpError::TooFewNodes { scheme, found, needed }) } else { Ok(()) }
}

/// Number of nodes from which a tree is faster than a vectorised loop over all nodes.
const TREE: usize = 1000;

/// Finds the `count` nearest nodes.
pub(crate) struct Neighbours {
    lookup: Lookup,
    count: usize,
}

enum Lookup {
    All([Vec<f64>; 3]),
    Tree(Search),
}

/// Buffers of a search, reused from target to target.
#[derive(Default)]
pub(crate) struct Found {
    squares: Vec<f64>,
    best: Vec<(f64, u32)>,
}

impl Neighbours {
    /// Prepares a search; `count` is at least 1 and at most the number of nodes, whose coordinates are
    /// finite.
    pub(crate) fn new(nodes: &[Point3], count: usize) -> Result<Neighbours, InterpError> {
        let lookup = if nodes.len() < TREE {
            Lookup::All(std::array::from_fn(|axis| nodes.iter().map(|p| p[axis]).collect()))
        } else {
            Lookup::Tree(Search::new(nodes)?)
        };
        Ok(Neighbours { lookup, count })
    }

    /// Returns distance (m) and index of the nearest nodes, nearest first.
    pub(crate) fn of<'a>(&self, x: &Point3, found: &'a mut Found) -> &'a [(f64, u32)] {
        let Found { squares, best } = found;
        best.clear();
        match &self.lookup {
            Lookup::Tree(search) => {
                best.extend(search.nearest(x, self.count).iter().map(|n| (n.distance, n.index)));
            }
            Lookup::All(axes) => {
                squares.resize(axes[0].len(), 0.0);
                squared_distances(axes, x, squares);
                smallest(squares, self.count, best);
                best.iter_mut().for_each(|found| found.0 = found.0.sqrt());
            }
        }
        best
    }
}

/// Computes the squared distances (m^2) of a point from others, given axis by axis.
pub(crate) fn squared_distances([xs, ys, zs]: &[Vec<f64>; 3], x: &Point3, squares: &mut [f64]) {
    for (((square, a), b), c) in squares.iter_mut().zip(xs).zip(ys).zip(zs) {
        let (dx, dy, dz) = (a - x.x, b - x.y, c - x.z);
        *square = dx * dx + dy * dy + dz * dz;
    }
}

/// Returns the `count` smallest numbers in ascending order; of equal numbers the lower index comes first,
/// because the sort is stable and the comparisons are strict.
fn smallest(squares: &[f64], count: usize, best: &mut Vec<(f64, u32)>) {
    let (first, rest) = squares.split_at(count);
    best.extend(first.iter().zip(0..).map(|(&square, node)| (square, node)));
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    let last = count - 1;
    for (&square, node) in rest.iter().zip(count as u32..) {
        if square < best[last].0 {
            let mut at = last;
            while at > 0 && square < best[at - 1].0 {
                best[at] = best[at - 1];
                at -= 1;
            }
            best[at] = (square, node);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tree_and_the_loop_agree_to_the_bit() {
        // A lattice, in which most distances are shared by several nodes.
        let nodes: Vec<Point3> =
            (0..1000).map(|i| Point3::new((i % 10) as f64, (i / 10 % 10) as f64, (i / 100) as f64)).collect();
        let of = |lookup: Lookup, x: &Point3| {
            Neighbours { lookup, count: 20 }.of(x, &mut Found::default()).to_vec()
        };
        let axes: [Vec<f64>; 3] = std::array::from_fn(|axis| nodes.iter().map(|p| p[axis]).collect());
        for x in [nodes[444], Point3::new(3.5, 4.5, 5.5), Point3::new(0.1, 7.3, 20.0)] {
            let all = of(Lookup::All(axes.clone()), &x);
            assert_eq!(all, of(Lookup::Tree(Search::new(&nodes).unwrap()), &x));
            let mut sorted: Vec<(f64, u32)> =
                nodes.iter().zip(0..).map(|(p, i)| ((p - x).norm_squared().sqrt(), i)).collect();
            sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            assert_eq!(
                all.iter().map(|f| f.1).collect::<Vec<_>>(),
                sorted[..20].iter().map(|f| f.1).collect::<Vec<_>>()
            );
        }
    }
}
