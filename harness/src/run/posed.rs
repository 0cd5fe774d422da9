//! A method's problem, posed to a solver outside: its tables, what acts on its nodes, and a displacement judged as one of our own.

use cases::scene::Procedure;
use contact::{ContactHistory, Drive, ToolState};
use geometry::{Mesh, Point3, Vector3};
use reports::Family;
use shape::{FixedDof, GradRows, PointRows, VolumeRows};

use super::{Group, loaded, size};
use crate::Failure;
use crate::discretise::Discretisation;
use crate::measure::{self, Request, check_probes};
use crate::outcome::{Counters, Identity, Meters, Outcome, Plan, StageName, ToolStep};
use crate::prepare::{Prepared, prepare};
use crate::procedure::external::{steps, taken};
use crate::procedure::{Problem, Solution};
use crate::scenario::Scenario;
use crate::scenario::setup::Setup;

/// A method's problem with all of its tables, not solved.
pub struct Posed {
    identity: Identity,
    method: Discretisation,
    setup: Setup,
    prepared: Prepared,
    plan: Plan,
}

/// What a solver outside found.
#[derive(Clone, Debug)]
pub struct Found {
    /// Its name.
    pub solver: String,
    /// Nodal parameters (m), which are displacements on a mesh: at the end of each of equal load steps, or at the end alone.
    pub fields: Vec<Vec<Vector3>>,
    /// Force (N) of each tool along its way at the end; by the scene's contact law where the solver gives none.
    pub pushed: Option<Vec<f64>>,
    /// What it took, s, where that is known.
    pub seconds: Option<f64>,
}

/// A tool of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct PosedTool {
    /// Its name.
    pub name: String,
    /// Unit direction of its way.
    pub along: Vector3,
    /// Its way at the end (m), where the scene drives it by that.
    pub closure: Option<f64>,
}

impl Group<'_> {
    /// Fills the tables of a method without solving it.
    ///
    /// # Errors
    /// A procedure other than linear and static, whose ends are not at rest, a cloud that follows an error, and what a run is
    /// refused for.
    pub fn pose(&self, scenario: &Scenario) -> Result<Posed, Failure> {
        let (method, setup) = (scenario.discretise()?, scenario.setup()?);
        let (plan, _) = self.plan(scenario)?;
        let refused = |problem: &str| Err(scenario.locate(Failure::Run(problem.into())));
        if !matches!(setup.procedure, Procedure::Linear { .. } | Procedure::Static(_)) {
            return refused("can't be posed to another solver: give kind = \"linear\" or \"static\"");
        }
        if plan.runs(StageName::Refinement) {
            return refused("refines its cloud by its own solutions: pose one without refine");
        }
        check_probes(method.mesh(), self.probes())?;
        let prepared = prepare(&method, &setup, &plan, &mut Counters::default());
        let prepared = prepared.map_err(|failure| scenario.locate(failure))?;
        Ok(Posed { identity: scenario.identity(), method, setup, prepared, plan })
    }

    /// Measures what a solver outside found, with the errors of any other run.
    ///
    /// # Errors
    /// Fields of another number of nodes or with numbers that are not finite, more fields than load steps, and forces of
    /// another number of tools.
    pub fn compare(&self, posed: &Posed, found: Found) -> Result<Outcome, Failure> {
        posed.check(&found)?;
        let request = Request { watch: None, ..self.request() };
        let Posed { method, setup, prepared, .. } = posed;
        let plan = posed.plan(&found.solver);
        let problem = Problem { method, setup, prepared, plan: &plan, watch: None, probes: self.probes() };
        let mut solution = taken(&problem, found.fields, 1.0)?;
        posed.touch(&mut solution, found.pushed)?;
        let mut meters = Meters::default();
        found.seconds.into_iter().for_each(|seconds| meters.timings.book("solve", seconds));
        let run = measure::Solved { method, setup, prepared, solution: &solution };
        let identity = Identity {
            family: Family::External,
            adapter: Some(found.solver),
            // A projection is of our own elements.
            dilation: None,
            ..posed.identity.clone()
        };
        let mut outcome = Outcome::new(identity, size(method, prepared, solution.dofs), plan);
        loaded(&mut outcome, &run, &request, meters)?;
        self.hold_against(&mut outcome);
        Ok(outcome)
    }
}

impl Posed {
    /// Positions that nodal parameters belong to, m.
    pub fn nodes(&self) -> &[Point3] {
        self.method.nodes()
    }

    /// The cells: elements, or the background of a cloud.
    pub fn mesh(&self) -> &Mesh {
        self.method.mesh()
    }

    /// Whether nodal parameters are displacements.
    pub fn interpolates(&self) -> bool {
        self.method.interpolates
    }

