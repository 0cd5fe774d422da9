//! `tissuebench list`: everything that a scene can name, from the catalogue and the schema of scenes.

mod item;
mod schema;

use std::collections::BTreeMap;
use std::path::Path;

use cases::exact::SOLUTIONS;
use cases::tissue::{self, Tissue};
use catalogue::metric::{METRICS, Metric};
use catalogue::warning::WARNINGS;
use catalogue::{Dimension, suggest, units};
use contact::TOOL_SHAPES;
use material::LAWS;

use item::{Item, print};
use schema::forms;

/// A part of the list.
struct Part {
    name: &'static str,
    /// Key at which a scene names the items.
    key: &'static str,
    items: fn() -> Vec<Item>,
}

const fn part(name: &'static str, key: &'static str, items: fn() -> Vec<Item>) -> Part {
    Part { name, key, items }
}

const PARTS: [Part; 23] = [
    part("bodies", "body.shape; their surfaces: on", || forms("body")),
    part("laws", "material.law", || Item::of_entries(LAWS)),
    part("tissues", "material.tissue, in place of law", tissues),
    part("tools", "tool.shape", tools),
    part("families", "method.family", || forms("method")),
    part("elements", "method.element, family = \"fem\"", || forms("method.fem.element")),
    part("clouds", "method.cloud, family = \"efg\"", || forms("method.efg.cloud")),
    part("kernels", "method.kernel", || Item::of_entries(efg::KERNELS)),
    part("bases", "method.basis", || forms("method.efg.basis")),
    part("neighbourhoods", "method.neighbourhood", || forms("method.efg.neighbourhood")),
    part("integration", "method.integration.rule", || forms("method.efg.integration")),
    part("dilations", "method.dilation", || forms("method.efg.dilation")),
    part("essential", "method.essential, family = \"efg\"", || forms("method.efg.essential")),
    part("masses", "method.mass, procedure.kind = \"modes\"", || forms("method.efg.mass")),
    part("procedures", "procedure.kind", || forms("procedure")),
    part("transfers", "output.transfer.scheme", transfers),
    part("solutions", "reference.exact", || Item::of_entries(SOLUTIONS)),
    part("purposes", "purpose", || forms("purpose")),
    part("publications", "published", || forms("published")),
    part("units", "of quantities such as \"20 kPa\"", dimensions),
    part("metrics", "check.metric, and recorded quantities", metrics),
    part("warnings", "of a run, counted by the metric \"warnings\"", warnings),
    part("files", "scenes and studies below this folder", || files(Path::new("cases"))),
];

/// Tissues with their sources and constants.
fn tissues() -> Vec<Item> {
    let item = |tissue: &Tissue| {
        let Tissue { organ, species, test, range, source, law, .. } = tissue;
        let doi = tissue.doi.as_ref().map_or(String::new(), |doi| format!(", doi {doi}"));
        let meaning = format!("{organ} ({species}): {test}; {range} [{source}{doi}]");
        let listed = |keys: BTreeMap<&str, String>| {
            let keys = keys.iter().map(|(key, value)| format!("{key} = {}", value.replace('"', "")));
            keys.collect::<Vec<_>>().join(", ")
        };
        let mut settings = vec![Item::new(law, "", &listed(tissue.constants()))];
        if !tissue.assumed().is_empty() {
            settings.push(Item::new("assumed", "", &listed(tissue.assumed())));
        }
        settings.extend(tissue.note.iter().map(|note| Item::new("note", "", note)));
        Item { settings, ..Item::new(&tissue.name, "", &meaning) }
    };
    tissue::all().iter().map(item).collect()
}

/// Shapes of the catalogue, and the surface of a file without the keys that every tool has.
fn tools() -> Vec<Item> {
    let mut tools = Item::of_entries(TOOL_SHAPES);
    let forms = forms("tool");
    let is_of_all =
        |key: &Item| forms.iter().all(|form| form.settings.iter().any(|one| one.name == key.name));
    let named: Vec<&str> = TOOL_SHAPES.iter().map(|entry| entry.name).collect();
    for form in forms.iter().filter(|form| !named.contains(&form.name.as_str())) {
        let settings = form.settings.iter().filter(|key| !is_of_all(key)).cloned().collect();
        tools.push(Item { settings, ..form.clone() });
    }
    tools
}

/// Prints all parts, or the part of this name, and returns the exit code.
pub fn list(what: Option<&str>) -> u8 {
    let names = PARTS.map(|part| part.name);
    if let Some(what) = what.filter(|what| !names.contains(what)) {
        eprintln!("tissuebench: no part of the list is called '{what}'; {}", suggest(what, &names));
        return 2;
    }
    let chosen = PARTS.iter().filter(|part| what.is_none_or(|what| what == part.name));
    let parts = chosen.map(|part| (part, (part.items)())).filter(|(_, items)| !items.is_empty());
    let texts: Vec<String> =
        parts.map(|(part, items)| format!("{} ({})\n{}", part.name, part.key, print(&items))).collect();
    let text = texts.join("\n");
    if text.is_empty() {
        println!("{}: none found in ./cases/scenes and ./cases/studies", what.unwrap_or("list"));
        return 0;
    }
    if text.contains("    [") {
        println!("Settings in [brackets] may be left out.\n");
    }
    println!("{}", text.trim_end());
    0
}

fn transfers() -> Vec<Item> {
    let own = forms("output.transfer.scheme").into_iter().filter(|item| item.name == "own");
    Item::of_entries(interp::SCHEMES).into_iter().chain(own).collect()
}

/// Returns the offered units by dimension, then all unit words.
fn dimensions() -> Vec<Item> {
    let named = |dimension: &&Dimension| !dimension.is_plain();
    let item = |dimension: &Dimension| {
        Item::new(dimension.name(), dimension.si_unit(), &dimension.offered().join(", "))
    };
    let mut items: Vec<Item> = Dimension::ALL.iter().filter(named).map(item).collect();
    let words = |prefixed: bool| {
        units()
            .filter(move |word| word.prefixed == prefixed)
            .map(|word| word.name)
            .collect::<Vec<_>>()
            .join(", ")
    };
    let prefixes = format!("{} with the prefixes G, M, k, h, c, m, u, n", words(true));
    items.push(Item::new(
        "words of units",
        "",
        &format!("{prefixes}; {}; joined as in N/mm^2", words(false)),
    ));
    items
}

fn metrics() -> Vec<Item> {
    let item = |metric: &&'static Metric| {
        let second = metric.addresses().next().filter(|of| of.index.is_some()).map(|of| of.at(1));
        let names: Vec<String> = metric.addresses().chain(second).map(|of| of.to_string()).collect();
        let names =
            if names.len() > 1 { format!("; recorded as {}", names.join(", ")) } else { String::new() };
        Item::new(metric.name, metric.unit(), &format!("{}{names}", metric.meaning))
    };
    METRICS.iter().map(item).collect()
}

fn warnings() -> Vec<Item> {
    WARNINGS.iter().map(|warning| Item::new(warning.code, warning.unit(), warning.meaning)).collect()
}

/// Returns the TOML files below the folders `scenes` and `studies`, sorted by name within each folder.
fn files(cases: &Path) -> Vec<Item> {
    let mut found = Vec::new();
    ["scenes", "studies"].iter().for_each(|folder| collect(&cases.join(folder), &mut found));
    found
}

fn collect(folder: &Path, found: &mut Vec<Item>) {
    let mut paths: Vec<_> =
        std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            found.push(Item::new(&path.display().to_string(), "", ""));
        }
    }
}
