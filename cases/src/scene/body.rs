//! The body of a scene: its shape, and the names of its surfaces.

use catalogue::{Problem, suggest};
use geometry::generate::{Ventricle, surfaces};
use geometry::surface::Treatment;
use mesh_files::is_surface;
use schemars::JsonSchema;
use serde::Deserialize;

use super::mesh_file::MeshFile;
use super::report::Report;
use super::selection::{Names, Place};
use super::units::{Length, Q, Unit};

/// The body in its undeformed state
#[derive(Deserialize, JsonSchema)]
#[serde(tag = "shape", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum BodyKeys {
    /// An axis-parallel box: give two corners (min, max), or a size with one corner at the origin
    #[schemars(extend("x-surfaces" = with_all(&surfaces::BOX)))]
    Box {
        /// Lower corner; the origin unless given
        min: Option<[Q<Length>; 3]>,
        /// Upper corner
        max: Option<[Q<Length>; 3]>,
        /// Edge lengths
        size: Option<[Q<Length>; 3]>,
    },
    /// A cylinder about the z axis with its base at z = 0
    #[schemars(extend("x-surfaces" = with_all(&surfaces::CYLINDER)))]
    Cylinder {
        /// Radius
        radius: Q<Length>,
        /// Height
        height: Q<Length>,
    },
    /// A ball about the origin
    #[schemars(extend("x-surfaces" = with_all(&surfaces::BALL)))]
    Ball {
        /// Radius
        radius: Q<Length>,
    },
    /// A thick sphere about the origin
    #[schemars(extend("x-surfaces" = with_all(&surfaces::SHELL)))]
    SphereShell {
        /// Inner radius
        inner: Q<Length>,
        /// Outer radius
        outer: Q<Length>,
        /// Only the octant x, y, z >= 0
        #[serde(default)]
        #[schemars(extend("x-surfaces" = surfaces::OCTANT))]
        octant: bool,
    },
    /// The left ventricle of a heart: the shell between two ellipsoids about the z axis, cut off at z = base, with
    /// the apex towards -z
    #[schemars(extend("x-surfaces" = with_all(&surfaces::VENTRICLE)))]
    Ventricle {
        /// Radius across and half length of the inner ellipsoid
        inner: [Q<Length>; 2],
        /// Radius across and half length of the outer ellipsoid
        outer: [Q<Length>; 2],
        /// Height of the cut
        base: Q<Length>,
    },
    /// The kidney, a bean of 40 x 75 x 30 mm
    #[schemars(extend("x-surfaces" = with_all(&surfaces::BALL)))]
    Kidney {
        /// Only the half z >= 0
        #[serde(default)]
        #[schemars(extend("x-surfaces" = surfaces::HALF))]
        half: bool,
        /// Weaker grading of the half's meshes under the jaw's edges, for meshes so fine that thin cells fold
        /// (10,000 nodes)
        #[serde(default)]
        mildly_graded: bool,
    },
    /// A mesh file (Gmsh .msh, Abaqus or CalculiX .inp, FEBio .feb, VTK .vtu or .vtk), which names its own
    /// surfaces, or a closed surface (STL, OBJ, PLY, OFF, VTK .vtp, Medit .mesh)
    File {
        /// The file, relative to the folder of the scene; or a list of closed surfaces, which nest or touch and
        /// become the regions of the body
        path: Names,
        /// Unit of the numbers in the file
        unit: Unit<Length>,
        /// Join pieces whose faces coincide without shared nodes, in all meshes of this body and its methods
        #[serde(default)]
        join: bool,
        /// Mend small faults of a surface: doubled corners and triangles, T-junctions, reversed triangles,
        /// holes of up to a tenth of its size
        #[serde(default)]
        repair: bool,
        /// Wrap a surface that is open, crosses itself or branches: the edge length of the cells of the wrap
        wrap: Option<Q<Length>>,
    },
}

