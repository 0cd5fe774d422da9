//! The shape table: *at this point, which nodes count, with which value and which gradient?*
//!
//! A finite element, a moving-least-squares cloud, an inverse-distance weight and a radial basis all answer that
//! one question, with a row. Everything downstream (kinematics, assembly, loads, supports, transfer) reads rows
//! and never asks who filled them, which is what makes a comparison fair.
//!
//! Compressed rows in flat arrays; positions and gradients in the reference configuration; SI units.

mod blocks;
mod dilation;
mod fixed;
mod order;
mod rows;
mod source;
mod tables;
mod trace;

pub use blocks::RowBlocks;
pub use dilation::DilationGroups;
pub use fixed::FixedDof;
pub use order::locality_order;
pub use rows::{Rows, ShapeError, Unity};
pub use source::{Quadrature, RowSource, SourceError, equal_groups};
pub use tables::{FluxRows, GradRows, Layout, PointRows, SurfaceRows, VolumeRows};
pub use trace::TraceRows;

/// A position in the reference configuration, in metres.
pub type Point3 = nalgebra::Point3<f64>;
/// A displacement (m), a normal (-) or a shape gradient (1/m).
pub type Vector3 = nalgebra::Vector3<f64>;
/// A displacement gradient (-).
pub type Matrix3 = nalgebra::Matrix3<f64>;
