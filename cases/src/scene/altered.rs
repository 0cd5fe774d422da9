//! A scene whose keys are set from outside after it was read: along an axis, to a sample of its inputs, or by
//! a fit.

use catalogue::Problem;

use super::demands;
use super::document::{Document, Origin};
use super::error::{ErrorKind, SceneError};
use super::report::Report;
use super::scene::{Scene, SceneKeys};
use super::shared;

/// The scene of some keys, if they contradict neither themselves nor each other.
pub(crate) fn resolved(keys: SceneKeys, origin: Origin) -> Result<Scene, Vec<SceneError>> {
    let report = Report::new(&origin);
    let scene = keys.read(&report);
    // Parts that could not be resolved are left out of the scene, so the demands of the other parts on them
    // cannot be checked.
    if let (Some(scene), true) = (&scene, report.is_clean()) {
        demands::scene(scene, &report);
    }
    let errors = report.finish();
    match scene {
        Some(scene) if errors.is_empty() => Ok(scene),
        _ => Err(errors),
    }
}

/// The scene with some keys set, or removed if they have no value, and with the named methods (all if
/// `methods` is empty). Checks, uncertain inputs and a fit are left out: they apply to the scene as written.
/// Errors in the values name `driver`.
///
/// # Errors
///
/// All findings about the scene; or a key that the scene cannot have.
pub(crate) fn altered(
    scene: &Scene,
    methods: &[String],
    settings: &[(&str, Option<&str>)],
    driver: &str,
) -> Result<Scene, Vec<SceneError>> {
    let mut document = Document::parse(scene.text(), scene.file())?;
    document.keep(methods);
    for left_out in ["check", "vary", "fit"] {
        document.root.get_mut().remove(left_out);
    }
    for (key, value) in settings {
        document.set(key, *value, driver).map_err(|problem| refused(scene, key, problem))?;
    }
    let (keys, origin) = shared::keys(document)?;
    resolved(keys, origin)
}

/// Error of a key that can't be set.
pub(crate) fn refused(scene: &Scene, key: &str, Problem { problem, help, .. }: Problem) -> Vec<SceneError> {
    let problem = format!("can't be driven: {problem}");
    vec![scene.error(ErrorKind::Invalid, key, &problem, help.as_deref())]
}
