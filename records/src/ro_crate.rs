//! Description of a folder of results as a research object, [RO-Crate 1.2](https://w3id.org/ro/crate/1.2):
//! the program, the run that it made, the scenes, and every file with its media type, size and hash.
//!
//! Results belong to whoever ran the program. The description therefore names no author and no licence.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use disk::Kind;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::error::{RecordError, unwritten};
use crate::provenance::Provenance;
use crate::run_set::{Failure, PlanEntry};
use crate::store::{DESCRIPTION, provenance_of, read_json, write_text};

/// Roles of files, by the beginning of their path.
const ROLES: [(&str, &str); 19] = [
    ("records.csv", "One number per row, SI units"),
    ("records.parquet", "The rows of records.csv for data-frame programs"),
    ("provenance.json", "Program, machine and hashes of the scenes"),
    ("checks.", "Bounds on numbers, with their outcomes"),
    ("plans.json", "Stages of every run, with the reasons why they ran or not"),
    ("failures.json", "Runs that failed or ended early"),
    ("warnings.json", "Warnings about the results of runs"),
    ("references.json", "References of the runs, and their own errors"),
    ("axes.json", "Outcomes of methods along the axes of a study"),
    ("samples.json", "Samples of uncertain inputs with their results"),
    ("fit.json", "Constants fitted to a measured curve"),
    ("fitted", "The scene with the fitted constants"),
    ("fields/", "Displacements of a body for pictures"),
    ("volumes/", "A body at its recorded states, for ParaView"),
    ("tasks/", "Stored results of one run, by which a study is resumed"),
    ("report/report.html", "The report"),
    ("report/credibility.", "Evidence of credibility by the factors of ASME V&V 40"),
    ("report/tables/", "A table of the report"),
    ("report/figures/", "A figure of the report, or its data"),
];

/// Media types by suffix (IANA where registered).
const TYPES: [(&str, &str); 13] = [
    ("csv", "text/csv"),
    ("html", "text/html"),
    ("json", "application/json"),
    ("md", "text/markdown"),
    ("parquet", "application/vnd.apache.parquet"),
    ("pdf", "application/pdf"),
    ("png", "image/png"),
    ("pvd", "application/xml"),
    ("svg", "image/svg+xml"),
    ("tex", "text/x-tex"),
    ("toml", "application/toml"),
    ("vtu", "application/xml"),
    ("xml", "application/xml"),
];

/// Writes the description of a folder of complete results. Call it last: files written afterwards are missing
/// in it.
///
/// # Errors
/// A folder without results, or a file that cannot be read or written.
pub fn describe(dir: &Path) -> Result<(), RecordError> {
    let provenance = provenance_of(dir).ok_or_else(|| RecordError::NoResults(dir.into()))?;
    let mut paths = Vec::new();
    walk(dir, dir, &mut paths).map_err(|source| RecordError::Io { path: dir.into(), source })?;
    paths.sort();
    let files: Vec<Value> = paths
        .iter()
        .map(|path| file(dir, path).map_err(|source| RecordError::Io { path: dir.join(path), source }))
        .collect::<Result<_, _>>()?;
    // The records carry no date, so that equal runs give equal files. Their date is that of their file.
    let written = fs::metadata(dir.join("provenance.json")).and_then(|file| file.modified());
    let written = written.map_err(|source| RecordError::Io { path: dir.into(), source })?;
    let date = humantime::format_rfc3339_seconds(written).to_string();
    let mut graph = about(&provenance, &cases_of(dir)?, &date, &files);
    graph.extend(files);
    let graph = json!({ "@context": "https://w3id.org/ro/crate/1.2/context", "@graph": graph });
    let path = dir.join(DESCRIPTION);
    let text = serde_json::to_string_pretty(&graph).map_err(|bad| unwritten(&path, bad.into()))?;
    write_text(&path, text + "\n")
}

