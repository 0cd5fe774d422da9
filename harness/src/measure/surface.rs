//! Data of a run for the three-dimensional view: the surface of the elements at some of the run's states.

use geometry::{Facet, Mesh, Point3, Search, Vector3};
use nalgebra::{Rotation3, UnitQuaternion};
use records::{BodyState, Faces, Inside, InsideState, RecordedBody, Skin, pack};
use shape::{Matrix3, PointRows};

use super::comparison::against;
use super::comparison::compared;
use super::request::Request;
use super::solved::{Field, Solved};
use super::states;
use super::states::{Recorded, at_mesh, recorded};
use super::stress::Recovered;
use crate::error::Failure;
use crate::outcome::{Moved, State, ToolSkin, von_mises};

/// Number of states kept of a run, enough to show a motion. A body of 1000 surface nodes takes 20 kB for
/// each.
const KEPT: usize = 6;
/// Largest number of cells for which the inside is kept, which takes a megabyte.
const CELLS: usize = 30_000;
/// Number of points from which the difference to the reference is interpolated.
const NEAREST: usize = 4;

/// Surface, tools and states of a run; `field` is the displacement at the points where runs are compared,
/// `source` the part of an error that each cell causes per volume.
pub(crate) fn surface(
    run: &Solved,
    field: &Field,
    request: &Request,
    source: &[f64],
) -> Result<RecordedBody, Failure> {
    let all = states(run, KEPT)?;
    let mesh = &all.mesh;
    let mut facets = mesh.boundary();
    let nodes = |facet: &Facet| mesh.facet_nodes(*facet).len();
    facets.sort_by_key(nodes);
    let points = Points::new(mesh, &facets, run.setup.alike());
    let faces = facets.chunk_by(|a, b| nodes(a) == nodes(b)).map(|alike| {
        let own = alike.iter().flat_map(|f| mesh.facet_nodes(*f).map(|node| (node, f.cell as usize)));
        let index = |(node, cell)| points.index(mesh, node, cell).expect("listed above") as u32;
        Faces { nodes: nodes(&alike[0]), indices: pack(own.map(index)) }
    });
    let rows = at_mesh(run)?;
    let recorded = recorded(run, KEPT);
    let values = |(state, at): (&State, &Recorded)| values(run, &points, state, at, rows.as_ref());
    let values: Vec<Option<Values>> = all.states.iter().zip(&recorded).map(values).collect();
    let states: Vec<(&State, Option<&Values>)> =
        all.states.iter().zip(values.iter().map(Option::as_ref)).collect();
    Ok(RecordedBody {
        points: vectors(points.skin().map(|n| mesh.points()[n].coords)),
        faces: faces.collect(),
        off: off(run, field, request, points.skin().map(|n| &mesh.points()[n]))?,
        source: if source.is_empty() { String::new() } else { pack(at_points(mesh, &points, source)) },
        inside: keeps_inside(mesh).then(|| inside(mesh, &points, &states)),
        cloud: cloud(run)?,
        tools: all.tools.iter().map(skin).collect(),
        states: states.iter().map(|(state, values)| body_state(state, *values, &points)).collect(),
        left_out: all.left_out,
    })
}

/// Whether the inside of a body is kept.
fn keeps_inside(mesh: &Mesh) -> bool {
    mesh.cell_count() <= CELLS
}

/// Points of a body. A node of the mesh is one point for each material that it belongs to, because stress
/// jumps at an interface. A point is given by a node and the first region of a material.
struct Points {
    /// Points on faces in ascending order, followed, if the inside is kept, by the other points in ascending
    /// order.
    all: Vec<(u32, u16)>,
    /// Number of points on faces.
    skin: usize,
    /// First region of the same material, for each region.
    alike: Vec<u16>,
}

