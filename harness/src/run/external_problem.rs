//! A method's problem for an external solver: its tables, the loads on its nodes, and the comparison of the
//! solver's displacement with the same errors as any other run.

use cases::scene::Procedure;
use contact::{ContactHistory, Drive, ToolState};
use geometry::{Mesh, Point3, Vector3};
use records::Family;
use shape::{FixedDof, GradRows, PointRows, VolumeRows};

use super::group::Group;
use super::{loaded, phases, size};
use crate::discretise::Discretisation;
use crate::error::Failure;
use crate::measure::{self, Request, check_probes};
use crate::outcome::timing::Meters;
use crate::outcome::{Counters, Identity, Outcome, Plan, StageName, ToolStep};
use crate::prepare::{Prepared, prepare};
use crate::procedure::external::{steps, taken};
use crate::procedure::{Problem, Solution};
use crate::scenario::Scenario;
use crate::scenario::setup::Setup;

/// A method's problem with all tables, not solved.
pub struct Posed {
    identity: Identity,
    method: Discretisation,
    setup: Setup,
    prepared: Prepared,
    plan: Plan,
}

/// Solution of an external solver.
#[derive(Clone, Debug)]
pub struct Found {
    /// Name of the solver.
    pub solver: String,
    /// Nodal parameters (m), which are displacements on a mesh. Either one field for the end of each of the
    /// equal load steps, or one field for the end.
    pub fields: Vec<Vec<Vector3>>,
    /// Force of each tool along its direction of travel at the end, N. `None` if the solver gives no forces:
    /// the scene's contact law then determines them.
    pub pushed: Option<Vec<f64>>,
    /// Solution time if known, s.
    pub seconds: Option<f64>,
}

/// Tool of a posed problem.
#[derive(Clone, Debug, PartialEq)]
pub struct PosedTool {
    /// Name of the tool.
    pub name: String,
    /// Unit direction of travel.
    pub along: Vector3,
    /// Travel at the end (m); `None` if the tool is force-controlled.
    pub closure: Option<f64>,
}

impl Group<'_> {
    /// Fills the tables of a method without solving it.
    ///
    /// # Errors
    /// Returns an error if the procedure is neither linear nor static (others do not end at rest), if the
    /// method refines its cloud, if a tool turns, and for every reason that a run is refused for.
    pub fn pose(&self, scenario: &Scenario) -> Result<Posed, Failure> {
        let (method, setup) = (scenario.discretise()?, scenario.setup()?);
        let (plan, _) = self.plan(scenario)?;
        let refused = |problem: &str| Err(scenario.locate(Failure::Run(problem.into())));
        if !matches!(setup.procedure, Procedure::Linear { .. } | Procedure::Static(_)) {
            return refused("can't be passed to another solver: give kind = \"linear\" or \"static\"");
        }
        if scenario.following().is_some() {
            return refused(
                "has a load on the deformed surface, which can't be passed to another solver: add dead = true",
            );
        }
        if setup.tools.iter().any(|placed| placed.tool.turns()) {
            return refused(
                "has a tool that turns, which can't be passed to another solver: give closure or force",
            );
        }
        if plan.runs(StageName::Refinement) {
            return refused("refines its cloud with its own solutions: take a method without refine");
        }
        check_probes(method.mesh(), self.probes())?;
        let prepared = prepare(&method, &setup, &plan, &mut Counters::default());
        let prepared = prepared.map_err(|failure| scenario.locate(failure))?;
        Ok(Posed { identity: scenario.identity(), method, setup, prepared, plan })
    }

    /// Compares the solution of an external solver with the references; the errors are those of any other
    /// run.
    ///
    /// # Errors
    /// Returns an error for fields with a wrong number of nodes or with numbers that are not finite, for a
    /// number of fields that is neither one nor the number of load steps, and for a wrong number of tool
    /// forces.
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
            // The projection of the dilation belongs to this program's own elements.
            dilation: None,
            ..posed.identity.clone()
        };
        let mut outcome = Outcome::new(identity, size(method, prepared, solution.dofs), plan);
        let Meters { timings, counters, .. } = &mut meters;
        loaded(&mut outcome, &run, &request, timings, counters)?;
        outcome.phases = phases(&meters, &run);
        outcome.counters = meters.counters;
        self.hold_against(&mut outcome);
        Ok(outcome)
    }
}

