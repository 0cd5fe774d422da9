//! The plan of a run: its stages in order, whether each runs, and why. The run asks [`Plan::runs`] before it refines a cloud,
//! fills tables of projections, regions, supports and contact, relaxes, transfers, or compares schemes: what is not in the
//! plan is not there for a solver to use. What a solver does with its tables (factors, iterations) follows from the procedure,
//! and is compared with the counters by a test.

use schemars::JsonSchema;
use serde::Serialize;

/// Declares the stages and their names.
macro_rules! stages {
    ($($(#[$meaning:meta])* $stage:ident = $name:literal,)*) => {
        /// A stage that a run may have.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
        pub enum StageName {
            $($(#[$meaning])* #[serde(rename = $name)] $stage,)*
        }

        impl StageName {
            /// The name in JSON and in records.
            pub fn name(self) -> &'static str {
                match self {
                    $(StageName::$stage => $name,)*
                }
            }
        }
    };
}

impl StageName {
    /// The name in plans that people read: the nodal supports of a cloud are not the supports of the body.
    pub fn label(self) -> &'static str {
        match self {
            StageName::Supports => "neighbour search",
            other => other.name(),
        }
    }
}

stages! {
    /// Clouds placed anew by an error of the solution.
    Refinement = "refinement",
    /// Support radii and neighbours of the nodes of a cloud.
    Supports = "supports",
    /// Shape functions with gradients at the integration points.
    ShapeFunctions = "shape functions",
    /// Groups of points that share a dilation, or a pressure field.
    Projection = "volumetric projection",
    /// A law for each integration point.
    Tensors = "elasticity tensor per region",
    /// A mass matrix.
    Mass = "mass",
    /// Stiffness matrices.
    Stiffness = "stiffness",
    /// Steps in time.
    TimeSteps = "time steps",
    /// Essential conditions by elimination.
    Elimination = "supports by elimination",
    /// Essential conditions by penalty, Nitsche's method or multipliers.
    WeakSupports = "weak supports",
    /// Factors of a matrix.
    Factorisation = "factorisation",
    /// Iterations of Newton's method.
    Newton = "Newton iterations",
    /// Dynamic relaxation beyond a limit point.
    Relaxation = "dynamic relaxation",
    /// Search for contact.
    Contact = "contact search",
    /// Slip of each point on each tool.
    Friction = "friction history",
    /// Displacements away from the nodal parameters.
    Transfer = "transfer",
    /// Transfer schemes to compare.
    Schemes = "transfer schemes",
}

/// One stage of a plan.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Stage {
    /// Name.
    pub stage: StageName,
    /// Whether it runs.
    pub ran: bool,
    /// Why, or why not.
    pub why: String,
}

/// Stages of a run, in order; each at most once.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct Plan {
    stages: Vec<Stage>,
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

    /// Takes a stage out of what runs.
    pub(crate) fn skip(&mut self, stage: StageName, why: &str) {
        for known in self.stages.iter_mut().filter(|known| known.stage == stage) {
            (known.ran, known.why) = (false, why.into());
        }
    }

    /// Gives a stage another reason.
    pub(crate) fn explain(&mut self, stage: StageName, why: impl Fn(&str) -> String) {
        for known in self.stages.iter_mut().filter(|known| known.stage == stage) {
            known.why = why(&known.why);
        }
    }
}
