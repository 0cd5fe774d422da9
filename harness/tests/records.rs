//! Records of a study: every number once, every repeat, and nothing that depends on the name of a case.

mod common;

use std::collections::HashSet;
use std::path::Path;

use common::{BLOCK, inside, tissuebench, write, written_out};
use records::{Purpose, Record, RunSet, Status, read_run};
use tempfile::TempDir;

fn verified(dir: &TempDir, study: &str, out: &str) -> (RunSet, String) {
    let study = write(dir, &format!("{out}.toml"), study);
    let out = inside(dir, out);
    let done = tissuebench(&["verify", &study, "--out", &out]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    (read_run(Path::new(&out)).unwrap(), out)
}

#[test]
fn a_run_of_several_tables_is_run_once_and_checked_by_each() {
    let dir = tempfile::tempdir().unwrap();
    let block = BLOCK.replace("cells = [2, 2, 1]", "level = 1");
    let scene = write(&dir, "block.toml", &block);
    let bound = |most: f64| format!("[[run.check]]\nmetric = \"max-z\"\nat_most = \"{most} mm\"\n");
    // The run is requested alone, as a level, and at the scene's own Poisson's ratio by number. All three are
    // the same run.
    let text = format!(
        "title = 'Twice'\n[[run]]\nscene = '{scene}'\n{}[[run]]\nscene = '{scene}'\nlevels = [1, 2]\n{}\
         [[run]]\nscene = '{scene}'\npoisson = [0.3, 0.4]\n{}",
        bound(2.0),
        bound(3.0),
        bound(4.0)
    );
    let (set, _) = verified(&dir, &text, "out");
    let runs: HashSet<&str> = set.records.iter().map(|r| r.run.as_str()).collect();
    let max: Vec<&Record> = set.records.iter().filter(|r| r.name() == "max-z").collect();
    assert_eq!((runs.len(), max.len()), (3, 3), "level 1, level 2, and the other ratio");
    let judged: Vec<&str> = set.checks.iter().map(|c| c.bound.as_str()).collect();
    for (bound, times) in [("at most 2e-3", 1), ("at most 3e-3", 2), ("at most 4e-3", 2)] {
        assert_eq!(judged.iter().filter(|b| **b == bound).count(), times, "{bound}: {judged:?}");
    }
    assert!(set.checks.iter().all(|c| c.status == Status::Pass), "{:?}", set.checks);
}

/// Everything that a run does between reading its scene and writing its results belongs to a phase.
#[test]
fn the_phases_of_a_run_add_up_to_its_wall_time() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "block.toml", &BLOCK.replace("cells = [2, 2, 1]", "cells = [24, 24, 12]"));
    let out = inside(&dir, "out");
    let start = std::time::Instant::now();
    let done = tissuebench(&["run", &scene, "--once", "-q", "--out", &out]);
    let wall = start.elapsed().as_secs_f64();
    assert_eq!(done.code, 0, "{}", done.stderr);
    let set = read_run(Path::new(&out)).unwrap();
    let phases: Vec<&Record> = (set.records.iter())
        .filter(|r| r.quantity == "time" && r.statistic == "repeat" && r.phase != "total")
        .collect();
    let names: Vec<&str> = phases.iter().map(|r| r.phase.as_str()).collect();
    assert_eq!(names, ["assemble", "factor", "measure", "mesh", "prepare", "solve"]);
    let sum: f64 = phases.iter().map(|r| r.value).sum();
    // The report and the start of the process belong to no run: some tenths of a second.
    assert!(sum <= wall && sum > 0.5 * (wall - 1.0), "{sum} of {wall} s: {names:?}");
    let run = tissuebench(&["run", &scene, "--once", "-q", "--format", "json"]);
    let object: serde_json::Value = serde_json::from_str(run.stdout.lines().next().unwrap()).unwrap();
    assert!(object["phases"]["mesh"].as_f64().unwrap() > 0.0);
}

