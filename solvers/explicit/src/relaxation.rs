//! Adaptive dynamic relaxation: the static solution as the limit of a damped motion.

use material::Material;
use shape::{FixedDof, Vector3};

use super::critical_step::{LanczosParams, critical_step_touching};
use super::motion::constrained;
use crate::error::ExplicitError;
use crate::force::InternalForce;
use crate::pressing::Pressing;

/// Parameters of a relaxation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelaxationParams {
    /// Tolerance of the estimated error of a displacement, relative to the largest displacement.
    pub tolerance: f64,
    /// Largest number of steps.
    pub steps: usize,
    /// Parameters of the estimate of the critical step.
    pub critical: LanczosParams,
    /// Number of steps between two estimates of the critical step; 0: at the start only.
    pub recheck: usize,
}

/// Outcome of a relaxation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelaxationInfo {
    /// Number of steps made.
    pub steps: usize,
    /// Estimated error of a displacement, relative to the largest displacement.
    pub error: f64,
    /// Largest out-of-balance force, relative to the largest internal force.
    pub residual: f64,
    /// Lowest angular frequency at the end, rad/s.
    pub omega_min: f64,
    /// Ratio of `omega_min` to the frequency of a shear wave across twice the body's longest side,
    /// `pi sqrt(mu / rho) / (2 L)`. A slender body in bending has some tenths. If the ratio is far smaller, a
    /// spurious slow mode governs (meshless kernels with wide support and mass lumped on their parameters),
    /// and the steps are wasted on it.
    pub slow_mode: f64,
    /// Last time step, s.
    pub dt: f64,
}

/// Body at rest: displacements (m), and forces of the supports on every node (N), zero at free degrees of
/// freedom.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Rested {
    pub u: Vec<Vector3>,
    pub reaction: Vec<Vector3>,
    pub info: RelaxationInfo,
}

/// Number of consecutive steps that must pass the stopping rule, because an oscillation about the end stands
/// still at its turning points.
const CONFIRM: usize = 10;

/// External forces at given displacements: adds nodal forces (N) to the second argument, which starts from
/// zero.
pub type StaticLoad<'a> = dyn FnMut(&[Vector3], &mut [Vector3]) + 'a;

/// Finds static displacements as [`relax_under`], without tools.
///
/// # Errors
///
/// As [`relax_under`].
pub fn relax(
    force: &mut InternalForce,
    mass: &[f64],
    fixed: &[FixedDof],
    load: &mut StaticLoad,
    start: Vec<Vector3>,
    params: RelaxationParams,
) -> Result<(Vec<Vector3>, RelaxationInfo), ExplicitError> {
    relax_under(force, mass, fixed, load, None, start, params).map(|rested| (rested.u, rested.info))
}

/// Finds the static displacements (m) under `load` and pressing tools, with `fixed` degrees of freedom, from
/// the displacements `start` (m). `mass` (kg, one value per node) may be any positive mass.
///
/// The time step `dt` is the critical step. With `k = 2 / (omega_min dt)`, `R = (k - 1) / (k + 1)` and
/// `s = (1 + R) dt / 2`, a step is `u_(n+1) = u_n + R^2 (u_n - u_(n-1)) + s^2 M^-1 (f_ext - f)`, with `f` the
/// internal less the contact forces. `omega_min^2` is the Rayleigh quotient `du . df / du . M du` of the last
/// step. The error is estimated by the remainder of a geometric series of steps, `max |du| rho / (1 - rho)`
/// with `rho = R + 0.2 (1 - R)`. The relaxation stops when this error, relative to the largest displacement,
/// has stayed below the tolerance for 10 steps.
///
/// Source: Joldes, Wittek & Miller, Comput. Methods Appl. Mech. Engrg. 200 (2011).
///
/// # Errors
///
/// [`ExplicitError::NotRelaxed`] if `params.steps` do not suffice; also for invalid input, inverted points
/// and contact errors.
pub fn relax_under(
    force: &mut InternalForce,
    mass: &[f64],
    fixed: &[FixedDof],
    load: &mut StaticLoad,
    mut pressing: Option<&mut Pressing>,
    start: Vec<Vector3>,
    params: RelaxationParams,
) -> Result<Rested, ExplicitError> {
    check(force.node_count(), mass, &start, params)?;
    let springs = pressing.as_ref().and_then(|p| p.springs());
    let mut trajectory = Trajectory::new(force, mass, fixed, start)?;
    let limit = |trajectory: &mut Trajectory| {
        let (constrained, u) = (&trajectory.constrained, &trajectory.u);
        critical_step_touching(
            trajectory.force,
            mass,
            u,
            |k| !constrained[k],
            springs.as_slice(),
            params.critical,
        )
        .map(|found| found.dt)
    };
    let mut dt = limit(&mut trajectory)?;
    let mut confirmed = 0;
    for step in 0..params.steps {
        trajectory.forces(step, dt, load, pressing.as_deref_mut())?;
        if params.recheck > 0 && step > 0 && step.is_multiple_of(params.recheck) {
            dt = limit(&mut trajectory)?;
        }
        trajectory.find_slowest(dt, pressing.as_deref());
        trajectory.advance(step, dt, pressing.as_deref_mut())?;
        confirmed = if trajectory.info.error < params.tolerance { confirmed + 1 } else { 0 };
        if confirmed == CONFIRM {
            if let Some(pressing) = &mut pressing {
                let time = step as f64 * dt;
                let within = pressing.check_sides(&trajectory.u);
                within.map_err(|(tool, cause)| ExplicitError::ContactAt { step, time, tool, cause })?;
            }
            let reaction = trajectory.reaction();
            return Ok(Rested { u: trajectory.u, reaction, info: trajectory.info });
        }
    }
    let RelaxationInfo { steps, error, .. } = trajectory.info;
    Err(ExplicitError::NotRelaxed { steps, error, tolerance: params.tolerance })
}

