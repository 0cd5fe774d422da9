//! Mesh quality: volumes, Jacobians, dihedral angles and aspect, each with the worst element.

use crate::element::CellKind;
use crate::mesh::Mesh;
use crate::{Point3, Vector3, element, quadrature};

/// Error of a mesh with inverted cells; describes the first of them.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("element {element} is inverted: det J = {det_j:e} m^3 (it has to be positive)")]
pub struct InvertedElement {
    /// Cell index.
    pub element: usize,
    /// Smallest Jacobian determinant in this cell, m^3.
    pub det_j: f64,
    /// Number of inverted cells.
    pub inverted: usize,
    /// Number of all cells.
    pub cells: usize,
}

/// Extreme value of a quality measure and its cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// Cell index.
    pub element: usize,
    /// The extreme value, in the unit of the measure.
    pub value: f64,
}

/// Volume and extreme quality measures of a mesh ([`check`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Quality {
    /// Volume of the whole mesh (m^3), curved cells included.
    pub volume: f64,
    /// Smallest cell volume (m^3).
    pub min_volume: Extreme,
    /// Largest cell volume (m^3).
    pub max_volume: Extreme,
    /// Smallest `det J` (m^3) over all nodes and over the points of a rule that integrates `det J` exactly.
    pub min_det_j: Extreme,
    /// Smallest ratio of lowest to highest `det J` within a cell; 1 for every straight tetrahedron.
    pub min_det_ratio: Extreme,
    /// Smallest angle (degrees) between two faces, each taken as the plane through its corners at the common
    /// edge.
    pub min_dihedral: Extreme,
    /// Largest such angle (degrees).
    pub max_dihedral: Extreme,
    /// Largest aspect ratio: longest edge times surface over volume, scaled to 1 for the regular cell of each
    /// shape.
    pub max_aspect: Extreme,
}

/// Checks that no cell is inverted, without measuring anything else: a tenth of the time of [`check`].
///
/// # Errors
/// An element with `det J <= 0` at a node or quadrature point. Values up to 1e-12 times the cube of the
/// longest edge count as zero.
pub fn check_inversion(mesh: &Mesh) -> Result<(), InvertedElement> {
    each_cell(mesh, |_, _, _, _| {})
}

/// Measures the quality of a mesh.
///
/// # Errors
/// As for [`check_inversion`].
pub fn check(mesh: &Mesh) -> Result<Quality, InvertedElement> {
    let mut quality: Option<Quality> = None;
    each_cell(mesh, |element, kind, points, Determinants { low, high, volume }| {
        let (sharp, blunt) = dihedrals(kind, points);
        let aspect = aspect(kind, points, volume);
        let at = |value| Extreme { element, value };
        let here = Quality {
            volume,
            min_volume: at(volume),
            max_volume: at(volume),
            min_det_j: at(low),
            min_det_ratio: at(low / high),
            min_dihedral: at(sharp),
            max_dihedral: at(blunt),
            max_aspect: at(aspect),
        };
        quality = Some(match quality.take() {
            None => here,
            Some(so_far) => so_far.joined(here),
        });
    })?;
    Ok(quality.expect("a mesh has at least one cell"))
}

/// Smallest and largest `det J` of a cell (m^3) and its volume (m^3).
struct Determinants {
    low: f64,
    high: f64,
    volume: f64,
}

/// Calls `visit` with the index, kind, nodes and determinants of every cell that is not inverted.
///
/// # Errors
/// As for [`check_inversion`].
fn each_cell(
    mesh: &Mesh,
    mut visit: impl FnMut(usize, CellKind, &[Point3], Determinants),
) -> Result<(), InvertedElement> {
    let mut folded: Option<InvertedElement> = None;
    let probes = CellKind::ALL.map(probe_points);
    let mut points = Vec::new();
    for element in 0..mesh.cell_count() {
        let kind = mesh.kind(element);
        points.clear();
        points.extend(mesh.cell_points(element).copied());
        let (rule, nodes) = &probes[kind as usize];
        let det = |xi: &[f64; 3]| element::map(kind, &points, *xi).1.determinant();
        let (mut low, mut high, mut volume) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        for (xi, w) in rule.points.iter().zip(&rule.weights) {
            let d = det(xi);
            volume += w * d;
            (low, high) = (low.min(d), high.max(d));
        }
        for xi in *nodes {
            let d = det(xi);
            (low, high) = (low.min(d), high.max(d));
        }
        // Rounding leaves a flat cell a determinant of 1e-17 rather than 0, so the threshold is relative to
        // the cell's size.
        let longest = longest_edge(kind, &points);
        if low.is_nan() || low <= 1e-12 * longest.powi(3) {
            let first = InvertedElement { element, det_j: low, inverted: 0, cells: mesh.cell_count() };
            folded.get_or_insert(first).inverted += 1;
        } else {
            visit(element, kind, &points, Determinants { low, high, volume });
        }
    }
    folded.map_or(Ok(()), Err)
}

