//! Order of modules: each module uses only those to its right. Files and functions stay small.

mod circles;
mod paths;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use catalogue::element::ELEMENTS;
use catalogue::metric::METRICS;
use paths::{Named, code_of, paths};

/// A folder of modules in an order.
struct House<'a> {
    /// Folder of its files, below the repository.
    folder: &'a str,
    /// Path of its modules.
    root: &'a str,
    /// Modules from left to right. A module without a file of its own here belongs to the folder that is
    /// named.
    rooms: &'a [&'a str],
}

/// The harness. Few files lie outside its rooms: the names it exports, and printing.
const HARNESS: House<'_> = House {
    folder: "harness/src",
    root: "crate",
    rooms: &[
        "cli",
        "study",
        "run",
        "measure",
        "procedure",
        "prepare",
        "scenario",
        "discretise",
        "adapter",
        "outcome",
        "executor",
        "process",
        "error",
    ],
};

/// The reader of scene and study files: whole files, the parts of a scene, what they are written in.
const SCENE: House<'_> = House {
    folder: "cases/src/scene",
    root: "crate::scene",
    rooms: &[
        "study",
        "coverage",
        "axis",
        "load",
        "fitted",
        "trained",
        "sample",
        "altered",
        "shared",
        "tissue",
        "set",
        "available",
        "demands",
        "timing",
        "scene",
        "fit",
        "training",
        "measured",
        "vary",
        "output",
        "reference",
        "check",
        "method",
        "method::external",
        "method::fem",
        "method::element",
        "method::efg",
        "method::cloud",
        "method::functions",
        "method::integration",
        "method::pod",
        "method::essential",
        "method::common",
        "goal",
        "tool",
        "touch",
        "drive",
        "condition",
        "foundation",
        "material",
        "direction",
        "curve",
        "field",
        "body",
        "real_time",
        "procedure",
        "frames",
        "ramp",
        "selection",
        "mesh_file",
        "purpose",
        "vocabulary",
        "report",
        "document",
        "limits",
        "conform",
        "sources",
        "error",
        "table",
        "units",
        "region",
        "expression",
        "words",
    ],
};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_path_buf()
}

/// Rust files below a folder, with their texts.
fn files(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            found.extend(files(&entry));
        } else if entry.extension().is_some_and(|e| e == "rs") {
            let text = std::fs::read_to_string(&entry).unwrap();
            found.push((entry, text));
        }
    }
    found
}

impl House<'_> {
    /// The files with the paths of their modules.
    fn modules(&self) -> Vec<(String, String)> {
        let folder = repository().join(self.folder);
        let module = |path: &Path| {
            let below = path.strip_prefix(&folder).unwrap().with_extension("");
            let parts = below.components().map(|part| part.as_os_str().to_str().unwrap());
            let parts = parts.filter(|part| !["mod", "lib", "main"].contains(part));
            std::iter::once(self.root).chain(parts).collect::<Vec<_>>().join("::")
        };
        files(&folder).into_iter().map(|(path, text)| (module(&path), text)).collect()
    }

    /// Index of the smallest room that has a path.
    fn room(&self, path: &str) -> Option<usize> {
        let below = path.strip_prefix(self.root)?.strip_prefix("::")?;
        let has = |room: &str| below.strip_prefix(room).is_some_and(|r| r.is_empty() || r.starts_with("::"));
        let rooms = self.rooms.iter().enumerate().filter(|(_, room)| has(room));
        rooms.max_by_key(|(_, room)| room.len()).map(|(index, _)| index)
    }

    /// Rooms that a text of a module names.
    fn used(&self, module: &str, text: &str) -> BTreeSet<usize> {
        let named = paths(module, &code_of(text), &BTreeSet::new());
        named.iter().filter_map(|named| self.room(&named.path)).collect()
    }

    /// Checks that every arrow between two rooms goes from left to right; returns the number of arrows.
    fn check(&self) -> usize {
        let mut arrows = 0;
        let mut seen = BTreeSet::new();
        for (module, text) in self.modules() {
            let Some(here) = self.room(&module) else { continue };
            seen.insert(here);
            for there in self.used(&module, &text) {
                let (from, to) = (self.rooms[here], self.rooms[there]);
                assert!(there >= here, "{module}: {from} uses {to}, a room to its left");
                arrows += usize::from(there > here);
            }
        }
        assert_eq!(seen.len(), self.rooms.len(), "{}: a room is empty: {seen:?}", self.folder);
        arrows
    }
}

#[test]
fn arrows_go_one_way() {
    let arrows = HARNESS.check();
    assert!(arrows > 100, "{arrows}: the arrows were not read");
    let arrows = SCENE.check();
    assert!(arrows > 100, "{arrows}: the arrows were not read");
}

