//! The problem on a body independent of the method: materials, supports and loads as functions of position.

use std::sync::Arc;

use cases::exact::{Contact, Exact};
use cases::scene::{Mass, Output, Place, Pod, Procedure, WallRule};
use geometry::{Point3, Vector3};
use material::{Law, LinearElastic, Prony};
use shape::Curve;

use super::file_vectors::FileVectors;
use super::tools::PlacedTool;
use crate::error::{Failure, Key};

/// A vector field of position (m); an error names the position of a value that is not finite.
pub type VectorField = Box<dyn Fn(&Point3) -> Result<Vector3, String> + Send + Sync>;
/// A scalar field of position (m).
pub type ScalarField = Box<dyn Fn(&Point3) -> Result<f64, String> + Send + Sync>;
/// A traction as a function of position (m) and outward unit normal.
pub type TractionField = Box<dyn Fn(&Point3, &Vector3) -> Result<Vector3, String> + Send + Sync>;

/// A prescribed displacement.
pub struct Support {
    /// The support's key in the scene, such as `support[0]`.
    pub key: String,
    /// The constrained part of the body.
    pub place: Place,
    /// Constrained axes among x, y, z.
    pub axes: [bool; 3],
    /// The displacement, m.
    pub value: VectorField,
    /// Factor of the displacement over time; `None` for the common growth.
    pub curve: Option<Arc<Curve>>,
    /// Start and end of the part of the loading in which it acts, a fraction in statics and s in dynamics;
    /// `None` for all of it.
    pub during: Option<[f64; 2]>,
}

/// Springs and dampers between a part of the surface and the ground.
pub struct Foundation {
    /// The key in the scene, such as `foundation[0]`.
    pub key: String,
    /// Part of the surface.
    pub place: Place,
    /// Stiffness per undeformed area, Pa/m.
    pub stiffness: f64,
    /// Damping per undeformed area, Pa s/m.
    pub damping: f64,
    /// Whether springs and dampers act along the undeformed normal only.
    pub along_normal: bool,
}

/// Directions of a material.
pub struct Directions {
    /// The material's key in the scene, such as `material`.
    pub key: String,
    /// Along the fibres.
    pub fibers: Direction,
    /// Within a sheet across the fibres, if given.
    pub sheets: Option<Direction>,
}

/// A direction in the undeformed body.
pub enum Direction {
    /// A vector of any length at each point.
    Field(VectorField),
    /// Vectors of the body's mesh file.
    File(Box<FileVectors>),
    /// By the depth of a wall, for which each method solves Laplace's equation.
    Wall(WallRule),
}

/// The kind of a load, with its field.
pub enum Applied {
    /// On a part of the surface.
    Surface(SurfaceLoad),
    /// Force per reference volume, N/m^3, everywhere.
    Body(VectorField),
    /// The same force at each of some points.
    Points {
        /// The points in the undeformed body, m.
        at: Vec<Point3>,
        /// The force at each, N.
        force: Vector3,
    },
}

/// The kind of a load on a surface, with its field.
pub enum SurfaceLoad {
    /// Force per reference area, Pa.
    Traction(TractionField),
    /// Pressure against the outward normal, Pa.
    Pressure(ScalarField),
    /// Force on the whole place, evenly per reference area, N.
    Force(Vector3),
}

/// A load and the part of the body it acts on.
pub struct Load {
    /// The load's key in the scene, such as `load[0]`.
    pub key: String,
    /// The loaded part of the surface; ignored by a body force and by forces at points.
    pub place: Place,
    /// The load's kind and field.
    pub applied: Applied,
    /// Whether the load varies with position.
    pub varies: bool,
    /// Whether the load depends on the outward normal.
    pub along_normal: bool,
    /// Whether a pressure or a traction acts on the deformed surface.
    pub follows: bool,
    /// Factor of the load over time; `None` for the common growth.
    pub curve: Option<Arc<Curve>>,
}

/// A problem without its method: materials, supports, loads, tools and known solutions.
pub struct Setup {
    /// One law per region of the mesh.
    pub laws: Vec<Law>,
    /// Small-strain limit of each law: the law itself in a linear procedure.
    pub materials: Vec<LinearElastic>,
    /// Density by region, kg/m^3; `None` if the scene gives none.
    pub densities: Vec<Option<f64>>,
    /// Stress relaxation by region; `None` for an elastic material.
    pub relaxation: Vec<Option<Prony>>,
    /// Directions of the material by region; `None` for a law that does not depend on them.
    pub directions: Vec<Option<Directions>>,
    /// Active stress along the fibre by region, Pa; empty if no region contracts.
    pub active: Vec<f64>,
    /// Factor of the active stress over time by region; `None` for the common growth.
    pub active_curves: Vec<Option<Arc<Curve>>>,
    /// Essential conditions.
    pub supports: Vec<Support>,
    /// Loads.
    pub loads: Vec<Load>,
    /// Springs and dampers.
    pub foundations: Vec<Foundation>,
    /// Points and surfaces of which results are reported.
    pub output: Output,
    /// Rigid tools.
    pub tools: Vec<PlacedTool>,
    /// Solution procedure.
    pub procedure: Procedure,
    /// Mass matrix for vibrations, a property of the method.
    pub mass: Option<Mass>,
    /// Known results of a contact problem, if the scene names a contact solution.
    pub contact: Option<Contact>,
    /// The exact field, if the scene names one.
    pub exact: Option<Box<dyn Exact>>,
    /// Reduction of the method to a few deformations.
    pub pod: Option<Pod>,
    /// The problems from whose solutions the deformations are learnt.
    pub training: Vec<Setup>,
}

