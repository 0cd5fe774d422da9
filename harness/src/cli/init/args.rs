//! Options of `init`. All are optional: on a terminal, missing values are asked for; otherwise defaults
//! apply.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Arguments of `init`.
#[derive(Args)]
pub struct InitArgs {
    /// Organ: a closed surface (STL, OBJ, PLY, OFF, .vtp, .mesh) or a mesh file (.msh, .inp, .vtu, .vtk)
    #[arg(long, value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// Mend small faults of the surface
    #[arg(long)]
    pub repair: bool,
    /// Wrap a surface that is open, crosses itself or branches, at cells with edges of this length; needs
    /// --unit
    #[arg(long, value_name = "LENGTH", conflicts_with = "repair", requires = "unit")]
    pub wrap: Option<String>,
    /// Length unit of the file: m, cm, mm or um (default: the unit that gives the length of an organ)
    #[arg(long)]
    pub unit: Option<String>,
    /// Large strain: neo-Hookean law, contact with a tool. Small strain: linear law, one end of the body
    /// displaced or loaded (default: large)
    #[arg(long, value_name = "small|large")]
    pub strain: Option<String>,
    /// Young's modulus (default: "20 kPa")
    #[arg(long, value_name = "PRESSURE")]
    pub young: Option<String>,
    /// Poisson's ratio, 0 to below 0.5 (default: 0.45)
    #[arg(long, value_name = "NUMBER")]
    pub poisson: Option<String>,
    /// Side of the tool: top (z), bottom, left (x), right, front (y) or back (default: the first side with a
    /// blunt end that is supported by the constrained part through a body that is not slender)
    #[arg(long, value_name = "SIDE")]
    pub press_from: Option<String>,
    /// Constrained part of the body: comparisons such as "z < 3 mm", or a named surface of the file (default:
    /// at least a fifth of the height, opposite to the tool; for jaws across them)
    #[arg(long, value_name = "WHERE")]
    pub hold: Option<String>,
    /// Displacement of the tool, of each of two jaws, into the body (default: a twentieth of the body's height)
    #[arg(long, value_name = "LENGTH", conflicts_with = "load")]
    pub closure: Option<String>,
    /// Force on the tool, on each of two jaws, such as "0.5 N", instead of --closure; at small strain a pressure, such as "1 kPa"
    #[arg(long, value_name = "FORCE")]
    pub load: Option<String>,
    /// Tool: plate, ball, jaws, or a closed surface (STL, OBJ, PLY, OFF, .vtp, .mesh) in the unit of the
    /// organ's file (default: plate)
    #[arg(long, value_name = "plate|ball|jaws|FILE")]
    pub tool: Option<String>,
    /// Coulomb's coefficient of friction between tool and body (default: none)
    #[arg(long, value_name = "NUMBER")]
    pub friction: Option<String>,
    /// Initial distance of the tool from the body (default: in contact)
    #[arg(long, value_name = "LENGTH", conflicts_with = "load")]
    pub gap: Option<String>,
    /// Methods, each in three sizes: tet4, tet4-nodal, tet10 and efg (default: tet4,tet10,efg)
    #[arg(long, value_name = "LIST")]
    pub methods: Option<String>,
    /// Approximate number of nodes in the finest size of each method, twice as many for tet10 (default: 1000)
    #[arg(long, value_name = "N", conflicts_with = "spacing")]
    pub nodes: Option<String>,
    /// Mean edge length of the finest size, instead of --nodes
    #[arg(long, value_name = "LENGTH")]
    pub spacing: Option<String>,
    /// Scene file to write (default: the name of the organ's file, with suffix .toml)
    #[arg(long, value_name = "SCENE")]
    pub out: Option<PathBuf>,
    /// Ask nothing: use the defaults on a terminal too
    #[arg(long)]
    pub yes: bool,
    /// Replace an existing scene
    #[arg(long)]
    pub force: bool,
}

/// Side from which the tool presses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Side {
    Top,
    Bottom,
    Left,
    Right,
    Front,
    Back,
}

impl Side {
    /// Returns the axis normal to the side.
    pub fn axis(self) -> usize {
        match self {
            Side::Left | Side::Right => 0,
            Side::Front | Side::Back => 1,
            Side::Top | Side::Bottom => 2,
        }
    }

    /// Returns the other side of the axis.
    pub fn opposite(self) -> Side {
        match self {
            Side::Top => Side::Bottom,
            Side::Bottom => Side::Top,
            Side::Left => Side::Right,
            Side::Right => Side::Left,
            Side::Front => Side::Back,
            Side::Back => Side::Front,
        }
    }

    /// Returns the side's name in a scene.
    pub fn name(self) -> String {
        let name = match self {
            Side::Left => "x-min",
            Side::Right => "x-max",
            Side::Front => "y-min",
            Side::Back => "y-max",
            Side::Bottom => "z-min",
            Side::Top => "z-max",
        };
        name.into()
    }

    /// Returns 1 for a side at the end of its axis, -1 at its start.
    pub fn sign(self) -> f64 {
        if matches!(self, Side::Top | Side::Right | Side::Back) { 1.0 } else { -1.0 }
    }
}

/// Range of strains, which decides the law and the loading.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Strain {
    Small,
    Large,
}

/// A method of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Method {
    Tet4,
    Tet4Nodal,
    Tet10,
    Efg,
}

/// Returns the word of a value on the command line.
pub(super) fn word<T: ValueEnum>(value: T) -> String {
    value.to_possible_value().map_or(String::new(), |value| value.get_name().to_string())
}

/// Parses a word of a choice; the error lists the known words.
pub(super) fn choice<T: ValueEnum>(text: &str) -> Result<T, String> {
    T::from_str(text.trim(), true).map_err(|_| {
        let known: Vec<String> = T::value_variants().iter().cloned().map(word).collect();
        let near = catalogue::nearest(text, known.iter().map(String::as_str));
        let near = near.map_or(String::new(), |near| format!("; did you mean '{near}'?"));
        format!("is not one of {}{near}", known.join(", "))
    })
}
