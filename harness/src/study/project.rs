//! Tests of the project's own verification study against its scenes and its baseline.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use cases::scene;

use super::check;
use super::plan::StudyPlan;
use super::tasks::Task;
use crate::run::case_name;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn verification() -> StudyPlan {
    let study = scene::load_study(&root().join("cases/studies/verify.toml")).expect("a sound study");
    StudyPlan::new(study).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// Whether any check applies to a task, either a check of one run or of several runs together. Statistics are
/// of the samples together.
fn is_checked(plan: &StudyPlan, task: &Task) -> bool {
    if plan.sample(task).is_some() {
        let vary = plan.scenes[task.scene].2.vary.as_ref();
        return vary.is_some_and(|vary| !vary.checks.is_empty());
    }
    if plan.is_fit(task) {
        return plan.scenes[task.scene].2.fit.as_ref().is_some_and(|fit| !fit.checks.is_empty());
    }
    let of_tables = plan.tables(task).flat_map(|run| &run.checks).filter(|check| check::is_of_many(check));
    let mut of_tables = of_tables.filter(|c| c.methods.is_empty() || c.methods.contains(&task.method.id));
    plan.checks(task).next().is_some() || of_tables.next().is_some()
}

#[test]
fn every_run_of_the_verification_is_checked() {
    let plan = verification();
    let unchecked = plan.tasks.iter().filter(|task| !is_checked(&plan, task));
    let case = |task: &Task| case_name(&plan.scenes[task.scene].2);
    let named: BTreeSet<String> = unchecked.map(|t| format!("{} {}", case(t), t.method.id)).collect();
    assert!(named.is_empty(), "no check is of\n{}", named.into_iter().collect::<Vec<_>>().join("\n"));
}

/// Collects the scenes in a folder and its subfolders.
fn scenes(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            scenes(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            found.push(path);
        }
    }
}

#[test]
fn every_scene_of_the_project_has_a_check_of_what_it_is_for() {
    let study = verification().study;
    let mut paths = Vec::new();
    scenes(&root().join("cases/scenes"), &mut paths);
    assert!(paths.len() > 30, "{}", paths.len());
    for path in paths {
        let same = |run: &&scene::Run| run.scene.file_name() == path.file_name();
        let in_study = study.runs.iter().filter(same).any(|run| !run.checks.is_empty());
        let own = scene::load(&path).map(|scene| !scene.checks.is_empty()).unwrap_or_default();
        assert!(own || in_study, "{} and its runs have no check", path.display());
    }
}

#[test]
fn the_quick_tier_has_the_cases_of_the_baseline_and_no_others() {
    let path = root().join("tests/baseline/quick");
    let baseline = reports::baseline::Baseline::load(&path).expect("a baseline");
    // A run's name begins with its case.
    let accepted: BTreeSet<&str> = baseline.runs.keys().filter_map(|run| run.split(' ').next()).collect();
    let StudyPlan { study, scenes, .. } = verification();
    let quick = study.runs.iter().filter(|run| run.quick).filter_map(|run| run.scene.file_stem()?.to_str());
    let mut expected: BTreeSet<&str> = quick.collect();
    // Stored references belong to both tiers.
    let stored = |scene: &&scene::Scene| matches!(scene.reference, Some(scene::Reference::Record(_)));
    let referenced: Vec<String> =
        scenes.iter().map(|(.., scene)| scene).filter(stored).map(case_name).collect();
    expected.extend(referenced.iter().map(String::as_str));
    assert_eq!(accepted, expected, "the baseline's, and those of the quick tier and with a stored reference");
}
