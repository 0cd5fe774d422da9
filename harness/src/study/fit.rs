//! A fit of constants to a measured curve as one task of a study. The runs of each Jacobian are tasks of a
//! study of their own, with its jobs and its store of results.

use std::collections::BTreeMap;
use std::path::PathBuf;

use cases::scene::{self, Fit, FitCheck, FitStatistic, Scene};
use catalogue::Dimension;
use catalogue::metric::{self, Address};
use records::{Check as Verdict, FitConstant, FitPoint, Record};
use uncertainty::{Confidence, Constant, FitError, Fitted, Measured};

use super::args::VerifyArgs;
use super::check;
use super::curve::{Curve, Outside};
use super::plan::StudyPlan;
use super::samples::{by_step, method_name};
use super::task::TaskResult;
use super::tasks::Task;
use crate::error::Failure;
use crate::outcome::Counters;
use crate::run::case_name;

/// Least step of the differences, of the logarithm of a constant. Differences have an error of half a step
/// times the curvature, and of the scatter of the runs over the step. Runs scatter by the tolerance of
/// Newton's method, so that its root balances both; contact that comes and goes adds more.
const LEAST_STEP: f64 = 1e-3;
/// Score of the runs of signs below which residuals are not random: 1 % of all fits by chance.
const NOT_RANDOM: f64 = -2.33;
/// Half of the width of an interval of a logarithm from which the interval spans a factor of four.
const WIDE: f64 = 0.693;

impl StudyPlan {
    /// Whether a task is a fit.
    pub(super) fn is_fit(&self, task: &Task) -> bool {
        self.scenes[task.scene].2.is_fit
    }

    /// Fits the constants of a task's scene.
    pub(super) fn fit(&self, task: &Task, args: &VerifyArgs) -> TaskResult {
        let (path, _, scene) = &self.scenes[task.scene];
        let Some(fit) = &scene.fit else { return TaskResult::default() };
        let mut runs = Runs {
            plan: self,
            args,
            task,
            path,
            scene,
            fit,
            made: 0,
            curves: Vec::new(),
            last: None,
            counters: Counters::default(),
            family: records::Family::default(),
        };
        let constants: Vec<Constant> = fit.keys.iter().map(|key| key.constant).collect();
        let data = Measured { values: &fit.data.y, sd: fit.data.sd.as_deref() };
        let found = uncertainty::fit(&constants, data, step(scene), &mut |sets| runs.at(sets));
        let failure = match found {
            Ok(fitted) if fitted.converged => {
                let fit = runs.record(&fitted);
                return TaskResult { fit: Some(fit), counters: runs.counters, ..TaskResult::default() };
            }
            Ok(fitted) => Failure::Run(format!(
                "the fit did not converge in {} iterations and {} runs, at {}, where the RMS residual is {}; start at other \
                 values, give within = [low, high], or fit fewer constants",
                fitted.iterations,
                fitted.runs,
                fit.keys
                    .iter()
                    .zip(&fitted.values)
                    .map(|(key, value)| format!("{} = {}", key.key, key.written(*value)))
                    .collect::<Vec<_>>()
                    .join(", "),
                records::text::significant(fitted.confidence.rms, 3)
            )),
            Err(FitError::Start) => match runs.last.take() {
                Some(failure) => failure,
                None => Failure::Run("the run at the start values has no results".into()),
            },
            Err(FitError::Derivative(k)) => Failure::Run(format!(
                "the fit has no derivative by {}: the runs at both sides of its value fail{}",
                fit.keys[k].key,
                runs.last.take().map_or(String::new(), |failure| format!(" ({failure})"))
            )),
        };
        TaskResult {
            counters: runs.counters,
            ..TaskResult::failed(&case_name(scene), &task.method, &failure)
        }
    }

    /// Verdicts on a fit.
    pub(super) fn fit_verdicts(&self, task: &Task, result: &TaskResult) -> Vec<Verdict> {
        let scene = &self.scenes[task.scene].2;
        let checks = scene.fit.iter().flat_map(|fit| &fit.checks);
        checks.map(|check| judge(check, scene, task, result)).collect()
    }
}

/// Step of the differences.
fn step(scene: &Scene) -> f64 {
    let tolerance = match &scene.procedure {
        scene::Procedure::Static(of) => of.newton.tolerance,
        scene::Procedure::ImplicitDynamic(of) => of.newton.tolerance,
        _ => 0.0,
    };
    tolerance.sqrt().max(LEAST_STEP)
}

/// Runs of a fit.
struct Runs<'a> {
    plan: &'a StudyPlan,
    args: &'a VerifyArgs,
    task: &'a Task,
    path: &'a PathBuf,
    scene: &'a Scene,
    fit: &'a Fit,
    /// Number of runs so far.
    made: usize,
    /// Curves of the runs that did not fail, with their constants.
    curves: Vec<(Vec<f64>, Curve)>,
    /// Last failure.
    last: Option<Failure>,
    counters: Counters,
    family: records::Family,
}