impl Points {
    fn new(mesh: &Mesh, facets: &[Facet], alike: Vec<u16>) -> Points {
        let material = |cell: usize| alike[usize::from(mesh.region(cell))];
        let unique = |mut points: Vec<(u32, u16)>| {
            points.sort_unstable();
            points.dedup();
            points
        };
        let of_faces = facets.iter().flat_map(|f| mesh.facet_nodes(*f).map(|n| (n, f.cell as usize)));
        let skin = unique(of_faces.map(|(n, cell)| (n, material(cell))).collect());
        let kept = if keeps_inside(mesh) { mesh.cell_count() } else { 0 };
        let cells = (0..kept).flat_map(|cell| mesh.cell(cell).iter().map(move |&n| (n, cell)));
        let of_cells = cells.map(|(n, cell)| (n, material(cell)));
        let inner = unique(of_cells.filter(|point| skin.binary_search(point).is_err()).collect());
        Points { skin: skin.len(), all: [skin, inner].concat(), alike }
    }

    /// Index of the point of a node in a cell; `None` inside a body whose inside is not kept.
    fn index(&self, mesh: &Mesh, node: u32, cell: usize) -> Option<usize> {
        let point = (node, self.alike[usize::from(mesh.region(cell))]);
        let (skin, inner) = self.all.split_at(self.skin);
        let inside = || Some(self.skin + inner.binary_search(&point).ok()?);
        skin.binary_search(&point).ok().or_else(inside)
    }

    /// Nodes of the points on faces.
    fn skin(&self) -> impl Iterator<Item = usize> {
        self.all[..self.skin].iter().map(|point| point.0 as usize)
    }

    /// Nodes of the points inside.
    fn inner(&self) -> impl Iterator<Item = usize> {
        self.all[self.skin..].iter().map(|point| point.0 as usize)
    }
}

/// Pressure (Pa), von Mises stress (Pa) and determinant of the deformation gradient at every point.
type Values = Vec<[f32; 3]>;

/// Values of a state. `rows` has the shape functions at the points of the mesh if these are not the method's
/// nodes.
fn values(
    run: &Solved,
    points: &Points,
    state: &State,
    at: &Recorded,
    rows: Option<&PointRows>,
) -> Option<Values> {
    let mesh = run.method.mesh();
    let recovered = Recovered::new(run, at.u, at.parameters?, at.time)?;
    let j = at_points(mesh, points, &state.tensors.as_ref()?.det_f);
    let value = |(&(node, region), j): (&(u32, u16), f32)| {
        let x = &mesh.points()[node as usize];
        let stress = match rows {
            Some(rows) => recovered.at(x, region, rows.rows().row(node as usize)),
            None => recovered.at(x, region, (&[node], &[1.0])),
        };
        [(-stress.trace() / 3.0) as f32, von_mises(&stress) as f32, j]
    };
    Some(points.all.iter().zip(j).map(value).collect())
}

/// Means of the values of the cells of its material around each point.
fn at_points(mesh: &Mesh, points: &Points, of_cell: &[f64]) -> impl Iterator<Item = f32> {
    let mut sums = vec![(0.0, 0.0); points.all.len()];
    for (cell, value) in of_cell.iter().enumerate() {
        for &node in mesh.cell(cell) {
            if let Some(k) = points.index(mesh, node, cell) {
                sums[k] = (sums[k].0 + value, sums[k].1 + 1.0);
            }
        }
    }
    sums.into_iter().map(|(sum, count)| (sum / count) as f32)
}

/// Difference (m) of surface points from the reference or the exact solution at the end. It is interpolated
/// with inverse squared distances from the points where it is known, usually the nodes.
fn off<'a>(
    run: &Solved,
    field: &Field,
    request: &Request,
    points: impl Iterator<Item = &'a Point3>,
) -> Result<String, Failure> {
    let Some(against) = against(run, request) else { return Ok(String::new()) };
    let known: Vec<f64> = field.values.iter().zip(&against).map(|(u, exact)| (u - exact).norm()).collect();
    let Ok(search) = Search::new(compared(run, request)) else { return Ok(String::new()) };
    let at = |x: &Point3| {
        let near = search.nearest(x, NEAREST);
        let least = near.first().map_or(0.0, |n| n.distance);
        if least == 0.0 {
            return near.first().map_or(0.0, |n| known[n.index as usize]) as f32;
        }
        let weight = |distance: f64| (least / distance).powi(2);
        let sum: f64 = near.iter().map(|n| weight(n.distance) * known[n.index as usize]).sum();
        (sum / near.iter().map(|n| weight(n.distance)).sum::<f64>()) as f32
    };
    Ok(pack(points.map(at)))
}

