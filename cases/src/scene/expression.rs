//! Expressions in x, y and z (metres), such as `20 * (1 - z^2 / 0.01)`.
//!
//! The usual rules: `^` binds before a sign, a sign before `*` and `/`, these before `+` and `-`. Powers
//! associate from the right, all other operators from the left. The reader is our own, in 200 lines, for two
//! reasons. The crate tried first (exmex 0.21) takes `sqrt(x^2 + y^2 + 3)` for `x^2 + sqrt(y^2 + 3)`, `-x^2`
//! for `(-x)^2` and doesn't know `1e-3`. And a message must point at the location of an error.

use std::borrow::Cow;
use std::iter::Peekable;
use std::str::CharIndices;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, de::Error as _};

use catalogue::suggest;

use catalogue::Problem;

/// An expression in the coordinates, compiled to postfix order.
#[derive(Clone, Debug)]
pub struct Expression {
    text: String,
    program: Vec<Op>,
}

/// Expressions with the same text have the same values.
impl PartialEq for Expression {
    fn eq(&self, other: &Expression) -> bool {
        self.text == other.text
    }
}

/// An error: an expression without a finite value at a point.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("expression '{expression}' is {value} at ({}, {}, {}) m", at[0], at[1], at[2])]
pub struct NotFinite {
    /// The text in the file.
    pub expression: String,
    /// NaN or an infinity.
    pub value: f64,
    /// The point, in metres.
    pub at: [f64; 3],
}

#[derive(Clone, Copy, Debug)]
enum Op {
    Number(f64),
    Coordinate(usize),
    One(OfOne),
    Two(OfTwo),
}

const COORDINATES: [&str; 3] = ["x", "y", "z"];
const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];
type OfOne = fn(f64) -> f64;
type OfTwo = fn(f64, f64) -> f64;

const ONE: [(&str, OfOne); 19] = [
    ("abs", f64::abs),
    ("sign", f64::signum),
    ("sqrt", f64::sqrt),
    ("cbrt", f64::cbrt),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("log10", f64::log10),
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("asin", f64::asin),
    ("acos", f64::acos),
    ("atan", f64::atan),
    ("sinh", f64::sinh),
    ("cosh", f64::cosh),
    ("tanh", f64::tanh),
    ("floor", f64::floor),
    ("ceil", f64::ceil),
    ("round", f64::round),
];
const TWO: [(&str, OfTwo); 4] =
    [("min", f64::min), ("max", f64::max), ("atan2", f64::atan2), ("hypot", f64::hypot)];

/// Deepest nesting allowed. The limit bounds the recursion of the reader and the stack of the evaluation. Up
/// to four values per level are on the stack: the left operands of a sum, a product and a power, and the
/// first argument of a function.
const MAX_DEPTH: usize = 40;
const STACK: usize = 4 * (MAX_DEPTH + 1);

impl Expression {
    /// Value at `x` (metres), in the unit given next to the expression.
    pub fn value(&self, x: [f64; 3]) -> Result<f64, NotFinite> {
        if let [Op::Number(value)] = self.program[..]
            && value.is_finite()
        {
            return Ok(value);
        }
        let mut stack = [0.0; STACK];
        let mut top = 0;
        for op in &self.program {
            match op {
                Op::Number(value) => stack[top] = *value,
                Op::Coordinate(axis) => stack[top] = x[*axis],
                Op::One(f) => {
                    top -= 1;
                    stack[top] = f(stack[top]);
                }
                Op::Two(f) => {
                    top -= 2;
                    stack[top] = f(stack[top], stack[top + 1]);
                }
            }
            top += 1;
        }
        let value = stack[0];
        if value.is_finite() {
            return Ok(value);
        }
        Err(NotFinite { expression: self.text.clone(), value, at: x })
    }

    /// The text in the file.
    pub fn text(&self) -> &str {
        &self.text
    }

