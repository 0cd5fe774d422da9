//! Transfer of a nodal field to other points by common schemes.
//!
//! A scheme is a table from nodes to targets. The table is built once from the positions and applied to any
//! field as a sparse product. Each scheme states the fields that it reproduces and whether it interpolates
//! ([`Scheme::exact_degree`], [`Scheme::interpolates`]); both are tested. The transpose of a table transfers
//! forces from the targets to the nodes ([`shape::Rows::apply_transposed`]). Some schemes also provide
//! gradients ([`Scheme::grad_rows`]).
//!
//! ```
//! use tissuebench_interp::{InverseDistance, Radial, Scheme};
//! use shape::{Point3, Vector3};
//! let nodes: Vec<Point3> =
//!     (0..27).map(|i| Point3::new((i % 3) as f64, (i / 3 % 3) as f64, (i / 9) as f64) * 1e-3).collect();
//! let target = [Point3::new(0.3e-3, 1.6e-3, 0.5e-3)];
//! let field: Vec<Vector3> = nodes.iter().map(|x| 0.1 * x.coords).collect();
//! let error = |scheme: Scheme| -> Result<f64, tissuebench_interp::InterpError> {
//!     let (rows, _) = scheme.rows(&nodes, None, &target)?;
//!     Ok((rows.rows().apply(&field)[0] - 0.1 * target[0].coords).norm())
//! };
//! assert!(error(Radial::Cubic.into())? < 1e-15); // exact for linear fields
//! assert!(error(InverseDistance { neighbours: 4, power: 2.0 }.into())? > 1e-6); // exact for constants only
//! # Ok::<(), tissuebench_interp::InterpError>(())
//! ```

mod circumcentre;
mod delaunay;
mod error;
mod frame;
mod hull;
mod lanes;
mod neighbours;
mod sibson;
mod table;
mod transfer;
mod twofold;

pub use error::InterpError;
pub use transfer::TransferInfo;

use catalogue::{Build, Entry, Values};
use geometry::Mesh;
use shape::{GradRows, Point3, PointRows};

use crate::transfer::{Source, Transfer};

/// A transfer scheme that scene files can name.
pub type SchemeEntry = Entry<Build<Scheme>>;

/// Declares the files of the schemes, each with its types and their entries.
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
        pub static SCHEMES: &[SchemeEntry] = &[$($($(
            $file::$entry.built_by(|values| Ok(($file::$entry.build)(values)?.into()))
        ),*),*),*];

        impl Scheme {
            fn transfer(&self) -> &dyn Transfer {
                match self {
                    $($(Scheme::$scheme(scheme) => scheme,)*)*
                }
            }
        }
    };
}

// Each scheme is a file with its function, a type that implements `Transfer` and its entry, and a line here.
schemes! {
    nearest::{Nearest [ENTRY]},
    inverse_distance::{InverseDistance [ENTRY]},
    shepard::{Shepard [ENTRY]},
    mls::{MlsLinear [MLS_LINEAR], MlsQuadratic [MLS_QUADRATIC], MlsModified [MLS_MODIFIED]},
    radial::{Radial [THIN_PLATE, CUBIC, MULTIQUADRIC, GAUSSIAN, WENDLAND_C2]},
    natural_neighbour::{NaturalNeighbour [ENTRY]},
    barycentric::{Barycentric [ENTRY]},
}

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

    /// Builds the table from `nodes` to `targets` (m). Only [`Barycentric`] uses `mesh`,
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
