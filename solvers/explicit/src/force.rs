//! Internal forces of a body, computed by the fastest kernel that fits its table and laws.

use lanes::LanePath;
use material::Material as _;
use shape::{Layout, Matrix3, Vector3};

use super::body::ExplicitBody;
use super::cells::Cells;
use super::moduli::LaneLaw;
use super::one_point::OnePoint;
use super::quadratic::{Quadratic, Sums};
use super::rows::Ragged;
use super::tet4::Tet4;
use super::trilinear::Trilinear;
use crate::error::{ExplicitError, InvertedPoint};
use crate::kernel::{Engine, Kernel, KernelInfo, Precision};
use crate::plain;

/// Evaluator of the internal force `f_I(u) = dE/du_I` of a body, for many evaluations.
pub struct InternalForce<'a> {
    body: ExplicitBody<'a>,
    /// Lane kernel; `None` for the plain loop.
    engine: Option<Box<dyn Engine>>,
    path: LanePath,
    precision: Precision,
    /// Active stress by region, Pa; empty if there is none.
    active: Vec<f64>,
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
        InternalForce::of_precision(body, path, Precision::Double)
    }

    /// Chooses the kernel as [`InternalForce::new`], for forces of the given precision.
    ///
    /// # Errors
    ///
    /// As [`InternalForce::new`]; [`ExplicitError::NoSinglePrecision`] if no kernel in single precision fits.
    pub fn of_precision(
        body: ExplicitBody<'a>,
        path: LanePath,
        precision: Precision,
    ) -> Result<InternalForce<'a>, ExplicitError> {
        body.check()?;
        let engine = match precision {
            Precision::Single => Some(elements::<f32>(&body).ok_or(ExplicitError::NoSinglePrecision)?),
            Precision::Double => elements::<f64>(&body).or_else(|| match body.groups {
                None if body.volume.hourglass().is_none() => {
                    Ragged::new(&body, LaneLaw::of_regions(&body)?).map(boxed)
                }
                _ => None,
            }),
        };
        Ok(InternalForce { body, engine, path, precision, active: Vec::new() })
    }

    /// Uses the plain loop for any table: the reference of the other kernels.
    ///
    /// # Errors
    ///
    /// As [`InternalForce::new`].
    pub fn plain(body: ExplicitBody<'a>) -> Result<InternalForce<'a>, ExplicitError> {
        body.check()?;
        let (path, precision) = (LanePath::PORTABLE, Precision::Double);
        Ok(InternalForce { body, engine: None, path, precision, active: Vec::new() })
    }

    /// The body.
    pub fn body(&self) -> ExplicitBody<'a> {
        self.body
    }

    /// Adds an active stress along the fibre (Pa, by region) to all evaluations that follow; none if empty. Its
    /// forces are computed by the plain loop, whatever the kernel.
    pub fn contract(&mut self, active: &[f64]) {
        self.active.clear();
        self.active.extend_from_slice(active);
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.body.volume.rows().node_count()
    }

    /// Returns the chosen kernel and its instruction set.
    pub fn info(&self) -> KernelInfo {
        let kernel = self.engine.as_ref().map_or(Kernel::Plain, |engine| engine.kernel());
        KernelInfo { kernel, path: kernel.is_parallel().then_some(self.path), precision: self.precision }
    }

    /// Requested instruction set; the plain loop does not use it.
    pub fn path(&self) -> LanePath {
        self.path
    }

    /// Precision of the forces.
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// Computes the internal forces (N) at nodal displacements `u` (m). After an error, `f` contains no valid
    /// forces.
    ///
    /// # Errors
    ///
    /// [`InvertedPoint`] if `J` is not positive at a point.
    pub fn evaluate(&mut self, u: &[Vector3], f: &mut [Vector3]) -> Result<(), InvertedPoint> {
        assert_eq!((u.len(), f.len()), (self.node_count(), self.node_count()), "one vector per node");
        self.passive(u, f)?;
        if self.active.is_empty() {
            return Ok(());
        }
        self.body.add_active_forces(&self.active, 1.0, u, f)
    }

    fn passive(&mut self, u: &[Vector3], f: &mut [Vector3]) -> Result<(), InvertedPoint> {
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

    /// Returns the largest difference between the internal forces of the kernel and those of the plain loop
    /// in double precision, relative to the largest force: what rounding changes.
    ///
    /// # Errors
    ///
    /// [`InvertedPoint`] if `J` is not positive at a point.
    pub fn rounding(&mut self, u: &[Vector3]) -> Result<f64, InvertedPoint> {
        let mut forces = [vec![Vector3::zeros(); u.len()], vec![Vector3::zeros(); u.len()]];
        let [found, exact] = &mut forces;
        self.passive(u, found)?;
        plain_forces(&self.body, u, exact)?;
        let largest = exact.iter().map(Vector3::amax).fold(0.0, f64::max);
        let gap = found.iter().zip(exact).map(|(a, b)| (a - *b).amax()).fold(0.0, f64::max);
        Ok(if largest > 0.0 { gap / largest } else { 0.0 })
    }

    /// Computes the strain energy (J) at nodal displacements `u` (m) by the plain loop, with the energy of an
    /// active stress.
    ///
    /// # Errors
    ///
    /// [`InvertedPoint`] if `J` is not positive at a point.
    pub fn energy(&self, u: &[Vector3]) -> Result<f64, InvertedPoint> {
        let density = |q: usize, h: &Matrix3| self.body.law(q).energy(h);
        let volume = self.body.volume;
        let seen = match self.body.groups {
            None => plain::energy(volume, density, u),
            Some(groups) => plain::dilated_energy(volume, groups, density, u),
        }?;
        let active = if self.active.is_empty() { 0.0 } else { self.body.active_energy(&self.active, u)? };
        Ok(seen + volume.hourglass_energy(|q| self.body.moduli(q), u) + active)
    }
}

/// Returns the kernel of the elements that the layout of the table names, if there is one.
fn elements<T: Sums>(body: &ExplicitBody) -> Option<Box<dyn Engine>> {
    let laws = LaneLaw::of_regions(body)?;
    match body.volume.layout() {
        Layout::LinearTetrahedra => Tet4::<T>::new(body, laws).map(boxed),
        Layout::Cells { nodes: 8, points: 1 } => OnePoint::<T>::new(body, laws).map(boxed),
        Layout::Cells { nodes: 8, points: 8 } => Cells::<T, Trilinear, 8, 8>::new(body, laws).map(boxed),
        Layout::Cells { nodes: 10, points: 4 } => quadratic::<T, 10, 4>(body, laws),
        Layout::Cells { nodes: 20, points: 27 } => quadratic::<T, 20, 27>(body, laws),
        Layout::Cells { nodes: 20, points: 8 } => quadratic::<T, 20, 8>(body, laws),
        Layout::Cells { .. } | Layout::General => None,
    }
}

fn quadratic<T: Sums, const N: usize, const Q: usize>(
    body: &ExplicitBody,
    laws: Vec<LaneLaw>,
) -> Option<Box<dyn Engine>> {
    Cells::<T, Quadratic<T, N, Q>, N, Q>::new(body, laws).map(boxed)
}

fn plain_forces(body: &ExplicitBody, u: &[Vector3], f: &mut [Vector3]) -> Result<(), InvertedPoint> {
    let stress = |q: usize, h: &Matrix3| body.law(q).stress(h);
    match body.groups {
        None => plain::forces(body.volume, stress, u, f),
        Some(groups) => plain::dilated_forces(body.volume, groups, stress, u, f),
    }?;
    body.volume.add_hourglass_forces(|q| body.moduli(q), u, f);
    Ok(())
}
