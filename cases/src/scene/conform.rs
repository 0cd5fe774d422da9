//! Checks a spanned TOML value against the schema of its target types. Every unknown key, missing key, wrong
//! type and unreadable quantity is reported at its place, not only the first.

use std::ops::Range;

use serde_json::{Map, Value};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use catalogue::{Dimension, Problem, clip, nearest, suggest};

use super::expression::Expression;
use super::region::Region;

/// Renamed keys, old name and new name; keys once spelled with hyphens, such as `on-stall`, need no entry.
const RENAMED: [(&str, &str); 3] =
    [("dilatation", "support_scale"), ("dilatations", "support_scales"), ("support", "neighbourhood")];

/// A problem at a place.
#[derive(Debug)]
pub(crate) struct Finding {
    pub key: String,
    pub span: Range<usize>,
    pub problem: Problem,
}

/// Finds all parts of `value` that `schema` doesn't allow.
pub(crate) fn check(value: &DeValue<'_>, span: Range<usize>, schema: &Value) -> Vec<Finding> {
    let mut findings = Vec::new();
    any(value, span, "", schema, &mut findings);
    findings
}

/// Joins `method[1]` and `size` into `method[1].size`.
pub(crate) fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_string() } else { format!("{path}.{key}") }
}

fn any(value: &DeValue<'_>, span: Range<usize>, path: &str, schema: &Value, findings: &mut Vec<Finding>) {
    let mut forms = Vec::new();
    flatten(schema, &mut forms);
    let fitting: Vec<_> = forms.iter().copied().filter(|form| fits(value, form)).collect();
    let mut add = |problem| findings.push(Finding { key: path.to_string(), span: span.clone(), problem });
    match (value, fitting.as_slice()) {
        (_, []) if forms.is_empty() => {}
        (_, []) => add(wrong_type(value, &forms)),
        // Only one form is a text, and this text is a word: "1 kPa" may stand where [x, y, z] or "exact" is
        // expected. The other forms give a better message.
        (DeValue::String(text), [form])
            if forms.len() > 1 && words_of(form).is_some_and(|words| nearest(text, words).is_none()) =>
        {
            let problem = wrong_type(value, &forms);
            add(match schema.get("description").and_then(Value::as_str) {
                Some(meaning) => problem.help(clause(meaning)),
                None => problem,
            });
        }
        (_, [form]) => one(value, span, path, form, findings),
        (DeValue::Table(table), several) => match tagged(table, span.clone(), path, several) {
            Ok(form) => keys(table, span, path, form, several, findings),
            Err(finding) => findings.push(*finding),
        },
        // Lists of numbers or of expressions: the form that fits best, the first of equals.
        (DeValue::Array(_), several) => {
            let of_form = |form: &&Map<String, Value>| {
                let mut of_form = Vec::new();
                one(value, span.clone(), path, form, &mut of_form);
                of_form
            };
            findings.extend(several.iter().map(of_form).min_by_key(Vec::len).into_iter().flatten());
        }
        (_, several) => {
            let words: Vec<&str> = several.iter().flat_map(|form| words(form)).collect();
            if matches!(value, DeValue::String(text) if words.contains(&text.as_ref())) {
                return;
            }
            match several.iter().find(|form| words_of(form).is_none()) {
                Some(form) => one(value, span, path, form, findings),
                None => add(not_one_of(value, &words)),
            }
        }
    }
}

/// Alternatives of a schema without `null`, which stands for an absent key in TOML.
fn flatten<'s>(schema: &'s Value, forms: &mut Vec<&'s Map<String, Value>>) {
    let Some(map) = schema.as_object() else { return };
    match map.get("anyOf").or(map.get("oneOf")).and_then(Value::as_array) {
        Some(list) => list.iter().for_each(|schema| flatten(schema, forms)),
        None if map.get("type").and_then(Value::as_str) == Some("null") => {}
        None => forms.push(map),
    }
}

fn types(form: &Map<String, Value>) -> Vec<&str> {
    match form.get("type") {
        Some(Value::String(name)) => vec![name],
        Some(Value::Array(names)) => {
            names.iter().filter_map(Value::as_str).filter(|n| *n != "null").collect()
        }
        _ => vec![],
    }
}