fn check(n: usize, mass: &[f64], start: &[Vector3], params: RelaxationParams) -> Result<(), ExplicitError> {
    for (what, found) in [("masses", mass.len()), ("displacements", start.len())] {
        if found != n {
            return Err(ExplicitError::Length { what, found, expected: n });
        }
    }
    if params.tolerance > 0.0 && params.tolerance < 1.0 {
        return Ok(());
    }
    let what = "tolerance of the relaxation";
    let value = params.tolerance;
    Err(ExplicitError::BadParameter { what, value, allowed: "between 0 and 1" })
}

/// Motion of the body towards rest.
struct Trajectory<'a, 'b> {
    force: &'a mut InternalForce<'b>,
    mass: &'a [f64],
    constrained: Vec<bool>,
    u: Vec<Vector3>,
    /// Increment of the last step, m.
    du: Vec<Vector3>,
    internal: Vec<Vector3>,
    /// Internal forces of the previous step.
    previous: Vec<Vector3>,
    external: Vec<Vector3>,
    touch: Vec<Vector3>,
    /// Frequency of a shear wave across the body, rad/s.
    expected: f64,
    info: RelaxationInfo,
}

impl<'a, 'b> Trajectory<'a, 'b> {
    fn new(
        force: &'a mut InternalForce<'b>,
        mass: &'a [f64],
        fixed: &[FixedDof],
        mut u: Vec<Vector3>,
    ) -> Result<Trajectory<'a, 'b>, ExplicitError> {
        let n = mass.len();
        let constrained = constrained(n, fixed.iter().map(|f| (f.node, f.axis)))?;
        for f in fixed {
            u[f.node as usize][f.axis as usize] = f.value;
        }
        let expected = shear_frequency(force, mass);
        let info = RelaxationInfo {
            steps: 0,
            error: f64::INFINITY,
            residual: f64::INFINITY,
            omega_min: expected,
            slow_mode: 1.0,
            dt: 0.0,
        };
        let zeros = || vec![Vector3::zeros(); n];
        let (du, internal, previous, external) = (zeros(), zeros(), zeros(), zeros());
        let touch = Vec::new();
        Ok(Trajectory {
            force,
            mass,
            constrained,
            u,
            du,
            internal,
            previous,
            external,
            touch,
            expected,
            info,
        })
    }

    /// Computes the internal forces less the contact forces, and the external forces.
    fn forces(
        &mut self,
        step: usize,
        dt: f64,
        load: &mut StaticLoad,
        pressing: Option<&mut Pressing>,
    ) -> Result<(), ExplicitError> {
        let time = step as f64 * dt;
        std::mem::swap(&mut self.internal, &mut self.previous);
        let inverted = |at| ExplicitError::InvertedAt { step, time, at };
        self.force.evaluate(&self.u, &mut self.internal).map_err(inverted)?;
        self.external.fill(Vector3::zeros());
        load(&self.u, &mut self.external);
        if let Some(pressing) = pressing {
            self.touch.clear();
            self.touch.resize(self.u.len(), Vector3::zeros());
            pressing.touch(&self.u, &mut self.touch).map_err(|(tool, cause)| ExplicitError::ContactAt {
                step,
                time,
                tool,
                cause,
            })?;
            self.internal.iter_mut().zip(&self.touch).for_each(|(f, t)| *f -= t);
        }
        Ok(())
    }

