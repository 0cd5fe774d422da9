//! Folder of a run, written once by the harness and read by the report.
//!
//! | file | content |
//! |---|---|
//! | `records.csv` | the long table, one number per row, SI |
//! | `records.parquet` | the same table for data-frame programs; never read back |
//! | `provenance.json` | provenance of the numbers, with the hash of every scene |
//! | `checks.csv`, `checks.json` | every bound with its outcome |
//! | `plans.json`, `failures.json` | stages run and skipped; runs without numbers or with a partial load |
//! | `warnings.json` | warnings about the numbers of runs |
//! | `references.json` | references of the runs, with their own errors |
//! | `axes.json` | outcomes of methods along the axes of the study |
//! | `samples.json` | samples of uncertain inputs with their results, if a scene has any |
//! | `fit.json` | constants that were fitted to measured curves, if a scene has any |
//! | `fields/CASE--METHOD.json` | surface displacements and states, see below |
//! | `ro-crate-metadata.json` | description of all files of the folder, see [`ro_crate`](crate::ro_crate) |
//! | `incomplete.json` | present from the start of a study or run until all files are written |
//!
//! A file in `fields` contains the surface displacements, and the surface at some states for a
//! three-dimensional view. For a case with tools it also contains the tools and a section with its pressure.
//!
//! Each file is written under another name and then renamed, so it is complete, the previous version, or
//! absent. Rows are sorted and contain no date. Two runs of one state therefore differ only in measured rows
//! (times, memory).

use std::collections::HashSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use disk::Kind;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::cell::csv_line;
use crate::error::{RecordError, unwritten};
use crate::fit::Fit;
use crate::frame;
use crate::provenance::{FORMAT, Provenance};
use crate::record::Record;
use crate::run_set::RunSet;
use crate::samples::Samples;

/// Name of the mark of a folder whose results are not those of the last study or run started there.
const MARK: &str = "incomplete.json";

/// Name of the description of a folder.
pub(crate) const DESCRIPTION: &str = "ro-crate-metadata.json";

/// Name of the file of samples.
const SAMPLES: &str = "samples.json";
/// Name of the file of fits.
const FITS: &str = "fit.json";

/// Content of the mark.
#[derive(Serialize, Deserialize)]
struct Mark {
    /// File name of the study or scene.
    source: String,
}

/// Marks a folder as incomplete until its results, and their report if there is one, are written. Records of
/// an earlier run in this folder are then not read. Otherwise they would pass for the new results if this run
/// were killed.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn begin(dir: &Path, source: &str) -> Result<(), RecordError> {
    make_dir(dir)?;
    // It would describe files that the run is about to replace.
    remove(&dir.join(DESCRIPTION))?;
    write_json(&dir.join(MARK), &Mark { source: source.to_string() })
}

/// Whether a folder is marked as incomplete.
pub fn is_incomplete(dir: &Path) -> bool {
    dir.join(MARK).exists()
}

/// Removes the mark from results that are complete: all written, or none touched.
///
/// # Errors
/// A mark that cannot be removed.
pub fn end(dir: &Path) -> Result<(), RecordError> {
    remove(&dir.join(MARK))
}

/// Removes a file if it exists.
fn remove(path: &Path) -> Result<(), RecordError> {
    match disk::remove(path) {
        Err(bad) if bad.kind() != io::ErrorKind::NotFound => Err(unwritten(path, bad)),
        _ => Ok(()),
    }
}

/// Writes a run to a folder, which is created if it does not exist. Surface fields of an earlier run there
/// are removed.
///
/// # Errors
/// Invalid records or fields, two records with the same key, or a file that cannot be written.
pub fn write_run(dir: &Path, run: &RunSet) -> Result<(), RecordError> {
    write_marked(dir, run)?;
    end(dir)
}

