//! Keys set from outside of the scene's file: by a study's axis, or by `--set KEY=VALUE`.

use std::borrow::Cow;
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use catalogue::{Problem, nearest};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::document::{Document, moved};
use super::error::{ErrorKind, SceneError};

/// A key of the scene and the value that replaces the file's value, as given by `KEY=VALUE`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    /// Key in the form of messages, such as `method[0].size.level`. `method[tet4]` is the method with that
    /// id.
    pub key: String,
    /// Value as TOML. Text that is not valid TOML, such as `10 kPa`, is used as a string.
    pub value: String,
}

impl FromStr for Override {
    type Err = String;

    fn from_str(text: &str) -> Result<Override, String> {
        match text.split_once('=') {
            Some((key, value)) if !key.trim().is_empty() && !value.trim().is_empty() => {
                Ok(Override { key: key.trim().into(), value: value.trim().into() })
            }
            _ => Err("is not KEY=VALUE, such as material.poisson=0.45".into()),
        }
    }
}

impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key, self.value)
    }
}

type Value<'t> = Spanned<DeValue<'t>>;

impl<'t> Document<'t> {
    /// Sets the keys in order.
    ///
    /// # Errors
    /// All keys that the document cannot have.
    pub fn set_all(&mut self, overrides: &'t [Override]) -> Result<(), Vec<SceneError>> {
        let mut errors = Vec::new();
        for each in overrides {
            if let Err(problem) = self.set(&each.key, Some(&each.value), &format!("--set {each}")) {
                let place = self.sources.last();
                errors.push(self.files.error(ErrorKind::Invalid, place, &each.key, problem));
            }
        }
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }

    /// Sets a key such as `method[].size.cells[0]` to a value, or removes the key. Missing tables along the
    /// path are created. An error in the value names `driver` in place of a file.
    pub fn set(&mut self, key: &str, value: Option<&'t str>, driver: &str) -> Result<(), Problem> {
        let value = value.map(|text| {
            self.files.add_override(driver.to_string());
            let base = self.sources.add(text);
            let span = base..base + text.len();
            let read = DeValue::parse(text).map_or(DeValue::String(Cow::Borrowed(text)), Spanned::into_inner);
            Spanned::new(span, moved(&read, base))
        });
        set(self.root.get_mut(), key, value.as_ref())
    }
}

/// Splits a key before its first `.` or `[`.
fn split(key: &str) -> (&str, &str) {
    key.find(['.', '[']).map_or((key, ""), |end| key.split_at(end))
}

fn set<'t>(table: &mut DeTable<'t>, key: &str, value: Option<&Value<'t>>) -> Result<(), Problem> {
    let (head, rest) = split(key);
    if !table.contains_key(head) && rest.starts_with('[') {
        let near = nearest(head, table.keys().map(|key| key.get_ref().as_ref()));
        let help = near.map_or(String::new(), |near| format!("did you mean '{near}'?"));
        return Err(Problem::new("is not in the scene").found(head).help(help));
    }
    let span = value.map_or(0..0, Spanned::span);
    match (rest.is_empty(), value) {
        (true, None) => drop(table.remove(head)),
        (true, Some(value)) => {
            // The key has to be at the place of the new value, so the old key is removed first.
            table.remove(head);
            table.insert(owned(head, span), value.clone());
        }
        (false, _) => {
            if !table.contains_key(head) {
                let empty = Spanned::new(span.clone(), DeValue::Table(DeTable::new()));
                table.insert(owned(head, span), empty);
            }
            below(table.get_mut(head).expect("put there"), rest, value)?;
        }
    }
    Ok(())
}

fn owned<'t>(key: &str, span: Range<usize>) -> Spanned<Cow<'t, str>> {
    Spanned::new(span, Cow::Owned(key.to_string()))
}

