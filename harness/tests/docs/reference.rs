//! The book's reference pages, generated from the schemas and the program's output.
//!
//! `cargo xtask book` sets `TISSUEBENCH_BOOK=write`. Without this variable, the committed pages must equal
//! the generated ones.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::process::Command;

use catalogue::metric::{Address, METRICS};
use serde_json::Value;

use crate::root;

pub fn compare_or_write() {
    let write = std::env::var_os("TISSUEBENCH_BOOK").is_some();
    let mut stale = Vec::new();
    for (name, text) in pages() {
        let path = root().join("docs/src/reference").join(name);
        if std::fs::read_to_string(&path).is_ok_and(|old| old == text) {
            continue;
        }
        if write {
            std::fs::write(&path, text).expect("written");
        } else {
            stale.push(name);
        }
    }
    assert!(
        stale.is_empty(),
        "stale pages in docs/src/reference: {}; run `cargo xtask book`",
        stale.join(", ")
    );
}

fn pages() -> [(&'static str, String); 5] {
    let scene = keys(
        "Keys of a scene",
        "Every key of a scene file, generated from its schema (`tissuebench schema`).",
        &cases::scene::schema(),
    );
    let study = keys(
        "Keys of a study",
        "Every key of a study file, generated from its schema (`tissuebench schema study`).",
        &cases::scene::study_schema(),
    );
    let names = format!(
        "# Names\n\nEverything that a scene can name, as `tissuebench list` prints it.\n\n```text\n{}```\n",
        printed(&["list"])
    );
    let mut commands = String::from("# Command line\n\nGenerated from `tissuebench --help`.\n");
    let help = printed(&["--help"]);
    write!(commands, "\n```text\n{help}```\n").expect("a string");
    for verb in verbs(&help) {
        write!(commands, "\n## `{verb}`\n\n```text\n{}```\n", printed(&[verb, "--help"])).expect("a string");
    }
    [
        ("scene.md", scene),
        ("study.md", study),
        ("names.md", names),
        ("commands.md", commands),
        ("numbers.md", numbers()),
    ]
}

/// Names of numbers with a component or an index, and the columns that hold them.
fn numbers() -> String {
    let mut text = String::from(
        "# Names of numbers\n\n\
         A check, a baseline and a message name a number in one word: the metric, its component, and the number of \
         its tool, support or face from 2 on. Records have a column for each of the three. Tables of older \
         programs, without the columns `component` and `index`, have the whole name as their `quantity` and are read \
         by this map. All other metrics are numbers of the whole run, without component and index.\n\n\
         | name | `quantity` | `component` | `index` |\n| --- | --- | --- | --- |\n",
    );
    let of_run = |of: &Address| of.component.is_empty() && of.index.is_none();
    for first in METRICS.iter().flat_map(|metric| metric.addresses()).filter(|of| !of_run(of)) {
        let second = first.index.map(|_| first.at(1));
        for of in [first].into_iter().chain(second) {
            let index = of.index.map_or(String::new(), |index| index.to_string());
            let component = of.component;
            writeln!(text, "| `{of}` | `{}` | {component} | {index} |", of.metric.name).expect("a string");
        }
    }
    text
}

/// Commands that the program's help lists.
fn verbs(help: &str) -> Vec<&str> {
    let listed =
        help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    listed.filter_map(|line| line.split_whitespace().next()).filter(|verb| *verb != "help").collect()
}

/// Output of the program in an empty folder, without spaces at line ends.
fn printed(args: &[&str]) -> String {
    let dir = tempfile::tempdir().expect("a folder");
    let output = Command::new(env!("CARGO_BIN_EXE_tissuebench")).args(args).current_dir(dir.path()).output();
    let text = String::from_utf8(output.expect("runs").stdout).expect("utf-8");
    text.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// Row of a table of keys.
#[derive(PartialEq)]
struct Row {
    key: String,
    value: String,
    required: bool,
    /// Kinds of the enclosing table that have the key.
    kinds: Vec<String>,
    meaning: String,
}

/// Generates a page with a table for every top-level key of a file.
fn keys(title: &str, opening: &str, schema: &Value) -> String {
    let mut page = format!("# {title}\n\n{opening} *Needed* marks keys without a default.\n");
    let plain = "| key | value | needed | with | meaning |\n| --- | --- | --- | --- | --- |\n";
    let properties = schema["properties"].as_object().expect("a table of keys");
    for (name, property) in properties {
        let mut rows = Vec::new();
        walk(name, property, is_required(schema, name), &[], &mut rows, properties);
        write!(page, "\n## `{name}`\n\n{plain}").expect("a string");
        for row in merged(rows) {
            let needed = if row.required { "yes" } else { "" };
            let cells =
                [format!("`{}`", row.key), row.value, needed.into(), row.kinds.join(", "), row.meaning];
            let cells = cells.map(|cell| cell.replace('|', "\\|").replace('\n', " "));
            writeln!(page, "| {} |", cells.join(" | ")).expect("a string");
        }
    }
    page
}

/// Adds the rows of a key and of all keys below it. `top` are the top-level keys: a table that repeats one of
/// them is not expanded again.
fn walk(
    key: &str,
    schema: &Value,
    required: bool,
    kinds: &[String],
    rows: &mut Vec<Row>,
    top: &serde_json::Map<String, Value>,
) {
    let alternatives = alternatives(schema);
    let mut meaning = vec![schema["description"].as_str().unwrap_or_default().to_string()];
    let choices = alternatives.iter().filter(|a| a["const"].is_string());
    meaning.extend(
        choices.filter_map(|a| Some(format!("`{}`: {}", a["const"].as_str()?, a["description"].as_str()?))),
    );
    let mut value: Vec<String> = alternatives.iter().map(|a| kind(a)).collect();
    value.dedup();
    let same = top
        .iter()
        .find(|(name, other)| key.contains('.') && bare(other) == bare(schema) && key.ends_with(*name));
    if let Some((name, _)) = same {
        value = vec![format!("as [`{name}`](#{name})")];
    }
    let meaning =
        meaning.into_iter().filter(|m| !m.is_empty()).collect::<Vec<_>>().join(". ").replace(".. ", ". ");
    rows.push(Row { key: key.into(), value: value.join(" or "), required, kinds: kinds.to_vec(), meaning });
    if same.is_none() {
        alternatives.iter().for_each(|a| below(key, a, kinds, rows, top));
    }
}

/// Adds the keys of a table, of the tables of a list, or of one kind of table.
fn below(
    key: &str,
    schema: &Value,
    kinds: &[String],
    rows: &mut Vec<Row>,
    top: &serde_json::Map<String, Value>,
) {
    if schema["items"].is_object() {
        alternatives(&schema["items"])
            .iter()
            .for_each(|item| below(&format!("{key}[]"), item, kinds, rows, top));
    }
    let Some(properties) = schema["properties"].as_object() else { return };
    let tag = properties.iter().find(|(_, p)| p["const"].is_string());
    let own: Vec<String> = match tag {
        Some((name, choice)) => {
            let choice = choice["const"].as_str().unwrap_or_default();
            let said = schema["description"].as_str().map_or(String::new(), |d| format!("`{choice}`: {d}."));
            let row = Row {
                key: format!("{key}.{name}"),
                value: format!("`\"{choice}\"`"),
                required: true,
                kinds: kinds.to_vec(),
                meaning: said.replace("..", "."),
            };
            rows.push(row);
            vec![format!("`{choice}`")]
        }
        None => schema["x-kind"].as_str().map_or(kinds.to_vec(), |kind| vec![format!("`{kind}`")]),
    };
    for (name, property) in properties.iter().filter(|(_, p)| !p["const"].is_string()) {
        walk(&format!("{key}.{name}"), property, is_required(schema, name), &own, rows, top);
    }
}

/// Merges rows with the same key, value and meaning, and merges the choices of a kind into a list.
fn merged(rows: Vec<Row>) -> Vec<Row> {
    let mut kept: Vec<Row> = Vec::new();
    for row in rows {
        let is_tag = |r: &Row| r.value.starts_with("`\"") && r.required;
        let twin = kept.iter_mut().find(|old| {
            old.key == row.key
                && ((old.value == row.value && old.required == row.required && old.meaning == row.meaning)
                    || (is_tag(old) && is_tag(&row) && old.kinds == row.kinds))
        });
        match twin {
            Some(old) if old.value == row.value => old.kinds.extend(row.kinds),
            Some(old) => {
                old.value = format!("{}, {}", old.value, row.value);
                old.meaning = format!("{} {}", old.meaning, row.meaning).trim().to_string();
            }
            None => kept.push(row),
        }
    }
    // A key of all kinds of a table needs no condition.
    let mut all: BTreeMap<String, usize> = BTreeMap::new();
    for row in kept.iter().filter(|row| row.value.starts_with("`\"") && row.required) {
        let table = row.key.rsplit_once('.').map_or("", |(table, _)| table);
        all.insert(table.to_string(), row.value.matches("`\"").count());
    }
    for row in &mut kept {
        let table = row.key.rsplit_once('.').map_or("", |(table, _)| table);
        if all.get(table) == Some(&row.kinds.len()) {
            row.kinds.clear();
        }
    }
    kept
}

/// Alternatives of a value, without null.
fn alternatives(schema: &Value) -> Vec<&Value> {
    for word in ["anyOf", "oneOf"] {
        if let Some(list) = schema[word].as_array() {
            return list.iter().filter(|a| a["type"] != "null").flat_map(|a| alternatives(a)).collect();
        }
    }
    vec![schema]
}

/// Type of a value in words.
fn kind(schema: &Value) -> String {
    let word = |name: &str| match &schema["type"] {
        Value::String(t) => t == name,
        Value::Array(list) => list.iter().any(|t| t == name),
        _ => false,
    };
    let quoted = |v: &Value| format!("`\"{}\"`", v.as_str().unwrap_or_default());
    if let Some(list) = schema["enum"].as_array() {
        return list.iter().filter(|v| v.is_string()).map(quoted).collect::<Vec<_>>().join(", ");
    }
    if schema["const"].is_string() {
        return quoted(&schema["const"]);
    }
    if let Some(dimension) = schema["x-quantity"].as_str() {
        return format!("{dimension}, such as {}", quoted(&schema["examples"][0]));
    }
    if let Some(dimension) = schema["x-unit"].as_str() {
        return format!("unit of {dimension}");
    }
    if word("array") {
        let items =
            alternatives(&schema["items"]).iter().map(|i| kind(i)).collect::<std::collections::BTreeSet<_>>();
        let items = items.into_iter().collect::<Vec<_>>().join(" or ");
        let list = match schema["minItems"].as_u64() {
            Some(count) if schema["maxItems"] == count => format!("{count} of: "),
            _ => "list of: ".to_string(),
        };
        return list + &items;
    }
    let words = [
        ("object", "table"),
        ("boolean", "`true` or `false`"),
        ("integer", "integer"),
        ("number", "number"),
        ("string", "text"),
    ];
    words.iter().find(|(name, _)| word(name)).map_or("value", |(_, said)| said).to_string()
}

fn is_required(schema: &Value, name: &str) -> bool {
    schema["required"].as_array().is_some_and(|list| list.iter().any(|n| n == name))
}

/// Schema without its description.
fn bare(schema: &Value) -> Value {
    let mut schema = schema.clone();
    if let Some(object) = schema.as_object_mut() {
        object.remove("description");
    }
    schema
}
