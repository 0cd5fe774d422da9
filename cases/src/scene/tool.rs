//! Rigid tools: shape, drive and contact parameters.

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;

use catalogue::{Problem, find};
use contact::{ContactError, RoundedSurface, ToolShape};
use nalgebra::Matrix3;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use serde_json::json;
use shape::Curve;

use super::body::Body;
use super::curve::NamedCurve;
use super::drive::{Drive, DriveKeys, GivenLeg, Leg};
use super::mesh_file::MeshFile;
use super::procedure::{Procedure, ProcedureKind};
use super::report::Report;
use super::touch::AtKeys;
use super::units::{ContactSlope, Length, Q, Unit};
use super::vocabulary::{Given, ToolShapes, Vocabulary, Word, build, settings, tagged};

/// A rigid tool
#[derive(Deserialize)]
pub(crate) struct ToolKeys {
    shape: ShapeWord,
    #[serde(flatten)]
    beside: BesideShape,
    #[serde(flatten)]
    settings: Given<ToolShapes>,
    // The last, because it takes its keys from those that follow: `axis` is a setting of named shapes too.
    #[serde(flatten)]
    surface: Option<SurfaceKeys>,
}

/// The word of a tool's shape
enum ShapeWord {
    Named(Word<ToolShapes>),
    File,
}

const FILE: &str = "file";

/// The closed surface of a file (STL, OBJ, PLY, OFF, .vtp, .mesh), with rounded edges and corners
#[derive(Deserialize, JsonSchema)]
struct SurfaceKeys {
    /// The file, relative to the folder of the scene
    path: String,
    /// Unit of the numbers in the file
    unit: Unit<Length>,
    /// Radius of the rounding, which is added to the surface all round; larger than the penetration of the
    /// points in contact
    rounding: Q<Length>,
    /// Direction of the file's z axis; z unless given
    axis: Option<[f64; 3]>,
}

impl<'de> Deserialize<'de> for ShapeWord {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<ShapeWord, D::Error> {
        match String::deserialize(deserializer)?.as_str() {
            FILE => Ok(ShapeWord::File),
            name => find(ToolShapes::ENTRIES, name)
                .map(|entry| ShapeWord::Named(Word(entry)))
                .map_err(D::Error::custom),
        }
    }
}

/// Keys that every tool has, whatever its shape
#[derive(Deserialize, JsonSchema)]
struct BesideShape {
    name: String,
    at: AtKeys,
    /// Direction of motion; not with a path
    along: Option<[f64; 3]>,
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
        let mut schema = tagged::<ToolShapes, BesideShape>("shape", "A rigid tool", generator);
        let surface = SurfaceKeys::json_schema(generator).to_value();
        let mut form = BesideShape::json_schema(generator).to_value();
        for (key, of_key) in surface["properties"].as_object().into_iter().flatten() {
            form["properties"][key] = of_key.clone();
        }
        form["properties"]["shape"] = json!({ "type": "string", "const": FILE });
        let required = form["required"].as_array_mut().expect("required keys");
        required.push("shape".into());
        required.extend(surface["required"].as_array().into_iter().flatten().cloned());
        form["description"] = surface["description"].clone();
        form["additionalProperties"] = json!(false);
        let forms = schema.get_mut("oneOf").and_then(serde_json::Value::as_array_mut);
        forms.expect("a form for each shape").push(form);
        schema
    }
}

/// A rigid tool.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    /// Name, unique within the scene.
    pub name: String,
    /// Shape of the tool.
    pub shape: ToolShape,
    /// File of the shape, if it is a surface.
    pub file: Option<PathBuf>,
    /// Initial position of the centre, in metres: of a surface, the middle of its bounding box.
    pub at: [f64; 3],
    /// Unit direction of motion of the centre, at the start of a path. The axis, if the tool first turns about
    /// its centre.
    pub along: [f64; 3],
    /// Legs of a path; empty for a straight motion.
    pub path: Vec<Leg>,
    /// Direction of the z axis of the shape's frame, as a unit vector: the axis of a cylinder or capsule, the
    /// outward normal of a plate's face. `None` for a shape aligned with the axes of the scene.
    pub axis: Option<[f64; 3]>,
    /// Drive of the tool.
    pub drive: Drive,
    /// Time of the ramp in seconds (dynamics).
    pub over: Option<f64>,
    /// Factor of the drive over time; `None` for the common growth.
    pub curve: Option<Arc<Curve>>,
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