/// Continues at `.key` or `[index]` below a value, or replaces the value at the end of the key.
fn below<'t>(slot: &mut Value<'t>, rest: &str, value: Option<&Value<'t>>) -> Result<(), Problem> {
    if let Some(key) = rest.strip_prefix('.') {
        return match slot.get_mut() {
            DeValue::Table(table) => set(table, key, value),
            _ => Err(Problem::new("is not a table").found(key)),
        };
    }
    let Some(inside) = rest.strip_prefix('[') else {
        *slot = value.ok_or_else(|| Problem::new("is an entry of a list and can't be left out"))?.clone();
        return Ok(());
    };
    let (index, behind) =
        inside.split_once(']').ok_or_else(|| Problem::new("a '[' is never closed").found(rest))?;
    let DeValue::Array(list) = slot.get_mut() else { return Err(Problem::new("is not a list").found(rest)) };
    if index.is_empty() {
        return list.iter_mut().try_for_each(|item| below(item, behind, value));
    }
    let at = index.parse().ok().or_else(|| list.iter().position(|item| is_named(item, index)));
    let length = list.len();
    let item = at.and_then(|at: usize| list.get_mut(at));
    let item = item.ok_or_else(|| {
        Problem::new(format!("[{index}] is out of range; the list has {length}")).found(rest)
    })?;
    below(item, behind, value)
}

/// Whether an entry of a list has the id or name `name`.
fn is_named(item: &Value<'_>, name: &str) -> bool {
    let named = |key: &str| item.get_ref().get(key).and_then(|value| value.get_ref().as_str()) == Some(name);
    named("id") || named("name") || named("use")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(settings: &[(&str, Option<&'static str>)]) -> Result<toml::Table, Problem> {
        let text = "method = [{ id = 'a' }, { id = 'b' }]\nbody = { size = [1, 2] }";
        let mut document = Document::parse(text, "scene.toml").unwrap();
        for (key, value) in settings {
            document.set(key, *value, "test")?;
        }
        use serde::Deserialize;
        Ok(toml::Table::deserialize(toml::de::Deserializer::from(document.root)).unwrap())
    }

    #[test]
    fn keys_reach_into_lists_and_every_method() {
        let made = after(&[
            ("method[].cells", Some("3")),
            ("method[b].cells", Some("4")),
            ("body.size[1]", Some("7")),
            ("material.poisson", Some("0.4")),
            ("material.young", Some("10 kPa")),
        ]);
        let expected = "method = [{ id = 'a', cells = 3 }, { id = 'b', cells = 4 }]\nbody = { size = [1, 7] }\n\
                        material = { poisson = 0.4, young = '10 kPa' }";
        assert_eq!(made.unwrap(), expected.parse().unwrap());
        let made = after(&[("method[].id", None), ("material", None)]).unwrap();
        assert_eq!(made, "method = [{}, {}]\nbody = { size = [1, 2] }".parse().unwrap());
    }

    #[test]
    fn a_key_that_leads_nowhere_is_refused() {
        for (key, value, problem) in [
            ("body.size[0]", None, "can't be left out"),
            ("body.size[2]", Some("7"), "[2] is out of range; the list has 2"),
            ("method[c].cells", Some("7"), "[c] is out of range; the list has 2"),
            ("methd[].id", Some("7"), "not in the scene"),
            ("body.size.x", Some("7"), "is not a table"),
            ("body[0]", Some("7"), "is not a list"),
            ("body.size[0", Some("7"), "never closed"),
        ] {
            let found = after(&[(key, value)]).unwrap_err().problem;
            assert!(found.contains(problem), "{key}: {found}");
        }
    }

    #[test]
    fn an_override_is_a_key_and_a_value() {
        let read: Override = "material.young = 10 kPa".parse().unwrap();
        assert_eq!((read.key.as_str(), read.value.as_str()), ("material.young", "10 kPa"));
        for bad in ["", "material", "=3", "material.young="] {
            assert!(bad.parse::<Override>().is_err(), "{bad}");
        }
    }
}
