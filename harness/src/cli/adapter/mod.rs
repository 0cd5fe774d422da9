//! `tissuebench adapter`: lists, checks, installs and copies adapters of external solvers, and calls them
//! once.

mod call;
mod check;
mod install;

use std::path::PathBuf;

use clap::Subcommand;

use crate::adapter::{self, All};
use crate::cli::errors::fail;

/// Actions on adapters.
#[derive(Subcommand)]
pub enum AdapterAction {
    /// List all adapters, their folders, and whether their requirements are installed
    List,
    /// Check a solver against exact solutions and this program's elements: rigid motion, linear patch, force
    /// balance, agreement
    Check {
        /// Name of the adapter
        name: String,
    },
    /// Call a solver once on a problem written by `export`, and keep its answer
    Run {
        /// Name of the adapter
        name: String,
        /// Folder of the problem
        problem: PathBuf,
        /// Folder for the answer
        answer: PathBuf,
    },
    /// Install the Python packages that an adapter needs in a separate virtual environment
    Install {
        /// Name of the adapter
        name: String,
    },
    /// Copy the folder of an adapter as the basis of another adapter
    Copy {
        /// Name of the adapter
        name: String,
        /// New folder; its name becomes the name of the new adapter
        folder: PathBuf,
    },
}

/// Runs an action and returns the exit code.
pub(super) fn act(action: &AdapterAction) -> u8 {
    let done = match action {
        AdapterAction::List => Ok(list()),
        AdapterAction::Check { name } => adapter::find(name, None).map(|found| check::check(&found)),
        AdapterAction::Run { name, problem, answer } => {
            adapter::find(name, None).and_then(|found| call::call(&found, problem, answer))
        }
        AdapterAction::Install { name } => {
            adapter::find(name, None).and_then(|found| install::install(&found))
        }
        AdapterAction::Copy { name, folder } => {
            adapter::find(name, None).and_then(|found| install::copy(&found, folder)).map(|()| 0)
        }
    };
    done.unwrap_or_else(|failure| fail(&failure))
}

fn list() -> u8 {
    let All { found, broken } = adapter::all(None);
    for adapter in &found {
        let manifest = &adapter.manifest;
        // The version is not listed, because it would have to be printed by the adapter's programs.
        let state = adapter::ready(adapter).err().unwrap_or_else(|| "ready".into());
        println!("{}: {} ({})", manifest.name, manifest.title, adapter.place());
        println!("  can       {}", manifest.can.join(", "));
        println!("  elements  {}", manifest.elements.join(", "));
        println!("  state     {state}");
    }
    for (_, bad) in &broken {
        eprintln!("tissuebench: {bad}");
    }
    if broken.is_empty() { 0 } else { 2 }
}
