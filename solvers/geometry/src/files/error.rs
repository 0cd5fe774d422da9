//! What can be wrong with a mesh file, and where.

use std::fmt;
use std::path::PathBuf;

use crate::MeshError;

/// A result whose error knows its place.
pub(super) type Parsed<T> = Result<T, (Place, Problem)>;

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Line number from 1; one past the last line where the file ends too early.
    Line(usize),
    /// Byte number from 0, of a binary file.
    Byte(usize),
    /// Cell number from 0, of a file that has arrays of cells.
    Cell(usize),
    /// Node number from 0, of a file that has arrays of nodes.
    Node(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(line) => write!(f, "line {line}"),
            Place::Byte(byte) => write!(f, "byte {byte}"),
            Place::Cell(cell) => write!(f, "cell {cell}"),
            Place::Node(node) => write!(f, "node {node}"),
        }
    }
}

/// A mesh file that can't be read or written.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The operating system refused.
    #[error("{file}: {source}", file = file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// What the file holds breaks its format.
    #[error("{file}:{place}: {problem}", file = file.display(), place = short(*place))]
    At {
        /// The file.
        file: PathBuf,
        /// Where.
        place: Place,
        /// What is wrong there.
        problem: Problem,
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
    #[error("{file}: the name {name:?} is empty, holds a quotation mark or a line break, or for .inp a comma, blanks at an end, a letter that is not ASCII, or differs from another in its case alone", file = file.display())]
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
    /// A name from which no format follows.
    #[error("{file}: meshes are written as .msh (Gmsh 2.2 or 4.1), .inp (Abaqus, CalculiX), .vtu (VTK) and .stl (the boundary alone); end the name with one of them", file = file.display())]
    Suffix {
        /// The file.
        file: PathBuf,
    },
}

/// A line as compilers name it, `file:12`; a byte by its word.
fn short(place: Place) -> String {
    match place {
        Place::Line(line) => line.to_string(),
        Place::Byte(_) | Place::Cell(_) | Place::Node(_) => format!(" {place}"),
    }
}

