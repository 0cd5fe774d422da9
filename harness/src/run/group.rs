//! A scene at one Poisson's ratio. Its reference runs first; its methods are then compared with the
//! reference.

use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

use cases::scene::{self, ErrorKind, Family, Reference, Scene, Size, Target};
use geometry::Point3;
use interp::Scheme;

use super::levels::report_estimates;
use super::memory::return_freed_memory;
use super::stored_reference::Stored;
use super::symmetry::Mirror;
use super::witness::{own_error, reference_coarser};
use super::{FinishedRun, run};
use crate::discretise::Discretisation;
use crate::error::Failure;
use crate::measure::{self, OwnError, Repeats, Request};
use crate::outcome::timing::Timings;
use crate::outcome::{
    Counters, Metric, Outcome, Plan, SchemeSettings, Size as Sizes, Unfinished, Warning, Watch,
};
use crate::prepare::region_check;
use crate::procedure::{Schemes, Wanted, plan};
use crate::scenario::{Scenario, point, rule, tools, uncut, warnings};

/// Data shared by all runs of a scene at one Poisson's ratio: probes, targets, transfer schemes and
/// references.
pub struct Group<'a> {
    scene: Cow<'a, Scene>,
    case: String,
    poisson: Option<f64>,
    probes: Vec<Point3>,
    targets: Vec<Point3>,
    schemes: Vec<(SchemeSettings, Scheme)>,
    reference: Option<measure::Reference>,
    beside: Option<measure::Reference>,
    reference_counters: Counters,
    reference_stalled: Option<Failure>,
    repeats: Repeats,
    watch: Option<Arc<Watch>>,
}

/// Optional outputs of a run in addition to its metrics.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunOptions {
    /// Keeps the surface displacement, for pictures.
    pub picture: bool,
    /// Keeps the body at all recorded states, for visualisation programs.
    pub states: bool,
    /// Runs the loop that the scene requests (`[output] repeated`) after the first solution.
    pub frames: bool,
    /// Solves a cloud a second time with this integration rule, to separate its integration error from its
    /// discretisation error.
    pub split: Option<scene::Integration>,
}

/// The case name of a scene: its file's stem.
pub fn case_name(scene: &Scene) -> String {
    Path::new(scene.file()).file_stem().map_or_else(|| "scene".into(), |s| s.to_string_lossy().into_owned())
}

impl<'a> Group<'a> {
    /// Runs the reference method, if the scene has one, and finds the target points.
    ///
    /// # Errors
    /// Returns the error of a reference that cannot be read or solved, and of target points that cannot be
    /// read.
    pub fn new(scene: &'a Scene, poisson: Option<f64>, repeats: Repeats) -> Result<Group<'a>, Failure> {
        Group::watched(Cow::Borrowed(scene), poisson, repeats, None)
    }

    /// Same as [`Group::new`], but the group may own its scene, and `watch` is called with the steps of the
    /// reference and of every run.
    ///
    /// # Errors
    /// Returns the same errors as [`Group::new`].
    pub fn watched(
        scene: Cow<'a, Scene>,
        poisson: Option<f64>,
        repeats: Repeats,
        watch: Option<Arc<Watch>>,
    ) -> Result<Group<'a>, Failure> {
        let mut group = Group::prepared(scene, repeats)?;
        (group.poisson, group.watch) = (poisson, watch);
        match group.scene.reference.clone() {
            Some(Reference::Method { id, size, accuracy }) => {
                let method = group.resized(&id, size.as_ref());
                let known = group.solve_reference(&method, size.is_some())?;
                if let Some(accuracy) = accuracy.filter(|_| known) {
                    group.refine_reference(method, accuracy)?;
                }
            }
            Some(Reference::Record(path)) => {
                let stored = Stored::load(&group.scene, &path)?;
                let mirror = Mirror::of(&group.scene);
                group.targets = stored.targets(&mirror);
                // Each run reports invalid tools.
                let tools = tools(&group.scene).unwrap_or_default();
                group.reference = Some(stored.reference(&mirror, &tools));
            }
            Some(Reference::Exact { .. }) | None => {}
        }
        if let Some(id) = group.scene.output.beside.clone() {
            let method = group.scene.method(&id).expect("validated").clone();
            group.beside = Some(group.compared(method, false)?.0);
        }
        Ok(group)
    }

