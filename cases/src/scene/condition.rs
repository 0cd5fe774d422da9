//! Supports and loads of a scene.

use std::sync::Arc;

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;
use shape::Curve;

use super::body::Body;
use super::curve::{NamedCurve, named};
use super::field::{ExactWord, FieldKeys, ScalarField, VectorField, VectorKeys};
use super::procedure::{Procedure, ProcedureKind};
use super::region::Region;
use super::report::Report;
use super::selection::{Names, Place, PlaceKeys};
use super::units::{BodyForce, Force, Length, Pressure, Q, Time};

/// Prescribed displacement along one axis
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum AxisKeys {
    Exact(ExactWord),
    Field(FieldKeys<Length>),
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct AxesKeys {
    x: Option<AxisKeys>,
    y: Option<AxisKeys>,
    z: Option<AxisKeys>,
}

/// Prescribed displacement: some axes, all three as [x, y, z], or "exact"
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum MoveKeys {
    Exact(ExactWord),
    All([AxisKeys; 3]),
    Axes(AxesKeys),
}

/// Prescribed displacement of faces, an edge, or points
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SupportKeys {
    /// Names of surfaces given by the shape, or of surfaces, curves, points and sets of nodes of the mesh file
    on: Option<Names>,
    /// Comparisons joined by 'and'
    #[serde(rename = "where")]
    place: Option<Region>,
    /// Surfaces that share an edge or a corner, such as ["x-min", "z-min"], or a curve of the mesh file
    edge: Option<Names>,
    /// Points of the body, which are nodes of elements: [["5 mm", "0 mm", "0 mm"]]
    at: Option<Vec<[Q<Length>; 3]>>,
    /// Axes fixed at zero, such as "xyz"
    fix: Option<String>,
    #[serde(rename = "move")]
    motion: Option<MoveKeys>,
    /// Name of the curve that the motion follows; the common growth unless given
    curve: Option<String>,
    /// Start and end of the part of the loading in which the support acts, such as [0.4, 1]; in dynamics times,
    /// such as ["0 s", "2 s"]. One that starts late holds the points where they are then; its motion counts
    /// from there. All of the loading unless given
    during: Option<SpanKeys>,
}

/// Start and end of a part of the loading
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum SpanKeys {
    Parts([f64; 2]),
    Times([Q<Time>; 2]),
}

/// Part of the loading in which a support acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Start, as a fraction of the loading or in seconds.
    pub from: f64,
    /// End, likewise.
    pub until: f64,
    pub(crate) in_time: bool,
}

impl From<SpanKeys> for Span {
    fn from(keys: SpanKeys) -> Span {
        match keys {
            SpanKeys::Parts([from, until]) => Span { from, until, in_time: false },
            SpanKeys::Times([from, until]) => Span { from: from.0, until: until.0, in_time: true },
        }
    }
}

/// A load: exactly one of traction, pressure (along the inner normal), force and body force
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LoadKeys {
    on: Option<Names>,
    #[serde(rename = "where")]
    place: Option<Region>,
    /// Force per area as a vector; for a force along the inner normal take pressure = "1 kPa"
    traction: Option<VectorKeys<Pressure>>,
    /// Force per area along the inner normal: of the deformed surface with a law of large strain in a procedure
    /// of large displacements, otherwise of the undeformed surface
    pressure: Option<FieldKeys<Pressure>>,
    /// Whether a pressure acts along the normals and on the areas of the undeformed surface; false unless given.
    /// With a traction: whether it is per area of the undeformed surface; true unless given
    dead: Option<bool>,
    /// Force as a vector: at each point of 'at', or in total, evenly on the faces of 'on' or 'where' or on the
    /// nodes of sets of the mesh file
    force: Option<[Q<Force>; 3]>,
    /// Points of the body at which a force acts: [["5 mm", "0 mm", "0 mm"]]
    at: Option<Vec<[Q<Length>; 3]>>,
    /// Force per volume, everywhere
    body: Option<VectorKeys<BodyForce>>,
    /// Name of the curve that the load follows; the common growth unless given
    curve: Option<String>,
}

/// Prescribed displacement of a support along one axis, in metres.
#[derive(Clone, Debug)]
pub enum Prescribed {
    /// A given displacement.
    Field(ScalarField),
    /// The displacement of the exact solution in `[reference]`.
    Exact,
}

/// Prescribed displacement of a part of the body.
#[derive(Clone, Debug)]
pub struct Support {
    /// Constrained part of the body.
    pub place: Place,
    /// Prescribed displacements along x, y, z; `None` for a free axis. At least one is prescribed.
    pub motion: [Option<Prescribed>; 3],
    /// Factor of the displacements over time; `None` for the common growth.
    pub curve: Option<Arc<Curve>>,
    /// Part of the loading in which the support acts; `None` for all of it.
    pub during: Option<Span>,
}

