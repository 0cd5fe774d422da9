//! Keys of procedures: each kind has its own.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::procedure::OnStall;
use crate::scene::units::{Length, Q, Rate, Time};

/// How the scene is solved; kind = "linear" unless given
#[derive(Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum ProcedureKeys {
    /// Shape functions and integration rows only: what a method costs before anything is solved
    Prepare {
        /// Read and not used, so that one word changes the kind
        steps: Option<u32>,
    },
    /// One linear solve
    Linear {
        /// Read and not used, so that one word changes the kind
        steps: Option<u32>,
    },
    /// Small free vibrations: the lowest modes and every frequency
    Modes {
        /// Lowest modes of vibration that are reported and compared; 24 unless given
        modes: Option<u32>,
        /// Read and not used, so that one word changes the kind
        steps: Option<u32>,
    },
    /// Quasi-static load steps, each by Newton's method; large-strain laws and tools
    Static(StaticKeys),
    /// Explicit dynamics: central differences
    Explicit(ExplicitKeys),
    /// Implicit dynamics: generalised-alpha
    ImplicitDynamic(ImplicitKeys),
}

#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) struct StaticKeys {
    /// Load steps at whose ends results are reported; 1 unless given
    pub steps: Option<u32>,
    #[serde(flatten)]
    pub newton: NewtonKeys,
    /// Part of the load to within which a limit point is located, if the path loses its stability: steps are halved
    /// down to it. Unless given, a limit point is reported at the end of the load step that passes it
    pub limit_within: Option<f64>,
    /// What follows if no equilibrium is found
    pub on_stall: Option<OnStall>,
}

/// How a step is solved by Newton's method
#[derive(Deserialize, JsonSchema)]
pub(crate) struct NewtonKeys {
    /// Relative residual of a step by Newton's method; 1e-8 unless given
    pub tolerance: Option<f64>,
    /// Most iterations of Newton's method in a step; 25 unless given
    pub iterations: Option<u32>,
    /// Uzawa iterations of contact in a step; 0 (a plain penalty) unless given
    pub augmentations: Option<u32>,
}

/// The time axis of dynamics
#[derive(Deserialize, JsonSchema)]
pub(crate) struct RampKeys {
    /// Equal intervals of time at whose ends results are reported; 1 unless given
    pub steps: Option<u32>,
    /// End of the time axis
    pub duration: Q<Time>,
    /// Time over which loads and supports grow before they are constant; the duration unless given, "0 s" is at once
    pub over: Option<Q<Time>>,
    /// Mass-proportional damping, in explicit dynamics also of tools that have a mass; none unless given
    pub damping: Option<Q<Rate>>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) struct ExplicitKeys {
    #[serde(flatten)]
    pub ramp: RampKeys,
    /// Time step over the critical one; 0.9 unless given
    pub safety: Option<f64>,
    /// Time step; safety times the critical one unless given
    pub step: Option<Q<Time>>,
    /// Mass of a tool driven by a force over that of the body; 0.1 unless given
    pub tool_mass: Option<f64>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) struct ImplicitKeys {
    #[serde(flatten)]
    pub ramp: RampKeys,
    #[serde(flatten)]
    pub newton: NewtonKeys,
    /// Whether mass acts; true unless given, false for a quasi-static motion of tissue that relaxes
    pub inertia: Option<bool>,
    /// Spectral radius at infinite frequency, 0 to 1; 0.8 unless given, and 0 with tools
    pub spectral_radius: Option<f64>,
    /// Local error of a displacement that a time step may make; unlimited unless given
    pub accuracy: Option<Q<Length>>,
}
