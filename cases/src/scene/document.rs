//! A TOML document with the place of every key, read in one pass that collects all errors.

use std::collections::BTreeMap;
use std::ops::Range;

use schemars::{JsonSchema, generate::SchemaSettings};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use catalogue::{Problem, clip};

use super::conform::{self, written};
use super::error::{ErrorKind, SceneError};
use super::limits;
use super::sources::{Files, Place, Sources};

/// Locations of the keys of a file by line and column, for messages long after reading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    files: Files,
    text: String,
    places: Places,
}

/// By key: its place, and its value as written if the value is a scalar.
type Places = BTreeMap<String, (Place, Option<String>)>;

impl Origin {
    /// File name as given by the caller.
    pub fn file(&self) -> &str {
        self.files.own()
    }

    /// The text of the file; with shared methods or tissues, the equivalent text in which these are written out.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// The file that contains the value of `key`.
    pub(crate) fn file_of(&self, key: &str) -> &str {
        self.places.get(key).map_or(self.file(), |(place, _)| self.files.name(place.file))
    }

    /// Whether the file has `key`.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.places.contains_key(key)
    }

    /// Whether the file has `key`, in which brackets stand for any entry of a list.
    pub(crate) fn has_any(&self, key: &str) -> bool {
        let key = unnumbered(key);
        self.places.keys().any(|place| unnumbered(place) == key)
    }

    /// The scalar at `key` as written, without quotes; of a key with empty brackets, that of the first entry.
    pub(crate) fn scalar(&self, key: &str) -> Option<&str> {
        let first = key.replace("[]", "[0]");
        self.places.get(&first)?.1.as_deref()
    }

    /// An error at `key`, such as `method[1].size.nodes`, with the value in the file. If the file does not
    /// have the key, the error is at the nearest key above it.
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
        let (place, text) = place.cloned().unwrap_or((Place { file: 0, line: 1, column: 1 }, None));
        let found = problem.found.or(if at == key { text } else { None });
        self.files.error(kind, place, key, Problem { found, ..problem })
    }
}

/// The key with empty brackets.
pub(crate) fn unnumbered(key: &str) -> String {
    let mut parts = key.split('[');
    let first = parts.next().unwrap_or_default().to_string();
    parts.fold(first, |whole, part| whole + "[]" + part.split_once(']').map_or("", |(_, rest)| rest))
}

/// A file with valid TOML syntax.
pub(crate) struct Document<'t> {
    pub root: Spanned<DeTable<'t>>,
    pub sources: Sources<'t>,
    pub files: Files,
    /// Whether tables of the text stand for others, as the names of tissues do.
    pub is_expanded: bool,
}