impl Support {
    /// Whether a prescribed displacement differs from zero.
    pub fn moves(&self) -> bool {
        let still = |p: &Prescribed| matches!(p, Prescribed::Field(ScalarField::Constant(0.0)));
        !self.motion.iter().flatten().all(still)
    }
}

/// A load.
#[derive(Clone, Debug)]
pub struct Load {
    /// Loaded part of the body.
    pub place: Place,
    /// Kind and value.
    pub kind: LoadKind,
    /// Whether a pressure keeps the normals and the areas of the undeformed surface, or a traction its areas; true
    /// for all other loads.
    pub dead: bool,
    /// Factor of the load over time; `None` for the common growth.
    pub curve: Option<Arc<Curve>>,
}

/// Kinds of loads.
#[derive(Clone, Debug)]
pub enum LoadKind {
    /// Force per area, in pascals.
    Traction(VectorField),
    /// Pressure along the inner normal, in pascals.
    Pressure(ScalarField),
    /// Force per volume, in newtons per cubic metre.
    Body(VectorField),
    /// Force on the loaded part of the surface in total, evenly per undeformed area, in newtons; on a set of
    /// nodes, evenly per node.
    Force([f64; 3]),
    /// Force at each of some points of the body.
    Points {
        /// Points of the undeformed body, in metres.
        at: Vec<[f64; 3]>,
        /// Force at each point, in newtons.
        force: [f64; 3],
    },
}

impl LoadKind {
    /// Whether the load varies in space.
    pub fn varies(&self) -> bool {
        match self {
            LoadKind::Traction(field) | LoadKind::Body(field) => field.varies(),
            LoadKind::Pressure(field) => field.varies(),
            LoadKind::Force(_) | LoadKind::Points { .. } => false,
        }
    }

    /// Whether the load is that of the exact solution.
    pub(crate) fn is_exact(&self) -> bool {
        matches!(self, LoadKind::Traction(VectorField::Exact) | LoadKind::Body(VectorField::Exact))
    }
}

impl SupportKeys {
    /// Reads a support; checks its names of surfaces if the body is known.
    pub fn read(self, body: Option<&Body>, curves: &[NamedCurve], report: &Report) -> Support {
        let curve = named(self.curve.as_ref(), curves, "curve", report);
        let SupportKeys { on, place, edge, at, .. } = self;
        let place = Place::of_support(PlaceKeys { on, place, edge, at }, report);
        body.inspect(|body| body.find(&place, report));
        let mut motion: [Option<Prescribed>; 3] = [None, None, None];
        if let Some(fix) = &self.fix {
            let sound = ["x", "y", "z", "xy", "xz", "yz", "xyz"].contains(&fix.as_str());
            let help = "write the axes fixed at zero in order: x, y, z, xy, xz, yz or xyz";
            report.require(sound, "fix", "is not a list of axes", help);
            let zero = Prescribed::Field(ScalarField::Constant(0.0));
            motion = ['x', 'y', 'z'].map(|axis| fix.contains(axis).then(|| zero.clone()));
        }
        match self.motion {
            Some(MoveKeys::Exact(_)) => {
                let help = "write move = { x = \"exact\" } for some axes, and fix for others";
                report.require(self.fix.is_none(), "move", "moves axes that 'fix' constrains", help);
                motion = std::array::from_fn(|_| Some(Prescribed::Exact));
            }
            Some(MoveKeys::Axes(axes)) => {
                let keys = ["move.x", "move.y", "move.z"];
                moved(&mut motion, [axes.x, axes.y, axes.z], keys, report);
            }
            Some(MoveKeys::All(axes)) => {
                moved(&mut motion, axes.map(Some), ["move[0]", "move[1]", "move[2]"], report);
            }
            None => {}
        }
        if motion.iter().all(Option::is_none) && self.fix.is_none() {
            report.missing("fix", "write fix = \"xyz\", or move = { z = \"-1 mm\" }");
        }
        Support { place, motion, curve, during: self.during.map(Span::from) }
    }
}

/// Adds the prescribed displacements along the axes, each at its key.
fn moved(
    motion: &mut [Option<Prescribed>; 3],
    axes: [Option<AxisKeys>; 3],
    keys: [&str; 3],
    report: &Report,
) {
    for ((motion, given), key) in motion.iter_mut().zip(axes).zip(keys) {
        let Some(given) = given else { continue };
        let free = motion.is_none();
        report.require(free, key, "moves an axis that 'fix' constrains", "name each axis once");
        *motion = Some(match given {
            AxisKeys::Exact(_) => Prescribed::Exact,
            AxisKeys::Field(field) => Prescribed::Field(field.into()),
        });
    }
}

