//! Errors of mesh files, with the place in the file.

use std::fmt;
use std::path::PathBuf;

use geometry::MeshError;
use geometry::surface::{PolygonFault, SurfaceProblem};

/// A result whose error has a place in the file.
pub(crate) type Parsed<T> = Result<T, (Place, Problem)>;

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Line number from 1; one past the last line for a file that ends too early.
    Line(usize),
    /// Byte number from 0, in a binary file.
    Byte(usize),
    /// Cell number from 0, in a file with arrays of cells.
    Cell(usize),
    /// Node number from 0, in a file with arrays of nodes.
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

/// Error of reading a surface file.
#[derive(Debug, thiserror::Error)]
pub enum SurfaceError {
    /// A file that cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A file whose triangles do not form a closed surface.
    #[error("{file}: {problem}{}", advice(problem, *repaired), file = file.display())]
    Surface {
        /// The file.
        file: PathBuf,
        /// Whether the faults are those that a repair has left.
        repaired: bool,
        /// Problem of the surface.
        problem: Box<SurfaceProblem>,
    },
}

fn advice(problem: &SurfaceProblem, repaired: bool) -> String {
    problem.advice(repaired).map_or(String::new(), |advice| format!("; {advice}"))
}

/// Errors of reading or writing a mesh file.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// A file that the operating system cannot read or write.
    #[error("{file}: {source}", file = file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// Content that violates the file format.
    #[error("{file}:{place}: {problem}", file = file.display(), place = short(*place))]
    At {
        /// The file.
        file: PathBuf,
        /// Place in the file.
        place: Place,
        /// Problem found there.
        problem: Problem,
    },
    /// Cells that do not form a valid mesh.
    #[error("{file}: {source}", file = file.display())]
    Mesh {
        /// The file.
        file: PathBuf,
        /// Problem of the mesh.
        source: MeshError,
    },
    /// A region or group name that the format cannot represent.
    #[error("{file}: the name {name:?} cannot be written: names must not be empty or contain quotation marks \
             or line breaks; for .inp also no commas, no blanks at either end and only ASCII, and two names \
             must not differ in case only", file = file.display())]
    Name {
        /// The file.
        file: PathBuf,
        /// The name.
        name: String,
    },
    /// An array that the file does not have.
    #[error("{file}: {problem}", file = file.display())]
    Array {
        /// The file.
        file: PathBuf,
        /// Problem of the array.
        problem: Problem,
    },
    /// A length unit that is not a positive number.
    #[error("{file}: the length unit is {unit} m; it has to be positive", file = file.display())]
    Unit {
        /// The file.
        file: PathBuf,
        /// Metres per unit of the file.
        unit: f64,
    },
    /// A file name whose suffix belongs to no format.
    #[error("{file}: meshes are written as .msh (Gmsh 2.2 or 4.1), .inp (Abaqus, CalculiX), .vtu (VTK) and \
             .stl (the boundary only); give a name with one of these suffixes", file = file.display())]
    Suffix {
        /// The file.
        file: PathBuf,
    },
}

/// Place in the style of compilers: a line as `12` in `file:12`, other places in words.
fn short(place: Place) -> String {
    match place {
        Place::Line(line) => line.to_string(),
        Place::Byte(_) | Place::Cell(_) | Place::Node(_) => format!(" {place}"),
    }
}

