//! Solvers outside this program: what an adapter says of itself, where it is found, how it is called, what it answers.
//!
//! An adapter is a folder with `adapter.toml` and any program: a process, files in, files out. What is in the files of a problem is
//! written where problems are (`procedure::external`); this room knows no scene.

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
pub(crate) use find::{All, Found, add_folders, all, find, given_folders};
pub(crate) use outside::{About, Outside, label};
pub(crate) use run::{Answered, Question, ask, environment, ready, version};
pub(crate) use work::Folder;

/// The environment variable with folders of adapters, as `PATH` has folders of programs.
pub(crate) const FOLDERS: &str = "TISSUEBENCH_ADAPTERS";
