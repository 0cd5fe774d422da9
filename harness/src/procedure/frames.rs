//! Frames with a fixed budget of work, as simulators run them, and the results of each recorded state.

use cases::scene::Swept;
use catalogue::metric;
use contact::{ContactSurface, Drive};
use explicit::{
    ExplicitError, FrameLoad, FrameParams, FrameState, FrameTool, Frames, Lumping, Prescribed, lumped_mass,
};
use geometry::Vector3;

use super::explicit::{body, smallest_j};
use super::loading::Loading;
use super::problem::Problem;
use super::solution::{Solution, StepHistory};
use super::stages::Stages;
use crate::error::{Failure, Key};
use crate::outcome::timing::Meters;
use crate::outcome::{Counters, LoadStep, Metric, ToolStep};
use crate::prepare::ConditionForces;
use crate::scenario::PlacedTool;
use crate::scenario::setup::Setup;

/// Kinds of sweeps over the body.
#[derive(Clone, Copy)]
pub(super) enum Sweeps {
    /// Vertex block descent.
    VertexDescent,
    /// Constraints of extended position-based dynamics.
    Constraints,
    /// Iterations of conjugate gradients on one linearisation in each frame.
    ConjugateGradients {
        /// Relative residual at which the iterations end.
        tolerance: f64,
    },
}

impl Sweeps {
    /// Words for plans: what is repeated, and what is solved at a time.
    fn words(self) -> [&'static str; 2] {
        match self {
            Sweeps::VertexDescent => ["sweeps of vertex block descent", "a block of each node at a time"],
            Sweeps::Constraints => ["sweeps of extended position-based dynamics", "a constraint at a time"],
            Sweeps::ConjugateGradients { .. } => {
                ["iterations of conjugate gradients", "products with tangents of points"]
            }
        }
    }
}

pub(super) fn stages(setup: &Setup, asked: &Swept, kind: Sweeps) -> Stages {
    let [name, part] = kind.words();
    let (step, count) = asked.time_steps();
    let steps = format!(
        "{} s in {} steps of {step:e} s, {} {name} in each{}",
        asked.ramp.duration,
        count * asked.ramp.steps,
        asked.sweeps,
        setup.curves(),
    );
    Stages {
        mass: if asked.inertia { (true, "lumped".into()) } else { (false, "without inertia".into()) },
        stiffness: (false, format!("not assembled: {part}")),
        time_steps: (true, steps),
        factorisation: (false, format!("no system of equations: {part}")),
        newton: (false, "a fixed amount of work in each step".into()),
        ..Stages::linear()
    }
}

/// Advances the body from rest, frame by frame. A run that ends early keeps its results, or those of the
/// start if no state was recorded.
pub(super) fn solve(
    problem: &Problem,
    asked: &Swept,
    kind: Sweeps,
    meters: &mut Meters,
) -> Result<Solution, Failure> {
    let Meters { timings, counters, .. } = meters;
    timings.time("solve", || motion(problem, asked, kind, counters))
}

fn motion(
    problem: &Problem,
    asked: &Swept,
    kind: Sweeps,
    counters: &mut Counters,
) -> Result<Solution, Failure> {
    let mass = mass(problem, asked)?;
    if asked.inertia {
        counters.mass_nodes += mass.len() as u64;
    }
    let (_, count) = asked.time_steps();
    with_frames(problem, asked, kind, &mass, |frames, load, free| {
        let mut states = States::default();
        let failure = states.march(frames, load, count, problem, asked).err();
        let made = frames.steps() as u64;
        counters.time_steps += made;
        counters.contact_evaluations += frames.contact_counts().evaluations;
        counters.contact_skips += frames.contact_counts().skipped;
        let u = states.fields.last().cloned();
        Solution {
            dofs: free,
            u: u.unwrap_or_else(|| vec![Vector3::zeros(); mass.len()]),
            history: Some(states.history(problem, asked, made, mass.iter().sum(), failure)),
            ..Solution::default()
        }
    })
}

