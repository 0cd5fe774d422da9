//! The checks that take hours, for a schedule: listed faults, killed processes, closed surfaces, dependencies,
//! packages, and fuzzing.

use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};

use crate::cargo::{cargo, code_of};
use crate::mutants::mutants;
use crate::skips::skipped;

/// Seconds in a minute.
const MINUTE: u32 = 60;

/// Runs every check regardless of the others, with `minutes` for each fuzz target, and returns the worst exit
/// code.
pub(crate) fn nightly(root: &Path, minutes: u32) -> Result<u8> {
    let checks: [(&str, &dyn Fn() -> Result<u8>); 7] = [
        ("deny", &|| deny(root)),
        ("package", &|| cargo(&["package", "--workspace", "--allow-dirty", "--locked", "--quiet"], &[])),
        ("mutants", &|| mutants(root, &[])),
        ("survive", &survive),
        ("organs", &organs),
        ("newcomer", &newcomer),
        ("fuzz", &|| fuzz(root, minutes)),
    ];
    let mut worst = 0;
    for (name, check) in checks {
        let code = check().unwrap_or_else(|error| {
            eprintln!("xtask: {name}: {error:#}");
            3
        });
        println!("{name}: {}", if code == 0 { "ok" } else { "FAILED" });
        worst = worst.max(code);
    }
    Ok(worst)
}

/// Kills one of two processes of a study at random times, a hundred times, with and without `--isolate`. No
/// result may be lost, repeated or changed.
fn survive() -> Result<u8> {
    let test = ["test", "--release", "--locked", "--package", "tissuebench-harness", "--test", "survive"];
    cargo(&[&test[..], &["--", "--ignored", "--nocapture"]].concat(), &[])
}

/// Makes scenes of all closed surfaces and runs them with every method.
fn organs() -> Result<u8> {
    let test = ["test", "--release", "--locked", "--package", "tissuebench-harness", "--test", "organs"];
    cargo(&[&test[..], &["--", "--include-ignored"]].concat(), &[])
}

/// Follows the first page of the guide in a fresh clone, with a time limit.
fn newcomer() -> Result<u8> {
    let test =
        ["test", "--locked", "--package", "tissuebench-xtask", "--test", "newcomer", "--", "--ignored"];
    cargo(&test, &[])
}

/// Checks licences, advisories, sources and versions of all dependencies.
fn deny(root: &Path) -> Result<u8> {
    if !has("cargo-deny") {
        return skipped(
            root,
            "cargo-deny",
            "cargo-deny is not installed, so the dependencies are not checked",
        );
    }
    cargo(&["deny", "--locked", "check"], &[])
}

/// Runs every fuzz target for some minutes, starting from its corpus; new inputs stay in target/fuzz.
fn fuzz(root: &Path, minutes: u32) -> Result<u8> {
    if !has("cargo-fuzz") {
        return skipped(root, "cargo-fuzz", "cargo-fuzz is not installed, so the readers are not fuzzed");
    }
    let mut targets: Vec<_> = std::fs::read_dir(root.join("fuzz/engine/fuzz_targets"))?
        .filter_map(|entry| Some(entry.ok()?.path().file_stem()?.to_os_string()))
        .collect();
    targets.sort();
    let time = format!("-max_total_time={}", MINUTE * minutes);
    let mut worst = 0;
    for target in &targets {
        let (new, known) = (root.join("target/fuzz").join(target), root.join("fuzz/corpus").join(target));
        std::fs::create_dir_all(&new)?;
        // The pinned toolchain is not the toolchain that instruments.
        let mut command = Command::new("rustup");
        command.args([
            "run",
            "nightly",
            "cargo",
            "fuzz",
            "run",
            "--fuzz-dir",
            "fuzz/engine",
            "--sanitizer",
            "none",
        ]);
        command.arg(target).args([new, known]);
        command.args(["--", "-dict=fuzz/words.dict", "-max_len=16000", &time]).current_dir(root);
        worst = worst.max(code_of(command.status().context("could not start rustup")?));
    }
    Ok(worst)
}

fn has(program: impl AsRef<OsStr>) -> bool {
    Command::new(program).arg("--version").output().is_ok()
}
