//! Integration points on faces, shared by smoothing, tractions and supports. The points of a triangle depend
//! on its three corners alone, neither on the side from which the triangle is seen nor on the order of its
//! corners. The integration constraint therefore holds to rounding.

use geometry::quadrature::{self, Parts, Rule};
use geometry::{CellKind, Facet, Mesh};
use shape::{FluxRows, Point3, SurfaceRows, Vector3};

use crate::approximation::Approximation;
use crate::error::EfgError;
use crate::info::MlsInfo;

/// Points, weights (m^2) and outward unit normals on a list of facets.
struct FacetPoints {
    points: Vec<Point3>,
    cells: Vec<u32>,
    weights: Vec<f64>,
    normals: Vec<Vector3>,
}

/// Computes shape values on boundary facets of a background of tet4 and hex8, for tractions and constraints.
/// There are `face_points` points per triangle (symmetric rules) or, if the number is a square, per
/// quadrilateral (Gauss).
///
/// With the same `face_points` as in [`crate::smoothed_rows`] the points on triangles are identical bit for
/// bit.
pub fn surface_rows(
    approximation: &Approximation,
    background: &Mesh,
    facets: &[Facet],
    face_points: usize,
) -> Result<(SurfaceRows, MlsInfo), EfgError> {
    divided_surface_rows(approximation, background, facets, face_points, &[])
}

/// Computes [`surface_rows`] with the points on parts of the facets: a division for each facet, or an empty
/// list for whole facets.
pub(crate) fn divided_surface_rows(
    approximation: &Approximation,
    background: &Mesh,
    facets: &[Facet],
    face_points: usize,
    parts: &[Parts],
) -> Result<(SurfaceRows, MlsInfo), EfgError> {
    let FacetPoints { points, cells, weights, normals } =
        facet_points(background, facets, face_points, parts)?;
    let (at, info) = approximation.point_rows_in(points, Some(&|| cells.clone()))?;
    Ok((SurfaceRows::new(at, weights, normals)?, info))
}

/// Computes [`surface_rows`] with gradients (1/m), for the boundary stress of Nitsche's method. The gradients
/// are those of the shape functions themselves, not smoothed gradients.
pub fn flux_rows(
    approximation: &Approximation,
    background: &Mesh,
    facets: &[Facet],
    face_points: usize,
) -> Result<(FluxRows, MlsInfo), EfgError> {
    let FacetPoints { points, cells, weights, normals } = facet_points(background, facets, face_points, &[])?;
    let (at, info) = approximation.grad_rows_in(points, Some(&|| cells.clone()))?;
    Ok((FluxRows::new(at, weights, normals)?, info))
}

/// Returns the symmetric rule with `points` points on the reference triangle.
pub(crate) fn triangle_rule(points: usize) -> Result<Rule<2>, EfgError> {
    let offered = "see geometry::quadrature::TRI_RULES";
    quadrature::tri(points).ok_or(EfgError::NoRule { what: "triangle", points, offered })
}

/// Returns a triangle by ascending corner numbers, and whether this reversed its normal.
pub(crate) fn canonical([a, b, c]: [u32; 3]) -> ([u32; 3], bool) {
    let mut sorted = [a, b, c];
    sorted.sort_unstable();
    let even = sorted == [a, b, c] || sorted == [b, c, a] || sorted == [c, a, b];
    (sorted, !even)
}

/// Returns the vector area (m^2) of the triangle of canonical corners: its normal times its area.
pub(crate) fn vector_area(mesh: &Mesh, corners: [u32; 3]) -> Vector3 {
    let [p, q, r] = corners.map(|n| mesh.points()[n as usize]);
    (q - p).cross(&(r - p)) / 2.0
}

/// Appends the rule's points on the triangle of canonical corners.
pub(crate) fn triangle_points(mesh: &Mesh, corners: [u32; 3], rule: &Rule<2>, points: &mut Vec<Point3>) {
    let [p, q, r] = corners.map(|n| mesh.points()[n as usize]);
    points.extend(rule.points.iter().map(|xi| p + (q - p) * xi[0] + (r - p) * xi[1]));
}

