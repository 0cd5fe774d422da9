//! Rules of Newton's method: its parameters, its goal when the tangent is not definite, and the iterations at
//! which it gives up or reuses the last tangent.

use crate::nonlinear::error::StaticError;

/// Parameters of Newton's method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonParams {
    /// Residual of the free degrees of freedom relative to the larger of internal and external forces.
    pub tolerance: f64,
    /// Largest number of iterations per step.
    pub iterations: usize,
    /// Allows the last iterations to reuse the previous tangent if the expected residual reduction suffices.
    /// Convergence is then no longer quadratic, but the run is a quarter faster (the published kidney, tet4).
    pub chords: bool,
    /// Cost ratio of factorisation to solution (in multiplications) above which factors are kept from one
    /// tangent to the next and computed in single precision. Systems are then solved iteratively.
    pub keeps: f64,
    /// Largest relative residual to which these systems are solved if the next step needs no more; `None`
    /// solves them as accurately as those with sliding friction.
    pub loosest: Option<f64>,
}

impl NewtonParams {
    /// Ratio above which keeping factors pays off. Measured on the kidney between jaws (7 mm; factors kept /
    /// renewed for each tangent, in CPU seconds): 1.5 / 2.2 at a ratio of 83 (hex20 with reduced integration,
    /// 1,201 nodes), 6.3 / 11.5 at 98 (tet10, 2,273 nodes).
    pub const KEEPS: f64 = 80.0;
    /// The same ratio for the frames of a simulator's loop, whose tangents differ less from one to the next.
    pub const KEEPS_FRAMES: f64 = 20.0;
    /// Largest relative residual of a system with a kept factor.
    pub const LOOSEST: f64 = 1e-2;
}

/// Record of one Newton iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Relative residual before the iteration.
    pub residual: f64,
    /// `|du . r|` of the step, relative to that of the first iteration.
    pub energy: f64,
    /// Length of the step relative to the Newton step: below 1 if the line search cut the step, above 1 if it
    /// extended the step.
    pub length: f64,
    /// Whether the tangent was positive definite (on the kernel of the pressures), force-driven tools
    /// included.
    pub definite: bool,
    /// Whether the tangent was that of the previous iteration (a chord).
    pub chord: bool,
}

/// Goal of Newton's method when the tangent is not definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Descent {
    /// The nearest equilibrium by tangents that are all definite, on a branch that stays stable.
    Smooth,
    /// The nearest equilibrium; a symmetric state stays symmetric. With a pressure field every step is a full
    /// step.
    Nearest,
    /// The nearest equilibrium; with a pressure field steps may be cut. This helps if full steps cycle
    /// between sticking and sliding points. Otherwise it takes about 1.6 times the iterations, so it is not
    /// the first choice.
    Guarded,
    /// A stable equilibrium, reached by reducing the energy.
    Down,
}

/// Finds the nearest equilibrium. With a pressure field, steps are cut if full steps do not converge.
pub(crate) fn near<T>(
    saddle: bool,
    to: &mut impl FnMut(Descent) -> Result<T, StaticError>,
) -> Result<T, StaticError> {
    to(Descent::Nearest).or_else(|error| if saddle { to(Descent::Guarded) } else { Err(error) })
}

/// Iterations without a reduction of the residual by a tenth after which the nearest equilibrium is given up.
/// Successful steps of the kidney between jaws took up to 7 such iterations. A limit of 40 doubled the time
/// of the whole path.
const PATIENCE: usize = 10;

/// Relative residual to which a chord is solved if factors are expensive. The chord itself leaves as much.
const CHORD: f64 = 0.03;

/// Ratio of residual to tolerance up to which a frame starts with the last tangent. The step leaves at most a
/// tenth of the residual while no point starts or ceases to touch or to slide. If a point does, a second such
/// step rarely helps.
const NEAR: f64 = 10.0;

/// The limit replacing `PATIENCE` if every one of these iterations took at most an eighth of its step with an
/// indefinite tangent: past a limit point no equilibrium is near. Ten such iterations took a sixth of the
/// time of the kidney's whole path.
const LOST: usize = 4;

/// Returns the number of iterations without a reduction of the residual by a tenth that are tolerated.
pub(super) fn patience(log: &[Iteration]) -> usize {
    let last = log.len().saturating_sub(LOST);
    let lost = log.len() >= LOST && log[last..].iter().all(|i| !i.definite && i.length <= 0.125);
    if lost { LOST } else { PATIENCE }
}

/// Whether steps with the previous tangent are expected to converge from `residual` in at most three
/// iterations. Each costs a sixth of an iteration with its own tangent (tet4, 3855 unknowns). If residuals
/// fall as `C r^2`, the first step leaves `2 r / r_before` of the residual, and so do the next steps.
pub(super) fn chord_suffices(log: &[Iteration], residual: f64, tolerance: f64) -> bool {
    if log.iter().all(|i| i.chord) {
        return log.is_empty() && residual <= NEAR * tolerance;
    }
    let chords = log.iter().rev().take_while(|i| i.chord).count();
    let Some(before) = log.last().filter(|i| i.length == 1.0 && i.definite) else { return false };
    let rate = residual / before.residual;
    match chords {
        0 => {
            let left = 2.0 * rate;
            left < 0.1 && residual * left.powi(3) <= tolerance
        }
        _ => chords < 4 && rate < 0.3,
    }
}

/// Rules of one step.
#[derive(Clone, Copy)]
pub(super) struct Policy<'a> {
    pub params: &'a NewtonParams,
    /// Treatment of a tangent that is not definite.
    pub descent: Descent,
    /// Whether steps are the frames of a simulator's loop. A frame starts with the last tangent if that is
    /// expected to suffice. A step that was cut too far, so that points of the whole step lost contact, is
    /// lengthened again.
    pub repeats: bool,
    /// Whether the equations have a pressure field.
    pub saddle: bool,
}

impl Policy<'_> {
    /// Whether factors with this ratio of the multiplications of a factorisation to those of a solution are
    /// large enough to be kept and to be computed in single precision. Pressure fields are excluded because
    /// their regularisation would be lost in rounding.
    pub fn keeps(&self, solutions: f64) -> bool {
        solutions > self.params.keeps && !self.saddle
    }

    /// Whether Newton's method gives up: at the largest number of iterations or, except during descent, after
    /// too many iterations without progress. `log` has the iterations of this search for an equilibrium,
    /// `best` the number of iterations before the last reduction of the residual by a tenth. During descent
    /// the forces may grow at first.
    pub fn gives_up(&self, log: &[Iteration], best: usize) -> bool {
        let stuck = self.descent != Descent::Down && log.len() >= best + patience(log);
        log.len() >= self.params.iterations || stuck
    }

    /// Returns the relative residual to which systems that are solved iteratively are solved: those with
    /// sliding friction, and those solved only as accurately as the next step needs, at most to `loosest`. A
    /// tenth of the residual preserves the order of convergence (Dembo, Eisenstat & Steihaug 1982). Far from
    /// equilibrium further digits would be useless.
    pub fn forcing(&self, residual: f64, chord: bool, loosest: Option<f64>) -> f64 {
        let Some(loosest) = loosest else { return (0.1 * residual).clamp(1e-7, 1e-2) };
        // The tolerance needs no further digits.
        let enough = (0.1 * self.params.tolerance / residual).min(loosest);
        let forcing = (0.1 * residual).clamp(1e-7, loosest).max(enough);
        if chord { forcing.max(CHORD) } else { forcing }
    }
}