impl Posed {
    /// Positions of the nodes, m.
    pub fn nodes(&self) -> &[Point3] {
        self.method.nodes()
    }

    /// Mesh of the elements, or background mesh of a cloud.
    pub fn mesh(&self) -> &Mesh {
        self.method.mesh()
    }

    /// Whether nodal parameters are displacements.
    pub fn interpolates(&self) -> bool {
        self.method.interpolates
    }

    /// Prescribed displacement components of nodes, with their values (m).
    pub fn fixed(&self) -> &[FixedDof] {
        self.prepared.fixed()
    }

    /// Consistent nodal forces of all loads, N, one per node.
    ///
    /// # Errors
    /// Returns an error if the value of a load is not finite.
    pub fn force(&self) -> Result<Vec<Vector3>, Failure> {
        Ok(statics::nodal_forces(&self.prepared.volume.rows, &self.prepared.loads())?)
    }

    /// Tools in the order of the scene.
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

    /// Quadrature points of the body: shape function values and gradients, and weights.
    pub fn volume(&self) -> &VolumeRows {
        &self.prepared.volume.rows
    }

    /// Shape function values at points (m), and the number of points outside the mesh, which take the values
    /// of the nearest point.
    ///
    /// # Errors
    /// Returns an error if a point has no shape functions.
    pub fn at_points(&self, points: &[Point3]) -> Result<(PointRows, usize), Failure> {
        Ok(self.prepared.source.at_points(points)?)
    }

    /// Shape function values and gradients at points (m).
    ///
    /// # Errors
    /// Returns an error if a point has no shape functions.
    pub fn gradients_at(&self, points: &[Point3]) -> Result<GradRows, Failure> {
        Ok(self.prepared.source.gradients_at(points)?)
    }

    /// Number of load steps of the scene; 1 for a linear procedure.
    pub fn steps(&self) -> usize {
        steps(&self.setup).max(1)
    }

    fn check(&self, found: &Found) -> Result<(), Failure> {
        let wrong = |problem: String| Err(Failure::Input(problem));
        let nodes = self.nodes().len();
        let steps = self.steps();
        match found.fields.len() {
            1 => {}
            given if given == steps => {}
            given => {
                return wrong(format!(
                    "{given} displacement fields; give one field, or one for each of {steps} load steps"
                ));
            }
        }
        for field in &found.fields {
            if field.len() != nodes {
                return wrong(format!("the displacement has {} nodes; the problem has {nodes}", field.len()));
            }
            if let Some(node) = field.iter().position(|u| !u.iter().all(|c| c.is_finite())) {
                return wrong(format!("the displacement of node {node} is not finite"));
            }
        }
        let tools = self.setup.tools.len();
        match &found.pushed {
            Some(forces) if forces.len() != tools => {
                wrong(format!("{} tool forces given; the scene has {tools}", forces.len()))
            }
            Some(forces) if !forces.iter().all(|force| force.is_finite()) => {
                wrong("a force on a tool is not finite".into())
            }
            _ => Ok(()),
        }
    }

    /// Plan without the stages that the external solver performs.
    fn plan(&self, solver: &str) -> Plan {
        let mut plan = self.plan.clone();
        for stage in
            [StageName::Stiffness, StageName::Factorisation, StageName::Newton, StageName::Relaxation]
        {
            plan.skip(stage, &format!("solved by {solver}"));
        }
        plan
    }

    /// Adds the tools to the load steps: their travel, and the forces by the scene's contact law, with the
    /// friction history carried from step to step. Forces that are given replace those of the last step. The
    /// travel of a force-controlled tool is unknown.
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
