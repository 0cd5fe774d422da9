//! The tool of a scene: a plate, a ball, two jaws, or the surface of a file.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use geometry::Point3;

use super::args::{Side, choice, word};
use super::organ::Organ;

/// Radius of the ball over the smallest extent of the body.
const BALL: f64 = 0.25;
/// Half width of a jaw across its way over the smallest extent of the body, and half its thickness.
const JAW: [f64; 2] = [0.3, 0.1];
/// Rounding of the edges of jaws and files over the smallest extent of the body.
const ROUNDING: f64 = 0.02;
/// Slope of the tangential traction while the surfaces stick, over the penalty.
pub(super) const STICK: f64 = 0.2;

/// A kind of tool.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Tool {
    Plate,
    Ball,
    Jaws,
    /// The closed surface of a file, in the unit of the organ's file.
    File(PathBuf),
}

/// Tools that have a word on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Named {
    Plate,
    Ball,
    Jaws,
}

impl Tool {
    /// Parses the word of a tool, or the path of a surface.
    pub fn parse(text: &str) -> Result<Tool, String> {
        if Path::new(text).is_file() {
            return Ok(Tool::File(text.into()));
        }
        choice(text)
            .map(|named| match named {
                Named::Plate => Tool::Plate,
                Named::Ball => Tool::Ball,
                Named::Jaws => Tool::Jaws,
            })
            .map_err(|bad| format!("{bad}, and there is no such file"))
    }

    /// Returns the name of the tool that comes from the side `at` of several.
    pub fn name(&self, at: usize) -> String {
        match self {
            Tool::Plate => word(Named::Plate),
            Tool::Ball => word(Named::Ball),
            Tool::Jaws => format!("jaw-{}", at + 1),
            Tool::File(_) => "tool".into(),
        }
    }

    /// Describes the tool in a sentence.
    pub fn words(&self) -> &'static str {
        match self {
            Tool::Plate => "a plate",
            Tool::Ball => "a ball",
            Tool::Jaws => "two jaws, one",
            Tool::File(_) => "a tool",
        }
    }

    /// Returns the sides from which tools come.
    pub fn sides(&self, side: Side) -> Vec<Side> {
        match self {
            Tool::Jaws => vec![side, side.opposite()],
            _ => vec![side],
        }
    }

    /// Returns the side opposite to which the body is constrained: that of the tool, or for jaws an end of the
    /// longest axis across them.
    pub fn held_from(&self, side: Side, organ: &Organ) -> Side {
        if *self != Tool::Jaws {
            return side;
        }
        let across =
            [Side::Right, Side::Back, Side::Top].into_iter().filter(|other| other.axis() != side.axis());
        across.max_by(|a, b| organ.extent(a.axis()).total_cmp(&organ.extent(b.axis()))).unwrap_or(side)
    }

    /// Returns the position of the tool's centre across its way, m: over the point it touches first, or for
    /// jaws over the middle of the body.
    pub fn across(&self, side: Side, organ: &Organ) -> Point3 {
        match self {
            Tool::Jaws => nalgebra::center(&organ.bounds[0], &organ.bounds[1]),
            _ => organ.first_touched(side),
        }
    }

    /// Returns the keys of the tool's shape: `path` is that of the file in the scene, `extent` (m) the smallest
    /// of the body, and `length` writes a length.
    pub fn shape(
        &self,
        side: Side,
        path: &str,
        unit: &str,
        extent: f64,
        length: impl Fn(f64) -> String,
    ) -> String {
        let quoted = |metres: f64| format!("\"{}\"", length(metres));
        match self {
            Tool::Plate => "shape = \"plate\"".into(),
            Tool::Ball => format!("shape = \"sphere\"\nradius = {}", quoted(BALL * extent)),
            Tool::Jaws => {
                let half = |axis: usize| quoted(extent * JAW[usize::from(axis == side.axis())]);
                let half = [0, 1, 2].map(half).join(", ");
                format!("shape = \"rounded-box\"\nhalf = [{half}]\nradius = {}", quoted(ROUNDING * extent))
            }
            Tool::File(_) => {
                let rounding = quoted(ROUNDING * extent);
                format!("shape = \"file\"\npath = {path}\nunit = \"{unit}\"\nrounding = {rounding}")
            }
        }
    }
}
