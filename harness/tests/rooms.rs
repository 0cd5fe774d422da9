//! Order of the harness's modules: each module uses only those to its right. Files and functions stay small.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Modules from left to right.
const ROOMS: [&str; 12] = [
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
    "process",
    "error",
];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
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

/// Index of a file's module: the first part of its path below `src`.
fn room(path: &Path) -> Option<usize> {
    let below = path.strip_prefix(source()).unwrap().with_extension("");
    let first = below.components().next()?.as_os_str().to_str()?.to_string();
    ROOMS.iter().position(|room| *room == first)
}

/// Modules that a text names after `crate::`, in a path or in a list.
fn used(text: &str) -> BTreeSet<usize> {
    let known = |name: &str| ROOMS.iter().position(|room| *room == name);
    let word = |text: &str| {
        text.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or("").to_string()
    };
    let mut found = BTreeSet::new();
    for after in text.split("crate::").skip(1) {
        match after.strip_prefix('{') {
            Some(list) => {
                let end = list.find(';').unwrap_or(list.len());
                found.extend(list[..end].split([',', '{', '}']).filter_map(|item| known(&word(item.trim()))));
            }
            None => found.extend(known(&word(after))),
        }
    }
    found
}

#[test]
fn arrows_go_one_way() {
    let mut arrows = 0;
    for (path, text) in files(&source()) {
        let Some(here) = room(&path) else { continue };
        for there in used(&text) {
            let (path, from, to) = (path.display(), ROOMS[here], ROOMS[there]);
            assert!(there >= here, "{path}: {from} uses {to}, a room to its left");
            arrows += usize::from(there > here);
        }
    }
    assert!(arrows > 100, "{arrows}: the arrows were not read");
    let rooms: BTreeSet<usize> = files(&source()).iter().filter_map(|(path, _)| room(path)).collect();
    assert_eq!(rooms.len(), ROOMS.len(), "a room is empty: {rooms:?}");
}

#[test]
fn an_arrow_back_would_be_seen() {
    assert_eq!(used("use crate::run::Group;"), BTreeSet::from([2]));
    assert_eq!(used("use crate::{Failure, cli::args, outcome::{Meters, Plan}};"), BTreeSet::from([0, 9]));
    assert_eq!(used("let x = crate::study::check(1);"), BTreeSet::from([1]));
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
        if !names_one {
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
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_path_buf();
    let mut count = 0;
    for folder in ["harness", "reports", "cases", "solvers", "xtask", "tests", "docs"] {
        for (path, text) in files(&root.join(folder)) {
            let (lines, longest) = (text.lines().count(), longest_function(&text));
            assert!(lines <= 500, "{}: {lines} lines", path.display());
            assert!(longest <= 100, "{}: a function of {longest} lines", path.display());
            count += 1;
        }
    }
    assert!(count > 300, "{count} files");
}

#[test]
fn no_meaning_is_read_out_of_names() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_path_buf();
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
    let words = ["relaxation", "first", "compression", "cantilever"];
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

/// Files are opened in one place only, which refuses large or special files and outputs that would replace an
/// input. Text is printed in one place only, which handles control characters of terminals.
#[test]
fn files_are_opened_and_text_is_printed_in_one_place_each() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_path_buf();
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
