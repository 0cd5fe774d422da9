//! Quantities as keys of a file, with the dimension as a type.

use std::borrow::Cow;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, de::Error as _};

use catalogue::Dimension;

/// A dimension as a type, for the keys of a file.
pub(crate) trait Dim {
    const DIMENSION: Dimension;
}

macro_rules! dims {
    ($($name:ident),*) => {$(
        #[derive(JsonSchema)]
        pub(crate) struct $name;
        impl Dim for $name {
            const DIMENSION: Dimension = Dimension::$name;
        }
    )*};
}
dims!(Length, Pressure, Density, Force, Time, BodyForce, ContactSlope, SurfaceDamping, Rate, Bytes, Angle);

/// A part of a whole, such as "0.5 %".
#[derive(JsonSchema)]
pub(crate) struct Part;

impl Dim for Part {
    const DIMENSION: Dimension = Dimension::None;
}

/// A quantity of dimension `D`: text in the file, SI value in the program.
pub(crate) struct Q<D>(pub f64, PhantomData<D>);

impl<'de, D: Dim> Deserialize<'de> for Q<D> {
    fn deserialize<S: Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        let text = String::deserialize(deserializer)?;
        D::DIMENSION
            .read(&text)
            .map(|value| Q(value, PhantomData))
            .map_err(|bad| S::Error::custom(bad.problem))
    }
}

impl<D: Dim> JsonSchema for Q<D> {
    fn schema_name() -> Cow<'static, str> {
        D::DIMENSION.name().into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let units = D::DIMENSION.offered();
        json_schema!({
            "type": "string",
            "x-quantity": D::DIMENSION.name(),
            "examples": [format!("1 {}", units.first().unwrap_or(&""))],
        })
    }
}

/// Unit of a field, such as the `Pa` in `{ unit = "Pa", of = "z^2" }`: the conversion factor to SI.
pub(crate) struct Unit<D>(pub f64, PhantomData<D>);

impl<'de, D: Dim> Deserialize<'de> for Unit<D> {
    fn deserialize<S: Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        let text = String::deserialize(deserializer)?;
        let read = D::DIMENSION.read_unit(&text);
        read.map(|factor| Unit(factor, PhantomData)).map_err(|bad| S::Error::custom(bad.problem))
    }
}

impl<D: Dim> JsonSchema for Unit<D> {
    fn schema_name() -> Cow<'static, str> {
        format!("unit of {}", D::DIMENSION.name()).into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "x-unit": D::DIMENSION.name(), "examples": [D::DIMENSION.si_unit()] })
    }
}