/// Mass of each node, kg; zero without inertia.
pub(super) fn mass(problem: &Problem, asked: &Swept) -> Result<Vec<f64>, Failure> {
    let (setup, volume) = (problem.setup, &problem.prepared.volume);
    Ok(match asked.inertia {
        true => {
            lumped_mass(&volume.rows, &setup.density()?, &volume.region, Lumping::for_table(&volume.rows))?
        }
        false => vec![0.0; volume.rows.rows().node_count()],
    })
}

/// Calls `work` with frames at the start, their loads, and the number of free degrees of freedom.
pub(super) fn with_frames<T>(
    problem: &Problem,
    asked: &Swept,
    kind: Sweeps,
    mass: &[f64],
    work: impl FnOnce(&mut Frames, &mut FrameLoad, usize) -> T,
) -> Result<T, Failure> {
    let Problem { setup, prepared, .. } = *problem;
    let loading = Loading::new(problem, &asked.ramp)?;
    let mut load = |t: f64, f: &mut [Vector3]| {
        for (curve, forces) in &loading.loads {
            let part = curve.value(t);
            forces.iter().for_each(|(i, force)| f[*i] += force * part);
        }
    };
    let motions = loading.motions();
    let prescribed: Vec<Prescribed> = (loading.led.keys().zip(&motions))
        .map(|(&(node, axis), motion)| Prescribed { node, axis, motion: motion.as_ref() })
        .collect();
    let (dt, _) = asked.time_steps();
    let params =
        FrameParams { dt, damping: asked.ramp.damping, inertia: asked.inertia, sweeps: asked.sweeps };
    let surface = prepared.contact();
    let closures: Vec<_> = setup.tools.iter().map(|of| closure(of, asked)).collect::<Result<_, _>>()?;
    let body = body(setup, prepared);
    let frames = match kind {
        Sweeps::VertexDescent => Frames::vertex_descent(body, mass, &prescribed, params),
        Sweeps::Constraints => Frames::constraints(body, mass, &prescribed, params),
        Sweeps::ConjugateGradients { tolerance } => {
            let more = [tolerance, asked.ramp.stiffness_damping];
            Frames::conjugate_gradients(body, mass, &prescribed, params, more)
        }
    };
    let mut frames = frames.map_err(|error| unavailable(error, problem))?;
    if let Some(surface) = &surface {
        frames =
            with_tools(frames, surface, setup, &closures).map_err(|error| unavailable(error, problem))?;
    }
    Ok(work(&mut frames, &mut load, 3 * mass.len() - loading.led.len()))
}

/// Displacement of a tool (m) over time (s).
type Closure<'a> = Box<dyn Fn(f64) -> f64 + Sync + 'a>;

fn closure<'a>(of: &'a PlacedTool, asked: &Swept) -> Result<Closure<'a>, Failure> {
    let Drive::Closure(full) = of.drive else {
        let problem = format!("'{}' is driven by a force, which sweeps do not support", of.name);
        return Err(Failure::unavailable(
            Key::Scene("tool".into()),
            problem,
            "give drive = { closure = ... }",
        ));
    };
    let over = of.over.unwrap_or(asked.ramp.duration);
    Ok(match &of.curve {
        Some(curve) => Box::new(move |t| full * curve.value(t)),
        None if over > 0.0 => Box::new(move |t| full * (t / over).clamp(0.0, 1.0)),
        None => Box::new(move |_| full),
    })
}

fn with_tools<'a>(
    frames: Frames<'a>,
    surface: &'a ContactSurface<'a>,
    setup: &'a Setup,
    closures: &'a [Closure<'a>],
) -> Result<Frames<'a>, ExplicitError> {
    let each = setup.tools.iter().zip(closures);
    let tools = each.map(|(of, closure)| FrameTool { tool: &of.tool, closure: closure.as_ref() });
    frames.with_tools(surface, tools.collect())
}

