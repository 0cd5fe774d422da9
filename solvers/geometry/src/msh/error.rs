//! What can be wrong with a mesh file, and where.

use std::path::PathBuf;

use crate::MeshError;

/// A mesh file that can't be read or written.
#[derive(Debug, thiserror::Error)]
pub enum MshError {
    /// The operating system refused.
    #[error("{file}: {source}", file = file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The text breaks the format.
    #[error("{file}:{line}: {problem}", file = file.display())]
    Syntax {
        /// The file.
        file: PathBuf,
        /// Line number from 1; one past the last line where the file ends too early.
        line: usize,
        /// What is wrong there.
        problem: MshProblem,
    },
    /// The cells make no valid mesh.
    #[error("{file}: {source}", file = file.display())]
    Mesh {
        /// The file.
        file: PathBuf,
        /// Why.
        source: MeshError,
    },
    /// A region or group name that the format can't hold.
    #[error("{file}: the name {name:?} holds a quotation mark or a line break", file = file.display())]
    Name {
        /// The file.
        file: PathBuf,
        /// The name.
        name: String,
    },
    /// A length unit that is not a positive number.
    #[error("{file}: the length unit is {unit} m; it has to be positive", file = file.display())]
    Unit {
        /// The file.
        file: PathBuf,
        /// Metres per unit of the file.
        unit: f64,
    },
}

/// What is wrong with a line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MshProblem {
    /// Not the version and type that are understood.
    #[error("format '{found}'; only Gmsh 2.2 ASCII ('2.2 0 8') is read (export with -format msh22)")]
    Format {
        /// The line found.
        found: String,
    },
    /// Not what comes next in the format.
    #[error("expected {expected}, found '{found}'")]
    Expected {
        /// What belongs here.
        expected: &'static str,
        /// What is there.
        found: String,
    },
    /// The file stops in the middle of a section.
    #[error("the file ends where {expected} should come")]
    End {
        /// What belongs here.
        expected: &'static str,
    },
    /// A section that comes twice.
    #[error("section {section} comes a second time")]
    Repeated {
        /// Its name.
        section: &'static str,
    },
    /// A section that is needed is not there.
    #[error("the file has no {section} section")]
    Missing {
        /// Its name.
        section: &'static str,
    },
    /// A number given twice.
    #[error("{what} {number} comes a second time")]
    Duplicate {
        /// Node or element.
        what: &'static str,
        /// Its number in the file.
        number: u64,
    },
    /// A coordinate that is not finite.
    #[error("node {number} has a coordinate that is not finite")]
    NotFinite {
        /// Node number in the file.
        number: u64,
    },
    /// An element whose node isn't in the file.
    #[error("element {element} names node {node}, which the file does not have")]
    UnknownNode {
        /// Element number in the file.
        element: u64,
        /// Node number in the file.
        node: u64,
    },
    /// An element that names one node twice.
    #[error("element {element} names node {node} twice")]
    RepeatedNode {
        /// Element number in the file.
        element: u64,
        /// Node number in the file.
        node: u64,
    },
    /// An element type that is not understood.
    #[error(
        "element {element} has type {kind}; types 4, 5, 11, 17 (solids), 2, 3, 9, 16 (faces) and lines and points are read"
    )]
    UnknownType {
        /// Element number in the file.
        element: u64,
        /// Gmsh's type number.
        kind: u64,
    },
    /// A line with too few or too many numbers.
    #[error("element {element} of type {kind} has {found} numbers on its line instead of {expected}")]
    Length {
        /// Element number in the file.
        element: u64,
        /// Gmsh's type number.
        kind: u64,
        /// Numbers found.
        found: usize,
        /// Numbers needed.
        expected: usize,
    },
    /// A surface element that is no face of a cell on the boundary.
    #[error("surface element {element} is not a face of any cell")]
    LooseFace {
        /// Element number in the file.
        element: u64,
    },
    /// No cells.
    #[error("the file has no tetrahedra or hexahedra")]
    NoCells,
    /// More nodes or regions than can be counted.
    #[error("too many {what}: {count}")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many.
        count: usize,
    },
}
