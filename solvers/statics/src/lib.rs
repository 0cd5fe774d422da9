//! Statics, implicit dynamics and vibrations over shape tables: assembly, supports, constraints, Newton's
//! method, recovery.
//!
//! This crate knows neither elements nor kernels. A [`LinearBody`] is a quadrature with a material, and a
//! [`LinearProblem`] is a body with loads and supports. Each stage is a value of its own, which can be timed,
//! kept and reused:
//!
//! ```text
//! LinearProblem --assemble--> Assembled --factor--> Factored --solve--> Solution
//! ```
//!
//! The same problem with a [`Mass`] has [`modes`] of free vibration.
//!
//! One factorisation serves any number of load levels and load sets. Every solve ends with a check of its
//! residual, and results have the same bits at any number of threads.
//!
//! Beyond small strain a [`Solid`] is the same quadrature with a [`material::Law`] and a [`SolidDilation`]
//! (standard, by groups, or mixed with a pressure field of its own). Two procedures share its forces:
//!
//! ```text
//! StaticProblem --solve_static--> StaticPath     Newton with load steps, tools, friction
//! TimeProblem --solve_in_time--> TimePath        generalised-alpha, or creep and relaxation without inertia
//! ```
//!
//! A path that ends early keeps the steps reached and states the reason.
//!
//! ```
//! use geometry::{CellKind, generate::box_mesh};
//! use material::LinearElastic;
//! use shape::{FixedDof, Point3};
//! use tissuebench_statics::{LinearBody, LinearProblem, assemble};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A cube of 10 mm between frictionless walls, its top pressed down by 0.1 mm.
//! let max = Point3::new(0.01, 0.01, 0.01);
//! let mesh = box_mesh(CellKind::Hex8, Point3::origin(), max, [2; 3], [1.0; 3], None)?;
//! let volume = fem::volume_rows(&mesh, &fem::VolumeRule::STANDARD)?;
//! let materials = [LinearElastic::new(20e3, 0.3)?];
//! let nodes = mesh.points();
//! let body =
//!     LinearBody { nodes, volume: &volume, materials: &materials, region: &[], dilation: None };
//! let mut fixed = Vec::new();
//! for (side, axis, value) in
//!     [("x-min", 0, 0.0), ("y-min", 1, 0.0), ("z-min", 2, 0.0), ("z-max", 2, -1e-4)]
//! {
//!     let nodes = mesh.facet_group_nodes(mesh.group(side).expect("a box has six sides"));
//!     fixed.extend(nodes.into_iter().map(|node| FixedDof { node, axis, value }));
//! }
//! let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &[], weak: &[] };
//! let solution = assemble(&problem)?.factor()?.solve(1.0)?;
//! // Uniaxial stress: W = E eps^2 V / 2.
//! let energy = tissuebench_statics::strain_energy(&body, &solution.u)?;
//! assert!((energy - 0.5 * 20e3 * 1e-4 * 1e-6).abs() < 1e-12 * energy);
//! # Ok(())
//! # }
//! ```

// `!(x > 0.0)` rejects NaN; `x <= 0.0` would let NaN pass.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

mod assembly;
mod body;
mod cells;
mod coercivity;
mod condense;
mod constraint;
mod dilation;
mod eliminate;
mod error;
mod grad_table;
mod hourglass;
mod implicit;
mod laplace;
mod load;
mod modes;
mod nonlinear;
pub mod plain;
mod pressure;
mod problem;
mod recover;
mod reduction;
mod rigid;
mod rigid_mode;
mod solve;
mod support;
mod weak;

pub use body::LinearBody;
pub use cells::{Cells, FactoredCells, factor_cells};
pub use condense::Condensed;
pub use constraint::{ConstraintRow, multiplier_rows};
pub use error::SolveError;
pub use implicit::{
    Energy, Inertia, Mass, Motion, TimeError, TimeParams, TimePath, TimeProblem, TimeStep, solve_in_time,
};
pub use laplace::{LaplaceProblem, solve_laplace};
pub use load::{Load, nodal_forces, nodal_forces_by_curve};
pub use modes::{ALL_MODES_LIMIT, Modes, lowest_modes, modes};
pub use nonlinear::{
    Active, Basis, Curves, FollowingLoad, Frames, Goal, Inverted, Iteration, LinearSystems, Nearby,
    NewtonParams, PenaltySurface, Predicted, Rest, Solid, SolidDilation, StaticError, StaticParams,
    StaticPath, StaticProblem, StaticWork, Step, Timing, Traced, Worst, predict, solve_static, trace,
    unbalanced,
};
pub use problem::{Assembled, LinearProblem, assemble};
pub use recover::{body_stress, mean_pressure, strain_energy, stress};
pub use rigid_mode::RigidMode;
pub use solve::{Factored, Iterated, Solution, SolveInfo};
pub use weak::{Weak, WeakSupport};
