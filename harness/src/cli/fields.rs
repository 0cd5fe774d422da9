//! Writes the body at every recorded state to files, for `tissuebench fields` and for `run --out`.

use std::fs;
use std::path::Path;

use records::{RecordError, write_text};

use crate::cli::args::FieldsArgs;
use crate::cli::errors::unreported;
use crate::cli::like::Like;
use crate::cli::scenes::{affordable_methods, open};
use crate::measure::Repeats;
use crate::outcome::States;
use crate::run::{Group, RunOptions};

/// Name of the folder of fields next to the results of a scene.
pub(super) const FOLDER: &str = "volumes";

/// Runs the methods, writes their fields and returns the exit code.
pub(super) fn run(args: &FieldsArgs) -> u8 {
    let (scene, chosen) = match open(&args.scene) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    if let Err(code) = affordable_methods(&scene, &chosen, args.force) {
        return code;
    }
    let group = match Group::unreferenced(&scene, Repeats::ONCE) {
        Ok(group) => group,
        Err(failure) => {
            eprintln!("{failure}");
            return failure.exit_code();
        }
    };
    let like = match args.like.as_deref().map(Like::read).transpose() {
        Ok(like) => like,
        Err(bad) => {
            eprintln!("tissuebench: {bad}");
            return 2;
        }
    };
    let mut code = 0;
    for index in chosen {
        let method = &scene.methods[index];
        let options = RunOptions { states: true, ..RunOptions::default() };
        let scenario = group.scenario(method.clone(), 0);
        if let Some(Err(bad)) = like.as_ref().map(|like| like.fits(&scenario)) {
            eprintln!("tissuebench: {bad} (method '{}')", method.id);
            code = code.max(2);
            continue;
        }
        let outcome = match group.run(&scenario, options) {
            Ok(outcome) => outcome,
            Err(unfinished) => {
                eprintln!("{} (method '{}')", unfinished.failure, method.id);
                code = code.max(unfinished.failure.exit_code());
                continue;
            }
        };
        if let Some(failure) = &outcome.stalled {
            eprintln!("{}: {failure} (method '{}')", outcome.status, method.id);
            code = code.max(failure.exit_code());
        }
        let Some(mut states) = outcome.states.filter(|states| !states.is_empty()) else {
            eprintln!("no displacement to write (method '{}')", method.id);
            continue;
        };
        let tables = like.as_ref().map_or(Vec::new(), |like| like.number(&mut states));
        let tables = tables
            .into_iter()
            .map(|(name, text)| write_text(&args.out.join(format!("{}-{name}.csv", method.id)), text));
        match write(&states, &method.id, &args.out).and_then(|()| tables.collect()) {
            Ok(()) => {
                let series = args.out.join(format!("{}.pvd", method.id));
                println!("{}: {} states", series.display(), states.len());
            }
            Err(bad) => code = code.max(unreported(bad)),
        }
    }
    code
}

/// Writes the files of a method to a folder, which is created if missing. Parts of an earlier series of the
/// method are removed.
pub(super) fn write(states: &States, method: &str, folder: &Path) -> Result<(), RecordError> {
    if states.is_empty() {
        return Ok(());
    }
    let parts = folder.join(method);
    clear(&parts)?;
    fs::create_dir_all(&parts).map_err(|source| RecordError::Unwritten { path: parts.clone(), source })?;
    let mut files = states.files(method);
    let series = files.next();
    // The series file is written last, so that all parts it names exist.
    files.chain(series).try_for_each(|(name, bytes)| write_text(&folder.join(name), bytes))
}

/// Removes the files of earlier series from a folder, and the folder itself if it is then empty.
pub(super) fn clear(folder: &Path) -> Result<(), RecordError> {
    let unwritten = |source| RecordError::Unwritten { path: folder.into(), source };
    let Ok(entries) = fs::read_dir(folder) else { return Ok(()) };
    for entry in entries {
        let entry = entry.map_err(unwritten)?;
        let path = entry.path();
        // A linked folder does not belong to the results.
        if entry.file_type().map_err(unwritten)?.is_dir() {
            clear(&path)?;
        } else if States::is_file(&entry.file_name().to_string_lossy()) {
            disk::remove(&path).map_err(|source| RecordError::Unwritten { path, source })?;
        }
    }
    // A folder with other files stays.
    let _ = fs::remove_dir(folder);
    Ok(())
}
