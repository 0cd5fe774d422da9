//! Methods that several scenes share: one file of `[[method]]` tables, from which a scene takes methods by
//! their ids.
//!
//! ```toml
//! methods_from = "../../methods.toml"
//!
//! [[method]]
//! use = "hex8-mean"
//! size = { level = 2 }
//! ```
//!
//! A key next to `use` replaces the key of the shared table. The result is read like a method written out in
//! the scene. A shared table cannot take another shared method.

use std::sync::LazyLock;

use schemars::JsonSchema;
use serde_json::{Value, json};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::conform::written;
use super::document::{Document, Origin, moved, schema, sorted};
use super::error::{SceneError, unread};
use super::method::MethodKeys;
use super::report::{Report, beside, which};
use super::scene::{SceneKeys, SoundParts};
use super::set::Override;
use super::sources::Taken;
use super::tissue;
use catalogue::Problem;

/// Schemas, generated once: generating a schema takes longer than checking a file.
static SCENE: LazyLock<Value> = LazyLock::new(schema::<SceneKeys>);
static SHARED: LazyLock<Value> = LazyLock::new(|| unfinished(schema::<SharedKeys>()));

/// A file of shared methods
#[derive(JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)] // only a schema to check the file; a scene that takes a table reads it
struct SharedKeys {
    method: Vec<MethodKeys>,
}

/// Reads a scene together with its shared methods, and with some keys set from outside.
pub(crate) fn read(
    text: &str,
    file: &str,
    overrides: &[Override],
) -> Result<(SceneKeys, Origin), Vec<SceneError>> {
    let mut document = Document::parse(text, file)?;
    let Some(from) = document.root.get_ref().get("methods_from") else {
        unshared(&document)?;
        document.set_all(overrides)?;
        return keys(document);
    };
    let wrong = |problem| vec![document.error(Some(from.span()), "methods_from", problem)];
    let DeValue::String(path) = from.get_ref() else {
        return Err(wrong(
            Problem::new("is not the path of a file")
                .help("give it in quotes: methods_from = \"methods.toml\""),
        ));
    };
    let path = beside(file, path);
    let shared_file = path.display().to_string();
    let shared_text = disk::read_text(&path, disk::Kind::SCENE).map_err(|bad| {
        let help = format!("{}; paths are relative to the folder of the file they are in", unread(&bad));
        wrong(Problem::new("can't be read").found(shared_file.as_str()).help(help))
    })?;
    let shared = Document::parse(&shared_text, &shared_file)?;
    shared.check(&SHARED)?;
    unique(&shared)?;
    take(&mut document, shared)?;
    document.set_all(overrides)?;
    keys(document)
}

/// Keys of a scene, with its tissues written out; or all errors in the keys, and in the values of the parts whose keys are valid.
pub(crate) fn keys(mut document: Document<'_>) -> Result<(SceneKeys, Origin), Vec<SceneError>> {
    tissue::expand(&mut document)?;
    let Err(mut errors) = document.check(&SCENE) else { return document.values() };
    if let Some((parts, origin)) = document.sound::<SoundParts>(&errors) {
        let report = Report::new(&origin);
        parts.check(&report);
        errors.extend(report.finish());
    }
    Err(sorted(errors))
}

/// Extends the schema of a scene by shared methods.
pub(crate) fn describe(mut schema: Value) -> Value {
    let shared = json!({
        "type": "object",
        "description": "A shared method",
        "x-kind": "shared",
        "properties": { "use": {
            "type": "string",
            "description": "The id of a method in the file `methods_from`. Further keys replace those of the shared method",
        } },
        "required": ["use"],
    });
    if let Some(forms) = forms(&mut schema) {
        forms.push(shared);
    }
    schema
}

/// The schema of shared methods, in which scenes may supply keys such as the size.
fn unfinished(mut schema: Value) -> Value {
    for form in forms(&mut schema).into_iter().flatten() {
        form["required"] = json!(["id", "family"]);
    }
    schema
}

/// The alternative forms of a method in a schema.
fn forms(schema: &mut Value) -> Option<&mut Vec<Value>> {
    schema.pointer_mut("/properties/method/items/oneOf")?.as_array_mut()
}

/// The tables under `[[method]]`.
fn tables<'a, 't>(document: &'a Document<'t>) -> &'a [Spanned<DeValue<'t>>] {
    match document.root.get_ref().get("method").map(Spanned::get_ref) {
        Some(DeValue::Array(methods)) => methods,
        _ => &[],
    }
}

