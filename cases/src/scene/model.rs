//! A scene as the program uses it: every quantity is an `f64` in SI, every choice an enum.

use super::document::Origin;
use catalogue::Problem;
use geometry::generate::surfaces;

use super::error::{ErrorKind, SceneError};
use super::field::{Prescribed, ScalarField, VectorField};
use super::material::Material;
use super::method::{MeshFile, Method};
use super::output::{Check, Output, Reference};
use super::procedure::Procedure;
use super::purpose::{Publication, Purpose};
use super::region::Region;
use super::tool::Tool;

/// A checked scene.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Title of the scene in one line.
    pub title: String,
    /// Source of the case and its reference.
    pub source: Option<String>,
    /// Purpose of the scene.
    pub purpose: Purpose,
    /// Published comparison that the results are compared with.
    pub published: Option<Publication>,
    /// The body in its undeformed state.
    pub body: Body,
    /// Material of the body outside the regions with their own material.
    pub material: Material,
    /// Parts of the body with their own material; in an overlap the later region counts.
    pub regions: Vec<MaterialRegion>,
    /// Prescribed displacements.
    pub supports: Vec<Support>,
    /// Given loads.
    pub loads: Vec<Load>,
    /// Rigid tools.
    pub tools: Vec<Tool>,
    /// Solution procedure.
    pub procedure: Procedure,
    /// Methods to run: at least one, with unique ids.
    pub methods: Vec<Method>,
    /// Requested output.
    pub output: Output,
    /// Reference that results are compared with.
    pub reference: Option<Reference>,
    /// Bounds on the results.
    pub checks: Vec<Check>,
    /// Axis of a study along which the scene is varied, with its value; `None` for the scene of the file.
    pub varied: Option<(String, f64)>,
    pub(crate) origin: Origin,
}

impl Scene {
    /// Name of the file, as given to [`load`](super::load) or [`parse`](super::parse).
    pub fn file(&self) -> &str {
        self.origin.file()
    }

    /// The text of the file; with shared methods, the equivalent text in which these are written out. It
    /// contains the whole scene except the meshes that it names.
    pub fn text(&self) -> &str {
        self.origin.text()
    }

    /// Every material with its key: the body's material, then those of the regions in their order.
    pub fn materials(&self) -> impl Iterator<Item = (String, &Material)> {
        let regions = self.regions.iter().enumerate();
        std::iter::once(("material".to_string(), &self.material))
            .chain(regions.map(|(i, r)| (format!("region[{i}].material"), &r.material)))
    }

    /// The method with the id `id`.
    pub fn method(&self, id: &str) -> Option<&Method> {
        self.methods.iter().find(|method| method.id == id)
    }

    /// Whether the body moves: by a load, a tool, or a support with a prescribed displacement other than
    /// zero. Also true for free vibrations and for scenes that only prepare, which need no load.
    pub fn is_moved(&self) -> bool {
        let still = |p: &Prescribed| matches!(p, Prescribed::Field(ScalarField::Constant(0.0)));
        let moves = |support: &Support| !support.motion.iter().flatten().all(still);
        let unsolved = matches!(self.procedure, Procedure::Modes { .. } | Procedure::Prepare);
        unsolved || !self.loads.is_empty() || !self.tools.is_empty() || self.supports.iter().any(moves)
    }

    /// Whether the file has `key`.
    pub fn has(&self, key: &str) -> bool {
        self.origin.has(key)
    }

    /// An error at `key`, such as `support[0].where` or `method[1].size.nodes` (tables of a list count from
    /// 0), that is found only while running: an empty region, an inverted element. The error names file, line
    /// and value.
    pub fn error(&self, kind: ErrorKind, key: &str, problem: &str, help: Option<&str>) -> SceneError {
        let mut bad = Problem::new(problem);
        bad.help = help.map(str::to_string);
        self.origin.error(kind, key, bad)
    }
}

/// Names of the parts of a surface, followed by "surface" for all of it.
pub(crate) fn with_all(parts: &[&'static str]) -> Vec<&'static str> {
    let all = surfaces::BALL[0];
    parts.iter().copied().filter(|part| *part != all).chain([all]).collect()
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

impl Body {
    /// The name of the shape in files and tables.
    pub fn name(&self) -> &'static str {
        match self {
            Body::Box { .. } => "box",
            Body::Cylinder { .. } => "cylinder",
            Body::Ball { .. } => "ball",
            Body::SphereShell { .. } => "sphere-shell",
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
            Body::SphereShell { octant: false, .. } => (&surfaces::SHELL, &[]),
            Body::SphereShell { octant: true, .. } => (&surfaces::SHELL, &surfaces::OCTANT),
            Body::File(_) => return None,
        };
        Some([with_all(parts), further.to_vec()].concat())
    }
}

/// A part of the body with its own material.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialRegion {
    /// Name in tables.
    pub name: String,
    /// Selection of its cells; names refer to volumes in the mesh file.
    pub place: Place,
    /// Material of the region.
    pub material: Material,
}

/// Selection of a part of the body.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// Named parts.
    On(Vec<String>),
    /// Points that satisfy comparisons.
    Where(Region),
    /// Everywhere (body forces).
    Everywhere,
}

/// Prescribed displacement of a part of the body.
#[derive(Clone, Debug)]
pub struct Support {
    /// Constrained part of the body.
    pub place: Place,
    /// Prescribed displacements along x, y, z; `None` for a free axis. At least one is prescribed.
    pub motion: [Option<Prescribed>; 3],
}

/// A load.
#[derive(Clone, Debug)]
pub struct Load {
    /// Loaded part of the body.
    pub place: Place,
    /// Kind and value.
    pub kind: LoadKind,
}

/// Kinds of loads.
#[derive(Clone, Debug)]
pub enum LoadKind {
    /// Force per area, in pascals.
    Traction(VectorField),
    /// Pressure along the inner normal, in pascals.
    Pressure(ScalarField),
    /// Force per volume, in newtons per cubic metre.
    Body(VectorField),
}

impl LoadKind {
    /// Whether the load varies in space.
    pub fn varies(&self) -> bool {
        let constant = |field: &ScalarField| matches!(field, ScalarField::Constant(_));
        match self {
            LoadKind::Traction(VectorField::Exact) | LoadKind::Body(VectorField::Exact) => true,
            LoadKind::Traction(VectorField::Components(c)) | LoadKind::Body(VectorField::Components(c)) => {
                !c.iter().all(constant)
            }
            LoadKind::Pressure(field) => !constant(field),
        }
    }
}
