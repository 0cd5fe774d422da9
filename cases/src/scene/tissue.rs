//! Tissues of the catalogue in a scene: `tissue = "liver/..."` in a material stands for the law and the
//! constants of a published parameter set.
//!
//! The keys are inserted into the document before it is checked, at the place of the name. A constant of the
//! source cannot be given beside the name: with another constant it is not that set any more. Keys that the
//! source does not give, such as the density or the bulk modulus of a tissue taken as incompressible, can be.

use std::ops::Range;

use catalogue::Problem;
use serde_json::{Value, json};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::conform::written;
use super::document::{Document, sorted};
use super::error::SceneError;
use crate::tissue::find;

/// Keys of which a law takes one: either replaces the assumed one.
const VOLUME: [&str; 2] = ["poisson", "bulk"];
/// Laws of small strain. Another law with the same moduli may replace it.
const SMALL_STRAIN: &str = "linear";

/// A finding: key below the material, span, problem.
type Finding = (String, Range<usize>, Problem);

/// Replaces the names of tissues in all materials by their laws and constants.
pub(crate) fn expand(document: &mut Document<'_>) -> Result<(), Vec<SceneError>> {
    let mut found = Vec::new();
    let mut is_expanded = false;
    for (key, material) in materials(document.root.get_mut()) {
        let DeValue::Table(table) = material.get_mut() else { continue };
        if !table.contains_key("tissue") {
            continue;
        }
        is_expanded = true;
        if let Err(finding) = insert(table) {
            let (at, span, problem) = *finding;
            found.push((format!("{key}.{at}"), span, problem));
        }
    }
    document.is_expanded |= is_expanded;
    let errors: Vec<SceneError> =
        found.into_iter().map(|(key, span, problem)| document.error(Some(span), &key, problem)).collect();
    if errors.is_empty() { Ok(()) } else { Err(sorted(errors)) }
}

/// All materials of a scene with their keys.
fn materials<'a, 't>(root: &'a mut DeTable<'t>) -> Vec<(String, &'a mut Spanned<DeValue<'t>>)> {
    let mut found = Vec::new();
    for (key, value) in root.iter_mut() {
        if key.get_ref() == "material" {
            found.push(("material".to_string(), value));
        } else if let ("region", DeValue::Array(regions)) = (key.get_ref().as_ref(), value.get_mut()) {
            for (i, region) in regions.iter_mut().enumerate() {
                let DeValue::Table(region) = region.get_mut() else { continue };
                let material = region.get_mut("material");
                found.extend(material.map(|material| (format!("region[{i}].material"), material)));
            }
        }
    }
    found
}

/// Inserts the keys of the tissue that the table names.
fn insert(table: &mut DeTable<'_>) -> Result<(), Box<Finding>> {
    let Some(name) = table.remove("tissue") else { return Ok(()) };
    let span = name.span();
    let DeValue::String(text) = name.get_ref() else {
        let problem =
            Problem { found: written(name.get_ref()), ..Problem::new("is not the name of a tissue") };
        let help = "write it in quotes: tissue = \"liver/human-venkatesh-2008\"";
        return Err(Box::new(("tissue".into(), span, problem.help(help))));
    };
    let tissue = find(text).map_err(|problem| Box::new(("tissue".into(), span.clone(), problem)))?;
    let [constants, assumed] = tissue.tables();
    if let Some((key, law)) = table.get_key_value("law").filter(|_| tissue.law != SMALL_STRAIN) {
        let help = format!("leave it out, or leave out tissue: its law is {}", tissue.law);
        let problem = Problem { found: written(law.get_ref()), ..Problem::new("is given by the tissue") };
        return Err(Box::new(("law".into(), key.span(), problem.help(help))));
    }
    for (key, _) in &constants {
        let Some((own, value)) = table.get_key_value(key.get_ref().as_ref()) else { continue };
        let name = key.get_ref().to_string();
        let of_source = tissue.constants().remove(name.as_str()).unwrap_or_default();
        let help = format!(
            "leave it out (the source has {name} = {of_source}), or leave out tissue and write law = \"{}\" with all its constants",
            tissue.law
        );
        let problem = Problem::new("is a constant of the tissue").help(help);
        let problem = Problem { found: written(value.get_ref()), ..problem };
        return Err(Box::new((name, own.span(), problem)));
    }
    let has_volume = VOLUME.iter().any(|key| table.contains_key(*key));
    let is_replaced = |key: &str| table.contains_key(key) || (has_volume && VOLUME.contains(&key));
    let assumed: Vec<_> = assumed.into_iter().filter(|(key, _)| !is_replaced(key.get_ref())).collect();
    if !table.contains_key("law") {
        table.insert(
            Spanned::new(span.clone(), "law".into()),
            Spanned::new(span.clone(), DeValue::String(tissue.law.as_str().into())),
        );
    }
    for (key, value) in constants.into_iter().chain(assumed) {
        let key = Spanned::new(span.clone(), key.into_inner());
        table.insert(key, Spanned::new(span.clone(), placed(value.into_inner(), &span)));
    }
    Ok(())
}

/// The value with all its spans at one place.
fn placed<'t>(value: DeValue<'t>, span: &Range<usize>) -> DeValue<'t> {
    match value {
        DeValue::Array(items) => DeValue::Array(
            items
                .into_iter()
                .map(|item| Spanned::new(span.clone(), placed(item.into_inner(), span)))
                .collect(),
        ),
        scalar => scalar,
    }
}

/// Extends the schema of a scene by tissues: another form of each material, beside which the keys of its law go.
pub(crate) fn describe(mut schema: Value) -> Value {
    for at in ["/properties/material/oneOf", "/properties/region/items/properties/material/oneOf"] {
        let Some(forms) = schema.pointer_mut(at).and_then(Value::as_array_mut) else { continue };
        forms.push(json!({
            "type": "object",
            "description": "A tissue with published constants",
            "x-kind": "tissue",
            "properties": { "tissue": {
                "type": "string",
                "description": "A tissue of the catalogue (`tissuebench list tissues`), in place of law and its constants",
            } },
            "required": ["tissue"],
        }));
    }
    schema
}
