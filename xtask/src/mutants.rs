//! Faults that the tests must find. All are compiled in next to the correct code, and one is switched on at a
//! time.
//!
//! `tests/mutants.toml` lists them. The workspace is copied to `target/mutants/source` with every fault in
//! it, so a single build serves all.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;

/// Environment variable with the name of the active fault.
const SWITCH: &str = "TISSUEBENCH_MUTANT";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    mutant: Vec<Mutant>,
}

/// A fault.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Mutant {
    name: String,
    /// Description of the fault in a sentence.
    what: String,
    /// Source file, from the root of the workspace.
    file: String,
    /// An expression that occurs once in the file.
    find: String,
    /// Replacement of the expression when the fault is on.
    replace: String,
    /// Test that finds the fault: `PACKAGE lib|TEST [FILTER]`, a test target of `cargo test`, or
    /// `baseline TEXT`, the accepted numbers of the quick runs whose case or method contains the text.
    test: String,
}

/// Runs the named mutants, or all. Returns 0 if each is killed, otherwise 1.
pub(crate) fn mutants(root: &Path, names: &[String]) -> Result<u8> {
    let all = read(&root.join("tests/mutants.toml"))?;
    if let Some(name) = names.iter().find(|name| all.iter().all(|m| m.name != **name)) {
        bail!("tests/mutants.toml has no mutant '{name}'");
    }
    let chosen: Vec<&Mutant> = all.iter().filter(|m| names.is_empty() || names.contains(&m.name)).collect();
    copy(root, &all)?;
    eprintln!("xtask: building the tests with {} faults, all off; minutes the first time", all.len());
    let tests: BTreeSet<&str> = chosen.iter().map(|m| m.test.as_str()).collect();
    let targets: BTreeSet<String> = tests.iter().map(|test| target(test)).collect::<Result<_>>()?;
    for target in targets {
        // Warnings concern the switches; only errors are reported.
        let built = cargo(root, &target).arg("--no-run").output()?;
        let said = String::from_utf8_lossy(&built.stderr);
        let said = &said[said.find("\nerror").unwrap_or(0)..];
        ensure!(built.status.success(), "cargo {target} failed to build:{said}");
    }
    for test in tests {
        let output = run(root, test, "")?;
        let said = String::from_utf8_lossy(&output.stdout);
        ensure!(output.status.success(), "{test} fails without any fault:\n{said}");
    }
    let begin = Instant::now();
    let mut survivors = 0;
    for mutant in &chosen {
        let start = Instant::now();
        let killed = !run(root, &mutant.test, &mutant.name)?.status.success();
        let Mutant { name, what, test, .. } = mutant;
        let seconds = start.elapsed().as_secs_f64();
        if killed {
            println!("killed    {name} by {test} ({seconds:.1} s)");
        } else {
            survivors += 1;
            println!("SURVIVED  {name}: {what} Not found by {test} ({seconds:.1} s)");
        }
    }
    let seconds = begin.elapsed().as_secs();
    println!("{} of {} killed, in {seconds} s", chosen.len() - survivors, chosen.len());
    Ok(u8::from(survivors > 0))
}

fn read(path: &Path) -> Result<Vec<Mutant>> {
    let text = std::fs::read_to_string(path).with_context(|| format!("{} can't be read", path.display()))?;
    let List { mutant } = toml::from_str(&text).with_context(|| path.display().to_string())?;
    let names: BTreeSet<&str> = mutant.iter().map(|m| m.name.as_str()).collect();
    ensure!(names.len() == mutant.len(), "{}: two mutants have the same name", path.display());
    Ok(mutant)
}

/// Copies the files tracked by git, with the faults in them. Files with unchanged text are not written, so
/// cargo builds only the changes.
fn copy(root: &Path, mutants: &[Mutant]) -> Result<()> {
    let to = root.join("target/mutants/source");
    let mut faults: BTreeMap<&str, Vec<&Mutant>> = BTreeMap::new();
    for mutant in mutants {
        faults.entry(&mutant.file).or_default().push(mutant);
    }
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(root).output();
    let listed = listed.context("could not start git")?;
    let files = String::from_utf8(listed.stdout)?;
    let mut kept = BTreeSet::new();
    for file in files.split_terminator('\0') {
        // A file may be deleted while git still tracks it.
        let Ok(mut text) = std::fs::read(root.join(file)) else { continue };
        if let Some(faults) = faults.remove(file) {
            text = with_faults(&String::from_utf8(text)?, &faults)?.into_bytes();
        }
        let copy = to.join(file);
        if std::fs::read(&copy).ok().as_ref() != Some(&text) {
            std::fs::create_dir_all(copy.parent().expect("a file is in a folder"))?;
            std::fs::write(&copy, text)?;
        }
        kept.insert(copy);
    }
    remove_others(&to, &kept)?;
    match faults.into_iter().next() {
        Some((file, faults)) => bail!("{}: the file {file} is not in git", faults[0].name),
        None => Ok(()),
    }
}

