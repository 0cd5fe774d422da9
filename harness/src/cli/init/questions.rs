//! Values from options, from answers on a terminal, or from defaults, which are named in the output.

use std::io::{BufRead, Write};

use crate::cli::errors::input;
use crate::error::Failure;

/// Source of values without an option.
pub(super) struct Questions {
    /// Answers, one per line; `None` uses the defaults.
    pub answers: Option<Box<dyn BufRead>>,
    /// Defaults used, as option, value and meaning.
    pub taken: Vec<[String; 3]>,
}

impl Questions {
    /// Returns the value of an option: the given value, the answer, or the default. An invalid answer is
    /// asked for again.
    pub fn value<T>(
        &mut self,
        option: &str,
        given: Option<&str>,
        question: &str,
        default: &str,
        read: impl Fn(&str) -> Result<T, String>,
    ) -> Result<T, Failure> {
        let wrong = |text: &str, bad: String| input(format!("--{option} '{text}': {bad}"));
        if let Some(text) = given {
            return read(text).map_err(|bad| wrong(text, bad));
        }
        while let Some(answers) = &mut self.answers {
            eprint!("{question} [{default}]: ");
            let _ = std::io::stderr().flush();
            let mut line = String::new();
            let count = answers.read_line(&mut line).map_err(|bad| input(format!("stdin: {bad}")))?;
            let text = line.trim();
            // At the end of the answers, defaults are used.
            if count == 0 {
                self.answers = None;
            } else if text.is_empty() {
                break;
            } else {
                match read(text) {
                    Ok(value) => return Ok(value),
                    Err(bad) => eprintln!("  '{text}' {bad}"),
                }
            }
        }
        if default.is_empty() {
            return Err(input(format!("--{option} is needed: {question}")));
        }
        self.taken.push([format!("--{option}"), default.into(), question.into()]);
        read(default).map_err(|bad| wrong(default, bad))
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn number(text: &str) -> Result<u32, String> {
        text.parse().map_err(|_| "is no number".into())
    }

    #[test]
    fn options_come_before_answers_and_answers_before_defaults() {
        let answers = Cursor::new("seven\n7\n\n");
        let mut questions = Questions { answers: Some(Box::new(answers)), taken: Vec::new() };
        let mut ask = |given| questions.value("nodes", given, "How many", "3", number);
        assert_eq!(ask(Some("5")).unwrap(), 5);
        assert_eq!(ask(None).unwrap(), 7); // the second answer: the first is invalid
        assert_eq!(ask(None).unwrap(), 3); // an empty line
        assert_eq!(ask(None).unwrap(), 3); // the end
        assert_eq!(ask(Some("x")).unwrap_err().to_string(), "--nodes 'x': is no number");
        assert_eq!(questions.taken, vec![["--nodes", "3", "How many"].map(String::from); 2]);
    }
}
