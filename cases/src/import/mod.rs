//! Scenes of the models of other programs: a reader fills a document of keys, which is printed as a scene.
//! The scene refers to the model as its mesh file, so that nodes, elements and sets keep their names and
//! numbers.
//!
//! A part of a model that changes the answer and that no scene can express is refused with its file and line.
//! Every other part that is not in the scene is listed, in the result and as a comment in the scene.

mod abaqus;
mod document;
mod edges;
mod febio;
mod finding;
mod model;
mod units;

use std::path::Path;

pub use finding::Finding;
pub use model::Imported;
pub use units::Units;

use model::Model;

/// Whether a file is a model according to its suffix: `.feb`, or an `.inp` with a step.
pub fn is_model(file: &Path) -> bool {
    let suffix = file.extension().map(|s| s.to_string_lossy().to_lowercase()).unwrap_or_default();
    let has_step = |bytes: Vec<u8>| {
        let mut lines = bytes.split(|&byte| byte == b'\n');
        lines.any(|line| line.get(..5).is_some_and(|start| start.eq_ignore_ascii_case(b"*STEP")))
    };
    match suffix.as_str() {
        "feb" => true,
        "inp" => disk::read(file, disk::Kind::MESH).is_ok_and(has_step),
        _ => false,
    }
}

/// Makes a scene of a model. `path` is the model's path as the scene writes it, relative to its own folder.
/// `step` is the number of a step of a deck, from 1; the last unless given.
///
/// # Errors
/// A file that cannot be read, or all parts of it that change the answer and that no scene can express.
pub fn import(file: &Path, path: &str, units: Units, step: Option<usize>) -> Result<Imported, Vec<Finding>> {
    let name = file.display().to_string();
    let bytes = disk::read(file, disk::Kind::MESH).map_err(|bad| {
        vec![Finding { file: name.clone(), line: 0, what: format!("can't be read: {bad}"), help: None }]
    })?;
    import_bytes(&bytes, &name, path, units, step)
}

/// Makes a scene as [`import`] does, of a model in memory. `name` is the file name in findings.
///
/// # Errors
/// As for [`import`].
pub fn import_bytes(
    bytes: &[u8],
    name: &str,
    path: &str,
    units: Units,
    step: Option<usize>,
) -> Result<Imported, Vec<Finding>> {
    let model = Model { file: name, path, units, step };
    // XML begins with `<`, a deck with `*`.
    let first = bytes.iter().find(|byte| !byte.is_ascii_whitespace() && byte.is_ascii());
    if first == Some(&b'*') || name.to_ascii_lowercase().ends_with(".inp") {
        return abaqus::import(bytes, &model);
    }
    if step.is_some_and(|step| step != 1) {
        let what = "is no deck of CalculiX, whose steps have numbers".to_string();
        return Err(vec![Finding { file: name.into(), line: 0, what, help: None }]);
    }
    febio::import(bytes, &model)
}
