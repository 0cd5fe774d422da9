//! The approach of force-driven tools under displacement control.

use contact::Drive;
use shape::Vector3;

use super::Newton;
use super::policy::Descent;
use super::state::State;
use crate::error::SolveError;
use crate::nonlinear::error::StaticError;
use crate::nonlinear::step::Step;

/// Number of strides under displacement control after which the approach is given up: a tool that slips off
/// never reaches its force. Approaches of the kidney between jaws take 10 to 13.
const STRIDES: usize = 50;
/// Fraction of the first stride below which a stride is not cut further and a failed approach is given up.
const SHORTEST: f64 = 0.1;
/// Number of iterations up to which the next stride is doubled.
const QUICK: usize = 6;

impl Newton<'_> {
    /// Solves the step from `start` to `time` as [`Newton::step`] does, and returns the new state with the
    /// record of the step. If that fails and the force-driven tools do not touch the body yet, the step is
    /// solved under displacement control.
    pub fn find(
        &mut self,
        start: &State,
        before: Option<&State>,
        time: f64,
        augmentations: usize,
        descent: Descent,
    ) -> Result<(State, Step), StaticError> {
        let step = self.step(start, before, time, augmentations, descent);
        step.and_then(|reached| self.checked(start, reached))
            .or_else(|error| match descent {
                Descent::Smooth | Descent::Nearest => self
                    .under_displacement_control(start, time, augmentations, descent)
                    .ok_or(error)
                    .and_then(|reached| self.checked(start, reached)),
                Descent::Guarded | Descent::Down => Err(error),
            })
            .map_err(|error| match error {
                // A body that has carried load is held together, so an indefinite tangent is an instability.
                StaticError::Solve(SolveError::NotPositiveDefinite) if start.time > 0.0 => {
                    StaticError::Unstable
                }
                error => error,
            })
    }

    /// Finds the equilibrium at `time` from `start` with force-driven tools that do not touch yet. These
    /// tools are under displacement control until each reaches its force, and are driven by this force
    /// afterwards. The result is `None` if all tools touch, or if no equilibrium is found in this way either.
    ///
    /// At first contact the force acts on one or two points, whose tangent does not anticipate further
    /// points. Newton's method would alternate between no contact and deep contact, whereas the body can
    /// follow a given displacement.
    pub(super) fn under_displacement_control(
        &mut self,
        start: &State,
        time: f64,
        augmentations: usize,
        descent: Descent,
    ) -> Option<(State, Step)> {
        let forced = |k: usize| matches!(self.equations.problem.tools[k].drive, Drive::Force(_));
        let tools = 0..self.equations.problem.tools.len();
        if !tools.clone().any(|k| forced(k) && self.equations.approach(k, start, 0.0) > 0.0) {
            return None;
        }
        self.equations.displacement_driven = tools.map(forced).collect();
        let reached = self.follow(start, time, augmentations, descent);
        self.equations.displacement_driven.fill(false);
        reached
    }

    fn follow(
        &mut self,
        start: &State,
        time: f64,
        augmentations: usize,
        descent: Descent,
    ) -> Option<(State, Step)> {
        let tools = self.equations.problem.tools;
        let forces: Vec<f64> = (tools.iter().enumerate())
            .map(|(k, t)| match t.drive {
                Drive::Force(full) => full * self.equations.part(k, time),
                Drive::Closure(_) => 0.0,
            })
            .collect();
        let gaps: Vec<f64> = (0..tools.len()).map(|k| self.equations.approach(k, start, 0.0)).collect();
        let unit: Vec<f64> =
            (0..tools.len()).map(|k| self.equations.approach(k, start, forces[k]) - gaps[k]).collect();
        let mut state = start.clone();
        // Displacement of the nodes per unit stride, once the tools touch: the guess for the next stride.
        let mut per_stride: Option<Vec<Vector3>> = None;
        let mut before = vec![0.0; tools.len()];
        let mut stride = 1.0;
        let mut touches = false;
        let mut iterations = Vec::new();
        for _ in 0..STRIDES {
            let forced = !self.equations.displacement_driven.contains(&true);
            let mut guess = state.clone();
            for (k, closure) in
                guess.closures.iter_mut().enumerate().filter(|(k, _)| self.equations.displacement_driven[*k])
            {
                *closure += stride * unit[k] + if touches { 0.0 } else { gaps[k] };
            }
            if let (Some(per_stride), false) = (&per_stride, forced) {
                guess.u.iter_mut().zip(per_stride).for_each(|(u, du)| *u += stride * du);
            }
            let kind = if forced { descent } else { Descent::Nearest };
            match self.step(&guess, None, time, augmentations, kind) {
                Ok((reached, step)) if forced => {
                    iterations.extend(step.iterations);
                    return Some((reached, Step { iterations, ..step }));
                }
                Ok((reached, step)) => {
                    iterations.extend_from_slice(&step.iterations);
                    let pressed: Vec<f64> = tools
                        .iter()
                        .zip(&step.tools)
                        .map(|(t, now)| -now.force.dot(&t.tool.along()))
                        .collect();
                    // A tool beyond its force would move back, and friction would reverse. The stride is cut
                    // instead.
                    let part = (0..tools.len())
                        .filter(|&k| self.equations.displacement_driven[k] && pressed[k] > 1.1 * forces[k])
                        .map(|k| (forces[k] - before[k]) / (pressed[k] - before[k]))
                        .fold(1.0, f64::min);
                    if touches && part < 1.0 && stride > SHORTEST {
                        stride *= part.max(0.1);
                        continue;
                    }
                    per_stride = touches.then(|| {
                        reached.u.iter().zip(&state.u).map(|(now, then)| (now - then) / stride).collect()
                    });
                    (0..tools.len())
                        .for_each(|k| self.equations.displacement_driven[k] &= pressed[k] < 0.95 * forces[k]);
                    stride *= if step.iterations.len() <= QUICK { 2.0 } else { 1.0 };
                    (state, before, touches) = (reached, pressed, true);
                }
                Err(_) if forced || stride < SHORTEST => return None,
                Err(_) => stride *= 0.25,
            }
        }
        None
    }
}
