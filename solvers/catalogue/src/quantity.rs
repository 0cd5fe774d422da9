//! Quantities with units as text (`"20 kPa"`, `"0.5 /m"`), read into SI.

use crate::names::nearest;
use crate::problem::Problem;

/// Exponents of metre, kilogram, second, radian and byte.
pub type Exponents = [i8; 5];

/// Number in SI base units with its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Value in SI base units (angles in radians).
    pub value: f64,
    /// Exponents of metre, kilogram, second, radian and byte.
    pub exponents: Exponents,
}

impl Quantity {
    /// Reads a number followed by a unit: factors joined by `*`, `/` or a space, each with an integer power.
    ///
    /// # Errors
    ///
    /// The text does not begin with a finite number, or a unit is not known.
    pub fn read(text: &str) -> Result<Quantity, Problem> {
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

/// Splits a text into its longest leading number and the rest.
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

/// Named unit: name, power of ten, further factor, exponents. The power of ten is kept apart so that "35 mm"
/// is read as the double nearest to 0.035.
type Named = (&'static str, i32, f64, Exponents);

/// Units that take the prefixes G, M, k, h, c, m, u and n.
const PREFIXED: [Named; 8] = [
    ("m", 0, 1.0, [1, 0, 0, 0, 0]),
    ("g", -3, 1.0, [0, 1, 0, 0, 0]),
    ("s", 0, 1.0, [0, 0, 1, 0, 0]),
    ("N", 0, 1.0, [1, 1, -2, 0, 0]),
    ("Pa", 0, 1.0, [-1, 1, -2, 0, 0]),
    ("J", 0, 1.0, [2, 1, -2, 0, 0]),
    ("rad", 0, 1.0, [0, 0, 0, 1, 0]),
    ("Hz", 0, 1.0, [0, 0, -1, 0, 0]),
];

/// Units that take no prefix.
const PLAIN: [Named; 17] = [
    ("1", 0, 1.0, [0, 0, 0, 0, 0]),
    ("%", -2, 1.0, [0, 0, 0, 0, 0]),
    ("t", 3, 1.0, [0, 1, 0, 0, 0]),
    ("min", 0, 60.0, [0, 0, 1, 0, 0]),
    ("h", 0, 3600.0, [0, 0, 1, 0, 0]),
    ("deg", 0, std::f64::consts::PI / 180.0, [0, 0, 0, 1, 0]),
    ("\u{b0}", 0, std::f64::consts::PI / 180.0, [0, 0, 0, 1, 0]),
    ("bar", 5, 1.0, [-1, 1, -2, 0, 0]),
    ("mmHg", 0, 133.322_387_415, [-1, 1, -2, 0, 0]),
    ("B", 0, 1.0, [0, 0, 0, 0, 1]),
    ("kB", 3, 1.0, [0, 0, 0, 0, 1]),
    ("MB", 6, 1.0, [0, 0, 0, 0, 1]),
    ("GB", 9, 1.0, [0, 0, 0, 0, 1]),
    ("TB", 12, 1.0, [0, 0, 0, 0, 1]),
    ("KiB", 0, 1024.0, [0, 0, 0, 0, 1]),
    ("MiB", 0, 1048576.0, [0, 0, 0, 0, 1]),
    ("GiB", 0, 1073741824.0, [0, 0, 0, 0, 1]),
];

/// Named unit without prefix, such as `Pa` or `min`, for lists of the known units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitWord {
    /// Name of the unit, without prefix.
    pub name: &'static str,
    /// Whether the unit takes the prefixes G, M, k, h, c, m, u and n.
    pub prefixed: bool,
    /// Size of the unit in SI base units.
    pub si: f64,
    /// Exponents of metre, kilogram, second, radian and byte.
    pub exponents: Exponents,
}

/// Iterates over all named units that a quantity may contain.
pub fn units() -> impl Iterator<Item = UnitWord> {
    let word = |prefixed: bool| {
        move |&(name, ten, factor, exponents): &Named| UnitWord {
            name,
            prefixed,
            si: factor * 10f64.powi(ten),
            exponents,
        }
    };
    PREFIXED.iter().map(word(true)).chain(PLAIN.iter().map(word(false)))
}

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

/// Returns power of ten, further factor and dimension of a unit, or the unknown word as the error.
fn read_unit(text: &str) -> Result<(i32, f64, Exponents), String> {
    let mut ten = 0;
    let mut factor = 1.0;
    let mut exponents: Exponents = [0; 5];
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

/// Splits `mm^2` or `mm\u{b2}` into name and power. Powers beyond 6 are taken as typing errors.
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

/// Returns `number` times ten to the power `ten`, correctly rounded.
fn scaled(number: &str, ten: i32) -> Option<f64> {
    let (mantissa, exponent) = match number.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (number, 0),
    };
    format!("{mantissa}e{}", exponent.checked_add(ten)?).parse().ok()
}
