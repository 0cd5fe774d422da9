//! Nodes of places, and places without faces: edges, points, and sets of nodes of a mesh file.

use geometry::{Mesh, Point3};
use shape::position;

use super::place::{self, Place};
use crate::error::{Failure, Key};

/// Largest distance of a point from its node, relative to the diagonal of the mesh's bounding box. Files round
/// positions to six digits.
const NEAR: f64 = 1e-6;

/// Returns the sorted indices of the nodes in the place: those of its named facets and sets, edges or points, or
/// all mesh nodes that satisfy its comparisons.
///
/// # Errors
/// Returns an error if the mesh lacks a name, if surfaces share no node, or if a point is no node.
pub(crate) fn nodes(key: &str, place: &Place, mesh: &Mesh) -> Result<Vec<u32>, Failure> {
    if !matches!(place, Place::Where(_) | Place::Everywhere) {
        let mut nodes = mesh.facet_group_nodes(&place::facets(key, place, mesh)?);
        nodes.extend(bare(key, place, mesh)?);
        nodes.sort_unstable();
        nodes.dedup();
        return Ok(nodes);
    }
    let tolerance = place::tolerance(mesh);
    Ok((0..mesh.points().len() as u32)
        .filter(|&n| place::holds(place, &mesh.points()[n as usize], tolerance))
        .collect())
}

/// Returns the sorted nodes that belong to the place of the support at `key` but to none of its faces.
///
/// # Errors
/// Returns an error if the mesh lacks a name, if surfaces share no node, or if a point is no node.
fn bare(key: &str, place: &Place, mesh: &Mesh) -> Result<Vec<u32>, Failure> {
    match place {
        Place::On(names) => {
            let sets = names.iter().filter_map(|name| mesh.node_group(name));
            Ok(sorted(sets.flatten().copied().collect()))
        }
        Place::Edge(names) => edge(key, names, mesh),
        Place::At(points) => {
            let each = points.iter().enumerate().map(|(index, at)| node_at(key, index, &(*at).into(), mesh));
            Ok(sorted(each.collect::<Result<_, _>>()?))
        }
        Place::Where(_) | Place::Everywhere => Ok(Vec::new()),
    }
}

/// Returns the points (m) that belong to the place but to none of its faces: those of `at` as they are,
/// otherwise mesh nodes.
///
/// # Errors
/// Returns an error if the mesh lacks a name or if surfaces share no node.
pub(crate) fn points(key: &str, place: &Place, mesh: &Mesh) -> Result<Vec<Point3>, Failure> {
    match place {
        Place::At(points) => Ok(points.iter().map(|at| Point3::from(*at)).collect()),
        _ => Ok(bare(key, place, mesh)?.into_iter().map(|node| mesh.points()[node as usize]).collect()),
    }
}

/// Returns the nodes of a place, without the points of `at` that are no nodes.
///
/// # Errors
/// Returns an error if the mesh lacks a name or if surfaces share no node.
pub(crate) fn known(key: &str, place: &Place, mesh: &Mesh) -> Result<Vec<u32>, Failure> {
    match place {
        Place::At(points) => {
            let nearest = points.iter().map(|at| nearest(&(*at).into(), mesh));
            Ok(sorted(nearest.filter(|(_, off)| is_near(*off, mesh)).map(|(node, _)| node).collect()))
        }
        _ => nodes(key, place, mesh),
    }
}

/// Returns the sorted nodes of a place that names only sets of nodes without faces; `None` for other places.
pub(crate) fn alone(place: &Place, mesh: &Mesh) -> Option<Vec<u32>> {
    let Place::On(names) = place else { return None };
    let set = |name: &String| mesh.node_group(name).filter(|_| mesh.group(name).is_none());
    let sets: Option<Vec<&[u32]>> = names.iter().map(set).collect();
    sets.map(|sets| sorted(sets.concat())).filter(|nodes| !nodes.is_empty())
}

/// Refuses names without faces for a load or a mean at `key`.
///
/// # Errors
/// Returns an error if the place names a set of nodes that is no surface.
pub(crate) fn refuse(key: &str, place: &Place, mesh: &Mesh) -> Result<(), Failure> {
    let Place::On(names) = place else { return Ok(()) };
    let bare = |name: &&String| mesh.group(name).is_none() && mesh.node_group(name).is_some();
    let Some(name) = names.iter().find(bare) else { return Ok(()) };
    let problem = format!("names '{name}', a set of nodes without faces");
    let help = "name a surface; only a force acts on the nodes of a set";
    Err(Failure::input(place::key(place, key), problem, help))
}

fn edge(key: &str, names: &[String], mesh: &Mesh) -> Result<Vec<u32>, Failure> {
    let here = || Key::Scene(format!("{key}.edge"));
    let mut shared: Option<Vec<u32>> = None;
    for name in names {
        let found = match (mesh.group(name), mesh.node_group(name)) {
            (Some(facets), None) if names.len() == 1 => {
                let problem = format!("names '{name}', a surface of {} faces, not an edge", facets.len());
                return Err(Failure::input(here(), problem, "name two surfaces that share the edge"));
            }
            (None, None) => return Err(place::unknown(here(), name, mesh)),
            (facets, nodes) => {
                let of_faces = mesh.facet_group_nodes(facets.unwrap_or_default());
                sorted([of_faces, nodes.unwrap_or_default().to_vec()].concat())
            }
        };
        shared = Some(match shared {
            None => found,
            Some(mut shared) => {
                shared.retain(|node| found.binary_search(node).is_ok());
                shared
            }
        });
    }
    let nodes = shared.unwrap_or_default();
    if nodes.is_empty() {
        let problem = format!("names {}, which share no node of the mesh", names.join(" and "));
        return Err(Failure::input(here(), problem, "name surfaces that meet in an edge or a corner"));
    }
    Ok(nodes)
}

fn node_at(key: &str, index: usize, at: &Point3, mesh: &Mesh) -> Result<u32, Failure> {
    let (node, off) = nearest(at, mesh);
    if is_near(off, mesh) {
        return Ok(node);
    }
    let size = place::size(mesh);
    let problem = format!(
        "{} is no node of the mesh: the nearest, at {}, is {:.3e} mm away",
        position(at, size),
        position(&mesh.points()[node as usize], size),
        1e3 * off
    );
    let help =
        "elements are supported at their nodes: give the position of a node, or a mesh with a node there";
    Err(Failure::input(Key::Scene(format!("{key}.at[{index}]")), problem, help))
}

/// Node nearest to a point, and its distance, m.
fn nearest(at: &Point3, mesh: &Mesh) -> (u32, f64) {
    let distances = mesh.points().iter().map(|x| (x - at).norm());
    let nearest = distances.enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b));
    nearest.map_or((0, f64::INFINITY), |(node, off)| (node as u32, off))
}

fn is_near(off: f64, mesh: &Mesh) -> bool {
    off <= NEAR * place::size(mesh)
}

fn sorted(mut nodes: Vec<u32>) -> Vec<u32> {
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}