/// Removes files that the workspace no longer has.
fn remove_others(folder: &Path, kept: &BTreeSet<PathBuf>) -> Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            remove_others(&path, kept)?;
        } else if !kept.contains(&path) {
            std::fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// Returns the text of a file with a switch around each expression of a fault.
fn with_faults(text: &str, mutants: &[&Mutant]) -> Result<String> {
    // Places in the text; two faults of the same expression share a place.
    let mut places: BTreeMap<usize, (&str, String)> = BTreeMap::new();
    for Mutant { name, file, find, replace, .. } in mutants {
        let at: Vec<usize> = text.match_indices(find.as_str()).map(|(at, _)| at).collect();
        let [at] = at[..] else { bail!("{name}: {file} contains `{find}` {} times, not once", at.len()) };
        let (old, new) = places.entry(at).or_insert((find, find.clone()));
        ensure!(old == find, "{name}: {file} has two overlapping faults in `{find}`");
        *new = format!(
            "(if {{ static ON: std::sync::LazyLock<bool> = std::sync::LazyLock::new(|| \
             std::env::var_os(\"{SWITCH}\").is_some_and(|on| on == \"{name}\")); *ON }} {{ {replace} }} else {{ {new} }})"
        );
    }
    let mut out = String::new();
    let mut done = 0;
    for (at, (old, new)) in places {
        ensure!(at >= done, "{}: two overlapping faults in `{old}`", mutants[0].file);
        out += &text[done..at];
        out += &new;
        done = at + old.len();
    }
    Ok(out + &text[done..])
}

/// Returns the arguments with which cargo builds a test: `test --package P --test T`.
fn target(test: &str) -> Result<String> {
    let words: Vec<&str> = test.split_whitespace().collect();
    match words[..] {
        ["baseline", ..] => Ok("test --package tissuebench-harness --test verify".into()),
        [package, "lib", ..] => Ok(format!("test --package tissuebench-{package} --lib")),
        [package, name, ..] => Ok(format!("test --package tissuebench-{package} --test {name}")),
        _ => bail!("`{test}` is not a test: write `PACKAGE lib|TEST [FILTER]` or `baseline TEXT`"),
    }
}

/// Runs a test with one fault on, or without a fault for an empty name.
fn run(root: &Path, test: &str, mutant: &str) -> Result<Output> {
    let words: Vec<&str> = test.split_whitespace().collect();
    if words[0] != "baseline" {
        return Ok(cargo(root, &target(test)?).arg("--").args(&words[2..]).env(SWITCH, mutant).output()?);
    }
    let out = root.join("target/mutants/results");
    if out.exists() {
        std::fs::remove_dir_all(&out)?;
    }
    let out = out.to_str().context("the workspace's path is not UTF-8")?;
    let mut verify = vec!["verify", "--quick", "--out", out];
    verify.extend(words.get(1).iter().flat_map(|text| ["--filter", text]));
    // Only the numbers matter here, not the results of checks.
    tissuebench(root, &verify).env(SWITCH, mutant).output()?;
    // This build rounds differently from that of the accepted numbers, so these are treated as numbers of
    // another processor.
    let folder = root.join("target/mutants/baseline");
    std::fs::create_dir_all(&folder)?;
    for entry in std::fs::read_dir(root.join("tests/baseline/quick"))? {
        let file = entry?.path();
        let accepted = std::fs::read_to_string(&file)?;
        let name = file.file_name().context("a file has a name")?;
        let another = accepted.replace("\nprocessor = \"", "\nprocessor = \"another: ");
        std::fs::write(folder.join(name), another)?;
    }
    let folder = folder.to_str().context("the workspace's path is not UTF-8")?;
    Ok(tissuebench(root, &["baseline", out, "--accepted", folder, "--part", "--check"]).output()?)
}

fn cargo(root: &Path, args: &str) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(args.split(' ')).args(["--quiet", "--locked"]);
    command.current_dir(root.join("target/mutants/source"));
    command.env("CARGO_TARGET_DIR", root.join("target/mutants/build")).env_remove(SWITCH);
    command
}

fn tissuebench(root: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(root.join("target/mutants/build/debug/tissuebench"));
    command.args(args).current_dir(root.join("target/mutants/source"));
    command
}

#[cfg(test)]
mod tests;
