//! `tissuebench adapter install` and `copy`: installs the requirements of an adapter, and copies its folder.

use std::path::Path;
use std::process::Command;

use crate::adapter::{self, Found};
use crate::error::Failure;

/// Creates the virtual environment, installs the packages and returns the exit code.
pub(super) fn install(adapter: &Found) -> Result<u8, Failure> {
    let manifest = &adapter.manifest;
    let needs = &manifest.install;
    if !needs.programs.is_empty() {
        println!("{} needs {}: {}", manifest.name, needs.programs.join(", "), needs.say);
    } else if !needs.say.is_empty() {
        println!("{}: {}", manifest.name, needs.say);
    }
    if needs.python.is_empty() {
        return Ok(match adapter::ready(adapter) {
            Ok(()) => 0,
            Err(reason) => {
                eprintln!("tissuebench: {reason}");
                3
            }
        });
    }
    let folder = adapter::environment(&manifest.name)
        .ok_or_else(|| Failure::Run("no folder for data: set TISSUEBENCH_DATA or HOME".into()))?;
    println!("{}: {} into {}", manifest.name, needs.python.join(", "), folder.display());
    run(Command::new("python3").args(["-m", "venv"]).arg(&folder))?;
    run(Command::new(folder.join("bin/python"))
        .args(["-m", "pip", "install", "--quiet"])
        .args(&needs.python))?;
    for package in &needs.faster {
        let pip = ["-m", "pip", "install", "--quiet", package];
        if run(Command::new(folder.join("bin/python")).args(pip)).is_err() {
            println!(
                "{}: {package} can't be installed; the adapter works without this package, but more slowly",
                manifest.name
            );
        }
    }
    Ok(0)
}

fn run(command: &mut Command) -> Result<(), Failure> {
    let program = command.get_program().to_string_lossy().into_owned();
    let status =
        command.status().map_err(|bad| Failure::Run(format!("{program} can't be started: {bad}")))?;
    match status.success() {
        true => Ok(()),
        false => Err(Failure::Run(format!("{program} ended with {status}"))),
    }
}

/// Writes the files of an adapter to a new folder and renames the adapter to the folder's name.
pub(super) fn copy(adapter: &Found, folder: &Path) -> Result<(), Failure> {
    let bad = |what: String| Failure::Input(format!("{}: {what}", folder.display()));
    let name = folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    if folder.exists() {
        return Err(bad("already exists; give a new folder".into()));
    }
    std::fs::create_dir_all(folder).map_err(|source| bad(format!("can't be made: {source}")))?;
    for (file, bytes) in adapter.files() {
        let old = format!("name = \"{}\"", adapter.manifest.name);
        let text = String::from_utf8_lossy(&bytes).replacen(&old, &format!("name = \"{name}\""), 1);
        let bytes = if file == "adapter.toml" { text.into_bytes() } else { bytes };
        disk::write(&folder.join(&file), bytes).map_err(|source| bad(format!("{file}: {source}")))?;
    }
    let beside = folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    println!(
        "{}: edit adapter.toml and its program, then: tissuebench adapter check {name} --adapters '{}'",
        folder.display(),
        beside.display()
    );
    Ok(())
}
