//! The schemes as values: what a scene file names and a study sweeps.
//!
//! Each scheme is a file with its function, a type that implements [`Transfer`] and its entry, and a line of the list below.

use catalogue::{Dimension, Entry, Parameter, Problem, Range, Values};
use efg::Support;
use geometry::Mesh;
use shape::{GradRows, Point3, PointRows};

use crate::{InterpError, SCHEMES, Scheme, TransferInfo};

/// A transfer scheme that scene files can name.
pub type SchemeEntry = Entry<fn(&Values) -> Result<Scheme, Problem>>;

/// Where a field is known.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    /// Its nodes, m.
    pub nodes: &'a [Point3],
    mesh: Option<&'a Mesh>,
}

impl<'a> Source<'a> {
    /// The mesh, if there is one over these nodes.
    pub fn mesh(self, scheme: &'static str) -> Result<&'a Mesh, InterpError> {
        let mesh = self.mesh.ok_or(InterpError::NeedsMesh { scheme })?;
        let points = mesh.points();
        if points != self.nodes {
            let first = points.iter().zip(self.nodes).take_while(|(a, b)| a == b).count();
            return Err(InterpError::MeshMismatch { mesh: points.len(), nodes: self.nodes.len(), first });
        }
        Ok(mesh)
    }
}

/// What a scheme does.
pub(crate) trait Transfer {
    /// The name of its entry.
    fn name(&self) -> &'static str;

    /// Degree of the polynomials it transfers exactly; none if not even constants.
    fn exact_degree(&self) -> Option<usize>;

    /// True if a target at a node gets that node's value.
    fn interpolates(&self) -> bool;

    /// The table from the nodes to `targets` (m).
    fn rows(&self, source: Source, targets: &[Point3]) -> Result<(PointRows, TransferInfo), InterpError>;

    /// The table with gradients (1/m); none unless a scheme has them in closed form.
    fn grad_rows(&self, _: Source, _: &[Point3]) -> Result<(GradRows, TransferInfo), InterpError> {
        Err(InterpError::NoGradient { scheme: self.name() })
    }
}

/// Declares the schemes, each with its type and its entries.
macro_rules! schemes {
    ($($file:ident::{$($scheme:ident [$($entry:ident),*]),*},)*) => {
        $(
            mod $file;
            pub use $file::*;
            $(
                impl From<$scheme> for Scheme {
                    fn from(scheme: $scheme) -> Scheme {
                        Scheme::$scheme(scheme)
                    }
                }
            )*
        )*

        /// A transfer scheme with its parameters.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(missing_docs)] // each is its type
        pub enum Scheme {
            $($($scheme($scheme),)*)*
        }

        /// Every scheme, in the order tables list them; defaults as in the transfer study of the kidney.
        pub static SCHEMES: &[SchemeEntry] = &[$($($($file::$entry),*),*),*];

        impl Scheme {
            fn transfer(&self) -> &dyn scheme::Transfer {
                match self {
                    $($(Scheme::$scheme(scheme) => scheme,)*)*
                }
            }
        }
    };
}

pub(crate) use schemes;

impl Scheme {
    /// Every scheme with its default parameters, in the order tables list them.
    pub fn all() -> impl Iterator<Item = Scheme> {
        // No parameter of a scheme is required.
        SCHEMES.iter().filter_map(|entry| (entry.build)(&Values::new(entry.parameters)).ok())
    }

    /// The name used in scene files and tables.
    pub fn name(&self) -> &'static str {
        self.transfer().name()
    }

    /// The scheme of that name with its default parameters.
    pub fn from_name(name: &str) -> Option<Scheme> {
        Scheme::all().find(|scheme| scheme.name() == name)
    }

    /// Degree of the polynomials it transfers exactly: 0, 1 or 2; none if not even constants.
    pub fn exact_degree(&self) -> Option<usize> {
        self.transfer().exact_degree()
    }

    /// True if a target at a node gets that node's value.
    pub fn interpolates(&self) -> bool {
        self.transfer().interpolates()
    }

    /// The table from `nodes` to `targets` (m). Only [`Barycentric`](crate::Barycentric) reads `mesh`, whose points
    /// `nodes` must be.
    pub fn rows(
        &self,
        nodes: &[Point3],
        mesh: Option<&Mesh>,
        targets: &[Point3],
    ) -> Result<(PointRows, TransferInfo), InterpError> {
        self.transfer().rows(Source { nodes, mesh }, targets)
    }

    /// The table with gradients (1/m) of its rows, for strain and stress at `targets` (m): moving least squares, radial bases
    /// and barycentric interpolation (constant in every tetrahedron) have them in closed form; the others have none, or
    /// none at the nodes, and say so.
    pub fn grad_rows(
        &self,
        nodes: &[Point3],
        mesh: Option<&Mesh>,
        targets: &[Point3],
    ) -> Result<(GradRows, TransferInfo), InterpError> {
        self.transfer().grad_rows(Source { nodes, mesh }, targets)
    }
}

/// A support radius of a multiple of the mean spacing.
pub(crate) fn scaled(factor: f64) -> Support {
    Support::Dilatation { factor }
}

/// The parameter of that radius.
pub(crate) const fn support_scale(default: f64) -> Parameter {
    Parameter::default("support_scale", Dimension::None, default, "support radius over mean spacing")
        .within(Range::Positive)
}