/// Names that `scene/mod.rs` exports would be a way around the order.
#[test]
fn every_file_of_scenes_is_in_a_room_and_names_rooms() {
    for (module, text) in SCENE.modules().iter().filter(|(module, _)| module != SCENE.root) {
        assert!(SCENE.room(module).is_some(), "{module} is in no room");
        let named = paths(module, &code_of(text), &BTreeSet::new());
        for Named { path, .. } in named.iter().filter(|named| named.path.starts_with(SCENE.root)) {
            assert!(SCENE.room(path).is_some(), "{module} names {path}, which is in no room");
        }
    }
}

#[test]
fn an_arrow_back_would_be_seen() {
    let used = |text: &str| HARNESS.used("crate::run::group", text);
    assert_eq!(used("use crate::study::StudyPlan;"), BTreeSet::from([1]));
    assert_eq!(
        used("use crate::{Failure, cli::args, outcome::{Meters as M, Plan}};"),
        BTreeSet::from([0, 9])
    );
    assert_eq!(used("let x = crate::study::check(super::super::measure::y);"), BTreeSet::from([1, 3]));
    assert_eq!(
        used("// crate::study\nuse super::{self, plan};\nuse super::super::cli;"),
        BTreeSet::from([0, 2])
    );
    let used = |text: &str| SCENE.used("crate::scene::method::fem", text);
    assert_eq!(used("use super::{Method, common::{Size, Mass}};"), [22, 32].into());
    assert_eq!(
        used("use crate::exact::Exact; use crate::scene::{tool::Tool, words::words};"),
        [34, 62].into()
    );
}

/// Number of lines of the longest function in a text formatted by rustfmt: from `fn` to the closing brace at
/// the same indentation.
fn longest_function(text: &str) -> usize {
    let lines: Vec<&str> = text.lines().collect();
    let mut longest = 0;
    for (start, line) in lines.iter().enumerate() {
        let code = line.trim_start();
        let names_one =
            ["fn ", "pub fn ", "pub(crate) fn ", "pub(super) fn "].iter().any(|head| code.starts_with(head));
        // A function of a trait may have no body.
        if !names_one || line.ends_with(';') {
            continue;
        }
        let close = format!("{}}}", &line[..line.len() - code.len()]);
        if let Some(length) = lines[start..].iter().position(|l| *l == close) {
            longest = longest.max(length + 1);
        }
    }
    longest
}

#[test]
fn files_and_functions_stay_small() {
    let root = repository();
    let mut count = 0;
    for folder in [
        "harness",
        "reports",
        "records",
        "cases",
        "solvers",
        "fuzz/src",
        "python/src",
        "xtask",
        "tests",
        "docs",
    ] {
        for (path, text) in files(&root.join(folder)) {
            let lines = text.lines().count();
            let longest = longest_function(&text);
            assert!(lines <= 500, "{}: {lines} lines", path.display());
            assert!(longest <= 80, "{}: a function of {longest} lines", path.display());
            count += 1;
        }
    }
    assert!(count > 300, "{count} files");
}

#[test]
fn no_meaning_is_read_out_of_names() {
    let root = repository();
    let mut scenes = Vec::new();
    let mut folders = vec![root.join("cases/scenes")];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            match path.extension() {
                Some(extension) if extension == "toml" => {
                    scenes.push(path.file_stem().unwrap().to_str().unwrap().to_string());
                }
                _ if path.is_dir() => folders.push(path),
                _ => {}
            }
        }
    }
    assert!(scenes.len() > 20, "{scenes:?}");
    // These words are also terms of the field.
    let words = ["relaxation", "first", "compression", "cantilever", "polynomial"];
    for folder in ["reports/src", "harness/src"] {
        for (path, text) in files(&root.join(folder)) {
            let code = text.split("#[cfg(test)]").next().unwrap();
            for name in ["fem", "efg", "interp"] {
                for compared in
                    [format!("== \"{name}\""), format!("starts_with(\"{name}"), format!("contains(\"{name}")]
                {
                    assert!(!code.contains(&compared), "{}: {compared}", path.display());
                }
            }
            for scene in scenes.iter().filter(|scene| !words.contains(&scene.as_str())) {
                assert!(!code.contains(&format!("\"{scene}\"")), "{}: names {scene}", path.display());
            }
        }
    }
}