/// Cases with a run: a study may read more scenes than it is asked to run.
fn cases_of(dir: &Path) -> Result<BTreeSet<String>, RecordError> {
    let plans: Vec<PlanEntry> = read_json(&dir.join("plans.json"))?;
    let failures: Vec<Failure> = read_json(&dir.join("failures.json"))?;
    Ok(plans.into_iter().map(|plan| plan.case).chain(failures.into_iter().map(|of| of.case)).collect())
}

/// Collects the files below a folder, relative to the root. Locks (hidden files), links, claims of runs that
/// are under way and the description itself are no results.
fn walk(root: &Path, dir: &Path, paths: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(dir)? {
        let (entry, path) = entry.map(|entry| (entry.file_type(), entry.path()))?;
        let local = path.strip_prefix(root).unwrap_or(&path).to_path_buf();
        let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        let transient = local.starts_with("tasks") && path.extension().is_none_or(|end| end != "json");
        match entry? {
            _ if hidden => {}
            kind if kind.is_dir() => walk(root, &path, paths)?,
            kind if kind.is_file() && !transient && local != Path::new(DESCRIPTION) => paths.push(local),
            _ => {}
        }
    }
    Ok(())
}

/// Description of a file.
fn file(dir: &Path, path: &Path) -> io::Result<Value> {
    let (mut hash, mut size) = (Sha256::new(), 0u64);
    let full = dir.join(path);
    let mut content = disk::open(&full, Kind::HASHED)?;
    let mut chunk = vec![0; 1 << 16];
    loop {
        match content.read(&mut chunk)? {
            0 => break,
            count => {
                hash.update(&chunk[..count]);
                size += count as u64;
            }
        }
    }
    let name = path.to_string_lossy().replace('\\', "/");
    let suffix = path.extension().map(|end| end.to_string_lossy().into_owned()).unwrap_or_default();
    let media = TYPES.iter().find(|(end, _)| *end == suffix);
    let role = ROLES.iter().find(|(begin, _)| name.starts_with(begin));
    Ok(json!({
        "@id": encoded(&name),
        "@type": "File",
        "name": name,
        "description": role.map_or("A file in the folder of results", |(_, role)| role),
        "encodingFormat": media.map_or("application/octet-stream", |(_, media)| media),
        "contentSize": size.to_string(),
        "sha256": hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect::<String>(),
    }))
}

/// A path as a relative URI reference: all but unreserved characters, slashes and non-ASCII letters is
/// escaped.
fn encoded(path: &str) -> String {
    let plain = |c: char| !c.is_ascii() || c.is_ascii_alphanumeric() || "-._~/".contains(c);
    let each = path.chars().map(|c| if plain(c) { c.to_string() } else { format!("%{:02X}", c as u32) });
    each.collect()
}

/// Reference to an entity.
fn id(name: impl Into<String>) -> Value {
    json!({ "@id": name.into() })
}

