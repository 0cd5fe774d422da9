//! The project's own verification, held against its scenes and its baseline.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use cases::scene;

use super::{Plan, Task, VerifyArgs, case_name, check};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn verification() -> Plan {
    let study = scene::load_study(&root().join("cases/studies/verify.toml")).expect("a sound study");
    Plan::new(study).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// Whether any check, of its own or of many runs together, is of a task.
fn is_checked(plan: &Plan, task: &Task) -> bool {
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
