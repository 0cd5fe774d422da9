//! The spacing that makes so many nodes.
//!
//! Inside thin walls the number of nodes jumps, and does not always grow as the spacing shrinks. So the spacings that are tried come from
//! one tree, which the surface alone decides: from coarse to fine, then by halves between the first with enough nodes and the one before it,
//! then some beyond. The wanted number decides only which branch is taken. Where the ways of two numbers part, both have tried a spacing
//! whose nodes lie between them: more nodes wanted are never fewer nodes made.

use super::{MEAN_EDGE, Stuffed, Stuffing, StuffingError, expected_nodes, stuff};
use crate::{Mesh, Surface, quality};

/// Spacings that have half the last: each step makes about 1.4 times the nodes.
const STEPS: f64 = 6.0;
/// Halves between two steps, to about a twentieth of the nodes. More would only close in on spacings where the number jumps, as the
/// lattice meets a plane face there: such a mesh is the worst one of its size.
const HALVES: usize = 3;
/// Parts of a step, and how many of them are tried beyond the first step with enough nodes where none is close: the number often falls
/// again behind a jump.
const PART: f64 = 0.25;
const BEYOND: usize = 6;
/// Steps that are always tried from the first on that fills the body: inside thin walls a finer one often has fewer nodes.
const AHEAD: usize = 4;
/// Parts of the wanted number that are close enough.
const CLOSE: f64 = 0.02;
/// A mesh with less of the surface's volume is not the body: cells larger than a wall is thick fill it here and there.
const WHOLE: f64 = 0.75;
/// No finer spacing is tried than one that makes about so many nodes, and so many times those wanted, while none has filled the body.
const HOPELESS: [f64; 2] = [2e5, 16.0];

/// Fills a surface with about so many nodes: of the spacings that are tried the one whose nodes are nearest by their ratio. More nodes
/// wanted never make fewer.
///
/// # Errors
/// As [`stuff`].
pub fn stuff_with_nodes(
    surface: &Surface,
    nodes: usize,
    doublings: u32,
) -> Result<(Stuffed, f64), StuffingError> {
    Search::new(surface, nodes, doublings, |mesh| mesh.points().len()).nearest()
}

/// The same, for so many nodes of quadratic tetrahedra: corners and the middles of edges.
///
/// # Errors
/// As [`stuff`].
pub fn stuff_with_quadratic_nodes(surface: &Surface, nodes: usize) -> Result<Stuffed, StuffingError> {
    let count = |mesh: &Mesh| mesh.points().len() + edge_count(mesh);
    Search::new(surface, nodes, 0, count).nearest().map(|(stuffed, _)| stuffed)
}

/// Edges of tetrahedra.
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
    /// How far the nodes of the best mesh are off, the mesh and its spacing.
    best: Option<(f64, Stuffed, f64)>,
}

/// What a spacing has against the wanted number.
enum Found {
    Fewer,
    Close,
    More,
}

impl<'a, F: Fn(&Mesh) -> usize> Search<'a, F> {
    fn new(surface: &'a Surface, nodes: usize, doublings: u32, count: F) -> Search<'a, F> {
        Search { surface, wanted: nodes.max(1) as f64, doublings, count, best: None }
    }

    /// The spacing of a step, from that of the body's size on.
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
            // The body is filled from here on.
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

    /// Fills the surface at a spacing, and keeps the mesh if it is the best.
    fn attempt(&mut self, step: f64) -> Result<Found, StuffingError> {
        let spacing = self.spacing(step);
        let stuffed = match stuff(self.surface, Stuffing { spacing, doublings: self.doublings }) {
            Ok(stuffed) if self.is_whole(&stuffed.mesh) => stuffed,
            Ok(_) | Err(StuffingError::TooCoarse { .. }) => return self.hoped(spacing),
            // What is there is the best.
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

    fn is_whole(&self, mesh: &Mesh) -> bool {
        quality::volumes(mesh).iter().sum::<f64>() >= WHOLE * self.surface.volume()
    }

    /// A spacing that does not fill the body has no nodes, unless no spacing will do.
    fn hoped(&self, spacing: f64) -> Result<Found, StuffingError> {
        let nodes = expected_nodes(self.surface.volume(), self.surface.area(), spacing);
        let [at_least, times] = HOPELESS;
        let hopeless = self.best.is_none() && nodes > at_least.max(times * self.wanted);
        if hopeless { Err(StuffingError::TooCoarse { spacing }) } else { Ok(Found::Fewer) }
    }
}
