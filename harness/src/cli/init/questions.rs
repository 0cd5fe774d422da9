//! Values from options, from answers on a terminal, or from defaults that are named in the output.

use std::io::{BufRead, Write};

use crate::Failure;
use crate::cli::mesh_files::input;

/// Where values come from that no option gives.
pub(super) struct Questions {
    /// Answers, line by line; `None` takes the defaults.
    pub answers: Option<Box<dyn BufRead>>,
    /// Defaults that were taken: option, value, what it is.
    pub taken: Vec<[String; 3]>,
}

impl Questions {
    /// The value of an option: as given, else as answered, else the default. An answer that is wrong is asked for again.
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
            // The end of the answers takes the rest of the defaults.
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
        assert_eq!(ask(None).unwrap(), 7); // the second answer: the first is none
        assert_eq!(ask(None).unwrap(), 3); // an empty line
        assert_eq!(ask(None).unwrap(), 3); // the end
        assert_eq!(ask(Some("x")).unwrap_err().to_string(), "--nodes 'x': is no number");
        assert_eq!(questions.taken, vec![["--nodes", "3", "How many"].map(String::from); 2]);
    }
}
