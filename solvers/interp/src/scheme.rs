//! Transfer schemes as values, as named in a scene file and swept in a study.
//!
//! Each scheme is a file with its function, a type that implements [`Transfer`] and its entry, and a line in
//! the list below.

use catalogue::{Dimension, Entry, Parameter, Problem, Range, Values};
use efg::Support;
use geometry::Mesh;
use shape::{GradRows, Point3, PointRows};

use crate::{InterpError, SCHEMES, Scheme, TransferInfo};

/// A transfer scheme that scene files can name.
pub type SchemeEntry = Entry<fn(&Values) -> Result<Scheme, Problem>>;

/// Source of a field: its nodes, and the mesh of the nodes if there is a mesh.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    /// Node positions, m.
    pub nodes: &'a [Point3],
    mesh: Option<&'a Mesh>,
}

impl<'a> Source<'a> {
    /// Returns the mesh, or an error if there is none or if its points differ from the nodes.
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

/// Behaviour of a scheme.
pub(crate) trait Transfer {
    /// Returns the name of the entry.
    fn name(&self) -> &'static str;

    /// Degree of the polynomials that are transferred exactly; `None` if not even constants are.
    fn exact_degree(&self) -> Option<usize>;

    /// Whether a target at a node takes that node's value.
    fn interpolates(&self) -> bool;

    /// Builds the table from the nodes to `targets` (m).
    fn rows(&self, source: Source, targets: &[Point3]) -> Result<(PointRows, TransferInfo), InterpError>;

    /// Builds the table with gradients (1/m), or returns an error if there are none in closed form.
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

        /// Entries of all schemes, in the order of tables. Defaults are those of the transfer study of the
        /// kidney.
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
    /// Returns every scheme with its default parameters, in the order of tables.
    pub fn all() -> impl Iterator<Item = Scheme> {
        // No parameter of a scheme is required.
        SCHEMES.iter().filter_map(|entry| (entry.build)(&Values::new(entry.parameters)).ok())
    }

    /// Returns the name used in scene files and tables.
    pub fn name(&self) -> &'static str {
        self.transfer().name()
    }

    /// Returns the scheme with this name and default parameters.
    pub fn from_name(name: &str) -> Option<Scheme> {
        Scheme::all().find(|scheme| scheme.name() == name)
    }

    /// Degree of the polynomials that are transferred exactly: 0, 1 or 2; `None` if not even constants are.
    pub fn exact_degree(&self) -> Option<usize> {
        self.transfer().exact_degree()
    }

    /// Whether a target at a node takes that node's value.
    pub fn interpolates(&self) -> bool {
        self.transfer().interpolates()
    }

    /// Builds the table from `nodes` to `targets` (m). Only [`Barycentric`](crate::Barycentric) uses `mesh`,
    /// whose points must equal `nodes`.
    ///
    /// # Errors
    /// Nodes, parameters or a mesh that the scheme refuses.
    pub fn rows(
        &self,
        nodes: &[Point3],
        mesh: Option<&Mesh>,
        targets: &[Point3],
    ) -> Result<(PointRows, TransferInfo), InterpError> {
        self.transfer().rows(Source { nodes, mesh }, targets)
    }

    /// Builds the table with the gradients (1/m) of its rows, for strain and stress at `targets` (m). Moving
    /// least squares, radial bases and barycentric interpolation (constant in every tetrahedron) have
    /// gradients in closed form.
    ///
    /// # Errors
    /// The errors of [`Scheme::rows`], and [`InterpError::NoGradient`] for the other schemes: they have no
    /// gradient in closed form, or none at the nodes.
    pub fn grad_rows(
        &self,
        nodes: &[Point3],
        mesh: Option<&Mesh>,
        targets: &[Point3],
    ) -> Result<(GradRows, TransferInfo), InterpError> {
        self.transfer().grad_rows(Source { nodes, mesh }, targets)
    }
}

/// Returns the rule of support radii that are a multiple of the mean spacing.
pub(crate) fn scaled(factor: f64) -> Support {
    Support::Dilatation { factor }
}

/// Returns the parameter of this multiple.
pub(crate) const fn support_scale(default: f64) -> Parameter {
    Parameter::default(
        "support_scale",
        Dimension::None,
        default,
        "ratio of support radius to mean node spacing",
    )
    .within(Range::Positive)
}
