//! Records the provenance of the program at build time: commit, whether the sources differ from the commit,
//! compiler, target and features.
//!
//! When the program runs, git could report another commit, which was checked out after the build.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Paths of the program's sources, relative to the workspace's folder. Changes elsewhere (scenes, tests,
/// docs) do not change the program.
const SOURCES: [&str; 12] = [
    "Cargo.toml",
    "Cargo.lock",
    "rust-toolchain.toml",
    "cases/src",
    "harness/shipped",
    "harness/src",
    "harness/build.rs",
    "records/src",
    "reports/src",
    "reports/assets",
    "reports/page/built",
    "solvers",
];

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let version = output(Command::new(rustc).arg("--version")).unwrap_or_else(|| "unknown".into());
    println!("cargo::rustc-env=TISSUEBENCH_RUSTC={version}");
    let variable = |name: &str| std::env::var(name).unwrap_or_default();
    println!("cargo::rustc-env=TISSUEBENCH_TARGET={}", variable("TARGET"));
    println!("cargo::rustc-env=TISSUEBENCH_FEATURES={}", variable("CARGO_CFG_TARGET_FEATURE"));
    // All of these are compiled into the program: a change that reruns this script rebuilds the program
    // anyway.
    for source in SOURCES.iter().filter(|source| **source != "solvers") {
        watch(&root.join(source));
    }
    for room in std::fs::read_dir(root.join("solvers")).into_iter().flatten().flatten() {
        watch(&room.path().join("src"));
    }
    let (commit, dirty) = match commit(&root) {
        Some(commit) => (commit, changed(&root)),
        None => ("unknown".into(), false),
    };
    println!("cargo::rustc-env=TISSUEBENCH_COMMIT={commit}");
    println!("cargo::rustc-env=TISSUEBENCH_DIRTY={dirty}");
}

/// Reruns this script when a file changes. A missing file would rerun the script at every build.
fn watch(path: &Path) {
    if path.exists() {
        println!("cargo::rerun-if-changed={}", path.display());
    }
}

/// Checked-out commit; `None` if this file is not tracked, such as in a tarball unpacked inside another
/// repository.
fn commit(root: &Path) -> Option<String> {
    git(root, &["ls-files", "--error-unmatch", "harness/build.rs"])?;
    // Every commit, checkout and reset adds a line to the log of HEAD. Without a log, the branch's own file
    // changes.
    let at = |name: &str| git(root, &["rev-parse", "--git-path", name]).map(|path| root.join(path));
    let log = at("logs/HEAD").filter(|path| path.exists());
    let branch = || git(root, &["symbolic-ref", "-q", "HEAD"]).and_then(|name| at(&name));
    let watched: Vec<PathBuf> = match log {
        Some(log) => vec![log],
        None => [at("HEAD"), branch(), at("packed-refs")].into_iter().flatten().collect(),
    };
    watched.iter().for_each(|path| watch(path));
    git(root, &["rev-parse", "HEAD"])
}

/// Whether the sources differ from the commit.
fn changed(root: &Path) -> bool {
    let status = ["status", "--porcelain", "--untracked-files=no", "--"];
    git(root, &[&status[..], &SOURCES].concat()).is_none_or(|changes| !changes.is_empty())
}

fn git(root: &Path, args: &[&str]) -> Option<String> {
    output(Command::new("git").arg("-C").arg(root).args(args))
}

fn output(command: &mut Command) -> Option<String> {
    let out = command.output().ok()?;
    out.status.success().then(|| String::from_utf8_lossy(&out.stdout).trim().to_string())
}