/// Literals of the reports and the harness that are a heading, a statistic, a key or a word of a sentence,
/// and have the name of a metric.
const WORDS: [(&str, &[&str]); 37] = [
    ("harness/src/cli/ci/listing.rs", &["memory"]),
    ("harness/src/cli/init/args.rs", &["load"]),
    ("harness/src/cli/init/mod.rs", &["closure", "load"]),
    ("harness/src/cli/init/scene_text.rs", &["pressure"]),
    ("harness/src/cli/list/mod.rs", &["warnings"]),
    ("harness/src/cli/mesh/info.rs", &["volume"]),
    ("harness/src/cli/mesh/make.rs", &["volume"]),
    ("harness/src/cli/paced.rs", &["max"]),
    ("harness/src/cli/pick/default_methods.rs", &["hex20", "tet10", "tet4"]),
    ("harness/src/cli/pick/quantity.rs", &["energy", "frequency", "pressure", "stress"]),
    ("harness/src/cli/text.rs", &["mode", "stretch"]),
    ("harness/src/executor/local.rs", &["memory"]),
    ("harness/src/executor/site.rs", &["time"]),
    ("harness/src/executor/slurm.rs", &["time"]),
    ("harness/src/outcome/latency.rs", &["max"]),
    ("harness/src/outcome/plan.rs", &["mass"]),
    ("harness/src/outcome/states.rs", &["pressure", "stress"]),
    ("harness/src/prepare/loads.rs", &["pressure"]),
    ("harness/src/procedure/external/problem.rs", &["closure"]),
    ("harness/src/procedure/implicit_dynamic.rs", &["time"]),
    ("harness/src/procedure/modes.rs", &["mass"]),
    ("harness/src/procedure/statics.rs", &["load"]),
    ("reports/src/commits/trend.rs", &["time"]),
    ("reports/src/compare/across.rs", &["mass"]),
    ("reports/src/credibility/calculation.rs", &["outside", "warnings"]),
    ("reports/src/credibility/code.rs", &["mass"]),
    ("reports/src/credibility/validation.rs", &["mean"]),
    ("reports/src/figures/history.rs", &["closure", "energy", "mode", "time"]),
    ("reports/src/figures/locking.rs", &["pressure"]),
    ("reports/src/figures/real_time.rs", &["max"]),
    ("reports/src/fronts.rs", &["max", "pressure"]),
    ("reports/src/tables/face_results.rs", &["mode"]),
    ("reports/src/tables/modes.rs", &["mass", "massless"]),
    ("reports/src/tables/outcome.rs", &["warnings"]),
    ("reports/src/tables/real_time.rs", &["max"]),
    ("reports/src/tables/uncertainty.rs", &["mean"]),
    ("reports/src/uncertain.rs", &["mean"]),
];

#[test]
fn reports_and_the_harness_name_no_quantity_and_no_element_in_text() {
    let root = repository();
    let names: Vec<String> =
        METRICS.iter().flat_map(|metric| metric.addresses()).map(|of| of.to_string()).collect();
    let bare = METRICS.iter().map(|metric| metric.name).chain(ELEMENTS.iter().map(|element| element.name));
    let names: BTreeSet<&str> = names.iter().map(String::as_str).chain(bare).collect();
    let mut found = BTreeSet::new();
    let all = ["reports/src", "harness/src"].map(|folder| files(&root.join(folder)));
    for (path, text) in all.into_iter().flatten().filter(|(path, _)| !path.ends_with("tests.rs")) {
        let file = path.strip_prefix(&root).unwrap().to_str().unwrap().to_string();
        let code = text.split("#[cfg(test)]").next().unwrap();
        for line in code.lines().filter(|line| !line.trim_start().starts_with("//")) {
            let literals = line.split('"').skip(1).step_by(2).filter(|literal| names.contains(literal));
            found.extend(literals.map(|literal| (file.clone(), literal.to_string())));
        }
    }
    let each = |(file, words): (&str, &'static [&str])| {
        words.iter().map(|word| (file.to_string(), word.to_string())).collect::<Vec<_>>()
    };
    let words = WORDS.into_iter().flat_map(each).collect();
    assert_eq!(found, words, "take the entry of the catalogue, such as `metric::L2`");
}

/// Files are opened in one place only, which refuses large or special files and outputs that would replace an
/// input. Text is printed in one place only, which handles control characters of terminals.
#[test]
fn files_are_opened_and_text_is_printed_in_one_place_each() {
    let root = repository();
    let opens = [
        "fs::read(",
        "fs::read_to_string(",
        "fs::write(",
        "fs::copy(",
        "fs::rename(",
        "fs::remove_file(",
        "File::open(",
        "File::create(",
        "OpenOptions::",
        "from_path(",
        "fs::hard_link(",
    ];
    let prints = ["io::stdout()", "io::stderr()", "std::println!", "std::eprintln!"];
    let mut count = 0;
    for folder in ["harness/src", "reports/src", "cases/src", "python/src", "solvers"] {
        for (path, text) in files(&root.join(folder)) {
            let name = path.strip_prefix(&root).unwrap().to_string_lossy().into_owned();
            if ["/tests", "/benches", "solvers/disk"].iter().any(|part| name.contains(part)) {
                continue;
            }
            let code = text.split("#[cfg(test)]").next().unwrap();
            let lines = code.lines().map(str::trim).filter(|line| !line.starts_with("//"));
            for line in lines {
                let system = ["\"/proc/", "\"/sys/"].iter().any(|folder| line.contains(folder));
                let opened = opens.iter().find(|call| line.contains(**call) && !system);
                assert_eq!(opened, None, "{name}: {line}");
                let asked = ["is_terminal", "choice", "flush"].iter().any(|word| line.contains(word));
                let printed = prints.iter().find(|call| line.contains(**call) && !asked);
                assert!(printed.is_none() || name == "harness/src/print.rs", "{name}: {line}");
            }
            count += 1;
        }
    }
    assert!(count > 300, "{count} files");
}
