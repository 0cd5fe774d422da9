//! Dimensions: the units that a key takes, and help for missing or wrong units.

use crate::problem::Problem;
use crate::quantity::{Exponents, Quantity};

/// Dimension of a value in a scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Metres.
    Length,
    /// Pascals: pressures, moduli, tractions and stresses.
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
    /// Pascals per metre: contact slopes. The units are those of a force per volume, the meaning is not.
    ContactSlope,
    /// Pascal seconds per metre: damping per area.
    SurfaceDamping,
    /// One per metre.
    Curvature,
    /// One per second.
    Rate,
    /// Radians.
    Angle,
    /// Joules.
    Energy,
    /// Newton metres. The units are those of an energy, the meaning is not.
    Moment,
    /// Kilograms.
    Mass,
    /// Cubic metres.
    Volume,
    /// Radians per second.
    AngularFrequency,
    /// Cycles per second.
    Frequency,
    /// A bare number.
    None,
    /// Bytes.
    Bytes,
}

impl Dimension {
    /// Every dimension.
    pub const ALL: &[Dimension] = &[
        Dimension::Length,
        Dimension::Pressure,
        Dimension::Density,
        Dimension::Force,
        Dimension::LineForce,
        Dimension::Time,
        Dimension::BodyForce,
        Dimension::ContactSlope,
        Dimension::SurfaceDamping,
        Dimension::Curvature,
        Dimension::Rate,
        Dimension::Angle,
        Dimension::Energy,
        Dimension::Moment,
        Dimension::Mass,
        Dimension::Volume,
        Dimension::AngularFrequency,
        Dimension::Frequency,
        Dimension::None,
        Dimension::Bytes,
    ];

    /// Exponents of metre, kilogram, second, radian and byte.
    pub fn exponents(self) -> Exponents {
        match self {
            Dimension::Length => [1, 0, 0, 0, 0],
            Dimension::Pressure => [-1, 1, -2, 0, 0],
            Dimension::Density => [-3, 1, 0, 0, 0],
            Dimension::Force => [1, 1, -2, 0, 0],
            Dimension::LineForce => [0, 1, -2, 0, 0],
            Dimension::Time => [0, 0, 1, 0, 0],
            Dimension::BodyForce | Dimension::ContactSlope => [-2, 1, -2, 0, 0],
            Dimension::SurfaceDamping => [-2, 1, -1, 0, 0],
            Dimension::Curvature => [-1, 0, 0, 0, 0],
            Dimension::Rate | Dimension::Frequency => [0, 0, -1, 0, 0],
            Dimension::Angle => [0, 0, 0, 1, 0],
            Dimension::Energy | Dimension::Moment => [2, 1, -2, 0, 0],
            Dimension::Mass => [0, 1, 0, 0, 0],
            Dimension::Volume => [3, 0, 0, 0, 0],
            Dimension::AngularFrequency => [0, 0, -1, 1, 0],
            Dimension::None => [0, 0, 0, 0, 0],
            Dimension::Bytes => [0, 0, 0, 0, 1],
        }
    }