/// Cells and inside points of a body.
fn inside(mesh: &Mesh, points: &Points, states: &[(&State, Option<&Values>)]) -> Inside {
    let mut cells: Vec<usize> = (0..mesh.cell_count()).collect();
    let nodes = |cell: usize| mesh.cell(cell).len();
    cells.sort_by_key(|&cell| nodes(cell));
    let index = |(cell, node)| points.index(mesh, node, cell).expect("each is listed") as u32;
    let cells = cells.chunk_by(|&a, &b| nodes(a) == nodes(b)).map(|alike| {
        let own = alike.iter().flat_map(|&cell| mesh.cell(cell).iter().map(move |&node| (cell, node)));
        Faces { nodes: nodes(alike[0]), indices: pack(own.map(index)) }
    });
    let state = |(state, values): &(&State, Option<&Values>)| InsideState {
        u: vectors(points.inner().map(|n| state.displacement[n])),
        values: values.map(|values| packed(&values[points.skin..])),
    };
    Inside {
        points: vectors(points.inner().map(|n| mesh.points()[n].coords)),
        cells: cells.collect(),
        states: states.iter().map(state).collect(),
    }
}

fn packed(values: &[[f32; 3]]) -> [String; 3] {
    [0, 1, 2].map(|k| pack(values.iter().map(|v| v[k])))
}

/// Deformed positions of a cloud's nodes at the end, m; empty for elements.
fn cloud(run: &Solved) -> Result<String, Failure> {
    let Solved { method, prepared, solution, .. } = *run;
    if method.interpolates {
        return Ok(String::new());
    }
    let (rows, _) = prepared.source.at_points(method.nodes())?;
    let moved = rows.rows().apply(&solution.u);
    Ok(vectors(method.nodes().iter().zip(moved).map(|(x, u)| x.coords + u)))
}

fn body_state(state: &State, values: Option<&Values>, points: &Points) -> BodyState {
    BodyState {
        time: state.time,
        u: vectors(points.skin().map(|n| state.displacement[n])),
        tools: state.tools.iter().map(|moved| moved.by.into()).collect(),
        turns: turns(&state.tools),
        touching: pack(state.touching.iter().flat_map(|(x, gap)| [x.x, x.y, x.z, -gap].map(|v| v as f32))),
        deepest_node: (-state.gap).max(0.0),
        values: values.map(|values| packed(&values[..points.skin])),
    }
}

/// Rotations of the tools as unit quaternions; empty if none turns.
fn turns(tools: &[Moved]) -> Vec<[f64; 4]> {
    if tools.iter().all(|moved| moved.rotation.is_none()) {
        return Vec::new();
    }
    let of_tool = |moved: &Moved| {
        let rotation = Rotation3::from_matrix_unchecked(moved.rotation.unwrap_or_else(Matrix3::identity));
        UnitQuaternion::from_rotation_matrix(&rotation).coords.into()
    };
    tools.iter().map(of_tool).collect()
}

fn skin(tool: &ToolSkin) -> Skin {
    Skin {
        points: vectors(tool.points.iter().map(|p| p.coords)),
        quads: pack(tool.quads.iter().flatten().copied()),
        along: tool.along.into(),
    }
}

fn vectors(all: impl Iterator<Item = Vector3>) -> String {
    pack(all.flat_map(|v| v.data.0[0].map(|x| x as f32)))
}
