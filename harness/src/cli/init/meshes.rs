//! Meshes of the scene's methods and reference. Places named in the scene must exist in each of them.

use std::sync::Arc;

use cases::scene::{Place, Reference, Scene};
use geometry::{Mesh, Point3};

use super::args::Side;
use crate::discretise::{node_set, place};
use crate::error::Failure;
use crate::scenario::Scenario;

/// Number of constrained corners that hold a cell: three that are not collinear.
const HOLD: usize = 3;

/// Meshes of the methods and of the reference, with their names.
pub(super) struct Meshes(Vec<(String, Arc<Mesh>)>);

impl Meshes {
    /// Makes the meshes of a scene as a run does. Stops with the error of the first mesh that `fits` refuses.
    pub fn new(scene: &Scene, fits: impl Fn(&str, &Mesh) -> Result<(), Failure>) -> Result<Meshes, Failure> {
        let own = scene.methods.iter().map(|method| (method.id.clone(), method.clone()));
        let mut all: Vec<_> = own.collect();
        if let Some(Reference::Method { id, size: Some(size), .. }) = &scene.reference
            && let Some(method) = scene.method(id)
        {
            let mut method = method.clone();
            method.resize(size);
            all.push(("the reference".into(), method));
        }
        let made = all.into_iter().map(|(name, method)| {
            let case = String::new();
            let scenario = Scenario { case, scene, method, level: 0, poisson: None, size_key: None };
            let mesh = scenario.discretise()?.mesh;
            fits(&name, &mesh)?;
            Ok((name, mesh))
        });
        Ok(Meshes(made.collect::<Result<_, Failure>>()?))
    }

    /// Returns the largest distance, m, by which a mesh falls [`short`].
    pub fn shortest(&self, bounds: [Point3; 2], side: Side) -> f64 {
        self.0.iter().map(|(_, mesh)| short(mesh, bounds, side)).fold(0.0, f64::max)
    }

    /// Returns the name of the first mesh with an unconstrained piece, and its number of pieces.
    pub fn unheld(&self, place: &Place) -> Result<Option<(&str, usize)>, Failure> {
        for (name, mesh) in &self.0 {
            let mut held = vec![false; mesh.points().len()];
            node_set::nodes("support[0]", place, mesh)?
                .into_iter()
                .for_each(|node| held[node as usize] = true);
            let (piece, pieces) = pieces(mesh);
            let mut holds = vec![false; pieces];
            for cell in 0..mesh.cell_count() {
                let corners = &mesh.cell(cell)[..mesh.kind(cell).corner_count()];
                if corners.iter().filter(|&&node| held[node as usize]).count() >= HOLD {
                    holds[piece[corners[0] as usize]] = true;
                }
            }
            if holds.contains(&false) {
                return Ok(Some((name, pieces)));
            }
        }
        Ok(None)
    }

    /// Whether a point is inside all meshes.
    pub fn all_have(&self, p: &Point3) -> bool {
        let inside = |mesh: &Mesh| fem::nearest_cells(mesh, &[*p]).is_ok_and(|found| found[0].1 == 0.0);
        self.0.iter().all(|(_, mesh)| inside(mesh))
    }
}

/// Returns the distance, m, by which a mesh falls short of the end of the body on one side.
pub(super) fn short(mesh: &Mesh, bounds: [Point3; 2], side: Side) -> f64 {
    let (axis, sign) = (side.axis(), side.sign());
    let (low, high) = place::bounds(mesh);
    let [end, reached] = [bounds, [low, high]].map(|ends| ends[usize::from(sign > 0.0)][axis]);
    sign * (end - reached)
}

/// Returns the piece of each node, numbered from 0, and the number of pieces. Cells connect their nodes.
fn pieces(mesh: &Mesh) -> (Vec<usize>, usize) {
    let mut above: Vec<usize> = (0..mesh.points().len()).collect();
    fn top(above: &mut [usize], mut node: usize) -> usize {
        while above[node] != node {
            above[node] = above[above[node]];
            node = above[node];
        }
        node
    }
    for cell in 0..mesh.cell_count() {
        let nodes = mesh.cell(cell);
        for two in nodes.windows(2) {
            let (a, b) = (top(&mut above, two[0] as usize), top(&mut above, two[1] as usize));
            above[a.max(b)] = a.min(b);
        }
    }
    let mut number = vec![usize::MAX; above.len()];
    let mut count = 0;
    let piece = (0..above.len()).map(|node| {
        let slot = top(&mut above, node);
        if number[slot] == usize::MAX {
            number[slot] = count;
            count += 1;
        }
        number[slot]
    });
    let piece = piece.collect();
    (piece, count)
}
