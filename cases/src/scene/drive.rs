//! Drives of tools: displacements, turns, forces.

use std::sync::Arc;

use catalogue::Problem;
use contact::ToolShape;
use geometry::{Point3, Vector3};
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::Deserialize;
use shape::Curve;

use super::curve::{NamedCurve, named as curve_named};
use super::report::Report;
use super::units::{Angle, Force, Length, Pressure, Q, Time};

/// Drive of a tool: one of closure, path, turn, force along its direction of motion, and mean pressure on its face
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-one-of" = ["closure", "path", "turn", "force", "pressure"]))]
pub(crate) struct DriveKeys {
    closure: Option<Q<Length>>,
    /// Displacements and turns of the tool, one after another, at constant speed: [["0 mm", "0 mm", "-3 mm"],
    /// { turn = "30 deg", about = { axis = [0, 0, 1] } }] presses and then twists
    path: Option<Vec<LegKeys>>,
    /// Angle by which the tool turns, such as a jaw about its hinge
    turn: Option<Q<Angle>>,
    /// Axis of the turn
    about: Option<AboutKeys>,
    force: Option<Q<Force>>,
    pressure: Option<Q<Pressure>>,
    /// Time of the ramp (dynamics)
    over: Option<Q<Time>>,
    /// Name of the curve that the drive follows; the common growth unless given
    curve: Option<String>,
}

/// Leg of a path: a displacement, or a turn
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum LegKeys {
    Move([Q<Length>; 3]),
    Turn(TurnKeys),
}

/// Turn of a tool about an axis
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TurnKeys {
    /// Angle
    turn: Q<Angle>,
    about: AboutKeys,
}

/// Axis of a turn, fixed to the tool
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct AboutKeys {
    /// Point on the axis while the tool stands at its start; the tool's centre unless given
    point: Option<[Q<Length>; 3]>,
    /// Direction of the axis; a positive turn is right-handed about it
    axis: [f64; 3],
    /// Distance from the axis at which the travel of a plate is measured; that of its farthest corner for a bounded
    /// tool
    arm: Option<Q<Length>>,
}

/// Drive of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Travel along the direction of motion or the path, in metres.
    Closure(f64),
    /// Total force along the direction of motion, in newtons.
    Force(f64),
    /// Mean pressure on the tool's face, in pascals.
    Pressure(f64),
}

/// Leg of a tool's path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leg {
    /// Displacement, in metres.
    Move([f64; 3]),
    /// Turn about an axis.
    Turn(Turn),
}

/// Turn of a tool about an axis that is fixed to the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Angle in radians, positive.
    pub angle: f64,
    /// Point on the axis while the tool stands at its start, in metres.
    pub point: [f64; 3],
    /// Unit vector of the axis, about which the turn is right-handed.
    pub axis: [f64; 3],
    /// Distance from the axis at which the travel is measured, in metres.
    pub arm: f64,
}

impl Leg {
    /// Travel of the tool, in metres.
    pub fn travel(&self) -> f64 {
        match self {
            Leg::Move(by) => Vector3::from(*by).norm(),
            Leg::Turn(turn) => turn.angle * turn.arm,
        }
    }
}

/// Drive before the tool has its place.
pub(super) struct GivenDrive {
    kind: Kind,
    /// Word of the key.
    pub word: &'static str,
    pub over: Option<f64>,
    pub curve: Option<Arc<Curve>>,
}

enum Kind {
    Fixed(Drive),
    Legs(Vec<(String, GivenLeg)>),
}

/// Leg before the tool has its place.
pub(super) enum GivenLeg {
    /// Displacement, m.
    Move(Vector3),
    Turn(GivenTurn),
}

pub(super) struct GivenTurn {
    angle: f64,
    point: Option<Point3>,
    axis: Vector3,
    arm: Option<f64>,
}

impl DriveKeys {
    pub(super) fn read(self, curves: &[NamedCurve], report: &Report) -> Option<GivenDrive> {
        let DriveKeys { closure, path, turn, about, force, pressure, over, curve } = self;
        let help = "leave it out: the curve has its own times";
        report.require(over.is_none() || curve.is_none(), "drive.over", "can't be combined with curve", help);
        if turn.is_none() && about.is_some() {
            let help = "give turn = \"30 deg\" too; a turn of a path has its own about";
            report.add("drive.about", Problem::new("goes with turn only").help(help));
            return None;
        }
        let curve = curve_named(curve.as_ref(), curves, "drive.curve", report);
        let (kind, word) = match (closure, path, turn, force, pressure) {
            (Some(q), None, None, None, None) => (Kind::Fixed(Drive::Closure(q.0)), "closure"),
            (None, Some(path), None, None, None) => (Kind::Legs(legs(path, report)?), "path"),
            (None, None, Some(turn), None, None) => {
                let Some(about) = about else {
                    let help = "give the axis of the turn: about = { point = [...], axis = [0, 0, 1] }";
                    report.missing("drive.about", help);
                    return None;
                };
                let leg = TurnKeys { turn, about }.read("drive", report)?;
                (Kind::Legs(vec![("drive".into(), GivenLeg::Turn(leg))]), "turn")
            }
            (None, None, None, Some(q), None) => {
                (Kind::Fixed(Drive::Force(report.positive("drive.force", q.0))), "force")
            }
            (None, None, None, None, Some(q)) => {
                (Kind::Fixed(Drive::Pressure(report.positive("drive.pressure", q.0))), "pressure")
            }
            _ => {
                let help = "give one of closure, path, turn, force and pressure";
                report.add("drive", Problem::new("is not one drive").help(help));
                return None;
            }
        };
        Some(GivenDrive { kind, word, over: over.map(|q| q.0), curve })
    }
}

