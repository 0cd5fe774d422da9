//! Node positions in a text file: x, y, z per line, between commas, with or without a line of column names.

use std::path::{Path, PathBuf};

use crate::Point3;

/// Positions and the lines they stand on.
#[derive(Clone, Debug, PartialEq)]
pub struct PointFile {
    /// Positions (m).
    pub points: Vec<Point3>,
    /// Line of each, from 1.
    pub lines: Vec<usize>,
}

/// A file of positions that can't be read.
#[derive(Debug, thiserror::Error)]
pub enum PointFileError {
    /// The operating system refused, or the file is no text.
    #[error("{file}: {source}", file = file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A line that is no position.
    #[error("{file}:{line}: column {column} {problem}", file = file.display())]
    Line {
        /// The file.
        file: PathBuf,
        /// Line number from 1.
        line: usize,
        /// Which of the values between commas, from 1.
        column: usize,
        /// What is wrong there.
        problem: PointProblem,
    },
    /// No positions.
    #[error("{file}: holds no positions", file = file.display())]
    Empty {
        /// The file.
        file: PathBuf,
    },
}

/// What is wrong with a value.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PointProblem {
    /// Text where a number belongs.
    #[error("has '{found}' where a number belongs")]
    NotANumber {
        /// What is there.
        found: String,
    },
    /// A number that is not finite.
    #[error("is {found}, which is not finite")]
    NotFinite {
        /// What is there.
        found: String,
    },
    /// A line that ends too early.
    #[error("is missing: the line has {found} values, {expected} are needed")]
    Missing {
        /// Values found.
        found: usize,
        /// Values needed.
        expected: usize,
    },
    /// A value too many.
    #[error("is one too many: the line has {found} values, {expected} are needed")]
    TooMany {
        /// Values found.
        found: usize,
        /// Values needed.
        expected: usize,
    },
    /// Column names without one that is needed.
    #[error("should be named {name}: of the columns none is")]
    NoColumn {
        /// The name.
        name: &'static str,
    },
}

/// Which columns hold x, y and z, and how many there are.
struct Columns {
    of_axis: [usize; 3],
    count: usize,
}

const NAMES: [&str; 3] = ["x", "y", "z"];

/// Reads a file of positions; `unit` is metres per unit of its numbers. Blank lines and those that start with `#` are passed over.
/// A first line without any number names the columns: those named x, y and z count, in any order and among others.
pub fn read_points(file: &Path, unit: f64) -> Result<PointFile, PointFileError> {
    let text = disk::read_text(file, disk::Kind::MESH)
        .map_err(|source| PointFileError::Io { file: file.to_path_buf(), source })?;
    read_points_text(&text, file, unit)
}

/// As [`read_points`], from text in memory; `file` is the name used in errors.
pub fn read_points_text(text: &str, file: &Path, unit: f64) -> Result<PointFile, PointFileError> {
    let wrong = |line, (column, problem): (usize, PointProblem)| PointFileError::Line {
        file: file.to_path_buf(),
        line,
        column: column + 1,
        problem,
    };
    let (mut points, mut lines) = (Vec::new(), Vec::new());
    let mut columns = None;
    let content = text.trim_start_matches('\u{feff}').lines().enumerate();
    for (index, line) in content.filter(|(_, line)| !line.trim().is_empty() && !line.trim().starts_with('#'))
    {
        let values: Vec<&str> = line.split(',').map(str::trim).collect();
        if columns.is_none() {
            let named = values.iter().all(|v| v.parse::<f64>().is_err());
            columns =
                Some(if named { header(&values) } else { Ok(Columns { of_axis: [0, 1, 2], count: 3 }) })
                    .transpose()
                    .map_err(|bad| wrong(index + 1, bad))?;
            if named {
                continue;
            }
        }
        if let Some(columns) = &columns {
            let at = position(&values, columns).map_err(|bad| wrong(index + 1, bad))?;
            points.push(Point3::from(unit * at.coords));
            lines.push(index + 1);
        }
    }
    if points.is_empty() {
        return Err(PointFileError::Empty { file: file.to_path_buf() });
    }
    Ok(PointFile { points, lines })
}

fn header(values: &[&str]) -> Result<Columns, (usize, PointProblem)> {
    let mut of_axis = [0; 3];
    for (axis, name) in NAMES.into_iter().enumerate() {
        let found = values.iter().position(|v| v.trim_matches('"').eq_ignore_ascii_case(name));
        of_axis[axis] = found.ok_or((axis, PointProblem::NoColumn { name }))?;
    }
    Ok(Columns { of_axis, count: values.len() })
}

fn position(values: &[&str], columns: &Columns) -> Result<Point3, (usize, PointProblem)> {
    let (found, expected) = (values.len(), columns.count);
    if found < expected {
        return Err((found, PointProblem::Missing { found, expected }));
    }
    if found > expected {
        return Err((expected, PointProblem::TooMany { found, expected }));
    }
    let mut at = Point3::origin();
    for (axis, &column) in columns.of_axis.iter().enumerate() {
        let found = values[column];
        at[axis] = found.parse().map_err(|_| (column, PointProblem::NotANumber { found: found.into() }))?;
        if !f64::is_finite(at[axis]) {
            return Err((column, PointProblem::NotFinite { found: found.into() }));
        }
    }
    Ok(at)
}