/// Writes a run as [`write_run`] does, but leaves the folder marked as incomplete, for results whose report
/// is not yet rendered.
pub fn write_marked(dir: &Path, run: &RunSet) -> Result<(), RecordError> {
    run.records.iter().try_for_each(|r| r.check())?;
    run.fields.iter().try_for_each(|f| f.check())?;
    once(&run.records)?;
    for check in &run.checks {
        if let Some(value) = check.value.filter(|v| !v.is_finite()) {
            return Err(RecordError::NotFinite {
                case: check.case.clone(),
                method: check.method.clone(),
                quantity: check.metric.clone(),
                field: "the checked value",
                value,
            });
        }
    }
    begin(dir, &run.provenance.source)?;
    let mut records = run.records.clone();
    records.sort_by(|a, b| a.order(b));
    frame::write(dir, records, &run.provenance)?;
    write_json(&dir.join("provenance.json"), &run.provenance)?;
    write_json(&dir.join("checks.json"), &run.checks)?;
    write_json(&dir.join("plans.json"), &run.plans)?;
    write_json(&dir.join("failures.json"), &run.failures)?;
    write_json(&dir.join("warnings.json"), &run.warnings)?;
    write_json(&dir.join("references.json"), &run.references)?;
    write_json(&dir.join("axes.json"), &run.axes)?;
    write_some(&dir.join(SAMPLES), &run.samples)?;
    write_some(&dir.join(FITS), &run.fits)?;
    let mut csv = String::from("case,method,metric,value,bound,status,reason,runs\n");
    for c in &run.checks {
        let value = c.value.map(|v| format!("{v:e}")).unwrap_or_default();
        csv.push_str(&csv_line(&[
            &c.case,
            &c.method,
            &c.metric,
            &value,
            &c.bound,
            c.status.name(),
            &c.reason,
            &c.runs.join(" "),
        ]));
    }
    write_text(&dir.join("checks.csv"), &csv)?;
    let fields = dir.join("fields");
    make_dir(&fields)?;
    remove_files(&fields, &["json"], &[])?;
    let mut taken = Vec::new();
    for field in &run.fields {
        let name = format!("{}--{}.json", slug(&field.case), slug(&field.method));
        if taken.contains(&name) {
            let reason = format!("another field already has the file name {name}");
            return Err(RecordError::Field {
                case: field.case.clone(),
                method: field.method.clone(),
                reason,
            });
        }
        write_json(&fields.join(&name), field)?;
        taken.push(name);
    }
    Ok(())
}

/// Writes a list, or removes that of an earlier run if it is empty.
fn write_some<T: Serialize>(path: &Path, list: &[T]) -> Result<(), RecordError> {
    match list.is_empty() {
        false => write_json(path, &list),
        true => remove(path),
    }
}

/// Reads a list; none if there is no file.
fn read_some<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, RecordError> {
    if path.exists() { read_json(path) } else { Ok(Vec::new()) }
}

/// Rejects rows with the same key.
fn once(records: &[Record]) -> Result<(), RecordError> {
    let mut seen = HashSet::with_capacity(records.len());
    match records.iter().find(|r| !seen.insert(r.key())) {
        None => Ok(()),
        Some(r) => Err(RecordError::Twice {
            case: r.case.clone(),
            method: r.method.clone(),
            quantity: r.name(),
            run: r.run.clone(),
        }),
    }
}

/// File name of the study or scene whose results are in a folder, or are being computed there; `None` without
/// results.
pub fn source_of(dir: &Path) -> Option<String> {
    let begun = read_json::<Mark>(&dir.join(MARK)).ok().map(|mark| mark.source);
    begun.or_else(|| provenance_of(dir).map(|held| held.source))
}

/// Provenance of the results in a folder, complete or not.
pub fn provenance_of(dir: &Path) -> Option<Provenance> {
    read_json(&dir.join("provenance.json")).ok()
}

/// Reads a run from its folder, with surface fields in the order of their file names.
///
/// # Errors
/// A folder without results or marked as incomplete, or a file that cannot be read.
pub fn read_run(dir: &Path) -> Result<RunSet, RecordError> {
    if is_incomplete(dir) {
        let of = source_of(dir).unwrap_or_else(|| "a study".into());
        return Err(RecordError::Incomplete { path: dir.into(), of });
    }
    read_marked(dir)
}

/// Reads a run as [`read_run`] does, and rejects results without records. `to` is the requested action.
///
/// # Errors
/// As for [`read_run`], and results without records.
pub fn read_numbers(dir: &Path, to: &'static str) -> Result<RunSet, RecordError> {
    let set = read_run(dir)?;
    if set.records.is_empty() { Err(RecordError::Nothing { path: dir.into(), to }) } else { Ok(set) }
}

