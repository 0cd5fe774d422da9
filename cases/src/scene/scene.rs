//! A scene: its keys, and the form that the program uses, in which every quantity is an `f64` in SI units and
//! every choice is an enum.

use std::sync::Arc;

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;
use shape::Curve;

use super::body::{Body, BodyKeys};
use super::check::{Check, CheckKeys};
use super::condition::{Load, LoadKeys, Support, SupportKeys};
use super::curve::{CurveKeys, NamedCurve, curves};
use super::document::Origin;
use super::error::{ErrorKind, SceneError};
use super::fit::{Fit, FitKeys};
use super::foundation::{Foundation, FoundationKeys};
use super::material::{Material, MaterialKeys, MaterialRegion, RegionKeys};
use super::method::{Method, MethodKeys};
use super::output::{Output, OutputKeys};
use super::procedure::{Procedure, ProcedureKeys};
use super::purpose::{Publication, Purpose};
use super::real_time::{RealTime, RealTimeKeys};
use super::reference::{Reference, ReferenceKeys};
use super::report::Report;
use super::tool::{Tool, ToolKeys};
use super::training::{Training, TrainingKeys};
use super::vary::{Vary, VaryKeys};

/// A scene: a body, its material, supports and loads, the methods to run, the reference, and the checks.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneKeys {
    /// Title of the scene in one line
    title: String,
    /// Source of the case and its reference
    source: Option<String>,
    /// Purpose of the scene; "smooth" unless given
    purpose: Option<Purpose>,
    /// A published comparison of methods; the results test its claim on run times and errors
    published: Option<Publication>,
    body: BodyKeys,
    material: MaterialKeys,
    /// Parts of the body with their own material
    #[serde(default)]
    region: Vec<RegionKeys>,
    #[serde(default)]
    support: Vec<SupportKeys>,
    #[serde(default)]
    load: Vec<LoadKeys>,
    #[serde(default)]
    foundation: Vec<FoundationKeys>,
    #[serde(default)]
    tool: Vec<ToolKeys>,
    #[serde(default)]
    curve: Vec<CurveKeys>,
    procedure: Option<ProcedureKeys>,
    /// A file of methods that several scenes share, relative to the folder of the scene. A `[[method]]` takes
    /// one of its methods by `use = "id"`
    #[allow(dead_code)] // read before the keys are, by `shared`
    methods_from: Option<String>,
    #[serde(default)]
    method: Vec<MethodKeys>,
    output: Option<OutputKeys>,
    #[serde(rename = "loop")]
    real_time: Option<RealTimeKeys>,
    reference: Option<ReferenceKeys>,
    #[serde(default)]
    check: Vec<CheckKeys>,
    vary: Option<VaryKeys>,
    fit: Option<FitKeys>,
    /// Runs of the scene from whose states reduced models take their deformations. A table for each run has keys of
    /// the scene, such as "tool[0].at", with their values there
    #[serde(default)]
    training: Vec<TrainingKeys>,
}

/// A checked scene.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Title of the scene in one line.
    pub title: String,
    /// Source of the case and its reference.
    pub source: Option<String>,
    /// Purpose of the scene.
    pub purpose: Purpose,
    /// Published comparison that the results are compared with.
    pub published: Option<Publication>,
    /// The body in its undeformed state.
    pub body: Body,
    /// Material of the body outside the regions with their own material.
    pub material: Material,
    /// Parts of the body with their own material; in an overlap the later region counts.
    pub regions: Vec<MaterialRegion>,
    /// Prescribed displacements.
    pub supports: Vec<Support>,
    /// Given loads.
    pub loads: Vec<Load>,
    /// Springs and dampers on parts of the surface.
    pub foundations: Vec<Foundation>,
    /// Rigid tools.
    pub tools: Vec<Tool>,
    /// Curves that loads, supports, tools and materials name.
    pub curves: Vec<NamedCurve>,
    /// Solution procedure.
    pub procedure: Procedure,
    /// Methods to run: at least one, with unique ids.
    pub methods: Vec<Method>,
    /// Requested output.
    pub output: Output,
    /// Simulator's loop in real time.
    pub real_time: Option<RealTime>,
    /// Reference that results are compared with.
    pub reference: Option<Reference>,
    /// Bounds on the results.
    pub checks: Vec<Check>,
    /// Uncertain inputs.
    pub vary: Option<Vary>,
    /// Constants that are fitted to a measured curve.
    pub fit: Option<Fit>,
    /// Runs from whose states reduced models take their deformations.
    pub training: Vec<Training>,
    /// Whether the scene stands for the fit of its constants, which is one task.
    pub is_fit: bool,
    /// Number of the sample of its uncertain inputs, from 0; `None` for the scene of the file.
    pub sample: Option<u32>,
    /// Axis of a study along which the scene is varied, with its value; `None` for the scene of the file.
    pub varied: Option<(String, f64)>,
    pub(crate) origin: Origin,
}

