//! Repairs of small faults: doubled corners and triangles, triangles without area, T-junctions, reversed
//! triangles and small holes. A surface without faults stays as it is.

mod holes;
mod junctions;
mod outwards;
mod thin;

use std::collections::HashSet;

use super::Surface;
use super::change::Change;
use super::digits::rounded;
use super::error::SurfaceProblem;
use super::orientation::consistent;
use super::sides::sides;
use super::soup::Soup;
use super::treated::Treated;

/// Fraction of the diagonal below which corners are merged, and triangles have no height.
const TOLERANCE: f64 = 1e-5;

/// Repairs the triangles and creates their surface, with lengths multiplied by `unit` (m).
pub(super) fn repaired(soup: Soup, unit: f64) -> Result<Treated, SurfaceProblem> {
    if let Ok(surface) = Surface::with_regions(soup.clone(), unit) {
        return Ok(Treated { surface, changes: Vec::new(), gaps: None });
    }
    let soup = soup.welded(0.0).used();
    let tolerance = TOLERANCE * soup.diagonal();
    let mut changes = Vec::new();
    // Triangles that collapse when their corners are merged have no height, and are counted here.
    let (soup, thin) = thin::without_thin(&soup, tolerance);
    changes.extend(thin);
    let (soup, merged) = merged(&soup, tolerance);
    changes.extend(merged);
    let (mut soup, double) = soup.without_doubles();
    changes.extend(Change::at("doubled triangles dropped", double));
    changes.extend(junctions::mend(&mut soup, tolerance));
    let orientation = consistent(&soup, &sides(&soup));
    let reversed = orientation.reversed().into_iter().map(|t| soup.middle(t));
    changes.extend(Change::at("triangles turned like their neighbours", reversed));
    orientation.apply(&mut soup);
    changes.extend(holes::close(&mut soup));
    changes.extend(outwards::turn(&mut soup));
    let surface = Surface::with_regions(soup.used(), unit)?;
    Ok(Treated { surface, changes, gaps: None })
}

/// Merges corners, and drops the triangles that collapse.
fn merged(soup: &Soup, tolerance: f64) -> (Soup, Option<Change>) {
    let merged = soup.welded(tolerance);
    let bits = |p: &crate::Point3| [p.x, p.y, p.z].map(f64::to_bits);
    let kept: HashSet<[u64; 3]> = merged.points.iter().map(bits).collect();
    let gone = soup.points.iter().filter(|p| !kept.contains(&bits(p))).copied();
    let what = format!("corners merged with others closer than {}", rounded(tolerance));
    let change = Change::at(&what, gone);
    (merged, change)
}
