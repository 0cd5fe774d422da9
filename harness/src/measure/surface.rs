//! What a run leaves for a view in three dimensions: its surface as the elements have it, at some of its states.

use geometry::{Facet, Mesh, Point3, Search, Vector3};
use reports::{Body, BodyState, Faces, Inside, InsideState, Skin, pack};
use shape::Matrix3;

use super::{Field, Request, Solved, against, compared, states};
use crate::Failure;
use crate::outcome::{State, Tensors, ToolSkin, von_mises};

/// States kept of a run: as many as tell a way. A body of 1000 surface nodes has 20 kB in each.
const KEPT: usize = 6;
/// Cells of the largest mesh whose inside is kept, which takes a megabyte.
const CELLS: usize = 30_000;
/// Points that the difference to the reference is interpolated from.
const NEAREST: usize = 4;

/// Surface, tools and states; `field` is what the request compares.
pub(crate) fn surface(run: &Solved, field: &Field, request: &Request) -> Result<Body, Failure> {
    let all = states(run, KEPT)?;
    let mesh = &all.mesh;
    let mut facets = mesh.boundary();
    let nodes = |facet: &Facet| mesh.facet_nodes(*facet).len();
    facets.sort_by_key(nodes);
    let mut used: Vec<u32> = facets.iter().flat_map(|f| mesh.facet_nodes(*f)).collect();
    used.sort_unstable();
    used.dedup();
    let faces = facets.chunk_by(|a, b| nodes(a) == nodes(b)).map(|alike| {
        let own = alike.iter().flat_map(|f| mesh.facet_nodes(*f));
        let place = |node: u32| used.binary_search(&node).expect("listed above") as u32;
        Faces { nodes: nodes(&alike[0]), indices: pack(own.map(place)) }
    });
    let states: Vec<(&State, Option<Values>)> =
        all.states.iter().map(|s| (s, s.tensors.as_ref().map(|cells| at_nodes(mesh, cells)))).collect();
    Ok(Body {
        points: vectors(used.iter().map(|&n| mesh.points()[n as usize].coords)),
        faces: faces.collect(),
        off: off(run, field, request, used.iter().map(|&n| &mesh.points()[n as usize]))?,
        inside: (mesh.cell_count() <= CELLS).then(|| inside(mesh, &used, &states)),
        cloud: cloud(run)?,
        tools: all.tools.iter().map(skin).collect(),
        states: states.iter().map(|(state, values)| body_state(state, values.as_ref(), &used)).collect(),
        left_out: all.left_out,
    })
}

/// Pressure, von Mises stress and determinant of the deformation gradient at every node.
type Values = Vec<[f32; 3]>;

/// Means over the cells around each node: of the stress, not of its invariants.
fn at_nodes(mesh: &Mesh, cells: &Tensors) -> Values {
    let mut sums = vec![(Matrix3::zeros(), 0.0, 0.0); mesh.points().len()];
    for cell in 0..mesh.cell_count() {
        for &node in mesh.cell(cell) {
            let (stress, j, count) = &mut sums[node as usize];
            *stress += cells.stress[cell];
            *j += cells.det_f[cell];
            *count += 1.0;
        }
    }
    let mean = |(stress, j, count): (Matrix3, f64, f64)| {
        let stress = stress / f64::max(count, 1.0);
        [-stress.trace() / 3.0, von_mises(&stress), j / f64::max(count, 1.0)].map(|v| v as f32)
    };
    sums.into_iter().map(mean).collect()
}

/// How far points of the body are from the reference or the exact solution at the end: interpolated by
/// inverse squares of distances from where that is known, most often at nodes.
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

/// Cells, and nodes on no face; `used` are those on faces, ascending.
fn inside(mesh: &Mesh, used: &[u32], states: &[(&State, Option<Values>)]) -> Inside {
    let mut place = vec![u32::MAX; mesh.points().len()];
    used.iter().zip(0..).for_each(|(&node, k)| place[node as usize] = k);
    let inner: Vec<u32> =
        (0..mesh.points().len() as u32).filter(|&n| place[n as usize] == u32::MAX).collect();
    inner.iter().zip(used.len() as u32..).for_each(|(&node, k)| place[node as usize] = k);
    let mut cells: Vec<usize> = (0..mesh.cell_count()).collect();
    let nodes = |cell: usize| mesh.cell(cell).len();
    cells.sort_by_key(|&cell| nodes(cell));
    let cells = cells.chunk_by(|&a, &b| nodes(a) == nodes(b)).map(|alike| Faces {
        nodes: nodes(alike[0]),
        indices: pack(alike.iter().flat_map(|&cell| mesh.cell(cell)).map(|&node| place[node as usize])),
    });
    let state = |(state, values): &(&State, Option<Values>)| InsideState {
        u: vectors(inner.iter().map(|&n| state.displacement[n as usize])),
        values: values.as_ref().map(|values| packed(values, &inner)),
    };
    Inside {
        points: vectors(inner.iter().map(|&n| mesh.points()[n as usize].coords)),
        cells: cells.collect(),
        states: states.iter().map(state).collect(),
    }
}

fn packed(values: &Values, nodes: &[u32]) -> [String; 3] {
    [0, 1, 2].map(|k| pack(nodes.iter().map(|&n| values[n as usize][k])))
}

/// Nodes of a cloud where they are at the end.
fn cloud(run: &Solved) -> Result<String, Failure> {
    let Solved { method, prepared, solution, .. } = *run;
    if method.interpolates {
        return Ok(String::new());
    }
    let (rows, _) = prepared.source.at_points(method.nodes())?;
    let moved = rows.rows().apply(&solution.u);
    Ok(vectors(method.nodes().iter().zip(moved).map(|(x, u)| x.coords + u)))
}

fn body_state(state: &State, values: Option<&Values>, used: &[u32]) -> BodyState {
    BodyState {
        time: state.time,
        u: vectors(used.iter().map(|&n| state.displacement[n as usize])),
        closures: state.closures.clone(),
        touching: pack(state.touching.iter().flat_map(|(x, gap)| [x.x, x.y, x.z, -gap].map(|v| v as f32))),
        deepest_node: (-state.gap).max(0.0),
        values: values.map(|values| packed(values, used)),
    }
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