/// Shape of the body; lengths in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// An axis-parallel box.
    Box {
        /// Lower corner.
        min: [f64; 3],
        /// Upper corner.
        max: [f64; 3],
    },
    /// A cylinder about the z axis, with its base at z = 0.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Height.
        height: f64,
    },
    /// A ball about the origin.
    Ball {
        /// Radius.
        radius: f64,
    },
    /// A thick sphere about the origin.
    SphereShell {
        /// Inner radius.
        inner: f64,
        /// Outer radius.
        outer: f64,
        /// Whether only the octant x, y, z >= 0 is present.
        octant: bool,
    },
    /// A ventricle between two ellipsoids.
    Ventricle(Ventricle),
    /// The kidney, as a map of the ball.
    Kidney {
        /// Whether only the half z >= 0 is present, with cells graded towards the z axis.
        half: bool,
        /// Whether these cells are graded less.
        mildly_graded: bool,
    },
    /// The mesh of a file.
    File(MeshFile),
}

impl BodyKeys {
    pub fn read(self, report: &Report) -> Option<Body> {
        Some(match self {
            BodyKeys::Box { min, max, size } => {
                let (min, max) = corners([min, max, size].map(|q| q.map(|q| q.map(|q| q.0))), report)?;
                let holds = (0..3).all(|a| max[a] > min[a]);
                report.require(holds, "", "has no volume", "every extent must be above zero");
                Body::Box { min, max }
            }
            BodyKeys::Cylinder { radius, height } => Body::Cylinder {
                radius: report.positive("radius", radius.0),
                height: report.positive("height", height.0),
            },
            BodyKeys::Ball { radius } => Body::Ball { radius: report.positive("radius", radius.0) },
            BodyKeys::SphereShell { inner, outer, octant } => {
                let inner = report.positive("inner", inner.0);
                let outer = report.positive("outer", outer.0);
                report.require(outer > inner, "outer", "is not above inner", "the wall needs a thickness");
                Body::SphereShell { inner, outer, octant }
            }
            BodyKeys::Ventricle { inner, outer, base } => {
                let [inner, outer] = [inner, outer].map(|radii| radii.map(|q| q.0));
                let base = base.0;
                for (k, name) in ["inner[0]", "inner[1]"].into_iter().enumerate() {
                    report.positive(name, inner[k]);
                    let at = format!("outer[{k}]");
                    report.require(
                        outer[k] > inner[k],
                        &at,
                        "is not above inner",
                        "the wall needs a thickness",
                    );
                }
                let help = "the cut has to cross the inner ellipsoid";
                report.require(base.abs() < inner[1], "base", "misses the inner ellipsoid", help);
                Body::Ventricle(Ventricle { inner, outer, base })
            }
            BodyKeys::Kidney { half, mildly_graded } => {
                let help =
                    "leave it out, or add half = true: the cells of the whole kidney are never mildly graded";
                report.require(half || !mildly_graded, "mildly_graded", "applies to the half only", help);
                Body::Kidney { half, mildly_graded }
            }
            BodyKeys::File { path, unit, join, repair, wrap } => {
                let file = files(path.into(), unit, report)?;
                let of_surface = is_surface(&file.path);
                let help = "leave it out: a closed surface has no nodes to join";
                report.require(!join || !of_surface, "join", "is for meshes", help);
                let treatment = treatment(repair, wrap.map(|size| size.0), of_surface, report);
                Body::File(MeshFile { join, treatment, ..file })
            }
        })
    }
}

/// A mesh file, or one or several surfaces.
fn files(paths: Vec<String>, unit: Unit<Length>, report: &Report) -> Option<MeshFile> {
    if paths.is_empty() {
        report.add("path", Problem::new("names no file").help("give a file, or several closed surfaces"));
        return None;
    }
    let file = MeshFile::together(&paths, Some(unit), "path", report);
    let all = file.paths();
    let other = all.iter().find(|path| all.len() > 1 && path.is_file() && !is_surface(path));
    if let Some(other) = other {
        let problem = format!("names several files, but {} is not a surface", other.display());
        report.add("path", Problem::new(problem).help(mesh_files::SURFACES));
    }
    Some(file)
}

/// Treatment of the surface of a file.
fn treatment(repair: bool, wrap: Option<f64>, of_surface: bool, report: &Report) -> Treatment {
    let help = "leave it out: the body of a mesh file with cells is bounded by their faces";
    report.require(!repair || of_surface, "repair", "is for surfaces", help);
    let Some(size) = wrap else { return if repair { Treatment::Repair } else { Treatment::AsGiven } };
    report.require(of_surface, "wrap", "is for surfaces", help);
    report.require(
        !repair,
        "wrap",
        "can't be combined with repair",
        "a wrap needs no repair: leave repair out",
    );
    Treatment::Wrap { size: report.positive("wrap", size) }
}