impl Setup {
    /// Returns the density by region, kg/m^3.
    ///
    /// # Errors
    /// Returns an error if a region's material has no density.
    pub fn density(&self) -> Result<Vec<f64>, Failure> {
        self.densities.iter().copied().collect::<Option<_>>().ok_or_else(|| {
            let key = Key::Scene("material.density".into());
            Failure::input(
                key,
                "is missing, but the procedure needs the mass",
                "add density = \"1000 kg/m^3\"",
            )
        })
    }

    /// Returns, for each region, the index of the first region with the same material.
    pub(crate) fn alike(&self) -> Vec<u16> {
        let same =
            |a: usize, b: usize| self.laws[a] == self.laws[b] && self.relaxation[a] == self.relaxation[b];
        let first = |region: usize| (0..region).find(|&other| same(other, region)).unwrap_or(region);
        (0..self.laws.len()).map(|region| first(region) as u16).collect()
    }

    /// Whether a single linear problem is solved.
    pub fn is_linear(&self) -> bool {
        matches!(self.procedure, Procedure::Prepare | Procedure::Linear { .. } | Procedure::Modes { .. })
    }

    /// Whether Newton's method solves the problem.
    pub fn solves_by_newton(&self) -> bool {
        matches!(self.procedure, Procedure::Static(_) | Procedure::ImplicitDynamic(_))
    }

    /// Describes in the plan which pressures follow the deformed surface and which do not, and which
    /// tractions follow its area; empty without any.
    pub fn pressures(&self) -> String {
        let of = |pressure: bool, follows: bool| -> Vec<&str> {
            let is = |load: &&Load| match load.applied {
                Applied::Surface(SurfaceLoad::Pressure(_)) => pressure,
                Applied::Surface(SurfaceLoad::Traction(_)) => !pressure,
                _ => false,
            };
            let of_kind = self.loads.iter().filter(is).filter(|load| load.follows == follows);
            of_kind.map(|load| load.key.as_str()).collect()
        };
        [
            (of(true, true), "pressure on the deformed surface"),
            (of(true, false), "pressure on the undeformed surface"),
            (of(false, true), "traction on the deformed area"),
        ]
        .into_iter()
        .filter(|(keys, _)| !keys.is_empty())
        .map(|(keys, what)| format!("; {what}: {}", keys.join(", ")))
        .collect()
    }

    /// Names in the plan the springs and dampers on surfaces; empty without any.
    pub fn springs(&self) -> String {
        let keys: Vec<&str> = self.foundations.iter().map(|foundation| foundation.key.as_str()).collect();
        if keys.is_empty() { String::new() } else { format!("; springs and dampers: {}", keys.join(", ")) }
    }

    /// Whether the stress depends on the strain history.
    pub fn relaxes(&self) -> bool {
        self.relaxation.iter().any(Option::is_some)
    }

    /// Keys of the supports, loads, tools and materials that follow a curve of their own.
    pub fn curved(&self) -> Vec<String> {
        let supports = self.supports.iter().map(|support| (support.key.clone(), &support.curve));
        let loads = self.loads.iter().map(|load| (load.key.clone(), &load.curve));
        let tools = self.tools.iter().map(|tool| (tool.name.clone(), &tool.curve));
        let active = self.active_curves.iter().map(|curve| ("active stress".to_string(), curve));
        let all = supports.chain(loads).chain(tools).chain(active);
        all.filter(|(_, curve)| curve.is_some()).map(|(key, _)| key).collect()
    }

    /// Keys of the supports that act during a part of the loading.
    pub fn staged(&self) -> Vec<&str> {
        let staged = self.supports.iter().filter(|support| support.during.is_some());
        staged.map(|support| support.key.as_str()).collect()
    }

    /// Describes in the plan what follows curves, and what acts during a part of the loading; empty without
    /// any.
    pub fn curves(&self) -> String {
        let (curved, staged) = (self.curved(), self.staged());
        let mut words = String::new();
        if !curved.is_empty() {
            words += &format!("; along curves: {}", curved.join(", "));
        }
        if !staged.is_empty() {
            words += &format!("; during a part of the loading: {}", staged.join(", "));
        }
        words
    }

    /// Whether any tool has friction.
    pub fn has_friction(&self) -> bool {
        self.tools.iter().any(|placed| placed.tool.law().friction() > 0.0)
    }
}