impl<'t> Document<'t> {
    /// Parses the text; reports the first syntax error only, because later ones are mostly consequences of
    /// it.
    pub fn parse(text: &'t str, file: &str) -> Result<Document<'t>, Vec<SceneError>> {
        let (sources, files) = (Sources::new(text), Files::new(file));
        if text.len() > limits::MOST_BYTES {
            let help = format!("give {} or less", limits::MOST_BYTES);
            let problem = Problem::new(format!("is {} bytes long", text.len())).help(help);
            return Err(vec![files.error(ErrorKind::Invalid, sources.place(None), "", problem)]);
        }
        match DeTable::parse(text) {
            Ok(root) => {
                let whole = Spanned::new(root.span(), DeValue::Table(root.get_ref().clone()));
                match limits::excess(&whole) {
                    None => Ok(Document { root, sources, files, is_expanded: false }),
                    Some((span, key, problem)) => {
                        let place = sources.place(Some(span));
                        Err(vec![files.error(ErrorKind::Invalid, place, &key, problem)])
                    }
                }
            }
            Err(bad) => {
                let place = sources.place(bad.span());
                let line = text.lines().nth(place.line - 1).unwrap_or_default();
                let (what, help) = match decimal_comma(line, place.column) {
                    Some(number) => {
                        let help = format!("write a decimal point: {}", number.replace(',', "."));
                        (format!("{number} is not a number"), help)
                    }
                    None => {
                        let help = "see https://toml.io for the format; text values need quotes";
                        (clip(bad.message()), help.into())
                    }
                };
                let problem = format!("not valid TOML at column {}: {what}", place.column);
                let problem = Problem::new(problem).help(help);
                Err(vec![files.error(ErrorKind::Invalid, place, "", problem)])
            }
        }
    }

    /// An error at a span.
    pub fn error(&self, span: Option<Range<usize>>, key: &str, problem: Problem) -> SceneError {
        self.files.error(ErrorKind::Invalid, self.sources.place(span), key, problem)
    }

    /// Checks every key against a schema.
    pub fn check(&self, schema: &Value) -> Result<(), Vec<SceneError>> {
        let root = DeValue::Table(self.root.get_ref().clone());
        let findings = conform::check(&root, self.root.span(), schema);
        let errors: Vec<SceneError> =
            findings.into_iter().map(|f| self.error(Some(f.span), &f.key, f.problem)).collect();
        if errors.is_empty() { Ok(()) } else { Err(sorted(errors)) }
    }

    /// Values of the document without the top-level keys that have errors in or below them.
    pub fn sound<T: DeserializeOwned>(&self, errors: &[SceneError]) -> Option<(T, Origin)> {
        let top = |error: &SceneError| error.key.split(['.', '[']).next().unwrap_or_default().to_string();
        let wrong: Vec<String> = errors.iter().map(top).collect();
        let is_sound = |key: &str| !wrong.iter().any(|top| top == key);
        let sound = self.root.get_ref().iter().filter(|(key, _)| is_sound(key.get_ref()));
        let sound: DeTable<'t> = sound.map(|(key, value)| (key.clone(), value.clone())).collect();
        let keys = T::deserialize(Deserializer::from(Spanned::new(self.root.span(), sound))).ok()?;
        Some((keys, self.origin(String::new())))
    }

    /// Checks every key against the schema of `T`, then reads the values.
    pub fn read<T: JsonSchema + DeserializeOwned>(self) -> Result<(T, Origin), Vec<SceneError>> {
        self.check(&schema::<T>())?;
        self.values()
    }

    /// Reads the values; the keys are already checked.
    pub fn values<T: DeserializeOwned>(self) -> Result<(T, Origin), Vec<SceneError>> {
        let values = || Deserializer::from(self.root.clone());
        let wrong =
            |bad: toml::de::Error| vec![self.error(bad.span(), "", Problem::new(clip(bad.message())))];
        let keys = T::deserialize(values()).map_err(wrong)?;
        let text = if self.files.are_several() || self.is_expanded {
            let mut table = toml::Table::deserialize(values()).map_err(wrong)?;
            table.remove("methods_from");
            table.to_string()
        } else {
            self.sources.own().to_string()
        };
        let origin = self.origin(text);
        Ok((keys, origin))
    }

    fn origin(&self, text: String) -> Origin {
        let mut places = BTreeMap::new();
        note(&DeValue::Table(self.root.get_ref().clone()), "", &self.sources, &mut places);
        Origin { files: self.files.clone(), text, places }
    }
}

/// A number with a decimal comma at or before the parser's error position; `column` counts from 1.
fn decimal_comma(line: &str, column: usize) -> Option<String> {
    let letters: Vec<char> = line.chars().collect();
    let is = |at: usize, fits: fn(&char) -> bool| letters.get(at).is_some_and(fits);
    // The parser may read the digits after the comma as a key and report the missing '=' behind them.
    let mut at = column - 1;
    while at > 0 && is(at - 1, |c| c.is_ascii_digit() || *c == ' ') {
        at -= 1;
    }
    let comma = [at.wrapping_sub(1), column - 1].into_iter().find(|&at| is(at, |c| *c == ','))?;
    let before = (0..comma).rev().take_while(|&at| is(at, char::is_ascii_digit)).count();
    let after = (comma + 1..letters.len()).take_while(|&at| is(at, char::is_ascii_digit)).count();
    let number = letters[comma - before..=comma + after].iter().collect();
    (before > 0 && after > 0).then_some(number)
}

/// Reads `text` as a `T`: syntax, then every key against the schema of `T`, then the values.
pub(crate) fn read<T: JsonSchema + DeserializeOwned>(
    text: &str,
    file: &str,
) -> Result<(T, Origin), Vec<SceneError>> {
    Document::parse(text, file)?.read()
}

/// The schema of a file, without references to definitions.
pub(crate) fn schema<T: JsonSchema>() -> Value {
    let settings = SchemaSettings::draft2020_12().with(|settings| settings.inline_subschemas = true);
    settings.into_generator().into_root_schema_for::<T>().to_value()
}

/// Sorts errors by file, then line, then column, then key.
pub(crate) fn sorted(mut errors: Vec<SceneError>) -> Vec<SceneError> {
    errors.sort_by(|a, b| (&a.file, a.line, a.column, &a.key).cmp(&(&b.file, b.line, b.column, &b.key)));
    errors
}

/// Records the place of every key below `path`.
fn note(value: &DeValue<'_>, path: &str, sources: &Sources<'_>, places: &mut Places) {
    let mut add = |path: String, span: Range<usize>, value: &DeValue<'_>| {
        note(value, &path, sources, places);
        places.insert(path, (sources.place(Some(span)), written(value)));
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

/// The value with all spans shifted by `base`.
pub(crate) fn moved<'t>(value: &DeValue<'t>, base: usize) -> DeValue<'t> {
    let span = |span: Range<usize>| span.start + base..span.end + base;
    let item = |value: &Spanned<DeValue<'t>>| Spanned::new(span(value.span()), moved(value.get_ref(), base));
    match value {
        DeValue::Table(table) => DeValue::Table(
            (table.iter())
                .map(|(key, value)| (Spanned::new(span(key.span()), key.get_ref().clone()), item(value)))
                .collect(),
        ),
        DeValue::Array(items) => DeValue::Array(items.iter().map(item).collect()),
        scalar => scalar.clone(),
    }
}
