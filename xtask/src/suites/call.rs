//! Calls of `tissuebench run` with a time limit.

use std::fs::File;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

/// A finished call of `tissuebench run`.
pub(super) struct Run {
    /// Exit code; `None` if the run took too long.
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

/// Runs a model once, for at most `limit` seconds.
pub(super) fn call(root: &Path, model: &Path, limit: u64) -> Result<Run> {
    let folder = root.join("target");
    let [out, err] = ["suites.stdout", "suites.stderr"].map(|name| folder.join(name));
    let mut child = Command::new(root.join("target/release/tissuebench"))
        .args(["run", "--once", "--quiet", "--format", "json"])
        .arg(model)
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
