//! Samples of uncertain inputs: the results that are kept of each, and the checks of their statistics.

use std::collections::BTreeMap;

use cases::scene::{Scene, Statistic, StatisticCheck, Vary};
use catalogue::metric::{self, Address, Metric};
use records::{Check as Verdict, Input, Output, Record, RunSet, Sample, SampleResults, Samples};
use reports::Uncertain;

use super::check;
use super::plan::StudyPlan;
use super::task::TaskResult;
use super::tasks::Task;
use crate::run::case_name;

/// Metrics with an estimate of their numerical error: the value, its relative error, the predicted value that
/// the error is relative to.
const ESTIMATED: [[&Metric; 3]; 3] = [
    [&metric::TOOL_FORCE, &metric::TOOL_FORCE_ESTIMATE, &metric::TOOL_FORCE_PREDICTED],
    [&metric::FREQUENCY, &metric::FREQUENCY_ESTIMATE, &metric::FREQUENCY_PREDICTED],
    [&metric::STRAIN_ENERGY, &metric::STRAIN_ENERGY_ESTIMATE, &metric::STRAIN_ENERGY_PREDICTED],
];

/// The result of a sample with only the metrics of its scene: 100,000 samples with all records would take
/// more memory than most machines have.
pub(super) fn condensed(vary: &Vary, result: TaskResult) -> TaskResult {
    let records = &result.records;
    let results = vary.of.iter().map(|of| check::value(*of, records)).collect();
    let curves = vary.of.iter().map(|of| curve(*of, records)).collect();
    let sample = (!records.is_empty()).then_some(SampleResults { results, curves });
    let TaskResult { warnings, failure, seconds, counters, .. } = result;
    TaskResult { sample, warnings, failure, seconds, counters, ..TaskResult::default() }
}

/// Values of a metric by step.
pub(super) fn by_step(of: Address, records: &[Record]) -> BTreeMap<u64, f64> {
    let own = |r: &&Record| r.is(of) && r.statistic == "value";
    records.iter().filter(own).filter_map(|r| Some((r.step?, r.value))).collect()
}

/// History of a metric over the closure of the tool, or over time without a tool; empty without a history.
fn curve(of: Address, records: &[Record]) -> Vec<(f64, f64)> {
    let values = by_step(of, records);
    let closing = by_step(metric::CLOSURE.whole(), records);
    let along = if closing.is_empty() { by_step(metric::TIME.whole(), records) } else { closing };
    values.into_iter().filter_map(|(step, value)| Some((*along.get(&step)?, value))).collect()
}

/// Absolute numerical error of a metric, SI; `None` if the run has no estimate.
pub fn numerical(of: Address, records: &[Record]) -> Option<f64> {
    let [_, error, predicted] = ESTIMATED.iter().find(|[value, ..]| *value == of.metric)?;
    let value = |metric: &'static Metric| check::value(Address { metric, ..of }, records);
    Some((value(error)? * value(predicted)?).abs())
}

impl StudyPlan {
    /// Samples of every scene with uncertain inputs, by method, size and Poisson's ratio.
    pub(super) fn samples(&self, results: &BTreeMap<usize, TaskResult>) -> Vec<Samples> {
        let mut out: Vec<(Samples, &Task)> = Vec::new();
        let sampled = results.iter().filter_map(|(&index, result)| {
            let task = &self.tasks[index];
            let scene = &self.scenes[task.scene].2;
            Some((task, result, scene, scene.vary.as_ref()?, scene.sample?))
        });
        for (task, result, scene, vary, index) in sampled {
            let same = |(_, first): &&mut (Samples, &Task)| {
                self.scenes[first.scene].0 == self.scenes[task.scene].0 && is_same(first, task)
            };
            let sample = Sample {
                sample: index + 1,
                values: vary.values(index),
                results: result.sample.clone().unwrap_or_default(),
                warnings: result.warnings.iter().map(|w| w.code.clone()).collect(),
                failure: result.failure.as_ref().map_or(String::new(), |(failure, _)| failure.reason.clone()),
            };
            match out.iter_mut().find(same) {
                Some((samples, _)) => samples.samples.push(sample),
                None => out.push((self.begun(task, scene, vary, sample, results), task)),
            }
        }
        out.into_iter().map(|(samples, _)| samples).collect()
    }

