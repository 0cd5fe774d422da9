//! Errors in a value, with a hint at the right value.

use std::fmt;

/// Error in a value, without its location in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Value as written in the file.
    pub found: Option<String>,
    /// Description of the error.
    pub problem: String,
    /// Hint at a right value.
    pub help: Option<String>,
    /// Parameter of an entry, if a constructor found the error.
    pub parameter: Option<&'static str>,
}

impl Problem {
    /// Makes an error without a value and without help.
    pub fn new(problem: impl Into<String>) -> Problem {
        Problem { found: None, problem: problem.into(), help: None, parameter: None }
    }

    /// Adds the value as written in the file, clipped as by [`clip`].
    pub fn found(mut self, found: impl fmt::Display) -> Problem {
        self.found = Some(clip(&found.to_string()));
        self
    }

    /// Sets the parameter of the entry in which the error was found.
    pub fn of(mut self, parameter: &'static str) -> Problem {
        self.parameter = Some(parameter);
        self
    }

    /// Adds a hint at a right value.
    pub fn help(mut self, help: impl Into<String>) -> Problem {
        self.help = Some(help.into());
        self
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(found) = &self.found {
            write!(f, "'{found}' ")?;
        }
        f.write_str(&self.problem)?;
        match &self.help {
            Some(help) => write!(f, "; {help}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Problem {}

/// Joins a text to one line and clips the line after 80 characters, with `...` in place of the rest.
pub fn clip(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(80) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line,
    }
}
