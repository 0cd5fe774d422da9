//! Coverage of a folder by a study: a scene that was removed from the study, or never added, is reported.

use std::path::{Path, PathBuf};

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use super::report::Report;

/// A scene that the study leaves out on purpose
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LeftOutKeys {
    /// The scene file, relative to the study's folder
    pub scene: String,
    /// Reason why no run has the scene
    pub reason: String,
}

/// Reports every scene in the folder `all_of` and below it that is neither in a run nor left out with a
/// reason.
pub(crate) fn check(all_of: Option<&str>, left_out: &[LeftOutKeys], runs: &[&Path], report: &Report) {
    let Some(folder) = all_of else {
        let help = "name the folder of the study's scenes: all_of = \"../scenes\"";
        report.require(left_out.is_empty(), "left_out", "applies to all_of only", help);
        return;
    };
    let folder = report.path(folder, "all_of");
    let mut scenes = Vec::new();
    let listed = list(&folder, &mut scenes, &mut 0);
    if matches!(listed, Ok(false)) {
        let help =
            format!("{} holds more than {MOST_FILES} files; name the folder of the scenes", folder.display());
        report.add("all_of", Problem::new("is too large a folder").help(help));
        return;
    }
    if listed.is_err() || scenes.is_empty() {
        let help = format!("no scenes in {}; the folder is relative to the study's", folder.display());
        report.add("all_of", Problem::new("has no scenes").help(help));
        return;
    }
    scenes.sort();
    let run: Vec<PathBuf> = runs.iter().map(|scene| whole(scene)).collect();
    let mut excused = Vec::new();
    for (i, keys) in left_out.iter().enumerate() {
        let key = format!("left_out[{i}]");
        let scene = report.path(&keys.scene, &format!("{key}.scene"));
        let help = format!("no file at {}; scenes are relative to the study's folder", scene.display());
        report.require(scene.is_file(), &format!("{key}.scene"), "can't be found", &help);
        let scene = whole(&scene);
        report.require(
            !run.contains(&scene),
            &format!("{key}.scene"),
            "is in a run",
            "leave one of them out",
        );
        let sound = !keys.reason.trim().is_empty();
        report.require(
            sound,
            &format!("{key}.reason"),
            "is empty",
            "give the reason why no run has the scene",
        );
        excused.push(scene);
    }
    for scene in scenes {
        let known = whole(&scene);
        if !run.contains(&known) && !excused.contains(&known) {
            let problem = Problem::new("contains a scene without a run").found(scene.display().to_string());
            let help =
                "add a [[run]] with the scene, or a [[left_out]] with scene = \"...\" and reason = \"...\"";
            report.add("all_of", problem.help(help));
        }
    }
}

/// Largest number of files and folders to search. A larger folder, such as `/`, is taken for a mistake.
const MOST_FILES: usize = 10_000;

/// Finds the TOML files in a folder and below it; returns false if there are more than [`MOST_FILES`]
/// entries.
fn list(folder: &Path, found: &mut Vec<PathBuf>, seen: &mut usize) -> std::io::Result<bool> {
    for entry in std::fs::read_dir(folder)? {
        *seen += 1;
        if *seen > MOST_FILES {
            return Ok(false);
        }
        let path = entry?.path();
        if path.is_dir() {
            if !list(&path, found, seen)? {
                return Ok(false);
            }
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            found.push(path);
        }
    }
    Ok(true)
}

/// The canonical path of a file.
fn whole(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.into())
}
