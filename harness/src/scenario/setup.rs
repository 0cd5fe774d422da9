//! What acts on a body: materials, supports and loads, with their fields as functions of position. Method-free.

use cases::exact::{Contact, Exact};
use cases::scene::{Mass, Procedure};
use geometry::{Point3, Vector3};
use material::{Law, LinearElastic, Prony};

use super::PlacedTool;
use crate::Failure;
use crate::discretise::place::Place;
use crate::error::Key;

/// A vector field of position (m); an error says where it was not finite.
pub type VectorField = Box<dyn Fn(&Point3) -> Result<Vector3, String> + Send + Sync>;
/// A scalar field of position (m).
pub type ScalarField = Box<dyn Fn(&Point3) -> Result<f64, String> + Send + Sync>;
/// A traction as a function of position (m) and outward unit normal.
pub type TractionField = Box<dyn Fn(&Point3, &Vector3) -> Result<Vector3, String> + Send + Sync>;

/// A prescribed displacement.
pub struct Support {
    /// The support's key in the scene, such as `support[0]`.
    pub key: String,
    /// Where.
    pub place: Place,
    /// Which of x, y, z.
    pub axes: [bool; 3],
    /// The displacement, m.
    pub value: VectorField,
}

/// What a load applies.
pub enum Applied {
    /// Force per reference area, Pa.
    Traction(TractionField),
    /// Pressure against the outward normal, Pa.
    Pressure(ScalarField),
    /// Force per reference volume, N/m^3, everywhere.
    Body(VectorField),
}

/// A load and where it acts.
pub struct Load {
    /// The load's key in the scene, such as `load[0]`.
    pub key: String,
    /// Where; ignored by a body force.
    pub place: Place,
    /// What.
    pub applied: Applied,
    /// Whether it is another one from point to point.
    pub varies: bool,
    /// Whether it goes by the outward normal.
    pub along_normal: bool,
}

/// Everything that does not depend on the method.
pub struct Setup {
    /// One law per region of the mesh.
    pub laws: Vec<Law>,
    /// The limit of each law at small strain: the law itself in a linear procedure.
    pub materials: Vec<LinearElastic>,
    /// Density by region, kg/m^3, where the scene gives one.
    pub densities: Vec<Option<f64>>,
    /// Relaxation over time by region; none in an elastic material.
    pub relaxation: Vec<Option<Prony>>,
    /// Essential conditions.
    pub supports: Vec<Support>,
    /// Loads.
    pub loads: Vec<Load>,
    /// Parts of the surface whose mean displacement is reported.
    pub means: Vec<Place>,
    /// Rigid tools.
    pub tools: Vec<PlacedTool>,
    /// How it is solved.
    pub procedure: Procedure,
    /// The mass of vibrations, which is the method's own.
    pub mass: Option<Mass>,
    /// What is known of a contact, if the scene names a solution of one.
    pub contact: Option<Contact>,
    /// The exact field, if the scene names one.
    pub exact: Option<Box<dyn Exact>>,
}

impl Setup {
    /// Density by region, kg/m^3.
    ///
    /// # Errors
    /// A region whose material has none.
    pub fn density(&self) -> Result<Vec<f64>, Failure> {
        self.densities.iter().copied().collect::<Option<_>>().ok_or_else(|| {
            let key = Key::Scene("material.density".into());
            Failure::input(key, "is missing, and mass acts", "density = \"1000 kg/m^3\"")
        })
    }

    /// For each region the first of the same material.
    pub(crate) fn alike(&self) -> Vec<u16> {
        let same =
            |a: usize, b: usize| self.laws[a] == self.laws[b] && self.relaxation[a] == self.relaxation[b];
        let first = |region: usize| (0..region).find(|&other| same(other, region)).unwrap_or(region);
        (0..self.laws.len()).map(|region| first(region) as u16).collect()
    }

    /// Whether one linear solve is all there is.
    pub fn is_linear(&self) -> bool {
        matches!(self.procedure, Procedure::Prepare | Procedure::Linear { .. } | Procedure::Modes { .. })
    }

    /// Whether Newton's method solves it.
    pub fn solves_by_newton(&self) -> bool {
        matches!(self.procedure, Procedure::Static(_) | Procedure::ImplicitDynamic(_))
    }

    /// Whether the stress depends on the past.
    pub fn relaxes(&self) -> bool {
        self.relaxation.iter().any(Option::is_some)
    }

    /// Whether a tool rubs.
    pub fn has_friction(&self) -> bool {
        self.tools.iter().any(|placed| placed.tool.law().friction() > 0.0)
    }
}
