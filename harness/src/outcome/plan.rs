//! The plan of a run: its stages in order, whether each of them runs, and why. The run consults
//! [`Plan::runs`] before it refines a cloud, fills tables of projections, regions, supports and contact,
//! relaxes, transfers, or compares schemes. A solver therefore never sees tables that the plan skips. The
//! operations on the tables (factors, iterations) follow from the procedure. A test compares them with the
//! counters.

use schemars::JsonSchema;
use serde::Serialize;

/// Declares the stages and their names.
macro_rules! stages {
    ($($(#[$meaning:meta])* $stage:ident = $name:literal,)*) => {
        /// Stage of a run.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
        pub enum StageName {
            $($(#[$meaning])* #[serde(rename = $name)] $stage,)*
        }

        impl StageName {
            /// Name in JSON and in records.
            pub fn name(self) -> &'static str {
                match self {
                    $(StageName::$stage => $name,)*
                }
            }
        }
    };
}

impl StageName {
    /// Name in printed plans. It distinguishes the supports of a cloud's nodes from the supports of the body.
    pub fn label(self) -> &'static str {
        match self {
            StageName::Supports => "neighbour search",
            other => other.name(),
        }
    }
}

stages! {
    /// Refinement of clouds by an error estimate of the solution.
    Refinement = "refinement",
    /// Support radii and neighbours of a cloud's nodes.
    Supports = "supports",
    /// Shape functions with gradients at the integration points.
    ShapeFunctions = "shape functions",
    /// Groups of points with a common dilation, or a pressure field.
    Projection = "volumetric projection",
    /// Material law of each integration point.
    Tensors = "elasticity tensor per region",
    /// Mass matrix.
    Mass = "mass",
    /// Stiffness matrices.
    Stiffness = "stiffness",
    /// Time steps of dynamics.
    TimeSteps = "time steps",
    /// Essential conditions by elimination.
    Elimination = "supports by elimination",
    /// Essential conditions by penalty, Nitsche's method or multipliers.
    WeakSupports = "weak supports",
    /// Factorisation of a matrix.
    Factorisation = "factorisation",
    /// Runs of the full method from which a reduced model is learnt.
    Training = "training",
    /// Iterations of Newton's method.
    Newton = "Newton iterations",
    /// Dynamic relaxation beyond a limit point.
    Relaxation = "dynamic relaxation",
    /// Search for contact.
    Contact = "contact search",
    /// Slip of each point on each tool.
    Friction = "friction history",
    /// Evaluation of displacements from the nodal parameters.
    Transfer = "transfer",
    /// Comparison of transfer schemes.
    Schemes = "transfer schemes",
    /// Prediction with more shape functions, from which errors are estimated.
    Estimate = "error estimate",
    /// Error of a number, traced to the cells that cause it.
    Trace = "error trace",
    /// Strict bounds of the strain energy.
    Bounds = "strict bounds",
}

/// Stage of a plan with its decision.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Stage {
    /// Name of the stage.
    pub stage: StageName,
    /// Whether the stage runs.
    pub ran: bool,
    /// Reason why the stage runs or is skipped.
    pub why: String,
}

/// Stages of a run in order, each at most once.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct Plan {
    stages: Vec<Stage>,
    /// Whether the tangents of nonlinear statics are iterated.
    #[serde(skip)]
    pub(crate) iterates: bool,
}

impl Plan {
    /// Adds a stage.
    pub(crate) fn add(&mut self, stage: StageName, ran: bool, why: impl Into<String>) {
        debug_assert!(self.get(stage).is_none(), "{stage:?} twice");
        self.stages.push(Stage { stage, ran, why: why.into() });
    }

    /// All stages, in order.
    pub fn stages(&self) -> &[Stage] {
        &self.stages
    }

    /// Whether a stage is in the plan and runs.
    pub fn runs(&self, stage: StageName) -> bool {
        self.get(stage).is_some_and(|stage| stage.ran)
    }

    fn get(&self, stage: StageName) -> Option<&Stage> {
        self.stages.iter().find(|known| known.stage == stage)
    }

    /// Marks a stage as skipped.
    pub(crate) fn skip(&mut self, stage: StageName, why: &str) {
        for known in self.stages.iter_mut().filter(|known| known.stage == stage) {
            (known.ran, known.why) = (false, why.into());
        }
    }

    /// Replaces the reason of a stage.
    pub(crate) fn explain(&mut self, stage: StageName, why: impl Fn(&str) -> String) {
        for known in self.stages.iter_mut().filter(|known| known.stage == stage) {
            known.why = why(&known.why);
        }
    }
}
