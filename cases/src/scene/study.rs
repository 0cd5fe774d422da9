//! Studies: many scenes and methods, with their variations and checks.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Deserialize;

use catalogue::metric::Needs;
use catalogue::{Problem, Values};

use super::axis::{Axis, AxisKeys};
use super::check::{Check, CheckKeys};
use super::coverage::{self, LeftOutKeys};
use super::demands::{self, known_methods};
use super::document;
use super::error::SceneError;
use super::load::{load, text_of};
use super::method::{
    ADAPTERS, Efg, Essential, EssentialKeys, Family, Integration, IntegrationKeys, Method, NO_ADAPTER,
    is_adapter,
};
use super::report::Report;
use super::scene::Scene;
use super::vocabulary::{Kernels, Word};

/// A study: runs of scenes, with their variations and checks.
#[derive(Clone, Debug)]
pub struct Study {
    /// Title of the study in one line.
    pub title: String,
    /// Scenes of the runs by path, without the scenes that can't be read. The run reads such a scene again
    /// and reports the reason.
    pub scenes: BTreeMap<PathBuf, Scene>,
    /// Runs in their order.
    pub runs: Vec<Run>,
}

/// One scene with its variations: methods times levels (or node counts) times kernels times support scales
/// times essential conditions times seeds times Poisson's ratios.
#[derive(Clone, Debug)]
pub struct Run {
    /// The scene file.
    pub scene: PathBuf,
    /// Ids of the methods; empty for all.
    pub methods: Vec<String>,
    /// External solvers, by adapter name, that also solve each plain finite-element method.
    pub adapters: Vec<String>,
    /// Levels in place of the methods' own sizes; empty for their own.
    pub levels: Vec<u32>,
    /// Poisson's ratios in place of the scene's ratio; empty for its own.
    pub poisson: Vec<f64>,
    /// Node counts of clouds; empty for their own.
    pub nodes: Vec<usize>,
    /// Kernels of clouds; empty for their own.
    pub kernels: Vec<efg::Kernel>,
    /// Support scales of clouds, support radius over the local spacing; empty for their own supports.
    pub support_scales: Vec<f64>,
    /// Essential conditions of clouds; empty for their own.
    pub essentials: Vec<Essential>,
    /// Integration rule with which every cloud is solved again. The change of the solution is the error of
    /// integration; the remaining error is the error of discretisation.
    pub split: Option<Integration>,
    /// Number of random clouds, with the seeds 1 to `seeds`, in place of the method's own cloud; 0 for its
    /// own. The spread of their results shows the influence of the node positions. The scene's checks apply
    /// to its own cloud only.
    pub seeds: u64,
    /// Axis along which the scene is varied. The response of each method is a result; the scene's checks
    /// apply to the unvaried scene only.
    pub axis: Option<Axis>,
    /// Whether the run belongs to the quick tier.
    pub quick: bool,
    /// Whether the quick tier also runs the loops of the scene.
    pub loops: bool,
    /// Words by which a run can be selected.
    pub tags: Vec<String>,
    /// Checks in addition to those of the scene.
    pub checks: Vec<Check>,
}

impl Run {
    /// A run of a scene with its own methods, without variations.
    pub fn of(scene: &Path) -> Run {
        Run {
            scene: scene.into(),
            methods: Vec::new(),
            adapters: Vec::new(),
            levels: Vec::new(),
            poisson: Vec::new(),
            nodes: Vec::new(),
            kernels: Vec::new(),
            support_scales: Vec::new(),
            essentials: Vec::new(),
            split: None,
            seeds: 0,
            axis: None,
            quick: false,
            loops: false,
            tags: Vec::new(),
            checks: Vec::new(),
        }
    }

    /// Methods of the scene that this run uses.
    pub fn chosen<'a>(&'a self, scene: &'a Scene) -> impl Iterator<Item = &'a Method> {
        scene.methods.iter().filter(|m| self.methods.is_empty() || self.methods.contains(&m.id))
    }

    /// The chosen methods as the external solvers of `adapters` solve them.
    fn twins(&self, scene: &Scene) -> Vec<Method> {
        let twins = |m| self.adapters.iter().filter_map(move |adapter| Method::solved_by(m, adapter));
        self.chosen(scene).flat_map(twins).collect()
    }
}

/// A study file
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct StudyKeys {
    pub title: String,
    /// A folder, relative to the study's; every scene in and below it has to be in a run or left out with a
    /// reason
    pub all_of: Option<String>,
    #[serde(default)]
    pub left_out: Vec<LeftOutKeys>,
    #[serde(default)]
    pub run: Vec<RunKeys>,
}

