//! Dimensions: which units a key takes, and what to write where they are missing or wrong.

use std::borrow::Cow;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, de::Error as _};

use super::error::Problem;
use super::quantity::{Exponents, Quantity};

/// The dimensions that scene files name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Metres.
    Length,
    /// Pascals; moduli, tractions and stresses too.
    Pressure,
    /// Kilograms per cubic metre.
    Density,
    /// Newtons.
    Force,
    /// Newtons per metre.
    LineForce,
    /// Seconds.
    Time,
    /// Newtons per cubic metre.
    BodyForce,
    /// Pascals per metre: slopes of contact. The same units as a force per volume, another meaning.
    ContactSlope,
    /// One per metre.
    Curvature,
    /// One per second.
    Rate,
    /// Radians.
    Angle,
    /// Joules.
    Energy,
    /// A bare number.
    None,
}

impl Dimension {
    const ALL: [Dimension; 13] = [
        Dimension::Length,
        Dimension::Pressure,
        Dimension::Density,
        Dimension::Force,
        Dimension::LineForce,
        Dimension::Time,
        Dimension::BodyForce,
        Dimension::ContactSlope,
        Dimension::Curvature,
        Dimension::Rate,
        Dimension::Angle,
        Dimension::Energy,
        Dimension::None,
    ];

    /// Exponents of metre, kilogram, second and radian.
    pub fn exponents(self) -> Exponents {
        match self {
            Dimension::Length => [1, 0, 0, 0],
            Dimension::Pressure => [-1, 1, -2, 0],
            Dimension::Density => [-3, 1, 0, 0],
            Dimension::Force => [1, 1, -2, 0],
            Dimension::LineForce => [0, 1, -2, 0],
            Dimension::Time => [0, 0, 1, 0],
            Dimension::BodyForce | Dimension::ContactSlope => [-2, 1, -2, 0],
            Dimension::Curvature => [-1, 0, 0, 0],
            Dimension::Rate => [0, 0, -1, 0],
            Dimension::Angle => [0, 0, 0, 1],
            Dimension::Energy => [2, 1, -2, 0],
            Dimension::None => [0, 0, 0, 0],
        }
    }

    /// The name in messages and in the schema.
    pub fn name(self) -> &'static str {
        match self {
            Dimension::Length => "length",
            Dimension::Pressure => "pressure",
            Dimension::Density => "density",
            Dimension::Force => "force",
            Dimension::LineForce => "force per length",
            Dimension::Time => "time",
            Dimension::BodyForce => "force per volume",
            Dimension::ContactSlope => "pressure per length",
            Dimension::Curvature => "curvature",
            Dimension::Rate => "rate",
            Dimension::Angle => "angle",
            Dimension::Energy => "energy",
            Dimension::None => "number",
        }
    }

    /// Unit of the value inside the program, as tables print it.
    pub fn si_unit(self) -> &'static str {
        match self {
            Dimension::Length => "m",
            Dimension::Pressure => "Pa",
            Dimension::Density => "kg/m^3",
            Dimension::Force => "N",
            Dimension::LineForce => "N/m",
            Dimension::Time => "s",
            Dimension::BodyForce => "N/m^3",
            Dimension::ContactSlope => "Pa/m",
            Dimension::Curvature => "1/m",
            Dimension::Rate => "1/s",
            Dimension::Angle => "rad",
            Dimension::Energy => "J",
            Dimension::None => "1",
        }
    }

    /// Units to offer, the usual one first.
    fn offered(self) -> &'static [&'static str] {
        match self {
            Dimension::Length => &["mm", "m", "cm", "um", "km"],
            Dimension::Pressure => &["kPa", "Pa", "MPa", "GPa", "N/mm^2"],
            Dimension::Density => &["kg/m^3", "g/cm^3", "t/mm^3"],
            Dimension::Force => &["N", "mN", "kN"],
            Dimension::LineForce => &["N/m", "mN/mm", "kN/m"],
            Dimension::Time => &["s", "ms", "us", "min", "h"],
            Dimension::BodyForce => &["N/m^3", "kN/m^3", "N/mm^3"],
            Dimension::ContactSlope => &["MPa/mm", "kPa/mm", "Pa/m", "N/mm^3"],
            Dimension::Curvature => &["/m", "1/m", "/mm", "/cm"],
            Dimension::Rate => &["/s", "1/s", "/ms"],
            Dimension::Angle => &["deg", "rad", "mrad"],
            Dimension::Energy => &["J", "mJ", "N mm"],
            Dimension::None => &[],
        }
    }

    pub(crate) fn from_name(name: &str) -> Option<Dimension> {
        Dimension::ALL.into_iter().find(|d| d.name() == name)
    }

    fn of(exponents: Exponents) -> Option<Dimension> {
        Dimension::ALL.into_iter().find(|d| d.exponents() == exponents)
    }

    /// The dimension of a quantity, such as that of one in the SI unit `unit` ("" for a bare number).
    pub(crate) fn of_unit(unit: &str) -> Option<Dimension> {
        Quantity::read(&format!("1 {unit}")).ok().and_then(|q| Dimension::of(q.exponents))
    }

    /// The name with its article.
    fn a_name(self) -> String {
        let article = if matches!(self, Dimension::Angle | Dimension::Energy) { "an" } else { "a" };
        format!("{article} {}", self.name())
    }

    /// `a pressure needs a unit: kPa, Pa, ...`
    fn need(self) -> String {
        match self {
            Dimension::None => "a number without a unit belongs here".into(),
            _ => format!("{} needs a unit: {}", self.a_name(), self.offered().join(", ")),
        }
    }

    /// What to write instead of the bare number `text`.
    pub(crate) fn fix(self, text: &str) -> String {
        let unit = self.offered().first().copied().unwrap_or_default();
        format!("write \"{} {unit}\" ({})", text.trim(), self.need())
    }

    /// Reads a quantity of this dimension into SI.
    pub(crate) fn read(self, text: &str) -> Result<f64, Problem> {
        let quantity = match Quantity::read(text) {
            Err(bad) if bad.help.is_none() => return Err(bad.help(self.need())),
            other => other?,
        };
        self.take(quantity, text)
    }

    /// The value of a quantity that must have this dimension; `text` is how the file has it.
    pub(crate) fn take(self, quantity: Quantity, text: &str) -> Result<f64, Problem> {
        if quantity.exponents == self.exponents() {
            return Ok(quantity.value);
        }
        if quantity.exponents == [0; 4] {
            return Err(Problem::new("has no unit").found(text).help(self.fix(text)));
        }
        let is = match Dimension::of(quantity.exponents) {
            Some(found) => format!("is {}, where {} belongs", found.a_name(), self.a_name()),
            None => format!("has the wrong dimension for {}", self.a_name()),
        };
        Err(Problem::new(is).found(text).help(self.need()))
    }

    /// Factor to SI of a unit alone, such as the `Pa` of `{ unit = "Pa", of = "z^2" }`.
    pub(crate) fn read_unit(self, text: &str) -> Result<f64, Problem> {
        if text.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
            && !text.trim_start().starts_with("1/")
        {
            return Err(Problem::new("is a quantity, not a unit").found(text).help(self.need()));
        }
        self.read(&format!("1 {text}")).map_err(|bad| bad.found(text))
    }
}

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
dims!(Length, Pressure, Density, Force, Time, BodyForce, ContactSlope, Rate);

/// A quantity of dimension `D` in a file: text outside, SI inside.
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

/// The unit of a field, such as the `Pa` of `{ unit = "Pa", of = "z^2" }`: the factor to SI.
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
