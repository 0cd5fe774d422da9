//! Regions defined by comparisons: `z == 0 mm and x >= 3 mm`.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, de::Error as _};

use catalogue::Dimension;
use catalogue::Problem;

/// A relation between a coordinate and a length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// Equal within the tolerance.
    Equal,
    /// Below, by more than the tolerance.
    Less,
    /// Below or equal within the tolerance.
    LessEqual,
    /// Above, by more than the tolerance.
    Greater,
    /// Above or equal within the tolerance.
    GreaterEqual,
}

/// One comparison of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Coordinate: 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// Relation of the coordinate to the length.
    pub relation: Relation,
    /// Length to compare with, in metres.
    pub value: f64,
}

/// Set of all points that satisfy every comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// The text in the file.
    pub text: String,
    /// The comparisons, joined by `and`.
    pub comparisons: Vec<Comparison>,
}

const HELP: &str = "write comparisons of x, y or z with a length, joined by 'and', such as \
                    \"z == 0 mm and x >= 3 mm\" (==, <, <=, >, >=)";

impl Region {
    /// Whether `x` (metres) belongs to the region. Lengths within `tolerance` (metres) count as equal; a good
    /// value is [`Region::TOLERANCE`] times the diagonal of the body.
    pub fn contains(&self, x: [f64; 3], tolerance: f64) -> bool {
        self.comparisons.iter().all(|c| {
            let ahead = x[c.axis] - c.value;
            match c.relation {
                Relation::Equal => ahead.abs() <= tolerance,
                Relation::Less => ahead < -tolerance,
                Relation::LessEqual => ahead <= tolerance,
                Relation::Greater => ahead > tolerance,
                Relation::GreaterEqual => ahead >= -tolerance,
            }
        })
    }

    /// Tolerance of equality relative to the diagonal of the body: far above rounding, far below any element.
    pub const TOLERANCE: f64 = 1e-9;

    pub(crate) fn read(text: &str) -> Result<Region, Problem> {
        let mut words = text.split_whitespace();
        let (mut parts, mut part) = (Vec::new(), Vec::new());
        loop {
            match words.next() {
                Some("and" | "&&") => parts.push(std::mem::take(&mut part).join(" ")),
                Some(word) => part.push(word),
                None => break,
            }
        }
        parts.push(part.join(" "));
        let comparisons = parts.iter().map(|part| comparison(part)).collect::<Result<_, _>>()?;
        Ok(Region { text: text.to_string(), comparisons })
    }
}

fn comparison(part: &str) -> Result<Comparison, Problem> {
    let bad = |problem: &str| Problem::new(problem).found(part).help(HELP);
    if part.is_empty() {
        return Err(bad("is an empty comparison"));
    }
    let at = part.find(['=', '<', '>', '!']).ok_or_else(|| bad("has no comparison"))?;
    let (left, rest) = part.split_at(at);
    let end = rest.find(|c| !"=<>!".contains(c)).unwrap_or(rest.len());
    let (sign, right) = rest.split_at(end);
    let relation = match sign {
        "==" => Relation::Equal,
        "<" => Relation::Less,
        "<=" => Relation::LessEqual,
        ">" => Relation::Greater,
        ">=" => Relation::GreaterEqual,
        "=" => return Err(bad("has '=', where '==' compares")),
        other => return Err(bad(&format!("has a comparison '{other}' that is not known"))),
    };
    let axis = ["x", "y", "z"].iter().position(|axis| *axis == left.trim());
    let axis = axis.ok_or_else(|| bad("doesn't begin with x, y or z"))?;
    if right.contains(['=', '<', '>']) {
        return Err(bad("compares twice"));
    }
    let value = Dimension::Length.read(right.trim()).map_err(|mut problem| {
        problem.found = Some(part.to_string());
        problem
    })?;
    Ok(Comparison { axis, relation, value })
}

impl<'de> Deserialize<'de> for Region {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Region, D::Error> {
        Region::read(&String::deserialize(deserializer)?).map_err(|bad| D::Error::custom(bad.problem))
    }
}

impl JsonSchema for Region {
    fn schema_name() -> Cow<'static, str> {
        "region".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "x-region": true, "examples": ["z == 0 mm and x >= 3 mm"] })
    }
}