fn fits(value: &DeValue<'_>, form: &Map<String, Value>) -> bool {
    let types = types(form);
    types.is_empty()
        || types.iter().any(|name| match value {
            DeValue::String(_) => *name == "string",
            DeValue::Integer(_) => *name == "integer" || *name == "number",
            DeValue::Float(_) => *name == "number",
            DeValue::Boolean(_) => *name == "boolean",
            DeValue::Array(_) => *name == "array",
            DeValue::Table(_) => *name == "object",
            DeValue::Datetime(_) => false,
        })
}

fn wrong_type(value: &DeValue<'_>, forms: &[&Map<String, Value>]) -> Problem {
    let text = written(value);
    let quantity = forms.iter().find_map(|form| form.get("x-quantity")).and_then(Value::as_str);
    if let (DeValue::Integer(_) | DeValue::Float(_), Some(dimension), Some(text)) =
        (value, quantity.and_then(Dimension::from_name), &text)
    {
        return Problem::new("has no unit").found(text).help(dimension.fix(text));
    }
    let wanted = describe_all(forms);
    let found = match value {
        DeValue::Table(_) => "a table",
        DeValue::Array(_) => "a list",
        DeValue::String(_) => "text",
        DeValue::Integer(_) | DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "a truth value",
        DeValue::Datetime(_) => "a date",
    };
    let problem = Problem::new(format!("is {found}, where {wanted} belongs"));
    match text {
        Some(text) => problem.found(text),
        None => problem,
    }
}

/// Describes the values allowed at a place; all single words are joined into one list.
fn describe_all(forms: &[&Map<String, Value>]) -> String {
    let listed: Vec<&str> = forms.iter().flat_map(words).collect();
    let mut wanted: Vec<String> = Vec::new();
    match listed.as_slice() {
        [] => {}
        [word] => wanted.push(format!("\"{word}\"")),
        several => wanted.push(format!("one of \"{}\"", several.join("\", \""))),
    }
    wanted.extend(forms.iter().filter(|form| words_of(form).is_none()).map(|form| describe(form)));
    // Several laws take the same keys.
    wanted.dedup();
    wanted.join(" or ")
}

fn describe(form: &Map<String, Value>) -> String {
    if let Some(dimension) = form.get("x-quantity").and_then(Value::as_str).and_then(Dimension::from_name) {
        return format!(
            "a {} with its unit in quotes (such as \"1 {}\")",
            dimension.name(),
            dimension.si_unit()
        );
    }
    if form.contains_key("x-region") {
        return "a region such as \"z == 0 mm and x >= 3 mm\"".into();
    }
    if form.contains_key("x-expression") {
        return "an expression in quotes such as \"z^2\"".into();
    }
    match types(form).first() {
        Some(&"string") => "text in quotes".into(),
        Some(&"integer") => "a whole number".into(),
        Some(&"number") => "a number without quotes".into(),
        Some(&"boolean") => "true or false".into(),
        Some(&"array") => match form.get("minItems").and_then(Value::as_u64) {
            Some(n) => format!("a list of {n}{}", example(form, n)),
            None => "a list".into(),
        },
        Some(&"object") => describe_table(form),
        _ => "something else".into(),
    }
}

/// Turns a sentence into the second half of another sentence: its first letter becomes lower case.
fn clause(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().into_iter().flat_map(char::to_lowercase).chain(letters).collect()
}

/// An example of a list of quantities; empty for other lists.
fn example(list: &Map<String, Value>, count: u64) -> String {
    let mut forms = Vec::new();
    list.get("items").into_iter().for_each(|items| flatten(items, &mut forms));
    let dimension = forms.iter().find_map(|form| Dimension::from_name(form.get("x-quantity")?.as_str()?));
    let Some(unit) = dimension.and_then(|dimension| dimension.offered().first().copied()) else {
        return String::new();
    };
    let items = (1..=count).map(|item| format!("\"{} {unit}\"", u8::from(item == count)));
    format!(" such as [{}]", items.collect::<Vec<_>>().join(", "))
}

/// Describes a table by its mutually exclusive keys if it has any, or else by all its keys.
fn describe_table(form: &Map<String, Value>) -> String {
    let names = |list: &Value| -> Option<Vec<String>> {
        list.as_array()?.iter().map(|name| Some(name.as_str()?.to_string())).collect()
    };
    if let Some(names) = form.get("x-one-of").and_then(names) {
        return format!("a table with one of {}", names.join(", "));
    }
    match form.get("properties").and_then(Value::as_object) {
        Some(keys) => format!("a table {{ {} }}", keys.keys().cloned().collect::<Vec<_>>().join(", ")),
        None => "a table".into(),
    }
}

