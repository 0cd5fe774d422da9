//! Finds the spacing that gives a requested number of nodes.
//!
//! Inside thin walls the number of nodes jumps, and does not always grow as the spacing shrinks. The spacings
//! tried therefore come from one tree that depends only on the surface. The spacings go from coarse to fine,
//! then by bisection between the first spacing with enough nodes and the spacing before it, then over some
//! finer spacings. The requested number decides only which branch is taken. When the branches of two requests
//! part, both have tried a spacing whose number of nodes lies between the two requests. So a larger request
//! never gives fewer nodes.

use super::fill::fill;
use super::{MEAN_EDGE, Stuffed, Stuffing, StuffingError, expected_nodes};
use crate::mesh::Mesh;
use crate::quality;
use crate::surface::Surface;

/// Number of steps that halve the spacing. Each step increases the number of nodes by a factor of about 1.4.
const STEPS: f64 = 6.0;
/// Number of bisections between two steps, which resolves the number of nodes to about a twentieth. More
/// bisections would only approach spacings at which the number jumps because the lattice meets a plane face.
/// Such a mesh is the worst of its size.
const HALVES: usize = 3;
/// Finer spacings tried after the first step with enough nodes, if no mesh so far is close: their distance as
/// a fraction of a step, and their number. The number of nodes often decreases again after a jump.
const PART: f64 = 0.25;
const BEYOND: usize = 6;
/// Number of steps that are always tried from the first that fills the body. Inside thin walls a finer step
/// often has fewer nodes.
const AHEAD: usize = 4;
/// Relative difference from the requested number at which the search stops.
const CLOSE: f64 = 0.02;
/// Smallest fraction of the surface's volume that a mesh must fill. Cells larger than the thickness of a wall
/// fill it only in places.
const WHOLE: f64 = 0.75;
/// Number of nodes, and multiple of the requested number, beyond which no finer spacing is tried if none has
/// filled the body.
const HOPELESS: [f64; 2] = [2e5, 16.0];

/// Fills a surface with linear tetrahedra that have about `nodes` nodes, with `doublings` as in [`Stuffing`].
/// Returns the mesh and its spacing (m). Several spacings are tried; the mesh returned has the ratio of its
/// number of nodes to `nodes` closest to 1. A larger request never gives fewer nodes.
///
/// # Errors
/// As for [`stuff`].
///
/// [`stuff`]: super::stuff
pub fn stuff_with_nodes(
    surface: &Surface,
    nodes: usize,
    doublings: u32,
) -> Result<(Stuffed, f64), StuffingError> {
    let found = Search::new(surface, nodes, doublings, |mesh| mesh.points().len()).nearest();
    found.map(|(stuffed, spacing)| (stuffed.linear(surface), spacing))
}

/// Fills a surface with quadratic tetrahedra of one size that have about `nodes` nodes, as
/// [`stuff_quadratic`] does.
///
/// # Errors
/// As for [`stuff`].
///
/// [`stuff`]: super::stuff
/// [`stuff_quadratic`]: super::stuff_quadratic
pub fn stuff_quadratic_with_nodes(surface: &Surface, nodes: usize) -> Result<Stuffed, StuffingError> {
    let count = |mesh: &Mesh| mesh.points().len() + edge_count(mesh);
    Search::new(surface, nodes, 0, count).nearest().map(|(stuffed, _)| stuffed.quadratic(surface))
}

/// Number of edges of a tetrahedral mesh.
fn edge_count(mesh: &Mesh) -> usize {
    let of_cell = |cell: usize| {
        let nodes = mesh.cell(cell);
        [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]
            .map(|[a, b]| (nodes[a].min(nodes[b]), nodes[a].max(nodes[b])))
    };
    let mut edges: Vec<(u32, u32)> = (0..mesh.cell_count()).flat_map(of_cell).collect();
    edges.sort_unstable();
    edges.dedup();
    edges.len()
}

struct Search<'a, F> {
    surface: &'a Surface,
    wanted: f64,
    doublings: u32,
    count: F,
    /// Best mesh so far: the logarithm of its ratio of nodes to the requested number, the mesh and its
    /// spacing (m).
    best: Option<(f64, Stuffed, f64)>,
}

/// Number of nodes at a spacing, compared with the requested number.
enum Found {
    Fewer,
    Close,
    More,
}

