//! Explicit time integration: central differences with velocities at half steps.

use shape::{Matrix3, Vector3};

use super::active::Contraction;
use super::critical_step::{CriticalStep, Estimate, Springs, critical_step_touching};
use super::motion::{Balance, DynamicsParams, External, Prescribed, constrained};
use super::step_lanes::{Forces, Inertia, accelerate, advance};
use super::stiffness_damping::StiffnessDamping;
use crate::error::ExplicitError;
use crate::force::InternalForce;
use crate::kernel::Precision;
use crate::tools::Tools;

/// Explicit time integration of a body. The bits do not depend on the number of threads.
pub struct Dynamics<'a, 'b> {
    force: &'b mut InternalForce<'a>,
    mass: &'b [f64],
    prescribed: &'b [Prescribed<'b>],
    params: DynamicsParams,
    /// Indices of the prescribed degrees of freedom that are still held.
    held: Vec<usize>,
    constrained: Vec<bool>,
    inertia: Inertia,
    tools: Option<Tools<'b>>,
    ground: Vec<Springs<'b>>,
    contraction: Option<Contraction<'b>>,
    stiffness_damping: Option<StiffnessDamping>,
    step: usize,
    /// Step and time of the last change of the time step.
    since: (usize, f64),
    /// Previous time step, s; differs from the next one right after a change of the time step.
    before: f64,
    u: Vec<Vector3>,
    /// Velocities at `n - 1/2`, m/s.
    v: Vec<Vector3>,
    internal: Vec<Vector3>,
    external: Vec<Vector3>,
    previous_external: Vec<Vector3>,
    reaction: Vec<f64>,
    /// Work of external forces and of supports, and energy lost to damping, J.
    work: [f64; 3],
    /// Half of this step's damping work, which belongs to the next step, J.
    pending: f64,
    start: Option<f64>,
    scale: f64,
    /// Last estimate of the critical step.
    estimate: Option<Estimate>,
}