#[test]
fn every_repeat_of_a_timing_is_kept_on_both_clocks() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "block.toml", BLOCK);
    let (set, _) = verified(&dir, &format!("title = 'Times'\n[[run]]\nscene = '{scene}'\n"), "out");
    for phase in ["prepare", "assemble", "factor", "solve", "total"] {
        let of = |quantity: &str, statistic: &str| -> Vec<&Record> {
            let fits = |r: &&Record| {
                (r.quantity.as_str(), r.phase.as_str(), r.statistic.as_str()) == (quantity, phase, statistic)
            };
            set.records.iter().filter(fits).collect()
        };
        let repeats = of("time", "repeat");
        // A study repeats short runs five times.
        assert_eq!(
            repeats.iter().map(|r| r.repeat).collect::<Vec<_>>(),
            (1..=5).map(Some).collect::<Vec<_>>()
        );
        let mut seconds: Vec<f64> = repeats.iter().map(|r| r.value).collect();
        seconds.sort_by(f64::total_cmp);
        assert_eq!(
            (of("time", "median")[0].value, of("time", "min")[0].value),
            (seconds[2], seconds[0]),
            "{phase}"
        );
        assert_eq!((of("cpu-time", "repeat").len(), of("cpu-time", "median").len()), (5, 1), "{phase}");
    }
    let solver = set.records[0].linear_solver.as_deref();
    assert!(solver.is_some_and(|name| name.contains("llt")), "{solver:?}");
    let machine = &set.provenance.machine;
    assert!(machine.threads > 0 && machine.load.is_none_or(|load| load >= 0.0));
    assert_eq!(machine.load.is_some(), machine.quiet.is_some());
}

/// Names and contents of the report's tables without times, names of its figures, and headings of its
/// findings.
fn report(out: &str, name: &str) -> Vec<(String, String)> {
    let timed = ["timing", "repeated", "cost", "transfer", "within"];
    let mut all = Vec::new();
    for folder in ["tables", "figures"] {
        for entry in std::fs::read_dir(format!("{out}/report/{folder}")).unwrap() {
            let path = entry.unwrap().path();
            let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
            let read = folder == "tables" && !timed.contains(&stem.as_str());
            let content = if read { std::fs::read_to_string(&path).unwrap() } else { String::new() };
            // A busy machine adds a row to the warnings.
            let content: String =
                content.split_inclusive('\n').filter(|l| !l.contains("machine-busy")).collect();
            let file = path.file_name().unwrap().to_string_lossy().replace(name, "NAME");
            all.push((file, content.replace(name, "NAME")));
        }
    }
    let page = std::fs::read_to_string(format!("{out}/report/report.html")).unwrap();
    all.extend(page.split("\"title\":\"").skip(1).map(|part| {
        let title = part.split('"').next().unwrap_or_default();
        ("title".to_string(), title.replace(name, "NAME"))
    }));
    all.sort();
    all
}

#[test]
fn a_scene_under_another_name_is_the_same_scene() {
    let dir = tempfile::tempdir().unwrap();
    for case in ["pure-bending", "patch-displacement", "bonded-cylinder"] {
        let text = written_out(&format!("{case}.toml"));
        let methods = if case == "bonded-cylinder" { "" } else { "methods = ['tet4', 'hex20']\n" };
        let study = |name: &str| {
            let scene = write(&dir, &format!("{name}.toml"), &text);
            format!("title = 'One'\n[[run]]\nscene = '{scene}'\n{methods}")
        };
        let (before, old) = verified(&dir, &study(case), &format!("{case}-before"));
        // The name contains all words that once had a meaning.
        let name = "rigid-kidney-paper-patch";
        let (after, new) = verified(&dir, &study(name), &format!("{case}-after"));
        let rows = |set: &RunSet| -> Vec<Record> {
            let exact = set.records.iter().filter(|r| !r.is_measured());
            exact.map(|r| Record { case: String::new(), run: String::new(), ..r.clone() }).collect()
        };
        assert!(rows(&before) == rows(&after), "{case}");
        assert_eq!(report(&old, case), report(&new, name), "{case}");
        let purpose = before.records[0].purpose;
        assert_eq!(purpose == Purpose::Patch, case == "patch-displacement", "{case}");
    }
}
