//! Everything of a release that can be done without publishing: versions, packages, wheel, README, container.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};

use crate::cargo::{cargo, code_of};
use crate::python::python;
use crate::skips::skipped;

/// Files that name the version, with the text before it.
const VERSIONS: [(&str, &str); 6] = [
    ("Cargo.toml", "version = \""),
    ("python/Cargo.toml", "version = \""),
    ("CITATION.cff", "version: "),
    ("packaging/homebrew/tissuebench.rb", "version \""),
    ("packaging/conda/recipe.yaml", "version: \""),
    ("packaging/Dockerfile", "ARG VERSION="),
];

/// Runs every step regardless of the others and returns the worst exit code.
pub(crate) fn check(root: &Path) -> Result<u8> {
    let steps: [(&str, &dyn Fn() -> Result<u8>); 6] = [
        ("versions", &|| versions(root)),
        // Each package is unpacked and built from its own files.
        ("packages", &|| cargo(&["package", "--workspace", "--allow-dirty", "--locked", "--quiet"], &[])),
        ("wheel", &|| python(root)),
        ("readme", &readme),
        ("container", &|| container(root)),
        ("workflows", &|| workflows(root)),
    ];
    let mut worst = 0;
    for (name, step) in steps {
        let code = step().unwrap_or_else(|error| {
            eprintln!("xtask: {name}: {error:#}");
            3
        });
        println!("{name}: {}", if code == 0 { "ok" } else { "FAILED" });
        worst = worst.max(code);
    }
    Ok(worst)
}

/// Compares the versions in all files.
fn versions(root: &Path) -> Result<u8> {
    let mut found = Vec::new();
    for (file, before) in VERSIONS {
        let text = std::fs::read_to_string(root.join(file)).with_context(|| file.to_string())?;
        let version = version(&text, before).with_context(|| format!("{file}: no line with {before:?}"))?;
        found.push((file, version));
    }
    let wrong: Vec<_> = found.iter().filter(|(_, version)| *version != found[0].1).collect();
    for (file, version) in &wrong {
        eprintln!("xtask: {file}: version {version}, but {}: {}", found[0].0, found[0].1);
    }
    Ok(u8::from(!wrong.is_empty()))
}

/// First version in a text, after a text at the beginning of a line.
fn version(text: &str, before: &str) -> Option<String> {
    let rest = text.lines().find_map(|line| line.trim_start().strip_prefix(before))?;
    Some(rest.chars().take_while(|c| c.is_ascii_alphanumeric() || ".-+".contains(*c)).collect())
}

/// Runs the commands of the README with the built program.
fn readme() -> Result<u8> {
    let tests = ["test", "--release", "--locked", "--package", "tissuebench-harness", "--test", "docs"];
    cargo(&tests, &[])
}

/// Builds the container and runs the program in it, if a container builder answers.
fn container(root: &Path) -> Result<u8> {
    let answers = Command::new("docker").arg("info").output().is_ok_and(|done| done.status.success());
    if !answers {
        return skipped(root, "docker", "no docker daemon answers, so the container is not built");
    }
    let docker = |args: &[&str]| -> Result<u8> {
        Ok(code_of(Command::new("docker").args(args).current_dir(root).status()?))
    };
    let code = docker(&["build", "--file", "packaging/Dockerfile", "--tag", "tissuebench:check", "."])?;
    if code != 0 { Ok(code) } else { docker(&["run", "--rm", "tissuebench:check", "--version"]) }
}

/// Checks the workflows, if actionlint is installed.
fn workflows(root: &Path) -> Result<u8> {
    match Command::new("actionlint").current_dir(root).status() {
        Ok(status) => Ok(code_of(status)),
        Err(_) => {
            skipped(root, "actionlint", "actionlint is not installed, so the workflows are not checked")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_files_have_one_version() {
        assert_eq!(versions(&crate::cargo::root()).unwrap(), 0);
        assert_eq!(
            version("a = 1\n  version = \"1.2.0-rc1\" # this\n", "version = \""),
            Some("1.2.0-rc1".into())
        );
        assert_eq!(version("a = 1\n", "version = \""), None);
    }
}
