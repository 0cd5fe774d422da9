//! Coverage of the catalogue: every word that a scene can name occurs in a run of the verification whose
//! results are checked.

mod common;

use std::collections::BTreeSet;
use std::path::Path;

use cases::scene::{Check, Run, Scene, load_study};
use common::tissuebench;
use toml::{Table, Value};

/// Parts of the list from which a scene does not choose, those of third-party solvers, and tissues, whose
/// laws are parts of their own and whose constants have tests beside them.
const NO_PARTS: [&str; 7] = ["units", "metrics", "warnings", "files", "purposes", "publications", "tissues"];
/// Words that are the default of their key.
const DEFAULTS: [(&str, &str); 4] = [
    ("method.neighbourhood", "ball"),
    ("method.dilation", "standard"),
    ("method.cloud", "mesh"),
    ("procedure.kind", "linear"),
];
/// Words that the verification cannot use, with the reason.
const EXCUSED: [(&str, &str); 1] =
    [("external", "needs a solver outside the program: cases/studies/solvers.toml runs them")];

/// Parts of the list: the key of each part and its words.
fn parts() -> Vec<(String, Vec<String>)> {
    let listed = tissuebench(&["list"]).stdout;
    let mut parts: Vec<(String, String, Vec<String>)> = Vec::new();
    for line in listed.lines() {
        let head = line.split_once(" (").filter(|_| !line.starts_with(' '));
        if let Some((name, key)) = head {
            parts.push((name.into(), key.split([',', ';', ')']).next().unwrap().into(), vec![]));
        }
        let word = line.strip_prefix("  ").filter(|rest| rest.starts_with(|c: char| c.is_alphanumeric()));
        if let (Some(word), Some(part)) = (word, parts.last_mut()) {
            part.2.push(word.split_whitespace().next().unwrap().into());
        }
    }
    parts.retain(|(name, ..)| !NO_PARTS.contains(&name.as_str()));
    // A table has no word.
    parts.into_iter().map(|(_, key, words)| (key, words.into_iter().filter(|w| w != "a").collect())).collect()
}

/// Words at a key of a table (`above.below`): plain words, or the first key of each table.
fn words(at: &Table, key: &str) -> Vec<String> {
    let (first, rest) = key.split_once('.').map_or((key, None), |(first, rest)| (first, Some(rest)));
    let found = match at.get(first) {
        Some(Value::Array(list)) => list.iter().collect(),
        Some(one) => vec![one],
        None => vec![],
    };
    let word = |value: &Value| match (value, rest) {
        (Value::Table(table), Some(rest)) => words(table, rest),
        (Value::Table(table), None) => ["name", "method"].iter().flat_map(|key| words(table, key)).collect(),
        (Value::String(word), None) => vec![word.clone()],
        _ => vec![],
    };
    found.into_iter().flat_map(word).collect()
}

/// Words at a part's key that a run uses and checks.
fn used(run: &Run, scene: &Scene, document: &Table, key: &str) -> Vec<String> {
    let checks: Vec<&Check> = scene.checks.iter().chain(&run.checks).collect();
    let is_checked =
        |id: &str| checks.iter().any(|c| c.methods.is_empty() || c.methods.iter().any(|m| m == id));
    let methods: Vec<&str> = run.chosen(scene).map(|m| m.id.as_str()).filter(|id| is_checked(id)).collect();
    let default = DEFAULTS.iter().find(|(of, _)| *of == key).map(|(_, word)| word.to_string());
    if let Some(key) = key.strip_prefix("method.") {
        let tables = document["method"].as_array().unwrap().iter().filter_map(Value::as_table);
        let tables = tables.filter(|m| m["id"].as_str().is_some_and(|id| methods.contains(&id)));
        let own = tables.flat_map(|m| {
            if m.contains_key(key.split('.').next().unwrap()) {
                words(m, key)
            } else {
                default.clone().into_iter().collect()
            }
        });
        let kernels = run.kernels.iter().filter(|_| key == "kernel" && !methods.is_empty());
        return own.chain(kernels.map(|kernel| kernel.name().to_string())).collect();
    }
    let checked = match key {
        "output.transfer.scheme" => {
            checks.iter().any(|check| check.address.metric.name.starts_with("transfer-"))
        }
        _ => !methods.is_empty(),
    };
    let mut found = words(document, key);
    found.extend(words(document, &format!("region.{key}")));
    found.extend(default.filter(|_| found.is_empty()));
    if checked { found } else { vec![] }
}

#[test]
fn every_entry_is_in_a_checked_run_of_the_verification() {
    let study = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/studies/verify.toml");
    let study = load_study(&study).unwrap_or_else(|bad| panic!("{bad:?}"));
    let parts = parts();
    assert!(parts.len() >= 16 && parts.iter().all(|(_, words)| !words.is_empty()), "{parts:?}");
    let mut known: BTreeSet<(&str, String)> = BTreeSet::new();
    for run in &study.runs {
        let scene = &study.scenes[&run.scene];
        let document: Table = scene.text().parse().unwrap();
        for (key, _) in &parts {
            known.extend(used(run, scene, &document, key).into_iter().map(|word| (key.as_str(), word)));
        }
    }
    let excused = |word: &String| EXCUSED.iter().any(|(other, _)| other == word);
    let missing: Vec<String> = (parts.iter())
        .flat_map(|(key, words)| words.iter().map(move |word| (key.as_str(), word)))
        .filter(|(key, word)| !known.contains(&(*key, (*word).clone())) && !excused(word))
        .map(|(key, word)| format!("{key} = \"{word}\""))
        .collect();
    assert!(missing.is_empty(), "no checked run of cases/studies/verify.toml uses:\n{}", missing.join("\n"));
}
