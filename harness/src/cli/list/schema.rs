//! Lists the values of a scene's key, from the schema of scenes.

use serde_json::{Map, Value};

use super::item::{Item, optional};

/// Returns the values allowed at `path`: keys joined by dots, with words that select a form of a table.
pub fn forms(path: &str) -> Vec<Item> {
    let schema = cases::scene::schema();
    let mut forms = vec![&schema];
    for step in path.split('.') {
        forms = forms.into_iter().flat_map(|form| below(form, step)).collect();
    }
    let mut found: Vec<Item> = Vec::new();
    for item in forms.into_iter().filter_map(items) {
        // The item type of a list repeats that of a single value.
        if found.iter().all(|other| other.name != item.name) {
            found.push(item);
        }
    }
    found
}

/// Returns the alternatives of a value or of the items of a list, without `null`.
fn alternatives(schema: &Value) -> Vec<&Value> {
    let list = ["anyOf", "oneOf"].into_iter().find_map(|word| schema[word].as_array());
    match list {
        Some(list) => list.iter().filter(|form| form["type"] != "null").flat_map(alternatives).collect(),
        None if schema["items"].is_object() && schema["minItems"].is_null() => alternatives(&schema["items"]),
        None => vec![schema],
    }
}

/// Returns the form itself if `step` is its word, otherwise the alternatives at its key of that name.
fn below<'s>(form: &'s Value, step: &str) -> Vec<&'s Value> {
    let Some(keys) = form["properties"].as_object() else { return vec![] };
    match keys.get(step) {
        _ if tag(keys).is_some_and(|(_, word)| word == step) => vec![form],
        Some(schema) => alternatives(schema),
        None => vec![],
    }
}

/// Returns the key that distinguishes a form of a table, and its word.
fn tag(keys: &Map<String, Value>) -> Option<(&str, &str)> {
    keys.iter().find_map(|(key, schema)| Some((key.as_str(), schema["const"].as_str()?)))
}

/// Returns the item of a word or of a table. A table with a word is named by the word.
fn items(form: &Value) -> Option<Item> {
    let meaning = form["description"].as_str().unwrap_or_default();
    if let Some(word) = form["const"].as_str() {
        return Some(Item::new(word, "", meaning));
    }
    let keys = form["properties"].as_object()?;
    let word = tag(keys);
    let name = word.map_or("a table", |(_, word)| word);
    let mut settings = settings("", form, word.map(|(key, _)| key));
    settings.extend(surfaces(form, keys));
    Some(Item { settings, ..Item::new(name, "", meaning) })
}

/// Returns the keys of a table, required keys first, each followed by the keys of its own tables.
fn settings(above: &str, table: &Value, tag: Option<&str>) -> Vec<Item> {
    let keys: Vec<_> = table["properties"].as_object().into_iter().flatten().collect();
    let required = |key: &str| table["required"].as_array().is_some_and(|keys| keys.iter().any(|k| k == key));
    let (first, last): (Vec<_>, Vec<_>) = keys.into_iter().partition(|(key, _)| required(key));
    let mut found = Vec::new();
    for (key, schema) in first.into_iter().chain(last).filter(|(key, _)| Some(key.as_str()) != tag) {
        let forms = alternatives(schema);
        let mut said = [schema].into_iter().chain(forms.iter().copied());
        let mut meaning =
            said.find_map(|schema| schema["description"].as_str()).unwrap_or_default().to_string();
        let words: Vec<&str> = forms.iter().filter_map(|form| form["const"].as_str()).collect();
        if !words.is_empty() {
            meaning = format!("{}: {}", meaning.trim_end_matches('.'), words.join(", "));
        }
        let name = format!("{above}{key}");
        found.push(Item::new(&optional(&name, required(key)), &value(schema, &forms), &meaning));
        let tables = forms.iter().filter(|form| form["properties"].is_object());
        tables.for_each(|form| found.extend(settings(&format!("{name}."), form, None)));
    }
    found
}

/// Describes the type of a value.
fn value(schema: &Value, forms: &[&Value]) -> String {
    if forms.iter().any(|form| form["const"].is_string()) {
        return "word".into();
    }
    let form = forms.first().copied().unwrap_or(schema);
    if let Some(dimension) = form["x-quantity"].as_str() {
        return dimension.into();
    }
    if let Some(dimension) = form["x-unit"].as_str() {
        return format!("unit of {dimension}");
    }
    let is = |name: &str| {
        form["type"] == name || form["type"].as_array().is_some_and(|types| types.iter().any(|t| t == name))
    };
    if is("array") {
        let inner = alternatives(&form["items"]);
        let count = form["minItems"].as_u64().map_or("list".into(), |count| count.to_string());
        return format!("{count} of: {}", value(&form["items"], &inner));
    }
    let names = [
        ("object", "table"),
        ("boolean", "true or false"),
        ("integer", "whole number"),
        ("number", "number"),
        ("string", "text"),
    ];
    names.into_iter().find(|(name, _)| is(name)).map_or("value", |(_, said)| said).into()
}

/// Returns the names of a body's surfaces, including those added by a key.
fn surfaces(form: &Value, keys: &Map<String, Value>) -> Vec<Item> {
    let names = |schema: &Value| -> Option<String> {
        let names = schema["x-surfaces"].as_array()?.iter().filter_map(Value::as_str);
        Some(names.collect::<Vec<_>>().join(", "))
    };
    let own = names(form).map(|names| Item::new("surfaces", "", &names));
    let of_key =
        |(key, schema): (&String, &Value)| Some(Item::new(&format!("with {key}"), "", &names(schema)?));
    own.into_iter().chain(keys.iter().filter_map(of_key)).collect()
}
