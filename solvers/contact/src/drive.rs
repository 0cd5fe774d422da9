//! Driven tools and their states.

use shape::Vector3;

use crate::contacts::Contacts;
use crate::tool::Tool;

/// Drive of a tool: its displacement or its force at the end of the loading. The value grows in proportion to
/// time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Displacement of the tool along its direction (closure), m.
    Closure(f64),
    /// Force that the tool exerts along its direction, N; the closure is an unknown.
    Force(f64),
}

/// Tool with its drive.
#[derive(Clone, Copy, Debug)]
pub struct DrivenTool<'a> {
    /// The tool.
    pub tool: &'a Tool,
    /// Drive of the tool.
    pub drive: Drive,
}

/// State of a tool after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolState {
    /// Displacement along the tool's direction (closure), m.
    pub closure: f64,
    /// Force on the tool, N.
    pub force: Vector3,
    /// Moment on the tool about its own origin, N m.
    pub moment: Vector3,
    /// Number of surface points in contact.
    pub active: usize,
    /// Effective number of points that carry the force, see [`Contacts::carriers`]; 0 without contact.
    pub carriers: f64,
    /// Undeformed area of the points in contact, m^2.
    pub area: f64,
    /// Deepest penetration, m; 0 if no point is inside the tool.
    pub penetration: f64,
}

impl ToolState {
    /// Collects the state of a tool with the displacement `closure` (m) along its direction. `contacts` is
    /// `None` if no point is near the tool.
    pub fn new(closure: f64, contacts: Option<&Contacts>) -> ToolState {
        let zero = Vector3::zeros;
        ToolState {
            closure,
            force: contacts.map_or_else(zero, Contacts::force),
            moment: contacts.map_or_else(zero, Contacts::moment),
            active: contacts.map_or(0, |c| c.points().len()),
            carriers: contacts.map_or(0.0, Contacts::carriers),
            area: contacts.map_or(0.0, Contacts::area),
            penetration: contacts.map_or(0.0, Contacts::max_penetration),
        }
    }
}
