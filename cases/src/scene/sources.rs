//! The texts that a scene is read from: its own file, the file of shared methods, and values set from
//! outside. Together the texts form one range of byte offsets, so that a span identifies its text.

use std::ops::Range;

use catalogue::Problem;

use super::error::{ErrorKind, SceneError};

/// The texts during reading.
pub(crate) struct Sources<'t> {
    texts: Vec<Text<'t>>,
}

struct Text<'t> {
    text: &'t str,
    /// Offset of the first byte.
    base: usize,
    /// Offsets of the starts of lines, from the first byte.
    starts: Vec<usize>,
}

/// A place in one of the files: line and column from 1, the column in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub file: usize,
    pub line: usize,
    pub column: usize,
}

impl<'t> Sources<'t> {
    pub fn new(text: &'t str) -> Sources<'t> {
        Sources { texts: vec![Text::new(text, 0)] }
    }

    /// The scene's own text.
    pub fn own(&self) -> &'t str {
        self.texts[0].text
    }

    /// Adds a text; returns the base of its offsets.
    pub fn add(&mut self, text: &'t str) -> usize {
        let base = self.texts.last().map_or(0, |last| last.base + last.text.len() + 1);
        self.texts.push(Text::new(text, base));
        base
    }

    /// Start of the last text added.
    pub fn last(&self) -> Place {
        Place { file: self.texts.len() - 1, line: 1, column: 1 }
    }

    /// Place at which a span begins; the start of the scene if there is no span.
    pub fn place(&self, span: Option<Range<usize>>) -> Place {
        let offset = span.map_or(0, |span| span.start);
        let file = self.texts.iter().rposition(|text| text.base <= offset).unwrap_or(0);
        let (line, column) = self.texts[file].place(offset);
        Place { file, line, column }
    }
}

impl<'t> Text<'t> {
    fn new(text: &'t str, base: usize) -> Text<'t> {
        let ends = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i + 1);
        Text { text, base, starts: std::iter::once(0).chain(ends).collect() }
    }

    fn place(&self, offset: usize) -> (usize, usize) {
        let offset = offset - self.base;
        let line = self.starts.partition_point(|start| *start <= offset);
        let start = self.starts[line - 1];
        let before = self.text.get(start..offset.min(self.text.len())).unwrap_or("");
        (line, before.chars().count() + 1)
    }
}

/// Names of the files, and the methods taken from the second file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Files {
    names: Vec<String>,
    taken: Vec<Taken>,
    /// Number of names, from the first, that are files. The other names stand for values set from outside.
    files: usize,
}

/// A shared method.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Taken {
    /// Its key in the scene, such as `method[2]`.
    pub here: String,
    /// Its key in the file of shared methods.
    pub there: String,
    /// The line of the scene that takes it.
    pub line: usize,
}

impl Files {
    pub fn new(file: &str) -> Files {
        Files { names: vec![file.to_string()], taken: Vec::new(), files: 1 }
    }

    /// Adds the file of shared methods.
    pub fn add(&mut self, file: String, taken: Vec<Taken>) {
        self.names.push(file);
        self.taken = taken;
        self.files += 1;
    }

    /// Adds the name of a value set from outside.
    pub fn add_override(&mut self, name: String) {
        self.names.push(name);
    }

    /// The scene's own file.
    pub fn own(&self) -> &str {
        &self.names[0]
    }

    pub fn name(&self, file: usize) -> &str {
        &self.names[file]
    }

    /// Whether there are other sources than the scene's own file.
    pub fn are_several(&self) -> bool {
        self.names.len() > 1
    }

    /// An error at a place. An error in a shared method has its key in the shared file, and names the scene
    /// that takes it.
    pub fn error(&self, kind: ErrorKind, place: Place, key: &str, problem: Problem) -> SceneError {
        let is_file = place.file < self.files;
        let taken = self.taken.iter().filter(|_| is_file && place.file > 0).find_map(|taken| {
            let rest = key.strip_prefix(&taken.here)?;
            (rest.is_empty() || rest.starts_with('.')).then(|| (format!("{}{rest}", taken.there), taken.line))
        });
        let (key, help) = match taken {
            Some((key, line)) => {
                let taken = format!("taken by {}:{line}", self.own());
                (key, Some(problem.help.map_or(taken.clone(), |help| format!("{help}; {taken}"))))
            }
            None => (key.to_string(), problem.help),
        };
        SceneError {
            kind,
            file: self.names[place.file].clone(),
            // A value set from outside has no lines.
            line: if is_file { place.line } else { 0 },
            column: if is_file { place.column } else { 0 },
            key,
            found: problem.found,
            problem: problem.problem,
            help,
        }
    }
}
