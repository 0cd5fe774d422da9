//! External solvers: the description of an adapter, the search for adapters, their calls and their answers.
//!
//! An adapter is a folder with `adapter.toml` and any program: one process with files as input and output.
//! The problem files are written by `procedure::external`; this module does not depend on scenes.

use std::path::Path;

mod answer;
mod builtin;
mod checked;
mod find;
mod manifest;
pub(crate) mod npy;
mod outside;
mod run;
mod work;

pub(crate) use answer::RESULT;
pub(crate) use checked::{is_checked, note};
pub(crate) use find::{All, Found, add_folders, all, find, given_folders, leave_local_out, leaves_local_out};
pub(crate) use outside::{About, Outside, label};
pub(crate) use run::{Answered, Question, ask, environment, ready, version};
pub(crate) use work::{Folder, remove_all};

/// Reads `adapter.toml`, `result.json` and `displacement.npy` in `folder`, for fuzz targets. Returns the
/// result of each reader, in this order. `nodes` and `steps` are the expected counts of the displacement.
pub fn try_readers(folder: &Path, nodes: usize, steps: usize) -> [Result<(), String>; 3] {
    let file = folder.join("adapter.toml");
    let text = disk::read_text(&file, disk::Kind::ADAPTER.at_most(1 << 20)).map_err(|bad| bad.to_string());
    let manifest = text.and_then(|text| manifest::Manifest::parse(&text, &file));
    let result = answer::Answer::read(folder).unwrap_or_else(|| Err("there is none".into()));
    let result = result.and_then(|answer| answer.objection("id"));
    [manifest.map(drop), result.map(drop), answer::displacement(folder, nodes, steps).map(drop)]
}

/// Environment variable with adapter folders, separated as in `PATH`.
pub(crate) const FOLDERS: &str = "TISSUEBENCH_ADAPTERS";
