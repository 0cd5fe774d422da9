//! Wraps: closed surfaces around triangles that may be open, crossing, branched or partly reversed.
//!
//! A position is inside where the winding number of the triangles is above 1/2. The surface between the inner
//! and outer points of a lattice is extracted by marching tetrahedra. It is closed, branches nowhere and does
//! not cross itself.

mod error;
mod lattice;
mod marching;
mod sense;

pub use error::WrapProblem;

use rayon::prelude::*;

use super::change::Change;
use super::error::SurfaceProblem;
use super::samples::{farthest, samples};
use super::soup::{Soup, WELD};
use super::treated::{Gaps, Treated};
use super::tree::Tree;
use super::winding::Winding;
use super::{Surface, closed, nested};
use crate::Point3;
use lattice::Lattice;

/// Volume, in cells, below which islands and cavities are left out.
const SPECK: f64 = 8.0;
/// Smallest number of triangles per parallel task.
const CHUNK: usize = 64;
/// Largest spacing of sample points on a triangle, as a fraction of the diagonal of the triangles.
const APART: f64 = 1.0 / 100.0;

/// Wraps the triangles, with lengths multiplied by `unit` (m), at cells of the edge length `size` (m).
pub(super) fn wrapped(soup: Soup, unit: f64, size: f64) -> Result<Treated, SurfaceProblem> {
    let same = soup.welded(0.0);
    let mut soup = same.welded(WELD * same.diagonal()).without_doubles().0;
    if soup.triangles.is_empty() {
        return Err(SurfaceProblem::TooFew { triangles: 0 });
    }
    soup.points.iter_mut().for_each(|p| *p *= unit);
    let (sensed, mut changes) = sense::sensed(&soup);
    if sensed.triangles.is_empty() {
        return Err(WrapProblem::Empty { size }.into());
    }
    let winding = Winding::new(Tree::new(&sensed.points, &sensed.triangles));
    let lattice = Lattice::new(&winding, size)?;
    changes.extend(Change::at("cells in which bodies overlap, counted once", lattice.doubled()));
    let (points, triangles) = marching::surface(&lattice, &winding);
    let tree = Tree::new(&soup.points, &soup.triangles);
    let faces = (1..=triangles.len() as u32).collect();
    let wrap = Soup { points, triangles, faces, ..Soup::default() };
    let (mut wrap, specks) = without_specks(&wrap, SPECK * size.powi(3))?;
    changes.extend(specks);
    changes.iter_mut().flat_map(|change| &mut change.places).for_each(|p| *p /= unit);
    if wrap.triangles.is_empty() {
        return Err(WrapProblem::Empty { size }.into());
    }
    if !soup.groups.names().is_empty() {
        let closest =
            |t: usize| tree.closest(&wrap.middle(t), f64::INFINITY).map_or(0, |c| c.triangle as usize);
        let closest: Vec<usize> =
            (0..wrap.triangles.len()).into_par_iter().with_min_len(CHUNK).map(closest).collect();
        wrap.groups = soup.groups.of_triangles(&closest);
    }
    let surface = Surface::new(wrap, 1.0)?;
    let [low, high] = tree.bounds();
    let apart = APART * (high - low).norm();
    let distance = |tree: &Tree, p: &Point3| {
        tree.closest(p, f64::INFINITY).map_or(f64::INFINITY, |closest| closest.square.sqrt())
    };
    let of_wrap = samples(surface.points(), surface.triangles(), apart);
    let of_triangles = samples(&soup.points, &soup.triangles, apart);
    let gaps = Gaps {
        from_wrap: farthest(&of_wrap, &|p| distance(&tree, p)),
        from_triangles: farthest(&of_triangles, &|p| distance(&surface.tree, p)),
    };
    Ok(Treated { surface, changes, gaps: Some(gaps) })
}

/// Leaves out the islands and cavities of a closed surface with less than this volume, m^3.
fn without_specks(soup: &Soup, least: f64) -> Result<(Soup, Option<Change>), SurfaceProblem> {
    if soup.triangles.is_empty() {
        return Ok((soup.clone(), None));
    }
    let parts = nested::parts(&closed::neighbours(soup)?);
    let count = parts.iter().max().map_or(0, |&last| last as usize + 1);
    let (mut volumes, mut first) = (vec![0.0; count], vec![usize::MAX; count]);
    let origin = soup.points[0];
    for (triangle, &part) in parts.iter().enumerate() {
        let [a, b, c] = soup.corners(triangle).map(|p| p - origin);
        volumes[part as usize] += a.dot(&b.cross(&c)) / 6.0;
        first[part as usize] = first[part as usize].min(triangle);
    }
    let is_small = |part: usize| volumes[part].abs() < least;
    let kept: Vec<usize> = (0..parts.len()).filter(|&t| !is_small(parts[t] as usize)).collect();
    let small = (0..count).filter(|&part| is_small(part)).map(|part| soup.middle(first[part]));
    let change = Change::at("islands and cavities of less than 8 cells left out", small);
    Ok((soup.of_triangles(&kept), change))
}