/// Two corners of a box from its `min`, `max` and `size`.
fn corners(keys: [Option<[f64; 3]>; 3], report: &Report) -> Option<([f64; 3], [f64; 3])> {
    match keys {
        [Some(min), Some(max), None] => Some((min, max)),
        [min, None, Some(size)] => {
            let min = min.unwrap_or([0.0; 3]);
            Some((min, std::array::from_fn(|a| min[a] + size[a])))
        }
        [_, Some(_), Some(_)] => {
            let help = "give min and max, or size alone (with a corner at the origin, or at min)";
            report.add("size", Problem::new("can't be combined with max").help(help));
            None
        }
        [_, _, None] => {
            report.missing("size", "give size = [\"40 mm\", \"40 mm\", \"20 mm\"], or min and max");
            None
        }
    }
}

impl Body {
    /// The name of the shape in files and tables.
    pub fn name(&self) -> &'static str {
        match self {
            Body::Box { .. } => "box",
            Body::Cylinder { .. } => "cylinder",
            Body::Ball { .. } => "ball",
            Body::SphereShell { .. } => "sphere-shell",
            Body::Ventricle(_) => "ventricle",
            Body::Kidney { .. } => "kidney",
            Body::File(_) => "file",
        }
    }

    /// Names of the parts of its surface, including "surface" for all of it; `None` if only the mesh file has
    /// names.
    pub fn surfaces(&self) -> Option<Vec<&'static str>> {
        let (parts, further): (&[_], &[_]) = match self {
            Body::Box { .. } => (&surfaces::BOX, &[]),
            Body::Cylinder { .. } => (&surfaces::CYLINDER, &[]),
            Body::Ball { .. } | Body::Kidney { half: false, .. } => (&surfaces::BALL, &[]),
            Body::Kidney { half: true, .. } => (&surfaces::BALL, &surfaces::HALF),
            Body::Ventricle(_) => (&surfaces::VENTRICLE, &[]),
            Body::SphereShell { octant: false, .. } => (&surfaces::SHELL, &[]),
            Body::SphereShell { octant: true, .. } => (&surfaces::SHELL, &surfaces::OCTANT),
            Body::File(_) => return None,
        };
        Some([with_all(parts), further.to_vec()].concat())
    }

    /// Reports the names in a selection that are not names of surfaces.
    pub(crate) fn find(&self, place: &Place, report: &Report) {
        let Some(known) = self.surfaces() else { return };
        let (key, names) = match place {
            Place::On(names) => ("on", names),
            Place::Edge(names) => ("edge", names),
            Place::Where(_) | Place::At(_) | Place::Everywhere => return,
        };
        let unknown = |name: &&String| !known.contains(&name.as_str());
        for name in names.iter().filter(unknown) {
            let problem = format!("is not a surface of a {}", self.name());
            report.add(key, Problem::new(problem).found(name).help(suggest(name, &known)));
        }
        if key == "edge" && !names.iter().any(|name| unknown(&name)) {
            self.check_edge(names, report);
        }
    }

    /// Reports surfaces that share no edge.
    fn check_edge(&self, names: &[String], report: &Report) {
        let help = "name two surfaces that meet: edge = [\"x-min\", \"z-min\"]";
        report.require(names.len() != 1, "edge", "is one surface, not an edge", help);
        let opposite = |name: &String| match name.split_once('-') {
            Some((axis, "min")) => format!("{axis}-max"),
            Some((axis, "max")) => format!("{axis}-min"),
            _ => String::new(),
        };
        let apart = names.iter().find(|name| names.contains(&opposite(name)));
        if let (Body::Box { .. }, Some(name)) = (self, apart) {
            let problem = format!("names '{name}' and '{}', which do not meet", opposite(name));
            report.add("edge", Problem::new(problem).help(help));
        }
    }
}

/// Names of the parts of a surface, followed by "surface" for all of it.
fn with_all(parts: &[&'static str]) -> Vec<&'static str> {
    let all = surfaces::BALL[0];
    parts.iter().copied().filter(|part| *part != all).chain([all]).collect()
}