    pub(crate) fn read(text: &str) -> Result<Expression, Problem> {
        if text.trim().is_empty() {
            let help = "write one in x, y and z, such as \"z^2\"";
            return Err(Problem::new("is an empty expression").found(text).help(help));
        }
        let mut reader =
            Reader { text, chars: text.char_indices().peekable(), program: Vec::new(), depth: 0 };
        reader.sum()?;
        match reader.next() {
            None => {}
            Some((at, ')')) => return Err(reader.bad(at, "a ')' closes nothing")),
            Some((at, ',')) => return Err(reader.bad(at, "a ',' is out of place")),
            Some((at, c)) if c.is_ascii_alphanumeric() || "._(".contains(c) => {
                let problem = reader.bad(at, &format!("an operator is missing before '{c}'"));
                return Err(problem.help("write a product as '2*x'"));
            }
            Some((at, c)) => return Err(reader.bad(at, &format!("'{c}' has no meaning"))),
        }
        let expression = Expression { text: text.to_string(), program: reader.program };
        let constant = !expression.program.iter().any(|op| matches!(op, Op::Coordinate(_)));
        if constant && expression.value([0.0; 3]).is_err() {
            return Err(Problem::new("is not finite").found(text));
        }
        Ok(expression)
    }
}

/// Reads an expression from left to right and writes its program.
struct Reader<'t> {
    text: &'t str,
    chars: Peekable<CharIndices<'t>>,
    program: Vec<Op>,
    depth: usize,
}

impl<'t> Reader<'t> {
    fn bad(&self, at: usize, problem: &str) -> Problem {
        let column = self.text[..at].chars().count() + 1;
        Problem::new(format!("can't be read: {problem} at character {column}")).found(self.text)
    }

    /// The next character that is not a space; it is not consumed.
    fn next(&mut self) -> Option<(usize, char)> {
        while self.chars.next_if(|(_, c)| c.is_whitespace()).is_some() {}
        self.chars.peek().copied()
    }

    /// Takes the next character if it is one of `wanted`.
    fn take(&mut self, wanted: &str) -> Option<char> {
        let (_, c) = self.next()?;
        wanted.contains(c).then(|| {
            self.chars.next();
            c
        })
    }

    fn place(&mut self) -> usize {
        self.next().map_or(self.text.len(), |(at, _)| at)
    }

