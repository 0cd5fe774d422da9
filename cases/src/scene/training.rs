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

use super::condition::Support;
use super::method::Method;
use super::output::Output;
use super::report::Report;

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
    pub(crate) set: Vec<(String, String)>,
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
        let set = self.0.into_iter().flat_map(|(key, value)| dotted(key, value)).collect();
        Some(Training { set })
    }
}

/// Keys with their values as TOML. TOML reads `material.young = "5 kPa"` as a table `material`, which would
/// replace that of the scene.
fn dotted(key: String, value: Value) -> Vec<(String, String)> {
    match value {
        Value::Table(table) if !key.contains(['.', '[']) => {
            table.into_iter().map(|(inner, value)| (format!("{key}.{inner}"), value.to_string())).collect()
        }
        value => vec![(key, value.to_string())],
    }
}

/// Reports reduced models without training, with supports that move, or with estimates of errors.
pub(crate) fn demands(
    training: &[Training],
    methods: &[Method],
    supports: &[Support],
    output: &Output,
    report: &Report,
) {
    let reduced = methods.iter().enumerate().filter(|(_, method)| method.pod.is_some());
    let reduced: Vec<String> = reduced.map(|(i, _)| format!("method[{i}].pod")).collect();
    let Some(first) = reduced.first() else { return };
    if training.is_empty() {
        let problem = Problem::new("learns from nothing");
        let help =
            "add [[training]] with a key of the scene and another value, such as \"tool[0].at\" = [...]";
        report.add(first, problem.help(help));
    }
    let moved = supports.iter().position(|support| support.moves() || support.during.is_some());
    if let Some(i) = moved {
        let problem = format!(
            "is not available with supports that move or act during a part of the loading, as support[{i}]"
        );
        report.add(first, Problem::new(problem).help("move a tool or a load"));
    }
    let known = output.estimate || output.error_of.is_some() || output.bounds;
    if known {
        let problem = "is not available with an error estimate: other deformations are excluded on purpose";
        report.add(first, Problem::new(problem).help("leave output.estimate, error_of and bounds out"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_without_quotes_changes_that_key_alone() {
        let keys = |text: &str| toml::from_str::<TrainingKeys>(text).unwrap();
        let set = |text: &str| keys(text).0.into_iter().flat_map(|(k, v)| dotted(k, v)).collect::<Vec<_>>();
        let expected = vec![("material.young".to_string(), "\"5 kPa\"".to_string())];
        assert_eq!(set("material.young = \"5 kPa\""), expected);
        assert_eq!(set("\"material.young\" = \"5 kPa\""), expected);
        assert_eq!(set("\"tool[0].drive\" = { closure = \"1 mm\" }")[0].0, "tool[0].drive");
    }
}
