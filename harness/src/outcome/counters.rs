//! Counters of a run's operations. A stage that the plan skips must leave its counters at zero.

use std::ops::AddAssign;

use schemars::JsonSchema;
use serde::Serialize;

use super::plan::StageName;

/// Counters of one pass over a run. Repeats for timings perform the same operations and are not added.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Counters {
    /// Refined clouds; the solutions that precede them are not counted below.
    pub refinements: u64,
    /// Computed support radii of nodes.
    pub support_radii: u64,
    /// Rows of shape functions with gradients at integration points.
    pub volume_rows: u64,
    /// Groups of points with a common dilation.
    pub dilation_groups: u64,
    /// Parameters of a pressure field.
    pub pressure_parameters: u64,
    /// Integration points with the material law of their own region.
    pub point_laws: u64,
    /// Rows of shape function values, without gradients, on loaded surfaces.
    pub surface_rows: u64,
    /// Boundary-gradient rows, or rows of penalty points, on weakly imposed supports.
    pub flux_rows: u64,
    /// Constraint rows imposed by Lagrange multipliers.
    pub multiplier_rows: u64,
    /// Constraint rows imposed by elimination.
    pub eliminated_rows: u64,
    /// Degrees of freedom eliminated.
    pub fixed_dofs: u64,
    /// Surface points at which tools may touch.
    pub contact_points: u64,
    /// Contact points with a friction history, once for each tool.
    pub friction_points: u64,
    /// Contact searches, one for each tool and state.
    pub contact_evaluations: u64,
    /// Contact searches that were skipped because no point is near the tool.
    pub contact_skips: u64,
    /// Nodes with a mass.
    pub mass_nodes: u64,
    /// Time steps.
    pub time_steps: u64,
    /// Steps of dynamic relaxation.
    pub relaxation_steps: u64,
    /// States of training runs from which a reduced model was learnt.
    pub training_states: u64,
    /// Linear systems that Newton's method solved in converged steps.
    pub newton_iterations: u64,
    /// Assembled stiffness matrices; in a static procedure, those of failed steps included.
    pub assemblies: u64,
    /// Factored matrices; in a static procedure, those of failed steps included.
    pub factorisations: u64,
    /// Solved right-hand sides.
    pub solves: u64,
    /// Iterations of the linear solver, which iterates with a factor of an earlier tangent, in single
    /// precision, or with sliding friction.
    pub inner_iterations: u64,
    /// Shape function rows that convert nodal parameters to displacements at nodes or targets.
    pub transfer_rows: u64,
    /// Tables built for transfer schemes.
    pub transfer_tables: u64,
    /// Degrees of freedom of the prediction from which errors are estimated.
    pub predicted_dofs: u64,
    /// Degrees of freedom of the richer method in which the error of a number is traced.
    pub traced_dofs: u64,
    /// Degrees of freedom of the displacement field and of the stress field between which the exact strain
    /// energy lies.
    pub bounding_dofs: u64,
}

impl Counters {
    /// Counter of a stage.
    pub fn of(&self, stage: StageName) -> u64 {
        match stage {
            StageName::Refinement => self.refinements,
            StageName::Supports => self.support_radii,
            StageName::ShapeFunctions => self.volume_rows,
            StageName::Projection => self.dilation_groups + self.pressure_parameters,
            StageName::Tensors => self.point_laws,
            StageName::Mass => self.mass_nodes,
            StageName::Stiffness => self.assemblies,
            StageName::TimeSteps => self.time_steps,
            StageName::Elimination => self.fixed_dofs + self.eliminated_rows,
            StageName::WeakSupports => self.flux_rows + self.multiplier_rows,
            StageName::Factorisation => self.factorisations,
            StageName::Training => self.training_states,
            StageName::Newton => self.newton_iterations,
            StageName::Relaxation => self.relaxation_steps,
            StageName::Contact => self.contact_evaluations,
            StageName::Friction => self.friction_points,
            StageName::Transfer => self.transfer_rows,
            StageName::Schemes => self.transfer_tables,
            StageName::Estimate => self.predicted_dofs,
            StageName::Trace => self.traced_dofs,
            StageName::Bounds => self.bounding_dofs,
        }
    }
}

impl AddAssign for Counters {
    fn add_assign(&mut self, other: Counters) {
        self.refinements += other.refinements;
        self.support_radii += other.support_radii;
        self.volume_rows += other.volume_rows;
        self.dilation_groups += other.dilation_groups;
        self.pressure_parameters += other.pressure_parameters;
        self.point_laws += other.point_laws;
        self.surface_rows += other.surface_rows;
        self.flux_rows += other.flux_rows;
        self.multiplier_rows += other.multiplier_rows;
        self.eliminated_rows += other.eliminated_rows;
        self.fixed_dofs += other.fixed_dofs;
        self.contact_points += other.contact_points;
        self.friction_points += other.friction_points;
        self.contact_evaluations += other.contact_evaluations;
        self.contact_skips += other.contact_skips;
        self.mass_nodes += other.mass_nodes;
        self.time_steps += other.time_steps;
        self.relaxation_steps += other.relaxation_steps;
        self.training_states += other.training_states;
        self.newton_iterations += other.newton_iterations;
        self.assemblies += other.assemblies;
        self.factorisations += other.factorisations;
        self.solves += other.solves;
        self.inner_iterations += other.inner_iterations;
        self.transfer_rows += other.transfer_rows;
        self.transfer_tables += other.transfer_tables;
        self.predicted_dofs += other.predicted_dofs;
        self.traced_dofs += other.traced_dofs;
        self.bounding_dofs += other.bounding_dofs;
    }
}
