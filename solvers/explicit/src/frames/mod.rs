//! Implicit Euler with a fixed budget of work in each time step, as simulators run it.

mod colours;
mod conjugate_gradients;
mod constraints;
mod equations;
mod parallel;
mod tetrahedra;
mod touch;
mod vertex_descent;

use contact::{ContactCounts, ContactSurface, ToolState};
use lanes::LanePath;
use shape::Vector3;

use super::body::ExplicitBody;
use super::error::ExplicitError;
use super::force::InternalForce;
use super::motion::{Prescribed, constrained};
use conjugate_gradients::ConjugateGradients;
use constraints::Constraints;
use equations::{Equations, Sweeper};
use tetrahedra::tetrahedra;
pub use touch::FrameTool;
use touch::Touch;
use vertex_descent::VertexDescent;

/// Parameters of the time steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameParams {
    /// Time step `h`, s.
    pub dt: f64,
    /// Mass-proportional damping `alpha` of `C = alpha M`, 1/s.
    pub damping: f64,
    /// Whether mass acts. Without it each time step starts from the last and approaches equilibrium.
    pub inertia: bool,
    /// Sweeps over the body in each time step, or iterations of conjugate gradients.
    pub sweeps: usize,
}

/// Motion of a body by implicit Euler, whose equations get a fixed number of sweeps in each time step.
pub struct Frames<'a> {
    force: InternalForce<'a>,
    mass: &'a [f64],
    prescribed: &'a [Prescribed<'a>],
    constrained: Vec<[bool; 3]>,
    params: FrameParams,
    sweeper: Box<dyn Sweeper + 'a>,
    touch: Option<Touch<'a>>,
    /// Weight of each node in the equations, N/m.
    weights: Vec<f64>,
    inertial: Vec<Vector3>,
    load: Vec<Vector3>,
    u: Vec<Vector3>,
    v: Vec<Vector3>,
    steps: usize,
}

/// Body at the end of a time step.
#[derive(Clone, Debug)]
pub struct FrameState {
    /// Time, s.
    pub time: f64,
    /// Strain energy, J.
    pub strain: f64,
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// Largest out-of-balance force of the time step at a free degree of freedom, over the largest force of
    /// any kind: what the sweeps left.
    pub residual: f64,
    /// Force of the prescribed displacements on each node, N; zero at free degrees of freedom.
    pub reaction: Vec<Vector3>,
    /// State of each tool.
    pub tools: Vec<ToolState>,
}

/// External forces as a function `(t, f)` that adds the nodal forces (N) at time `t` (s) to `f`, which starts
/// from zero.
pub type FrameLoad<'a> = dyn FnMut(f64, &mut [Vector3]) + 'a;