impl ToolKeys {
    pub fn read(self, body: Option<&Body>, curves: &[NamedCurve], report: &Report) -> Option<Tool> {
        let keys = self.beside;
        let placed = match self.shape {
            ShapeWord::Named(word) => named(&word, self.settings, report),
            ShapeWord::File => self.surface.and_then(|keys| surface(keys, report)),
        };
        let drive = keys.drive.read(curves, report)?;
        let along = match (keys.along, drive.first()) {
            (Some(along), None) => Some(unit(along, "along", report)?),
            (None, Some(GivenLeg::Move(leg))) => Some(unit((*leg).into(), "drive.path[0]", report)?),
            (None, Some(GivenLeg::Turn(_))) => None,
            (Some(_), Some(_)) => {
                let help = format!("leave it out: a {} has directions of its own", drive.word);
                let problem = format!("can't be combined with drive.{}", drive.word);
                report.add("along", Problem::new(problem).help(&help));
                return None;
            }
            (None, None) => {
                report.missing("along", "give the direction of motion, such as along = [0, 0, -1]");
                return None;
            }
        };
        let Placed { shape, file, middle, axis } = placed?;
        let axis = match axis {
            Some(axis) => Some(unit(axis, "axis", report)?),
            None => None,
        };
        let framed = |along: [f64; 3]| {
            let axis = axis.or_else(|| shape.axis(along.into()).map(Into::into));
            (axis, axis.map_or_else(Matrix3::identity, |axis| contact::Tool::turned_to(&axis.into())))
        };
        let (at, along) = match (keys.at, along, drive.first()) {
            (AtKeys::Point(at), along, first) => {
                let at = std::array::from_fn(|a| at[a].0 + middle[a]);
                let along = match (along, first) {
                    (None, Some(GivenLeg::Turn(turn))) => turn.along(&at.into()).into(),
                    (along, _) => along?,
                };
                (at, along)
            }
            (touch, Some(along), _) => (touch.read((&shape, framed(along).1, along), body, report)?, along),
            (_, None, _) => {
                let help = "give at = [x, y, z], or let a path start with a displacement";
                let problem = Problem::new("has no direction, because the tool turns first");
                report.add("at.touch", problem.help(help));
                return None;
            }
        };
        let (axis, turned) = framed(along);
        let (over, curve) = (drive.over, drive.curve.clone());
        let (drive, path) = drive.placed(&shape, &at.into(), &turned, report)?;
        Some(Tool {
            name: keys.name,
            shape,
            file,
            at,
            along,
            path,
            axis,
            drive,
            over,
            curve,
            penalty: report.positive("penalty", keys.penalty.0),
            friction: friction(keys.friction.unwrap_or(0.0), keys.stick, report),
        })
    }
}

/// A shape as the solver takes it.
struct Placed {
    shape: ToolShape,
    file: Option<PathBuf>,
    /// Position of the origin of the shape's frame relative to that of its file, m.
    middle: [f64; 3],
    /// Direction of its z axis, of any length, if the scene gives one.
    axis: Option<[f64; 3]>,
}

fn named(word: &Word<ToolShapes>, given: Given<ToolShapes>, report: &Report) -> Option<Placed> {
    let values = settings(word, given, report)?;
    let shape = build(word.0, &values, "shape", report)?;
    let axis = values.list("axis").and_then(|axis| axis.try_into().ok());
    Some(Placed { shape, file: None, middle: [0.0; 3], axis })
}

fn surface(keys: SurfaceKeys, report: &Report) -> Option<Placed> {
    let file = MeshFile::read(&keys.path, Some(keys.unit), "path", report);
    let rounding = report.positive("rounding", keys.rounding.0);
    if !file.path.is_file() || !(rounding > 0.0) {
        return None;
    }
    let unreadable = |bad| {
        report.add("path", Problem::new(format!("can't be read: {bad}")).help(mesh_files::SURFACES));
    };
    let surface = mesh_files::read_surface(&file.path, file.unit).map_err(unreadable).ok()?;
    let invalid = |bad: ContactError| report.add("rounding", Problem::new(bad.to_string()));
    let shape = RoundedSurface::new(Arc::new(surface), rounding).map_err(invalid).ok()?;
    let axis = match keys.axis {
        Some(axis) => Some(unit(axis, "axis", report)?),
        None => None,
    };
    let turned = axis.map_or_else(Matrix3::identity, |axis| contact::Tool::turned_to(&axis.into()));
    let middle = (turned * shape.middle()).into();
    Some(Placed { shape: shape.into(), file: Some(file.path), middle, axis })
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
        // In explicit dynamics a drive may act at once.
        let sound = match kind {
            ProcedureKind::Explicit => tool.over.is_none_or(|over| over >= 0.0),
            _ => tool.over.is_none_or(|over| over > 0.0),
        };
        report.require(
            sound,
            "drive.over",
            "is no duration of a ramp",
            "give a time above zero, or leave it out",
        );
        if matches!(tool.drive, Drive::Pressure(_)) && tool.shape.face_area(&tool.along.into()).is_none() {
            let help =
                "only a rounded-box that closes along x, y or z has a face of a known area; give force";
            report.add("drive.pressure", Problem::new("has no face to act on").help(help));
        }
    }
}