/// The words that a form allows, if it is restricted to words.
fn words_of(form: &Map<String, Value>) -> Option<Vec<&str>> {
    if let Some(word) = form.get("const").and_then(Value::as_str) {
        return Some(vec![word]);
    }
    Some(form.get("enum")?.as_array()?.iter().filter_map(Value::as_str).collect())
}

fn words<'s>(form: &&'s Map<String, Value>) -> Vec<&'s str> {
    words_of(form).unwrap_or_default()
}

fn not_one_of(value: &DeValue<'_>, words: &[&str]) -> Problem {
    let text = written(value).unwrap_or_default();
    Problem::new("is not known").found(&text).help(suggest(&text, words))
}

/// Selects the table that is meant, among tables distinguished by the word under one key (`shape = "box"`).
fn tagged<'s>(
    table: &DeTable<'_>,
    span: Range<usize>,
    path: &str,
    forms: &[&'s Map<String, Value>],
) -> Result<&'s Map<String, Value>, Box<Finding>> {
    let variants: Vec<(&str, &str, &'s Map<String, Value>)> =
        forms.iter().filter_map(|form| tag(form).map(|(tag, word)| (tag, word, *form))).collect();
    let tag = variants.first().map_or("", |variant| variant.0);
    let words: Vec<&str> = variants.iter().map(|variant| variant.1).collect();
    let Some((_, value)) = table.iter().find(|(key, _)| key.get_ref().as_ref() == tag) else {
        let help = format!("add {tag} = \"...\", one of: {}", words.join(", "));
        let problem = Problem::new("is missing").help(help);
        return Err(Box::new(Finding { key: join(path, tag), span, problem }));
    };
    let word = written(value.get_ref()).unwrap_or_default();
    match variants.iter().find(|variant| variant.1 == word) {
        Some(variant) => Ok(variant.2),
        None => {
            let problem = not_one_of(value.get_ref(), &words);
            Err(Box::new(Finding { key: join(path, tag), span: value.span(), problem }))
        }
    }
}

fn one(
    value: &DeValue<'_>,
    span: Range<usize>,
    path: &str,
    form: &Map<String, Value>,
    findings: &mut Vec<Finding>,
) {
    let result = match value {
        DeValue::Table(table) => return keys(table, span, path, form, &[], findings),
        DeValue::Array(array) => return items(array, span, path, form, findings),
        DeValue::String(text) => string(text, form),
        DeValue::Integer(_) | DeValue::Float(_) => number(value, form),
        DeValue::Boolean(_) | DeValue::Datetime(_) => Ok(()),
    };
    if let Err(problem) = result {
        findings.push(Finding { key: path.to_string(), span, problem });
    }
}

fn string(text: &str, form: &Map<String, Value>) -> Result<(), Problem> {
    let dimension = |key: &str| form.get(key).and_then(Value::as_str).and_then(Dimension::from_name);
    if let Some(dimension) = dimension("x-quantity") {
        return dimension.read(text).map(drop);
    }
    if let Some(dimension) = dimension("x-unit") {
        return dimension.read_unit(text).map(drop);
    }
    if form.contains_key("x-region") {
        return Region::read(text).map(drop);
    }
    if form.contains_key("x-expression") {
        return Expression::read(text).map(drop);
    }
    match words_of(form) {
        Some(words) if !words.contains(&text) => {
            Err(Problem::new("is not known").found(text).help(suggest(text, &words)))
        }
        _ => Ok(()),
    }
}

fn number(value: &DeValue<'_>, form: &Map<String, Value>) -> Result<(), Problem> {
    let text = written(value).unwrap_or_default();
    let bad = |problem: String| Err(Problem::new(problem).found(&text));
    let whole = types(form).contains(&"integer");
    let parsed = match value {
        DeValue::Integer(number) => {
            i64::from_str_radix(number.as_str(), number.radix()).ok().map(|n| n as f64)
        }
        _ => text.parse::<f64>().ok().filter(|v| v.is_finite()),
    };
    let Some(number) = parsed else {
        return bad(if whole { "is too large".into() } else { "is not a finite number".into() });
    };
    if form.get("minimum").and_then(Value::as_f64).is_some_and(|minimum| number < minimum) {
        return bad("is negative".into());
    }
    let narrow = form.get("format").and_then(Value::as_str) == Some("uint32");
    if narrow && number > f64::from(u32::MAX) {
        return bad(format!("is larger than {}", u32::MAX));
    }
    Ok(())
}

