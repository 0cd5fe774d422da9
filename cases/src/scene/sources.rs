//! The files that a scene is read from: its own, and that of the shared methods it takes; then values that
//! are set from outside. Their texts are one range of byte offsets, so that a span says which of them it is
//! in.

use std::ops::Range;

use catalogue::Problem;

use super::error::{ErrorKind, SceneError};

/// The texts while they are read.
pub(crate) struct Sources<'t> {
    texts: Vec<Text<'t>>,
}

struct Text<'t> {
    text: &'t str,
    /// Offset of its first byte.
    base: usize,
    /// Where its lines start, from its first byte.
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

    /// Adds a text; what its offsets are moved by.
    pub fn add(&mut self, text: &'t str) -> usize {
        let base = self.texts.last().map_or(0, |last| last.base + last.text.len() + 1);
        self.texts.push(Text::new(text, base));
        base
    }

    /// Start of the text that was added last.
    pub fn last(&self) -> Place {
        Place { file: self.texts.len() - 1, line: 1, column: 1 }
    }

    /// Where a span begins; the start of the scene where there is none.
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

/// The names of the files, and which methods are taken from the second.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Files {
    names: Vec<String>,
    taken: Vec<Taken>,
    /// How many of the names, from the first, are those of files. The rest name values set from outside.
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

    /// Adds what a value set from outside is called.
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

    /// Whether there is more than the scene's own.
    pub fn are_several(&self) -> bool {
        self.names.len() > 1
    }

    /// An error at a place. One in a shared method has the key that it has in its own file, and says which scene takes it.
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
            // A value from outside has no lines.
            line: if is_file { place.line } else { 0 },
            column: if is_file { place.column } else { 0 },
            key,
            found: problem.found,
            problem: problem.problem,
            help,
        }
    }
}
