//! `tissuebench import`: writes the scene of a model of another program.

use std::path::{Path, PathBuf};

use cases::import::{Finding, Imported, Units};
use cases::scene::{self, Override, Scene, SceneError};

use super::args::{ImportArgs, ModelUnit};
use super::errors::{fail, spare};

impl From<ModelUnit> for Units {
    fn from(unit: ModelUnit) -> Units {
        match unit {
            ModelUnit::M => Units::Metres,
            ModelUnit::Mm => Units::Millimetres,
        }
    }
}

/// Writes the scene, prints what it leaves out, and returns the exit code.
pub(super) fn import(args: &ImportArgs) -> u8 {
    let ImportArgs { model, out, unit, step } = args;
    let path = match out {
        Some(out) => path_from(out, model),
        None => model.file_name().unwrap_or_default().into(),
    };
    let Imported { scene, left_out } =
        match cases::import::import(model, &path.to_string_lossy(), (*unit).into(), *step) {
            Ok(imported) => imported,
            Err(findings) => return refuse(&findings),
        };
    if let Some(out) = out {
        if let Err(failure) = spare(out) {
            return fail(&failure);
        }
        if let Err(bad) = disk::write(out, &scene) {
            eprintln!("tissuebench: {}: can't be written: {bad}", out.display());
            return 5;
        }
    }
    let parts = left_out.iter().map(|finding| format!("  line {}: {}", finding.line, finding.what));
    match out {
        Some(out) => println!("{}: scene of {}", out.display(), model.display()),
        None => println!("{}: can be imported", model.display()),
    }
    if !left_out.is_empty() {
        println!("left out:");
        parts.for_each(|part| println!("{part}"));
    }
    0
}

/// Reads a model as a scene, with some keys set from outside. Prints what the scene leaves out.
pub(super) fn open(model: &Path, set: &[Override]) -> Result<Scene, u8> {
    let name = model.file_name().unwrap_or_default().to_string_lossy();
    let Imported { scene, left_out } =
        cases::import::import(model, &name, Units::Metres, None).map_err(|findings| refuse(&findings))?;
    left_out.iter().for_each(|finding| eprintln!("{finding} (left out)"));
    scene::parse_with(&scene, &model.with_extension("toml").display().to_string(), set)
        .map_err(|errors: Vec<SceneError>| super::errors::refuse(&errors))
}

/// Prints the refused parts of a model and returns the exit code.
fn refuse(findings: &[Finding]) -> u8 {
    findings.iter().for_each(|finding| eprintln!("{finding}"));
    2
}

/// Path of a model as a scene writes it: relative if the model is in the scene's folder or below.
fn path_from(scene: &Path, model: &Path) -> PathBuf {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let (scene, model) = (absolute(scene), absolute(model));
    let folder = scene.parent().unwrap_or(&scene);
    model.strip_prefix(folder).map(Path::to_path_buf).unwrap_or(model)
}
