//! Scenes named on the command line.

use std::path::Path;

use cases::scene::{self, Scene, SceneError};
use catalogue::nearest;

use super::args::SceneArgs;
use super::errors::refuse;
use crate::scenario::too_large;
use crate::study::like;

/// Prints why a file is not a scene, or which command takes it if it is a study or a body. Returns the exit
/// code.
pub(super) fn refuse_scene(path: &Path, errors: &[SceneError]) -> u8 {
    if holds_key(path, "run") {
        eprintln!("{0}: is a study, not a scene: tissuebench verify {0} runs it", path.display());
    } else if mesh_files::is_surface(path) || mesh_files::is_mesh(path) {
        eprintln!(
            "{0}: is a body, not a scene: tissuebench init --file {0} writes a scene for the body",
            path.display()
        );
    } else {
        return refuse(errors);
    }
    2
}

/// Loads the scene and returns it with the indices of the selected methods.
pub(super) fn open(args: &SceneArgs) -> Result<(Scene, Vec<usize>), u8> {
    let path = &args.file;
    if cases::import::is_model(path) {
        let scene = super::import::open(path, &args.set)?;
        let chosen = choose(&scene, args)?;
        return Ok((scene, chosen));
    }
    let scene = scene::load_with(path, &args.set).map_err(|errors| refuse_scene(path, &errors))?;
    let chosen = choose(&scene, args)?;
    Ok((scene, chosen))
}

/// Returns the indices of the selected methods, if the scene can run.
pub(super) fn choose(scene: &Scene, args: &SceneArgs) -> Result<Vec<usize>, u8> {
    let ahead = scene.unavailable();
    if !ahead.is_empty() {
        return Err(refuse(&ahead));
    }
    let known: Vec<&str> = scene.methods.iter().map(|m| m.id.as_str()).collect();
    for id in &args.methods {
        if !known.iter().any(|name| like(id, name)) {
            let near = nearest(id, known.iter().copied());
            let near = near.map_or(String::new(), |near| format!("; did you mean '{near}'?"));
            let file = args.file.display();
            eprintln!("{file}: no method '{id}'; known methods are {}{near}", known.join(", "));
            return Err(2);
        }
    }
    let wanted = |name: &str| args.methods.is_empty() || args.methods.iter().any(|id| like(id, name));
    Ok((0..known.len()).filter(|&index| wanted(known[index])).collect())
}

/// Whether a refused file has this top-level key, which distinguishes scenes from studies.
pub(super) fn holds_key(path: &Path, key: &str) -> bool {
    let text = disk::read_text(path, disk::Kind::SCENE).unwrap_or_default();
    text.parse::<toml::Table>().is_ok_and(|table| table.contains_key(key))
}

/// Refuses runs whose cost exceeds any plausible intention. With `force` this is only a warning.
pub(super) fn affordable(found: &[SceneError], force: bool) -> Result<(), u8> {
    for error in found {
        eprintln!("{error}");
    }
    if found.is_empty() || force { Ok(()) } else { Err(2) }
}

/// Applies the same check to some methods of a scene.
pub(super) fn affordable_methods(scene: &Scene, chosen: &[usize], force: bool) -> Result<(), u8> {
    let of = |&index: &usize| too_large(scene, &scene.methods[index], 1.0);
    affordable(&chosen.iter().filter_map(of).collect::<Vec<_>>(), force)
}
