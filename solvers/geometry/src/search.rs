//! Nearest-neighbour and radius search over a fixed set of points.
//!
//! A k-d tree (kiddo) finds candidates. Distances are recomputed here in one way only, and ties are resolved
//! by index, so that results depend only on the points.

use std::num::NonZeroUsize;

use kiddo::{ImmutableKdTree, SquaredEuclidean};

use crate::Point3;

/// Search structure over a fixed set of points, for the nearest points and for all points within a radius.
pub struct Search {
    tree: ImmutableKdTree<f64, 3>,
    points: Vec<[f64; 3]>,
}

/// A point found by a search, with its distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// Index of the point.
    pub index: u32,
    /// Distance in metres.
    pub distance: f64,
}

/// Errors of building a search structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SearchError {
    /// No points, or more points than 32-bit indices allow.
    #[error("{count} points cannot be searched; the number of points has to be 1 to {}", u32::MAX)]
    Count {
        /// Number of points.
        count: usize,
    },
    /// A coordinate that is not a finite number.
    #[error("point {point} has a coordinate that is not finite")]
    NotFinite {
        /// Point index.
        point: usize,
    },
}

impl Search {
    /// Builds the tree.
    ///
    /// # Errors
    /// No points, too many points, or a coordinate that is not finite.
    pub fn new(points: &[Point3]) -> Result<Search, SearchError> {
        let count = points.len();
        if count == 0 || u32::try_from(count).is_err() {
            return Err(SearchError::Count { count });
        }
        if let Some(point) = points.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
            return Err(SearchError::NotFinite { point });
        }
        let points: Vec<[f64; 3]> = points.iter().map(|p| [p.x, p.y, p.z]).collect();
        let tree = ImmutableKdTree::new_from_slice(&points).map_err(|_| SearchError::Count { count })?;
        Ok(Search { tree, points })
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there are no points: always false, since an empty set is an error.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The `k` nearest points (all points if there are fewer), ordered by distance, equal distances by index.
    pub fn nearest(&self, at: &Point3, k: usize) -> Vec<Neighbour> {
        let Some(k) = NonZeroUsize::new(k) else { return Vec::new() };
        let query = [at.x, at.y, at.z];
        // One more point than requested: if it is no farther than the k-th, there is a tie to resolve.
        let items = self.tree.query(&query).nearest_n::<SquaredEuclidean<f64>>(k.saturating_add(1)).execute();
        let mut found: Vec<(f64, u32)> =
            items.iter().map(|i| (self.square(&query, i.item), i.item)).collect();
        found.sort_unstable_by(by_distance_then_index);
        if found.len() > k.get() {
            let reach = found[k.get() - 1].0 * (1.0 + 1e-12);
            if found[k.get()].0 <= reach {
                found.clear();
                self.visit(&query, reach, |square, index| found.push((square, index)));
                found.sort_unstable_by(by_distance_then_index);
            }
            found.truncate(k.get());
        }
        found.into_iter().map(|(square, index)| Neighbour { index, distance: square.sqrt() }).collect()
    }

    /// Index of the nearest point. The tree resolves ties, in the same way on every run.
    pub(crate) fn nearest_one(&self, at: &Point3) -> usize {
        self.tree.query(&[at.x, at.y, at.z]).nearest_one::<SquaredEuclidean<f64>>().execute().item as usize
    }

    /// Indices of all points at a distance of at most `radius` (m), ascending.
    pub fn within(&self, at: &Point3, radius: f64) -> Vec<u32> {
        let mut found = Vec::new();
        self.within_into(at, radius, &mut found);
        found
    }

    /// Writes the result of [`Search::within`] to `found`, which is cleared first and reuses its allocation.
    pub fn within_into(&self, at: &Point3, radius: f64, found: &mut Vec<u32>) {
        found.clear();
        if radius.is_nan() || radius < 0.0 {
            return;
        }
        let square = radius * radius;
        // The tree may round a squared distance differently. The search uses a slightly larger radius and
        // decides here.
        self.visit(&[at.x, at.y, at.z], square * (1.0 + 1e-12), |s, index| {
            if s <= square {
                found.push(index);
            }
        });
        found.sort_unstable();
    }

    fn visit(&self, query: &[f64; 3], square: f64, mut found: impl FnMut(f64, u32)) {
        self.tree
            .query(query)
            .within::<SquaredEuclidean<f64>>(square)
            .unsorted()
            .visit(|item| found(self.square(query, item.item), item.item));
    }

    fn square(&self, query: &[f64; 3], index: u32) -> f64 {
        let p = &self.points[index as usize];
        let d = [p[0] - query[0], p[1] - query[1], p[2] - query[2]];
        d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    }
}

fn by_distance_then_index(a: &(f64, u32), b: &(f64, u32)) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}