    /// Returns the name used in messages and in the schema.
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
            Dimension::SurfaceDamping => "damping per area",
            Dimension::Curvature => "curvature",
            Dimension::Rate => "rate",
            Dimension::Angle => "angle",
            Dimension::Energy => "energy",
            Dimension::Moment => "moment",
            Dimension::Mass => "mass",
            Dimension::Volume => "volume",
            Dimension::AngularFrequency => "angular frequency",
            Dimension::Frequency => "frequency",
            Dimension::None => "number",
            Dimension::Bytes => "memory size",
        }
    }

    /// Returns the SI unit of values inside the program and in tables, such as `rad` for an angle.
    pub const fn si_unit(self) -> &'static str {
        match self {
            Dimension::Length => "m",
            Dimension::Pressure => "Pa",
            Dimension::Density => "kg/m^3",
            Dimension::Force => "N",
            Dimension::LineForce => "N/m",
            Dimension::Time => "s",
            Dimension::BodyForce => "N/m^3",
            Dimension::ContactSlope => "Pa/m",
            Dimension::SurfaceDamping => "Pa s/m",
            Dimension::Curvature => "1/m",
            Dimension::Rate => "1/s",
            Dimension::Angle => "rad",
            Dimension::Energy => "J",
            Dimension::Moment => "N m",
            Dimension::Mass => "kg",
            Dimension::Volume => "m^3",
            Dimension::AngularFrequency => "rad/s",
            Dimension::Frequency => "Hz",
            Dimension::None => "1",
            Dimension::Bytes => "B",
        }
    }

    /// Returns the units offered in messages, the usual one first.
    pub fn offered(self) -> &'static [&'static str] {
        match self {
            Dimension::Length => &["mm", "m", "cm", "um", "km"],
            Dimension::Pressure => &["kPa", "Pa", "MPa", "GPa", "N/mm^2"],
            Dimension::Density => &["kg/m^3", "g/cm^3", "t/mm^3"],
            Dimension::Force => &["N", "mN", "kN"],
            Dimension::LineForce => &["N/m", "mN/mm", "kN/m"],
            Dimension::Time => &["s", "ms", "us", "min", "h"],
            Dimension::BodyForce => &["N/m^3", "kN/m^3", "N/mm^3"],
            Dimension::ContactSlope => &["MPa/mm", "kPa/mm", "Pa/m", "N/mm^3"],
            Dimension::SurfaceDamping => &["kPa s/mm", "Pa s/m", "N s/mm^3"],
            Dimension::Curvature => &["/m", "1/m", "/mm", "/cm"],
            Dimension::Rate => &["/s", "1/s", "/ms"],
            Dimension::Angle => &["deg", "rad", "mrad"],
            Dimension::Energy => &["J", "mJ", "N mm"],
            Dimension::Moment => &["N m", "N mm"],
            Dimension::Mass => &["kg", "g", "t"],
            Dimension::Volume => &["mm^3", "m^3", "cm^3"],
            Dimension::AngularFrequency => &["rad/s", "rad/ms"],
            Dimension::Frequency => &["Hz", "kHz"],
            Dimension::Bytes => &["GB", "MB", "kB", "GiB", "MiB"],
            Dimension::None => &[],
        }
    }

    /// Whether values are bare numbers, without a unit.
    pub fn is_plain(self) -> bool {
        self.offered().is_empty()
    }

    /// Returns the dimension with that name.
    pub fn from_name(name: &str) -> Option<Dimension> {
        Dimension::ALL.iter().copied().find(|d| d.name() == name)
    }

    fn of(exponents: Exponents) -> Option<Dimension> {
        Dimension::ALL.iter().copied().find(|d| d.exponents() == exponents)
    }

    /// Returns the dimension of a quantity in `unit`, such as `kPa` ("" for a bare number). Of several
    /// dimensions with the same exponents, the first in [`Dimension::ALL`] is returned.
    pub fn of_unit(unit: &str) -> Option<Dimension> {
        Quantity::read(&format!("1 {unit}")).ok().and_then(|q| Dimension::of(q.exponents))
    }

    /// Returns the name with its article.
    fn a_name(self) -> String {
        let article = if matches!(self, Dimension::Angle | Dimension::AngularFrequency | Dimension::Energy) {
            "an"
        } else {
            "a"
        };
        format!("{article} {}", self.name())
    }

    /// Returns the help text: `a pressure needs a unit: kPa, Pa, ...`
    fn need(self) -> String {
        match self {
            Dimension::None => "a number without a unit belongs here".into(),
            _ => format!("{} needs a unit: {}", self.a_name(), self.offered().join(", ")),
        }
    }

    /// Returns the help text for a bare number `text`, with the unit that it lacks.
    pub fn fix(self, text: &str) -> String {
        let unit = self.offered().first().copied().unwrap_or_default();
        format!("write \"{} {unit}\" ({})", text.trim(), self.need())
    }

    /// Reads a quantity of this dimension and returns its value in SI.
    ///
    /// # Errors
    ///
    /// The text is no quantity, or a quantity of another dimension.
    pub fn read(self, text: &str) -> Result<f64, Problem> {
        let quantity = match Quantity::read(text) {
            Err(bad) if bad.help.is_none() => return Err(bad.help(self.need())),
            other => other?,
        };
        self.take(quantity, text)
    }

    /// Reads a quantity above zero, such as an option `--time-limit "60 s"`, into SI.
    ///
    /// # Errors
    ///
    /// The text is no quantity of this dimension, or not above zero.
    pub fn read_positive(self, text: &str) -> Result<f64, Problem> {
        let value = self.read(text)?;
        if value > 0.0 { Ok(value) } else { Err(Problem::new("has to be above zero").found(text)) }
    }

    /// Returns the SI value of a quantity that must have this dimension. `text` is the quantity as written in
    /// the file, for the error.
    ///
    /// # Errors
    ///
    /// The quantity has another dimension, or no unit.
    pub fn take(self, quantity: Quantity, text: &str) -> Result<f64, Problem> {
        if quantity.exponents == self.exponents() {
            return Ok(quantity.value);
        }
        if quantity.exponents == [0; 5] {
            return Err(Problem::new("has no unit").found(text).help(self.fix(text)));
        }
        let is = match Dimension::of(quantity.exponents) {
            Some(found) => format!("is {}, where {} belongs", found.a_name(), self.a_name()),
            None => format!("has the wrong dimension for {}", self.a_name()),
        };
        Err(Problem::new(is).found(text).help(self.need()))
    }

    /// Returns the factor to SI of a unit alone, such as the `Pa` of `{ unit = "Pa", of = "z^2" }`.
    ///
    /// # Errors
    ///
    /// The text is a quantity, an unknown unit, or a unit of another dimension.
    pub fn read_unit(self, text: &str) -> Result<f64, Problem> {
        if text.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
            && !text.trim_start().starts_with("1/")
        {
            return Err(Problem::new("is a quantity, not a unit").found(text).help(self.need()));
        }
        self.read(&format!("1 {text}")).map_err(|bad| bad.found(text))
    }
}