/// Descriptions of the crate, the program, its run, the scenes of these cases and the licence.
fn about(of: &Provenance, cases: &BTreeSet<String>, date: &str, files: &[Value]) -> Vec<Value> {
    let program = &of.program;
    let source = "#source";
    // The package URL of the program, because the standard requires an address of software.
    let package = format!("pkg:cargo/tissuebench-harness@{}", program.version);
    let scenes: Vec<Value> = of
        .scenes
        .iter()
        .filter(|scene| cases.contains(&scene.case))
        .map(|scene| {
            json!({
                "@id": format!("#scene-{}", encoded(&scene.case)),
                "@type": "CreativeWork",
                "name": scene.case,
                "description": scene.title,
                "identifier": format!("blake3:{}", scene.blake3),
            })
        })
        .collect();
    let objects = [id(source)].into_iter().chain(scenes.iter().map(|scene| json!({ "@id": scene["@id"] })));
    let machine = format!("{}, {} threads", of.machine.processor(), of.machine.threads);
    let altered = if of.set.is_empty() { String::new() } else { format!("; with {}", of.set.join(", ")) };
    let mut graph = vec![
        json!({
            "@id": DESCRIPTION,
            "@type": "CreativeWork",
            "conformsTo": id("https://w3id.org/ro/crate/1.2"),
            "about": id("./"),
        }),
        json!({
            "@id": "./",
            "@type": "Dataset",
            "name": format!("Results of {}", of.source),
            "description": format!(
                "Results of {} by tissuebench {} ({}): numbers, checks, warnings, tables, figures and a report",
                of.source,
                program.version,
                program.revision()
            ),
            "datePublished": date,
            "license": id("#licence"),
            "mentions": id("#run"),
            "hasPart": files.iter().map(|file| json!({ "@id": file["@id"] })).collect::<Vec<_>>(),
        }),
        json!({
            "@id": "#licence",
            "@type": "CreativeWork",
            "name": "No licence stated",
            "description": "The results belong to whoever ran the program. Their owner states a licence and \
                            the authors here before the folder is published.",
        }),
        json!({
            "@id": "#run",
            "@type": "CreateAction",
            "name": format!("tissuebench on {}", of.source),
            "description": format!("On {machine}{altered}"),
            "endTime": date,
            "instrument": id(&package),
            "object": objects.collect::<Vec<_>>(),
            "result": id("./"),
        }),
        json!({
            "@id": package,
            "@type": "SoftwareApplication",
            "name": "tissuebench",
            "url": package,
            "version": format!("{} (commit {})", program.version, program.revision()),
            "description": "Verification and benchmarks of soft-tissue solvers",
            "runtimePlatform": format!("{}, {}", program.target, program.rustc),
        }),
        json!({
            "@id": source,
            "@type": "CreativeWork",
            "name": of.source,
            "description": "The study or scene that was run; it is not part of the folder",
        }),
    ];
    graph.extend(scenes);
    graph
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run_set::RunSet;
    use crate::store::{begin, write_run};

    #[test]
    fn every_file_is_described_once_and_nothing_after_the_next_run_begins() {
        let dir = tempfile::tempdir().unwrap();
        let at = |name: &str| dir.path().join(name);
        write_run(dir.path(), &RunSet::default()).unwrap();
        fs::create_dir(at("tasks")).unwrap();
        for (name, text) in
            [("100 % mine.txt", "abc"), ("tasks/a.json", "{}"), ("tasks/a.claim", ""), (".lock", "1")]
        {
            fs::write(at(name), text).unwrap();
        }
        describe(dir.path()).unwrap();
        // A second time, the description does not describe itself.
        describe(dir.path()).unwrap();
        let text = fs::read_to_string(at(DESCRIPTION)).unwrap();
        let graph: Value = serde_json::from_str(&text).unwrap();
        let entities = graph["@graph"].as_array().unwrap();
        let files: Vec<&Value> = entities.iter().filter(|of| of["@type"] == "File").collect();
        let mine = files.iter().find(|of| of["@id"] == "100%20%25%20mine.txt").unwrap();
        assert_eq!(mine["contentSize"], "3");
        // FIPS 180-2, appendix B.1.
        let hash = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(mine["sha256"], hash);
        let names: BTreeSet<&str> = files.iter().map(|of| of["name"].as_str().unwrap()).collect();
        assert_eq!(names.len(), files.len());
        let known = [
            "100 % mine.txt",
            "axes.json",
            "checks.csv",
            "checks.json",
            "failures.json",
            "plans.json",
            "provenance.json",
            "records.csv",
            "records.parquet",
            "references.json",
            "tasks/a.json",
            "warnings.json",
        ];
        assert_eq!(names, BTreeSet::from(known));
        assert_eq!(entities[1]["hasPart"].as_array().unwrap().len(), files.len());
        begin(dir.path(), "study.toml").unwrap();
        assert!(!at(DESCRIPTION).exists());
    }
}