impl Document<'_> {
    /// Removes all methods except the named ones; removes none if `methods` is empty.
    pub fn keep(&mut self, methods: &[String]) {
        let Some(all) = self.root.get_mut().get_mut("method").filter(|_| !methods.is_empty()) else { return };
        let DeValue::Array(list) = all.get_ref() else { return };
        let named = |method: &&Spanned<DeValue<'_>>| {
            let id = value(method, "id").and_then(|id| id.get_ref().as_str());
            id.is_some_and(|id| methods.iter().any(|m| m == id))
        };
        *all = Spanned::new(all.span(), DeValue::Array(list.iter().filter(named).cloned().collect()));
    }
}

/// The value of a key of a method.
fn value<'a, 't>(method: &'a Spanned<DeValue<'t>>, key: &str) -> Option<&'a Spanned<DeValue<'t>>> {
    method.get_ref().as_table()?.get(key)
}

/// Refuses `use` in a scene without a file of shared methods.
fn unshared(document: &Document<'_>) -> Result<(), Vec<SceneError>> {
    let errors: Vec<SceneError> = (tables(document).iter().enumerate())
        .filter_map(|(i, method)| Some((i, value(method, "use")?)))
        .map(|(i, name)| {
            let problem = Problem::new("needs a file of methods");
            let help = "name it at the top of the scene: methods_from = \"methods.toml\"";
            let problem = Problem { found: written(name.get_ref()), ..problem.help(help) };
            document.error(Some(name.span()), &format!("method[{i}].use"), problem)
        })
        .collect();
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// Checks that the ids of the shared methods are unique.
fn unique(shared: &Document<'_>) -> Result<(), Vec<SceneError>> {
    let ids: Vec<_> = tables(shared).iter().filter_map(|method| value(method, "id")).collect();
    let text = |id: &Spanned<DeValue<'_>>| written(id.get_ref());
    let mut errors = Vec::new();
    for (i, id) in ids.iter().enumerate() {
        if ids[..i].iter().any(|other| text(other) == text(id)) {
            let problem = Problem::new("is the id of another method").help("ids are unique");
            let problem = Problem { found: text(id), ..problem };
            errors.push(shared.error(Some(id.span()), &format!("method[{i}].id"), problem));
        }
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// Inserts the shared tables into the scene's methods that name them.
fn take<'t>(document: &mut Document<'t>, shared: Document<'t>) -> Result<(), Vec<SceneError>> {
    let known = tables(&shared);
    let ids: Vec<String> = known
        .iter()
        .map(|m| value(m, "id").and_then(|id| written(id.get_ref())).unwrap_or_default())
        .collect();
    let base = document.sources.add(shared.sources.own());
    let mut taken = Vec::new();
    let mut errors = Vec::new();
    let mut merged: Vec<Spanned<DeValue<'t>>> = tables(document).to_vec();
    for (i, method) in merged.iter_mut().enumerate() {
        let span = method.span();
        let Some(name) = value(method, "use").cloned() else { continue };
        let here = format!("method[{i}]");
        let found = written(name.get_ref());
        let at = ids.iter().position(|id| matches!(name.get_ref(), DeValue::String(text) if text == id));
        let Some(at) = at else {
            let problem = Problem::new(format!("is not a method of {}", shared.files.own()));
            let help = which(found.as_deref().unwrap_or_default(), ids.iter().map(String::as_str));
            let problem = Problem { found, ..problem.help(help) };
            errors.push(document.error(Some(name.span()), &format!("{here}.use"), problem));
            continue;
        };
        let own = method.get_ref().as_table().cloned().unwrap_or_default();
        let line = document.sources.place(Some(name.span())).line;
        *method = Spanned::new(span, DeValue::Table(with(&known[at], base, own, name)));
        taken.push(Taken { here, there: format!("method[{at}]"), line });
    }
    if !errors.is_empty() {
        return Err(sorted(errors));
    }
    if let Some(methods) = document.root.get_mut().get_mut("method") {
        *methods = Spanned::new(methods.span(), DeValue::Array(merged.into_iter().collect()));
    }
    document.files.add(shared.files.own().to_string(), taken);
    Ok(())
}

/// A shared table with its keys replaced by the scene's keys. Its id has the place of the scene's `use`.
fn with<'t>(
    shared: &Spanned<DeValue<'t>>,
    base: usize,
    own: DeTable<'t>,
    name: Spanned<DeValue<'t>>,
) -> DeTable<'t> {
    let DeValue::Table(mut table) = moved(shared.get_ref(), base) else { return own };
    if let Some(id) = table.get_mut("id") {
        *id = name;
    }
    for (key, value) in own.into_iter().filter(|(key, _)| key.get_ref() != "use") {
        // The key is removed first, so that the new key has the location in the scene.
        table.remove(key.get_ref().as_ref());
        table.insert(key, value);
    }
    table
}
