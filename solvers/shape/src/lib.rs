//! The shape table: the nodes that contribute at a point, with their values and gradients.
//!
//! A finite element, a moving-least-squares cloud, an inverse-distance weight and a radial basis all provide
//! such a row. All later stages (kinematics, assembly, loads, supports, transfer) read rows regardless of
//! their source, which makes a comparison fair.
//!
//! Tables are compressed rows in flat arrays, with positions and gradients in the reference configuration and
//! SI units.
//!
//! ```
//! use tissuebench_shape::{PointRows, Point3, RowBlocks, Rows, Unity, Vector3};
//! // Two points on the line between two nodes, at a quarter and at the end of it.
//! let rows = Rows::new(2, vec![0, 2, 3], vec![0, 1, 1], vec![0.75, 0.25, 1.0], Unity::Within(1e-12))?;
//! let points = vec![Point3::new(0.25, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0)];
//! let table = PointRows::new(points, rows)?;
//! let u = [Vector3::zeros(), Vector3::new(8.0, 0.0, 0.0)];
//! let at_points = table.rows().apply(&u);
//! assert_eq!((at_points[0].x, at_points[1].x), (2.0, 8.0));
//! // Packed by eight rows for repeated use, with the same bits.
//! let mut out = vec![Vector3::zeros(); 2];
//! RowBlocks::new(table.rows()).apply_into(&u, &mut out);
//! assert_eq!(out, at_points);
//! # Ok::<(), tissuebench_shape::ShapeError>(())
//! ```

mod blocks;
mod coarser;
mod controlled;
mod curve;
mod dilation;
mod fixed;
mod hourglass;
mod order;
mod position;
mod resultant;
mod rows;
mod source;
mod tables;
mod trace;

pub use blocks::RowBlocks;
pub use coarser::Coarser;
pub use curve::{Curve, CurveError};
pub use dilation::DilationGroups;
pub use fixed::FixedDof;
pub use hourglass::{HOURGLASS, HOURGLASS_MODES, Hourglass, HourglassModulus};
pub use order::locality_order;
pub use position::{length, position, position_alone};
pub use resultant::Resultant;
pub use rows::{Rows, ShapeError, Unity};
pub use source::{Quadrature, RowSource, SourceError};
pub use tables::{FluxRows, GradRows, Layout, PointRows, SurfaceRows, VolumeRows};
pub use trace::TraceRows;

/// A position in the reference configuration, in metres.
pub type Point3 = nalgebra::Point3<f64>;
/// A displacement (m), a normal (-) or a shape gradient (1/m).
pub type Vector3 = nalgebra::Vector3<f64>;
/// A displacement gradient (-).
pub type Matrix3 = nalgebra::Matrix3<f64>;
