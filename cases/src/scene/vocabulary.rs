//! Entries of the catalogue as keys of a file: a name, and settings next to it.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::marker::PhantomData;

use catalogue::{Build, Dimension, Entry, Kind, Parameter, Problem, Value, Values, find, nearest};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, de::Error as _};
use serde_json::{Map, json};

use super::report::Report;
use crate::exact::{Exact, Medium};

/// A kind of catalogue entries that files can name.
pub(crate) trait Vocabulary: 'static {
    /// Constructor of the entries.
    type Build: 'static;
    /// Noun for one entry in messages.
    const NOUN: &'static str;
    /// All entries.
    const ENTRIES: &'static [Entry<Self::Build>];
}

/// The name of an entry.
pub(crate) struct Word<V: Vocabulary>(pub &'static Entry<V::Build>);

impl<V: Vocabulary> Clone for Word<V> {
    fn clone(&self) -> Word<V> {
        Word(self.0)
    }
}

impl<'de, V: Vocabulary> Deserialize<'de> for Word<V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Word<V>, D::Error> {
        let name = String::deserialize(deserializer)?;
        find(V::ENTRIES, &name).map(Word).map_err(D::Error::custom)
    }
}

impl<V: Vocabulary> JsonSchema for Word<V> {
    fn schema_name() -> Cow<'static, str> {
        V::NOUN.into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let word = |entry: &Entry<V::Build>| json!({ "type": "string", "const": entry.name, "description": entry.meaning });
        json_schema!({ "oneOf": V::ENTRIES.iter().map(word).collect::<Vec<_>>() })
    }
}

/// Settings next to the name: parameters of any entry, which [`settings`] checks against the named entry.
pub(crate) struct Given<V>(BTreeMap<String, Setting>, PhantomData<V>);

/// One value in a file.
#[derive(Clone, Deserialize)]
#[serde(untagged)]
enum Setting {
    Flag(bool),
    Number(f64),
    Quantity(String),
    List(Vec<Setting>),
}

impl<V> Given<V> {
    /// Names of the given settings.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }
}

impl<'de, V> Deserialize<'de> for Given<V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Given<V>, D::Error> {
        Ok(Given(BTreeMap::deserialize(deserializer)?, PhantomData))
    }
}

impl<V: Vocabulary> JsonSchema for Given<V> {
    fn schema_name() -> Cow<'static, str> {
        format!("settings of a {}", V::NOUN).into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut properties = Map::new();
        for parameter in V::ENTRIES.iter().flat_map(|entry| entry.parameters) {
            let known = properties.entry(parameter.name).or_insert_with(|| property(parameter));
            // Entries use this name with several dimensions. The dimension is checked when the entry is
            // known.
            if known["x-quantity"] != property(parameter)["x-quantity"] {
                *known = json!({ "type": "string", "description": parameter.meaning });
            }
        }
        json_schema!({ "type": "object", "properties": properties })
    }
}

fn property(parameter: &Parameter) -> serde_json::Value {
    let one = match (parameter.kind, parameter.dimension) {
        (Kind::Flag, _) => json!({ "type": "boolean" }),
        (Kind::Count, _) => json!({ "type": "integer", "format": "uint32", "minimum": 0 }),
        (_, dimension) if dimension.is_plain() => json!({ "type": "number", "format": "double" }),
        (_, dimension) => json!({
            "type": "string",
            "x-quantity": dimension.name(),
            "examples": [format!("1 {}", dimension.offered().first().unwrap_or(&""))],
        }),
    };
    let mut schema = match parameter.kind {
        Kind::List => json!({ "type": "array", "items": one }),
        Kind::Vector => json!({ "type": "array", "items": one, "minItems": 3, "maxItems": 3 }),
        Kind::Number | Kind::Count | Kind::Flag => one,
    };
    schema["description"] = parameter.meaning.into();
    schema
}

/// Settings of an entry. Reports settings that the entry does not have, values out of range, and missing
/// settings. Returns `None` if anything was reported.
pub(crate) fn settings<V: Vocabulary>(word: &Word<V>, given: Given<V>, report: &Report) -> Option<Values> {
    let entry = word.0;
    let mut values = Values::new(entry.parameters);
    let mut sound = true;
    for (name, setting) in given.0 {
        let read = match entry.parameter(&name) {
            None => {
                Err(Problem::new(format!("does not belong to this {}", V::NOUN)).help(of_entry(entry, &name)))
            }
            Some(parameter) => read(setting, parameter.dimension).and_then(|value| values.give(&name, value)),
        };
        if let Err(problem) = read {
            sound = false;
            report.add(&name, problem);
        }
    }
    let lacking = entry.parameters.iter().filter(|p| p.required && !values.has(p.name));
    for parameter in lacking {
        sound = false;
        if !report.has(parameter.name) {
            let help = format!("this {} needs the key: {}", V::NOUN, parameter.meaning);
            report.missing(parameter.name, &help);
        }
    }
    sound.then_some(values)
}

