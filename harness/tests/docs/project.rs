//! Facts that several files of the project state: versions, compilers, commands of continuous integration.

use std::path::PathBuf;

use crate::markdown::Page;
use crate::{command, root};

fn text(file: &str) -> String {
    std::fs::read_to_string(root().join(file)).unwrap_or_else(|bad| panic!("{file}: {bad}"))
}

/// A value of `[workspace.package]`.
fn of_the_workspace(key: &str) -> String {
    let manifest: toml::Table = text("Cargo.toml").parse().expect("a manifest");
    manifest["workspace"]["package"][key].as_str().expect("a text").into()
}

#[test]
fn one_version_is_in_all_files() {
    let version = of_the_workspace("version");
    for (file, start) in [
        ("CITATION.cff", format!("version: {version}")),
        ("CHANGELOG.md", format!("## {version}")),
        ("python/Cargo.toml", format!("version = \"{version}\"")),
    ] {
        let stated = text(file).lines().any(|line| line.starts_with(&start));
        assert!(stated, "{file}: no line begins with '{start}'");
    }
}

#[test]
fn the_oldest_compiler_of_the_workflow_is_that_of_the_manifest() {
    let ci = text(".github/workflows/ci.yml");
    let version = of_the_workspace("rust-version");
    for line in
        [format!("RUSTUP_TOOLCHAIN: \"{version}\"\n"), format!("toolchain install {version} --profile")]
    {
        assert!(ci.contains(&line), "ci.yml does not contain '{line}'");
    }
}

#[test]
fn the_workflow_runs_the_commands_of_the_readme() {
    let ci = text(".github/workflows/ci.yml").replace("${{ matrix.tests }}", "--workspace");
    let readme = Page::read(root().join("README.md"));
    let block =
        readme.blocks.iter().find(|block| block.text.contains("cargo xtask verify")).expect("two commands");
    for line in block.text.lines() {
        assert!(ci.contains(&format!("- run: {line}")), "ci.yml does not run '{line}'");
    }
}

#[test]
fn the_rules_for_contributors_have_the_limits_of_the_tests() {
    let rooms = text("harness/tests/rooms/main.rs");
    let limit = |name: &str| {
        let after = rooms.split_once(&format!("assert!({name} <= ")).expect("a limit in rooms").1;
        after.split(',').next().expect("a number").to_string()
    };
    let rule = format!("at most {} lines, a function at most {}.", limit("lines"), limit("longest"));
    assert!(text("CONTRIBUTING.md").contains(&rule), "CONTRIBUTING.md: no '{rule}'");
}

/// A fork has no secrets and no settings; its first push must succeed all the same.
#[test]
fn workflows_run_in_a_fork_as_they_are() {
    let folder = std::fs::read_dir(root().join(".github/workflows")).expect("workflows");
    let files: Vec<PathBuf> = folder.map(|entry| entry.expect("readable").path()).collect();
    assert!(files.len() >= 3, "{files:?}");
    for file in files {
        let name = file.display();
        let flow = std::fs::read_to_string(&file).expect("readable");
        assert!(flow.contains("\npermissions:\n  contents: read\n"), "{name}: no minimal permissions");
        assert!(!flow.contains("secrets."), "{name} needs a secret");
        for used in flow.lines().filter_map(|line| line.split_once("uses: ")).map(|(_, used)| used) {
            let major = used.split_once("@v").map(|(_, version)| version);
            assert!(major.is_some_and(|v| v.parse::<u32>().is_ok()), "{name}: {used} has no major version");
        }
        for task in flow.split("cargo xtask ").skip(1).filter_map(|after| after.split_whitespace().next()) {
            command::known_task(task).unwrap_or_else(|bad| panic!("{name}: cargo xtask {task}: {bad}"));
        }
    }
}