impl<'a, 'b> Dynamics<'a, 'b> {
    /// Starts from displacements `u` (m) and velocities `v` (m/s) at t = 0.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::StepTooLarge`] if the time step exceeds the critical step; also for invalid lengths,
    /// parameters, masses or degrees of freedom.
    pub fn new(
        force: &'b mut InternalForce<'a>,
        mass: &'b [f64],
        prescribed: &'b [Prescribed<'b>],
        params: DynamicsParams,
        u: Vec<Vector3>,
        v: Vec<Vector3>,
    ) -> Result<Dynamics<'a, 'b>, ExplicitError> {
        let n = force.node_count();
        for (what, found) in [("masses", mass.len()), ("displacements", u.len()), ("velocities", v.len())] {
            if found != n {
                return Err(ExplicitError::Length { what, found, expected: n });
            }
        }
        let bad = |what, value, allowed| Err(ExplicitError::BadParameter { what, value, allowed });
        if !(params.dt > 0.0 && params.dt.is_finite()) {
            return bad("time step", params.dt, "positive and finite");
        }
        if !(params.damping >= 0.0 && params.damping.is_finite()) {
            return bad("mass-proportional damping", params.damping, "finite and not negative");
        }
        if let Some(node) = mass.iter().position(|&m| !(m > 0.0 && m.is_finite())) {
            return Err(ExplicitError::NodalMass { node, mass: mass[node] });
        }
        let constrained = constrained(n, prescribed.iter().map(|p| (p.node, p.axis)))?;
        let zeros = vec![Vector3::zeros(); n];
        let mut dynamics = Dynamics {
            force,
            mass,
            prescribed,
            held: (0..prescribed.len()).collect(),
            params,
            inertia: Inertia::new(mass, &constrained),
            constrained,
            tools: None,
            ground: Vec::new(),
            contraction: None,
            stiffness_damping: None,
            step: 0,
            since: (0, 0.0),
            before: params.dt,
            u,
            v,
            internal: zeros.clone(),
            external: zeros.clone(),
            previous_external: zeros,
            reaction: vec![0.0; prescribed.len()],
            work: [0.0; 3],
            pending: 0.0,
            start: None,
            scale: 0.0,
            estimate: None,
        };
        for p in prescribed {
            dynamics.u[p.node as usize][p.axis as usize] = (p.motion)(0.0);
        }
        let gradients = dynamics.gradients();
        dynamics.estimate = params.known.map(|critical| Estimate { critical, gradients });
        dynamics.check_step()?;
        Ok(dynamics)
    }

    /// Adds tools that may touch the body. Their penalties count in the critical step from here on.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::StepTooLarge`] if the time step exceeds the critical step with these penalties.
    pub fn with_tools(mut self, tools: Tools<'b>) -> Result<Dynamics<'a, 'b>, ExplicitError> {
        self.tools = Some(tools);
        if self.params.known.is_none() {
            self.estimate = None;
        }
        self.check_step()?;
        Ok(self)
    }

    /// Adds springs and dampers to the ground, whose forces are among the external ones, to the estimates of
    /// the critical step.
    pub fn on_ground(mut self, springs: Vec<Springs<'b>>) -> Dynamics<'a, 'b> {
        self.ground = springs;
        self
    }

    /// Adds an active stress along the fibres, whose forces count as external ones, to the motion and to the
    /// estimates of the critical step.
    pub fn contracting(mut self, contraction: Contraction<'b>) -> Dynamics<'a, 'b> {
        self.contraction = Some(contraction);
        self
    }

    /// Adds the damping `beta K` to `C`, `beta` in s, with the tangent `K` of the internal forces in the current
    /// state, without an active stress. It shortens the critical step: see
    /// [`CriticalStep::with_stiffness_damping`].
    ///
    /// # Errors
    ///
    /// [`ExplicitError::BadParameter`] if `beta` is negative or not finite, [`ExplicitError::StepTooLarge`] if the
    /// time step exceeds the critical step with this damping.
    pub fn with_stiffness_damping(mut self, beta: f64) -> Result<Dynamics<'a, 'b>, ExplicitError> {
        if !(beta >= 0.0 && beta.is_finite()) {
            let what = "stiffness-proportional damping";
            return Err(ExplicitError::BadParameter {
                what,
                value: beta,
                allowed: "finite and not negative",
            });
        }
        if beta > 0.0 {
            self.stiffness_damping = Some(StiffnessDamping::new(beta, self.u.len()));
            if self.params.known.is_none() {
                self.estimate = None;
            }
            self.check_step()?;
        }
        Ok(self)
    }

    /// Tools in the state of the last recorded or completed step.
    pub fn tools(&self) -> Option<&Tools<'b>> {
        self.tools.as_ref()
    }

    /// Lets go of the prescribed degrees of freedom whose index `gone` names: from here on they move
    /// freely, from the velocity that they have.
    pub fn release(&mut self, gone: impl Fn(usize) -> bool) {
        for &k in self.held.iter().filter(|k| gone(**k)) {
            let Prescribed { node, axis, .. } = self.prescribed[k];
            let (i, axis) = (node as usize, usize::from(axis));
            // The other half of this step's work is that of no force.
            self.work[1] += 0.5 * self.before * self.v[i][axis] * std::mem::take(&mut self.reaction[k]);
            self.constrained[3 * i + axis] = false;
        }
        self.held.retain(|k| !gone(*k));
        self.inertia = Inertia::new(self.mass, &self.constrained);
        self.estimate = None;
    }

    /// Sets the time step `dt` (s) of the steps that follow.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::BadParameter`] if `dt` is not positive and finite, [`ExplicitError::StepTooLarge`] if
    /// `dt` exceeds the critical step, [`ExplicitError::InvertedAt`] if a point is inverted.
    pub fn set_step(&mut self, dt: f64) -> Result<(), ExplicitError> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(ExplicitError::BadParameter {
                what: "time step",
                value: dt,
                allowed: "positive and finite",
            });
        }
        self.since = (self.step, self.time());
        if self.step == 0 {
            self.before = dt;
        }
        self.params.dt = dt;
        self.check_step()
    }

    fn gradients(&self) -> Vec<Matrix3> {
        self.force.body().volume.at().displacement_gradients(&self.u)
    }

    /// Returns the critical step at the current displacements, or the last estimate if the body has hardly
    /// changed its shape since. An estimate takes thirty evaluations of the internal forces, the comparison
    /// of shapes as long as about one evaluation.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::InvertedAt`] if a point is inverted.
    pub fn critical_step(&mut self) -> Result<CriticalStep, ExplicitError> {
        let gradients = self.gradients();
        if let Some(last) = self.estimate.as_ref().filter(|last| last.serves(&gradients)) {
            return Ok(last.critical);
        }
        let critical = self.estimated()?;
        self.estimate = Some(Estimate { critical, gradients });
        Ok(critical)
    }

    fn estimated(&mut self) -> Result<CriticalStep, ExplicitError> {
        let constrained = &self.constrained;
        let contact = self.tools.as_ref().and_then(Tools::springs);
        let springs: Vec<Springs> = contact.into_iter().chain(self.ground.iter().copied()).collect();
        let step = self.step;
        let time = self.time();
        if let Some(contraction) = &self.contraction {
            self.force.contract(&contraction.largest);
        }
        let found = critical_step_touching(
            self.force,
            self.mass,
            &self.u,
            |k| !constrained[k],
            &springs,
            self.params.critical,
        );
        self.force.contract(&[]);
        let beta = self.stiffness_damping.as_ref().map(StiffnessDamping::beta);
        let found = found.map(|found| beta.into_iter().fold(found, CriticalStep::with_stiffness_damping));
        found.map_err(|error| match error {
            ExplicitError::Inverted(at) => ExplicitError::InvertedAt { step, time, at },
            other => other,
        })
    }

    /// Returns what rounding changes in the internal forces at the displacements `u` (m); see
    /// [`InternalForce::rounding`]. Returns zero in double precision, without an evaluation.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::Inverted`] if a point is inverted.
    pub fn rounding(&mut self, u: &[Vector3]) -> Result<f64, ExplicitError> {
        match self.force.precision() {
            Precision::Double => Ok(0.0),
            Precision::Single => Ok(self.force.rounding(u)?),
        }
    }

    /// Current displacements, m, one vector per node.
    pub fn displacements(&self) -> &[Vector3] {
        &self.u
    }

    /// Velocities half a step before the current displacements, m/s; at the start the given velocities.
    pub fn velocities(&self) -> &[Vector3] {
        &self.v
    }

    /// Number of completed steps.
    pub fn steps(&self) -> usize {
        self.step
    }

    /// Time of the current displacements, s; 0 at the start.
    pub fn time(&self) -> f64 {
        self.since.1 + (self.step - self.since.0) as f64 * self.params.dt
    }

    /// Forces of the supports on the body in the last completed step, N, in the order of the prescribed
    /// degrees of freedom given to [`Dynamics::new`]; zero once released.
    pub fn reactions(&self) -> &[f64] {
        &self.reaction
    }

    /// Makes `steps` steps. `record` is called with the balance and the displacements at every step whose
    /// number is a multiple of `every` (0: never), before the displacements advance.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::InvertedAt`], [`ExplicitError::NotFinite`], [`ExplicitError::StepTooLarge`],
    /// [`ExplicitError::ContactAt`] or [`ExplicitError::LightTool`], with the step and the time.
    pub fn run(
        &mut self,
        steps: usize,
        every: usize,
        external: &mut External,
        record: &mut dyn FnMut(&Balance, &[Vector3]),
    ) -> Result<(), ExplicitError> {
        for _ in 0..steps {
            let recheck = self.params.recheck;
            if recheck > 0 && self.step > 0 && self.step.is_multiple_of(recheck) {
                self.check_step()?;
            }
            let kinetic = self.accelerate(external)?;
            if every > 0 && self.step.is_multiple_of(every) {
                let balance = self.balance(kinetic)?;
                record(&balance, &self.u);
            }
            self.advance();
        }
        Ok(())
    }

    /// Computes the forces at `n`, then the velocities at `n + 1/2`, and returns the kinetic energy at `n`,
    /// J.
    ///
    /// With `c = alpha dt / 2`: `v_(n+1/2) = ((1 - c) v_(n-1/2) + dt M^-1 (f_ext - f_int)) / (1 + c)`; `dt`
    /// is the mean of the steps before and after.
    fn accelerate(&mut self, external: &mut External) -> Result<f64, ExplicitError> {
        let step = self.step;
        let time = self.time();
        let before_dt = self.before;
        let after_dt = self.params.dt;
        let dt = 0.5 * (before_dt + after_dt);
        self.force.evaluate(&self.u, &mut self.internal).map_err(|at| ExplicitError::InvertedAt {
            step,
            time,
            at,
        })?;
        std::mem::swap(&mut self.external, &mut self.previous_external);
        self.external.fill(Vector3::zeros());
        external(time, &self.u, &self.v, &mut self.external);
        self.act_on_itself(time)?;
        if let Some(tools) = &mut self.tools {
            tools.step(step, time, [before_dt, after_dt], &self.u)?;
        }

        let c = 0.5 * self.params.damping * dt;
        let keep = (1.0 - c) / (1.0 + c);
        let push = dt / (1.0 + c);
        let first = step == 0;
        // From here on, the internal forces are the forces that the body holds against its loads, contact
        // included.
        for (node, touch) in self.tools.iter().flat_map(Tools::forces) {
            self.internal[node] -= touch;
        }
        if first {
            // The step below then ends at v_0 + dt/2 a_0: v_(-1/2) = (1 + c) v_0 - dt/2 M^-1 f.
            for i in 0..self.v.len() {
                let f = self.external[i] - self.internal[i];
                self.v[i] = self.v[i] * (1.0 + c) - f * (0.5 * dt / self.mass[i]);
            }
        }
        for p in self.held.iter().map(|&k| &self.prescribed[k]) {
            self.v[p.node as usize][p.axis as usize] = 0.0;
        }
        let forces =
            Forces { external: &self.external, before: &self.previous_external, internal: &self.internal };
        let sums = accelerate(self.force.path(), &self.inertia, [keep, push], forces, &mut self.v);
        let mut kinetic = 0.5 * sums.kinetic;
        let mut moved = sums.moved;
        let [mut lost, mut next_lost] = sums.lost.map(|lost| 0.5 * lost);
        let work = if first { 0.0 } else { 0.5 * before_dt * sums.work };
        // Prescribed velocities, their part of the energies and their reactions.
        for &k in &self.held {
            let (p, reaction) = (&self.prescribed[k], &mut self.reaction[k]);
            let (i, axis) = (p.node as usize, p.axis as usize);
            let m = self.mass[i];
            let now = self.u[i][axis];
            let after = ((p.motion)(time + after_dt) - now) / after_dt;
            let before = if first { after } else { (now - (p.motion)(time - before_dt)) / before_dt };
            let mean = 0.5 * (before + after);
            let next = self.internal[i][axis] - self.external[i][axis]
                + m * ((after - before) / dt + self.params.damping * mean);
            if !first {
                self.work[1] += 0.5 * before_dt * before * (*reaction + next);
            }
            *reaction = next;
            lost += m * before * mean;
            next_lost += m * after * mean;
            kinetic += 0.5 * m * before * after;
            moved += after * after;
            self.v[i][axis] = after;
        }
        // This single sum checks all velocities: it is finite only if each of them is (below 1e154 m/s).
        if !moved.is_finite() {
            return Err(self.not_finite(step, time));
        }
        self.work[0] += work;
        // The kinetic energy loses exactly `alpha dt/2 v_(n+1/2) . M (v_n + v_(n+1))` per step, v_n the mean
        // of its neighbours. Half of it is known at n, half at n + 1.
        let half = 0.5 * self.params.damping * dt;
        if !first {
            self.work[2] += half * lost + self.pending;
        }
        self.pending = half * next_lost;
        Ok(kinetic)
    }

    /// Adds the forces of active stress and of stiffness-proportional damping to the external forces.
    fn act_on_itself(&mut self, time: f64) -> Result<(), ExplicitError> {
        let step = self.step;
        if let Some(contraction) = &self.contraction {
            let active = (contraction.stress)(time);
            (self.force.body().add_active_forces(&active, -1.0, &self.u, &mut self.external))
                .map_err(|at| ExplicitError::InvertedAt { step, time, at })?;
        }
        if let Some(damping) = &mut self.stiffness_damping {
            let (dt, external) = (self.before, &mut self.external);
            damping.act(&self.internal, dt, &self.v, &self.constrained, external);
        }
        Ok(())
    }

    fn not_finite(&self, step: usize, time: f64) -> ExplicitError {
        let bad = |f: &[Vector3]| f.iter().position(|f| !f.iter().all(|c| c.is_finite()));
        let (what, node) =
            [("external force", &self.external), ("displacement", &self.u), ("velocity", &self.v)]
                .into_iter()
                .find_map(|(what, f)| bad(f).map(|node| (what, node)))
                .unwrap_or_else(|| {
                    // All values are finite, but the square of one overflows: report the node with the
                    // largest velocity.
                    let speed = |i: &usize| self.v[*i].amax();
                    let fastest = (0..self.v.len()).max_by(|i, j| speed(i).total_cmp(&speed(j)));
                    ("kinetic energy", fastest.unwrap_or(0))
                });
        ExplicitError::NotFinite { step, time, what, node }
    }

    /// Computes `u_(n+1) = u_n + dt v_(n+1/2)`.
    fn advance(&mut self) {
        let dt = self.params.dt;
        advance(self.force.path(), dt, &self.v, &mut self.u);
        self.before = dt;
        self.step += 1;
        let time = self.time();
        for p in self.held.iter().map(|&k| &self.prescribed[k]) {
            self.u[p.node as usize][p.axis as usize] = (p.motion)(time);
        }
    }

    fn balance(&mut self, kinetic: f64) -> Result<Balance, ExplicitError> {
        let step = self.step;
        let time = self.time();
        let inverted = |at| ExplicitError::InvertedAt { step, time, at };
        let mut strain = self.force.energy(&self.u).map_err(inverted)?;
        let [mut external, support, mut damping] = self.work;
        if let Some(StiffnessDamping { lost: [free, prescribed], .. }) = &self.stiffness_damping {
            // Its forces in free degrees of freedom have worked as external ones so far.
            (external, damping) = (external + free, damping + free + prescribed);
        }
        if let Some(contraction) = &self.contraction {
            let active = (contraction.stress)(time);
            // Its force has worked as an external one so far.
            let energy = self.force.body().active_energy(&active, &self.u).map_err(inverted)?;
            (strain, external) = (strain + energy, external + energy);
        }
        let tools = self.tools.as_ref().map(Tools::energies).unwrap_or_default();
        let gained =
            kinetic + strain + damping + tools.kinetic + tools.stored + tools.friction + tools.damping;
        let total = gained - external - support - tools.work;
        let start = *self.start.get_or_insert(total);
        let terms = [kinetic, strain, damping, external, support, tools.work, tools.stored, tools.friction];
        self.scale = terms.iter().fold(self.scale, |a, b| a.max(b.abs()));
        let drift = if self.scale > 0.0 { (total - start) / self.scale } else { 0.0 };
        Ok(Balance { step, time, kinetic, strain, external, support, damping, tools, drift })
    }

    fn check_step(&mut self) -> Result<(), ExplicitError> {
        let step = self.step;
        let time = self.time();
        let dt = self.params.dt;
        let critical = self.critical_step()?.dt;
        // A NaN must not pass, hence `!(dt <= critical)`.
        if !(dt <= critical) {
            return Err(ExplicitError::StepTooLarge { step, time, dt, critical });
        }
        Ok(())
    }
}
