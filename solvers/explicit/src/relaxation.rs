//! Adaptive dynamic relaxation: the static solution as the end of a damped motion.

use super::central_difference::held;
use super::critical_step::{LanczosParams, critical_step_touching};
use super::{ExplicitError, InternalForce, Pressing};
use material::Material;
use shape::{FixedDof, Vector3};

/// What is asked of a relaxation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelaxationParams {
    /// Largest estimated error of a displacement over the largest displacement.
    pub tolerance: f64,
    /// Steps after which to give up.
    pub steps: usize,
    /// How the critical step is found.
    pub critical: LanczosParams,
    /// Steps between two estimates of the critical step; 0: at the start only.
    pub recheck: usize,
}

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelaxationInfo {
    /// Steps made.
    pub steps: usize,
    /// Estimated error of a displacement over the largest displacement.
    pub error: f64,
    /// Largest out-of-balance force over the largest internal force.
    pub residual: f64,
    /// Lowest angular frequency at the end, rad/s.
    pub omega_min: f64,
    /// `omega_min` over the frequency of a shear wave across twice the body's longest side,
    /// `pi sqrt(mu / rho) / (2 L)`. A slender body in bending has some tenths; far below, a spurious slow mode governs
    /// (meshless kernels of wide support with mass lumped on their parameters) and the steps are wasted on it.
    pub slow_mode: f64,
    /// Last time step, s.
    pub dt: f64,
}

/// Steps in a row that must pass the stopping rule: a swing about its end stands still at its turning points.
const CONFIRM: usize = 10;

/// External forces at displacements: adds nodal forces (N) to the second argument, which starts from zero.
pub type StaticLoad<'a> = dyn FnMut(&[Vector3], &mut [Vector3]) + 'a;

/// [`relax_under`] without tools.
pub fn relax(
    force: &mut InternalForce,
    mass: &[f64],
    fixed: &[FixedDof],
    load: &mut StaticLoad,
    start: Vec<Vector3>,
    params: RelaxationParams,
) -> Result<(Vec<Vector3>, RelaxationInfo), ExplicitError> {
    relax_under(force, mass, fixed, load, None, start, params)
}