    fn sum(&mut self) -> Result<(), Problem> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let at = self.place();
            return Err(self.bad(at, &format!("it is nested deeper than {MAX_DEPTH}")));
        }
        self.product()?;
        while let Some(sign) = self.take("+-") {
            self.product()?;
            self.program.push(Op::Two(if sign == '+' { |a, b| a + b } else { |a, b| a - b }));
        }
        self.depth -= 1;
        Ok(())
    }

    fn product(&mut self) -> Result<(), Problem> {
        self.signed()?;
        while let Some(sign) = self.take("*/") {
            self.signed()?;
            self.program.push(Op::Two(if sign == '*' { |a, b| a * b } else { |a, b| a / b }));
        }
        Ok(())
    }

    fn signed(&mut self) -> Result<(), Problem> {
        let mut negative = false;
        while let Some(sign) = self.take("+-") {
            negative ^= sign == '-';
        }
        self.power()?;
        if negative {
            self.program.push(Op::One(|a| -a));
        }
        Ok(())
    }

    /// Reads a power. A power of a power counts as nesting: `x^y^z` is read as `x^(y^z)`.
    fn power(&mut self) -> Result<(), Problem> {
        self.atom()?;
        if self.take("^").is_some() {
            self.depth += 1;
            if self.depth > MAX_DEPTH {
                let at = self.place();
                return Err(self.bad(at, &format!("it is nested deeper than {MAX_DEPTH}")));
            }
            self.signed()?;
            self.depth -= 1;
            // The most common power in fields, without exponential and logarithm.
            if let Some(Op::Number(2.0)) = self.program.last() {
                self.program.pop();
                self.program.push(Op::One(|a| a * a));
            } else {
                self.program.push(Op::Two(f64::powf));
            }
        }
        Ok(())
    }

    fn atom(&mut self) -> Result<(), Problem> {
        let Some((at, c)) = self.next() else {
            return Err(self.bad(self.text.len(), "an operand is missing"));
        };
        match c {
            '(' => {
                self.chars.next();
                self.sum()?;
                self.close()
            }
            '0'..='9' | '.' => self.number(at),
            c if c.is_ascii_alphabetic() => self.name(at),
            '*' | '/' | '^' | ',' | ')' => {
                Err(self.bad(at, &format!("a number, a coordinate or '(' is missing before '{c}'")))
            }
            _ => Err(self.bad(at, &format!("'{c}' has no meaning"))),
        }
    }

    fn close(&mut self) -> Result<(), Problem> {
        let at = self.place();
        match self.next() {
            Some((_, ')')) => {
                self.chars.next();
                Ok(())
            }
            Some((_, ',')) => Err(self.bad(at, "a ',' is out of place")),
            Some((_, c)) => Err(self.bad(at, &format!("an operator or ')' is missing before '{c}'"))),
            None => Err(self.bad(at, "a ')' is missing")),
        }
    }

    fn number(&mut self, at: usize) -> Result<(), Problem> {
        let digits = |c: char| c.is_ascii_digit() || c == '.';
        let mut end = at + self.text[at..].find(|c| !digits(c)).unwrap_or(self.text.len() - at);
        if let Some(exponent) = self.text[end..].strip_prefix(['e', 'E']) {
            let unsigned = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
            let count = unsigned.find(|c: char| !c.is_ascii_digit()).unwrap_or(unsigned.len());
            if count > 0 {
                end += 1 + (exponent.len() - unsigned.len()) + count;
            }
        }
        let number = &self.text[at..end];
        while self.chars.next_if(|(i, _)| *i < end).is_some() {}
        let value = number.parse::<f64>().ok().filter(|v| v.is_finite());
        let value = value.ok_or_else(|| self.bad(at, &format!("'{number}' is not a number")))?;
        self.program.push(Op::Number(value));
        Ok(())
    }

    fn name(&mut self, at: usize) -> Result<(), Problem> {
        let rest = &self.text[at..];
        let word = &rest[..rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len())];
        while self.chars.next_if(|(i, _)| *i < at + word.len()).is_some() {}
        if let Some(axis) = COORDINATES.iter().position(|c| *c == word) {
            self.program.push(Op::Coordinate(axis));
        } else if let Some((_, value)) = CONSTANTS.iter().find(|c| c.0 == word) {
            self.program.push(Op::Number(*value));
        } else if let Some((_, f)) = ONE.iter().find(|f| f.0 == word) {
            self.open(word)?;
            self.sum()?;
            self.close()?;
            self.program.push(Op::One(*f));
        } else if let Some((_, f)) = TWO.iter().find(|f| f.0 == word) {
            self.open(word)?;
            self.sum()?;
            if self.take(",").is_none() {
                let at = self.place();
                let problem = self.bad(at, "an argument is missing");
                return Err(problem.help(format!("{word} takes two: {word}(x, y)")));
            }
            self.sum()?;
            self.close()?;
            self.program.push(Op::Two(*f));
        } else {
            let names = COORDINATES.iter().copied().chain(CONSTANTS.iter().map(|c| c.0));
            let names: Vec<&str> =
                names.chain(ONE.iter().map(|f| f.0)).chain(TWO.iter().map(|f| f.0)).collect();
            return Err(self.bad(at, &format!("'{word}' is not known")).help(suggest(word, &names)));
        }
        Ok(())
    }

    fn open(&mut self, word: &str) -> Result<(), Problem> {
        if self.take("(").is_some() {
            return Ok(());
        }
        let at = self.place();
        Err(self.bad(at, &format!("{word} needs its argument in parentheses")))
    }
}

impl<'de> Deserialize<'de> for Expression {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Expression, D::Error> {
        Expression::read(&String::deserialize(deserializer)?).map_err(|bad| D::Error::custom(bad.problem))
    }
}

impl JsonSchema for Expression {
    fn schema_name() -> Cow<'static, str> {
        "expression".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": "string",
            "x-expression": true,
            "description": "expression in the coordinates x, y and z in metres",
            "examples": ["z^2"],
        })
    }
}
