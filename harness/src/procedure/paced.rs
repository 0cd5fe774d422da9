//! Frames of a simulator's loop, in which the loading passes at a fixed rate.

use cases::scene::{Procedure, RealTime, Swept};
use contact::ToolState;
use geometry::Vector3;
use shape::Rows;

use super::frames::{self, Sweeps};
use super::problem::Problem;
use super::statics;
use crate::error::Failure;
use crate::outcome::ToolStep;

/// Results of a frame.
pub(crate) struct FrameEnd {
    /// States of the tools.
    pub(crate) tools: Vec<ToolStep>,
    /// Displacement at the probes, m.
    pub(crate) probes: Vec<Vector3>,
    /// Linear systems solved by Newton's method, or sweeps.
    pub(crate) iterations: usize,
}

/// Makes the next frame, which ends at a part of the loading.
pub(crate) type Advance<'a> = dyn FnMut(f64) -> Result<FrameEnd, Failure> + 'a;

/// A loop in real time.
pub(crate) struct Loop<'a> {
    /// The problem, with its probes.
    pub(crate) problem: Problem<'a>,
    /// Values of the shape functions at the probes.
    pub(crate) probes: &'a Rows,
    /// Request of the scene.
    pub(crate) ask: &'a RealTime,
}

impl Loop<'_> {
    /// Calls `work` with the frames of the procedure, `count` up to the whole loading.
    pub(crate) fn paced<T>(&self, count: usize, work: impl FnOnce(&mut Advance) -> T) -> Result<T, Failure> {
        match &self.problem.setup.procedure {
            Procedure::Static(asked) => {
                statics::in_frames(&self.problem, asked, self.ask.tolerance, |frames| {
                    work(&mut |part| {
                        let step = frames.to(part)?;
                        Ok(self.end(&step.tools, frames.u(), statics::solves(&step) as usize))
                    })
                })
            }
            Procedure::Vbd(asked) => self.swept(&asked.in_frames(count), Sweeps::VertexDescent, work),
            Procedure::Xpbd(asked) => self.swept(&asked.in_frames(count), Sweeps::Constraints, work),
            Procedure::ImplicitCg(asked) => {
                let kind = Sweeps::ConjugateGradients { tolerance: asked.tolerance };
                self.swept(&asked.frames().in_frames(count), kind, work)
            }
            other => unreachable!("scenes with a {} procedure have no loop", other.kind().name()),
        }
    }

    fn swept<T>(
        &self,
        asked: &Swept,
        kind: Sweeps,
        work: impl FnOnce(&mut Advance) -> T,
    ) -> Result<T, Failure> {
        let mass = frames::mass(&self.problem, asked)?;
        frames::with_frames(&self.problem, asked, kind, &mass, |frames, load, _| {
            work(&mut |_| {
                (0..asked.substeps).try_for_each(|_| frames.step(load))?;
                let tools = frames.tools()?;
                Ok(self.end(&tools, frames.u(), asked.substeps * asked.sweeps))
            })
        })
    }

    fn end(&self, tools: &[ToolState], u: &[Vector3], iterations: usize) -> FrameEnd {
        let tools = tools.iter().zip(&self.problem.setup.tools);
        FrameEnd {
            tools: tools.map(|(state, set)| ToolStep::of(state, &set.tool)).collect(),
            probes: self.probes.apply(u),
            iterations,
        }
    }
}