fn legs(path: Vec<LegKeys>, report: &Report) -> Option<Vec<(String, GivenLeg)>> {
    if path.is_empty() {
        report.add("drive.path", Problem::new("is empty").help("give one or more displacements or turns"));
        return None;
    }
    let each = path.into_iter().enumerate().map(|(index, leg)| {
        let key = format!("drive.path[{index}]");
        let leg = match leg {
            LegKeys::Move(by) => {
                let by = Vector3::from(by.map(|q| q.0));
                let help = "leave it out, or give a displacement";
                report.require(by.norm() > 0.0, &key, "has no length", help);
                GivenLeg::Move(by)
            }
            LegKeys::Turn(turn) => GivenLeg::Turn(turn.read(&key, report)?),
        };
        Some((key, leg))
    });
    // All legs are read, so that each has its errors.
    each.collect::<Vec<_>>().into_iter().collect()
}

impl TurnKeys {
    /// Reads a turn at `key`. A negative angle is a turn about the opposite axis.
    fn read(self, key: &str, report: &Report) -> Option<GivenTurn> {
        let TurnKeys { turn, about } = self;
        let axis = Vector3::from(about.axis).try_normalize(0.0);
        if axis.is_none() {
            let help = "give a direction such as [0, 0, 1]";
            report.add(&format!("{key}.about.axis"), Problem::new("has no direction").help(help));
        }
        let is_turn = turn.0 != 0.0;
        report.require(is_turn, &format!("{key}.turn"), "is no turn", "give an angle such as \"30 deg\"");
        let arm = about.arm.map(|arm| report.positive(&format!("{key}.about.arm"), arm.0));
        let point = about.point.map(|point| Point3::from(point.map(|q| q.0)));
        let axis = axis.filter(|_| is_turn)? * turn.0.signum();
        Some(GivenTurn { angle: turn.0.abs(), point, axis, arm })
    }
}

impl GivenDrive {
    /// First leg of a path.
    pub fn first(&self) -> Option<&GivenLeg> {
        match &self.kind {
            Kind::Fixed(_) => None,
            Kind::Legs(legs) => legs.first().map(|(_, leg)| leg),
        }
    }

    /// Returns the drive and the legs of a tool with its centre at `at` (m), turned by `turned` (3, 3).
    pub fn placed(
        self,
        shape: &ToolShape,
        at: &Point3,
        turned: &Matrix3<f64>,
        report: &Report,
    ) -> Option<(Drive, Vec<Leg>)> {
        let legs = match self.kind {
            Kind::Fixed(drive) => return Some((drive, Vec::new())),
            Kind::Legs(legs) => legs,
        };
        let each = legs.into_iter().map(|(key, leg)| match leg {
            GivenLeg::Move(by) => Some(Leg::Move(by.into())),
            GivenLeg::Turn(turn) => {
                let point = turn.point.unwrap_or(*at);
                let arm = arm(&turn, &point, shape, (at, turned), &format!("{key}.about.arm"), report)?;
                Some(Leg::Turn(Turn { angle: turn.angle, point: point.into(), axis: turn.axis.into(), arm }))
            }
        });
        let legs: Vec<Leg> = each.collect::<Option<_>>()?;
        Some((Drive::Closure(legs.iter().map(Leg::travel).sum()), legs))
    }
}

impl GivenTurn {
    /// Unit direction in which the centre `at` (m) of a tool first moves; the axis, if it lies on the axis.
    pub fn along(&self, at: &Point3) -> Vector3 {
        let arm = at - self.point.unwrap_or(*at);
        let way = self.axis.cross(&arm);
        way.try_normalize(1e-9 * arm.norm()).unwrap_or(self.axis)
    }
}

/// Returns the distance (m) from the axis at which the travel is measured: that of the farthest corner of the
/// tool's box, so that no place of the tool travels farther.
fn arm(
    turn: &GivenTurn,
    point: &Point3,
    shape: &ToolShape,
    (at, turned): (&Point3, &Matrix3<f64>),
    key: &str,
    report: &Report,
) -> Option<f64> {
    match (turn.arm, shape.is_endless()) {
        (Some(arm), true) => Some(arm),
        (None, true) => {
            let help = "a plate has no farthest place: give the distance from the axis at which the travel is measured";
            report.missing(key, help);
            None
        }
        (Some(_), false) => {
            let help = "leave it out: the travel is that of the tool's farthest corner";
            report.add(key, Problem::new("is for a plate only").help(help));
            None
        }
        (None, false) => {
            let half = shape.bounds().1;
            let corner = |k: usize| {
                let sign = |axis: usize| if k >> axis & 1 == 1 { 1.0 } else { -1.0 };
                at + turned * Vector3::from_fn(|axis, _| sign(axis) * half[axis])
            };
            let each = (0..8).map(|k| turn.axis.cross(&(corner(k) - point)).norm());
            Some(each.fold(0.0, f64::max))
        }
    }
}
