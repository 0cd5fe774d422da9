//! The scenes and studies that come with the project.

use std::path::{Path, PathBuf};

use tissuebench_cases::scene::{load, load_study};

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The TOML files in a folder and below it.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            found.push(path);
        }
    }
}

#[test]
fn every_file_of_the_project_is_sound() {
    let mut paths = Vec::new();
    files(&folder().join("scenes"), &mut paths);
    files(&folder().join("studies"), &mut paths);
    for path in &paths {
        let text = std::fs::read_to_string(path).expect("a file");
        let errors = if text.contains("[[run]]") {
            load_study(path).err()
        } else {
            load(path).map(|scene| assert!(scene.unavailable().is_empty(), "{}", path.display())).err()
        };
        let said: Vec<String> = errors.into_iter().flatten().map(|e| e.to_string()).collect();
        assert!(said.is_empty(), "{}", said.join("\n"));
    }
    assert!(paths.len() > 25, "{}", paths.len());
}

/// Method tables written out in a file, without their sizes, which belong to each scene.
fn written_out(path: &Path) -> Vec<toml::Table> {
    let mut file: toml::Table = std::fs::read_to_string(path).expect("a file").parse().expect("TOML");
    let Some(toml::Value::Array(methods)) = file.remove("method") else { return vec![] };
    let tables = methods.into_iter().filter_map(|method| match method {
        toml::Value::Table(mut table) if !table.contains_key("use") => {
            table.remove("size");
            Some(table)
        }
        _ => None,
    });
    tables.collect()
}

#[test]
fn no_two_scenes_write_out_the_same_method() {
    let mut paths = vec![folder().join("methods.toml")];
    files(&folder().join("scenes"), &mut paths);
    // The first scene for new users is a single file, and an imported one is what `tissuebench import` writes.
    paths.retain(|path| !path.ends_with("first.toml") && !path.ends_with("import/pulled-in-steps.toml"));
    let mut known: Vec<(&Path, toml::Table)> = Vec::new();
    for path in &paths {
        for table in written_out(path) {
            if let Some((other, _)) = known.iter().find(|(_, known)| *known == table) {
                panic!("{} and {} both write out\n{table}", other.display(), path.display());
            }
            known.push((path, table));
        }
    }
    assert!(known.len() > 30, "{}", known.len());
}

#[test]
fn kinds_of_procedures_have_the_names_of_their_keys() {
    use tissuebench_cases::scene::ProcedureKind::{
        self, Explicit, ImplicitCg, ImplicitDynamic, Linear, Modes, Prepare, Static, Vbd, Xpbd,
    };
    let schema = tissuebench_cases::scene::schema();
    let forms = &schema["properties"]["procedure"]["anyOf"][0]["oneOf"];
    let words: Vec<&str> = forms
        .as_array()
        .unwrap_or_else(|| panic!("{}", schema["properties"]["procedure"]))
        .iter()
        .map(|form| form["properties"]["kind"]["const"].as_str().unwrap())
        .collect();
    let kinds = [Prepare, Linear, Modes, Static, Explicit, ImplicitDynamic, Vbd, Xpbd, ImplicitCg];
    assert_eq!(words, kinds.map(ProcedureKind::name));
}