impl<'a, F: Fn(&Mesh) -> usize> Search<'a, F> {
    fn new(surface: &'a Surface, nodes: usize, doublings: u32, count: F) -> Search<'a, F> {
        Search { surface, wanted: nodes.max(1) as f64, doublings, count, best: None }
    }

    /// Spacing (m) of a step; step 0 is about the size of the body.
    fn spacing(&self, step: f64) -> f64 {
        2.0 * MEAN_EDGE * (2.0 * self.surface.volume()).cbrt() * (-step / STEPS).exp2()
    }

    fn nearest(mut self) -> Result<(Stuffed, f64), StuffingError> {
        let (mut step, mut ahead, mut enough) = (0.0, AHEAD, None);
        while enough.is_none() || ahead > 0 {
            match self.attempt(step)? {
                Found::Close => return self.best(step),
                Found::More => enough = enough.or(Some(step)),
                Found::Fewer => {}
            }
            // The body is filled from this step on.
            ahead -= usize::from(self.best.is_some() && ahead > 0);
            step += 1.0;
        }
        let enough = enough.unwrap_or(step);
        let (mut coarse, mut fine) = (enough - 1.0, enough);
        for _ in 0..HALVES {
            let middle = 0.5 * (coarse + fine);
            match self.attempt(middle)? {
                Found::Close => return self.best(middle),
                Found::More => fine = middle,
                Found::Fewer => coarse = middle,
            }
        }
        for part in 1..=BEYOND {
            if let Found::Close = self.attempt(enough + PART * part as f64)? {
                break;
            }
        }
        self.best(fine)
    }

    fn best(self, step: f64) -> Result<(Stuffed, f64), StuffingError> {
        let spacing = self.spacing(step);
        self.best.map(|(_, stuffed, spacing)| (stuffed, spacing)).ok_or(StuffingError::TooCoarse { spacing })
    }

    /// Fills the surface at the spacing of a step, and keeps the mesh if it is the best.
    fn attempt(&mut self, step: f64) -> Result<Found, StuffingError> {
        let spacing = self.spacing(step);
        let stuffed = match fill(self.surface, Stuffing { spacing, doublings: self.doublings }) {
            Ok(stuffed) if self.is_whole(&stuffed.mesh) => stuffed,
            Ok(_) | Err(StuffingError::TooCoarse { .. } | StuffingError::RegionTooSmall { .. }) => {
                return self.hoped(spacing);
            }
            // The best mesh so far is used.
            Err(StuffingError::TooFine { .. }) if self.best.is_some() => return Ok(Found::More),
            Err(bad) => return Err(bad),
        };
        let found = (self.count)(&stuffed.mesh) as f64;
        let off = (found / self.wanted).ln().abs();
        if self.best.as_ref().is_none_or(|(least, ..)| off < *least) {
            self.best = Some((off, stuffed, spacing));
        }
        Ok(match found < self.wanted {
            _ if off < CLOSE => Found::Close,
            true => Found::Fewer,
            false => Found::More,
        })
    }

    /// Whether a mesh fills the surface, and each of its regions.
    fn is_whole(&self, mesh: &Mesh) -> bool {
        let volumes = quality::volumes(mesh);
        let in_region = |region: usize| {
            let own =
                volumes.iter().enumerate().filter(|(cell, _)| usize::from(mesh.region(*cell)) == region);
            own.map(|(_, volume)| volume).sum::<f64>()
        };
        volumes.iter().sum::<f64>() >= WHOLE * self.surface.volume()
            && (self.surface.regions().iter().enumerate())
                .all(|(at, region)| in_region(at) >= WHOLE * region.surface.volume())
    }

    /// Treats a spacing that does not fill the body as one with too few nodes.
    ///
    /// # Errors
    /// [`StuffingError::TooCoarse`] if no finer spacing is worth trying.
    fn hoped(&self, spacing: f64) -> Result<Found, StuffingError> {
        let nodes = expected_nodes(self.surface.volume(), self.surface.area(), spacing);
        let [at_least, times] = HOPELESS;
        let hopeless = self.best.is_none() && nodes > at_least.max(times * self.wanted);
        if hopeless { Err(StuffingError::TooCoarse { spacing }) } else { Ok(Found::Fewer) }
    }
}
