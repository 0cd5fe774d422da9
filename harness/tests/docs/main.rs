//! Tests of the documentation: commands run, links are valid, and reference pages are up to date.
//!
//! Pages are the Markdown files of the root, except the changelog, and those below docs/src. Every command in
//! a fenced `sh` or `console` block runs in a separate folder with a copy of `cases/` and the scenes of the
//! page: a `toml` block that opens with the comment `# NAME.toml` is the file of that name. Lines of a
//! `console` block that follow a command are its output; numbers in them are not compared. A comment before a
//! block changes the test of the block:
//!
//! ```text
//! <!-- not run: takes 4 minutes -->   the arguments are parsed, nothing is solved
//! <!-- exits 2 -->                    the exit code of the block's last command
//! ```

mod command;
mod markdown;
mod project;
mod reference;

use std::path::{Path, PathBuf};

use markdown::Page;
use rayon::prelude::*;

/// Root of the workspace.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("harness lies in the workspace")
}

/// Pages of the root.
const PAGES: [&str; 5] =
    ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "SECURITY.md", "CODE_OF_CONDUCT.md"];

/// The pages of the root and all pages of the book.
fn pages() -> Vec<Page> {
    let mut files = PAGES.map(|name| root().join(name)).to_vec();
    let mut folders = vec![root().join("docs/src")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("docs/src is there") {
            let path = entry.expect("readable").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "md") {
                files.push(path);
            }
        }
    }
    files.sort();
    files.into_iter().map(Page::read).collect()
}

#[test]
fn commands_do_what_the_pages_say() {
    let wrong: Vec<String> = pages()
        .par_iter()
        .with_max_len(1)
        .filter(|page| page.has_commands())
        .flat_map_iter(command::failures)
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// The README's changes for large strain.
#[test]
fn the_first_scene_of_the_readme_runs_at_large_strain() {
    let readme = Page::read(root().join("README.md"));
    let block = readme.blocks.iter().find(|b| b.file() == Some("block.toml")).expect("block.toml");
    let large = [
        ("law = \"linear\"", "law = \"neo-hookean\""),
        ("\nreference = ", "\nprocedure = { kind = \"static\", steps = 2 }\nreference = "),
    ];
    let scene = large.iter().fold(block.text.clone(), |text, (from, to)| {
        assert!(
            text.contains(from) && readme.text.contains(to.trim_end_matches("\nreference = ").trim()),
            "{to}"
        );
        text.replace(from, to)
    });
    let dir = tempfile::tempdir().expect("a folder");
    std::fs::write(dir.path().join("block.toml"), scene).expect("written");
    let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_tissuebench"));
    let output = program.args(["run", "block.toml"]).current_dir(dir.path()).output().expect("runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn scenes_in_the_pages_are_toml() {
    for page in pages() {
        for block in page.blocks.iter().filter(|block| block.language == "toml") {
            if let Err(bad) = block.text.parse::<toml::Table>() {
                panic!("{}:{}: {bad}", page.name(), block.line);
            }
        }
    }
}

#[test]
fn links_and_includes_lead_to_files() {
    let missing: Vec<String> = pages()
        .iter()
        .flat_map(|page| {
            let folder: PathBuf = page.path.parent().expect("a file").to_path_buf();
            let lost = page.targets().into_iter().filter(move |target| !folder.join(target).exists());
            lost.map(|target| format!("{}: {target}", page.name())).collect::<Vec<_>>()
        })
        .collect();
    assert!(missing.is_empty(), "no such files:\n{}", missing.join("\n"));
}

#[test]
fn every_page_is_in_the_summary() {
    let summary = Page::read(root().join("docs/src/SUMMARY.md"));
    let listed = summary.targets();
    for page in pages() {
        let Ok(path) = page.path.strip_prefix(root().join("docs/src")) else { continue };
        let path = path.to_str().expect("utf-8");
        assert!(path == "SUMMARY.md" || listed.iter().any(|l| l == path), "{path} is not in SUMMARY.md");
    }
}

#[test]
fn reference_pages_are_what_the_program_says() {
    reference::compare_or_write();
}