    /// Sets the repeats and the watch of the runs to come. The reference stays.
    pub fn follow(&mut self, repeats: Repeats, watch: Option<Arc<Watch>>) {
        (self.repeats, self.watch) = (repeats, watch);
    }

    /// Group without a reference, which suffices for a plan.
    ///
    /// # Errors
    /// Returns an error if a file of target points cannot be read.
    pub fn unreferenced(scene: &'a Scene, repeats: Repeats) -> Result<Group<'a>, Failure> {
        Group::prepared(Cow::Borrowed(scene), repeats)
    }

    fn prepared(scene: Cow<'a, Scene>, repeats: Repeats) -> Result<Group<'a>, Failure> {
        let probes: Vec<Point3> = scene.output.probes.iter().map(|&x| point(x)).collect();
        Ok(Group {
            case: case_name(&scene),
            poisson: None,
            targets: targets(&scene, &probes)?,
            probes,
            schemes: schemes(&scene),
            scene,
            reference: None,
            beside: None,
            reference_counters: Counters::default(),
            reference_stalled: None,
            repeats,
            watch: None,
        })
    }

    /// Solves method `id` as a reference. The displacement is reported at `targets` (m). `watch` is called
    /// with every converged step.
    ///
    /// # Errors
    /// Returns an error if the method fails or ends before the whole load.
    pub fn solve_for(
        scene: &'a Scene,
        id: &str,
        targets: Vec<Point3>,
        watch: Watch,
    ) -> Result<measure::Reference, Failure> {
        let mut group = Group::unreferenced(scene, Repeats::ONCE)?;
        (group.targets, group.watch) = (targets, Some(Arc::new(watch)));
        group.run_reference(&group.resized(id, None), false)?;
        match group.reference_stalled {
            Some(failure) => Err(failure),
            None => Ok(group.reference.expect("it has run")),
        }
    }

    /// A method of the scene, at another size if given.
    fn resized(&self, id: &str, size: Option<&Size>) -> scene::Method {
        let mut method = self.scene.method(id).expect("validated").clone();
        size.into_iter().for_each(|size| method.resize(size));
        method
    }

    /// Solves the reference, whose size may differ from that of the scene's method.
    fn run_reference(&mut self, method: &scene::Method, resized: bool) -> Result<(), Failure> {
        let (reference, stalled) = self.compared(method.clone(), resized)?;
        (self.reference, self.reference_stalled) = (Some(reference), stalled);
        Ok(())
    }

    /// Solves the reference, at the scene's targets or its own nodes, and estimates its own error. Returns
    /// whether it reached the whole load.
    pub(super) fn solve_reference(&mut self, method: &scene::Method, resized: bool) -> Result<bool, Failure> {
        self.targets = targets(&self.scene, &self.probes)?;
        self.run_reference(method, resized)?;
        self.know_reference(method);
        Ok(self.reference_stalled.is_none())
    }

    /// Estimates the own error of the reference, which was solved with this method.
    fn know_reference(&mut self, method: &scene::Method) {
        let Some(reference) = &self.reference else { return };
        let mut counters = Counters::default();
        let own = match &self.reference_stalled {
            Some(_) => OwnError { unknown: "it ended early".into(), ..OwnError::default() },
            None => own_error(method, reference, |witness, most| self.witness(witness, most, &mut counters)),
        };
        self.reference_counters += counters;
        self.reference.iter_mut().for_each(|reference| reference.own = own.clone());
    }

    /// Solves a witness of the reference, which must have fewer nodes than `most`. Returns its number of
    /// nodes and its metrics.
    fn witness(
        &self,
        method: scene::Method,
        most: Option<usize>,
        counters: &mut Counters,
    ) -> Result<(usize, Vec<Metric>), Failure> {
        let id = method.id.clone();
        let failed = |failure: Failure| {
            Failure::Run(format!("{id} on a coarser mesh gives no number to compare: {failure}"))
        };
        let scenario = self.scenario(method, 0);
        let discretisation = scenario.discretise().map_err(failed)?;
        let nodes = discretisation.nodes().len();
        if let Some(most) = most.filter(|most| nodes >= *most) {
            return Err(Failure::Run(format!("no mesh of {id} coarser than its {most} nodes can be made")));
        }
        let setup = scenario.setup().map_err(failed)?;
        let plan = plan(&discretisation, &setup, Wanted { targets: true, ..Wanted::default() });
        let solved = run(scenario.identity(), plan, &discretisation, &setup, &self.request())
            .map_err(|failure| failed(scenario.locate(failure)))?;
        *counters += solved.outcome.counters;
        match solved.outcome.stalled {
            Some(failure) => Err(failed(scenario.locate(failure))),
            None => Ok((nodes, solved.outcome.metrics)),
        }
    }

    /// Runs a method that others are compared with. If `resized`, its size is set by `reference.size`. The
    /// second value is the failure that ended the run early, if any.
    fn compared(
        &mut self,
        method: scene::Method,
        resized: bool,
    ) -> Result<(measure::Reference, Option<Failure>), Failure> {
        let scene = self.scene.clone();
        let mut scenario = self.scenario_of(&scene, method, 0);
        scenario.size_key = resized.then(|| "reference.size".into());
        let discretisation = scenario.discretise()?;
        if self.targets.is_empty() {
            self.targets = discretisation.nodes().to_vec();
        }
        let mut solved = self.solved(&scenario, &discretisation)?;
        let stalled = solved.outcome.stalled.clone().map(|failure| scenario.locate(failure));
        let nodes = solved.outcome.size.nodes as usize;
        solved.outcome.warn(warnings(&scene, &scenario.method, discretisation.mesh(), nodes));
        self.reference_counters += solved.outcome.counters;
        Ok((super::reference(solved, &self.targets)?, stalled))
    }

    /// Solves a method once, without repeats and without a comparison.
    fn solved(&self, scenario: &Scenario, discretisation: &Discretisation) -> Result<FinishedRun, Failure> {
        let setup = scenario.setup()?;
        let plan =
            plan(discretisation, &setup, Wanted { targets: !self.targets.is_empty(), ..Wanted::default() });
        let request = Request { watch: self.watch.as_deref(), ..Request::alone(&self.probes, &self.targets) };
        run(scenario.identity(), plan, discretisation, &setup, &request)
            .map_err(|failure| scenario.locate(failure))
    }

    /// Solves a cloud with another integration rule, as a reference at the targets; without targets, at its
    /// nodes.
    fn integrated(
        &self,
        scenario: &Scenario,
        rule: scene::Integration,
    ) -> Result<measure::Reference, Failure> {
        let mut scenario = scenario.clone();
        if let Family::Efg(efg) = &mut scenario.method.family {
            efg.integration = rule;
        }
        let discretisation = scenario.discretise()?;
        let solved = self.solved(&scenario, &discretisation)?;
        let nodes = discretisation.nodes().to_vec();
        let at = if self.targets.is_empty() { &nodes } else { &self.targets };
        super::reference(solved, at)
    }

    /// Combines one of the scene's methods with this group's scene and Poisson's ratio.
    pub fn scenario(&self, method: scene::Method, level: u32) -> Scenario<'_> {
        self.scenario_of(&self.scene, method, level)
    }

    fn scenario_of<'s>(&self, scene: &'s Scene, method: scene::Method, level: u32) -> Scenario<'s> {
        Scenario { case: self.case.clone(), scene, method, level, poisson: self.poisson, size_key: None }
    }

    pub(super) fn scene(&self) -> &Scene {
        &self.scene
    }

    pub(super) fn own_reference(&self) -> Option<&measure::Reference> {
        self.reference.as_ref()
    }

    /// Adds a warning of the reference.
    pub(super) fn warn_of_reference(&mut self, warning: Warning) {
        self.reference.iter_mut().for_each(|reference| reference.warnings.push(warning.clone()));
    }

    /// Probe positions, m.
    pub(super) fn probes(&self) -> &[Point3] {
        &self.probes
    }

    /// Counters of the reference, once for all methods; zero if no reference had to run.
    pub fn reference_counters(&self) -> Counters {
        self.reference_counters
    }

    /// Failure that ended the reference early, if any. Such a reference is compared only at the steps that it
    /// reached, not at its end.
    pub fn reference_stalled(&self) -> Option<&Failure> {
        self.reference_stalled.as_ref()
    }

    /// Fraction of the load that the reference reached, 0 to 1; `None` if the reference has no load steps.
    pub fn reference_carried(&self) -> Option<f64> {
        self.reference.as_ref().and_then(|reference| reference.steps.last()).map(|step| step.load)
    }

    /// Runs one method.
    ///
    /// # Errors
    /// Returns the failure with the plan and the sizes, as far as they were known.
    pub fn run(&self, scenario: &Scenario, options: RunOptions) -> Result<Outcome, Unfinished> {
        return_freed_memory();
        let mut timings = Timings::default();
        let discretisation = timings.time("mesh", || scenario.discretise())?;
        if self.scene.output.bounds {
            uncut(&self.scene, discretisation.mesh()).map_err(|failure| scenario.locate(failure))?;
        }
        let size = size(&discretisation);
        let setup =
            scenario.setup().map_err(|failure| Unfinished { failure, plan: Plan::default(), size })?;
        let plan = plan(&discretisation, &setup, self.wanted(scenario, &discretisation));
        let integrated = match options.split.filter(|_| scenario.method.is_cloud()) {
            Some(rule) => {
                let fail = |failure| Unfinished { failure, plan: plan.clone(), size };
                Some(self.integrated(scenario, rule).map_err(fail)?)
            }
            None => None,
        };
        let request = Request {
            schemes: &self.schemes,
            picture: options.picture,
            states: options.states,
            repeats: self.repeats,
            integrated: integrated.as_ref(),
            repeated: self.scene.output.repeated.as_ref().filter(|_| options.frames),
            real_time: self.scene.real_time.as_ref().filter(|_| options.frames),
            ..self.request()
        };
        let mut identity = scenario.identity();
        identity.split = integrated.as_ref().and(options.split).map(rule);
        match run(identity, plan.clone(), &discretisation, &setup, &request) {
            Ok(mut solved) => {
                let locate = |failure| scenario.locate(failure);
                solved.outcome.stalled = solved.outcome.stalled.map(locate);
                solved.outcome.relaxed = solved.outcome.relaxed.map(locate);
                let nodes = solved.outcome.size.nodes as usize;
                self.hold_against(&mut solved.outcome);
                if solved.outcome.estimates.is_some() {
                    timings.time("estimate-coarser", || {
                        report_estimates(&mut solved.outcome, scenario, &self.probes);
                    });
                }
                let of_scene = || warnings(&self.scene, &scenario.method, discretisation.mesh(), nodes);
                solved.outcome.warn(timings.time("mesh", of_scene));
                timings.join("mesh");
                solved.outcome.phases.extend_from_slice(timings.phases());
                Ok(solved.outcome)
            }
            Err(failure) => Err(Unfinished { failure: scenario.locate(failure), plan, size }),
        }
    }

    /// Request for a comparison with the references and no other output.
    pub(super) fn request(&self) -> Request<'_> {
        Request {
            reference: self.reference.as_ref(),
            beside: self.beside.as_ref(),
            watch: self.watch.as_deref(),
            ..Request::alone(&self.probes, &self.targets)
        }
    }

    /// Reference that the runs are compared with; `None` if there is none.
    pub fn reference(&self) -> Option<records::Reference> {
        let case = self.case.clone();
        if let Some(Reference::Exact { entry, .. }) = &self.scene.reference {
            return Some(records::Reference {
                case,
                method: entry.name.into(),
                ..records::Reference::default()
            });
        }
        let measure::Reference { method, nodes, own, warnings, .. } = self.reference.as_ref()?;
        Some(records::Reference {
            case,
            poisson: 0.0,
            method: method.clone(),
            nodes: *nodes as u64,
            band: own.band.iter().map(|metric| (metric.name(), metric.value)).collect(),
            by: own.by.clone(),
            unknown: own.unknown.clone(),
            warnings: warnings.iter().map(Warning::text).collect(),
        })
    }

    /// Records the reference in an outcome, and warns if the reference is coarser than the run.
    pub(super) fn hold_against(&self, outcome: &mut Outcome) {
        let poisson = outcome.identity.poisson;
        outcome.reference = self.reference().map(|reference| records::Reference { poisson, ..reference });
        outcome
            .warnings
            .extend(outcome.reference.as_ref().and_then(|reference| reference_coarser(reference, outcome)));
    }

    /// Plan and sizes of one method, without running the method.
    ///
    /// # Errors
    /// Returns an error if the method cannot be discretised and, as in a run, if a region selects nothing.
    pub fn plan(&self, scenario: &Scenario) -> Result<(Plan, Sizes), Failure> {
        let (discretisation, setup) = (scenario.discretise()?, scenario.setup()?);
        region_check::check(&discretisation, &setup).map_err(|failure| scenario.locate(failure))?;
        Ok((plan(&discretisation, &setup, self.wanted(scenario, &discretisation)), size(&discretisation)))
    }

    fn wanted(&self, scenario: &Scenario, method: &Discretisation) -> Wanted {
        // The targets count before the reference has run, so that the plan matches the run.
        let nodes_of_reference =
            matches!(self.scene.reference, Some(Reference::Method { .. } | Reference::Record(_)));
        let targets = nodes_of_reference || !self.targets.is_empty();
        let schemes = match &self.scene.reference {
            _ if !targets || self.schemes.is_empty() => Schemes::NotRequested,
            _ if method.interpolates && self.targets == method.nodes() => Schemes::OwnNodes,
            Some(Reference::Method { id, size: None, accuracy: None }) if *id == scenario.method.id => {
                Schemes::OfReference
            }
            _ => Schemes::Compared,
        };
        Wanted { targets, schemes }
    }
}