/// One scene with its variations
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RunKeys {
    /// The scene file, relative to the study's folder
    pub scene: String,
    /// Ids of methods; all unless given
    #[serde(default)]
    pub methods: Vec<String>,
    /// External solvers (`tissuebench adapter list`). Each also solves every method of plain finite elements,
    /// on the same mesh, as the method METHOD-ADAPTER
    #[serde(default)]
    pub adapters: Vec<String>,
    /// Levels in place of the methods' own sizes
    #[serde(default)]
    pub levels: Vec<u32>,
    /// Poisson's ratios in place of the scene's ratio
    #[serde(default)]
    pub poisson: Vec<f64>,
    /// Node counts of clouds
    #[serde(default)]
    pub nodes: Vec<u32>,
    /// Kernels of clouds
    #[serde(default)]
    pub kernels: Vec<Word<Kernels>>,
    /// Support scales of clouds: support radius over the local spacing
    #[serde(default)]
    pub support_scales: Vec<f64>,
    /// Essential conditions of clouds
    #[serde(default)]
    pub essentials: Vec<EssentialKeys>,
    /// Integration rule with which every cloud is solved again, to separate errors of integration and of
    /// discretisation
    pub split: Option<IntegrationKeys>,
    /// Number of random clouds, with seeds from 1 on, in place of the method's own cloud
    #[serde(default)]
    pub seeds: u32,
    pub axis: Option<AxisKeys>,
    /// Whether the run belongs to the quick tier
    #[serde(default)]
    pub quick: bool,
    /// Whether the quick tier also runs the scene's loops (`loop` and `output.repeated`), which it omits otherwise
    #[serde(default)]
    pub loops: bool,
    /// Words by which the run can be selected (`tissuebench verify --tag WORD`) or left out (`--not WORD`)
    #[serde(default)]
    pub tags: Vec<String>,
    #[serde(default)]
    pub check: Vec<CheckKeys>,
}

/// The JSON schema of study files.
pub fn study_schema() -> serde_json::Value {
    document::schema::<StudyKeys>()
}

/// Reads the study in a file. Messages name the file by `path` as given.
pub fn load_study(path: &Path) -> Result<Study, Vec<SceneError>> {
    parse_study(&text_of(path)?, &path.display().to_string())
}

/// Reads a study that was read before, with only the scene of the run with index `run`.
pub fn load_study_for(path: &Path, run: usize) -> Result<Study, Vec<SceneError>> {
    parse(&text_of(path)?, &path.display().to_string(), Some(run))
}

/// Reads a study from text. Messages name it by `file`; scenes are relative to the folder of `file`.
pub fn parse_study(text: &str, file: &str) -> Result<Study, Vec<SceneError>> {
    parse(text, file, None)
}

fn parse(text: &str, file: &str, only: Option<usize>) -> Result<Study, Vec<SceneError>> {
    let (keys, origin) = document::read::<StudyKeys>(text, file)?;
    let report = Report::new(&origin);
    if keys.run.is_empty() {
        report.add("run", Problem::new("is missing").help("add a [[run]] with scene = \"...\""));
    }
    let runs = report.each("run", keys.run, |keys, report| Some(keys.read(report)));
    let wanted = only.and_then(|run| runs.get(run)).map(|run| run.scene.clone());
    let mut scenes = BTreeMap::new();
    let mut all = (0.0, 0);
    for (i, run) in runs.iter().enumerate().filter(|(_, run)| wanted.as_ref().is_none_or(|w| run.scene == *w))
    {
        // A scene that can't be read is reported by the run that needs it, with better messages.
        let scene = scenes.entry(run.scene.clone()).or_insert_with(|| load(&run.scene).ok());
        if let Some(scene) = scene {
            let report = report.at(&format!("run[{i}]"));
            all = few_enough(run, scene, all, &report);
            fit(run, scene, &report);
        }
    }
    let scenes = scenes.into_iter().filter_map(|(path, scene)| Some((path, scene?))).collect();
    if only.is_none() {
        let run: Vec<&Path> = runs.iter().map(|run| run.scene.as_path()).collect();
        coverage::check(keys.all_of.as_deref(), &keys.left_out, &run, &report);
    }
    let errors = report.finish();
    if errors.is_empty() { Ok(Study { title: keys.title, scenes, runs }) } else { Err(errors) }
}

