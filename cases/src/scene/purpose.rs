//! What a scene is for: reports judge it by this, never by its name.

use schemars::JsonSchema;
use serde::Deserialize;

/// What a scene is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Purpose {
    /// A test of exactness: the solution lies in the space of every method, so that run times, locking and orders mean nothing.
    Patch,
    /// A smooth solution: errors fall with the order that theory promises.
    #[default]
    Smooth,
    /// A solution that is not smooth (a jump of the load, a wave front, a corner): theory promises no order.
    Rough,
    /// A reading of the published case that `published` names: its results are compared with the published ones. No order is promised.
    Published,
}

/// Published comparisons whose numbers the report holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum Publication {
    /// Saghaei Nooshabadi et al., Scientia Iranica B 23(1) (2016) 295-300: a kidney in a grasper, elements and clouds.
    #[serde(rename = "saghaei-2016")]
    Saghaei2016,
}

impl Publication {
    /// All, in the order they are listed.
    pub const ALL: [Publication; 1] = [Publication::Saghaei2016];

    /// The name in files and records.
    pub fn name(self) -> &'static str {
        match self {
            Publication::Saghaei2016 => "saghaei-2016",
        }
    }
}