/// A problem at a place in a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Problem {
    /// A file in none of the supported formats.
    #[error(
        "no supported mesh format begins with '{found}'; supported: Gmsh .msh ($MeshFormat, 2.2, 4.0 or 4.1; \
         $NOD), Abaqus .inp (*HEADING, *NODE), FEBio .feb (<febio_spec), VTK .vtu (<VTKFile) and .vtk (# vtk DataFile), and the \
         surfaces STL, OBJ, PLY, OFF, .vtp (VTK) and .mesh (Medit)"
    )]
    Format {
        /// The beginning of the file.
        found: String,
    },
    /// A surface instead of a mesh.
    #[error("is a surface, not a mesh; `tissuebench mesh make` fills it with tetrahedra")]
    Surface,
    /// An unsupported version of a format.
    #[error("format '{found}' is not supported; supported Gmsh formats: 1, 2.2, 4.0 and 4.1")]
    Version {
        /// Line found.
        found: String,
    },
    /// Content other than the format expects.
    #[error("expected {expected}, found '{found}'")]
    Expected {
        /// Expected item.
        expected: &'static str,
        /// Text found.
        found: String,
    },
    /// A file that ends too early.
    #[error("the file ends before {expected}")]
    End {
        /// Expected item.
        expected: &'static str,
    },
    /// A section that occurs twice.
    #[error("section {section} occurs a second time")]
    Repeated {
        /// Name of the section.
        section: &'static str,
    },
    /// A required section that is missing.
    #[error("the file has no {section} section")]
    Missing {
        /// Name of the section.
        section: &'static str,
    },
    /// A number that is used twice.
    #[error("{what} {number} occurs a second time")]
    Duplicate {
        /// Node or element.
        what: &'static str,
        /// Number in the file.
        number: u64,
    },
    /// Two solids with the same nodes, whose volume would count twice.
    #[error("element {element} has the same nodes as element {first} ({place})")]
    SameNodes {
        /// Number of the later element in the file.
        element: u64,
        /// Number of the first element.
        first: u64,
        /// Place of the first element.
        place: Place,
    },
    /// Two overlapping solids, on the same side of a face that they share.
    #[error(
        "element {element} shares a face with element {first} ({place}) and lies on the same side of it: they overlap"
    )]
    SameSide {
        /// Number of the later element in the file.
        element: u64,
        /// Number of the first element.
        first: u64,
        /// Place of the first element.
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
    /// A face with a corner that is not in the file.
    #[error("face {face} names corner {node}, which the file does not have")]
    UnknownCorner {
        /// Number of the face in the file, from 1.
        face: u64,
        /// Corner as written in the file.
        node: i64,
    },
    /// A face that is not a simple polygon.
    #[error(
        "edges {} and {} of face {face} (numbered by their first corners) cross or touch: give each corner \
         once, in order around the face, or cut the face into triangles", edges[0], edges[1]
    )]
    CrossedFace {
        /// Number of the face in the file, from 1.
        face: u64,
        /// Numbers of the two edges, from 1.
        edges: [usize; 2],
    },
    /// A concave face with too many corners.
    #[error(
        "face {face} is concave and has {corners} corners; cut concave faces of more than 1000 into triangles"
    )]
    LargeFace {
        /// Number of the face in the file, from 1.
        face: u64,
        /// Number of corners.
        corners: usize,
    },
    /// A file whose size contradicts its counts.
    #[error("{count} {what} take {expected} bytes, but the file has {found}")]
    Size {
        /// Kind of items counted.
        what: &'static str,
        /// Number of items according to the file.
        count: usize,
        /// Size of these items in bytes.
        expected: usize,
        /// Size of the file in bytes.
        found: usize,
    },
    /// Blocks whose total contradicts the count of the section.
    #[error("the section says that it has {claimed} {what}, but its blocks have {found}")]
    Count {
        /// Nodes or elements.
        what: &'static str,
        /// Number according to the file.
        claimed: u64,
        /// Number found.
        found: usize,
    },
    /// An element with a node that is not in the file.
    #[error("element {element} names node {node}, which the file does not have")]
    UnknownNode {
        /// Element number in the file.
        element: u64,
        /// Node number in the file.
        node: u64,
    },
    /// A node that no element uses.
    #[error(
        "node {number}{} belongs to no element; drop such nodes with tissuebench mesh convert --drop-unused", match others {
            0 => String::new(),
            others => format!(" (and {others} others)"),
        }
    )]
    UnusedNode {
        /// Node number in the file.
        number: u64,
        /// Number of further such nodes.
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
    /// An unsupported element type.
    #[error("element {element} has type {kind}; {known}")]
    UnknownType {
        /// Element number in the file.
        element: u64,
        /// Type as written in the file.
        kind: String,
        /// Types that are supported, in words.
        known: String,
    },
    /// An element with too few or too many numbers.
    #[error("element {element} of type {kind} has {found} numbers on its line instead of {expected}")]
    Length {
        /// Element number in the file.
        element: u64,
        /// Type as written in the file.
        kind: String,
        /// Numbers found.
        found: usize,
        /// Numbers needed.
        expected: usize,
    },
    /// A surface element that is not a face of a cell.
    #[error("surface element {element} is not a face of any cell")]
    LooseFace {
        /// Element number in the file.
        element: u64,
    },
    /// A set or group that refers to something the file does not have.
    #[error("{what} '{name}' names {of} {number}, which the file does not have")]
    UnknownMember {
        /// Kind of the set or surface.
        what: &'static str,
        /// Name of the set or surface.
        name: String,
        /// Kind of the member: element or set.
        of: &'static str,
        /// The member as written.
        number: String,
    },
    /// A surface of the free faces of elements that have no free face.
    #[error(
        "surface '{name}' has no face: give the faces (S1, S2, ..), or elements with a face that belongs to \
         no other element"
    )]
    NoFreeFace {
        /// Name of the surface.
        name: String,
    },
    /// An instance with the name of another instance.
    #[error("instance '{name}' occurs a second time; give each instance its own name")]
    SameInstance {
        /// Name of the instance.
        name: String,
    },
    /// A keyword of the format that changes the mesh and is not supported.
    #[error("{what} is not supported; {help}")]
    Unread {
        /// The keyword.
        what: String,
        /// Advice, in words.
        help: &'static str,
    },
    /// A keyword that neither Abaqus nor CalculiX knows.
    #[error("*{found} is not a keyword of Abaqus or CalculiX{}", match nearest {
        Some(nearest) => format!("; did you mean *{nearest}?"),
        None => String::new(),
    })]
    UnknownKeyword {
        /// Keyword as in the file, in upper case.
        found: String,
        /// Known keyword with the most similar spelling, if any is similar.
        nearest: Option<&'static str>,
    },
    /// Numbers outside the range stated at the head of a section.
    #[error("the section says that its {what} are numbered {} to {}, but they are {} to {}", claimed[0], claimed[1], found[0], found[1])]
    Range {
        /// Nodes or elements.
        what: &'static str,
        /// Smallest and largest number according to the file.
        claimed: [u64; 2],
        /// Smallest and largest number found.
        found: [u64; 2],
    },
    /// A block of elements whose type has another dimension than their entity.
    #[error(
        "a block of an entity of dimension {entity} has elements of type {kind}, whose dimension is {dimension}"
    )]
    Dimension {
        /// Dimension of the entity.
        entity: i64,
        /// Type as written in the file.
        kind: i64,
        /// Dimension of the type.
        dimension: i64,
    },
    /// Text that is not valid XML.
    #[error("{problem}")]
    Xml {
        /// Message of the parser.
        problem: String,
    },
    /// An array whose length contradicts the file.
    #[error("the array has length {found} instead of {expected} (numbers if text, bytes if binary)")]
    ArrayLength {
        /// Length found.
        found: usize,
        /// Length required.
        expected: usize,
    },
    /// An array of region or surface numbers with values that are not whole numbers.
    #[error(
        "cell {cell} has the value {value} in the array '{array}', which numbers regions or surfaces: give whole numbers, or rename the array"
    )]
    NotWhole {
        /// Name of the array.
        array: String,
        /// Cell number, from 0.
        cell: usize,
        /// Value at the cell.
        value: String,
    },
    /// Two arrays of region numbers that disagree.
    #[error(
        "cell {cell} is in region {} by the array '{}' and in {} by '{}': remove or rename one of the two arrays",
        values[0], arrays[0], values[1], arrays[1]
    )]
    TwoRegions {
        /// Names of the arrays.
        arrays: [String; 2],
        /// Number of the first cell at which they differ, from 0.
        cell: usize,
        /// Values of the two arrays at this cell.
        values: [i64; 2],
    },
    /// A requested array that the file does not have.
    #[error("has no array '{array}'{}", match known.is_empty() {
        true => ", and no other array of vectors with three components".to_string(),
        false => format!("; its arrays of vectors are {}", known.join(", ")),
    })]
    NoArray {
        /// Name of the array.
        array: String,
        /// Names of the arrays with three components.
        known: Vec<String>,
    },
    /// Two arrays of one name.
    #[error(
        "the array '{array}' occurs a second time, of other items or with other components: give each its own name"
    )]
    TwoArrays {
        /// Name of the array.
        array: String,
    },
    /// An array of vectors without three components.
    #[error("the array '{array}' has {found} component{}; a direction has three", if *found == 1 { "" } else { "s" })]
    Components {
        /// Name of the array.
        array: String,
        /// Number of components.
        found: usize,
    },
    /// A problem in an included file.
    #[error("in {file}, {place}: {problem}")]
    Included {
        /// Name of the included file, as written.
        file: String,
        /// Place in the included file.
        place: Place,
        /// Problem found there.
        problem: Box<Problem>,
    },
    /// A file without cells.
    #[error("the file has no solid elements")]
    NoCells,
    /// More items than can be indexed, or than the file has bytes for.
    #[error("too many {what}: {count}")]
    TooMany {
        /// Kind of items.
        what: &'static str,
        /// Number of items.
        count: usize,
    },
}

impl Problem {
    /// Problem of a face of a surface, by its number in the file, that cannot be divided into triangles.
    pub(crate) fn of_face(face: usize, fault: PolygonFault) -> Problem {
        let face = face as u64;
        match fault {
            PolygonFault::Crosses(edges) => Problem::CrossedFace { face, edges },
            PolygonFault::Corners(corners) => Problem::LargeFace { face, corners },
        }
    }
}

/// Numbers in ascending order, with commas.
pub(crate) fn ascending<T: Ord + ToString, const N: usize>(mut numbers: [T; N]) -> String {
    numbers.sort_unstable();
    numbers.map(|number| number.to_string()).join(", ")
}