impl Runs<'_> {
    /// Values of the model at the data for each set of constants.
    fn at(&mut self, sets: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        let mut found = Vec::new();
        let mut plan = StudyPlan::empty(scene::Study {
            title: self.scene.title.clone(),
            scenes: BTreeMap::new(),
            runs: vec![scene::Run::of(self.path)],
        });
        plan.watch = self.plan.watch.clone();
        for set in sets {
            let made = self.scene.with_constants(&self.task.method.id, set, self.made);
            self.made += 1;
            found.push(made.map(|scene| plan.add_run(self.path, scene, self.task)).map_err(|errors| {
                let text: Vec<String> = errors.iter().map(ToString::to_string).collect();
                Failure::Input(text.join("; "))
            }));
        }
        let args = VerifyArgs {
            jobs: self.args.jobs,
            resume: self.args.resume || self.args.join,
            quiet: true,
            out: self.args.out.clone(),
            ..VerifyArgs::of(self.path)
        };
        let (mut results, _) = plan.worked(&args, None);
        let each = sets.iter().zip(found).map(|(set, index)| {
            let result = index.map(|index| results.remove(&index).unwrap_or_default());
            match result.and_then(|result| self.values(set, &result)) {
                Ok(values) => Some(values),
                Err(failure) => {
                    self.last = Some(failure);
                    None
                }
            }
        });
        each.collect()
    }

    /// Values at the data from the result of a run.
    fn values(&mut self, set: &[f64], result: &TaskResult) -> Result<Vec<f64>, Failure> {
        self.counters += result.counters;
        if let Some((failure, code)) = &result.failure {
            let reason = failure.reason.clone();
            return Err(if *code == 2 { Failure::Input(reason) } else { Failure::Run(reason) });
        }
        let data = &self.fit.data;
        self.family = result.records.first().map(|record| record.family).unwrap_or_default();
        let curve = curve(data, &result.records).map_err(|problem| self.refused(&problem))?;
        let each = data.x.iter().zip(&data.lines).map(|(x, line)| {
            curve.at(*x).map_err(|Outside { low, high }| {
                let factor = if data.along.metric.dimension == Dimension::Length { 1e3 } else { 1.0 };
                let unit = if factor == 1.0 { data.along.metric.unit() } else { "mm" };
                let [x, low, high] = [*x, low, high].map(|v| records::text::significant(v * factor, 6));
                self.refused(&format!(
                    "has {} = {x} {unit} in line {line}, and the steps of the run cover {low} to {high} {unit}; extend \
                     the loading, or leave out the row",
                    data.along
                ))
            })
        });
        let values = each.collect::<Result<Vec<f64>, Failure>>()?;
        self.curves.push((set.to_vec(), curve));
        Ok(values)
    }

    fn refused(&self, problem: &str) -> Failure {
        let problem = format!("{}: {problem}", self.fit.data.path.display());
        Failure::Scene(Box::new(self.scene.error(scene::ErrorKind::Invalid, "fit.data", &problem, None)))
    }

    fn record(&self, fitted: &Fitted) -> records::Fit {
        let data = &self.fit.data;
        let curve = self.curves.iter().rev().find(|(set, _)| *set == fitted.values).map(|(_, curve)| curve);
        let constant = |(k, key): (usize, &scene::FittedKey)| FitConstant {
            key: key.key.clone(),
            unit: key.unit.clone(),
            start: key.constant.start,
            value: fitted.values[k],
            interval: fitted.confidence.intervals[k],
            on_bound: fitted.confidence.on_bound[k],
            logarithmic: key.constant.is_logarithmic(),
        };
        let point = |i: usize| FitPoint {
            x: data.x[i],
            measured: data.y[i],
            sd: data.sd.as_ref().map(|sd| sd[i]),
            fitted: fitted.model[i],
        };
        let Confidence { correlation, rms, r2, chi2, freedom, .. } = &fitted.confidence;
        let constants: Vec<FitConstant> = self.fit.keys.iter().enumerate().map(constant).collect();
        let warnings = warnings(&constants, fitted, curve, data);
        records::Fit {
            case: case_name(self.scene),
            method: method_name(self.task),
            family: self.family,
            data: data.path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            along: data.along.to_string(),
            of: data.of.to_string(),
            constants,
            correlation: correlation.clone(),
            points: (0..data.x.len()).map(point).collect(),
            curve: curve.map(|curve| curve.points().to_vec()).unwrap_or_default(),
            rms: *rms,
            r2: *r2,
            chi2: *chi2,
            freedom: *freedom as u64,
            iterations: fitted.iterations as u64,
            runs: fitted.runs as u64,
            warnings,
        }
    }
}

/// Metrics that are zero before the loading begins.
const FROM_ZERO: [&metric::Metric; 9] = [
    &metric::LOAD_CARRIED,
    &metric::CLOSURE,
    &metric::TOOL_FORCE,
    &metric::MEAN,
    &metric::REACTION,
    &metric::PROBE,
    &metric::STRAIN_ENERGY,
    &metric::TOOL_MOMENT,
    &metric::TIME,
];