/// Names the key of a table, a law or a tool that sweeps do not support.
fn unavailable(error: ExplicitError, problem: &Problem) -> Failure {
    let at = |key, help| Failure::unavailable(key, error.to_string(), help);
    match &error {
        ExplicitError::NotTetrahedra => {
            at(Key::Method("element"), "take element = \"tet4\", dilation = \"standard\"")
        }
        ExplicitError::NotStandard => at(Key::Method("dilation"), "take dilation = \"standard\""),
        ExplicitError::OtherLaw { .. } => {
            at(Key::Scene("material.law".into()), "take law = \"stable-neo-hookean\"")
        }
        ExplicitError::Friction { tool } => {
            let key = Key::Scene(format!("tool[{tool}].friction"));
            let help = format!("leave the friction of '{}' out", problem.setup.tools[*tool].name);
            Failure::unavailable(key, error.to_string(), &help)
        }
        _ => error.into(),
    }
}

/// Recorded states so far.
#[derive(Default)]
struct States {
    steps: Vec<LoadStep>,
    fields: Vec<Vec<Vector3>>,
    residual: f64,
}

impl States {
    /// Advances to the end in intervals of `count` time steps and records the state after each.
    fn march(
        &mut self,
        frames: &mut Frames,
        load: &mut FrameLoad,
        count: usize,
        problem: &Problem,
        asked: &Swept,
    ) -> Result<(), ExplicitError> {
        for _ in 0..asked.ramp.steps {
            for _ in 0..count {
                frames.step(load)?;
            }
            let state = frames.state()?;
            let step = reported(&state, frames.u(), problem, asked);
            if let Some(watch) = problem.watch {
                watch.step(&step);
            }
            self.residual = state.residual;
            self.steps.push(step);
            self.fields.push(frames.u().to_vec());
        }
        Ok(())
    }

    fn history(
        self,
        problem: &Problem,
        asked: &Swept,
        made: u64,
        mass: f64,
        failure: Option<ExplicitError>,
    ) -> StepHistory {
        let States { steps, fields, residual } = self;
        let last = steps.last().cloned();
        let last = last.unwrap_or_else(|| LoadStep::at_start(problem.setup.tools.len()));
        let mut metrics = vec![
            Metric::new(&metric::TIME_STEPS, made as f64),
            Metric::new(&metric::TIME_REACHED, last.load * asked.ramp.duration),
            Metric::new(&metric::SWEEPS, made as f64 * asked.sweeps as f64),
            Metric::new(&metric::SWEEP_RESIDUAL, residual),
        ];
        if asked.inertia {
            metrics.push(Metric::new(&metric::MASS, mass));
        }
        StepHistory { steps, fields, last, metrics, failure: failure.map(Failure::from) }
    }
}

fn reported(state: &FrameState, u: &[Vector3], problem: &Problem, asked: &Swept) -> LoadStep {
    let Problem { method, setup, prepared, .. } = *problem;
    let tools = state.tools.iter().zip(&setup.tools).map(|(state, set)| ToolStep::of(state, &set.tool));
    let mut more = vec![Metric::new(&metric::TIME, state.time)];
    if asked.inertia {
        more.push(Metric::new(&metric::KINETIC_ENERGY, state.kinetic));
    }
    LoadStep {
        load: state.time / asked.ramp.duration,
        tools: tools.collect(),
        supports: prepared.support_forces(&ConditionForces {
            at: &|i| method.nodes()[i] + u[i],
            nodes: &state.reaction,
            rows: &[],
            weak: &[],
            time: Some(state.time),
        }),
        means: Vec::new(),
        strain_energy: Some(state.strain),
        smallest_j: smallest_j(prepared, u),
        iterations: 0,
        probes: Vec::new(),
        points: Vec::new(),
        against: Vec::new(),
        more,
    }
}
