//! Reading of scene files: parsed, checked, converted, or refused with all findings.

use std::path::Path;

use super::altered::resolved;
use super::document;
use super::error::{ErrorKind, SceneError, unread};
use super::scene::{Scene, SceneKeys};
use super::set::Override;
use super::{fitted, sample, shared, tissue, trained};

/// Reads the scene in a file. Messages name the file by `path` as given.
pub fn load(path: &Path) -> Result<Scene, Vec<SceneError>> {
    load_with(path, &[])
}

/// Reads the scene in a file, with some keys set from outside of the file.
pub fn load_with(path: &Path, overrides: &[Override]) -> Result<Scene, Vec<SceneError>> {
    parse_with(&text_of(path)?, &path.display().to_string(), overrides)
}

/// Reads a scene from text. Messages name it by `file`; paths in the scene are relative to the folder of
/// `file`.
pub fn parse(text: &str, file: &str) -> Result<Scene, Vec<SceneError>> {
    parse_with(text, file, &[])
}

/// Reads a scene from text, with some keys set from outside of the text.
pub fn parse_with(text: &str, file: &str, overrides: &[Override]) -> Result<Scene, Vec<SceneError>> {
    let (keys, origin) = shared::read(text, file, overrides)?;
    let scene = resolved(keys, origin)?;
    sample::driven(&scene)?;
    fitted::driven(&scene)?;
    trained::trainable(&scene)?;
    Ok(scene)
}

/// The JSON schema of scene files.
pub fn schema() -> serde_json::Value {
    tissue::describe(shared::describe(document::schema::<SceneKeys>()))
}

/// The text of a scene or study file.
pub(crate) fn text_of(path: &Path) -> Result<String, Vec<SceneError>> {
    let wrong = |problem: String, help: Option<&str>| {
        vec![SceneError {
            kind: ErrorKind::Invalid,
            file: path.display().to_string(),
            line: 0,
            column: 0,
            key: String::new(),
            found: None,
            problem,
            help: help.map(Into::into),
        }]
    };
    let text = disk::read_text(path, disk::Kind::SCENE)
        .map_err(|bad| wrong(format!("can't be read: {}", unread(&bad)), None))?;
    if text.starts_with("$MeshFormat") {
        let help = "a scene names it: body = { shape = \"file\", path = \"...\", unit = \"mm\" }";
        return Err(wrong("is a mesh file, not a scene".into(), Some(help)));
    }
    Ok(text)
}
