//! A scene as the program works with it: every quantity an f64 in SI, every choice an enum.

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
    /// One line that says what the scene is.
    pub title: String,
    /// Where the case and its reference come from.
    pub source: Option<String>,
    /// What the scene is for.
    pub purpose: Purpose,
    /// The published comparison that the results are set against.
    pub published: Option<Publication>,
    /// The body in its undeformed state.
    pub body: Body,
    /// The material wherever no region has its own.
    pub material: Material,
    /// Parts of the body with a material of their own; later ones win.
    pub regions: Vec<MaterialRegion>,
    /// Prescribed displacements.
    pub supports: Vec<Support>,
    /// Given loads.
    pub loads: Vec<Load>,
    /// Rigid tools.
    pub tools: Vec<Tool>,
    /// How the scene is stepped.
    pub procedure: Procedure,
    /// At least one, with unique ids.
    pub methods: Vec<Method>,
    /// What to report.
    pub output: Output,
    /// What to compare with.
    pub reference: Option<Reference>,
    /// What must hold.
    pub checks: Vec<Check>,
    /// The axis of a study that drives the scene and its value there; `None` for the scene as it is in its file.
    pub varied: Option<(String, f64)>,
    pub(crate) origin: Origin,
}

impl Scene {
    /// Name of the file, as given to [`load`](super::load) or [`parse`](super::parse).
    pub fn file(&self) -> &str {
        self.origin.file()
    }

    /// The text of the file; where methods are taken from another one, what it comes to with them written out. It has all
    /// that the scene says, but for the meshes it names.
    pub fn text(&self) -> &str {
        self.origin.text()
    }

    /// Every material with its key: that of the body, then those of the regions in their order.
    pub fn materials(&self) -> impl Iterator<Item = (String, &Material)> {
        let regions = self.regions.iter().enumerate();
        std::iter::once(("material".to_string(), &self.material))
            .chain(regions.map(|(i, r)| (format!("region[{i}].material"), &r.material)))
    }

    /// The method of that id.
    pub fn method(&self, id: &str) -> Option<&Method> {
        self.methods.iter().find(|method| method.id == id)
    }

    /// Whether something moves the body: a load, a tool or a support that is not held still. Vibrations are free, and a
    /// scene that only prepares moves nothing.
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

    /// An error about `key`, such as `support[0].where` or `method[1].size.nodes` (tables of a list count from 0), found
    /// only while running: an empty region, an inverted element. It names file, line and value.
    pub fn error(&self, kind: ErrorKind, key: &str, problem: &str, help: Option<&str>) -> SceneError {
        let mut bad = Problem::new(problem);
        bad.help = help.map(str::to_string);
        self.origin.error(kind, key, bad)
    }
}

/// Parts of a surface, and "surface" for all of it.
pub(crate) fn with_all(parts: &[&'static str]) -> Vec<&'static str> {
    let all = surfaces::BALL[0];
    parts.iter().copied().filter(|part| *part != all).chain([all]).collect()
}

/// Bodies; lengths in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// An axis-parallel box.
    Box {
        /// Lower corner.
        min: [f64; 3],
        /// Upper corner.
        max: [f64; 3],
    },
    /// About the z axis, the base at z = 0.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Height.
        height: f64,
    },
    /// About the origin.
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
        /// Only x, y, z >= 0.
        octant: bool,
    },
    /// The kidney, by its map from the ball.
    Kidney {
        /// Only z >= 0, in cells drawn together around the z axis.
        half: bool,
        /// These cells are drawn together less.
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

    /// Names of the parts of its surface; `None` where only the mesh file knows them. "surface" is all of it.
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

/// A part of the body with a material of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialRegion {
    /// Its name in tables.
    pub name: String,
    /// Where it is; names are those of volumes in the mesh file.
    pub place: Place,
    /// Its material.
    pub material: Material,
}

/// Where something acts.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// On named parts.
    On(Vec<String>),
    /// Where comparisons hold.
    Where(Region),
    /// Everywhere (body forces).
    Everywhere,
}

/// Prescribed displacement of a part of the body.
#[derive(Clone, Debug)]
pub struct Support {
    /// Where.
    pub place: Place,
    /// Along x, y, z; free where `None`. At least one is prescribed.
    pub motion: [Option<Prescribed>; 3],
}

/// A given load.
#[derive(Clone, Debug)]
pub struct Load {
    /// Where.
    pub place: Place,
    /// What.
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
    /// Whether it is another one from point to point.
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
