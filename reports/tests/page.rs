//! The page's script is built from its sources, and a method looks the same wherever it is drawn.

mod common;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use records::{RunSet, write_run};
use tissuebench_reports::render;

/// Hash of the sources, as computed by `page/build.mjs`: FNV-1a over their bytes, in the order of their
/// names.
fn hash_of_sources(page: &Path) -> u64 {
    let source = |entry: fs::DirEntry| entry.file_name().into_string().unwrap();
    let mut names: Vec<String> = fs::read_dir(page.join("src"))
        .unwrap()
        .map(|entry| source(entry.unwrap()))
        .filter(|name| name.ends_with(".ts"))
        .map(|name| format!("src/{name}"))
        .collect();
    names.sort();
    names.extend(["build.mjs", "package-lock.json", "package.json", "tsconfig.json"].map(String::from));
    let bytes = names.iter().flat_map(|name| fs::read(page.join(name)).unwrap());
    bytes.fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}

#[test]
fn the_script_is_built_from_its_sources() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("page");
    let expected = format!("// sources {:016x}", hash_of_sources(&page));
    for built in ["page.js", "solid.js"] {
        let script = fs::read_to_string(page.join("built").join(built)).unwrap();
        assert_eq!(
            script.lines().next(),
            Some(expected.as_str()),
            "reports/page was changed since built/{built} was built from it: run `npm ci && npm run build` there"
        );
    }
}

/// Collects the colours of the markers and lines before each label in a figure's legend.
fn looks(svg: &str, found: &mut BTreeMap<String, BTreeSet<String>>, labels: &BTreeSet<String>) {
    let mut before: Vec<&str> = Vec::new();
    for tag in svg.split('<') {
        let Some((open, content)) = tag.split_once('>') else { continue };
        if open.starts_with("text") {
            if labels.contains(content.trim()) && !before.is_empty() {
                let colours = before.iter().flat_map(|shape| shape.split('"').filter(|w| w.starts_with('#')));
                // White is the paper inside an open marker, or the rim of a filled one.
                let own: BTreeSet<&str> = colours.filter(|c| *c != "#FFFFFF").collect();
                found.entry(content.trim().into()).or_default().insert(format!("{own:?}"));
            }
            before.clear();
        } else if !open.starts_with('/') {
            before.push(open);
            // A legend entry is a dashed line, a marker and its rim.
            before = before.split_off(before.len().saturating_sub(2));
        }
    }
}

#[test]
fn a_method_looks_the_same_in_all_figures_of_all_reports() {
    let study = common::study();
    let mut found = BTreeMap::new();
    // The whole study, and each of its cases alone: other methods in a figure must not matter.
    let mut cases: Vec<String> = study.records.iter().map(|r| r.case.clone()).collect();
    cases.dedup();
    let alone = cases.iter().map(|case| {
        let mut set = RunSet {
            provenance: study.provenance.clone(),
            records: study.records.clone(),
            ..RunSet::default()
        };
        set.records.retain(|r| &r.case == case);
        set
    });
    let labels: BTreeSet<String> = study.records.iter().map(|r| r.series.clone()).collect();
    let mut seen = 0;
    for set in std::iter::once(study.clone()).chain(alone) {
        let dir = tempfile::tempdir().unwrap();
        write_run(dir.path(), &set).unwrap();
        let rendered = render(dir.path(), dir.path()).unwrap();
        let drawn = |f: &&std::path::PathBuf| {
            let name = f.file_stem().unwrap().to_string_lossy().into_owned();
            f.extension().is_some_and(|e| e == "svg")
                && ["efficiency", "convergence", "locking", "tool-force"]
                    .iter()
                    .any(|of| name.starts_with(of))
        };
        for svg in rendered.files.iter().filter(drawn) {
            looks(&fs::read_to_string(svg).unwrap(), &mut found, &labels);
            seen += 1;
        }
    }
    assert!(seen > 20 && found.len() > 5, "{seen} figures, {found:?}");
    for (label, looks) in &found {
        assert_eq!(looks.len(), 1, "{label}: {looks:?}");
    }
    assert_ne!(found["tet4"], found["hex20"]);
}
