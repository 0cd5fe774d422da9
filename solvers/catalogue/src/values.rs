//! Checked values of an entry's parameters.

use crate::names::suggest;
use crate::parameter::{Parameter, Value};
use crate::problem::Problem;

/// Values of an entry's parameters: the given values, each known and in its range, and defaults for the other
/// parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    parameters: &'static [Parameter],
    /// Given values, in the order of the parameters.
    given: Vec<Option<Value>>,
}

impl Values {
    /// Makes a set of values in which no parameter is given.
    pub fn new(parameters: &'static [Parameter]) -> Values {
        Values { parameters, given: vec![None; parameters.len()] }
    }

    /// Sets the value of a parameter.
    ///
    /// # Errors
    ///
    /// The name is unknown, or the parameter does not accept the value.
    pub fn give(&mut self, name: &str, value: Value) -> Result<(), Problem> {
        let Some(index) = self.parameters.iter().position(|parameter| parameter.name == name) else {
            let names: Vec<&str> = self.parameters.iter().map(|parameter| parameter.name).collect();
            return Err(Problem::new("is not a parameter").found(name).help(suggest(name, &names)));
        };
        self.parameters[index].check(&value)?;
        self.given[index] = Some(value);
        Ok(())
    }

    /// Returns the first required parameter that is not given.
    pub fn missing(&self) -> Option<&'static Parameter> {
        let pairs = self.parameters.iter().zip(&self.given);
        pairs.filter(|(parameter, given)| parameter.required && given.is_none()).map(|(p, _)| p).next()
    }

    /// Iterates over the given parameters, with their values.
    pub fn given(&self) -> impl Iterator<Item = (&'static Parameter, &Value)> {
        self.parameters.iter().zip(&self.given).filter_map(|(p, given)| Some((p, given.as_ref()?)))
    }

    /// Whether the parameter of that name is given.
    pub fn has(&self, name: &str) -> bool {
        self.value(name).is_some()
    }

    /// Returns a given number or its default; `None` if there is neither, or no parameter of that name.
    pub fn get(&self, name: &str) -> Option<f64> {
        let index = self.parameters.iter().position(|parameter| parameter.name == name)?;
        match &self.given[index] {
            Some(Value::Number(number)) => Some(*number),
            Some(Value::List(_) | Value::Flag(_)) => None,
            None => self.parameters[index].default,
        }
    }

    /// Returns a given number or its default.
    ///
    /// # Errors
    ///
    /// The parameter is not given and has no default.
    pub fn number(&self, name: &'static str) -> Result<f64, Problem> {
        self.get(name).ok_or_else(|| Problem::new(format!("{name} is missing")))
    }

    /// Returns a given list or vector; `None` if it is not given.
    pub fn list(&self, name: &str) -> Option<&[f64]> {
        self.value(name)
            .and_then(|value| if let Value::List(list) = value { Some(list.as_slice()) } else { None })
    }

    /// Returns a given flag or its default; false if there is neither.
    pub fn flag(&self, name: &str) -> bool {
        match self.value(name) {
            Some(Value::Flag(flag)) => *flag,
            _ => self.parameters.iter().any(|p| p.name == name && p.default == Some(1.0)),
        }
    }

    /// Whether the entry has a parameter of that name.
    pub fn takes(&self, name: &str) -> bool {
        self.parameters.iter().any(|parameter| parameter.name == name)
    }

    fn value(&self, name: &str) -> Option<&Value> {
        self.given().find(|(parameter, _)| parameter.name == name).map(|(_, value)| value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Dimension, Range};

    static TAKEN: &[Parameter] = &[
        Parameter::required("radius", Dimension::Length, "").within(Range::Positive),
        Parameter::default("alpha", Dimension::None, 0.4, ""),
        Parameter::optional("eps", Dimension::None, ""),
    ];

    #[test]
    fn defaults_stand_in_for_what_is_not_given() {
        let mut values = Values::new(TAKEN);
        assert_eq!(values.missing().map(|p| p.name), Some("radius"));
        assert!(values.give("radius", Value::Number(-1.0)).is_err());
        values.give("radius", Value::Number(2.0)).unwrap();
        assert_eq!(values.missing(), None);
        assert_eq!((values.number("radius"), values.number("alpha")), (Ok(2.0), Ok(0.4)));
        assert_eq!((values.get("eps"), values.number("eps").is_err()), (None, true));
        let unknown = values.give("radios", Value::Number(1.0)).unwrap_err();
        assert_eq!(unknown.help.unwrap(), "did you mean 'radius'? (known here: radius, alpha, eps)");
        assert_eq!(values.given().count(), 1);
    }
}
