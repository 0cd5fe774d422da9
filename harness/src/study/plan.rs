//! The runs of a study, with their scenes.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use cases::scene::{self, ErrorKind, Scene, Study};
use rayon::prelude::*;
use records::Record;

use super::args::VerifyArgs;
use super::filters;
use super::tasks::{Known, Task, list};
use super::trials::RefusedScene;
use crate::measure::Repeats;
use crate::outcome::Watch;
use crate::run::case_name;
use crate::scenario::too_large;

/// Repeats of the timed part in a study: the median of five short passes, or a single long pass.
const REPEATS: Repeats = Repeats { most: 5, seconds: 0.4 };
/// Repeats in the quick tier, whose purpose is the checks: the median of three passes for runs below 20 ms.
const QUICK: Repeats = Repeats { most: 3, seconds: 0.05 };

/// Study with its parsed scenes.
pub struct StudyPlan {
    pub(super) study: Study,
    pub(super) scenes: Vec<(PathBuf, String, Scene)>,
    /// Indices of the unmodified scenes, by path.
    pub(super) as_they_are: BTreeMap<PathBuf, usize>,
    /// Files of the cases, by case name.
    pub(super) cases: BTreeMap<String, PathBuf>,
    pub(super) tasks: Vec<Task>,
    /// Axis values at which the scene is refused.
    pub(super) refused: Vec<RefusedScene>,
    /// Watch of the runs.
    pub(super) watch: Option<Arc<Watch>>,
}

impl StudyPlan {
    /// Reads the scenes of a study and lists its runs. The errors are those of all scenes.
    pub fn new(study: Study) -> Result<StudyPlan, Vec<scene::SceneError>> {
        StudyPlan::read(study, |_| true, |count| 0..count)
    }

    /// Reads only the scene of these run tables, or one sample of its uncertain inputs, and lists the runs
    /// that they request.
    pub(crate) fn of_tables(
        study: Study,
        tables: &[usize],
        sample: Option<u32>,
    ) -> Result<StudyPlan, Vec<scene::SceneError>> {
        let one = |_| sample.map_or(0..0, |sample| sample..sample + 1);
        let first = tables.first().and_then(|&table| study.runs.get(table));
        let scene = first.map(|run| run.scene.clone());
        let mut plan = StudyPlan::read(study, |run| Some(&run.scene) == scene.as_ref(), one)?;
        plan.tasks.retain_mut(|task| {
            task.runs.retain(|run| tables.contains(run));
            !task.runs.is_empty()
        });
        Ok(plan)
    }

    /// Reads the scenes of the run tables for which `wanted` returns true, with those of the samples of their
    /// uncertain inputs that `sampled` returns for the number of samples.
    fn read(
        study: Study,
        wanted: impl Fn(&scene::Run) -> bool,
        sampled: impl Fn(u32) -> Range<u32>,
    ) -> Result<StudyPlan, Vec<scene::SceneError>> {
        let mut plan = StudyPlan::empty(study);
        let mut errors = Vec::new();
        let mut known = Known::default();
        let runs = plan.study.runs.clone();
        for (index, run) in runs.iter().enumerate().filter(|(_, run)| wanted(run)) {
            let read = match &run.axis {
                None => plan.scene(run).and_then(|at| plan.with_samples(run, at, &sampled)),
                Some(axis) => plan.along(index, run, axis),
            };
            match read {
                Ok(found) => {
                    for at in found {
                        list(&mut plan.tasks, &mut known, index, at, run, &plan.scenes[at].2);
                    }
                }
                Err(bad) => errors.extend(bad),
            }
        }
        if errors.is_empty() { Ok(plan) } else { Err(errors) }
    }

    /// A plan without tasks.
    pub(super) fn empty(study: Study) -> StudyPlan {
        StudyPlan {
            study,
            scenes: Vec::new(),
            as_they_are: BTreeMap::new(),
            cases: BTreeMap::new(),
            tasks: Vec::new(),
            refused: Vec::new(),
            watch: None,
        }
    }

    /// Adds a run of a scene by the method of a task of another plan, and returns its index.
    pub(super) fn add_run(&mut self, path: &Path, scene: Scene, like: &Task) -> usize {
        self.scenes.push((path.to_path_buf(), scene.text().to_string(), scene));
        self.tasks.push(Task {
            runs: vec![0],
            scene: self.scenes.len() - 1,
            method: like.method.clone(),
            level: like.level,
            poisson: like.poisson,
            picture: false,
            split: None,
        });
        self.tasks.len() - 1
    }

    /// Reads the unmodified scene of a run table.
    fn read_scene(&self, run: &scene::Run) -> Result<Scene, Vec<scene::SceneError>> {
        match self.study.scenes.get(&run.scene) {
            Some(scene) => Ok(scene.clone()),
            None => scene::load(&run.scene),
        }
    }

    /// Index of a run table's unmodified scene, which is read if necessary.
    fn scene(&mut self, run: &scene::Run) -> Result<usize, Vec<scene::SceneError>> {
        if let Some(&at) = self.as_they_are.get(&run.scene) {
            return Ok(at);
        }
        let at = self.add(&run.scene, self.read_scene(run)?)?;
        self.as_they_are.insert(run.scene.clone(), at);
        Ok(at)
    }

