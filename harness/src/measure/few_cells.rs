//! Bodies with fewer than three cells (four linear tetrahedra) across a section that bends or is compressed.

use cases::scene::Dilation;
use catalogue::{metric, warning};
use geometry::{CellKind, Facet, Matrix3, Point3, Vector3};
use shape::position;

use super::solved::Solved;
use crate::discretise::place::{self, Patch};
use crate::error::Failure;
use crate::outcome::{Metric, Warning};

/// Number of cells across below which the warning is given.
const ENOUGH: usize = 3;
/// The same number for linear tetrahedra without a projection: with three of them across, slender parts bend
/// 30 to 45 % too little.
const ENOUGH_STIFF: usize = 4;
/// Margin that is subtracted from both numbers, because oblique cells appear wider.
const MARGIN: f64 = 0.5;
/// Stress jump below which few cells suffice, because the stress is uniform, or linear as in a beam of
/// quadratic cells. With few cells the jump underestimates the error, so this limit is below that of
/// `stress-jump`.
const EVEN: f64 = 0.15;
/// Number of points that are examined.
const PLACES: usize = 64;
/// Smallest cosine of the angle between a face's normal and an axis for which a support along the axis makes
/// the face a symmetry plane.
const ALONG: f64 = 0.999;
/// Relative rounding of a position on the surface.
const ROUNDING: f64 = 1e-9;

/// Triangle of the body's surface.
struct Triangle {
    corners: [Point3; 3],
    /// Outward unit normal.
    normal: Vector3,
    /// Whether the triangle lies on a symmetry plane.
    mirror: bool,
}

/// Warns if half of the strain energy lies where the body has fewer than [`ENOUGH`] cells between its two
/// sides. The cells are counted along the displacement, which is transverse in a body that bends or is
/// compressed, and longitudinal in a body that is stretched or sheared. With an exact solution, the errors
/// are known and there is no warning.
pub(super) fn warning(run: &Solved, metrics: &[Metric]) -> Result<Option<Warning>, Failure> {
    let jump = metrics.iter().find(|m| *m.of.metric == metric::STRESS_JUMP).map(|m| m.value);
    if run.setup.exact.is_some() || run.setup.contact.is_some() || !jump.is_some_and(|jump| jump > EVEN) {
        return Ok(None);
    }
    let surface = surface(run)?;
    let gradients = run.prepared.volume.rows.at().displacement_gradients(&run.solution.u);
    let mut counts: Vec<(f64, usize)> =
        by_energy(run, &gradients).into_iter().map(|q| (cells_across(run, &surface, q), q)).collect();
    counts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(&(cells, q)) = counts.get(counts.len() / 2) else { return Ok(None) };
    let mesh = run.method.mesh();
    let stiff = run.method.dilation == Dilation::Standard && mesh.kind(0) == CellKind::Tet4;
    let enough = if run.method.interpolates && stiff { ENOUGH_STIFF } else { ENOUGH };
    let few = enough as f64 - MARGIN;
    Ok((cells < few).then(|| {
        let at = position(&run.prepared.volume.rows.points()[q], place::size(mesh));
        let below = counts.iter().filter(|(cells, _)| *cells < few).count();
        let message = format!(
            "half of the strain energy lies where the body has at most {cells:.1} cells across in the direction of \
             its displacement (a quadratic cell counts twice), for example at {at}, and {:.0} \
             % of the energy lies where there are fewer than {enough}: forces and displacements may be inaccurate; take \
             smaller cells",
            100.0 * below as f64 / counts.len() as f64
        );
        Warning::new(&warning::FEW_CELLS, cells, "method", message)
    }))
}

/// Integration points that represent equal parts of the strain energy.
fn by_energy(run: &Solved, gradients: &[Matrix3]) -> Vec<usize> {
    let volume = &run.prepared.volume;
    let energy = gradients.iter().enumerate().map(|(q, h)| {
        let strain = (h + h.transpose() + h.transpose() * h) * 0.5;
        volume.rows.weights()[q] * run.setup.materials[volume.region(q)].mu() * strain.norm_squared()
    });
    let sums: Vec<f64> = energy
        .scan(0.0, |sum, e| {
            *sum += e;
            Some(*sum)
        })
        .collect();
    let all = sums.last().copied().unwrap_or(0.0);
    if !(all > 0.0 && all.is_finite()) {
        return Vec::new();
    }
    let at = |k: usize| all * (k as f64 + 0.5) / PLACES as f64;
    (0..PLACES).map(|k| sums.partition_point(|&sum| sum < at(k)).min(sums.len() - 1)).collect()
}

