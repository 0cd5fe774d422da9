//! Internal forces of a body, computed by the fastest kernel that fits its table and laws.

use lanes::LanePath;
use material::Material as _;
use shape::{Layout, Matrix3, Vector3};

use super::body::ExplicitBody;
use super::cells::Cells;
use super::moduli::LaneLaw;
use super::quadratic::Quadratic;
use super::rows::Ragged;
use super::tet4::Tet4;
use super::trilinear::Trilinear;
use crate::error::{ExplicitError, InvertedPoint};
use crate::kernel::{Engine, Kernel, KernelInfo};
use crate::plain;

/// Evaluator of the internal force `f_I(u) = dE/du_I` of a body, for many evaluations.
pub struct InternalForce<'a> {
    body: ExplicitBody<'a>,
    /// Lane kernel; `None` for the plain loop.
    engine: Option<Box<dyn Engine>>,
    path: LanePath,
}

fn boxed<E: Engine + 'static>(engine: E) -> Box<dyn Engine> {
    Box::new(engine)
}

impl<'a> InternalForce<'a> {
    /// Chooses the kernel from the layout of the table and the laws. Lane kernels run on `path`.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::Length`] or [`ExplicitError::NoLaw`] if the parts of the body do not fit together.
    pub fn new(body: ExplicitBody<'a>, path: LanePath) -> Result<InternalForce<'a>, ExplicitError> {
        body.check()?;
        let laws = || LaneLaw::of_regions(&body);
        let element = laws().and_then(|laws| match body.volume.layout() {
            Layout::LinearTetrahedra => Tet4::new(&body, laws).map(boxed),
            Layout::Cells { nodes: 8, points: 8 } => Cells::<Trilinear, 8, 8>::new(&body, laws).map(boxed),
            Layout::Cells { nodes: 10, points: 4 } => quadratic::<10, 4>(&body, laws),
            Layout::Cells { nodes: 20, points: 27 } => quadratic::<20, 27>(&body, laws),
            Layout::Cells { nodes: 20, points: 8 } => quadratic::<20, 8>(&body, laws),
            Layout::Cells { .. } | Layout::General => None,
        });
        let engine = element.or_else(|| match body.groups {
            None => Ragged::new(&body, laws()?).map(boxed),
            Some(_) => None,
        });
        Ok(InternalForce { body, engine, path })
    }

    /// Uses the plain loop for any table: the reference of the other kernels.
    ///
    /// # Errors
    ///
    /// As [`InternalForce::new`].
    pub fn plain(body: ExplicitBody<'a>) -> Result<InternalForce<'a>, ExplicitError> {
        body.check()?;
        Ok(InternalForce { body, engine: None, path: LanePath::PORTABLE })
    }

    /// The body.
    pub fn body(&self) -> ExplicitBody<'a> {
        self.body
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.body.volume.rows().node_count()
    }

    /// Returns the chosen kernel and its instruction set.
    pub fn info(&self) -> KernelInfo {
        let kernel = self.engine.as_ref().map_or(Kernel::Plain, |engine| engine.kernel());
        KernelInfo { kernel, path: kernel.is_parallel().then_some(self.path) }
    }

    /// Requested instruction set; the plain loop does not use it.
    pub fn path(&self) -> LanePath {
        self.path
    }

    /// Computes the internal forces (N) at nodal displacements `u` (m). After an error, `f` contains no valid
    /// forces.
    ///
    /// # Errors
    ///
    /// [`InvertedPoint`] if `J` is not positive at a point.
    pub fn evaluate(&mut self, u: &[Vector3], f: &mut [Vector3]) -> Result<(), InvertedPoint> {
        assert_eq!((u.len(), f.len()), (self.node_count(), self.node_count()), "one vector per node");
        let Some(engine) = &mut self.engine else {
            return plain_forces(&self.body, u, f);
        };
        if !engine.forces(self.path, u, f) {
            plain::check(self.body.volume, u)?;
            // A kernel and the plain loop may round `J` to different sides of zero: the plain loop decides.
            plain_forces(&self.body, u, f)?;
        }
        Ok(())
    }

    /// Computes the strain energy (J) at nodal displacements `u` (m) by the plain loop.
    ///
    /// # Errors
    ///
    /// [`InvertedPoint`] if `J` is not positive at a point.
    pub fn energy(&self, u: &[Vector3]) -> Result<f64, InvertedPoint> {
        let density = |q: usize, h: &Matrix3| self.body.law(q).energy(h);
        match self.body.groups {
            None => plain::energy(self.body.volume, density, u),
            Some(groups) => plain::dilated_energy(self.body.volume, groups, density, u),
        }
    }
}

fn quadratic<const N: usize, const Q: usize>(
    body: &ExplicitBody,
    laws: Vec<LaneLaw>,
) -> Option<Box<dyn Engine>> {
    Cells::<Quadratic<N, Q>, N, Q>::new(body, laws).map(boxed)
}

fn plain_forces(body: &ExplicitBody, u: &[Vector3], f: &mut [Vector3]) -> Result<(), InvertedPoint> {
    let stress = |q: usize, h: &Matrix3| body.law(q).stress(h);
    match body.groups {
        None => plain::forces(body.volume, stress, u, f),
        Some(groups) => plain::dilated_forces(body.volume, groups, stress, u, f),
    }
}