/// Aspect ratio as in [`Quality::max_aspect`].
fn aspect(kind: CellKind, points: &[Point3], volume: f64) -> f64 {
    longest_edge(kind, points) * surface(kind, points) / volume / kind.entry().cell.regular_aspect
}

/// Volume, aspect ratio and angles of one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellShape {
    /// Volume (m^3), negative if the cell is inverted.
    pub volume: f64,
    /// Aspect ratio: longest edge times surface over volume, scaled to 1 for the regular cell of each shape;
    /// infinite if the volume is not positive.
    pub aspect: f64,
    /// Smallest and largest angle (degrees) between two faces.
    pub angles: [f64; 2],
}

/// Shapes of all cells, including inverted cells.
pub fn shapes(mesh: &Mesh) -> Vec<CellShape> {
    let shape = |(cell, volume): (usize, f64)| {
        let kind = mesh.kind(cell);
        let points: Vec<Point3> = mesh.cell_points(cell).copied().collect();
        let aspect = if volume > 0.0 { aspect(kind, &points, volume) } else { f64::INFINITY };
        let (low, high) = dihedrals(kind, &points);
        CellShape { volume, aspect, angles: [low, high] }
    };
    volumes(mesh).into_iter().enumerate().map(shape).collect()
}

/// Volume of every cell (m^3), curved cells included; negative if a cell is inverted.
pub fn volumes(mesh: &Mesh) -> Vec<f64> {
    let probes = CellKind::ALL.map(probe_points);
    (0..mesh.cell_count())
        .map(|cell| {
            let kind = mesh.kind(cell);
            let points: Vec<Point3> = mesh.cell_points(cell).copied().collect();
            let rule = &probes[kind as usize].0;
            (rule.points.iter().zip(&rule.weights))
                .map(|(xi, w)| w * element::map(kind, &points, *xi).1.determinant())
                .sum()
        })
        .collect()
}

impl Quality {
    fn joined(self, other: Quality) -> Quality {
        let least = |a: Extreme, b: Extreme| if b.value < a.value { b } else { a };
        let most = |a: Extreme, b: Extreme| if b.value > a.value { b } else { a };
        Quality {
            volume: self.volume + other.volume,
            min_volume: least(self.min_volume, other.min_volume),
            max_volume: most(self.max_volume, other.max_volume),
            min_det_j: least(self.min_det_j, other.min_det_j),
            min_det_ratio: least(self.min_det_ratio, other.min_det_ratio),
            min_dihedral: least(self.min_dihedral, other.min_dihedral),
            max_dihedral: most(self.max_dihedral, other.max_dihedral),
            max_aspect: most(self.max_aspect, other.max_aspect),
        }
    }
}

/// Quadrature rule that integrates `det J` exactly, and the nodes; no nodes if `det J` is constant.
fn probe_points(kind: CellKind) -> (quadrature::Rule<3>, &'static [[f64; 3]]) {
    let entry = kind.entry();
    let nodes = if kind == CellKind::Tet4 { &[] } else { entry.nodes };
    ((entry.cell.rule)(entry.points.volume).expect("a tabulated rule"), nodes)
}

fn longest_edge(kind: CellKind, points: &[Point3]) -> f64 {
    let squares = kind.edges().iter().map(|&[a, b]| nalgebra::distance_squared(&points[a], &points[b]));
    squares.fold(0.0, f64::max).sqrt()
}

/// Area of the faces, each as the sum of the triangles around the mean of its corners.
fn surface(kind: CellKind, points: &[Point3]) -> f64 {
    let face_area = |face: usize| -> f64 {
        let face = kind.face_corners(face);
        let corners = face.len();
        let mean = face.iter().map(|&n| points[n].coords).sum::<Vector3>() / corners as f64;
        (0..corners)
            .map(|i| {
                let (a, b) = (points[face[i]].coords - mean, points[face[(i + 1) % corners]].coords - mean);
                0.5 * a.cross(&b).norm()
            })
            .sum()
    };
    (0..kind.faces().len()).map(face_area).sum()
}

/// Smallest and largest angle (degrees) between faces that share an edge. At an edge of a quadrilateral the
/// face is taken as the plane through the edge and the corner adjacent to its start.
pub(crate) fn dihedrals(kind: CellKind, points: &[Point3]) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for &[a, b] in kind.edges() {
        let along = (points[b] - points[a]).normalize();
        let mut arms = (0..kind.faces().len()).filter_map(|face| {
            let face = kind.face_corners(face);
            let corners = face.len();
            let at = face.iter().position(|&n| n == a)?;
            let next = face[(at + 1) % corners];
            let previous = face[(at + corners - 1) % corners];
            let other = if next == b {
                previous
            } else if previous == b {
                next
            } else {
                return None;
            };
            let arm = points[other] - points[a];
            Some((arm - along * along.dot(&arm)).normalize())
        });
        if let (Some(u), Some(v)) = (arms.next(), arms.next()) {
            let angle = u.dot(&v).clamp(-1.0, 1.0).acos().to_degrees();
            (low, high) = (low.min(angle), high.max(angle));
        }
    }
    (low, high)
}