    /// Components of nodes that are prescribed, with their values.
    pub fn fixed(&self) -> &[FixedDof] {
        self.prepared.fixed()
    }

    /// Consistent nodal forces of all loads, N.
    pub fn force(&self) -> Result<Vec<Vector3>, Failure> {
        Ok(statics::nodal_forces(&self.prepared.volume.rows, &self.prepared.loads())?)
    }

    /// The tools, in the order of the scene.
    pub fn tools(&self) -> Vec<PosedTool> {
        let one = |placed: &crate::scenario::PlacedTool| PosedTool {
            name: placed.name.clone(),
            along: placed.tool.along(),
            closure: match placed.drive {
                Drive::Closure(closure) => Some(closure),
                Drive::Force(_) => None,
            },
        };
        self.setup.tools.iter().map(one).collect()
    }

    /// The quadrature: values, gradients and weights.
    pub fn volume(&self) -> &VolumeRows {
        &self.prepared.volume.rows
    }

    /// Values at points, and how many of these lie outside.
    pub fn at_points(&self, points: &[Point3]) -> Result<(PointRows, usize), Failure> {
        Ok(self.prepared.source.at_points(points)?)
    }

    /// Values and gradients at points.
    pub fn gradients_at(&self, points: &[Point3]) -> Result<GradRows, Failure> {
        Ok(self.prepared.source.gradients_at(points)?)
    }

    /// Load steps of the scene; 1 of a linear procedure.
    pub fn steps(&self) -> usize {
        steps(&self.setup).max(1)
    }

    fn check(&self, found: &Found) -> Result<(), Failure> {
        let wrong = |problem: String| Err(Failure::Input(problem));
        let (nodes, steps) = (self.nodes().len(), self.steps());
        match found.fields.len() {
            1 => {}
            given if given == steps => {}
            given => {
                return wrong(format!("{given} fields; give one, or one for each of {steps} load steps"));
            }
        }
        for field in &found.fields {
            if field.len() != nodes {
                return wrong(format!("the displacement of {} nodes; the problem has {nodes}", field.len()));
            }
            if let Some(node) = field.iter().position(|u| !u.iter().all(|c| c.is_finite())) {
                return wrong(format!("the displacement of node {node} is not finite"));
            }
        }
        let tools = self.setup.tools.len();
        match &found.pushed {
            Some(forces) if forces.len() != tools => {
                wrong(format!("forces of {} tools; the scene has {tools}", forces.len()))
            }
            Some(forces) if !forces.iter().all(|force| force.is_finite()) => {
                wrong("a force on a tool is not finite".into())
            }
            _ => Ok(()),
        }
    }

    /// What is left for this program to do.
    fn plan(&self, solver: &str) -> Plan {
        let mut plan = self.plan.clone();
        for stage in
            [StageName::Stiffness, StageName::Factorisation, StageName::Newton, StageName::Relaxation]
        {
            plan.skip(stage, &format!("{solver} solves it"));
        }
        plan
    }

    /// Puts the tools into the steps: where they stand, and the forces that our contact law has there, with friction from step to
    /// step; or at the end those that are given. A tool that is driven by force stands nowhere known.
    fn touch(&self, solution: &mut Solution, pushed: Option<Vec<f64>>) -> Result<(), Failure> {
        let (Some(history), Some(contact)) = (&mut solution.history, self.prepared.contact()) else {
            return Ok(());
        };
        let points = contact.rows().points().len();
        let mut tools: Vec<ContactHistory> =
            self.setup.tools.iter().map(|placed| ContactHistory::new(&placed.tool, points)).collect();
        for (step, u) in history.steps.iter_mut().zip(&history.fields) {
            for (placed, memory) in self.setup.tools.iter().zip(&mut tools) {
                let tool = match placed.drive {
                    Drive::Closure(closure) => {
                        let closure = closure * step.load;
                        let evaluated =
                            contact.tractions(&placed.tool, closure, u, memory, &mut Default::default());
                        let contacts =
                            evaluated.map_err(|bad| Failure::Run(format!("{}: {bad}", placed.name)))?;
                        memory.commit_all(contacts.as_ref(), &contact, &placed.tool, closure, u);
                        ToolStep::of(&ToolState::new(closure, contacts.as_ref()), &placed.tool)
                    }
                    Drive::Force(force) => ToolStep { pushed: force * step.load, ..ToolStep::UNTOUCHED },
                };
                step.tools.push(tool);
            }
        }
        if let (Some(end), Some(pushed)) = (history.steps.last_mut(), pushed) {
            end.tools.iter_mut().zip(pushed).for_each(|(tool, pushed)| tool.pushed = pushed);
        }
        history.last = history.steps.last().cloned().unwrap_or_else(|| history.last.clone());
        Ok(())
    }
}