impl<'a> Frames<'a> {
    /// Starts vertex block descent with an undeformed body at rest. `mass` (kg) has one value per node.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::NotTetrahedra`], [`ExplicitError::OtherLaw`], or invalid input.
    pub fn vertex_descent(
        body: ExplicitBody<'a>,
        mass: &'a [f64],
        prescribed: &'a [Prescribed<'a>],
        params: FrameParams,
    ) -> Result<Frames<'a>, ExplicitError> {
        let sweeper = VertexDescent::new(tetrahedra(&body)?, body.volume.rows().node_count(), params.sweeps);
        Frames::new(body, mass, prescribed, params, Box::new(sweeper))
    }

    /// Starts extended position-based dynamics with an undeformed body at rest, as
    /// [`Frames::vertex_descent`].
    ///
    /// # Errors
    ///
    /// [`ExplicitError::NotTetrahedra`], [`ExplicitError::OtherLaw`], or invalid input such as no inertia.
    pub fn constraints(
        body: ExplicitBody<'a>,
        mass: &'a [f64],
        prescribed: &'a [Prescribed<'a>],
        params: FrameParams,
    ) -> Result<Frames<'a>, ExplicitError> {
        if !params.inertia {
            return Err(ExplicitError::BadParameter { what: "inertia", value: 0.0, allowed: "present" });
        }
        let sweeper = Constraints::new(tetrahedra(&body)?, body.volume.rows().node_count(), params.sweeps);
        Frames::new(body, mass, prescribed, params, Box::new(sweeper))
    }

    /// Starts implicit Euler with one linearisation in each time step and at most `params.sweeps` iterations
    /// of conjugate gradients, down to the relative residual `tolerance`. `stiffness_damping` is the `beta`
    /// (s) of the damping `beta K`. Takes any table without a projection of the dilation, and any law.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::NotStandard`], or invalid input.
    pub fn conjugate_gradients(
        body: ExplicitBody<'a>,
        mass: &'a [f64],
        prescribed: &'a [Prescribed<'a>],
        params: FrameParams,
        [tolerance, stiffness_damping]: [f64; 2],
    ) -> Result<Frames<'a>, ExplicitError> {
        let stiff = 1.0 + stiffness_damping / params.dt;
        let solver = ConjugateGradients::new(body, [stiff, tolerance], params.sweeps)?;
        Frames::new(body, mass, prescribed, params, Box::new(solver))
    }

    fn new(
        body: ExplicitBody<'a>,
        mass: &'a [f64],
        prescribed: &'a [Prescribed<'a>],
        params: FrameParams,
        sweeper: Box<dyn Sweeper + 'a>,
    ) -> Result<Frames<'a>, ExplicitError> {
        let n = body.volume.rows().node_count();
        if mass.len() != n {
            return Err(ExplicitError::Length { what: "masses", found: mass.len(), expected: n });
        }
        for (what, value, sound) in
            [("time step", params.dt, params.dt > 0.0), ("damping", params.damping, params.damping >= 0.0)]
        {
            if !(sound && value.is_finite()) {
                return Err(ExplicitError::BadParameter { what, value, allowed: "positive and finite" });
            }
        }
        let marks = constrained(n, prescribed.iter().map(|of| (of.node, of.axis)))?;
        let constrained = marks.as_chunks::<3>().0.to_vec();
        let per_mass =
            if params.inertia { (1.0 + params.damping * params.dt) / params.dt.powi(2) } else { 0.0 };
        let zeros = || vec![Vector3::zeros(); n];
        Ok(Frames {
            force: InternalForce::new(body, LanePath::best())?,
            weights: mass.iter().map(|m| m * per_mass).collect(),
            inertial: zeros(),
            load: zeros(),
            u: zeros(),
            v: zeros(),
            touch: None,
            steps: 0,
            mass,
            prescribed,
            constrained,
            params,
            sweeper,
        })
    }

    /// Adds tools that press on a surface.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::Friction`] for a tool with friction.
    pub fn with_tools(
        mut self,
        surface: &'a ContactSurface<'a>,
        tools: Vec<FrameTool<'a>>,
    ) -> Result<Frames<'a>, ExplicitError> {
        self.touch = Some(Touch::new(surface, tools)?);
        Ok(self)
    }

    /// Displacements, m.
    pub fn u(&self) -> &[Vector3] {
        &self.u
    }

    /// Number of time steps so far.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Time, s.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.params.dt
    }

    /// Counters of the contact search at the states.
    pub fn contact_counts(&self) -> ContactCounts {
        self.touch.as_ref().map(Touch::counts).unwrap_or_default()
    }

    /// Makes one time step under the loads at its end.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::NotFinite`] if the motion has no numbers any more.
    pub fn step(&mut self, load: &mut FrameLoad) -> Result<(), ExplicitError> {
        let h = self.params.dt;
        let time = (self.steps + 1) as f64 * h;
        self.load.fill(Vector3::zeros());
        load(time, &mut self.load);
        let before = self.u.clone();
        if self.params.inertia {
            let part = h / (1.0 + self.params.damping * h);
            self.u.iter_mut().zip(&self.v).for_each(|(u, v)| *u += v * part);
        }
        self.inertial.copy_from_slice(&self.u);
        for of in self.prescribed {
            self.u[of.node as usize][usize::from(of.axis)] = (of.motion)(time);
        }
        if let Some(touch) = &mut self.touch {
            touch.drive(time);
        }
        let equations = Equations {
            weights: &self.weights,
            inertial: &self.inertial,
            before: &before,
            load: &self.load,
            constrained: &self.constrained,
            touch: self.touch.as_ref(),
        };
        self.sweeper.solve(&equations, &mut self.u);
        self.steps += 1;
        if let Some(node) = self.u.iter().position(|u| !u.iter().all(|c| c.is_finite())) {
            return Err(ExplicitError::NotFinite { step: self.steps, time, what: "displacement", node });
        }
        if self.params.inertia {
            let ends = self.u.iter().zip(&before);
            self.v.iter_mut().zip(ends).for_each(|(v, (u, before))| *v = (u - before) / h);
        }
        Ok(())
    }

    /// Evaluates the tools at the end of the last time step.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::ContactAt`] if a tool has passed through the surface.
    pub fn tools(&mut self) -> Result<Vec<ToolState>, ExplicitError> {
        self.pushed(&mut vec![Vector3::zeros(); self.u.len()])
    }

    /// Evaluates the tools, and adds their forces on the nodes (N).
    fn pushed(&mut self, forces: &mut [Vector3]) -> Result<Vec<ToolState>, ExplicitError> {
        let (step, time) = (self.steps, self.time());
        match &mut self.touch {
            Some(touch) => (touch.settle(&self.u, forces))
                .map_err(|(tool, cause)| ExplicitError::ContactAt { step, time, tool, cause }),
            None => Ok(Vec::new()),
        }
    }

    /// Evaluates the state at the end of the last time step.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::InvertedAt`] if a tetrahedron is inverted, and [`ExplicitError::ContactAt`] if a tool
    /// has passed through the surface.
    pub fn state(&mut self) -> Result<FrameState, ExplicitError> {
        let (step, time) = (self.steps, self.time());
        let inverted = |at| ExplicitError::InvertedAt { step, time, at };
        let zeros = vec![Vector3::zeros(); self.u.len()];
        let (mut internal, mut pushed) = (zeros.clone(), zeros);
        self.force.evaluate(&self.u, &mut internal).map_err(inverted)?;
        let tools = self.pushed(&mut pushed)?;
        let mut reaction = vec![Vector3::zeros(); self.u.len()];
        let (mut out, mut largest) = (0.0f64, 0.0f64);
        for i in 0..self.u.len() {
            let inertia = (self.u[i] - self.inertial[i]) * self.weights[i];
            let lacking = inertia + internal[i] - self.load[i] - pushed[i];
            for force in [inertia, internal[i], self.load[i], pushed[i]] {
                largest = largest.max(force.amax());
            }
            for axis in 0..3 {
                match self.constrained[i][axis] {
                    true => reaction[i][axis] = lacking[axis],
                    false => out = out.max(lacking[axis].abs()),
                }
            }
        }
        let moving = self.mass.iter().zip(&self.v);
        Ok(FrameState {
            time,
            strain: self.force.energy(&self.u).map_err(inverted)?,
            kinetic: moving.map(|(m, v)| 0.5 * m * v.norm_squared()).sum(),
            residual: if largest > 0.0 { out / largest } else { 0.0 },
            reaction,
            tools,
        })
    }
}