/// Help for a setting that the entry does not have.
fn of_entry<B>(entry: &Entry<B>, name: &str) -> String {
    match nearest(name, entry.parameters.iter().map(|parameter| parameter.name)) {
        Some(near) => format!("did you mean '{near}'?"),
        None => format!("{} takes no {name}: leave it out", entry.name),
    }
}

fn read(setting: Setting, dimension: Dimension) -> Result<Value, Problem> {
    let number = |setting| match setting {
        Setting::Number(number) if dimension.is_plain() => Ok(number),
        Setting::Number(number) => Err(Problem::new("has no unit").help(dimension.fix(&number.to_string()))),
        Setting::Quantity(text) => dimension.read(&text),
        Setting::Flag(_) | Setting::List(_) => Err(Problem::new("is not a number")),
    };
    match setting {
        Setting::Flag(flag) => Ok(Value::Flag(flag)),
        Setting::List(list) => list.into_iter().map(number).collect::<Result<_, _>>().map(Value::List),
        one => number(one).map(Value::Number),
    }
}

/// Constructs the object of an entry. An error of the constructor is reported at the parameter that it names,
/// or else at `key`.
pub(crate) fn build<T>(entry: &Entry<Build<T>>, values: &Values, key: &str, report: &Report) -> Option<T> {
    (entry.build)(values).map_err(|bad| report.add(bad.parameter.unwrap_or(key), bad)).ok()
}

/// The schema of a table that names an entry by the key `tag` and has its settings, together with the keys
/// `K` of all entries of the kind. There is one form for each entry, so that a setting of another entry is
/// not a valid key.
pub(crate) fn tagged<V: Vocabulary, K: JsonSchema>(
    tag: &str,
    meaning: &str,
    generator: &mut SchemaGenerator,
) -> Schema {
    let beside = K::json_schema(generator).to_value();
    let form = |entry: &Entry<V::Build>| {
        let mut properties = beside["properties"].as_object().cloned().unwrap_or_default();
        let mut required = beside["required"].as_array().cloned().unwrap_or_default();
        properties.insert(tag.into(), json!({ "type": "string", "const": entry.name }));
        required.push(tag.into());
        for parameter in entry.parameters {
            properties.insert(parameter.name.into(), property(parameter));
            if parameter.required {
                required.push(parameter.name.into());
            }
        }
        json!({
            "type": "object",
            "description": entry.meaning,
            "properties": properties,
            "required": required,
            "additionalProperties": false,
        })
    };
    let forms: Vec<_> = V::ENTRIES.iter().map(form).collect();
    json_schema!({ "description": meaning, "oneOf": forms })
}

/// Laws of materials.
pub(crate) enum Laws {}

impl Vocabulary for Laws {
    type Build = catalogue::Build<material::Law>;
    const NOUN: &'static str = "law";
    const ENTRIES: &'static [Entry<Self::Build>] = material::LAWS;
}

/// Shapes of tools.
pub(crate) enum ToolShapes {}

impl Vocabulary for ToolShapes {
    type Build = fn(&Values) -> Result<contact::ToolShape, Problem>;
    const NOUN: &'static str = "shape";
    const ENTRIES: &'static [Entry<Self::Build>] = contact::TOOL_SHAPES;
}

/// Exact solutions.
pub(crate) enum Solutions {}

impl Vocabulary for Solutions {
    type Build = fn(&Medium, &Values) -> Result<Box<dyn Exact>, Problem>;
    const NOUN: &'static str = "exact solution";
    const ENTRIES: &'static [Entry<Self::Build>] = crate::exact::SOLUTIONS;
}

/// Kernels of clouds.
pub(crate) enum Kernels {}

impl Vocabulary for Kernels {
    type Build = fn(&Values) -> Result<efg::Kernel, Problem>;
    const NOUN: &'static str = "kernel";
    const ENTRIES: &'static [Entry<Self::Build>] = efg::KERNELS;
}

/// Transfer schemes.
pub(crate) enum Schemes {}

impl Vocabulary for Schemes {
    type Build = fn(&Values) -> Result<interp::Scheme, Problem>;
    const NOUN: &'static str = "scheme";
    const ENTRIES: &'static [Entry<Self::Build>] = interp::SCHEMES;
}
