//! The Python module: its wheel is built, installed in a fresh virtual environment and tested there, if the
//! required tools are installed.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::cargo::{cargo, code_of};
use crate::skips::skipped;

/// Modules that the test must be able to import; nothing is downloaded.
const NEEDED: [&str; 3] = ["maturin", "numpy", "pytest"];

/// Builds, installs and tests the module if the tools are available.
pub(crate) fn python(root: &Path) -> Result<u8> {
    let python = std::env::var_os("PYTHON").unwrap_or_else(|| "python3".into());
    let missing = |name: &&str| {
        let found = Command::new(&python).args(["-c", &format!("import {name}")]).output();
        !found.is_ok_and(|done| done.status.success())
    };
    let missing: Vec<&str> = NEEDED.into_iter().filter(missing).collect();
    if !missing.is_empty() {
        let why = format!(
            "the Python module is not tested, because {} can't import {}; set PYTHON to another interpreter",
            python.display(),
            missing.join(", ")
        );
        return skipped(root, "maturin", &why);
    }
    let manifest = ["--manifest-path", "python/Cargo.toml"];
    let code = cargo(&[&["fmt", "--check"], &manifest[..]].concat(), &[])?;
    if code != 0 {
        return Ok(code);
    }
    eprintln!("xtask: building the wheel; the first build takes as long as tissuebench itself");
    let work = root.join("target/python");
    let wheels = work.join("wheels");
    if wheels.exists() {
        std::fs::remove_dir_all(&wheels)?;
    }
    let mut build = Command::new(&python);
    build.args(["-m", "maturin", "build", "--release", "--locked"]).args(manifest).arg("--out").arg(&wheels);
    let code = code_of(build.current_dir(root).status()?);
    if code != 0 {
        return Ok(code);
    }
    // The output of the command is compared with that of the module.
    let build = ["build", "--release", "--locked", "--package", "tissuebench-harness"];
    let code = cargo(&build, &[])?;
    if code != 0 {
        return Ok(code);
    }
    let fresh = environment(&python, &work.join("venv"))?;
    let wheel = std::fs::read_dir(&wheels)?.next().context("maturin wrote no wheel")??.path();
    let install = ["-m", "pip", "install", "--quiet", "--no-index", "--no-deps"];
    let status = Command::new(&fresh).args(install).arg(wheel).status()?;
    ensure!(status.success(), "the wheel can't be installed");
    let tests = Command::new(&fresh).args(["-m", "pytest", "-q", "python/tests"]).current_dir(root).status();
    Ok(code_of(tests.context("could not start pytest")?))
}

/// Creates a virtual environment without network access that finds the packages of the creating interpreter;
/// returns the path of its interpreter.
fn environment(python: &std::ffi::OsStr, folder: &Path) -> Result<PathBuf> {
    let made = Command::new(python).args(["-m", "venv", "--clear"]).arg(folder).status()?;
    ensure!(made.success(), "no virtual environment can be made in {}", folder.display());
    let fresh = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let packages = |of: &std::ffi::OsStr| -> Result<PathBuf> {
        let print = "import sysconfig; print(sysconfig.get_path('purelib'))";
        let output = Command::new(of).args(["-c", print]).output()?;
        Ok(String::from_utf8_lossy(&output.stdout).trim().into())
    };
    let theirs = packages(python)?;
    std::fs::write(packages(fresh.as_os_str())?.join("theirs.pth"), theirs.to_string_lossy().as_bytes())?;
    Ok(fresh)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// Returns the project's packages with their dependencies, including those of tests.
    fn ours(lock: &str) -> BTreeMap<String, Vec<String>> {
        let text = std::fs::read_to_string(crate::cargo::root().join(lock)).unwrap();
        let read: toml::Value = toml::from_str(&text).unwrap();
        let name = |package: &toml::Value| package["name"].as_str().unwrap().to_string();
        let of = |package: &toml::Value| -> Vec<String> {
            let all = package.get("dependencies").and_then(toml::Value::as_array).into_iter().flatten();
            all.map(|entry| entry.as_str().unwrap().split(' ').next().unwrap().into()).collect()
        };
        let packages = read["package"].as_array().unwrap().iter();
        packages.filter(|p| name(p).starts_with("tissuebench-")).map(|p| (name(p), of(p))).collect()
    }

    /// Returns the name of a package and its dependencies outside the workspace, from its manifest.
    fn needed(folder: &Path) -> (String, Vec<String>) {
        let read: toml::Value =
            toml::from_str(&std::fs::read_to_string(folder.join("Cargo.toml")).unwrap()).unwrap();
        let depends = read.get("dependencies").and_then(toml::Value::as_table).into_iter().flatten();
        let name = read["package"]["name"].as_str().unwrap().into();
        (name, depends.map(|(key, _)| key.clone()).collect())
    }

    /// Both workspaces have a lock file. If a dependency is added or removed in only one of them, the wheel
    /// can no longer be built as locked.
    #[test]
    fn the_lock_file_of_the_module_has_the_dependencies_of_the_workspace() {
        let (workspace, module) = (ours("Cargo.lock"), ours("python/Cargo.lock"));
        assert!(module.len() > 10, "{module:?}");
        for (package, depends) in module.iter().filter(|(package, _)| *package != "tissuebench-python") {
            for one in depends {
                assert!(workspace[package].contains(one), "{package} no longer needs {one}");
            }
        }
        let solvers =
            std::fs::read_dir(crate::cargo::root().join("solvers")).unwrap().map(|e| e.unwrap().path());
        let rest = ["cases", "harness", "reports"].map(|folder| crate::cargo::root().join(folder));
        for (package, depends) in solvers.chain(rest).map(|folder| needed(&folder)) {
            for one in depends.iter().filter(|one| !module.contains_key(&format!("tissuebench-{one}"))) {
                assert!(
                    module[&package].contains(one),
                    "{package} needs {one}, which the module has not locked"
                );
            }
        }
    }
}
