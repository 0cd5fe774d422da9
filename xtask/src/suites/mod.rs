//! Runs the test suites of other programs: every model is imported and run, and its numbers are compared with
//! those that the suite stores.

mod calculix;
mod call;
mod febio;
mod outcome;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;

use crate::cargo::cargo;
use call::call;
use outcome::{Outcome, table};

/// Arguments of `suites`.
#[derive(Args)]
pub(crate) struct SuitesArgs {
    /// Folder of FEBio's test suite, with the folders Verify and code
    #[arg(long, value_name = "DIR")]
    febio: Option<PathBuf>,
    /// Folder of CalculiX's test suite, with decks and their .dat.ref
    #[arg(long, value_name = "DIR")]
    calculix: Option<PathBuf>,
    /// Only files whose names end in one of these characters, without the suffix
    #[arg(long, value_name = "CHARACTERS")]
    ending: Option<String>,
    /// Longest time of a run, s
    #[arg(long, default_value_t = 300, value_name = "SECONDS")]
    limit: u64,
    /// Table to write (Markdown)
    #[arg(long, default_value = "target/suites.md", value_name = "FILE")]
    out: PathBuf,
}

/// Runs the suites, writes the table, and returns 0 unless a run fails.
pub(crate) fn suites(root: &Path, args: &SuitesArgs) -> Result<u8> {
    let build = ["build", "--release", "--locked", "--workspace", "--bins"];
    let code = cargo(&build, &[])?;
    if code != 0 {
        return Ok(code);
    }
    let mut found: Vec<Outcome> = Vec::new();
    let mut add = |model: String, step, verdict| {
        found.push(Outcome { model, step, verdict });
        eprintln!("{}", found[found.len() - 1]);
    };
    if let Some(folder) = &args.febio {
        let stored = febio::stored(folder)?;
        for model in models(&folder.join("Verify"), "feb", args.ending.as_deref())? {
            let name = stem(&model);
            let run = call(root, &model, args.limit)?;
            let verdict = febio::verdict(&model, stored.get(&name).copied(), &run)?;
            add(name, None, verdict);
        }
    }
    if let Some(folder) = &args.calculix {
        for deck in models(folder, "inp", args.ending.as_deref())? {
            for (step, verdict) in calculix::verdicts(root, &deck, args.limit)? {
                add(stem(&deck), step, verdict);
            }
        }
    }
    let text = table(&found);
    std::fs::write(&args.out, &text).with_context(|| format!("could not write {}", args.out.display()))?;
    print!("{text}");
    Ok(u8::from(found.iter().any(Outcome::failed)))
}

fn stem(file: &Path) -> String {
    file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Models of a folder by name.
fn models(folder: &Path, suffix: &str, ending: Option<&str>) -> Result<Vec<PathBuf>> {
    let entries =
        std::fs::read_dir(folder).with_context(|| format!("could not read {}", folder.display()))?;
    let mut all: Vec<PathBuf> = entries.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    let wanted = |name: &str| ending.is_none_or(|ending| name.ends_with(|c| ending.contains(c)));
    all.retain(|path| path.extension().is_some_and(|found| found == suffix) && wanted(&stem(path)));
    all.sort();
    Ok(all)
}
