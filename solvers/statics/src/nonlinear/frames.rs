//! Repeated solutions of a static problem at varying load, as in a simulator; the problem is prepared once.

use shape::Vector3;

use super::error::StaticError;
use super::newton::{Descent, Newton, State, near, shortest_travel};
use super::problem::StaticProblem;
use super::statics::StaticParams;
use super::step::{StaticWork, Step};

/// Sequence of equilibria ("frames"), each of which starts from the last, forwards or backwards along the
/// loading. Residuals are relative to the largest forces so far: when tools lift off, a simulator does not
/// need the digits of a force near zero.
pub struct Frames<'a> {
    newton: Newton<'a>,
    state: State,
    before: Option<State>,
    augmentations: usize,
    /// Load fraction below which a frame is not divided further.
    smallest: f64,
    /// The same limit for frames in which a tool travels too far.
    shortest: f64,
}

impl<'a> Frames<'a> {
    /// Starts from the undeformed body.
    pub fn new(problem: &'a StaticProblem<'a>, params: &'a StaticParams) -> Result<Frames<'a>, StaticError> {
        Ok(Frames {
            newton: Newton::new(problem, &params.newton)?.repeat(),
            state: State::start(problem),
            before: None,
            augmentations: params.augmentations,
            smallest: params.smallest / params.steps.max(1) as f64,
            shortest: shortest_travel(problem),
        })
    }

    /// Finds the equilibrium at `time` (load fraction, above 0) in one step, or in halved steps if that
    /// fails.
    pub fn to(&mut self, time: f64) -> Result<Step, StaticError> {
        // Runs on a thread of the pool. Called from outside, each of an iteration's twenty loops would have
        // to wake a thread.
        rayon::scope(|_| self.go(time))
    }

    fn go(&mut self, time: f64) -> Result<Step, StaticError> {
        let mut target = time;
        loop {
            let newton = &mut self.newton;
            let state = &self.state;
            let before = self.before.as_ref();
            let mut solve = |descent| newton.find(state, before, target, self.augmentations, descent);
            let reached = near(!state.pressure.is_empty(), &mut solve).or_else(|_| solve(Descent::Down));
            let reached = reached.and_then(|(reached, step)| match target == time {
                true => self.newton.check_overlap(&reached, &step, false).map(|()| (reached, step)),
                false => Ok((reached, step)),
            });
            match reached {
                Ok((reached, step)) => {
                    self.newton.keep_scale();
                    let last = std::mem::replace(&mut self.state, reached);
                    // A frame at the same load predicts nothing for the next frame.
                    if last.time != self.state.time {
                        self.before = Some(last);
                    }
                    if target == time {
                        return Ok(step);
                    }
                    target = time;
                }
                Err(cause) => {
                    let failed = target - self.state.time;
                    target = self.state.time + 0.5 * failed;
                    if 0.5 * failed.abs() < cause.finest(self.smallest, self.shortest) {
                        let time = self.state.time;
                        return Err(StaticError::Stalled { time, step: failed, cause: Box::new(cause) });
                    }
                }
            }
        }
    }

    /// Returns the counters of all frames.
    pub fn work(&self) -> StaticWork {
        self.newton.totals().work
    }

    /// Returns the nodal parameters of the last frame, m.
    pub fn u(&self) -> &[Vector3] {
        &self.state.u
    }
}
