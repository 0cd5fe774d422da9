//! Data of a run for the pictures: the deformed surface, the tools at their positions, and a section between
//! the tools with its pressure.

use geometry::{Mesh, Point3, Vector3};
use records::{Section, SectionCell, SurfaceField, ToolHull};

use super::mean_pressure;
use super::solved::Solved;
use super::states::at_mesh;
use crate::error::Failure;
use crate::outcome::{Identity, LoadStep};
use crate::scenario::PlacedTool;

/// Displacement of the boundary's corner nodes (m), and, if there are tools, their hulls and a section.
/// `last` has the positions of the tools; `None` for a linear procedure.
pub(crate) fn picture(
    identity: &Identity,
    run: &Solved,
    last: Option<&LoadStep>,
) -> Result<SurfaceField, Failure> {
    let Solved { method, setup, solution, .. } = *run;
    let u = &solution.u;
    let mesh = method.mesh();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for facet in mesh.boundary() {
        let corners: Vec<u32> = mesh.facet_corners(facet).collect();
        triangles.extend((1..corners.len() - 1).map(|k| [corners[0], corners[k], corners[k + 1]]));
    }
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    for corner in triangles.iter_mut().flatten() {
        *corner = used.binary_search(corner).expect("listed above") as u32;
    }
    let of_mesh = at_mesh(run)?.map_or_else(|| u.clone(), |rows| rows.rows().apply(u));
    let closures = last.iter().flat_map(|step| step.tools.iter().map(|t| t.closure));
    let tools: Vec<ToolHull> =
        setup.tools.iter().zip(closures).map(|(set, closure)| hull(set, closure, mesh)).collect();
    let section = match (setup.tools.first(), last) {
        (Some(tool), Some(_)) => section(tool, run, &of_mesh),
        _ => None,
    };
    Ok(SurfaceField {
        case: identity.case.clone(),
        method: identity.method.clone(),
        family: identity.family,
        title: format!("{} ({} nodes)", identity.method, method.nodes().len()),
        points: used.iter().map(|&n| mesh.points()[n as usize].coords.into()).collect(),
        triangles,
        displacement: used.iter().map(|&n| of_mesh[n as usize].into()).collect(),
        tools,
        section,
        body: None,
    })
}

/// Extent of the body along each axis, m.
fn extent(mesh: &Mesh) -> Vector3 {
    let first = mesh.points()[0].coords;
    let (low, high) =
        mesh.points().iter().fold((first, first), |(low, high), p| (low.inf(&p.coords), high.sup(&p.coords)));
    high - low
}

/// Points whose convex hull is the tool at a closure (m); for a plate, a slab as wide as the body.
fn hull(set: &PlacedTool, closure: f64, mesh: &Mesh) -> ToolHull {
    let points = set.tool.shape().outline(extent(mesh).max());
    let pose = set.tool.pose(closure);
    ToolHull {
        name: set.name.clone(),
        points: points.iter().map(|p| (pose.place + pose.rotation * p).into()).collect(),
    }
}

/// Section by the undeformed plane through the first tool's position, spanned by the tool's direction of
/// travel and the axis of the body's longest extent across it. Each cut cell has its mean pressure. `None` if
/// the quadrature is not per cell.
fn section(tool: &PlacedTool, run: &Solved, of_mesh: &[Vector3]) -> Option<Section> {
    let Solved { method, setup, prepared, solution } = *run;
    let mesh = method.mesh();
    let weights = prepared.volume.rows.weights();
    let starts = prepared.source.cell_points()?;
    let right = tool.tool.along();
    let extent = extent(mesh);
    let across = |axis: &usize| extent[*axis] * (1.0 - right[*axis].powi(2));
    let longest = (0..3).max_by(|a, b| across(a).total_cmp(&across(b))).unwrap_or(1);
    let up = Vector3::ith(longest, 1.0);
    let up = (up - right * right.dot(&up)).normalize();
    let normal = right.cross(&up);
    let from = tool.tool.place(0.0);
    let gradients = prepared.volume.rows.at().displacement_gradients(&solution.u);
    let active = prepared.active(setup, solution.time());
    let pressure =
        mean_pressure::at_points((&setup.laws, &active), &prepared.volume, &gradients, &solution.pressure);
    let side: Vec<f64> = mesh.points().iter().map(|x| normal.dot(&(x - from))).collect();
    let cells = (0..mesh.cell_count()).filter_map(|cell| {
        let corners = cut(mesh, cell, &side, of_mesh, (&right, &up))?;
        let points = starts[cell]..starts[cell + 1];
        let volume: f64 = weights[points.clone()].iter().sum();
        let sum: f64 = points.map(|q| weights[q] * pressure[q]).sum();
        Some(SectionCell { corners, pressure: sum / volume })
    });
    Some(Section { right: right.into(), up: up.into(), cells: cells.collect() })
}

/// Polygon in which a plane cuts a cell's straight edges: deformed corners (m) in order around the cut;
/// `None` if the plane misses the cell.
fn cut(
    mesh: &Mesh,
    cell: usize,
    side: &[f64],
    u: &[Vector3],
    (right, up): (&Vector3, &Vector3),
) -> Option<Vec<[f64; 3]>> {
    let nodes = mesh.cell(cell);
    let met = mesh.kind(cell).edges().iter().filter_map(|ends| {
        let [a, b] = ends.map(|k| nodes[k] as usize);
        // A node in the plane counts as above the plane, so that a face in the plane is cut once, not twice.
        if (side[a] < 0.0) == (side[b] < 0.0) {
            return None;
        }
        let t = side[a] / (side[a] - side[b]);
        let x = mesh.points()[a].coords.lerp(&mesh.points()[b].coords, t);
        Some((x, x + u[a].lerp(&u[b], t)))
    });
    let mut met: Vec<(Vector3, Vector3)> = met.collect();
    if met.len() < 3 {
        return None;
    }
    let middle = met.iter().map(|m| m.0).sum::<Vector3>() / met.len() as f64;
    let angle = |x: &Vector3| (x - middle).dot(up).atan2((x - middle).dot(right));
    met.sort_by(|a, b| angle(&a.0).total_cmp(&angle(&b.0)));
    Some(met.iter().map(|m| Point3::from(m.1).coords.into()).collect())
}
