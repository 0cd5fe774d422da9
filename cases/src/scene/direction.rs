//! Directions of a material: constant, by expressions, from the data of the body's mesh file, by the depth of the wall,
//! or by the rule of a ventricle.

use catalogue::{Problem, suggest};
use mesh_files::is_mesh;
use schemars::JsonSchema;
use serde::Deserialize;

use super::body::Body;
use super::expression::Expression;
use super::field::ScalarField;
use super::report::Report;
use super::selection::Names;
use super::units::{Angle, Q};

/// Three numbers, three expressions in x, y and z (metres), or a rule
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum DirectionKeys {
    Constant([f64; 3]),
    Expressions([Expression; 3]),
    Rule(RuleKeys),
}

/// A rule for a direction: data of the mesh file, the depth of a wall, or the helix of a ventricle
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RuleKeys {
    /// Name of an array of vectors, one for each cell or node of the body's mesh file
    data: Option<String>,
    /// The wall between two surfaces, with its depth by Laplace's equation
    depth: Option<DepthKeys>,
    /// Angle from the circumference towards the base, at the inner and at the outer wall of a ventricle or at the
    /// surfaces `from` and `to` of a depth, and linear in the depth. With a depth and no angle: the direction
    /// through the wall
    helix: Option<[Q<Angle>; 2]>,
    /// Long axis about which the circumference of a wall runs, towards the base; for a helix by a depth
    axis: Option<[f64; 3]>,
}

/// Two surfaces with a wall between them
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DepthKeys {
    /// Surface of depth 0
    from: Names,
    /// Surface of depth 1
    to: Names,
}

/// A direction as a function of the undeformed position.
#[derive(Clone, Debug, PartialEq)]
pub enum Direction {
    /// A vector of any length.
    Field([ScalarField; 3]),
    /// Vectors of the cells or nodes of the body's mesh file, by the name of their array.
    Data(String),
    /// By the depth of a wall.
    Depth(WallRule),
    /// In the wall of a ventricle, at an angle (radians) from the circumference towards the base: at the inner and
    /// at the outer wall, and linear in the depth.
    Helix([f64; 2]),
}

/// Directions in the wall between two surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct WallRule {
    /// Names of the surface of depth 0.
    pub from: Vec<String>,
    /// Names of the surface of depth 1.
    pub to: Vec<String>,
    /// The helix of the direction; `None` for the direction through the wall.
    pub helix: Option<WallHelix>,
}

/// A direction that turns through a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallHelix {
    /// Long axis, of any length.
    pub axis: [f64; 3],
    /// Angle (radians) from the circumference towards the end of the axis, at depth 0 and at depth 1.
    pub angles: [f64; 2],
}

impl DirectionKeys {
    /// Reads the direction under `key` of the table of `report`.
    pub fn read(self, key: &str, report: &Report) -> Option<Direction> {
        let direction = match self {
            DirectionKeys::Constant(components) => Direction::Field(components.map(ScalarField::Constant)),
            DirectionKeys::Expressions(of) => {
                Direction::Field(of.map(|of| ScalarField::Expression { of, factor: 1.0 }))
            }
            DirectionKeys::Rule(keys) => return keys.read(&report.at(key)),
        };
        let zero = |field: &ScalarField| matches!(field, ScalarField::Constant(0.0));
        let is_zero = matches!(&direction, Direction::Field(components) if components.iter().all(zero));
        report.require(!is_zero, key, "has no direction", "give a vector such as [1, 0, 0]");
        Some(direction)
    }
}

impl RuleKeys {
    fn read(self, report: &Report) -> Option<Direction> {
        let RuleKeys { data, depth, helix, axis } = self;
        let helix = helix.map(|angles| angles.map(|angle| angle.0));
        let one = "give one rule: data, depth (with or without helix and axis), or helix";
        if data.is_some() {
            let others = [("depth", depth.is_some()), ("helix", helix.is_some()), ("axis", axis.is_some())];
            for (key, _) in others.into_iter().filter(|(_, given)| *given) {
                report.add(key, Problem::new("can't be combined with data").help(one));
            }
            return data.map(Direction::Data);
        }
        let Some(depth) = depth else {
            let help = "leave it out: the axis of a ventricle is z. Or give depth = { from = ..., to = ... }";
            report.require(axis.is_none(), "axis", "has no effect without a depth", help);
            if helix.is_none() {
                report.add("", Problem::new("has no rule").help(one));
            }
            return helix.map(Direction::Helix);
        };
        let help = "give the long axis from the apex to the base, such as axis = [0, 0, 1]";
        match (&helix, &axis) {
            (Some(_), None) => report.missing("axis", help),
            (None, Some(_)) => {
                let help = "leave it out, or give the angles too: helix = [\"60 deg\", \"-60 deg\"]";
                report.add("axis", Problem::new("has no effect without a helix").help(help));
            }
            _ => {}
        }
        let sound = axis.is_none_or(|axis| axis.iter().any(|c| *c != 0.0));
        report.require(sound, "axis", "has no direction", help);
        let (from, to) = (Vec::from(depth.from), Vec::from(depth.to));
        for (key, names) in [("depth.from", &from), ("depth.to", &to)] {
            report.require(!names.is_empty(), key, "names nothing", "name a part of the surface");
        }
        if let Some(both) = to.iter().find(|name| from.contains(name)) {
            let help = "name the two opposite surfaces of the wall";
            report.add("depth.to", Problem::new("is also in from").found(both).help(help));
        }
        let helix = helix.zip(axis).map(|(angles, axis)| WallHelix { axis, angles });
        Some(Direction::Depth(WallRule { from, to, helix }))
    }
}

impl Direction {
    /// Reports contradictions with the body; `key` is that of the direction.
    pub(crate) fn demands(&self, key: &str, body: &Body, report: &Report) {
        let report = report.at(key);
        match self {
            Direction::Field(_) => {}
            Direction::Helix(_) => {
                let help = "take body = { shape = \"ventricle\", ... }, give the wall with depth = { from = ..., to = ... }, \
                            or give numbers or expressions";
                let sound = matches!(body, Body::Ventricle(_));
                report.require(sound, "helix", "needs a ventricle as the body", help);
            }
            Direction::Data(_) => {
                let problem = match body {
                    Body::File(file) if is_mesh(&file.path) => return,
                    Body::File(_) => "needs a mesh, but the body is a closed surface without data",
                    _ => "needs a mesh file as the body",
                };
                let help = "take body = { shape = \"file\", path = \"...\", ... } with a .vtk, .vtu or .msh file, or give \
                            numbers, expressions or another rule";
                report.add("data", Problem::new(problem).help(help));
            }
            Direction::Depth(wall) => {
                let Some(known) = body.surfaces() else { return };
                for (key, names) in [("depth.from", &wall.from), ("depth.to", &wall.to)] {
                    for name in names.iter().filter(|name| !known.contains(&name.as_str())) {
                        let problem = format!("is not a surface of a {}", body.name());
                        report.add(key, Problem::new(problem).found(name).help(suggest(name, &known)));
                    }
                }
            }
        }
    }
}
