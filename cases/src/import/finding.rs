//! Parts of a model that are refused or left out, with their places.

use std::cell::RefCell;
use std::fmt;

/// A part of a model that is refused or left out. Prints as `file:line: what; help`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// File name as given by the caller.
    pub file: String,
    /// Line, from 1; 0 for the whole file.
    pub line: usize,
    /// The part, and for a refused one the reason.
    pub what: String,
    /// Advice: the form that would be right.
    pub help: Option<String>,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file)?;
        if self.line > 0 {
            write!(f, "{}:", self.line)?;
        }
        write!(f, " {}", self.what)?;
        match &self.help {
            Some(help) => write!(f, "; {help}"),
            None => Ok(()),
        }
    }
}

/// Findings of one model, collected while it is read.
pub(crate) struct Findings {
    file: String,
    refused: RefCell<Vec<Finding>>,
    left_out: RefCell<Vec<Finding>>,
}

impl Findings {
    pub fn of(file: &str) -> Findings {
        Findings { file: file.into(), refused: RefCell::default(), left_out: RefCell::default() }
    }

    /// Refuses a part that changes the answer.
    pub fn refuse(&self, line: usize, what: impl Into<String>, help: &str) {
        let help = (!help.is_empty()).then(|| help.to_string());
        let file = self.file.clone();
        self.refused.borrow_mut().push(Finding { file, line, what: what.into(), help });
    }

    /// Lists a part that does not change the answer.
    pub fn leave_out(&self, line: usize, what: impl Into<String>) {
        let finding = Finding { file: self.file.clone(), line, what: what.into(), help: None };
        self.left_out.borrow_mut().push(finding);
    }

    /// Whether anything is refused so far.
    pub fn refuses(&self) -> bool {
        !self.refused.borrow().is_empty()
    }

    /// The parts left out, by line, or all that is refused.
    pub fn close(self) -> Result<Vec<Finding>, Vec<Finding>> {
        let (mut refused, mut left_out) = (self.refused.into_inner(), self.left_out.into_inner());
        refused.sort_by_key(|finding| finding.line);
        left_out.sort_by_key(|finding| finding.line);
        if refused.is_empty() { Ok(left_out) } else { Err(refused) }
    }
}