    fn add(&mut self, path: &Path, scene: Scene) -> Result<usize, Vec<scene::SceneError>> {
        if !scene.unavailable().is_empty() {
            return Err(scene.unavailable());
        }
        let other = self.cases.entry(case_name(&scene)).or_insert_with(|| path.into());
        if other != path {
            let problem = format!("is in a file with the same name as {}", other.display());
            let help = "rename one of the files: results are stored under the names of scenes";
            return Err(vec![scene.error(ErrorKind::Invalid, "title", &problem, Some(help))]);
        }
        let text = scene.text().to_string();
        self.scenes.push((path.to_path_buf(), text, scene));
        Ok(self.scenes.len() - 1)
    }

    /// Index of a scene, and those of the samples of its uncertain inputs and of its fit if it has any. Along
    /// an axis a scene is neither sampled nor fitted.
    fn with_samples(
        &mut self,
        run: &scene::Run,
        at: usize,
        sampled: impl Fn(u32) -> Range<u32>,
    ) -> Result<Vec<usize>, Vec<scene::SceneError>> {
        let base = &self.scenes[at].2;
        let indices = sampled(base.vary.as_ref().map_or(0, |vary| vary.samples));
        let samples: Vec<Result<Scene, Vec<scene::SceneError>>> =
            indices.into_par_iter().map(|index| base.at_sample(&run.methods, index)).collect();
        let mut found = vec![at];
        for sample in samples {
            found.push(self.add(&run.scene, sample?)?);
        }
        if let Some(fit) = self.scenes[at].2.to_fit() {
            found.push(self.add(&run.scene, fit)?);
        }
        Ok(found)
    }

    /// Adds the scene at each value of an axis. A refused scene is an error only at the base value.
    fn along(
        &mut self,
        index: usize,
        run: &scene::Run,
        axis: &scene::Axis,
    ) -> Result<Vec<usize>, Vec<scene::SceneError>> {
        let base = self.read_scene(run)?;
        let mut found = Vec::new();
        for &value in &axis.values {
            match axis.at(&base, &run.methods, value) {
                Ok(scene) => found.push(self.add(&run.scene, scene)?),
                Err(bad) if value == axis.base => return Err(bad),
                Err(bad) => {
                    let reason = bad.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
                    self.refused.push(RefusedScene { run: index, value, reason });
                }
            }
        }
        Ok(found)
    }

    /// Keeps the runs that the arguments select.
    pub fn select(&mut self, args: &VerifyArgs) {
        let runs = &self.study.runs;
        let scenes = &self.scenes;
        self.tasks.retain_mut(|task| {
            task.runs.retain(|&run| !args.quick || runs[run].quick);
            let case = case_name(&scenes[task.scene].2);
            let method = &task.method.id;
            let contains = |text: &str| case.contains(text) || method.contains(text);
            let tags = filters::tags(task, runs, &scenes[task.scene].2);
            !task.runs.is_empty()
                && args.filter.as_deref().is_none_or(contains)
                && args.filters.fits(&case, method, &tags)
        });
        if let Some(shard) = args.shard {
            let mine = self.share(args, shard);
            let mut index = 0..;
            self.tasks.retain(|_| index.next().is_some_and(|index| mine.contains(&index)));
        }
    }

    /// Errors of the runs that exceed the limits on memory or time.
    pub(crate) fn too_large(&self, args: &VerifyArgs) -> Vec<scene::SceneError> {
        let foreseen = self.foreseen(args);
        let of =
            |task: &Task| too_large(&self.scenes[task.scene].2, &task.method, foreseen.factor(task.scene));
        self.tasks.iter().filter_map(of).collect()
    }

    /// Run tables that request a task.
    pub(super) fn tables<'a>(&'a self, task: &'a Task) -> impl Iterator<Item = &'a scene::Run> {
        task.runs.iter().map(|&run| &self.study.runs[run])
    }

    /// Whether the task is requested only as one of many clouds.
    pub(super) fn is_one_of_many(&self, task: &Task) -> bool {
        self.tables(task).all(|run| run.seeds > 0)
    }

    /// Number of the task's sample of uncertain inputs, from 0; `None` for any other run.
    pub(super) fn sample(&self, task: &Task) -> Option<u32> {
        self.scenes[task.scene].2.sample
    }

    /// Whether a task is a run along an axis, a sample of uncertain inputs, or a fit or one of its runs.
    pub(super) fn is_driven(&self, task: &Task) -> bool {
        self.scenes[task.scene].2.varied.is_some()
    }

    /// Whether the results of a task are those of a sample or of a fit, which are no records of its case.
    pub(super) fn is_apart(&self, task: &Task) -> bool {
        self.sample(task).is_some() || self.is_fit(task)
    }

    /// Repeats of the timed part of a task. The time of a sample or of a run of a fit is of no interest.
    pub(super) fn repeats(&self, task: &Task, args: &VerifyArgs) -> Repeats {
        let driven = self.is_driven(task) && self.tables(task).all(|run| run.axis.is_none());
        match (driven, args.quick) {
            (true, _) => Repeats::ONCE,
            (false, true) => QUICK,
            (false, false) => REPEATS,
        }
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.tasks.len()
    }

    /// Whether nothing is to be run.
    pub fn is_empty(&self) -> bool {
        self.tasks.is_empty()
    }
}

/// Method id with the settings that distinguish the run from others of the same method.
pub(super) fn label(task: &Task, records: &[Record], seeded: bool) -> String {
    let mut text = task.method.id.clone();
    if task.level > 0 {
        text += &format!(" level {}", task.level);
    }
    if let (Some(first), 0) = (records.first(), task.level) {
        text += &format!(" {} {} nodes", first.variant, first.nodes);
    }
    if let Some(poisson) = task.poisson {
        text += &format!(" nu={poisson}");
    }
    if seeded {
        text += &format!(" seed={}", records.first().map_or(0, |r| r.seed));
    }
    text
}