/// Numbers of nodes and elements, which are known before any table is filled.
fn size(method: &Discretisation) -> Sizes {
    let (nodes, elements) = (method.nodes().len() as u64, method.mesh().cell_count() as u64);
    Sizes { nodes, elements, ..Sizes::default() }
}

/// Key of a transfer in the scene, which gives either a single table or a list.
fn transfer_key(scene: &Scene, index: usize, below: &str) -> String {
    let listed = format!("output.transfer[{index}]");
    let key = if scene.has(&listed) { listed } else { "output.transfer".into() };
    format!("{key}.{below}")
}

fn targets(scene: &Scene, probes: &[Point3]) -> Result<Vec<Point3>, Failure> {
    for (index, transfer) in scene.output.transfers.iter().enumerate() {
        match &transfer.to {
            Target::ReferenceNodes => {}
            Target::Probes => return Ok(probes.to_vec()),
            Target::File(file) => {
                let mesh = mesh_files::read(&file.path, file.unit).map_err(|bad| {
                    let (key, problem) =
                        (transfer_key(scene, index, "to.file"), format!("can't be read: {bad}"));
                    Failure::of_scene(scene, ErrorKind::Invalid, &key, &problem, mesh_files::READ)
                })?;
                return Ok(mesh.points().to_vec());
            }
        }
    }
    Ok(Vec::new())
}

/// Transfer schemes of the scene with their settings, without duplicates. The method's own shape functions
/// are always compared with them.
fn schemes(scene: &Scene) -> Vec<(SchemeSettings, Scheme)> {
    let named = scene.output.transfers.iter().filter_map(|transfer| transfer.scheme.as_ref());
    let mut list = Vec::new();
    for (scheme, values) in named {
        let scheme = (SchemeSettings::of(values), *scheme);
        if !list.contains(&scheme) {
            list.push(scheme);
        }
    }
    list
}