impl Scene {
    /// Name of the file, as given to [`load`](super::load) or [`parse`](super::parse).
    pub fn file(&self) -> &str {
        self.origin.file()
    }

    /// The text of the file; with shared methods or tissues, the equivalent text in which these are written
    /// out. It contains the whole scene except the meshes that it names.
    pub fn text(&self) -> &str {
        self.origin.text()
    }

    /// Every material with its key: the body's material, then those of the regions in their order.
    pub fn materials(&self) -> impl Iterator<Item = (String, &Material)> {
        let regions = self.regions.iter().enumerate();
        std::iter::once(("material".to_string(), &self.material))
            .chain(regions.map(|(i, r)| (format!("region[{i}].material"), &r.material)))
    }

    /// The method with the id `id`.
    pub fn method(&self, id: &str) -> Option<&Method> {
        self.methods.iter().find(|method| method.id == id)
    }

    /// Whether the body moves: by a load, a tool, an active stress, or a support with a prescribed
    /// displacement other than zero. Also true for free vibrations and for scenes that only prepare, which
    /// need no load.
    pub fn is_moved(&self) -> bool {
        let unsolved = matches!(self.procedure, Procedure::Modes { .. } | Procedure::Prepare);
        unsolved
            || !self.loads.is_empty()
            || !self.tools.is_empty()
            || self.supports.iter().any(Support::moves)
            || self.materials().any(|(_, material)| material.active != 0.0)
    }

    /// Key and curve of every condition that has one.
    pub fn curved(&self) -> impl Iterator<Item = (String, &Arc<Curve>)> {
        let supports = self.supports.iter().map(|support| &support.curve).enumerate();
        let loads = self.loads.iter().map(|load| &load.curve).enumerate();
        let tools = self.tools.iter().map(|tool| &tool.curve).enumerate();
        let materials =
            self.materials().map(|(key, material)| (format!("{key}.active_curve"), &material.active_curve));
        (supports.map(|(i, curve)| (format!("support[{i}].curve"), curve)))
            .chain(loads.map(|(i, curve)| (format!("load[{i}].curve"), curve)))
            .chain(tools.map(|(i, curve)| (format!("tool[{i}].drive.curve"), curve)))
            .chain(materials)
            .filter_map(|(key, curve)| Some((key, curve.as_ref()?)))
    }

    /// Returns the keys of the supports that act during a part of the loading.
    pub fn staged(&self) -> impl Iterator<Item = String> {
        let spans = self.supports.iter().map(|support| support.during).enumerate();
        spans.filter_map(|(i, during)| during.map(|_| format!("support[{i}].during")))
    }

    /// Whether the file has `key`.
    pub fn has(&self, key: &str) -> bool {
        self.origin.has(key)
    }

    /// Whether the file has `key`, in which brackets stand for any entry of a list.
    pub(crate) fn has_any(&self, key: &str) -> bool {
        self.origin.has_any(key)
    }