fn facet_points(
    mesh: &Mesh,
    facets: &[Facet],
    face_points: usize,
    parts: &[Parts],
) -> Result<FacetPoints, EfgError> {
    let mut out =
        FacetPoints { points: Vec::new(), cells: Vec::new(), weights: Vec::new(), normals: Vec::new() };
    let (mut triangle, mut quadrilateral) = (None, None);
    for (k, &facet) in facets.iter().enumerate() {
        let divided = parts.get(k).copied().filter(|parts| *parts != Parts::WHOLE);
        let (cell, kind) = (facet.cell as usize, mesh.kind(facet.cell as usize));
        match kind {
            CellKind::Tet4 => {
                let rule = match triangle.take() {
                    Some(rule) => rule,
                    None => triangle_rule(face_points)?,
                };
                let parts = divided.map(|parts| parts.tri(&rule));
                on_triangle(mesh, facet, parts.as_ref().unwrap_or(&rule), &mut out)?;
                triangle = Some(rule);
            }
            CellKind::Hex8 => {
                let rule = match quadrilateral.take() {
                    Some(rule) => rule,
                    None => quadrilateral_rule(face_points)?,
                };
                let parts = divided.map(|parts| parts.quad(&rule));
                on_quadrilateral(mesh, facet, parts.as_ref().unwrap_or(&rule), &mut out)?;
                quadrilateral = Some(rule);
            }
            _ => return Err(EfgError::CellKind { cell, kind, what: "a boundary", allowed: "tet4 and hex8" }),
        }
        out.cells.resize(out.points.len(), facet.cell);
    }
    Ok(out)
}

fn quadrilateral_rule(points: usize) -> Result<Rule<2>, EfgError> {
    let offered = "1, 4, 9, .. 100";
    let n = (1..=10).find(|n| n * n == points);
    n.map(quadrature::quad).ok_or(EfgError::NoRule { what: "quadrilateral", points, offered })
}

fn on_triangle(mesh: &Mesh, facet: Facet, rule: &Rule<2>, out: &mut FacetPoints) -> Result<(), EfgError> {
    let mut corners = [0; 3];
    for (slot, node) in corners.iter_mut().zip(mesh.facet_nodes(facet)) {
        *slot = node;
    }
    let (corners, turned) = canonical(corners);
    let outward = vector_area(mesh, corners) * if turned { -1.0 } else { 1.0 };
    let area = outward.norm();
    if !area.is_normal() {
        return Err(EfgError::FlatFacet { cell: facet.cell, face: facet.face });
    }
    triangle_points(mesh, corners, rule, &mut out.points);
    out.weights.extend(rule.weights.iter().map(|w| 2.0 * w * area));
    out.normals.extend(std::iter::repeat_n(outward / area, rule.len()));
    Ok(())
}

fn on_quadrilateral(
    mesh: &Mesh,
    facet: Facet,
    rule: &Rule<2>,
    out: &mut FacetPoints,
) -> Result<(), EfgError> {
    const SIGNS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    for (xi, weight) in rule.points.iter().zip(&rule.weights) {
        let (mut x, mut along, mut across) = (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
        for (node, sign) in mesh.facet_nodes(facet).zip(&SIGNS) {
            let p = mesh.points()[node as usize].coords;
            let (f, g) = (0.5 * (1.0 + sign[0] * xi[0]), 0.5 * (1.0 + sign[1] * xi[1]));
            x += p * (f * g);
            along += p * (0.5 * sign[0] * g);
            across += p * (0.5 * sign[1] * f);
        }
        let normal = along.cross(&across);
        let area = normal.norm();
        if !area.is_normal() {
            return Err(EfgError::FlatFacet { cell: facet.cell, face: facet.face });
        }
        out.points.push(Point3::from(x));
        out.weights.push(weight * area);
        out.normals.push(normal / area);
    }
    Ok(())
}
