//! Scenes of a fit: the runs with other values of the fitted constants, and the text with the fitted values.

use std::ops::Range;
use std::path::Path;

use catalogue::Problem;
use catalogue::metric::Needs;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::altered::altered;
use super::demands;
use super::document::Document;
use super::error::SceneError;
use super::fit::Fit;
use super::report::{Report, beside};
use super::sample;
use super::scene::Scene;

/// Name of the fit, and of its runs, where runs are named by the setting in which they differ.
const FIT: &str = "fit";
/// Relative change of a constant at which a scene is tried before the first run.
const TRIED: f64 = 1e-3;

impl Scene {
    /// The scene as the fit of its constants, which is one task of a study; `None` without `[fit]`.
    pub fn to_fit(&self) -> Option<Scene> {
        self.fit.as_ref()?;
        Some(Scene { varied: Some((FIT.into(), 0.0)), is_fit: true, ..self.clone() })
    }

    /// The scene with other values of its fitted constants, for the run `index` of the fit, with one method.
    /// Requests for output that the fit does not need are left out, and so is a reference that has to be
    /// solved.
    ///
    /// # Errors
    /// The scene refuses the values.
    pub fn with_constants(
        &self,
        method: &str,
        values: &[f64],
        index: usize,
    ) -> Result<Scene, Vec<SceneError>> {
        let keys = self.fit.iter().flat_map(|fit| &fit.keys);
        let set: Vec<(&str, String)> =
            keys.zip(values).map(|(key, value)| (key.key.as_str(), key.written(*value))).collect();
        let set = set.iter().map(|(key, text)| (*key, Some(text.as_str())));
        let settings: Vec<_> =
            sample::left_out(self, |_: &[Needs]| false, false).into_iter().chain(set).collect();
        let driver = format!("{} in run {} of the fit", self.file(), index + 1);
        let mut made = altered(self, &[method.into()], &settings, &driver)?;
        made.varied = Some((FIT.into(), index as f64 + 1.0));
        Ok(made)
    }

    /// The text of the scene's file, with its comments, with the values of the fitted constants. Relative
    /// paths of files are made absolute, so that the text runs from any folder. `None` if a constant is not
    /// in this file, such as one of a named tissue.
    pub fn fitted_text(&self, values: &[f64]) -> Option<String> {
        let fit = self.fit.as_ref()?;
        let text = disk::read_text(Path::new(self.file()), disk::Kind::SCENE).ok()?;
        let document = Document::parse(&text, self.file()).ok()?;
        let root = DeValue::Table(document.root.get_ref().clone());
        let mut edits: Vec<(Range<usize>, String)> = Vec::new();
        for (key, value) in fit.keys.iter().zip(values) {
            let mut found = Vec::new();
            places(&root, &key.key, &mut found)?;
            edits.extend(found.into_iter().map(|place| (place, key.written(*value))));
        }
        paths(&root, self.file(), &mut edits);
        edits.sort_by_key(|(place, _)| std::cmp::Reverse(place.start));
        let mut text = text.clone();
        edits.into_iter().for_each(|(place, with)| text.replace_range(place, &with));
        Some(text)
    }
}

/// Places of the values of a key such as `tool[].friction`; `None` if the document does not have it.
fn places(value: &DeValue, key: &str, found: &mut Vec<Range<usize>>) -> Option<()> {
    let key = key.strip_prefix('.').unwrap_or(key);
    let mut at = |value: &Spanned<DeValue>, rest: &str| match rest.is_empty() {
        true => {
            found.push(value.span());
            Some(())
        }
        false => places(value.get_ref(), rest, found),
    };
    if let Some(inside) = key.strip_prefix('[') {
        let (index, rest) = inside.split_once(']')?;
        let DeValue::Array(list) = value else { return None };
        return match index.parse::<usize>() {
            Ok(index) => at(list.get(index)?, rest),
            Err(_) if index.is_empty() => list.iter().try_for_each(|item| at(item, rest)),
            Err(_) => None,
        };
    }
    let (head, rest) = key.split_at(key.find(['.', '[']).unwrap_or(key.len()));
    let DeValue::Table(table) = value else { return None };
    at(table.get(head)?, rest)
}

/// Edits that make paths of files absolute: texts with a dot or a slash that are files from the scene's
/// folder.
fn paths(value: &DeValue, file: &str, edits: &mut Vec<(Range<usize>, String)>) {
    let mut one = |value: &Spanned<DeValue>| match value.get_ref() {
        DeValue::String(text) if text.contains(['.', '/']) && Path::new(text.as_ref()).is_relative() => {
            let path = beside(file, text);
            if let (true, Ok(path)) = (path.is_file(), path.canonicalize()) {
                edits.push((value.span(), toml::Value::String(path.display().to_string()).to_string()));
            }
        }
        below => paths(below, file, edits),
    };
    match value {
        DeValue::Table(table) => DeTable::iter(table).for_each(|(_, value)| one(value)),
        DeValue::Array(list) => list.iter().for_each(one),
        _ => {}
    }
}

/// Checks that the runs of the scene have the metrics of the curve and take other values of the constants.
///
/// # Errors
/// Metrics that no run gives, and keys that take no value near the start.
pub(crate) fn driven(scene: &Scene) -> Result<(), Vec<SceneError>> {
    let Some(Fit { data, keys, .. }) = &scene.fit else { return Ok(()) };
    let report = Report::new(&scene.origin);
    let at = report.at("fit");
    let kind = scene.procedure.kind();
    let problem = format!("is a curve, and a {} procedure has one state", kind.name());
    at.require(!kind.has_no_steps(), "data", &problem, "take [procedure] kind = \"static\" and steps = 10");
    [data.along, data.of].into_iter().for_each(|of| demands::varied(of, scene, &at.at("data")));
    for key in keys {
        let moved = |part: f64| {
            let start = key.constant.start;
            let set = key.written(start + part * if start == 0.0 { 1.0 } else { start });
            altered(scene, &[], &[(key.key.as_str(), Some(set.as_str()))], scene.file()).map(|_| ())
        };
        if let Err(errors) = moved(TRIED).or_else(|_| moved(-TRIED)) {
            let why =
                errors.first().map_or(String::new(), |error| format!("{} {}", error.key, error.problem));
            let problem = format!("takes no value next to {}: {why}", key.written(key.constant.start));
            at.add(
                "keys",
                Problem::new(problem).found(key.key.clone()).help("fit a constant that is any number"),
            );
        }
    }
    let errors = report.finish();
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}
