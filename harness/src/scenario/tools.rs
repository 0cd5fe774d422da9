//! Converts a scene's tools to those of the solver.

use std::sync::Arc;

use cases::scene::{self, ErrorKind};
use contact::{ContactError, ContactLaw, Drive, Motion, Tool, Turn};
use geometry::{Point3, Vector3};
use shape::{Curve, Matrix3};

use crate::error::{Failure, Key};

/// A tool with its name and its drive.
pub struct PlacedTool {
    /// Name of the tool in the scene.
    pub name: String,
    /// The tool.
    pub tool: Tool,
    /// Rotation from the axes of the tool's frame to the global axes (3, 3).
    pub turned: Matrix3,
    /// Drive at the end of the loading.
    pub drive: Drive,
    /// Time over which the drive grows, s; `None` for the duration of the loading.
    pub over: Option<f64>,
    /// Factor of the drive over time; `None` for the common growth.
    pub curve: Option<Arc<Curve>>,
}

/// Returns the scene's tools in order.
///
/// # Errors
/// Returns an error for a tool with invalid parameters, or with a pressure but no face.
pub fn tools(scene: &scene::Scene) -> Result<Vec<PlacedTool>, Failure> {
    scene.tools.iter().enumerate().map(|(i, tool)| placed(tool, i)).collect()
}

fn placed(tool: &scene::Tool, index: usize) -> Result<PlacedTool, Failure> {
    let at = |below: &str| Key::Scene(format!("tool[{index}]{below}"));
    let drive = match tool.drive {
        scene::Drive::Closure(closure) => Drive::Closure(closure),
        scene::Drive::Force(force) => Drive::Force(force),
        scene::Drive::Pressure(pressure) => {
            let area = tool.shape.face_area(&tool.along.into()).ok_or_else(|| {
                Failure::input(
                    at(".drive.pressure"),
                    "needs a tool with a flat face",
                    "give drive = { force = ... }",
                )
            })?;
            Drive::Force(pressure * area)
        }
    };
    let wrong = |bad: ContactError| {
        Failure::at(ErrorKind::Invalid, at(""), format!("is not a valid tool: {bad}"), "")
    };
    let law = match tool.friction {
        Some(f) => ContactLaw::coulomb(tool.penalty, f.coefficient, f.stick),
        None => ContactLaw::frictionless(tool.penalty),
    };
    let turned = tool.axis.map_or_else(Matrix3::identity, |axis| Tool::turned_to(&Vector3::from(axis)));
    let first = tool.path.first().map_or(Motion::Along(Vector3::from(tool.along)), motion);
    let law = law.map_err(wrong)?;
    let straight = Tool::new(tool.shape.clone(), Point3::from(tool.at), turned, first, law);
    // Each bend needs the length of the leg before it.
    let bends = tool.path.iter().zip(tool.path.iter().skip(1));
    let solver = bends.fold(straight, |path, (before, after)| path?.then(before.travel(), motion(after)));
    let solver = solver.map_err(wrong)?;
    Ok(PlacedTool {
        name: tool.name.clone(),
        tool: solver,
        turned,
        drive,
        over: tool.over,
        curve: tool.curve.clone(),
    })
}

/// Motion of a tool on a leg of its path.
fn motion(leg: &scene::Leg) -> Motion {
    match *leg {
        scene::Leg::Move(by) => Motion::Along(Vector3::from(by).normalize()),
        scene::Leg::Turn(scene::Turn { point, axis, arm, .. }) => {
            Motion::About(Turn { pin: Point3::from(point), axis: Vector3::from(axis), arm })
        }
    }
}
