//! A body with loads, supports and tools.

use contact::{ContactSurface, DrivenTool};
use shape::{Coarser, FixedDof, Point3, SurfaceRows, Vector3};

use super::following::FollowingPressure;
use super::solid::Solid;
use crate::load::Load;

/// A surface constrained by a penalty, for bases whose parameters are not displacements.
#[derive(Clone, Debug)]
pub struct PenaltySurface<'a> {
    /// Shape values and weights at the surface points.
    pub surface: &'a SurfaceRows,
    /// Constrained axes x, y, z.
    pub axes: [bool; 3],
    /// Prescribed displacement at each point at the end of the loading, m.
    pub values: Vec<Vector3>,
    /// Penalty, Pa/m.
    pub beta: f64,
}

/// Solver of the linear systems of Newton's method.
#[derive(Clone, Copy, Debug, Default)]
pub enum LinearSystems<'a> {
    /// Every tangent is factored.
    #[default]
    Factored,
    /// Systems are iterated with multigrid. A tangent is factored if the iterations do not converge, if the
    /// last tangent was not positive definite, with a pressure field, and with tools driven by force.
    Iterated {
        /// Linear mesh of a quadratic mesh, the next coarser level.
        linear: Option<&'a Coarser>,
    },
}

/// A body with loads, supports and tools. Loads, pressures, prescribed displacements and drives grow in
/// proportion to the time, 0 to 1.
#[derive(Clone, Debug)]
pub struct StaticProblem<'a> {
    /// Reference positions, m.
    pub nodes: &'a [Point3],
    /// The body.
    pub solid: Solid<'a>,
    /// Dead loads (per reference area or volume), which are summed.
    pub loads: &'a [Load<'a>],
    /// Pressures on the deformed surface.
    pub following: &'a [FollowingPressure],
    /// Prescribed nodal parameters.
    pub fixed: &'a [FixedDof],
    /// Surfaces constrained by penalty.
    pub penalties: &'a [PenaltySurface<'a>],
    /// Surface on which tools may touch the body.
    pub contact: Option<&'a ContactSurface<'a>>,
    /// The tools.
    pub tools: &'a [DrivenTool<'a>],
    /// Solver of the linear systems.
    pub systems: LinearSystems<'a>,
}
