//! A TOML document with the place of every key, read in one pass that collects what is wrong.

use std::collections::BTreeMap;
use std::ops::Range;

use schemars::{JsonSchema, generate::SchemaSettings};
use serde::de::DeserializeOwned;
use serde_json::Value;
use toml::de::{DeTable, DeValue};

use super::conform;
use catalogue::{Problem, clip};

use super::error::{ErrorKind, SceneError};

/// Line and column of the keys of a file, for messages that come long after reading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    file: String,
    places: Places,
}

/// Of a key: its line and column, and its value as written if that is a scalar.
type Places = BTreeMap<String, (usize, usize, Option<String>)>;

impl Origin {
    /// File name as given by the caller.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Whether the file has `key`.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.places.contains_key(key)
    }

    /// An error at `key`, such as `method[1].size.nodes`, with the value the file has there; at the nearest key above it
    /// if the file doesn't have it.
    pub(crate) fn error(&self, kind: ErrorKind, key: &str, problem: Problem) -> SceneError {
        let mut at = key;
        let place = loop {
            if let Some(place) = self.places.get(at) {
                break Some(place);
            }
            match at.rfind(['.', '[']) {
                Some(end) => at = &at[..end],
                None => break None,
            }
        };
        let (line, column, text) = place.cloned().unwrap_or((1, 1, None));
        let found = problem.found.or(if at == key { text } else { None });
        SceneError {
            kind,
            file: self.file.clone(),
            line,
            column,
            key: key.to_string(),
            found,
            problem: problem.problem,
            help: problem.help,
        }
    }
}

/// Reads `text` as a `T`: syntax, then every key against the schema of `T`, then the values.
pub(crate) fn read<T: JsonSchema + DeserializeOwned>(
    text: &str,
    file: &str,
) -> Result<(T, Origin), Vec<SceneError>> {
    let lines = Lines::new(text);
    let here = |span: Option<Range<usize>>, key: &str, problem: Problem| {
        let (line, column) = lines.place(span.map_or(0, |span| span.start));
        SceneError {
            kind: ErrorKind::Invalid,
            file: file.to_string(),
            line,
            column,
            key: key.to_string(),
            found: problem.found,
            problem: problem.problem,
            help: problem.help,
        }
    };
    // The first error of syntax alone: what a parser says after it is mostly its own confusion.
    let root = DeTable::parse(text).map_err(|bad| {
        let help = "see https://toml.io for the format; text values stand in quotes";
        vec![here(
            bad.span(),
            "",
            Problem::new(format!("not valid TOML: {}", clip(bad.message()))).help(help),
        )]
    })?;
    let root_value = DeValue::Table(root.get_ref().clone());
    let findings = conform::check(&root_value, root.span(), &schema::<T>());
    if !findings.is_empty() {
        return Err(sorted(findings.into_iter().map(|f| here(Some(f.span), &f.key, f.problem)).collect()));
    }
    let mut places = BTreeMap::new();
    note(&root_value, "", &lines, &mut places);
    match toml::from_str::<T>(text) {
        Ok(keys) => Ok((keys, Origin { file: file.to_string(), places })),
        Err(bad) => Err(vec![here(bad.span(), "", Problem::new(clip(bad.message())))]),
    }
}

/// The schema of a file, without references to definitions.
pub(crate) fn schema<T: JsonSchema>() -> Value {
    let settings = SchemaSettings::draft2020_12().with(|settings| settings.inline_subschemas = true);
    settings.into_generator().into_root_schema_for::<T>().to_value()
}

/// By line, then column, then key.
pub(crate) fn sorted(mut errors: Vec<SceneError>) -> Vec<SceneError> {
    errors.sort_by(|a, b| (a.line, a.column, &a.key).cmp(&(b.line, b.column, &b.key)));
    errors
}

/// Places of every key below `path`.
fn note(value: &DeValue<'_>, path: &str, lines: &Lines<'_>, places: &mut Places) {
    let mut add = |path: String, span: Range<usize>, value: &DeValue<'_>| {
        let (line, column) = lines.place(span.start);
        note(value, &path, lines, places);
        places.insert(path, (line, column, written(value)));
    };
    match value {
        DeValue::Table(table) => {
            table.iter().for_each(|(key, value)| {
                add(conform::join(path, key.get_ref()), value.span(), value.get_ref())
            });
        }
        DeValue::Array(array) => {
            let values = array.iter().enumerate();
            values.for_each(|(i, value)| add(format!("{path}[{i}]"), value.span(), value.get_ref()));
        }
        _ => {}
    }
}

/// A scalar as the file has it, without quotes.
pub(crate) fn written(value: &DeValue<'_>) -> Option<String> {
    match value {
        DeValue::String(text) => Some(clip(text)),
        DeValue::Integer(number) => Some(number.to_string()),
        DeValue::Float(number) => Some(number.as_str().to_string()),
        DeValue::Boolean(value) => Some(value.to_string()),
        DeValue::Datetime(value) => Some(value.to_string()),
        DeValue::Array(_) | DeValue::Table(_) => None,
    }
}

/// Byte offsets into lines and columns.
struct Lines<'t> {
    text: &'t str,
    starts: Vec<usize>,
}

impl<'t> Lines<'t> {
    fn new(text: &'t str) -> Lines<'t> {
        let ends = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i + 1);
        Lines { text, starts: std::iter::once(0).chain(ends).collect() }
    }

    /// Line and column, from 1, the column in characters.
    fn place(&self, offset: usize) -> (usize, usize) {
        let line = self.starts.partition_point(|start| *start <= offset);
        let start = self.starts[line - 1];
        let before = self.text.get(start..offset.min(self.text.len())).unwrap_or("");
        (line, before.chars().count() + 1)
    }
}