    /// Returns the forces that balance the constrained degrees of freedom, N.
    fn reaction(&self) -> Vec<Vector3> {
        let lacking = |i: usize, a: usize| self.internal[i][a] - self.external[i][a];
        let held = |i: usize, a: usize| if self.constrained[3 * i + a] { lacking(i, a) } else { 0.0 };
        (0..self.u.len()).map(|i| Vector3::from_fn(|a, _| held(i, a))).collect()
    }

    /// Estimates the lowest frequency in the last step by its Rayleigh quotient.
    fn find_slowest(&mut self, dt: f64, pressing: Option<&Pressing>) {
        let (mut stiff, mut inert) = (0.0, 0.0);
        for i in 0..self.u.len() {
            stiff += self.du[i].dot(&(self.internal[i] - self.previous[i]));
            inert += self.mass[i] * self.du[i].norm_squared();
        }
        if let Some(pressing) = pressing {
            let (of_tools, mass) = pressing.quotient(dt);
            stiff += of_tools;
            inert += mass;
        }
        // Softening makes the quotient negative for a while; the last positive value is kept.
        if stiff > 0.0 && inert > 0.0 {
            self.info.omega_min = (stiff / inert).sqrt();
        }
    }

    /// Makes one step and estimates the distance from rest.
    fn advance(
        &mut self,
        step: usize,
        dt: f64,
        pressing: Option<&mut Pressing>,
    ) -> Result<(), ExplicitError> {
        let k = (2.0 / (self.info.omega_min * dt)).max(1.0);
        let r = (k - 1.0) / (k + 1.0);
        let s = 0.5 * (1.0 + r) * dt;
        let (mut largest_step, mut largest_u, mut residual, mut largest_force) =
            (0.0f64, 0.0f64, 0.0f64, 0.0f64);
        for i in 0..self.u.len() {
            for axis in 0..3 {
                largest_force = largest_force.max(self.internal[i][axis].abs());
                largest_u = largest_u.max(self.u[i][axis].abs());
                if self.constrained[3 * i + axis] {
                    continue;
                }
                let out = self.external[i][axis] - self.internal[i][axis];
                let move_by = r * r * self.du[i][axis] + s * s / self.mass[i] * out;
                if !move_by.is_finite() {
                    let what = "out-of-balance force";
                    let time = step as f64 * dt;
                    return Err(ExplicitError::NotFinite { step, time, what, node: i });
                }
                residual = residual.max(out.abs());
                largest_step = largest_step.max(move_by.abs());
                self.du[i][axis] = move_by;
                self.u[i][axis] += move_by;
            }
        }
        if let Some(pressing) = pressing {
            let (moved, lacking) = pressing.advance(dt, r, s);
            largest_step = largest_step.max(moved);
            residual = residual.max(lacking);
        }
        let rho = r + 0.2 * (1.0 - r);
        let relative = |value: f64, scale: f64| if value == 0.0 { 0.0 } else { value / scale };
        let omega_min = self.info.omega_min;
        self.info = RelaxationInfo {
            steps: step + 1,
            error: relative(largest_step * rho / (1.0 - rho), largest_u.max(largest_step)),
            residual: relative(residual, largest_force.max(residual)),
            omega_min,
            slow_mode: omega_min / self.expected,
            dt,
        };
        Ok(())
    }
}

/// Returns `pi sqrt(mu / rho) / (2 L)` for the softest law, with L the longest side of the box around the
/// points, rad/s.
fn shear_frequency(force: &InternalForce, mass: &[f64]) -> f64 {
    let body = force.body();
    let density = mass.iter().sum::<f64>() / body.volume.weights().iter().sum::<f64>();
    let mu = body.laws.iter().map(|law| law.mu()).fold(f64::INFINITY, f64::min);
    let extent = |axis: usize| {
        let x = body.volume.points().iter().map(|p| p[axis]);
        x.clone().fold(f64::NEG_INFINITY, f64::max) - x.fold(f64::INFINITY, f64::min)
    };
    // A single point has no extent; any positive length is acceptable.
    let length = (0..3).map(extent).fold(f64::MIN_POSITIVE, f64::max);
    0.5 * std::f64::consts::PI * (mu / density).sqrt() / length
}