/// The curve of a run, from the unloaded state if its values are known to be zero there.
fn curve(data: &scene::Measured, records: &[Record]) -> Result<Curve, String> {
    let history = |of: Address| {
        let mut values = by_step(of, records);
        if !values.is_empty() && FROM_ZERO.contains(&of.metric) {
            values.entry(0).or_insert(0.0);
        }
        values
    };
    let (along, of) = (history(data.along), history(data.of));
    for (metric, values) in [(data.along, &along), (data.of, &of)] {
        if values.len() < 2 {
            return Err(format!(
                "{metric} has no history in the runs of this scene; name a metric that every load step has"
            ));
        }
    }
    let points = of.into_iter().filter_map(|(step, y)| Some((*along.get(&step)?, y))).collect();
    Curve::new(points).map_err(|[before, after]| {
        format!("{} goes from {before:e} to {after:e} in a load step of the run; fit along load-carried or time, or the loading only", data.along)
    })
}

/// Reasons to doubt the constants.
fn warnings(
    constants: &[FitConstant],
    fitted: &Fitted,
    curve: Option<&Curve>,
    data: &scene::Measured,
) -> Vec<String> {
    let Confidence { without_influence, collinear, runs_score, chi2, freedom, rms, .. } = &fitted.confidence;
    let mut out = Vec::new();
    let key = |k: usize| constants[k].key.as_str();
    out.extend(
        without_influence
            .iter()
            .map(|&k| format!("{} has no influence on {}: leave it out", key(k), data.of)),
    );
    if let Some(of) = collinear {
        let names: Vec<&str> = of.constants.iter().map(|&k| key(k)).collect();
        let pair = match of.constants[..] {
            [a, b, ..] => format!(", correlation {:.4}", fitted.confidence.correlation[a][b]),
            _ => String::new(),
        };
        let verb = if of.determined { "hardly distinguishes" } else { "does not distinguish" };
        out.push(format!(
            "the curve {verb} {} (collinearity index {:.0}{pair}): fix all but one of them by other tests, or measure a \
             curve on which they act differently",
            names.join(" and "),
            of.index
        ));
    }
    for constant in constants {
        if constant.on_bound {
            out.push(
                format!("{} ends on its bound, {} {}", constant.key, constant.value, constant.unit)
                    .trim_end()
                    .into(),
            );
        }
        let wide =
            constant.interval.filter(|[low, high]| constant.logarithmic && 0.5 * (high / low).ln() > WIDE);
        if wide.is_some() {
            out.push(format!(
                "{} is hardly determined: its interval spans more than a factor of four",
                constant.key
            ));
        }
    }
    if runs_score.is_some_and(|score| score < NOT_RANDOM) {
        out.push("the residuals follow each other: the model, the scene or the mesh is wrong, and the intervals are too narrow".into());
    }
    let spread = 1.0 + 3.0 * (2.0 / *freedom as f64).sqrt();
    if let Some(chi2) = chi2.filter(|chi2| *chi2 > spread) {
        out.push(format!(
            "the residuals are {:.1} times the stated standard deviations: the model or these are wrong",
            chi2.sqrt()
        ));
    }
    let bend = curve.map_or(0.0, |curve| data.x.iter().map(|x| curve.bend(*x)).fold(0.0, f64::max));
    if bend > *rms && bend > 1e-3 * data.y.iter().fold(0.0, |most: f64, y| most.max(y.abs())) {
        out.push(format!(
            "the curve bends between load steps by up to {} {}, more than the residuals: give more steps, best at the \
             measured values of {}",
            records::text::significant(bend, 2),
            data.of.metric.unit(),
            data.along
        ));
    }
    out
}

/// Value of a result of a fit.
fn judge(of: &FitCheck, scene: &Scene, task: &Task, result: &TaskResult) -> Verdict {
    let fit = result.fit.as_ref();
    let constant = fit.and_then(|fit| fit.constants.iter().find(|c| Some(&c.key) == of.key.as_ref()));
    let value = match of.statistic {
        FitStatistic::Value => constant.map(|c| c.value),
        FitStatistic::HalfWidth => constant.and_then(FitConstant::half_width),
        FitStatistic::R2 => fit.map(|fit| fit.r2),
        FitStatistic::Rms => fit.map(|fit| fit.rms),
        FitStatistic::Runs => fit.map(|fit| fit.runs as f64),
    };
    let bound = scene::Check {
        address: metric::LOAD_CARRIED.whole(),
        methods: Vec::new(),
        bound: of.bound.clone(),
        at: of.at.clone(),
    };
    let (case, method) = (case_name(scene), method_name(task));
    let verdict = match &result.failure {
        Some((failure, _)) => check::not_run(&bound, &case, &method, &failure.reason),
        None => check::judge(&bound, &case, &method, value, None),
    };
    let key = of.key.as_ref().map_or(String::new(), |key| format!(" of {key}"));
    Verdict { metric: format!("fit {}{key}", of.statistic.name()), ..verdict }
}