impl LoadKeys {
    /// Reads a load; checks its names of surfaces if the body is known.
    pub fn read(self, body: Option<&Body>, curves: &[NamedCurve], report: &Report) -> Option<Load> {
        let curve = named(self.curve.as_ref(), curves, "curve", report);
        let points = self.at.map(|at| at.into_iter().map(|x| x.map(|q| q.0)).collect::<Vec<_>>());
        let force = self.force.map(|force| force.map(|q| q.0));
        let (has_force, at) = (force.is_some(), points.is_some());
        let kind = match (self.traction, self.pressure, self.body, force) {
            (Some(traction), None, None, None) => LoadKind::Traction(traction.into()),
            (None, Some(pressure), None, None) => LoadKind::Pressure(pressure.into()),
            (None, None, Some(force), None) => LoadKind::Body(force.into()),
            (None, None, None, Some(force)) => match points {
                Some(at) => {
                    report.require(!at.is_empty(), "at", "names no point", "give one or more points");
                    LoadKind::Points { at, force }
                }
                None => LoadKind::Force(force),
            },
            (None, None, None, None) => {
                report.missing("", "give one of traction, pressure, force and body");
                return None;
            }
            _ => {
                let help = "give one of traction, pressure, force and body";
                report.add("", Problem::new("has several kinds of load").help(help));
                return None;
            }
        };
        let (problem, help) =
            ("belongs to a pressure or a traction", "all other loads are always dead loads");
        let is_pressure = matches!(kind, LoadKind::Pressure(_));
        let is_traction = matches!(kind, LoadKind::Traction(VectorField::Components(_)));
        report.require(self.dead.is_none() || is_pressure || is_traction, "dead", problem, help);
        report.require(
            has_force || !at,
            "at",
            "belongs to a force",
            "give on or where for a load on a surface",
        );
        let dead = self.dead.filter(|_| is_pressure || is_traction).unwrap_or(!is_pressure);
        let everywhere = match kind {
            LoadKind::Body(_) => Some(("limits a body force to a region", "a body force acts everywhere")),
            LoadKind::Points { .. } => Some((
                "gives a place beside the points of 'at'",
                "give one: points, or faces that carry the force in total",
            )),
            _ => None,
        };
        let place = match everywhere {
            None => Place::required(self.on, self.place, report),
            Some((problem, help)) => {
                let place = Place::read(self.on, self.place, report);
                report.require(!matches!(place, Place::On(_)), "on", problem, help);
                report.require(!matches!(place, Place::Where(_)), "where", problem, help);
                place
            }
        };
        body.inspect(|body| body.find(&place, report));
        Some(Load { place, kind, dead, curve })
    }
}

/// Reports contradictions of supports and loads with the procedure, and values of an exact solution in a
/// scene without one.
pub(crate) fn demands(
    (supports, loads): (&[Support], &[Load]),
    procedure: &Procedure,
    has_exact: bool,
    report: &Report,
) {
    let vibrates = procedure.kind() == ProcedureKind::Modes;
    let follows = |support: &Support| support.motion.iter().flatten().any(|m| matches!(m, Prescribed::Exact));
    let lacking = "needs an exact solution";
    let add = "add [reference] exact = \"...\"";
    for (i, support) in supports.iter().enumerate() {
        let key = format!("support[{i}].move");
        report.require(has_exact || !follows(support), &key, lacking, add);
        let help = "give fix = \"xyz\"";
        report.require(
            !vibrates || !support.moves(),
            &key,
            "prescribes a motion, but the body vibrates freely",
            help,
        );
    }
    for (i, load) in loads.iter().enumerate() {
        report.require(has_exact || !load.kind.is_exact(), &format!("load[{i}]"), lacking, add);
    }
    if let (true, Some((problem, help))) = (vibrates, procedure.kind().lacks_displacements()) {
        report.require(loads.is_empty(), "load[0]", problem, help);
    }
    let jumps = procedure.has_inertia() && procedure.ramp().is_some_and(|ramp| ramp.over == Some(0.0));
    if let (true, Some(i)) = (jumps, supports.iter().position(|s| s.moves() && s.curve.is_none())) {
        let problem = Problem::new(format!("leaves no time for the motion of support[{i}]"));
        report.add("procedure.over", problem.help("a mass can't jump: give the duration of the motion"));
    }
}
