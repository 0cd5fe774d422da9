//! A body with loads, supports and tools.

use contact::{ContactSurface, Drive, DrivenTool};
use shape::{Coarser, FixedDof, Point3};

use super::basis::Basis;
use super::curves::Curves;
use super::following::FollowingLoad;
use super::penalty::PenaltySurface;
use super::solid::Solid;
use crate::load::Load;

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
    /// The displacement is a combination of a few modes, and the tangent of their coefficients is dense.
    /// Prescribed nodes stay at rest, and there is no pressure field.
    Modal(&'a Basis),
}

/// A body with loads, supports and tools.
#[derive(Clone, Debug)]
pub struct StaticProblem<'a> {
    /// Reference positions, m.
    pub nodes: &'a [Point3],
    /// The body.
    pub solid: Solid<'a>,
    /// Dead loads (per reference area or volume), which are summed.
    pub loads: &'a [Load<'a>],
    /// Pressures on the deformed surface.
    pub following: &'a [FollowingLoad],
    /// Prescribed nodal parameters.
    pub fixed: &'a [FixedDof],
    /// Surfaces constrained by penalty, and surfaces on springs and dampers.
    pub penalties: &'a [PenaltySurface<'a>],
    /// Surface on which tools may touch the body.
    pub contact: Option<&'a ContactSurface<'a>>,
    /// The tools.
    pub tools: &'a [DrivenTool<'a>],
    /// Curves of all of these over time.
    pub curves: Curves<'a>,
    /// Solver of the linear systems.
    pub systems: LinearSystems<'a>,
}

impl StaticProblem<'_> {
    /// Returns the times at which a step has to end: those of the points of curves, and those at which a tool
    /// passes a bend of its path. A step across a bend would cut it, and friction would act along the cut.
    pub(crate) fn stops(&self) -> Vec<f64> {
        let mut times = self.curves.points();
        for (index, driven) in self.tools.iter().enumerate() {
            if let Drive::Closure(full) = driven.drive {
                let bends = driven.tool.bends();
                times.extend(bends.flat_map(|bend| self.curves.tools.of(index).passes(bend / full)));
            }
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }
}
