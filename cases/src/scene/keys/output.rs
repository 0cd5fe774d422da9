//! Keys of output, reference and checks.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Names, SizeKeys};
use crate::scene::region::Region;
use crate::scene::units::{Length, Q, Time, Unit};
use crate::scene::vocabulary::{Given, Schemes, Solutions, Word};
use crate::scene::words::words;

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct OutputKeys {
    /// Points at which results are reported
    pub probes: Option<Vec<[Q<Length>; 3]>>,
    /// Faces whose area mean of the displacement is reported: [{ on = "z-max" }, { where = "z == 20 mm and x
    /// >= 3 mm" }]
    pub means: Option<Vec<MeanKeys>>,
    pub transfer: Option<TransfersKeys>,
    /// Secondary reference: a method of this scene that every run is also compared with at the targets. For a
    /// published method whose own error is part of a published difference
    pub beside: Option<String>,
    /// Repetition of the loading after the first solution, as in a simulator, with each frame timed
    pub repeated: Option<RepeatedKeys>,
}

/// A part of the surface
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct MeanKeys {
    /// Names given by the shape or the mesh file
    pub on: Option<Names>,
    /// Comparisons joined by 'and'
    #[serde(rename = "where")]
    pub place: Option<Region>,
}

/// A simulator's loop: prepared once, the loading goes up and down frame by frame
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RepeatedKeys {
    /// Total number of frames; percentiles above 99 need 1000
    pub frames: u32,
    /// Frames of one cycle up and down; 120 unless given, 4 s at 30 Hz
    pub cycle: Option<u32>,
    /// Time after which no further frame starts; 10 s unless given
    pub within: Option<Q<Time>>,
    /// Relative residual of a frame solved by Newton's method; the procedure's tolerance unless given
    pub tolerance: Option<f64>,
}

/// One transfer or several
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum TransfersKeys {
    One(TransferKeys),
    Several(Vec<TransferKeys>),
}

/// A transfer of nodal displacements to other points
#[derive(Deserialize, JsonSchema)]
pub(crate) struct TransferKeys {
    pub to: TargetKeys,
    pub scheme: SchemeKeys,
    #[serde(flatten)]
    pub settings: Given<Schemes>,
}

/// A transfer scheme, or "own": the method's own shape functions
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum SchemeKeys {
    Scheme(Word<Schemes>),
    Own(OwnWord),
}

words! {
    /// A transfer without a scheme.
    pub(crate) enum OwnWord {
        /// The method's own shape functions.
        Own = "own",
    }
}

/// "reference-nodes", "probes", or the nodes of a mesh file
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum TargetKeys {
    Name(TargetName),
    File(MeshFileKeys),
}

words! {
    /// Target points of a transfer.
    pub(crate) enum TargetName {
        /// The nodes of the reference method.
        ReferenceNodes = "reference-nodes",
        /// The probes of the output.
        Probes = "probes",
    }
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct MeshFileKeys {
    pub file: String,
    pub unit: Option<Unit<Length>>,
}

/// Reference that results are compared with; further keys are parameters of the exact solution
#[derive(Deserialize, JsonSchema)]
// The known parameters depend on the solution. Its reader names them if a key is mistyped.
#[schemars(extend("additionalProperties" = {}))]
pub(crate) struct ReferenceKeys {
    /// An exact solution by name
    pub exact: Option<Word<Solutions>>,
    /// A stored record
    pub record: Option<String>,
    /// A method of this scene, run at another size if `size` is given
    pub method: Option<String>,
    pub size: Option<SizeKeys>,
    #[serde(flatten)]
    pub settings: Given<Solutions>,
}

/// A bare number, or a quantity in quotes
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum NumberKeys {
    Number(f64),
    Quantity(String),
}

/// A bound on a result
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CheckKeys {
    pub metric: String,
    /// Methods that the check applies to; all unless given
    pub method: Option<Names>,
    pub at_most: Option<NumberKeys>,
    pub at_least: Option<NumberKeys>,
    /// Low and high end of a known defect, reported as not passing
    pub known_band: Option<[NumberKeys; 2]>,
    pub reason: Option<String>,
}
