//! Exact solutions of linear elasticity, each a closed form in three dimensions: what the solvers are judged by.
//!
//! Every solution gives displacement, displacement gradient, stress and body force at a point, and is built either
//! by its own constructor or by name with a list of parameters ([`exact_by_name`]). Stresses follow from the
//! gradients by Hooke's law written out here, so that a solver's material never judges itself.
//!
//! A solution may move ([`BarWave`]), vibrate ([`LameCube`], [`RollerBox`]) or relax ([`RelaxingCompression`]): it is a field at one time and gives that at any other.
//!
//! Beside them stand large strains ([`Homogeneous`], [`FiniteBending`], of the laws in [`Hyperelastic`]), contact
//! ([`Hertz`]) and a period ([`VibratingCantilever`]).

mod affine;
mod bar_wave;
mod cantilever;
mod elastic;
mod finite_bending;
mod hertz;
mod homogeneous;
mod hyperelastic;
mod lame_cube;
mod params;
mod polylog;
mod pure_bending;
mod quadratic_patch;
mod relaxing_compression;
mod rigid;
mod roller_box;
mod saint_venant;
mod thick_sphere;
mod uniaxial_compression;
mod vibrating_cantilever;

pub use affine::Affine;
pub use bar_wave::BarWave;
pub use cantilever::CantileverPlaneStrain;
pub use elastic::Elastic;
pub use finite_bending::FiniteBending;
pub use hertz::Hertz;
pub use homogeneous::Homogeneous;
pub use hyperelastic::Hyperelastic;
pub use lame_cube::LameCube;
pub use params::{ExactError, Parameter, Params};
pub use pure_bending::PureBending;
pub use quadratic_patch::QuadraticPatch;
pub use relaxing_compression::RelaxingCompression;
pub use rigid::Rigid;
pub use roller_box::RollerBox;
pub use saint_venant::SaintVenantFlexure;
pub use thick_sphere::ThickSphere;
pub use uniaxial_compression::UniaxialCompression;
pub use vibrating_cantilever::VibratingCantilever;

use catalogue::nearest;
use params::Values;

/// A position in the reference configuration, in metres.
pub type Point3 = nalgebra::Point3<f64>;
/// A displacement (m), a normal (-), a traction (Pa) or a body force (N/m^3).
pub type Vector3 = nalgebra::Vector3<f64>;
/// A displacement gradient (-) or a stress (Pa).
pub type Matrix3 = nalgebra::Matrix3<f64>;

/// A displacement field that solves the equations of linear elasticity exactly.
pub trait Exact: Send + Sync {
    /// The material the field solves for.
    fn elastic(&self) -> Elastic;

    /// Displacement `u`, m.
    fn displacement(&self, x: &Point3) -> Vector3;

    /// Displacement gradient `H_ij = du_i / dx_j`, (3, 3), dimensionless.
    fn gradient(&self, x: &Point3) -> Matrix3;

    /// Cauchy stress, (3, 3), Pa; by Hooke's law from the gradient unless a solution knows better.
    fn stress(&self, x: &Point3) -> Matrix3 {
        self.elastic().stress(&self.gradient(x))
    }

    /// Body force `b = -div sigma`, N/m^3; none unless a solution needs one. Of a motion it is that of inertia, `-rho u''`.
    fn body_force(&self, _x: &Point3) -> Vector3 {
        Vector3::zeros()
    }

    /// Traction `sigma n` on a surface of outward unit normal `n`, Pa.
    fn traction(&self, x: &Point3, normal: &Vector3) -> Vector3 {
        self.stress(x) * normal
    }

    /// The field at another time (s) since its start, for a solution that moves or relaxes; one made by name is at time 0.
    fn at(&self, _time: f64) -> Option<Box<dyn Exact>> {
        None
    }

    /// What is known of free vibrations, where the solution is one.
    fn vibrations(&self) -> Option<&dyn Vibrations> {
        None
    }
}

/// Free vibrations of a body.
pub trait Vibrations {
    /// Angular frequency of the solution's own field, rad/s.
    fn omega(&self) -> f64;

    /// All modes of that frequency at a point, linearly independent, of any size.
    fn shapes(&self, x: &Point3) -> Vec<Vector3>;

    /// The lowest `count` angular frequencies of the body, ascending and each as often as it has modes, rad/s; `None` where
    /// not all are known.
    fn lowest(&self, count: usize) -> Option<Vec<f64>>;
}

type Build = fn(Elastic, &Values) -> Result<Box<dyn Exact>, ExactError>;

/// Name, parameters and constructor of every solution.
const SOLUTIONS: [(&str, &[Parameter], Build); 12] = [
    ("affine", affine::PARAMETERS, affine::build),
    ("quadratic-patch", quadratic_patch::PARAMETERS, quadratic_patch::build),
    ("pure-bending", pure_bending::PARAMETERS, pure_bending::build),
    ("cantilever-plane-strain", cantilever::PARAMETERS, cantilever::build),
    ("saint-venant-flexure", saint_venant::PARAMETERS, saint_venant::build),
    ("uniaxial-compression", uniaxial_compression::PARAMETERS, uniaxial_compression::build),
    ("thick-sphere", thick_sphere::PARAMETERS, thick_sphere::build),
    ("rigid", rigid::PARAMETERS, rigid::build),
    ("bar-wave", bar_wave::PARAMETERS, bar_wave::build),
    ("relaxing-compression", relaxing_compression::PARAMETERS, relaxing_compression::build),
    ("lame-cube", lame_cube::PARAMETERS, lame_cube::build),
    ("roller-box", roller_box::PARAMETERS, roller_box::build),
];

fn entry(name: &str) -> Result<&'static (&'static str, &'static [Parameter], Build), ExactError> {
    SOLUTIONS.iter().find(|(known, ..)| *known == name).ok_or_else(|| {
        let known: Vec<&'static str> = exact_names().collect();
        ExactError::UnknownSolution {
            name: name.into(),
            nearest: nearest(name, known.iter().copied()),
            known: known.join(", "),
        }
    })
}

/// Names of all solutions, in the order tables list them.
pub fn exact_names() -> impl Iterator<Item = &'static str> {
    SOLUTIONS.iter().map(|(name, ..)| *name)
}

/// The parameters a solution takes beside Young's modulus and Poisson's ratio.
pub fn exact_parameters(name: &str) -> Result<&'static [Parameter], ExactError> {
    entry(name).map(|(_, parameters, _)| *parameters)
}

/// The solution of that name for a material and its own parameters.
pub fn exact_by_name(name: &str, params: &Params) -> Result<Box<dyn Exact>, ExactError> {
    let (name, parameters, build) = entry(name)?;
    let elastic = Elastic::new(params.young, params.poisson)?;
    build(elastic, &Values::resolve(name, parameters, params)?)
}