impl RunKeys {
    fn read(self, report: &Report) -> Run {
        let scene = report.path(&self.scene, "scene");
        let help = format!("no file at {}; scenes are relative to the study's folder", scene.display());
        report.require(scene.is_file(), "scene", "can't be found", &help);
        let each = |key: &str, sound: Vec<bool>, problem: &str, help: &str| {
            for (i, sound) in sound.into_iter().enumerate() {
                report.require(sound, &format!("{key}[{i}]"), problem, help);
            }
        };
        let sound = self.adapters.iter().map(|name| is_adapter(name)).collect();
        each("adapters", sound, NO_ADAPTER, ADAPTERS);
        let sound = self.levels.iter().map(|l| (1..=8).contains(l)).collect();
        each("levels", sound, "is not a valid level", "levels are 1 to 8");
        let sound = self.poisson.iter().map(|nu| *nu > -1.0 && *nu < 0.5).collect();
        let help = "give ratios above -1 and below 0.5, such as 0.4999";
        each("poisson", sound, "is not a valid Poisson's ratio", help);
        let sound = self.nodes.iter().map(|n| *n >= 4).collect();
        each("nodes", sound, "are too few for a cloud", "give 4 nodes or more");
        let sound = self.support_scales.iter().map(|d| (1.0..=10.0).contains(d)).collect();
        let help = "1 to 10, as in a method; 1.2 to 3 is usual";
        each("support_scales", sound, "is not a valid support scale", help);
        for (key, once) in [
            ("methods", first_times(&self.methods)),
            ("adapters", first_times(&self.adapters)),
            ("levels", first_times(&self.levels)),
            ("poisson", first_times(&self.poisson)),
            ("nodes", first_times(&self.nodes)),
            ("support_scales", first_times(&self.support_scales)),
        ] {
            each(key, once, "is given already", "name each once");
        }
        let sound = self.seeds != 1 && self.seeds <= 10_000;
        report.require(sound, "seeds", "is out of range", "give 2 to 10000; 50 is usual");
        let alone = self.levels.is_empty() || self.nodes.is_empty();
        report.require(
            alone,
            "nodes",
            "can't be combined with levels",
            "vary levels or node counts, not both",
        );
        let kernel = |word: &Word<Kernels>| (word.0.build)(&Values::new(word.0.parameters)).ok();
        Run {
            scene,
            methods: self.methods,
            adapters: self.adapters,
            levels: self.levels,
            poisson: self.poisson,
            nodes: self.nodes.iter().map(|&n| n as usize).collect(),
            kernels: self.kernels.iter().filter_map(kernel).collect(),
            support_scales: self.support_scales,
            essentials: report.each("essentials", self.essentials, |keys, report| Some(keys.read(report))),
            split: self.split.map(|keys| keys.read(&report.at("split"))),
            seeds: self.seeds.into(),
            axis: self.axis.and_then(|keys| keys.read(&report.at("axis"))),
            quick: self.quick,
            loops: self.loops,
            tags: self.tags,
            checks: report.each("check", self.check, CheckKeys::read),
        }
    }
}

/// Limits on the runs of a study and on the scenes along its axes, which are all read before the first run.
const MOST_RUNS: f64 = 100_000.0;
const MOST_SCENES: usize = 5000;

/// Reports the run table at which a study exceeds the limits; returns the numbers of runs and scenes so far.
fn few_enough(run: &Run, scene: &Scene, (runs, scenes): (f64, usize), report: &Report) -> (f64, usize) {
    let methods = run.chosen(scene).count() + run.twins(scene).len();
    let samples = scene.vary.as_ref().map_or(0, |vary| vary.samples as usize);
    let values = run.axis.as_ref().map_or(0, |axis| axis.values.len());
    let scenes_of_each = if run.axis.is_some() { values } else { samples };
    let varied = [run.poisson.len(), run.levels.len().max(run.nodes.len()), run.kernels.len()];
    let more = [run.support_scales.len(), run.essentials.len(), run.seeds as usize, scenes_of_each];
    let product = varied.iter().chain(&more).map(|&n| n.max(1) as f64).product::<f64>();
    let now = (runs + methods as f64 * product, scenes + values);
    if now.0 > MOST_RUNS && runs <= MOST_RUNS {
        let problem = Problem::new(format!("gives {:.0} runs in total", now.0));
        report.add("", problem.help(format!("give {MOST_RUNS} or less in all")));
    }
    if now.1 > MOST_SCENES && scenes <= MOST_SCENES {
        let problem = Problem::new(format!("gives {} scenes in total", now.1));
        report.add("axis.values", problem.help(format!("give {MOST_SCENES} or less in all")));
    }
    now
}