/// Reads a run as [`read_run`] does, from a folder that may be marked as incomplete.
pub fn read_marked(dir: &Path) -> Result<RunSet, RecordError> {
    let provenance = dir.join("provenance.json");
    if !provenance.exists() {
        return Err(RecordError::NoResults(dir.into()));
    }
    // The version is read first, before any content that may depend on it.
    #[derive(Deserialize)]
    struct Version {
        #[serde(default)]
        format: u32,
    }
    let Version { format } = read_json(&provenance)?;
    if format > FORMAT {
        let reason = format!(
            "has version {format}, but this program reads versions up to {FORMAT}: use a newer version of the program"
        );
        return Err(RecordError::Content { path: provenance, reason });
    }
    let fields_dir = dir.join("fields");
    let fields = if fields_dir.is_dir() { files_ending(&fields_dir, &["json"])? } else { Vec::new() };
    let run = RunSet {
        provenance: read_json(&provenance)?,
        records: frame::read(dir)?,
        checks: read_json(&dir.join("checks.json"))?,
        fields: fields.iter().map(|path| read_json(path)).collect::<Result<_, _>>()?,
        plans: read_json(&dir.join("plans.json"))?,
        failures: read_json(&dir.join("failures.json"))?,
        warnings: read_json(&dir.join("warnings.json"))?,
        references: read_some(&dir.join("references.json"))?,
        axes: read_json(&dir.join("axes.json"))?,
        samples: read_some::<Samples>(&dir.join(SAMPLES))?,
        fits: read_some::<Fit>(&dir.join(FITS))?,
    };
    run.records.iter().try_for_each(|r| r.check())?;
    run.fields.iter().try_for_each(|f| f.check())?;
    Ok(run)
}

/// Creates a folder and its parents.
pub fn make_dir(dir: &Path) -> Result<(), RecordError> {
    fs::create_dir_all(dir).map_err(|source| unwritten(dir, source))
}

/// Writes a file completely or not at all.
///
/// # Errors
/// A file that cannot be written.
pub fn write_text(path: &Path, text: impl AsRef<[u8]>) -> Result<(), RecordError> {
    disk::replace(path, |file| file.write_all(text.as_ref())).map_err(|source| unwritten(path, source))
}

/// Replaces all but ASCII letters (in lower case), digits and dots by dashes, for use as a file name.
pub fn slug(name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || c == '.' { c.to_ascii_lowercase() } else { '-' };
    name.chars().map(safe).collect()
}

/// Removes the files with these suffixes that are not in `kept`, so that no file of an earlier run passes for
/// a current file.
pub fn remove_files(dir: &Path, endings: &[&str], kept: &[PathBuf]) -> Result<(), RecordError> {
    for old in files_ending(dir, endings)?.iter().filter(|old| !kept.contains(old)) {
        disk::remove(old).map_err(|source| unwritten(old, source))?;
    }
    Ok(())
}

/// Returns the files of a folder with these suffixes, in order.
pub fn files_ending(dir: &Path, endings: &[&str]) -> Result<Vec<PathBuf>, RecordError> {
    let io = |source| RecordError::Io { path: dir.into(), source };
    let mut paths = Vec::new();
    for entry in fs::read_dir(dir).map_err(io)? {
        let path = entry.map_err(io)?.path();
        if path.extension().is_some_and(|e| endings.iter().any(|ending| e == *ending)) {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}

fn write_json<T: Serialize>(path: &Path, value: &T) -> Result<(), RecordError> {
    let mut text = serde_json::to_string_pretty(value)
        .map_err(|e| RecordError::Content { path: path.into(), reason: e.to_string() })?;
    text.push('\n');
    write_text(path, text)
}

pub(crate) fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, RecordError> {
    let text = disk::read_text(path, Kind::RESULTS)
        .map_err(|source| RecordError::Io { path: path.into(), source })?;
    serde_json::from_str(&text).map_err(|e| RecordError::Content { path: path.into(), reason: e.to_string() })
}