    /// An error at `key`, such as `support[0].where` or `method[1].size.nodes` (tables of a list count from
    /// 0), that is found only while running: an empty region, an inverted element. The error names file, line
    /// and value.
    pub fn error(&self, kind: ErrorKind, key: &str, problem: &str, help: Option<&str>) -> SceneError {
        let mut bad = Problem::new(problem);
        bad.help = help.map(str::to_string);
        self.origin.error(kind, key, bad)
    }
}

impl SceneKeys {
    /// Reads a scene; returns `None` only if there are findings.
    pub fn read(self, report: &Report) -> Option<Scene> {
        let sound = !self.title.trim().is_empty();
        report.require(sound, "title", "is empty", "describe the scene in one line");
        let body = self.body.read(&report.at("body"));
        let (curves, sound_curves) = curves(self.curve, report);
        let material = self.material.read(&curves, &report.at("material"));
        let count = self.region.len();
        let region = |keys: RegionKeys, report: &Report| keys.read(&curves, report);
        let regions = report.each("region", self.region, region);
        let (supports, loads) = conditions(body.as_ref(), &curves, self.support, self.load, report);
        let founded = |keys: FoundationKeys, report: &Report| Some(keys.read(body.as_ref(), report));
        let foundations = report.each("foundation", self.foundation, founded);
        let procedure = Procedure::read(self.procedure, !self.tool.is_empty(), &report.at("procedure"));
        let tools = report.each("tool", self.tool, |keys, report| keys.read(body.as_ref(), &curves, report));
        let methods = report.each("method", self.method, MethodKeys::read);
        let output = self.output.unwrap_or_default().read(&report.at("output"));
        let real_time = self.real_time.map(|keys| keys.read(&report.at("loop")));
        let reference = self.reference.and_then(|keys| keys.read(&report.at("reference")));
        let checks = report.each("check", self.check, CheckKeys::read);
        let vary = self.vary.map(|keys| keys.read(&report.at("vary")));
        let fit = self.fit.and_then(|keys| keys.read(&report.at("fit")));
        let training = report.each("training", self.training, TrainingKeys::read);
        let (body, material) = (body?, material?);
        (regions.len() == count && sound_curves).then(|| Scene {
            title: self.title,
            source: self.source,
            purpose: self.purpose.unwrap_or(Purpose::Smooth),
            published: self.published,
            body,
            material,
            regions,
            supports,
            loads,
            foundations,
            tools,
            curves,
            procedure,
            methods,
            output,
            real_time,
            reference,
            checks,
            vary,
            fit,
            training,
            is_fit: false,
            sample: None,
            varied: None,
            origin: report.origin().clone(),
        })
    }
}

/// Reads supports and loads; checks the names of surfaces if the body is known.
fn conditions(
    body: Option<&Body>,
    curves: &[NamedCurve],
    supports: Vec<SupportKeys>,
    loads: Vec<LoadKeys>,
    report: &Report,
) -> (Vec<Support>, Vec<Load>) {
    let supports = report.each("support", supports, |keys, report| Some(keys.read(body, curves, report)));
    (supports, report.each("load", loads, |keys, report| keys.read(body, curves, report)))
}

/// The parts of a scene with valid keys, if the keys of other parts are not valid.
#[derive(Deserialize)]
pub(crate) struct SoundParts {
    body: Option<BodyKeys>,
    material: Option<MaterialKeys>,
    #[serde(default)]
    support: Vec<SupportKeys>,
    #[serde(default)]
    load: Vec<LoadKeys>,
    #[serde(default)]
    curve: Vec<CurveKeys>,
}

impl SoundParts {
    /// Reports errors in these parts, so that an error in one part does not hide errors in another.
    pub fn check(self, report: &Report) {
        let body = self.body.and_then(|keys| keys.read(&report.at("body")));
        let (curves, _) = curves(self.curve, report);
        self.material.map(|keys| keys.read(&curves, &report.at("material")));
        conditions(body.as_ref(), &curves, self.support, self.load, report);
    }
}
