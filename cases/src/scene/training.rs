//! Training of reduced models: the scene with other values of some keys.
//!
//! ```toml
//! [[training]]
//! "tool[0].at" = ["12 mm", "20 mm", "31 mm"]
//! ```

use std::collections::BTreeMap;

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Value;

use super::altered::altered;
use super::error::SceneError;
use super::report::Report;
use super::sample::left_out;
use super::scene::Scene;

/// Parts of a scene that a training run may change: the others make another body or another method of it.
const CHANGED: [&str; 4] = ["tool", "load", "material", "curve"];

/// A run of the scene from whose states reduced models take their deformations: keys of the scene with their
/// values
#[derive(Deserialize, JsonSchema)]
pub(crate) struct TrainingKeys(
    #[schemars(with = "BTreeMap<String, serde_json::Value>")] BTreeMap<String, Value>,
);

/// A run of the scene from whose states reduced models take their deformations.
#[derive(Clone, Debug, PartialEq)]
pub struct Training {
    /// Keys of the scene with their values as TOML.
    set: Vec<(String, String)>,
}

impl TrainingKeys {
    pub fn read(self, report: &Report) -> Option<Training> {
        let help = "set a key of the scene, such as \"tool[0].at\"";
        report.require(!self.0.is_empty(), "", "changes nothing", help);
        for key in self.0.keys() {
            let head = key.split(['.', '[']).next().unwrap_or_default();
            let problem =
                "does not belong to a training run, which has the body, supports and methods of the scene";
            let help = "set keys of tool, load, material or curve";
            report.require(CHANGED.contains(&head), key, problem, help);
        }
        Some(Training { set: self.0.into_iter().map(|(key, value)| (key, value.to_string())).collect() })
    }
}

impl Scene {
    /// The scene of a training run, numbered from 0, of the method `id`, which is not reduced there.
    ///
    /// # Errors
    /// All findings about the scene with these values.
    pub fn at_training(&self, id: &str, index: usize) -> Result<Scene, Vec<SceneError>> {
        let set = self.training[index].set.iter().map(|(key, value)| (key.as_str(), Some(value.as_str())));
        let full = [("method[].pod", None), ("training", None)].into_iter();
        let settings: Vec<_> = left_out(self, |_| false, false).into_iter().chain(full).chain(set).collect();
        altered(self, &[id.into()], &settings, &format!("{}, training[{index}]", self.file()))
    }
}

/// Reports training without a reduced model, and reduced models without training or with supports that move.
pub(crate) fn demands(scene: &Scene, report: &Report) {
    let reduced = scene.methods.iter().enumerate().filter(|(_, method)| method.pod.is_some());
    let reduced: Vec<String> = reduced.map(|(i, _)| format!("method[{i}].pod")).collect();
    let Some(first) = reduced.first() else {
        let problem =
            Problem::new("trains nothing").help("give a method pod = { modes = 20 }, or leave it out");
        return if scene.training.is_empty() {
        } else {
            report.add("training", problem)
        };
    };
    if scene.training.is_empty() {
        let problem = Problem::new("learns from nothing");
        let help =
            "add [[training]] with a key of the scene and another value, such as \"tool[0].at\" = [...]";
        report.add(first, problem.help(help));
    }
    let moved = scene.supports.iter().position(|support| support.moves() || support.during.is_some());
    if let Some(i) = moved {
        let problem = format!(
            "is not available with supports that move or act during a part of the loading, as support[{i}]"
        );
        report.add(first, Problem::new(problem).help("move a tool or a load"));
    }
    let known = scene.output.estimate || scene.output.error_of.is_some() || scene.output.bounds;
    if known {
        let problem = "is not available with an error estimate: other deformations are excluded on purpose";
        report.add(first, Problem::new(problem).help("leave output.estimate, error_of and bounds out"));
    }
}

/// Checks that the scene can be trained as it says.
///
/// # Errors
/// All findings about the scenes of the training runs.
pub(crate) fn trainable(scene: &Scene) -> Result<(), Vec<SceneError>> {
    let Some(method) = scene.methods.iter().find(|method| method.pod.is_some()) else { return Ok(()) };
    (0..scene.training.len()).try_for_each(|index| scene.at_training(&method.id, index).map(drop))
}
