//! Keys of supports, loads and tools.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

use super::Names;
use crate::scene::expression::Expression;
use crate::scene::region::Region;
use crate::scene::units::{BodyForce, ContactSlope, Dim, Force, Length, Pressure, Q, Time, Unit};
use crate::scene::vocabulary::{Given, ToolShapes, Word, tagged};
use crate::scene::words::words;

words! {
    /// A field that is given by its name.
    pub(crate) enum ExactWord {
        /// The values of the exact solution that `[reference]` names.
        Exact = "exact",
    }
}

/// A quantity, or an expression in x, y and z (metres) with the unit of its value
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
#[serde(bound = "")]
pub(crate) enum FieldKeys<D: Dim> {
    Constant(Q<D>),
    Expression(FieldOf<D>),
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "")]
pub(crate) struct FieldOf<D: Dim> {
    pub unit: Unit<D>,
    pub of: Expression,
}

/// Three components, "exact", or three expressions with one unit
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
#[serde(bound = "")]
pub(crate) enum VectorKeys<D: Dim> {
    Exact(ExactWord),
    Components([FieldKeys<D>; 3]),
    Expressions(VectorOf<D>),
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "")]
pub(crate) struct VectorOf<D: Dim> {
    pub unit: Unit<D>,
    pub of: [Expression; 3],
}

/// Prescribed displacement along one axis
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum AxisKeys {
    Exact(ExactWord),
    Field(FieldKeys<Length>),
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct AxesKeys {
    pub x: Option<AxisKeys>,
    pub y: Option<AxisKeys>,
    pub z: Option<AxisKeys>,
}

/// Prescribed displacement: some axes, all three as [x, y, z], or "exact"
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum MoveKeys {
    Exact(ExactWord),
    All([AxisKeys; 3]),
    Axes(AxesKeys),
}

/// Prescribed displacement of a region
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SupportKeys {
    /// Names given by the shape or the mesh file
    pub on: Option<Names>,
    /// Comparisons joined by 'and'
    #[serde(rename = "where")]
    pub place: Option<Region>,
    /// Axes fixed at zero, such as "xyz"
    pub fix: Option<String>,
    #[serde(rename = "move")]
    pub motion: Option<MoveKeys>,
}

/// A load: exactly one of traction, pressure (along the inner normal) and body force
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LoadKeys {
    pub on: Option<Names>,
    #[serde(rename = "where")]
    pub place: Option<Region>,
    /// Force per area: for one along the inner normal take pressure = "1 kPa"
    pub traction: Option<VectorKeys<Pressure>>,
    /// Force per area along the inner normal
    pub pressure: Option<FieldKeys<Pressure>>,
    /// Force per volume, everywhere
    pub body: Option<VectorKeys<BodyForce>>,
}

/// A rigid tool
#[derive(Deserialize)]
pub(crate) struct ToolKeys {
    pub shape: Word<ToolShapes>,
    #[serde(flatten)]
    pub beside: BesideShape,
    #[serde(flatten)]
    pub settings: Given<ToolShapes>,
}

/// Keys that every tool has, whatever its shape
#[derive(Deserialize, JsonSchema)]
pub(crate) struct BesideShape {
    pub name: String,
    pub at: [Q<Length>; 3],
    /// Direction of motion
    pub along: [f64; 3],
    pub drive: DriveKeys,
    /// Normal pressure per penetration
    pub penalty: Q<ContactSlope>,
    /// Coulomb coefficient
    pub friction: Option<f64>,
    /// Tangential traction per elastic slip, with friction
    pub stick: Option<Q<ContactSlope>>,
}

impl JsonSchema for ToolKeys {
    fn schema_name() -> Cow<'static, str> {
        "tool".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        tagged::<ToolShapes, BesideShape>("shape", "A rigid tool", generator)
    }
}

/// Drive of a tool: one of closure, force along its direction of motion, and mean pressure on its face
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-one-of" = ["closure", "force", "pressure"]))]
pub(crate) struct DriveKeys {
    pub closure: Option<Q<Length>>,
    pub force: Option<Q<Force>>,
    pub pressure: Option<Q<Pressure>>,
    /// Time of the ramp (dynamics)
    pub over: Option<Q<Time>>,
}