/// Number of cells between the two sides of the body along the displacement of an integration point; infinite
/// if the point does not move or lies between two symmetry planes.
fn cells_across(run: &Solved, surface: &[Triangle], q: usize) -> f64 {
    let rows = &run.prepared.volume.rows;
    let (nodes, values) = rows.rows().row(q);
    let u: Vector3 =
        nodes.iter().zip(values).map(|(&node, &value)| run.solution.u[node as usize] * value).sum();
    let Some(along) = u.try_normalize(0.0) else { return f64::INFINITY };
    let x = &rows.points()[q];
    let (Some(ahead), Some(behind)) = (hit(surface, x, along), hit(surface, x, -along)) else {
        return f64::INFINITY;
    };
    let length = match (ahead.1.mirror, behind.1.mirror) {
        (true, true) => return f64::INFINITY,
        (false, false) => ahead.0 + behind.0,
        _ => 2.0 * (ahead.0 + behind.0),
    };
    let across =
        |triangle: &Triangle| length * along.dot(&triangle.normal).abs() / size(run, nodes, &triangle.normal);
    // A triangle that contains the point itself may be almost parallel to the line.
    let sides =
        [ahead, behind].into_iter().filter(|(distance, triangle)| !triangle.mirror && *distance > 0.0);
    sides.map(|(_, triangle)| across(triangle)).fold(f64::INFINITY, f64::min)
}

/// Extent of the cell of these nodes along a direction, m; half of it for a quadratic cell, and the node
/// spacing for a cloud.
fn size(run: &Solved, nodes: &[u32], along: &Vector3) -> f64 {
    if !run.method.interpolates {
        return run.prepared.spacing;
    }
    let at = || nodes.iter().map(|&node| run.method.nodes()[node as usize].coords.dot(along));
    let extent = at().fold(f64::NEG_INFINITY, f64::max) - at().fold(f64::INFINITY, f64::min);
    if run.method.order == 2 { extent / 2.0 } else { extent }
}

/// Nearest triangle through which a line from a point leaves the body, with its distance, m. The point may
/// lie on the surface itself: a triangle that the line enters there is not counted.
fn hit<'a>(surface: &'a [Triangle], x: &Point3, along: Vector3) -> Option<(f64, &'a Triangle)> {
    let leaves = surface.iter().filter(|triangle| triangle.normal.dot(&along) > 0.0);
    let met = leaves.filter_map(|triangle| Some((triangle.distance(x, &along)?, triangle)));
    met.min_by(|a, b| a.0.total_cmp(&b.0))
}

impl Triangle {
    /// Distance along a direction (Moeller & Trumbore 1997); `None` if the line misses the triangle or the
    /// triangle lies behind. The distance of a point on the triangle is 0; rounding may move it off the
    /// triangle or across an edge.
    fn distance(&self, x: &Point3, along: &Vector3) -> Option<f64> {
        let [a, b, c] = &self.corners;
        let (e, f, s) = (b - a, c - a, x - a);
        let (p, r) = (along.cross(&f), s.cross(&e));
        let det = e.dot(&p);
        let (v, w, t) = (s.dot(&p) / det, along.dot(&r) / det, f.dot(&r) / det);
        // A triangle parallel to the direction gives NaN and is missed.
        let inside = v >= -ROUNDING && w >= -ROUNDING && v + w <= 1.0 + ROUNDING;
        let on = ROUNDING * e.norm();
        (inside && t >= -on).then_some(if t > on { t } else { 0.0 })
    }
}

/// Triangulates the surface of the body.
fn surface(run: &Solved) -> Result<Vec<Triangle>, Failure> {
    let mesh = run.method.mesh();
    let mut mirrors: Vec<(Facet, usize)> = Vec::new();
    for support in &run.setup.supports {
        let [Some(axis), None] = [0, 1].map(|k| (0..3).filter(|&a| support.axes[a]).nth(k)) else { continue };
        let Patch { whole, .. } = place::patch(&support.key, &support.place, mesh)?;
        let still = |facet: &Facet| {
            place::corners(mesh, *facet).iter().all(|x| (support.value)(x).is_ok_and(|u| u[axis] == 0.0))
        };
        mirrors.extend(whole.into_iter().filter(still).map(|facet| (facet, axis)));
    }
    mirrors.sort_unstable();
    let mut triangles = Vec::new();
    for facet in mesh.boundary() {
        let corners = place::corners(mesh, facet);
        for k in 1..corners.len() - 1 {
            let corners = [corners[0], corners[k], corners[k + 1]];
            let Some(normal) = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).try_normalize(0.0)
            else {
                continue;
            };
            let held =
                |axis: usize| normal[axis].abs() > ALONG && mirrors.binary_search(&(facet, axis)).is_ok();
            triangles.push(Triangle { corners, normal, mirror: (0..3).any(held) });
        }
    }
    Ok(triangles)
}
