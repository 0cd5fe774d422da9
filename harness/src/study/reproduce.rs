//! Stored runs of a study, made again and compared with what is stored.

use std::path::PathBuf;

use clap::Args;
use records::{Machine, Provenance, Record};
use reports::baseline::{Baseline, Change};

use super::args::VerifyArgs;
use super::merge::{Unmerged, noted};
use super::plan::StudyPlan;
use super::store::{Accept, Store};
use super::task::TaskResult;
use crate::error::Failure;
use crate::outcome::provenance;
use crate::run::case_name;

/// Arguments of `reproduce`.
#[derive(Args)]
pub struct ReproduceArgs {
    /// Folder of results, written by `tissuebench verify`
    pub results: PathBuf,
    /// Runs: ids, as in the column `run` of the records, or parts of names, such as "kidney-paper tet4"
    #[arg(value_name = "RUN", required_unless_present = "sample")]
    pub runs: Vec<String>,
    /// Make only N of these runs again, chosen at random
    #[arg(long, value_name = "N")]
    pub sample: Option<usize>,
    /// Seed of the random choice
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Study file, if its path has changed
    #[arg(long, value_name = "FILE")]
    pub study: Option<PathBuf>,
}

/// Stored run of a study.
pub(crate) struct StoredRun {
    index: usize,
    id: String,
    /// Case, method, settings and size.
    pub(crate) name: String,
    result: TaskResult,
}

/// A run and its repetition.
pub(crate) struct Repetition {
    /// Quantities that differ.
    pub(crate) changes: Vec<Change>,
    /// Number of values compared.
    pub(crate) compared: usize,
    /// Whether equal means bit by bit, because the processor is of the same kind.
    pub(crate) bitwise: bool,
    /// Whether the stored run failed, so that there may be no number to compare.
    failed: bool,
    /// Reasons for which the run failed when it was stored, and now, if these differ.
    pub(crate) failures: Option<[String; 2]>,
    /// Times of the stored run and of its repetition, s.
    pub(crate) seconds: [f64; 2],
}

impl Repetition {
    pub(crate) fn is_same(&self) -> bool {
        self.changes.is_empty() && self.failures.is_none() && (self.compared > 0 || self.failed)
    }
}

/// Chosen runs of the study in a folder of results.
pub(crate) struct Chosen {
    plan: StudyPlan,
    args: VerifyArgs,
    /// Program and machine of the stored results.
    pub(crate) from: Provenance,
    pub(crate) runs: Vec<StoredRun>,
}

impl Chosen {
    /// Reads the study of a folder of results, and chooses among the runs that have a stored result.
    ///
    /// # Errors
    /// A folder without a study, a study or scene that cannot be read, and a name that no stored run has.
    pub(crate) fn of(args: &ReproduceArgs) -> Result<Chosen, Unmerged> {
        let refused = |problem: String| Unmerged::Other(Failure::Input(problem));
        let mut note = noted(&args.results).map_err(Unmerged::Other)?;
        note.study = args.study.clone().unwrap_or(note.study);
        let (plan, verify) = note.plan(args.results.clone()).map_err(Unmerged::Scenes)?;
        let from = records::provenance_of(&args.results).unwrap_or_default();
        let stored = plan.stored(&verify).map_err(refused)?;
        let of = format!("{} of {} runs of the study have a stored result", stored.len(), plan.len());
        let fits = |wanted: &str, run: &StoredRun| run.id == wanted || run.name.contains(wanted);
        if let Some(unknown) = args.runs.iter().find(|wanted| !stored.iter().any(|run| fits(wanted, run))) {
            return Err(refused(format!(
                "{}: has no stored run \"{unknown}\"; {of}, and a run whose scene has changed since has none",
                args.results.display()
            )));
        }
        let chosen = |run: &StoredRun| args.runs.is_empty() || args.runs.iter().any(|w| fits(w, run));
        let mut runs: Vec<StoredRun> = stored.into_iter().filter(chosen).collect();
        if let Some(count) = args.sample {
            // A hash of seed and key is as good as a random number, and needs no generator.
            let chance = |run: &StoredRun| {
                blake3::hash(format!("{} {}", args.seed, plan.key(run.index, &verify)).as_bytes())
                    .to_hex()
                    .to_string()
            };
            runs.sort_by_cached_key(chance);
            runs.truncate(count);
        }
        if runs.is_empty() {
            return Err(refused(format!("{}: nothing to make again; {of}", args.results.display())));
        }
        Ok(Chosen { plan, args: verify, from, runs })
    }

    /// Makes a run again, with its reference, and compares it with what is stored.
    pub(crate) fn again(&self, run: &StoredRun) -> Repetition {
        let now = self.plan.run(run.index, &self.args, &mut None);
        let before = &run.result;
        let of = |result: &TaskResult, machine: &Machine| {
            let Machine { cpu, model, instructions, .. } = machine;
            Baseline::of(&numbers_of(result), &format!("{cpu}, {model}, {instructions}"))
        };
        let found = of(before, &self.from.machine).compare(&of(&now, &provenance::machine()), true);
        let reason = |result: &TaskResult| {
            result.failure.as_ref().map_or("none".into(), |(failure, _)| failure.reason.clone())
        };
        let failures = [reason(before), reason(&now)];
        Repetition {
            changes: found.changes,
            compared: found.compared,
            bitwise: found.bitwise,
            failed: before.failure.is_some(),
            failures: (failures[0] != failures[1]).then_some(failures),
            seconds: [before.seconds, now.seconds],
        }
    }
}