/// Static displacements (m) under `load` and tools that press, with `fixed` degrees of freedom, from `start`; `mass` may be any
/// positive one.
///
/// With `k = 2 / (omega_min dt)`, `R = (k - 1) / (k + 1)` and `s = (1 + R) dt / 2`:
/// `u_(n+1) = u_n + R^2 (u_n - u_(n-1)) + s^2 M^-1 (f_ext - f_int)`; `omega_min^2` by the Rayleigh quotient
/// `du . df / du . M du` of the last step, `f` the internal less the contact forces. Stops when `max |du| rho / (1 - rho)`, `rho = R + 0.2 (1 - R)`, stays
/// below the tolerance: what a geometric series of steps has left. Source: Joldes, Wittek & Miller, Comput. Methods
/// Appl. Mech. Engrg. 200 (2011).
pub fn relax_under(
    force: &mut InternalForce,
    mass: &[f64],
    fixed: &[FixedDof],
    load: &mut StaticLoad,
    mut pressing: Option<&mut Pressing>,
    start: Vec<Vector3>,
    params: RelaxationParams,
) -> Result<(Vec<Vector3>, RelaxationInfo), ExplicitError> {
    let n = force.node_count();
    for (what, found) in [("masses", mass.len()), ("displacements", start.len())] {
        if found != n {
            return Err(ExplicitError::Length { what, found, expected: n });
        }
    }
    if !(params.tolerance > 0.0 && params.tolerance < 1.0) {
        let (what, value) = ("tolerance of the relaxation", params.tolerance);
        return Err(ExplicitError::BadParameter { what, value, allowed: "between 0 and 1" });
    }
    let held = held(n, fixed.iter().map(|f| (f.node, f.axis)))?;
    let mut u = start;
    for f in fixed {
        u[f.node as usize][f.axis as usize] = f.value;
    }
    let springs = pressing.as_ref().and_then(|p| p.springs());
    let limit = |force: &mut InternalForce, u: &[Vector3]| {
        critical_step_touching(force, mass, u, |k| !held[k], springs, params.critical).map(|found| found.dt)
    };
    let mut dt = limit(force, &u)?;
    let expected = shear_frequency(force, mass);
    let mut info = RelaxationInfo {
        steps: 0,
        error: f64::INFINITY,
        residual: f64::INFINITY,
        omega_min: expected,
        slow_mode: 1.0,
        dt,
    };
    let zeros = vec![Vector3::zeros(); n];
    let (mut du, mut internal, mut previous, mut external) =
        (zeros.clone(), zeros.clone(), zeros.clone(), zeros);
    let mut touch: Vec<Vector3> = Vec::new();
    let mut confirmed = 0;
    for step in 0..params.steps {
        let at = |error| ExplicitError::InvertedAt { step, time: step as f64 * dt, at: error };
        std::mem::swap(&mut internal, &mut previous);
        force.evaluate(&u, &mut internal).map_err(at)?;
        external.fill(Vector3::zeros());
        load(&u, &mut external);
        if let Some(pressing) = &mut pressing {
            touch.clear();
            touch.resize(n, Vector3::zeros());
            let time = step as f64 * dt;
            pressing.touch(&u, &mut touch).map_err(|cause| ExplicitError::ContactAt { step, time, cause })?;
            internal.iter_mut().zip(&touch).for_each(|(f, t)| *f -= t);
        }
        if params.recheck > 0 && step > 0 && step.is_multiple_of(params.recheck) {
            dt = limit(force, &u)?;
        }

        let (mut stiff, mut inert) = (0.0, 0.0);
        for i in 0..n {
            stiff += du[i].dot(&(internal[i] - previous[i]));
            inert += mass[i] * du[i].norm_squared();
        }
        if let Some(pressing) = &pressing {
            let (of_tools, mass) = pressing.quotient(dt);
            stiff += of_tools;
            inert += mass;
        }
        // Softening makes the quotient negative for a while; the last good one stays.
        if stiff > 0.0 && inert > 0.0 {
            info.omega_min = (stiff / inert).sqrt();
        }
        let k = (2.0 / (info.omega_min * dt)).max(1.0);
        let r = (k - 1.0) / (k + 1.0);
        let s = 0.5 * (1.0 + r) * dt;

        let (mut largest_step, mut largest_u, mut residual, mut largest_force) =
            (0.0f64, 0.0f64, 0.0f64, 0.0f64);
        for i in 0..n {
            for axis in 0..3 {
                largest_force = largest_force.max(internal[i][axis].abs());
                largest_u = largest_u.max(u[i][axis].abs());
                if held[3 * i + axis] {
                    continue;
                }
                let out = external[i][axis] - internal[i][axis];
                let move_by = r * r * du[i][axis] + s * s / mass[i] * out;
                if !move_by.is_finite() {
                    let (what, time) = ("out-of-balance force", step as f64 * dt);
                    return Err(ExplicitError::NotFinite { step, time, what, node: i });
                }
                residual = residual.max(out.abs());
                largest_step = largest_step.max(move_by.abs());
                du[i][axis] = move_by;
                u[i][axis] += move_by;
            }
        }
        if let Some(pressing) = &mut pressing {
            let (moved, lacking) = pressing.advance(dt, r, s);
            largest_step = largest_step.max(moved);
            residual = residual.max(lacking);
        }
        let rho = r + 0.2 * (1.0 - r);
        let relative = |value: f64, scale: f64| if value == 0.0 { 0.0 } else { value / scale };
        info.steps = step + 1;
        info.dt = dt;
        info.error = relative(largest_step * rho / (1.0 - rho), largest_u.max(largest_step));
        info.residual = relative(residual, largest_force.max(residual));
        info.slow_mode = info.omega_min / expected;
        confirmed = if info.error < params.tolerance { confirmed + 1 } else { 0 };
        if confirmed == CONFIRM {
            if let Some(pressing) = &mut pressing {
                let time = step as f64 * dt;
                let within = pressing.check_sides(&u);
                within.map_err(|cause| ExplicitError::ContactAt { step, time, cause })?;
            }
            return Ok((u, info));
        }
    }
    Err(ExplicitError::NotRelaxed { steps: info.steps, error: info.error, tolerance: params.tolerance })
}

/// `pi sqrt(mu / rho) / (2 L)` of the softest law, L the longest side of the box around the points, rad/s.
fn shear_frequency(force: &InternalForce, mass: &[f64]) -> f64 {
    let body = force.body();
    let density = mass.iter().sum::<f64>() / body.volume.weights().iter().sum::<f64>();
    let mu = body.laws.iter().map(|law| law.mu()).fold(f64::INFINITY, f64::min);
    let extent = |axis: usize| {
        let x = body.volume.points().iter().map(|p| p[axis]);
        x.clone().fold(f64::NEG_INFINITY, f64::max) - x.fold(f64::INFINITY, f64::min)
    };
    // A single point has no extent; any positive length will do there.
    let length = (0..3).map(extent).fold(f64::MIN_POSITIVE, f64::max);
    0.5 * std::f64::consts::PI * (mu / density).sqrt() / length
}
