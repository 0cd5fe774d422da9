//! `tissuebench adapter`: which solvers outside this program there are, whether they are right, and one call of them.

mod call;
mod check;
mod install;

use std::path::PathBuf;

use clap::Subcommand;

use crate::adapter::{self, All};
use crate::cli::fail;

/// What to do with adapters.
#[derive(Subcommand)]
pub enum AdapterAction {
    /// List the adapters there are, where they are, and whether what they need is installed
    List,
    /// Hold a solver against exact solutions and our own elements: rigid motion, linear patch, balance of forces, agreement
    Check {
        /// Name of the adapter
        name: String,
    },
    /// Call a solver once with a problem that `export` wrote, and keep its answer
    Run {
        /// Name of the adapter
        name: String,
        /// The folder of the problem
        problem: PathBuf,
        /// The folder for its answer
        answer: PathBuf,
    },
    /// Install the Python packages that an adapter needs, in a virtual environment of its own
    Install {
        /// Name of the adapter
        name: String,
    },
    /// Copy the folder of an adapter, to make another one of it
    Copy {
        /// Name of the adapter
        name: String,
        /// The new folder; its name is that of the new adapter
        folder: PathBuf,
    },
}

/// Does it; the exit code.
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
        // Its version is what one of its programs says: a list calls none of them.
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
