//! Triangles without area.

use crate::surface::change::Change;
use crate::surface::soup::Soup;

/// Drops triangles whose height is not above the tolerance. Their neighbours then meet at T-junctions, which
/// are mended.
pub(super) fn without_thin(soup: &Soup, tolerance: f64) -> (Soup, Option<Change>) {
    let is_thin = |&triangle: &usize| {
        let [a, b, c] = soup.corners(triangle);
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        (b - a).cross(&(c - a)).norm() <= tolerance * longest
    };
    let (thin, kept): (Vec<usize>, Vec<usize>) = (0..soup.triangles.len()).partition(is_thin);
    let change = Change::at("triangles without area dropped", thin.iter().map(|&t| soup.middle(t)));
    (soup.of_triangles(&kept), change)
}
