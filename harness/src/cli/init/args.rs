//! The options of `init`. All are optional: what is not given is asked on a terminal, and else takes its default.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// Arguments of `init`.
#[derive(Args)]
pub struct InitArgs {
    /// The organ: a closed surface (STL, OBJ, PLY) or a mesh file (.msh, .inp, .vtu, .vtk)
    #[arg(long, value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// Length unit of the file: m, cm, mm or um (default: the one in which it is as long as organs are)
    #[arg(long)]
    pub unit: Option<String>,
    /// Large strain: a neo-Hookean law, a plate in contact. Small strain: a linear law, the end of the body is moved or loaded (default:
    /// large)
    #[arg(long, value_name = "small|large")]
    pub strain: Option<String>,
    /// Young's modulus (default: "20 kPa")
    #[arg(long, value_name = "PRESSURE")]
    pub young: Option<String>,
    /// Poisson's ratio, 0 to below 0.5 (default: 0.45)
    #[arg(long, value_name = "NUMBER")]
    pub poisson: Option<String>,
    /// The side from which the plate presses: top (z), bottom, left (x), right, front (y) or back (default:
    /// the first whose end is blunt, stands on what is held and is not slender)
    #[arg(long, value_name = "SIDE")]
    pub press_from: Option<String>,
    /// What is held: comparisons such as "z < 3 mm", or a surface that the file names (default: a fifth of the body, away from the
    /// plate)
    #[arg(long, value_name = "WHERE")]
    pub hold: Option<String>,
    /// How far the plate presses into the body's height (default: a twentieth of it)
    #[arg(long, value_name = "LENGTH", conflicts_with = "load")]
    pub closure: Option<String>,
    /// In place of --closure: the force on the plate, such as "0.5 N"; at small strain a pressure, such as "1 kPa"
    #[arg(long, value_name = "FORCE")]
    pub load: Option<String>,
    /// Distance from which the plate starts (default: it touches the body)
    #[arg(long, value_name = "LENGTH", conflicts_with = "load")]
    pub gap: Option<String>,
    /// Methods, each in three sizes: tet4, tet4-nodal, tet10 and efg (default: tet4,tet10,efg)
    #[arg(long, value_name = "LIST")]
    pub methods: Option<String>,
    /// About how many nodes the finest size of each method has; tet10 has twice as many (default: 1000)
    #[arg(long, value_name = "N", conflicts_with = "spacing")]
    pub nodes: Option<String>,
    /// In place of --nodes: the mean length of the edges of the finest size
    #[arg(long, value_name = "LENGTH")]
    pub spacing: Option<String>,
    /// The scene to write (default: the name of the file, ending in .toml)
    #[arg(long, value_name = "SCENE")]
    pub out: Option<PathBuf>,
    /// Ask nothing: take the defaults on a terminal too
    #[arg(long)]
    pub yes: bool,
    /// Replace the scene if there is one
    #[arg(long)]
    pub force: bool,
}

/// The side from which the plate presses.
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
    /// The axis on which it lies.
    pub fn axis(self) -> usize {
        match self {
            Side::Left | Side::Right => 0,
            Side::Front | Side::Back => 1,
            Side::Top | Side::Bottom => 2,
        }
    }

    /// 1 at the end of the axis, -1 at its start.
    pub fn sign(self) -> f64 {
        if matches!(self, Side::Top | Side::Right | Side::Back) { 1.0 } else { -1.0 }
    }
}

/// How large strains may become.
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

/// The word of the command line.
pub(super) fn word<T: ValueEnum>(value: T) -> String {
    value.to_possible_value().map_or(String::new(), |value| value.get_name().to_string())
}

/// One of the words that a choice has.
pub(super) fn choice<T: ValueEnum>(text: &str) -> Result<T, String> {
    T::from_str(text.trim(), true).map_err(|_| {
        let known: Vec<String> = T::value_variants().iter().cloned().map(word).collect();
        let near = catalogue::nearest(text, known.iter().map(String::as_str));
        let near = near.map_or(String::new(), |near| format!("; did you mean '{near}'?"));
        format!("is none of {}{near}", known.join(", "))
    })
}
