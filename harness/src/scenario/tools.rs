//! From a scene's tools to those of the solver.

use cases::scene::{self, ErrorKind};
use contact::{ContactError, ContactLaw, Drive, Tool, ToolShape};
use geometry::{Point3, Vector3};
use shape::Matrix3;

use crate::Failure;
use crate::error::Key;

/// A tool with its name and its drive.
pub struct PlacedTool {
    /// Its name in the scene.
    pub name: String,
    /// The tool.
    pub tool: Tool,
    /// Takes the axes of the tool's frame to the world's (3, 3).
    pub turned: Matrix3,
    /// Its drive, reached at the end of the loading.
    pub drive: Drive,
    /// Time over which its drive grows, s; that of the loading where the scene gives none.
    pub over: Option<f64>,
}

/// The scene's tools in order.
pub fn tools(scene: &scene::Scene) -> Result<Vec<PlacedTool>, Failure> {
    scene.tools.iter().enumerate().map(|(i, tool)| placed(tool, i)).collect()
}

fn placed(tool: &scene::Tool, index: usize) -> Result<PlacedTool, Failure> {
    let at = |below: &str| Key::Scene(format!("tool[{index}]{below}"));
    let drive = match tool.drive {
        scene::Drive::Closure(closure) => Drive::Closure(closure),
        scene::Drive::Force(force) => Drive::Force(force),
        scene::Drive::Pressure(pressure) => {
            let area = tool.face_area().ok_or_else(|| {
                Failure::input(at(".drive.pressure"), "has no face to act on", "give force")
            })?;
            Drive::Force(pressure * area)
        }
    };
    let solver = solver_tool(tool).map_err(|bad| match bad {
        Some(bad) => Failure::at(ErrorKind::Invalid, at(""), format!("is no tool: {bad}"), ""),
        None => {
            Failure::unavailable(at(".shape"), "is the distance to a mesh, which is not available yet", "")
        }
    })?;
    Ok(PlacedTool { name: tool.name.clone(), tool: solver, turned: turned(tool), drive, over: tool.over })
}

/// `None` for a shape that is ahead of the solver.
fn solver_tool(tool: &scene::Tool) -> Result<Tool, Option<ContactError>> {
    let law = match tool.friction {
        Some(f) => ContactLaw::coulomb(tool.penalty, f.coefficient, f.stick),
        None => ContactLaw::frictionless(tool.penalty),
    };
    let shape = match tool.shape {
        scene::ToolShape::Plate => ToolShape::Plate,
        scene::ToolShape::RoundedBox { half, radius } => ToolShape::RoundedBox { half, radius },
        scene::ToolShape::Sphere { radius } => ToolShape::Sphere { radius },
        scene::ToolShape::Cylinder { radius, length } => {
            ToolShape::Cylinder { radius, half_length: 0.5 * length }
        }
        scene::ToolShape::Capsule { radius, length } => {
            ToolShape::Capsule { radius, half_length: 0.5 * length }
        }
        scene::ToolShape::File(_) => return Err(None),
    };
    let along = Vector3::from(tool.along);
    let law = law.map_err(Some)?;
    Tool::new(shape, Point3::from(tool.at), turned(tool), along, law).map_err(Some)
}

/// Takes the axes of the tool's frame to the world's (3, 3).
fn turned(tool: &scene::Tool) -> Matrix3 {
    tool.axis.map_or_else(Matrix3::identity, |axis| Tool::turned_to(&Vector3::from(axis)))
}
