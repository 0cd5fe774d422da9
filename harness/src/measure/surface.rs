//! What a run leaves for a view in three dimensions: its surface as the elements have it, at some of its states.

use geometry::{Facet, Vector3};
use reports::{Body, BodyState, Compared, Faces, Skin, pack};

use super::{Field, Request, Solved, against, compared, states};
use crate::Failure;
use crate::outcome::{State, ToolSkin, von_mises};

/// States kept of a run: as many as tell a way. A body of 1000 surface nodes has 20 kB in each.
const KEPT: usize = 6;

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
    let behind: Vec<usize> = facets.iter().map(|f| f.cell as usize).collect();
    Ok(Body {
        points: vectors(used.iter().map(|&n| mesh.points()[n as usize].coords)),
        faces: faces.collect(),
        compared: against(run, request).map(|against| {
            let places = compared(run, request).iter().zip(&against).map(|(x, u)| x.coords + u);
            let off = field.values.iter().zip(&against).map(|(u, exact)| (u - exact).norm() as f32);
            Compared { points: vectors(places), off: pack(off) }
        }),
        cloud: cloud(run)?,
        tools: all.tools.iter().map(skin).collect(),
        states: all.states.iter().map(|s| state(s, &used, &behind)).collect(),
        left_out: all.left_out,
    })
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

fn state(state: &State, used: &[u32], behind: &[usize]) -> BodyState {
    let values = state.tensors.as_ref().map(|cells| {
        let each = |value: &dyn Fn(usize) -> f64| pack(behind.iter().map(|&cell| value(cell) as f32));
        let stress = |cell: usize| &cells.stress[cell];
        [
            each(&|cell| -stress(cell).trace() / 3.0),
            each(&|cell| von_mises(stress(cell))),
            each(&|cell| cells.det_f[cell]),
        ]
    });
    BodyState {
        time: state.time,
        u: vectors(used.iter().map(|&n| state.displacement[n as usize])),
        closures: state.closures.clone(),
        touching: pack(state.touching.iter().flat_map(|(x, gap)| [x.x, x.y, x.z, -gap].map(|v| v as f32))),
        deepest_node: (-state.gap).max(0.0),
        values,
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
