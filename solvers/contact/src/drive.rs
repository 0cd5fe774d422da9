//! Tools that are driven, and where they stand.

use shape::Vector3;

use crate::{Contacts, Tool};

/// How a tool is driven: the value at the end of the loading, reached in proportion to time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Closure, m.
    Closure(f64),
    /// Force that the tool exerts along its way, N; its closure is an unknown.
    Force(f64),
}

/// A tool and its drive.
#[derive(Clone, Copy, Debug)]
pub struct DrivenTool<'a> {
    /// The tool.
    pub tool: &'a Tool,
    /// Its drive.
    pub drive: Drive,
}

/// A tool after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolState {
    /// Closure, m.
    pub closure: f64,
    /// Force on the tool, N.
    pub force: Vector3,
    /// Moment on the tool about its own place, N m.
    pub moment: Vector3,
    /// Surface points in contact.
    pub active: usize,
    /// How many of them carry the force, see [`Contacts::carriers`].
    pub carriers: f64,
    /// Their undeformed area, m^2.
    pub area: f64,
    /// Deepest penetration, m.
    pub penetration: f64,
}

impl ToolState {
    /// At that closure (m) with these contacts; `None` where nothing is near.
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