    /// The samples of a method, with the first of them.
    fn begun(
        &self,
        task: &Task,
        scene: &Scene,
        vary: &Vary,
        first: Sample,
        results: &BTreeMap<usize, TaskResult>,
    ) -> Samples {
        let as_written = |(index, _): &(&usize, &TaskResult)| {
            let other = &self.tasks[**index];
            let (path, _, of) = &self.scenes[other.scene];
            of.varied.is_none() && *path == self.scenes[task.scene].0 && is_same(other, task)
        };
        let nominal: &[Record] = results.iter().find(as_written).map_or(&[], |(_, result)| &result.records);
        let input = |key: &cases::scene::VariedKey| Input {
            key: key.key.clone(),
            unit: key.unit.clone(),
            distribution: key.distribution.clone(),
        };
        let output = |of: &Address| Output {
            name: of.to_string(),
            nominal: check::value(*of, nominal),
            numerical: numerical(*of, nominal),
        };
        let along = if scene.tools.is_empty() { &metric::TIME } else { &metric::CLOSURE };
        Samples {
            case: case_name(scene),
            method: method_name(task),
            run: nominal.first().map(|record| record.run.clone()).unwrap_or_default(),
            family: nominal.first().map(|record| record.family).unwrap_or_default(),
            inputs: vary.keys.iter().map(input).collect(),
            seed: uncertainty::SEED,
            outputs: vary.of.iter().map(output).collect(),
            along: along.name.into(),
            samples: vec![first],
        }
    }

    /// Verdicts on the statistics of every scene with uncertain inputs of which all samples were run. A share
    /// of a study has none: they are made when the shares are merged.
    pub(super) fn statistic_verdicts(&self, set: &RunSet) -> Vec<Verdict> {
        let all = reports::uncertain(set);
        let mut out = Vec::new();
        for of in &all {
            let own = |scene: &&Scene| scene.sample.is_none() && case_name(scene) == of.of.case;
            let scene = self.scenes.iter().map(|(_, _, scene)| scene).find(own);
            let vary = scene.and_then(|scene| scene.vary.as_ref());
            let vary = vary.filter(|vary| of.of.samples.len() == vary.samples as usize);
            let checks = vary.map_or(&[][..], |vary| &vary.checks);
            out.extend(
                checks.iter().filter(|c| c.address.to_string() == of.output.name).map(|c| judge(c, of)),
            );
        }
        out
    }

    /// Exit codes of the methods of which no sample gave a result.
    pub(super) fn without_samples(&self, set: &RunSet, results: &BTreeMap<usize, TaskResult>) -> Vec<u8> {
        let none = |samples: &&Samples| samples.samples.iter().all(|s| s.results.results.is_empty());
        let code = |samples: &Samples| {
            let own = |index: &usize| {
                let task = &self.tasks[*index];
                let case = case_name(&self.scenes[task.scene].2);
                self.sample(task).is_some() && case == samples.case && method_name(task) == samples.method
            };
            let failed = |(index, result): (&usize, &TaskResult)| {
                result.failure.as_ref().filter(|_| own(index)).map(|(_, code)| *code)
            };
            results.iter().find_map(failed)
        };
        set.samples.iter().filter(none).filter_map(code).collect()
    }
}

/// Id of a task's method, with its size and Poisson's ratio if a study varies them.
pub(super) fn method_name(task: &Task) -> String {
    let level = if task.level > 0 { format!(" level {}", task.level) } else { String::new() };
    let poisson = task.poisson.map_or(String::new(), |poisson| format!(" nu={poisson}"));
    format!("{}{level}{poisson}", task.method.id)
}

/// Whether two tasks of a scene differ at most in their sample.
fn is_same(one: &Task, other: &Task) -> bool {
    one.method == other.method && one.level == other.level && one.poisson == other.poisson
}

/// Value of a statistic.
fn statistic(check: &StatisticCheck, of: &Uncertain) -> Option<f64> {
    let found = of.statistics.as_ref();
    let index = || {
        let at = of.of.inputs.iter().position(|input| Some(&input.key) == check.key.as_ref())?;
        found?.indices.get(at)
    };
    match check.statistic {
        Statistic::Mean => found.map(|s| s.mean.value),
        Statistic::Sd => found.map(|s| s.sd.value),
        Statistic::P5 => found.map(|s| s.quantiles[0].value),
        Statistic::P50 => found.map(|s| s.quantiles[1].value),
        Statistic::P95 => found.map(|s| s.quantiles[2].value),
        Statistic::Q2 => found.and_then(|s| s.q2),
        Statistic::First => index().map(|index| index.first.value),
        Statistic::Total => index().map(|index| index.total.value),
        Statistic::Missing => Some(of.missing as f64),
    }
}

fn judge(check: &StatisticCheck, of: &Uncertain) -> Verdict {
    let bound = cases::scene::Check {
        address: check.address,
        methods: Vec::new(),
        bound: check.bound.clone(),
        at: check.at.clone(),
    };
    let verdict = super::check::judge(&bound, &of.of.case, &of.of.method, statistic(check, of), None);
    let key = check.key.as_ref().map_or(String::new(), |key| format!(" of {key}"));
    Verdict { metric: format!("{} {}{key}", check.address, check.statistic.name()), ..verdict }
}