/// Records of a run. The results of a sample of uncertain inputs and the constants of a fit, which have no
/// records, become some.
fn numbers_of(result: &TaskResult) -> Vec<Record> {
    let sample = result.sample.iter().flat_map(|sample| &sample.results).copied();
    let fitted = result.fit.iter().flat_map(|fit| fit.constants.iter().map(|of| Some(of.value)));
    let record = |(index, value): (usize, Option<f64>)| {
        let quantity = format!("result-{index}");
        Some(Record { quantity, value: value?, ..Record::default() })
    };
    result.records.iter().cloned().chain((1..).zip(sample.chain(fitted)).filter_map(record)).collect()
}

impl StudyPlan {
    /// The runs that have a stored result, of any build of the program.
    fn stored(&self, args: &VerifyArgs) -> Result<Vec<StoredRun>, String> {
        let store = Store::of(args);
        let mut found = Vec::new();
        for (index, task) in self.tasks.iter().enumerate() {
            let Some(result) = store.load(&self.key(index, args), Accept::AnyBuild)? else { continue };
            let first = result.records.first();
            let case = case_name(&self.scenes[task.scene].2);
            let sample = self.sample(task).map_or(String::new(), |sample| format!(" sample {}", sample + 1));
            let name = first.map_or(format!("{case} {}{sample}", task.method.id), Record::run_name);
            let id = first.map_or(String::new(), |record| record.run.clone());
            found.push(StoredRun { index, id, name, result });
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    const SCENE: &str = include_str!("../../../cases/scenes/first.toml");

    /// Runs two methods of a scene into the folder.
    fn executed(folder: &Path) -> ReproduceArgs {
        let study = folder.join("study.toml");
        let text = "title = \"two\"\n[[run]]\nscene = \"first.toml\"\nmethods = [\"tet10\", \"efg\"]\n";
        std::fs::write(folder.join("first.toml"), SCENE).unwrap();
        std::fs::write(&study, text).unwrap();
        let plan = StudyPlan::new(cases::scene::load_study(&study).unwrap()).unwrap();
        let results = folder.join("results");
        let args = VerifyArgs { out: results.clone(), ..VerifyArgs::of(&study) };
        plan.execute_in_folder(&args, &study, None).unwrap();
        ReproduceArgs { results, runs: Vec::new(), sample: None, seed: 1, study: None }
    }

    fn refused(args: &ReproduceArgs) -> String {
        match Chosen::of(args) {
            Err(Unmerged::Other(failure)) => failure.to_string(),
            Err(Unmerged::Scenes(errors)) => format!("{errors:?}"),
            Ok(chosen) => panic!("{} runs were chosen", chosen.runs.len()),
        }
    }

    #[test]
    fn a_run_made_again_has_the_same_bits_and_a_changed_number_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let mut args = executed(folder.path());
        args.runs = vec!["first tet10".into()];
        let chosen = Chosen::of(&args).unwrap_or_else(|_| panic!("the study is there"));
        assert_eq!(chosen.runs.len(), 1);
        let again = chosen.again(&chosen.runs[0]);
        assert!(again.is_same() && again.bitwise && again.compared > 10, "{:?}", again.changes);

        // By its id, after its first number was stored with another last digit.
        args.runs = vec![chosen.runs[0].id.clone()];
        let mut altered = chosen.runs[0].result.clone();
        let record = altered.records.iter_mut().find(|record| !record.is_measured()).unwrap();
        record.value = f64::from_bits(record.value.to_bits() + 1);
        let key = chosen.plan.key(chosen.runs[0].index, &chosen.args);
        Store::of(&chosen.args).save(&key, &altered).unwrap();
        let chosen = Chosen::of(&args).unwrap_or_else(|_| panic!("the id is known"));
        let again = chosen.again(&chosen.runs[0]);
        assert_eq!(again.changes.len(), 1, "{:?}", again.changes);
    }

    #[test]
    fn only_stored_runs_are_made_again() {
        let folder = tempfile::tempdir().unwrap();
        let mut args = executed(folder.path());
        args.sample = Some(1);
        let one = |seed| {
            let results = args.results.clone();
            let args = ReproduceArgs { results, runs: Vec::new(), sample: Some(1), seed, study: None };
            let chosen = Chosen::of(&args).unwrap_or_else(|_| panic!("the study is there"));
            assert_eq!(chosen.runs.len(), 1);
            chosen.runs[0].name.clone()
        };
        assert!((1..20).any(|seed| one(seed) != one(1)), "every seed chooses {}", one(1));
        args.runs = vec!["hex8".into()];
        let said = refused(&args);
        assert!(said.contains("no stored run \"hex8\"; 2 of 2 runs"), "{said}");
        std::fs::write(folder.path().join("first.toml"), SCENE.replace("1 kPa", "2 kPa")).unwrap();
        args.runs.clear();
        assert!(
            refused(&args).contains("0 of 2 runs of the study have a stored result"),
            "{}",
            refused(&args)
        );
    }
}
