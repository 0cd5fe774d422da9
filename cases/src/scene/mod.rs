//! Scene and study files: parsed, checked and turned into SI numbers, or refused with all findings at their
//! places.
//!
//! A scene is one TOML file. Its keys are types (`keys`) from which the schema is generated. A file is
//! checked against that schema, so the two cannot diverge. A valid file becomes a [`Scene`], which has no
//! text left to parse. Methods that several scenes share are in a separate file (`shared`).

mod available;
mod axis;
mod conform;
mod coverage;
mod demands;
mod document;
mod error;
mod expression;
mod external;
mod family;
mod field;
mod keys;
mod limits;
mod material;
mod method;
mod model;
mod output;
mod procedure;
mod purpose;
mod region;
mod report;
mod resolve;
mod set;
mod shared;
mod sources;
mod study;
mod tool;
mod units;
mod validate;
mod vocabulary;
mod words;

use std::path::Path;

pub use axis::Axis;
pub use document::Origin;
pub use error::{ErrorKind, SceneError};
pub use expression::{Expression, NotFinite};
pub use external::{External, Setting};
pub use family::{FAMILIES, OverMesh};
pub use field::{Prescribed, ScalarField, VectorField};
pub use material::{Material, Relaxation, medium};
pub use method::{
    Basis, Cloud, ConstraintRows, Dilation, Efg, Element, Essential, EssentialKind, Family, Fem, Functions,
    Integration, Jitter, Mass, MeshFile, Method, Refine, Regions, Size, SupportRule, SupportShape,
};
pub use model::{Body, Load, LoadKind, MaterialRegion, Place, Scene, Support};
pub use output::{Bound, Check, Output, Reference, Repeated, Target, Transfer};
pub use procedure::{
    Explicit, Implicit, LinearSolver, Newton, OnStall, Procedure, ProcedureKind, Ramp, Static,
};
pub use purpose::{Publication, Purpose};
pub use region::{Comparison, Region, Relation};
pub use set::Override;
pub use study::{Run, Study, load_study, load_study_for, parse_study};
pub use tool::{Drive, Friction, Tool};

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
    resolved(keys, origin)
}

fn resolved(keys: keys::SceneKeys, origin: Origin) -> Result<Scene, Vec<SceneError>> {
    let mut report = report::Report::new(&origin);
    let scene = resolve::scene(keys, &mut report);
    // Parts that could not be resolved are left out of the scene, so the demands of the other parts on them
    // cannot be checked.
    if let (Some(scene), true) = (&scene, report.is_clean()) {
        validate::scene(scene, &mut report);
        demands::scene(scene, &mut report);
    }
    let errors = report.finish();
    match scene {
        Some(scene) if errors.is_empty() => Ok(scene),
        _ => Err(errors),
    }
}

/// The JSON schema of scene files.
pub fn schema() -> serde_json::Value {
    shared::describe(document::schema::<keys::SceneKeys>())
}

/// The JSON schema of study files.
pub fn study_schema() -> serde_json::Value {
    document::schema::<study::StudyKeys>()
}

fn text_of(path: &Path) -> Result<String, Vec<SceneError>> {
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
        .map_err(|bad| wrong(format!("can't be read: {}", error::unread(&bad)), None))?;
    if text.starts_with("$MeshFormat") {
        let help = "a scene names it: body = { shape = \"file\", path = \"...\", unit = \"mm\" }";
        return Err(wrong("is a mesh file, not a scene".into(), Some(help)));
    }
    Ok(text)
}
