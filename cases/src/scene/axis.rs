//! An axis of a study: one setting of a scene, varied from value to value until methods bend and break.
//!
//! ```toml
//! [run.axis]
//! name = "edge ratio of the cells"
//! values = [1, 2, 5, 10]
//! judge = "l2"
//! set = { "body.size[2]" = "{40 / x} mm" }
//! ```
//!
//! A key of `set` is a key of the scene as messages name it; `method[]` stands for every method of the run.
//! Text in braces is an expression of the value `x`. A text that consists of one pair of braces becomes a
//! number.

use std::collections::BTreeMap;

use catalogue::Problem;
use catalogue::metric::{self, Address};
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Value;

use super::altered::{altered, refused};
use super::error::SceneError;
use super::expression::Expression;
use super::report::Report;
use super::scene::Scene;

/// An axis along which a scene is varied, and the criterion for a correct result.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Name of the varied setting in figures and tables.
    pub name: String,
    /// Unit of the values in figures; empty for a bare number.
    pub unit: String,
    /// Values of the axis, in their order.
    pub values: Vec<f64>,
    /// Value at which a method's reference error is taken.
    pub base: f64,
    /// Metric of the error by which results are judged.
    pub judge: Address,
    /// Smallest error that makes a result wrong.
    pub wrong: f64,
    set: BTreeMap<String, Value>,
    unset: Vec<String>,
}

/// One setting of the scene, varied from value to value until methods bend and break
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct AxisKeys {
    /// Name of the varied setting in figures and tables
    name: String,
    /// Unit of the values, for figures; none unless given
    #[serde(default)]
    unit: String,
    /// Values of the axis
    values: Vec<f64>,
    /// Value for comparison: a method bends at twice the error it has here; the first value unless given
    base: Option<f64>,
    /// Metric of the error that is judged, such as "l2" or "relative-rms"
    judge: String,
    /// Smallest error that makes a result wrong; 0.25 unless given
    wrong: Option<f64>,
    /// Keys of the scene, such as "material.poisson" or "method[].support_scale" for every method of the run,
    /// with their values. Text in braces is an expression of the value x, such as "{40 / x} mm"
    #[schemars(with = "BTreeMap<String, serde_json::Value>")]
    set: BTreeMap<String, Value>,
    /// Keys of the scene to remove, such as "method[].support_scale" if neighbours are set
    #[serde(default)]
    unset: Vec<String>,
}

impl AxisKeys {
    pub fn read(self, report: &Report) -> Option<Axis> {
        let judge = metric::named(&self.judge).map_err(|bad| report.add("judge", bad)).ok()?;
        let is_error = matches!(judge.metric.kind, metric::Kind::Error | metric::Kind::Tool);
        report.require(is_error, "judge", "is no error", "take \"l2\" or \"relative-rms\"");
        report.require(!self.values.is_empty(), "values", "are none", "give two or more");
        report.require(!self.set.is_empty(), "set", "drives nothing", "name a key of the scene");
        let base = self.base.or(self.values.first().copied()).unwrap_or(0.0);
        let known = self.values.contains(&base);
        report.require(known, "base", "is none of the values", "name one of them");
        let wrong = self.wrong.unwrap_or(0.25);
        report.require(wrong > 0.0, "wrong", "is no error", "give a number above 0");
        let AxisKeys { name, unit, values, set, unset, .. } = self;
        Some(Axis { name, unit, values, base, judge, wrong, set, unset })
    }
}

impl Axis {
    /// The scene at one value of the axis, with the named methods (all if `methods` is empty).
    ///
    /// # Errors
    ///
    /// All findings about the scene, as given or at this value; or a key of the axis that the scene cannot
    /// have.
    pub fn at(&self, scene: &Scene, methods: &[String], value: f64) -> Result<Scene, Vec<SceneError>> {
        let filled = self.set.iter().map(|(key, template)| match fill(template, value) {
            Ok(filled) => Ok((key.as_str(), filled.to_string())),
            Err(problem) => Err(refused(scene, key, problem)),
        });
        let filled = filled.collect::<Result<Vec<_>, _>>()?;
        let left_out = self.unset.iter().map(|key| (key.as_str(), None));
        let set = filled.iter().map(|(key, value)| (*key, Some(value.as_str())));
        let driver = format!("{} along '{}' at {value}", scene.file(), self.name);
        let mut varied = altered(scene, methods, &left_out.chain(set).collect::<Vec<_>>(), &driver)?;
        varied.varied = Some((self.name.clone(), value));
        Ok(varied)
    }
}

/// Replaces the braces of a template by the value of their expression at `x`.
fn fill(template: &Value, x: f64) -> Result<Value, Problem> {
    Ok(match template {
        Value::String(text) => fill_text(text, x)?,
        Value::Array(list) => Value::Array(list.iter().map(|v| fill(v, x)).collect::<Result<_, _>>()?),
        Value::Table(table) => Value::Table(
            table.iter().map(|(k, v)| Ok((k.clone(), fill(v, x)?))).collect::<Result<_, Problem>>()?,
        ),
        other => other.clone(),
    })
}

fn fill_text(text: &str, x: f64) -> Result<Value, Problem> {
    let mut out = String::new();
    let mut rest = text;
    let mut number = None;
    while let Some((before, after)) = rest.split_once('{') {
        let (expression, behind) =
            after.split_once('}').ok_or_else(|| Problem::new("a '{' is never closed").found(text))?;
        let value = Expression::read(expression)?
            .value([x, 0.0, 0.0])
            .map_err(|bad| Problem::new(format!("'{expression}' is {} at {x}", bad.value)))?;
        number = (before.is_empty() && behind.is_empty() && out.is_empty()).then_some(value);
        out += &format!("{before}{value}");
        rest = behind;
    }
    out += rest;
    Ok(match number {
        Some(value) if value.fract() == 0.0 && value.abs() < 1e15 => Value::Integer(value as i64),
        Some(value) => Value::Float(value),
        None => Value::String(out),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn braces_hold_expressions_of_the_value() {
        let text = |text: &str| fill(&Value::String(text.into()), 4.0).unwrap();
        assert_eq!(text("{40 / x} mm"), Value::String("10 mm".into()));
        assert_eq!(text("{x}"), Value::Integer(4));
        assert_eq!(text("{x / 8}"), Value::Float(0.5));
        assert_eq!(text("{x}{x}"), Value::String("44".into()));
        assert_eq!(text("plain"), Value::String("plain".into()));
        assert!(fill(&Value::String("{x".into()), 4.0).unwrap_err().problem.contains("never closed"));
    }
}
