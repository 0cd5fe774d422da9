//! Rigid tools: shape, drive and contact parameters.

use std::borrow::Cow;

use catalogue::Problem;
use contact::ToolShape;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use super::procedure::{Procedure, ProcedureKind};
use super::report::Report;
use super::units::{ContactSlope, Force, Length, Pressure, Q, Time};
use super::vocabulary::{Given, ToolShapes, Word, build, settings, tagged};

/// A rigid tool
#[derive(Deserialize)]
pub(crate) struct ToolKeys {
    shape: Word<ToolShapes>,
    #[serde(flatten)]
    beside: BesideShape,
    #[serde(flatten)]
    settings: Given<ToolShapes>,
}

/// Keys that every tool has, whatever its shape
#[derive(Deserialize, JsonSchema)]
struct BesideShape {
    name: String,
    at: [Q<Length>; 3],
    /// Direction of motion
    along: [f64; 3],
    drive: DriveKeys,
    /// Normal pressure per penetration
    penalty: Q<ContactSlope>,
    /// Coulomb coefficient
    friction: Option<f64>,
    /// Tangential traction per elastic slip, with friction
    stick: Option<Q<ContactSlope>>,
}

impl JsonSchema for ToolKeys {
    fn schema_name() -> Cow<'static, str> {
        "tool".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        tagged::<ToolShapes, BesideShape>("shape", "A rigid tool", generator)
    }
}

/// Drive of a tool: one of closure, force along its direction of motion, and mean pressure on its face
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-one-of" = ["closure", "force", "pressure"]))]
struct DriveKeys {
    closure: Option<Q<Length>>,
    force: Option<Q<Force>>,
    pressure: Option<Q<Pressure>>,
    /// Time of the ramp (dynamics)
    over: Option<Q<Time>>,
}

/// A rigid tool.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    /// Name, unique within the scene.
    pub name: String,
    /// Shape of the tool.
    pub shape: ToolShape,
    /// Initial position of the centre, in metres.
    pub at: [f64; 3],
    /// Unit direction of motion.
    pub along: [f64; 3],
    /// Direction of the z axis of the shape's frame, as a unit vector: the axis of a cylinder or capsule, the
    /// outward normal of a plate's face. `None` for a shape aligned with the axes of the scene.
    pub axis: Option<[f64; 3]>,
    /// Drive of the tool.
    pub drive: Drive,
    /// Time of the ramp in seconds (dynamics).
    pub over: Option<f64>,
    /// Normal pressure per penetration, in pascals per metre.
    pub penalty: f64,
    /// Friction; `None` without a coefficient, or with a coefficient of 0.
    pub friction: Option<Friction>,
}

/// Coulomb friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coefficient, positive.
    pub coefficient: f64,
    /// Tangential traction per elastic slip while the surfaces stick, in pascals per metre.
    pub stick: f64,
}

/// Drive of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Displacement along the direction of motion, in metres.
    Closure(f64),
    /// Total force along the direction of motion, in newtons.
    Force(f64),
    /// Mean pressure on the tool's face, in pascals.
    Pressure(f64),
}

impl ToolKeys {
    pub fn read(self, report: &Report) -> Option<Tool> {
        let keys = self.beside;
        let values = settings(&self.shape, self.settings, report);
        let shape = values.as_ref().and_then(|values| build(self.shape.0, values, "shape", report));
        let drive = match (keys.drive.closure, keys.drive.force, keys.drive.pressure) {
            (Some(q), None, None) => Drive::Closure(q.0),
            (None, Some(q), None) => Drive::Force(report.positive("drive.force", q.0)),
            (None, None, Some(q)) => Drive::Pressure(report.positive("drive.pressure", q.0)),
            _ => {
                let help = "give one of closure, force and pressure";
                report.add("drive", Problem::new("is not one drive").help(help));
                return None;
            }
        };
        let along = unit(keys.along, "along", report)?;
        let (shape, values) = (shape?, values?);
        let axis = match values.list("axis") {
            Some(&[x, y, z]) => Some(unit([x, y, z], "axis", report)?),
            _ => shape.axis(along.into()).map(Into::into),
        };
        Some(Tool {
            name: keys.name,
            shape,
            at: keys.at.map(|q| q.0),
            along,
            axis,
            drive,
            over: keys.drive.over.map(|q| q.0),
            penalty: report.positive("penalty", keys.penalty.0),
            friction: friction(keys.friction.unwrap_or(0.0), keys.stick, report),
        })
    }
}

fn friction(coefficient: f64, stick: Option<Q<ContactSlope>>, report: &Report) -> Option<Friction> {
    report.require(coefficient >= 0.0, "friction", "is negative", "give a coefficient of 0 or more");
    let stick = stick.map(|stick| report.positive("stick", stick.0));
    match (coefficient > 0.0, stick) {
        (true, Some(stick)) => return Some(Friction { coefficient, stick }),
        (true, None) => report.missing(
            "stick",
            "friction needs the slope of the traction while the surfaces stick: stick = \"0.1 MPa/mm\"",
        ),
        (false, Some(_)) => {
            let help = "leave it out, or give friction = 0.15";
            report.add("stick", Problem::new("goes with friction only").help(help));
        }
        (false, None) => {}
    }
    None
}

/// A direction as a unit vector.
fn unit(direction: [f64; 3], key: &str, report: &Report) -> Option<[f64; 3]> {
    let norm = direction.iter().map(|a| a * a).sum::<f64>().sqrt();
    report.require(norm > 0.0, key, "has no direction", "give a direction such as [0, 0, -1]");
    (norm > 0.0).then(|| direction.map(|a| a / norm))
}

/// Reports contradictions of the tools with each other and with the procedure.
pub(crate) fn demands(tools: &[Tool], procedure: &Procedure, report: &Report) {
    let kind = procedure.kind();
    for (i, tool) in tools.iter().enumerate() {
        let report = report.at(&format!("tool[{i}]"));
        if matches!(kind, ProcedureKind::Linear | ProcedureKind::Modes) {
            let problem = format!("'{}' touches the body, but the procedure is linear", tool.name);
            let help = "contact is not linear: add [procedure] kind = \"static\" and steps = 10";
            report.add("", Problem::new(problem).help(help));
        }
        if tools[..i].iter().any(|other| other.name == tool.name) {
            report.add("name", Problem::new("is the name of another tool").help("names are unique"));
        }
        if tool.over.is_some() && procedure.ramp().is_none() {
            let help = format!("a {} procedure has no time axis: leave it out", kind.name());
            report.add("drive.over", Problem::new("is the time of a ramp").help(help));
        }
        if matches!(tool.drive, Drive::Pressure(_)) && tool.shape.face_area(&tool.along.into()).is_none() {
            let help =
                "only a rounded-box that closes along x, y or z has a face of a known area; give force";
            report.add("drive.pressure", Problem::new("has no face to act on").help(help));
        }
    }
}
