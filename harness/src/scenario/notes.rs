//! Warnings about a run before it starts, from its scene and mesh alone.

use std::path::Path;

use cases::scene::{self, Body, Scene, Size};
use catalogue::warning;
use geometry::surface::Treatment;
use geometry::{Mesh, pieces, quality};

use super::file_body;
use crate::discretise::place::{self, tolerance};
use crate::error::{Failure, Key};
use crate::outcome::Warning;

/// Relative difference between requested and actual node counts above which a warning is issued.
const NEAR: f64 = 0.1;
/// Relative difference between the volumes of a mesh and its surface above which a warning is issued. Fine
/// meshes of organs are within 1 %, coarse meshes within 3 %.
const VOLUME: f64 = 0.05;

/// Returns warnings about the scene on this mesh, and about the size of a method with `nodes` nodes.
pub(crate) fn warnings(scene: &Scene, method: &scene::Method, mesh: &Mesh, nodes: usize) -> Vec<Warning> {
    let mut found = Vec::new();
    if !scene.is_moved() {
        let message =
            "nothing moves this body: the scene has no load, no tool and no support that moves".to_string();
        found.push(Warning::new(&warning::NOTHING_MOVES, 0.0, "", message));
    }
    found.extend(scene.regions.iter().enumerate().filter_map(|(index, region)| cut(index, region, mesh)));
    found.extend(method.nodes_of_size().and_then(|asked| other_size(asked, nodes)));
    found.extend(apart(mesh));
    found.extend(other_volume(&scene.body, method, mesh));
    found.extend(treated(&scene.body));
    let of_body = if let Body::File(file) = &scene.body { Some(file) } else { None };
    let of_size = if let Some(Size::File(file)) = method.size() { Some(file) } else { None };
    found.extend(of_size.or(of_body).and_then(|file| left_out(&file.path)));
    found
}

/// Refuses strict bounds of a body whose regions end within cells of this mesh.
///
/// # Errors
/// The first such region.
pub(crate) fn uncut(scene: &Scene, mesh: &Mesh) -> Result<(), Failure> {
    let cut = scene.regions.iter().enumerate().find_map(|(index, region)| cut(index, region, mesh));
    let Some(warning) = cut else { return Ok(()) };
    let problem = format!("has no strict bounds on this mesh: {}", warning.message);
    Err(Failure::input(Key::Scene(warning.place), problem, "end the region at faces of the mesh"))
}

/// Warns of parts of a mesh file other than its mesh.
fn left_out(file: &Path) -> Option<Warning> {
    let mut parts = mesh_files::left_out(file);
    parts.retain(|part| part.kind != mesh_files::Kind::Values);
    let joins = parts.iter().filter(|part| part.kind == mesh_files::Kind::Joins).count();
    (!parts.is_empty()).then(|| {
        let words = match joins {
            0 => "",
            _ => {
                ". The first of these connect or support parts of the body: without them the problem is a different one"
            }
        };
        let list = mesh_files::summary(&parts).join(", ");
        let message = format!("only the mesh of {} is read; ignored parts: {list}{words}", file.display());
        Warning::new(&warning::LEFT_OUT, joins as f64, "body", message)
    })
}

/// Warns of a body in several pieces. Contact acts only between the body and tools: pieces do not interact,
/// even if their faces coincide.
fn apart(mesh: &Mesh) -> Option<Warning> {
    let count = pieces::count(mesh);
    (count > 1).then(|| {
        let help = match pieces::coincident(mesh) {
            0 => "no faces coincide: constrain each piece with a support, or mesh the pieces as one body".to_string(),
            faces => format!(
                "{faces} faces coincide: join the pieces (body = {{ shape = \"file\", ..., join = true }}, or \
                 tissuebench mesh convert --join)"
            ),
        };
        let message =
            format!("consists of {count} pieces that share no node and do not interact; {help}");
        Warning::new(&warning::PIECES_APART, count as f64, "body", message)
    })
}

/// Warns of a mesh with another volume than its surface encloses: cells leave out parts thinner than they
/// are.
fn other_volume(body: &Body, method: &scene::Method, mesh: &Mesh) -> Option<Warning> {
    let (Body::File(file), false) = (body, matches!(method.size(), Some(Size::File(_)))) else { return None };
    // The file was already read to fill its surface.
    let enclosed = file_body::load(file).ok()?.surface.volume();
    let ratio = quality::volumes(mesh).iter().sum::<f64>() / enclosed;
    ((ratio - 1.0).abs() > VOLUME).then(|| {
        let message = format!(
            "the mesh has a volume of {:.4} cm^3, {:+.1} % relative to the volume enclosed by the surface: parts thinner \
             than the cells are left out; take smaller cells (spacing, nodes)",
            1e6 * ratio * enclosed,
            100.0 * (ratio - 1.0)
        );
        Warning::new(&warning::VOLUME_DIFFERS, ratio, "method.size", message)
    })
}

/// Warns of a repaired or wrapped surface, with the changes.
fn treated(body: &Body) -> Option<Warning> {
    let Body::File(file) = body else { return None };
    let (word, key) = match file.treatment {
        Treatment::AsGiven => return None,
        Treatment::Repair => ("repaired", "body.repair"),
        Treatment::Wrap { .. } => ("wrapped", "body.wrap"),
    };
    let body = file_body::load(file).ok()?;
    let mut parts: Vec<String> = body.changes.iter().map(ToString::to_string).collect();
    let farthest = body.gaps.map_or(0.0, |gaps| gaps.from_wrap.max(gaps.from_triangles));
    if body.gaps.is_some() {
        parts.push(format!("the wrap is up to {:.3} mm from the triangles", 1e3 * farthest));
    }
    let message = format!("the surface of {} is {word}: {}", file.path.display(), parts.join("; "));
    (!parts.is_empty()).then(|| Warning::new(&warning::SURFACE_TREATED, farthest, key, message))
}

/// Warns of a node count other than requested. Meshes of closed forms come in steps of size, and those inside
/// a surface depend on how the cells fit.
fn other_size(asked: usize, got: usize) -> Option<Warning> {
    let ratio = got as f64 / asked.max(1) as f64;
    ((ratio - 1.0).abs() > NEAR).then(|| {
        let message = format!(
            "size = {{ nodes = {asked} }} gives {got} nodes, because cell sizes come in steps. Compare by the actual \
             number of nodes, or give spacing"
        );
        Warning::new(&warning::NODES_DIFFER, ratio, "method.size.nodes", message)
    })
}

/// Warns of cells with some corners inside a region and some outside.
fn cut(index: usize, region: &scene::MaterialRegion, mesh: &Mesh) -> Option<Warning> {
    let scene::Place::Where(_) = &region.place else { return None };
    let tolerance = tolerance(mesh);
    let is_cut = |&cell: &usize| {
        // A corner on the border is on neither side.
        let holds = |x| [tolerance, -tolerance].map(|by| place::holds(&region.place, x, by));
        let sides: Vec<[bool; 2]> = mesh.cell_points(cell).map(holds).collect();
        sides.contains(&[true; 2]) && sides.contains(&[false; 2])
    };
    let cells = (0..mesh.cell_count()).filter(is_cut).count();
    let all = mesh.cell_count();
    if cells == 0 {
        return None;
    }
    let share = cells as f64 / all as f64;
    let message = format!(
        "the border of '{}' cuts {cells} of {all} cells ({:.1} %): a cell has the material at its centre, so the \
         border follows the faces of cells",
        region.name,
        100.0 * share
    );
    Some(Warning::new(&warning::REGION_CUT, share, format!("region[{index}].where"), message))
}
