//! What acts on a body: materials, supports and loads, with their fields as functions of position. Method-free.

use cases::exact::{Contact, Exact};
use geometry::{Point3, Vector3};
use material::{Law, LinearElastic};
use statics::StaticParams;

use crate::explicit::ExplicitParams;
use crate::in_time::InTimeParams;
use crate::modes::ModesParams;
use crate::outcome::LoadStep;
use crate::place::Place;
use crate::tools::SetTool;

/// A vector field of position (m); an error says where it was not finite.
pub type VectorField = Box<dyn Fn(&Point3) -> Result<Vector3, String> + Send + Sync>;
/// A scalar field of position (m).
pub type ScalarField = Box<dyn Fn(&Point3) -> Result<f64, String> + Send + Sync>;
/// A traction as a function of position (m) and outward unit normal.
pub type TractionField = Box<dyn Fn(&Point3, &Vector3) -> Result<Vector3, String> + Send + Sync>;

/// A prescribed displacement.
pub struct Held {
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
pub struct Acting {
    /// The load's key in the scene, such as `load[0]`.
    pub key: String,
    /// Where; ignored by a body force.
    pub place: Place,
    /// What.
    pub applied: Applied,
}

/// Everything that does not depend on the method.
pub struct Setup {
    /// One law per region of the mesh.
    pub laws: Vec<Law>,
    /// The limit of each law at small strain: the law itself in a linear procedure.
    pub materials: Vec<LinearElastic>,
    /// Supports.
    pub held: Vec<Held>,
    /// Loads.
    pub loads: Vec<Acting>,
    /// Rigid tools.
    pub tools: Vec<SetTool>,
    /// Told every converged step of a static path, for those who wait.
    pub watch: Option<fn(&LoadStep)>,
    /// Whether nothing is solved.
    pub prepare_only: bool,
    /// Which vibrations are asked for; `None` for another procedure.
    pub modes: Option<ModesParams>,
    /// How a static procedure is stepped; `None` for another one.
    pub statics: Option<StaticParams>,
    /// Whether a static path that stalls goes on by dynamic relaxation.
    pub relax: bool,
    /// How explicit dynamics is stepped; `None` for another procedure.
    pub explicit: Option<ExplicitParams>,
    /// How implicit dynamics is stepped; `None` for another procedure.
    pub in_time: Option<InTimeParams>,
    /// What is known of a contact, if the scene names a solution of one.
    pub contact: Option<Contact>,
    /// The exact field, if the scene names one.
    pub exact: Option<Box<dyn Exact>>,
}

impl Setup {
    /// Whether one linear solve is all there is.
    pub fn is_linear(&self) -> bool {
        self.statics.is_none() && self.explicit.is_none() && self.in_time.is_none()
    }

    /// Whether the stress depends on the past.
    pub fn relaxes(&self) -> bool {
        self.in_time.as_ref().is_some_and(|params| params.relaxation.iter().any(Option::is_some))
    }
}
