//! Parameters of entries: meaning, accepted values and defaults.

use crate::dimension::Dimension;
use crate::problem::Problem;

/// Parameter of an entry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name in files.
    pub name: &'static str,
    /// Dimension of the value, which is in the SI unit of that dimension.
    pub dimension: Dimension,
    /// Kind of value.
    pub kind: Kind,
    /// Default of a number or a flag (1 for true); `None` without a default.
    pub default: Option<f64>,
    /// Whether a value must be given.
    pub required: bool,
    /// Range of accepted values. It applies to each number of a list or vector.
    pub range: Range,
    /// Meaning, in a few words.
    pub meaning: &'static str,
}

/// Kind of value of a parameter: a number, a whole number, a vector, a list or a flag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Number,
    /// A whole number.
    Count,
    /// Three numbers.
    Vector,
    /// Any number of numbers.
    List,
    /// True or false.
    Flag,
}

/// Range of accepted values. All values must be finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Any number.
    Any,
    /// Above zero.
    Positive,
    /// Zero or more.
    NotNegative,
    /// The given number or more.
    AtLeast(f64),
    /// From the first number to the second, ends included.
    Within(f64, f64),
    /// Above the first number and below the second.
    Between(f64, f64),
}

/// Value of one parameter, in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// Several numbers.
    List(Vec<f64>),
    /// True or false.
    Flag(bool),
}

impl Parameter {
    /// Makes a parameter for a number that must be given.
    pub const fn required(name: &'static str, dimension: Dimension, meaning: &'static str) -> Parameter {
        let (kind, range) = (Kind::Number, Range::Any);
        Parameter { name, dimension, kind, default: None, required: true, range, meaning }
    }

    /// Makes a parameter for a number with a default, in the SI unit of its dimension.
    pub const fn default(
        name: &'static str,
        dimension: Dimension,
        default: f64,
        meaning: &'static str,
    ) -> Parameter {
        let parameter = Parameter::required(name, dimension, meaning);
        Parameter { default: Some(default), required: false, ..parameter }
    }

    /// Makes a parameter for a number that may be absent and has no default.
    pub const fn optional(name: &'static str, dimension: Dimension, meaning: &'static str) -> Parameter {
        Parameter { required: false, ..Parameter::required(name, dimension, meaning) }
    }

    /// Returns the parameter as optional, for a value that can be given by one of several parameters.
    pub const fn may_be_absent(self) -> Parameter {
        Parameter { required: false, ..self }
    }

    /// Returns the parameter with values of another kind: a vector, a list, a whole number or a flag.
    pub const fn of(self, kind: Kind) -> Parameter {
        Parameter { kind, ..self }
    }

    /// Returns the parameter with a range.
    pub const fn within(self, range: Range) -> Parameter {
        Parameter { range, ..self }
    }

    /// Checks the kind and the range of a value.
    ///
    /// # Errors
    ///
    /// The value is of another kind, not finite or out of range.
    pub fn check(&self, value: &Value) -> Result<(), Problem> {
        let numbers = match (self.kind, value) {
            (Kind::Number | Kind::Count, Value::Number(number)) => std::slice::from_ref(number),
            (Kind::List, Value::List(list)) => list,
            (Kind::Vector, Value::List(list)) if list.len() == 3 => list,
            (Kind::Flag, Value::Flag(_)) => &[],
            _ => return Err(Problem::new(format!("is not {}", self.kind.text()))),
        };
        for &number in numbers {
            if self.kind == Kind::Count && number.fract() != 0.0 {
                return Err(Problem::new("is not a whole number").found(number));
            }
            self.range.check(number).map_err(|bad| self.explained(bad, number))?;
        }
        Ok(())
    }

    /// Adds the parameter's meaning to a range error, and for a list the number at fault.
    fn explained(&self, bad: Problem, number: f64) -> Problem {
        let help = match (&bad.help, self.meaning) {
            (Some(help), meaning) if !meaning.is_empty() => Some(format!("{help}: {meaning}")),
            (help, _) => help.clone(),
        };
        let found = match self.kind {
            Kind::List | Kind::Vector => Some(number.to_string()),
            Kind::Number | Kind::Count | Kind::Flag => bad.found.clone(),
        };
        Problem { help, found, ..bad }
    }
}

impl Kind {
    fn text(self) -> &'static str {
        match self {
            Kind::Number => "a number",
            Kind::Count => "a whole number",
            Kind::Vector => "a list of 3",
            Kind::List => "a list",
            Kind::Flag => "true or false",
        }
    }
}

impl Range {
    /// Checks that a number is finite and in range.
    ///
    /// # Errors
    ///
    /// The number is not finite or out of range.
    pub fn check(self, value: f64) -> Result<(), Problem> {
        let (holds, problem) = match self {
            Range::Any => (true, ""),
            Range::Positive => (value > 0.0, "is not positive"),
            Range::NotNegative => (value >= 0.0, "is negative"),
            Range::AtLeast(low) if low == 1.0 && value == 0.0 => (false, "is zero"),
            Range::AtLeast(low) => (value >= low, "is too small"),
            Range::Within(low, high) => ((low..=high).contains(&value), "is out of range"),
            Range::Between(low, high) => (value > low && value < high, "is out of range"),
        };
        match holds && value.is_finite() {
            true => Ok(()),
            false if value.is_finite() => Err(Problem::new(problem).help(format!("give {}", self.text()))),
            false => Err(Problem::new("is not a finite number").found(value)),
        }
    }

    /// Returns the range in words, such as `a value above zero`.
    pub fn text(self) -> String {
        match self {
            Range::Any => "any number".into(),
            Range::Positive => "a value above zero".into(),
            Range::NotNegative => "zero or more".into(),
            Range::AtLeast(low) => format!("{} or more", short(low)),
            Range::Within(low, high) => format!("{} to {}", short(low), short(high)),
            Range::Between(low, high) => format!("a value above {} and below {}", short(low), short(high)),
        }
    }
}

/// Formats a number for messages, such as `0.05` or, below 1e-3 in magnitude, `2e-4`.
pub fn short(number: f64) -> String {
    if number != 0.0 && number.abs() < 1e-3 { format!("{number:e}") } else { number.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_another_kind_or_out_of_range_are_refused() {
        let width = Parameter::required("alpha", Dimension::None, "").within(Range::Within(0.05, 10.0));
        let power = Parameter::required("power", Dimension::None, "").of(Kind::Count);
        let half =
            Parameter::required("half", Dimension::Length, "").of(Kind::Vector).within(Range::Positive);
        assert_eq!(width.check(&Value::Number(0.05)), Ok(()));
        assert_eq!(
            width.check(&Value::Number(0.01)).unwrap_err().to_string(),
            "is out of range; give 0.05 to 10"
        );
        assert!(width.check(&Value::Number(f64::NAN)).is_err());
        assert!(width.check(&Value::Flag(true)).is_err());
        assert!(power.check(&Value::Number(1.5)).is_err());
        assert_eq!(half.check(&Value::List(vec![1.0; 3])), Ok(()));
        assert!(half.check(&Value::List(vec![1.0; 2])).is_err());
        assert!(half.check(&Value::List(vec![1.0, 0.0, 1.0])).is_err());
    }
}
