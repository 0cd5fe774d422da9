//! What a run did, counted as it did it: a stage that the plan skips must have left nothing here.

use std::ops::AddAssign;

use schemars::JsonSchema;
use serde::Serialize;

use super::StageName;

/// Counts of one pass over a run; repeats for timings do the same again and are not added up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Counters {
    /// Clouds placed anew by an error, each after a solution that is not counted below.
    pub refinements: u64,
    /// Support radii of nodes found.
    pub support_radii: u64,
    /// Shape function rows with gradients at integration points.
    pub volume_rows: u64,
    /// Groups of points that share a dilation.
    pub dilation_groups: u64,
    /// Parameters of a pressure field.
    pub pressure_parameters: u64,
    /// Integration points given the law of their own region.
    pub point_laws: u64,
    /// Rows of values alone on loaded surfaces.
    pub surface_rows: u64,
    /// Rows with gradients (or of penalty points) where a support is weak.
    pub flux_rows: u64,
    /// Constraint rows with multipliers.
    pub multiplier_rows: u64,
    /// Constraint rows to eliminate.
    pub eliminated_rows: u64,
    /// Degrees of freedom eliminated.
    pub fixed_dofs: u64,
    /// Surface points at which tools may touch.
    pub contact_points: u64,
    /// Of these, points that keep a history of friction, once for each tool.
    pub friction_points: u64,
    /// Searches for contact, one for each tool and state.
    pub contact_evaluations: u64,
    /// Of these, skipped whole: no point near the tool.
    pub contact_skips: u64,
    /// Nodes given a mass.
    pub mass_nodes: u64,
    /// Time steps made.
    pub time_steps: u64,
    /// Steps of dynamic relaxation made.
    pub relaxation_steps: u64,
    /// Linear systems of Newton's method on the way to converged steps.
    pub newton_iterations: u64,
    /// Stiffness matrices assembled; in a static procedure those of failed steps too.
    pub assemblies: u64,
    /// Matrices factored; in a static procedure those of failed steps too.
    pub factorisations: u64,
    /// Right-hand sides solved for.
    pub solves: u64,
    /// Iterations of the linear solver: with a factor kept from another tangent, in single precision, or with sliding friction.
    pub inner_iterations: u64,
    /// Shape function rows that turn nodal parameters into displacements at nodes or targets.
    pub transfer_rows: u64,
    /// Tables of transfer schemes built.
    pub transfer_tables: u64,
}

impl Counters {
    /// What a stage left.
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
            StageName::Newton => self.newton_iterations,
            StageName::Relaxation => self.relaxation_steps,
            StageName::Contact => self.contact_evaluations,
            StageName::Friction => self.friction_points,
            StageName::Transfer => self.transfer_rows,
            StageName::Schemes => self.transfer_tables,
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
        self.newton_iterations += other.newton_iterations;
        self.assemblies += other.assemblies;
        self.factorisations += other.factorisations;
        self.solves += other.solves;
        self.inner_iterations += other.inner_iterations;
        self.transfer_rows += other.transfer_rows;
        self.transfer_tables += other.transfer_tables;
    }
}