/// For each value, whether it differs from all values before it.
fn first_times<T: PartialEq>(list: &[T]) -> Vec<bool> {
    list.iter().enumerate().map(|(i, value)| !list[..i].contains(value)).collect()
}

/// Reports each external solver whose method would have the id of another method.
fn distinct(run: &Run, scene: &Scene, report: &Report) {
    let mut known: Vec<String> = scene.methods.iter().map(|method| method.id.clone()).collect();
    for own in run.chosen(scene) {
        for (at, adapter) in run.adapters.iter().enumerate() {
            let Some(twin) = own.solved_by(adapter) else { continue };
            if known.contains(&twin.id) {
                let problem = format!("solves '{}' as '{}', the id of another method", own.id, twin.id);
                let help = "rename one of the two methods in the scene, or leave the adapter out";
                report.add(&format!("adapters[{at}]"), Problem::new(problem).found(adapter).help(help));
            }
            known.push(twin.id);
        }
    }
}

/// Checks the demands of a run on its scene.
fn fit(run: &Run, scene: &Scene, report: &Report) {
    known_methods(&run.methods, scene, "methods", report);
    distinct(run, scene, report);
    if let Some(axis) = &run.axis
        && let Err(bad) = axis.at(scene, &run.methods, axis.base)
    {
        let first = bad.first().map_or(String::new(), ToString::to_string);
        let problem = Problem::new("gives no valid scene at its base").found(axis.name.as_str()).help(first);
        report.add("axis", problem);
    }
    let twins = run.twins(scene);
    let help = "it goes with finite elements that have no dilation of their own: name one in methods, or leave it out";
    let solvable = run.adapters.is_empty() || !twins.is_empty();
    report.require(solvable, "adapters", "have no method to solve", help);
    let is_run = |id: &String| run.methods.contains(id) || twins.iter().any(|twin| twin.id == *id);
    let all = Scene { methods: [&scene.methods[..], &twins].concat(), ..scene.clone() };
    for (i, check) in run.checks.iter().enumerate() {
        let report = report.at(&format!("check[{i}]"));
        demands::check(check, &all, &report);
        if check.address.metric.needs == Needs::Levels && run.levels.len() < 2 {
            let problem = Problem::new("needs several levels").help("give the run levels = [1, 2, 3]");
            report.add("metric", problem);
        }
        if check.address.metric.needs == Needs::Seeds && run.seeds == 0 {
            let problem = Problem::new("needs many clouds").help("give the run seeds = 50");
            report.add("metric", problem);
        }
        if !run.methods.is_empty() {
            for id in check.methods.iter().filter(|id| !is_run(id)) {
                let problem =
                    Problem::new("is not run here").found(id).help("name it in methods, or leave it out");
                report.add("method", problem);
            }
        }
    }
    let efgs: Vec<&Efg> = (run.chosen(scene))
        .filter_map(|m| if let Family::Efg(efg) = &m.family { Some(efg) } else { None })
        .collect();
    let clouds = !efgs.is_empty();
    for (name, given) in [
        ("nodes", !run.nodes.is_empty()),
        ("kernels", !run.kernels.is_empty()),
        ("support_scales", !run.support_scales.is_empty()),
        ("essentials", !run.essentials.is_empty()),
        ("split", run.split.is_some()),
    ] {
        let help = "it goes with element-free Galerkin methods: name one in methods, or leave it out";
        report.require(!given || clouds, name, "has no method to vary", help);
    }
    for (i, essential) in run.essentials.iter().enumerate() {
        let key = format!("essentials[{i}]");
        if let Some(problem) = essential.unsupported(scene.procedure.kind()) {
            report.add(&key, problem);
        }
        let help = "name methods of a linear basis whose nodes stay where they are";
        let fits = *essential != Essential::Coupling || efgs.iter().all(|efg| efg.can_couple());
        report.require(fits, &key, "does not go with every method", help);
    }
    let placed = efgs.iter().any(|efg| efg.cloud.is_refined());
    let help = "a cloud that follows an error would be another one: name other methods";
    report.require(run.split.is_none() || !placed, "split", "is not of every method", help);
    let seeded = run.chosen(scene).all(|m| m.seeded(1).is_some());
    let help = "a cloud that is uniform, graded or jittered has one: name such methods in methods";
    report.require(run.seeds == 0 || seeded, "seeds", "are not of every method", help);
    let elastic = scene.material.constant("poisson").is_some();
    let help = format!("the {} law has none", scene.material.name());
    report.require(run.poisson.is_empty() || elastic, "poisson", "has nothing to vary", &help);
}
