//! Calls of `tissuebench` with a time limit.

use std::fs::File;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

/// Longest time of an import, s.
const IMPORT_LIMIT: u64 = 60;

/// A finished call.
pub(super) struct Run {
    /// Exit code; `None` if the run took too long.
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

/// Runs a model or a scene once, for at most `limit` seconds.
pub(super) fn call(root: &Path, model: &Path, limit: u64) -> Result<Run> {
    program(
        root,
        &[&["run", "--once", "--quiet", "--format", "json"].map(Path::new)[..], &[model]].concat(),
        limit,
    )
}

/// Imports a step of a deck as a scene.
pub(super) fn import(root: &Path, deck: &Path, step: usize, scene: &Path) -> Result<Run> {
    let step = step.to_string();
    let words = ["import", "--step", &step, "--out"].map(Path::new);
    program(root, &[&words[..], &[scene, deck]].concat(), IMPORT_LIMIT)
}

fn program(root: &Path, arguments: &[&Path], limit: u64) -> Result<Run> {
    let folder = root.join("target");
    let [out, err] = ["suites.stdout", "suites.stderr"].map(|name| folder.join(name));
    let mut child = Command::new(root.join("target/release/tissuebench"))
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(File::create(&out)?)
        .stderr(File::create(&err)?)
        .spawn()
        .context("could not start target/release/tissuebench")?;
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break Some(status);
        }
        if start.elapsed() > Duration::from_secs(limit) {
            child.kill()?;
            child.wait()?;
            break None;
        }
        std::thread::sleep(Duration::from_millis(10));
    };
    let read = |file: &Path| -> Result<String> { Ok(String::from_utf8_lossy(&std::fs::read(file)?).into()) };
    // A program that a signal ended has no exit code.
    Ok(Run {
        code: status.map(|status| status.code().unwrap_or(-1)),
        stdout: read(&out)?,
        stderr: read(&err)?,
    })
}
