//! No circle of files in any crate, and no name taken through the root of its own crate.

use std::collections::{BTreeMap, BTreeSet};

use crate::paths::{Named, code_of, paths};
use crate::{House, repository};

/// The files of a crate: the paths that each uses, and the names that each exports from other files.
struct Files {
    used: BTreeMap<String, Vec<Named>>,
    exports: BTreeMap<String, Vec<Named>>,
}

impl Files {
    fn new(modules: Vec<(String, String)>) -> Files {
        // `lib.rs` and `main.rs` are the same module.
        let mut codes: BTreeMap<String, String> = BTreeMap::new();
        for (module, text) in modules {
            *codes.entry(module).or_default() += &format!("\n{}", code_of(&text));
        }
        let (mut used, mut exports) = (BTreeMap::new(), BTreeMap::new());
        for (module, code) in &codes {
            let below = codes.keys().filter_map(|other| other.strip_prefix(module)?.strip_prefix("::"));
            let children: BTreeSet<&str> = below.filter(|below| !below.contains("::")).collect();
            let mut own = String::new();
            let mut exported = Vec::new();
            for statement in code.split_inclusive(';') {
                let starts = ["\npub use ", "\npub(crate) use ", "\npub(super) use "];
                let exporting = starts.iter().find_map(|start| statement.rfind(start));
                let (before, export) = statement.split_at(exporting.unwrap_or(statement.len()));
                own += before;
                exported.extend(paths(module, export, &children));
            }
            let is_code = |line: &&str| !(line.contains("mod ") && line.ends_with(';'));
            let words = own.lines().filter(is_code);
            let words = words.flat_map(|line| line.split(|c: char| !(c.is_alphanumeric() || c == '_')));
            let words: BTreeSet<&str> = words.collect();
            let mut named = paths(module, &own, &children);
            // A file may itself use what it exports, one name or any of a whole file.
            let used_too = |named: &&Named| named.name.is_empty() || words.contains(named.name.as_str());
            let twice = exported.iter().filter(used_too);
            named.extend(twice.map(|named| Named { path: named.path.clone(), name: named.name.clone() }));
            used.insert(module.clone(), named);
            exports.insert(module.clone(), exported);
        }
        Files { used, exports }
    }

    /// The file that a path leads to, and the rest of the path.
    fn split<'p>(&self, path: &'p str) -> Option<(&'p str, &'p str)> {
        let ends = path.match_indices("::").map(|(at, _)| at).chain([path.len()]);
        let end = ends.filter(|&end| self.used.contains_key(&path[..end])).last()?;
        Some((&path[..end], path[end..].trim_start_matches("::")))
    }

    /// The file that defines what a path names, through all files that export it.
    fn defines(&self, path: &str) -> Option<String> {
        let (file, rest) = self.split(path)?;
        let (name, below) = rest.split_once("::").unwrap_or((rest, ""));
        let export = self.exports[file].iter().find(|export| export.name == name);
        match export.filter(|export| export.path != path) {
            Some(export) if below.is_empty() => self.defines(&export.path),
            Some(export) => self.defines(&format!("{}::{below}", export.path)),
            None => Some(file.to_string()),
        }
    }

    /// Arrows between files on circles: files that use none of the rest, or that none of the rest uses, are
    /// taken away, again and again.
    fn circles(&self) -> Vec<String> {
        let mut left: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
        for (file, named) in &self.used {
            let used = named.iter().filter_map(|named| self.defines(&named.path));
            left.insert(file, used.filter(|used| used != file).collect());
        }
        loop {
            let count = left.len();
            let used: BTreeSet<String> = left.values().flatten().cloned().collect();
            let files: BTreeSet<String> = left.keys().map(ToString::to_string).collect();
            left.retain(|file, others| used.contains(*file) && !others.is_disjoint(&files));
            if left.len() == count {
                break;
            }
        }
        let arrows = |(file, others): (&&str, &BTreeSet<String>)| -> Vec<String> {
            let on = others.iter().filter(|other| left.contains_key(other.as_str()));
            on.map(|other| format!("{file} -> {other}")).collect()
        };
        left.iter().flat_map(arrows).collect()
    }

    /// Names that files take from the root of their crate, which exports but does not define them.
    fn through_the_root(&self) -> Vec<String> {
        let exported = |named: &&Named| match self.split(&named.path) {
            Some(("crate", rest)) => {
                let name = rest.split("::").next().unwrap_or_default();
                self.exports["crate"].iter().any(|export| export.name == name)
            }
            _ => false,
        };
        let of = |(file, named): (&String, &Vec<Named>)| -> Vec<String> {
            let own = named.iter().filter(exported);
            own.map(|named| format!("{file} names {}", named.path)).collect()
        };
        self.used.iter().filter(|(file, _)| *file != "crate").flat_map(of).collect()
    }
}

/// Folders of all crates, of those outside the workspace too.
fn crates() -> Vec<String> {
    let text = std::fs::read_to_string(repository().join("Cargo.toml")).unwrap();
    let manifest: toml::Table = text.parse().unwrap();
    let list = |key: &str| manifest["workspace"][key].as_array().unwrap().clone();
    let folders = list("members").into_iter().chain(list("exclude"));
    folders.map(|folder| folder.as_str().unwrap().to_string()).collect()
}

/// A name of a file is taken from the file that defines it. The root of a crate exports names for other
/// crates alone.
#[test]
fn files_use_each_other_in_no_circle_and_name_each_other() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for folder in crates().iter().map(|folder| format!("{folder}/src")) {
        if repository().join(&folder).is_dir() {
            let files = Files::new(House { folder: &folder, root: "crate", rooms: &[] }.modules());
            count += files.used.len();
            let found = files.circles().into_iter().chain(files.through_the_root());
            wrong.extend(found.map(|found| format!("{folder}: {found}")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(count > 600, "{count} files were read");
}

#[test]
fn a_circle_would_be_seen() {
    let files = |texts: &[(&str, &str)]| {
        let module = |name: &str| if name.is_empty() { "crate".into() } else { format!("crate::{name}") };
        Files::new(texts.iter().map(|(name, text)| (module(name), text.to_string())).collect())
    };
    let (ab, ba) = ("crate::a -> crate::b", "crate::b -> crate::a");
    let a = ("a", "use crate::b::X;");
    assert_eq!(files(&[a, ("b", "use super::{c, a::Y};"), ("c", "")]).circles(), [ab, ba]);
    assert!(
        files(&[a, ("b", "use super::c;\n#[cfg(test)]\nuse super::a::Y;"), ("c", "")]).circles().is_empty()
    );
    // A file and the files of its folder.
    let folder = ("a", "mod b;\nfn f() { b::g() }\nfn h() { x.b::<3>() }");
    let circle = files(&[folder, ("a::b", "use super::h;")]).circles();
    assert_eq!(circle, ["crate::a -> crate::a::b", "crate::a::b -> crate::a"]);
    // An exported name leads to the file that defines it.
    let root = ("", "mod a;\npub use a::{A as One, b::B};");
    let through =
        files(&[root, ("a", "pub(crate) use b::B;"), ("a::b", ""), ("c", "use crate::{One, a::B};")]);
    assert_eq!(through.defines("crate::B").as_deref(), Some("crate::a::b"));
    assert_eq!(through.through_the_root(), ["crate::c names crate::One"]);
    assert!(through.circles().is_empty());
}
