//! Scenes as lists of tables with comments, printed in a fixed order.

use std::fmt::Write;

/// A table of a scene: its header, the comment above it, and its keys in order.
pub(crate) struct Part {
    header: &'static str,
    comment: Vec<String>,
    keys: Vec<(&'static str, String)>,
}

impl Part {
    /// A table with this header, such as `[[support]]`; empty for the keys at the top.
    pub fn new(header: &'static str) -> Part {
        Part { header, comment: Vec::new(), keys: Vec::new() }
    }

    /// Adds a line of the comment.
    pub fn note(mut self, line: impl AsRef<str>) -> Part {
        // Names of the source may contain line breaks, which would end the comment.
        self.comment.push(line.as_ref().chars().map(|c| if c.is_control() { ' ' } else { c }).collect());
        self
    }

    /// Adds a key with its value as written in a scene.
    pub fn key(mut self, name: &'static str, value: impl Into<String>) -> Part {
        self.keys.push((name, value.into()));
        self
    }

    /// Adds a key if it has a value.
    pub fn maybe(self, name: &'static str, value: Option<String>) -> Part {
        match value {
            Some(value) => self.key(name, value),
            None => self,
        }
    }
}

/// Text of a scene.
pub(crate) fn print(parts: &[Part]) -> String {
    let mut out = String::new();
    for (count, part) in parts.iter().enumerate() {
        if count > 0 {
            out.push('\n');
        }
        // Writing to a string cannot fail.
        for line in &part.comment {
            let _ = writeln!(out, "{}", format!("# {line}").trim_end());
        }
        if !part.header.is_empty() {
            let _ = writeln!(out, "{}", part.header);
        }
        for (name, value) in &part.keys {
            let _ = writeln!(out, "{name} = {value}");
        }
    }
    out
}

/// A text as a value of a scene.
pub(crate) fn quoted(text: &str) -> String {
    toml::Value::String(text.into()).to_string()
}

/// A list as a value of a scene.
pub(crate) fn list(values: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", values.into_iter().collect::<Vec<_>>().join(", "))
}

/// Names as the value of a scene: one text, or a list.
pub(crate) fn names(names: &[&str]) -> String {
    match names {
        [one] => quoted(one),
        all => list(all.iter().map(|name| quoted(name))),
    }
}
