//! Quantities with units as text (`"20 kPa"`, `"0.5 /m"`), read into SI with their dimension checked.

use std::borrow::Cow;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, de::Error as _};

use super::error::{Problem, nearest};

/// Exponents of metre, kilogram, second and radian.
pub type Exponents = [i8; 4];

/// A number in SI together with its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Value in SI base units (angles in radians).
    pub value: f64,
    /// Exponents of metre, kilogram, second and radian.
    pub exponents: Exponents,
}

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
    /// Seconds.
    Time,
    /// Newtons per cubic metre.
    BodyForce,
    /// One per metre.
    Curvature,
    /// Radians.
    Angle,
    /// Pascals per metre (a contact stiffness per area).
    Stiffness,
    /// Joules.
    Energy,
    /// A bare number.
    None,
}

impl Dimension {
    const ALL: [Dimension; 10] = [
        Dimension::Length,
        Dimension::Pressure,
        Dimension::Density,
        Dimension::Force,
        Dimension::Time,
        Dimension::BodyForce,
        Dimension::Curvature,
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
            Dimension::Time => [0, 0, 1, 0],
            Dimension::BodyForce | Dimension::Stiffness => [-2, 1, -2, 0],
            Dimension::Curvature => [-1, 0, 0, 0],
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
            Dimension::Time => "time",
            Dimension::BodyForce => "force per volume",
            Dimension::Curvature => "curvature",
            Dimension::Angle => "angle",
            Dimension::Stiffness => "pressure per length",
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
            Dimension::Time => "s",
            Dimension::BodyForce => "N/m^3",
            Dimension::Curvature => "1/m",
            Dimension::Angle => "rad",
            Dimension::Stiffness => "Pa/m",
            Dimension::Energy => "J",
            Dimension::None => "1",
        }
    }

    /// Units to offer, the usual one first.
    fn offered(self) -> [&'static str; 5] {
        match self {
            Dimension::Length => ["mm", "m", "cm", "um", "km"],
            Dimension::Pressure => ["kPa", "Pa", "MPa", "GPa", "N/mm^2"],
            Dimension::Density => ["kg/m^3", "g/cm^3", "g/mm^3", "t/m^3", "t/mm^3"],
            Dimension::Force => ["N", "mN", "kN", "MN", "uN"],
            Dimension::Time => ["s", "ms", "us", "min", "h"],
            Dimension::BodyForce => ["N/m^3", "kN/m^3", "N/mm^3", "mN/mm^3", "Pa/m"],
            Dimension::Curvature => ["/m", "1/m", "/mm", "1/mm", "/cm"],
            Dimension::Angle => ["deg", "rad", "mrad", "\u{b0}", "1 rad"],
            Dimension::Stiffness => ["MPa/mm", "Pa/m", "kPa/mm", "N/mm^3", "N/m^3"],
            Dimension::Energy => ["J", "mJ", "kJ", "N m", "N mm"],
            Dimension::None => ["", "", "", "", ""],
        }
    }

    pub(crate) fn from_name(name: &str) -> Option<Dimension> {
        Dimension::ALL.into_iter().chain([Dimension::Stiffness]).find(|d| d.name() == name)
    }

    fn of(exponents: Exponents) -> Option<Dimension> {
        Dimension::ALL.into_iter().find(|d| d.exponents() == exponents)
    }

    /// `a pressure needs a unit: kPa, Pa, ...`
    fn need(self) -> String {
        let article = if self == Dimension::Angle || self == Dimension::Energy { "an" } else { "a" };
        format!("{article} {} needs a unit: {}", self.name(), self.offered()[..4].join(", "))
            + &match self {
                Dimension::Angle => String::new(),
                _ => format!(", {}", self.offered()[4]),
            }
    }

    /// What to write instead of the bare number `text`.
    pub(crate) fn fix(self, text: &str) -> String {
        let unit = self.offered()[0];
        format!("write \"{} {unit}\" ({})", text.trim(), self.need())
    }

    /// Reads a quantity of this dimension into SI.
    pub(crate) fn read(self, text: &str) -> Result<f64, Problem> {
        let quantity = match Quantity::read(text) {
            Err(bad) if bad.help.is_none() => return Err(bad.help(self.need())),
            other => other?,
        };
        if quantity.exponents == self.exponents() {
            return Ok(quantity.value);
        }
        if quantity.exponents == [0; 4] {
            return Err(Problem::new("has no unit").found(text).help(self.fix(text)));
        }
        let is = match Dimension::of(quantity.exponents) {
            Some(found) => format!("is a {}, where a {} belongs", found.name(), self.name()),
            None => format!("has the wrong dimension for a {}", self.name()),
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

impl Quantity {
    /// Reads a number followed by a unit: factors joined by `*`, `/` or a space, each with an integer power.
    pub(crate) fn read(text: &str) -> Result<Quantity, Problem> {
        let bad = |problem: &str| Problem::new(problem).found(text);
        let trimmed = text.trim();
        let (number, unit) = split_number(trimmed);
        if !number.contains(|c: char| c.is_ascii_digit()) {
            return Err(bad("doesn't begin with a finite number"));
        }
        let (ten, factor, exponents) = read_unit(unit).map_err(|word| unknown_unit(text, &word))?;
        let value = scaled(number, ten).map(|value| value * factor);
        let value = value.filter(|v| v.is_finite()).ok_or_else(|| bad("is not a finite number"))?;
        Ok(Quantity { value, exponents })
    }
}

fn unknown_unit(text: &str, word: &str) -> Problem {
    let problem = Problem::new(format!("has a unit '{word}' that is not known")).found(text);
    let names =
        PREFIXED.iter().flat_map(|(name, ..)| ["", "m", "k", "M", "G", "c"].map(|p| format!("{p}{name}")));
    let names: Vec<String> = names.chain(PLAIN.iter().skip(1).map(|u| u.0.to_string())).collect();
    let same = names.iter().find(|n| n.eq_ignore_ascii_case(word)).map(String::as_str);
    match same.or_else(|| nearest(word, names.iter().map(String::as_str))) {
        Some(near) if !word.is_empty() => problem.help(format!("did you mean '{near}'?")),
        _ => problem,
    }
}

/// The longest leading number, and the rest.
fn split_number(text: &str) -> (&str, &str) {
    let bytes = text.as_bytes();
    let digits = |mut i: usize| {
        while i < bytes.len() && bytes[i].is_ascii_digit() {
            i += 1;
        }
        i
    };
    let mut end = digits(usize::from(bytes.first().is_some_and(|b| b"+-".contains(b))));
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(bytes.get(end + 1).is_some_and(|b| b"+-".contains(b)));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    text.split_at(end)
}

/// A named unit: name, power of ten, further factor, exponents. The power of ten is kept apart so that "35 mm" is read as
/// the double nearest to 0.035.
type Named = (&'static str, i32, f64, Exponents);

/// Units that take the prefixes G, M, k, h, c, m, u and n.
const PREFIXED: [Named; 8] = [
    ("m", 0, 1.0, [1, 0, 0, 0]),
    ("g", -3, 1.0, [0, 1, 0, 0]),
    ("s", 0, 1.0, [0, 0, 1, 0]),
    ("N", 0, 1.0, [1, 1, -2, 0]),
    ("Pa", 0, 1.0, [-1, 1, -2, 0]),
    ("J", 0, 1.0, [2, 1, -2, 0]),
    ("rad", 0, 1.0, [0, 0, 0, 1]),
    ("Hz", 0, 1.0, [0, 0, -1, 0]),
];

/// Units that take no prefix.
const PLAIN: [Named; 9] = [
    ("1", 0, 1.0, [0, 0, 0, 0]),
    ("%", -2, 1.0, [0, 0, 0, 0]),
    ("t", 3, 1.0, [0, 1, 0, 0]),
    ("min", 0, 60.0, [0, 0, 1, 0]),
    ("h", 0, 3600.0, [0, 0, 1, 0]),
    ("deg", 0, std::f64::consts::PI / 180.0, [0, 0, 0, 1]),
    ("\u{b0}", 0, std::f64::consts::PI / 180.0, [0, 0, 0, 1]),
    ("bar", 5, 1.0, [-1, 1, -2, 0]),
    ("mmHg", 0, 133.322_387_415, [-1, 1, -2, 0]),
];

const PREFIXES: [(char, i32); 9] =
    [('G', 9), ('M', 6), ('k', 3), ('h', 2), ('c', -2), ('m', -3), ('u', -6), ('\u{b5}', -6), ('n', -9)];

fn named(name: &str) -> Option<(i32, f64, Exponents)> {
    if let Some(unit) = PLAIN.iter().chain(&PREFIXED).find(|unit| unit.0 == name) {
        return Some((unit.1, unit.2, unit.3));
    }
    let prefix = name.chars().next()?;
    let ten = PREFIXES.iter().find(|p| p.0 == prefix)?.1;
    let unit = PREFIXED.iter().find(|unit| unit.0 == &name[prefix.len_utf8()..])?;
    Some((ten + unit.1, unit.2, unit.3))
}

/// Power of ten, further factor and dimension of a unit; the word that isn't known otherwise.
fn read_unit(text: &str) -> Result<(i32, f64, Exponents), String> {
    let mut ten = 0;
    let mut factor = 1.0;
    let mut exponents: Exponents = [0; 4];
    let mut rest = text.trim();
    while !rest.is_empty() {
        // A factor after a division multiplies again: "N /m^2 s" is (N / m^2) s.
        let mut sign = 1;
        if let Some(after) = rest.strip_prefix('/') {
            (sign, rest) = (-1, after.trim_start());
        } else if let Some(after) = rest.strip_prefix('*') {
            rest = after.trim_start();
        }
        let end = rest.find([' ', '\t', '/', '*']).unwrap_or(rest.len());
        let (word, after) = rest.split_at(end);
        let (name, power) = split_power(word).ok_or_else(|| word.to_string())?;
        let (unit_ten, unit, dims) = named(name).ok_or_else(|| word.to_string())?;
        ten += i32::from(sign * power) * unit_ten;
        factor *= unit.powi(i32::from(sign * power));
        for (total, dim) in exponents.iter_mut().zip(dims) {
            *total = total.checked_add(sign * power * dim).ok_or_else(|| word.to_string())?;
        }
        rest = after.trim_start();
    }
    Ok((ten, factor, exponents))
}

/// `mm^2` or `mm\u{b2}` into name and power; powers beyond 6 are slips of the pen.
fn split_power(word: &str) -> Option<(&str, i8)> {
    let (name, power) = if let Some((name, power)) = word.split_once('^') {
        (name, power.parse::<i8>().ok()?)
    } else if let Some(name) = word.strip_suffix('\u{b2}') {
        (name, 2)
    } else if let Some(name) = word.strip_suffix('\u{b3}') {
        (name, 3)
    } else {
        (word, 1)
    };
    (-6..=6).contains(&power).then_some((name, power))
}

/// `number` times ten to the `ten`, correctly rounded.
fn scaled(number: &str, ten: i32) -> Option<f64> {
    let (mantissa, exponent) = match number.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (number, 0),
    };
    format!("{mantissa}e{}", exponent.checked_add(ten)?).parse().ok()
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
dims!(Length, Pressure, Density, Force, Time, BodyForce);

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
            "examples": [format!("1 {}", units[0])],
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
        json_schema!({ "type": "string", "x-unit": D::DIMENSION.name(), "examples": [D::DIMENSION.offered()[0]] })
    }
}