/// What is wrong with a place in a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Problem {
    /// None of the formats that are read.
    #[error(
        "'{found}' begins no mesh file that is read: Gmsh .msh ($MeshFormat, 2.2, 4.0 or 4.1; $NOD), Abaqus .inp (*HEADING, *NODE), VTK .vtu (<VTKFile) and .vtk (# vtk DataFile) are, and surfaces: STL, OBJ, PLY"
    )]
    Format {
        /// The beginning of the file.
        found: String,
    },
    /// A surface where a mesh is wanted.
    #[error("is a surface, not a mesh; `tissuebench mesh make` fills it with tetrahedra")]
    Surface,
    /// A version of a format that is not understood.
    #[error("format '{found}'; of Gmsh 1, 2.2, 4.0 and 4.1 are read")]
    Version {
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
    /// The file stops in the middle.
    #[error("the file ends where {expected} should come")]
    End {
        /// What belongs here.
        expected: &'static str,
    },
    /// A part that comes twice.
    #[error("section {section} comes a second time")]
    Repeated {
        /// Its name.
        section: &'static str,
    },
    /// A part that is needed is not there.
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
    /// Two solids of the same nodes: their volume would count twice.
    #[error("element {element} has the same nodes as element {first} ({place})")]
    SameNodes {
        /// Number of the later element in the file.
        element: u64,
        /// Number of the first one.
        first: u64,
        /// Where the first one is.
        place: Place,
    },
    /// Two solids on the same side of a face that they share: they overlap.
    #[error(
        "element {element} shares a face with element {first} ({place}) and lies on the same side of it: they overlap"
    )]
    SameSide {
        /// Number of the later element in the file.
        element: u64,
        /// Number of the first one.
        first: u64,
        /// Where the first one is.
        place: Place,
    },
    /// A coordinate that is not finite.
    #[error("node {number} has a coordinate that is not finite")]
    NotFinite {
        /// Node number in the file.
        number: u64,
    },
    /// A triangle with a coordinate that is not finite.
    #[error("triangle {number} has a coordinate that is not finite")]
    NotFiniteFace {
        /// Number of the triangle in the file, from 1.
        number: u64,
    },
    /// A face whose corner isn't in the file.
    #[error("face {face} names corner {node}, which the file does not have")]
    UnknownCorner {
        /// Number of the face in the file, from 1.
        face: u64,
        /// The corner as the file has it.
        node: i64,
    },
    /// A face that isn't one plane piece.
    #[error(
        "edges {} and {} of face {face}, from its corners of these numbers on, cross or touch: give each corner once, in order around the face, or cut it into triangles", edges[0], edges[1]
    )]
    CrossedFace {
        /// Number of the face in the file, from 1.
        face: u64,
        /// The edges, from 1.
        edges: [usize; 2],
    },
    /// A concave face of too many corners.
    #[error(
        "face {face} is concave and has {corners} corners; cut concave faces of more than 1000 into triangles"
    )]
    LargeFace {
        /// Number of the face in the file, from 1.
        face: u64,
        /// How many it has.
        corners: usize,
    },
    /// A file of another size than its own counts make.
    #[error("{count} {what} take {expected} bytes, but the file has {found}")]
    Size {
        /// Of what.
        what: &'static str,
        /// How many the file says there are.
        count: usize,
        /// Bytes these take.
        expected: usize,
        /// Bytes there are.
        found: usize,
    },
    /// Parts that have not as many together as the file says.
    #[error("the section says that it has {claimed} {what}, but its blocks have {found}")]
    Count {
        /// Nodes or elements.
        what: &'static str,
        /// How many the file says there are.
        claimed: u64,
        /// How many there are.
        found: usize,
    },
    /// An element whose node isn't in the file.
    #[error("element {element} names node {node}, which the file does not have")]
    UnknownNode {
        /// Element number in the file.
        element: u64,
        /// Node number in the file.
        node: u64,
    },
    /// A node of no element.
    #[error(
        "no element names node {number}{}; leave such nodes out: tissuebench mesh convert --drop-unused", match others {
            0 => String::new(),
            others => format!(" (and {others} others)"),
        }
    )]
    UnusedNode {
        /// Node number in the file.
        number: u64,
        /// How many more there are.
        others: usize,
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
    #[error("element {element} has type {kind}; {known}")]
    UnknownType {
        /// Element number in the file.
        element: u64,
        /// The type as the file has it.
        kind: String,
        /// The types that are.
        known: &'static str,
    },
    /// An element with too few or too many numbers.
    #[error("element {element} of type {kind} has {found} numbers on its line instead of {expected}")]
    Length {
        /// Element number in the file.
        element: u64,
        /// The type as the file has it.
        kind: String,
        /// Numbers found.
        found: usize,
        /// Numbers needed.
        expected: usize,
    },
    /// A surface element that is no face of a cell.
    #[error("surface element {element} is not a face of any cell")]
    LooseFace {
        /// Element number in the file.
        element: u64,
    },
    /// A set or a group that names what the file does not have.
    #[error("{what} '{name}' names {of} {number}, which the file does not have")]
    UnknownMember {
        /// Set or surface.
        what: &'static str,
        /// Its name.
        name: String,
        /// Element or set.
        of: &'static str,
        /// What it names.
        number: String,
    },
    /// A surface by the free faces of elements that have none.
    #[error(
        "surface '{name}' has no face: give the faces (S1, S2, ..), or elements with a face that no other element has"
    )]
    NoFreeFace {
        /// Its name.
        name: String,
    },
    /// An instance whose name another has.
    #[error("instance '{name}' comes a second time; give each its own name")]
    SameInstance {
        /// Its name.
        name: String,
    },
    /// A keyword of the format that changes the mesh and is not read.
    #[error("{what} is not read; {help}")]
    Unread {
        /// The keyword.
        what: String,
        /// What to do.
        help: &'static str,
    },
    /// A keyword that neither Abaqus nor CalculiX has.
    #[error("*{found} is no keyword of Abaqus or CalculiX{}", match nearest {
        Some(nearest) => format!("; did you mean *{nearest}?"),
        None => String::new(),
    })]
    UnknownKeyword {
        /// As the file has it, in capitals.
        found: String,
        /// The one that is spelled most like it, if any is.
        nearest: Option<&'static str>,
    },
    /// Numbers beyond those that the head of a section claims.
    #[error("the section says that its {what} are numbered {} to {}, but they are {} to {}", claimed[0], claimed[1], found[0], found[1])]
    Range {
        /// Nodes or elements.
        what: &'static str,
        /// The least and the largest number that the file says there are.
        claimed: [u64; 2],
        /// Those there are.
        found: [u64; 2],
    },
    /// A block of elements whose type has another dimension than their entity.
    #[error(
        "a block of an entity of dimension {entity} has elements of type {kind}, whose dimension is {dimension}"
    )]
    Dimension {
        /// That of the block.
        entity: i64,
        /// The type as the file has it.
        kind: i64,
        /// That of the type.
        dimension: i64,
    },
    /// Text that is no XML.
    #[error("{problem}")]
    Xml {
        /// What the parser says.
        problem: String,
    },
    /// An array of another length than its file says elsewhere.
    #[error("an array of {found} where {expected} should be (numbers in text, bytes else)")]
    ArrayLength {
        /// Its length.
        found: usize,
        /// The length wanted.
        expected: usize,
    },
    /// An array that numbers regions or surfaces with other than whole numbers.
    #[error(
        "cell {cell} has {value} in the array '{array}', which numbers regions or surfaces: give whole numbers, or give the array another name"
    )]
    NotWhole {
        /// The array's name.
        array: String,
        /// The cell, from 0.
        cell: usize,
        /// Its value.
        value: String,
    },
    /// Two arrays that number regions, each in its own way.
    #[error(
        "cell {cell} is in region {} by the array '{}' and in {} by '{}': leave one of the two out, or give it another name",
        values[0], arrays[0], values[1], arrays[1]
    )]
    TwoRegions {
        /// Names of the arrays.
        arrays: [String; 2],
        /// The first cell where they differ, from 0.
        cell: usize,
        /// Its values.
        values: [i64; 2],
    },
    /// Something in a file that this one includes.
    #[error("in {file}, {place}: {problem}")]
    Included {
        /// The included file as it is named.
        file: String,
        /// Where in it.
        place: Place,
        /// What is wrong there.
        problem: Box<Problem>,
    },
    /// No cells.
    #[error("the file has no tetrahedra or hexahedra")]
    NoCells,
    /// More than can be counted, or than the file has bytes for.
    #[error("too many {what}: {count}")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many.
        count: usize,
    },
}
