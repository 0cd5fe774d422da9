//! Expressions in x, y and z (metres).
//!
//! The text is checked token by token first, for two reasons: messages that point at the place, and three readings of the
//! evaluator (exmex) that would be silently wrong here: `1e-3` is not a number to it, `-x^2` is `(-x)^2`, and `x^y^z` is
//! `(x^y)^z`. The first two are rewritten, the third is refused.

use std::borrow::Cow;
use std::sync::Arc;

use exmex::{Express, FlatEx};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, de::Error as _};

use super::error::{Problem, suggest};

/// An expression in the coordinates, compiled.
#[derive(Clone, Debug)]
pub struct Expression {
    text: String,
    /// Shared: a compiled expression takes 20 kB.
    compiled: Arc<FlatEx<f64>>,
    /// Which of x, y, z it uses, in this order.
    uses: Vec<usize>,
}

/// An expression that has no finite value somewhere.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("expression '{expression}' is {value} at ({}, {}, {}) m", at[0], at[1], at[2])]
pub struct NotFinite {
    /// The text in the file.
    pub expression: String,
    /// NaN or an infinity.
    pub value: f64,
    /// Where, in metres.
    pub at: [f64; 3],
}

const FUNCTIONS: [&str; 25] = [
    "abs", "signum", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh", "acosh",
    "atanh", "floor", "round", "ceil", "exp", "sqrt", "cbrt", "ln", "log2", "log10", "min", "max",
];
const CONSTANTS: [(&str, &str); 3] = [("pi", "PI"), ("PI", "PI"), ("e", "E")];
const COORDINATES: [&str; 3] = ["x", "y", "z"];
/// Deeper or longer expressions are no fields; the limit keeps recursion in the evaluator shallow.
const MAX_CHARS: usize = 2000;
const MAX_DEPTH: usize = 40;

impl Expression {
    /// Value at `x` (metres), in the unit that stands beside the expression.
    pub fn value(&self, x: [f64; 3]) -> Result<f64, NotFinite> {
        let mut used = [0.0; 3];
        for (slot, axis) in used.iter_mut().zip(&self.uses) {
            *slot = x[*axis];
        }
        let value = self.compiled.eval(&used[..self.uses.len()]).unwrap_or(f64::NAN);
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
        let rewritten = rewrite(text)?;
        let compiled = FlatEx::<f64>::parse(&rewritten)
            .map_err(|bad| Problem::new(format!("can't be read as an expression: {bad}")).found(text))?;
        let uses = compiled.var_names().iter();
        let uses = uses.filter_map(|name| COORDINATES.iter().position(|c| c == name)).collect();
        let expression = Expression { text: text.to_string(), compiled: Arc::new(compiled), uses };
        if expression.uses.is_empty() && expression.value([0.0; 3]).is_err() {
            return Err(Problem::new("is not finite").found(text));
        }
        Ok(expression)
    }
}

/// What must come next.
#[derive(Clone, Copy, PartialEq)]
enum Next {
    /// A number, name, `(` or sign.
    Operand,
    /// An operator, `,` or `)`.
    Operator,
    /// The `(` of a function.
    Open,
}

/// An open parenthesis: arguments still expected (commas), and whether the last operand in it is an exponent.
struct Level {
    commas: usize,
    after_power: bool,
}

