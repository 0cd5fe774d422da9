//! What is wrong with a value, and what would be right.

use std::fmt;

/// A finding that doesn't know its place in a file yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The value as the file has it.
    pub found: Option<String>,
    /// What is wrong with it.
    pub problem: String,
    /// What would be right.
    pub help: Option<String>,
    /// The parameter of an entry that it is about, where a constructor found it.
    pub parameter: Option<&'static str>,
}

impl Problem {
    /// Without a value and without help.
    pub fn new(problem: impl Into<String>) -> Problem {
        Problem { found: None, problem: problem.into(), help: None, parameter: None }
    }

    /// With the value, one line of at most 80 characters.
    pub fn found(mut self, found: impl fmt::Display) -> Problem {
        self.found = Some(clip(&found.to_string()));
        self
    }

    /// About a parameter of an entry.
    pub fn of(mut self, parameter: &'static str) -> Problem {
        self.parameter = Some(parameter);
        self
    }

    /// With what would be right.
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

/// One line of at most 80 characters.
pub fn clip(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(80) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line,
    }
}
