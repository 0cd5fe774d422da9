//! Reads node positions from text files: x, y and z per line, separated by commas, with an optional line of
//! column names.

use std::path::{Path, PathBuf};

use crate::Point3;

/// Positions with their line numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct PointFile {
    /// Positions (m).
    pub points: Vec<Point3>,
    /// Line number of each position, from 1.
    pub lines: Vec<usize>,
}

/// Errors of reading a file of positions.
#[derive(Debug, thiserror::Error)]
pub enum PointFileError {
    /// A file that the operating system cannot read, or that is not text.
    #[error("{file}: {source}", file = file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// A line that is not a position.
    #[error("{file}:{line}: column {column} {problem}", file = file.display())]
    Line {
        /// The file.
        file: PathBuf,
        /// Line number from 1.
        line: usize,
        /// Column number among the comma-separated values, from 1.
        column: usize,
        /// The problem in this column.
        problem: PointProblem,
    },
    /// A file without positions.
    #[error("{file}: contains no positions", file = file.display())]
    Empty {
        /// The file.
        file: PathBuf,
    },
}

/// A problem with one value of a line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PointProblem {
    /// Text in place of a number.
    #[error("is '{found}', not a number")]
    NotANumber {
        /// Text found.
        found: String,
    },
    /// A number that is not finite.
    #[error("is {found}, which is not finite")]
    NotFinite {
        /// Number found, as written.
        found: String,
    },
    /// A line that ends too early.
    #[error("is missing: the line has {found} values instead of {expected}")]
    Missing {
        /// Values found.
        found: usize,
        /// Values needed.
        expected: usize,
    },
    /// A value too many.
    #[error("is one too many: the line has {found} values instead of {expected}")]
    TooMany {
        /// Values found.
        found: usize,
        /// Values needed.
        expected: usize,
    },
    /// Column names that lack x, y or z.
    #[error("should be named {name}, but no column has this name")]
    NoColumn {
        /// Name of the missing column.
        name: &'static str,
    },
}

/// Columns of x, y and z, and the number of columns.
struct Columns {
    of_axis: [usize; 3],
    count: usize,
}

const NAMES: [&str; 3] = ["x", "y", "z"];

/// Reads a file of positions, one per line, with values separated by commas. `unit` is the number of metres
/// per unit of the file; the positions returned are in metres. Blank lines and lines that start with `#` are
/// skipped. A first line without any number holds column names: only the columns x, y and z are read, in any
/// order.
///
/// # Errors
/// A file that cannot be read, a line that is not a position, or a file without positions.
pub fn read_points(file: &Path, unit: f64) -> Result<PointFile, PointFileError> {
    let text = disk::read_text(file, disk::Kind::MESH)
        .map_err(|source| PointFileError::Io { file: file.to_path_buf(), source })?;
    read_points_text(&text, file, unit)
}

/// Reads positions as [`read_points`] does, from text in memory. `file` is the name used in errors.
///
/// # Errors
/// A line that is not a position, or a text without positions.
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
    let found = values.len();
    let expected = columns.count;
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