fn items(
    array: &[Spanned<DeValue<'_>>],
    span: Range<usize>,
    path: &str,
    form: &Map<String, Value>,
    findings: &mut Vec<Finding>,
) {
    let bound = |key: &str| form.get(key).and_then(Value::as_u64);
    let count = array.len() as u64;
    let wrong = match (bound("minItems"), bound("maxItems")) {
        (Some(low), Some(high)) if low == high && count != low => {
            Some(format!("has {count} entries, not {low}"))
        }
        (Some(low), _) if count < low => Some(format!("has {count} entries, at least {low} are needed")),
        _ => None,
    };
    if let Some(problem) = wrong {
        findings.push(Finding { key: path.to_string(), span, problem: Problem::new(problem) });
    }
    if let Some(schema) = form.get("items") {
        for (i, item) in array.iter().enumerate() {
            any(item.get_ref(), item.span(), &format!("{path}[{i}]"), schema, findings);
        }
    }
}

/// The key that distinguishes a form from the others, and its word.
fn tag(form: &Map<String, Value>) -> Option<(&str, &str)> {
    let keys = form.get("properties")?.as_object()?;
    keys.iter().find_map(|(key, schema)| Some((key.as_str(), schema.get("const")?.as_str()?)))
}

/// The problem with a key that belongs to another form; `None` if no other form has the key.
fn of_another(name: &str, form: &Map<String, Value>, others: &[&Map<String, Value>]) -> Option<Problem> {
    let (key, word) = tag(form)?;
    let has = |other: &&&Map<String, Value>| {
        other.get("properties").and_then(Value::as_object).is_some_and(|keys| keys.contains_key(name))
    };
    let words: Vec<&str> = others.iter().filter(has).filter_map(|other| Some(tag(other)?.1)).collect();
    let problem = Problem::new(format!("does not belong to {key} = \"{word}\""));
    (!words.is_empty()).then(|| problem.help(format!("leave it out; it goes with {}", words.join(", "))))
}

/// Checks the keys of a table; `others` are the alternative forms, distinguished by a word as in [`tagged`].
fn keys(
    table: &DeTable<'_>,
    span: Range<usize>,
    path: &str,
    form: &Map<String, Value>,
    others: &[&Map<String, Value>],
    findings: &mut Vec<Finding>,
) {
    let empty = Map::new();
    let known = form.get("properties").and_then(Value::as_object).unwrap_or(&empty);
    let mut mistyped = Vec::new();
    for (key, value) in table {
        let name = key.get_ref().as_ref();
        let other = form.get("additionalProperties").filter(|schema| !schema.is_boolean());
        if form.get("additionalProperties") == Some(&Value::Bool(true)) {
            // The keys belong to another file, and its reader gives better messages.
            continue;
        }
        if let Some(schema) = known.get(name).or(other) {
            any(value.get_ref(), value.span(), &join(path, name), schema, findings);
        } else {
            let names: Vec<&str> = known.keys().map(String::as_str).collect();
            mistyped.extend(nearest(name, names.iter().copied()));
            let now = RENAMED
                .iter()
                .find(|(old, _)| *old == name)
                .map_or(name.replace('-', "_"), |(_, new)| (*new).into());
            let problem = match known.get_key_value(&now) {
                Some((new, _)) => Problem::new("is an old name").help(format!("write {new}")),
                None => of_another(name, form, others)
                    .unwrap_or_else(|| Problem::new("is not a known key").help(suggest(name, &names))),
            };
            findings.push(Finding { key: join(path, name), span: key.span(), problem });
        }
    }
    for name in form.get("required").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str)
    {
        if !mistyped.contains(&name) && !table.keys().any(|key| key.get_ref().as_ref() == name) {
            let mut forms = Vec::new();
            known.get(name).into_iter().for_each(|schema| flatten(schema, &mut forms));
            let problem = Problem::new("is missing").help(format!("add {}", describe_all(&forms)));
            findings.push(Finding { key: join(path, name), span: span.clone(), problem });
        }
    }
}

/// A scalar as written in the file, without quotes.
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