/// Checks `text` token by token and writes it as the evaluator reads it.
fn rewrite(text: &str) -> Result<String, Problem> {
    let at = |i: usize, problem: String| {
        let column = text[..i].chars().count() + 1;
        Problem::new(format!("{problem} at character {column} of the expression")).found(text)
    };
    let names = || COORDINATES.iter().chain(&FUNCTIONS).copied().chain(["pi", "e"]).collect::<Vec<_>>();
    if text.trim().is_empty() {
        return Err(Problem::new("is an empty expression")
            .found(text)
            .help("write one in x, y and z, such as \"z^2\""));
    }
    if text.chars().count() > MAX_CHARS {
        return Err(Problem::new(format!("is longer than {MAX_CHARS} characters")).found(text));
    }
    let mut out = String::new();
    let mut levels = vec![Level { commas: 0, after_power: false }];
    let mut next = Next::Operand;
    let mut commas = 0; // of the function whose parenthesis comes next
    let mut fresh = true; // at the start of a term list: after nothing, '(' or ','
    let mut power = false; // the operand to come is an exponent
    let mut i = 0;
    while let Some(c) = text[i..].chars().next() {
        let start = i;
        i += c.len_utf8();
        if c.is_whitespace() {
            continue;
        }
        if next == Next::Open && c != '(' {
            return Err(at(start, format!("a function needs its argument in parentheses, found '{c}'")));
        }
        let operand = c.is_ascii_alphanumeric() || c == '.' || c == '(' || c == '_';
        if next == Next::Operator && operand {
            return Err(
                at(start, format!("an operator is missing before '{c}'")).help("write a product as '2*x'")
            );
        }
        let mut done = false; // an operand is complete
        match c {
            '(' => {
                if levels.len() > MAX_DEPTH {
                    return Err(at(start, format!("parentheses are nested deeper than {MAX_DEPTH}")));
                }
                if let Some(outer) = levels.last_mut() {
                    outer.after_power = std::mem::take(&mut power);
                }
                levels.push(Level { commas, after_power: false });
                (next, fresh, commas) = (Next::Operand, true, 0);
                out.push('(');
            }
            '0'..='9' | '.' => {
                let number = number_at(&text[start..]);
                i = start + number.len();
                let value = number.parse::<f64>().ok().filter(|v| v.is_finite());
                let value = value.ok_or_else(|| at(start, format!("'{number}' is not a number")))?;
                out.push_str(&format!("{value}"));
                done = true;
            }
            c if c.is_ascii_alphabetic() || c == '_' => {
                let word = &text[start..];
                let word = &word
                    [..word.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(word.len())];
                i = start + word.len();
                if FUNCTIONS.contains(&word) {
                    commas = usize::from(word == "min" || word == "max");
                    next = Next::Open;
                    out.push_str(word);
                } else if COORDINATES.contains(&word) {
                    out.push_str(word);
                    done = true;
                } else if let Some(constant) = CONSTANTS.iter().find(|constant| constant.0 == word) {
                    out.push_str(constant.1);
                    done = true;
                } else {
                    return Err(at(start, format!("'{word}' is not known")).help(suggest(word, &names())));
                }
            }
            '+' | '-' if next == Next::Operand => {
                if !fresh {
                    return Err(at(start, format!("a sign '{c}' follows an operator"))
                        .help(format!("write ({c}...)")));
                }
                out.push_str(if c == '-' { "0-" } else { "0+" });
                fresh = false;
            }
            '+' | '-' | '*' | '/' | '^' if next == Next::Operator => {
                let level = levels.last_mut().ok_or_else(|| at(start, "a ')' too many".into()))?;
                if c == '^' && level.after_power {
                    return Err(
                        at(start, "a power of a power is ambiguous".into()).help("write (a^b)^c or a^(b^c)")
                    );
                }
                level.after_power = false;
                power = c == '^';
                (next, fresh) = (Next::Operand, false);
                out.push(c);
            }
            ',' if next == Next::Operator => {
                let level = levels.last_mut().filter(|level| level.commas > 0);
                let level = level.ok_or_else(|| at(start, "a ',' is out of place".into()))?;
                (level.commas, level.after_power) = (level.commas - 1, false);
                (next, fresh) = (Next::Operand, true);
                out.push(',');
            }
            ')' if next == Next::Operator => {
                if levels.len() == 1 {
                    return Err(at(start, "a ')' closes nothing".into()));
                }
                if levels.pop().is_some_and(|level| level.commas > 0) {
                    return Err(
                        at(start, "an argument is missing".into()).help("min and max take two arguments")
                    );
                }
                out.push(')');
            }
            '+' | '-' | '*' | '/' | '^' | ',' | ')' => {
                return Err(at(start, format!("a number, a coordinate or '(' is missing before '{c}'")));
            }
            _ => return Err(at(start, format!("'{c}' has no meaning"))),
        }
        if done {
            (next, fresh) = (Next::Operator, false);
            if let Some(level) = levels.last_mut() {
                level.after_power = std::mem::take(&mut power);
            }
        }
    }
    if next != Next::Operator {
        return Err(at(text.len(), "an operand is missing".into()));
    }
    if levels.len() > 1 {
        return Err(at(text.len(), "a ')' is missing".into()));
    }
    Ok(out)
}

/// The longest number at the start of `text`: digits, a point, an exponent.
fn number_at(text: &str) -> &str {
    let bytes = text.as_bytes();
    let digits = |i: usize| i + bytes[i..].iter().take_while(|b| b.is_ascii_digit() || **b == b'.').count();
    let mut end = digits(0);
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(bytes.get(end + 1).is_some_and(|b| b"+-".contains(b)));
        let exponent = digits((end + 1 + sign).min(bytes.len()));
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    &text[..end]
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
