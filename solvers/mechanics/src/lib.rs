//! Solid mechanics over shape tables: materials, assembly, supports, constraints, factorisation, recovery.
//!
//! Nothing here knows an element or a kernel. A [`Body`] is a quadrature with a material, a [`LinearProblem`] is
//! a body with loads and supports, and the stages are values of their own, so that each can be timed, kept and
//! used again:
//!
//! ```text
//! LinearProblem --assemble--> Assembled --factor--> Factored --solve--> Solution
//! ```
//!
//! The same problem with a [`Mass`] has [`modes`] of free vibration.
//!
//! One factorisation serves any number of load levels and load sets. Every solve ends with a check of its residual,
//! and results have the same bits at any number of threads.
//!
//! Beyond small strain a [`Solid`] is the same quadrature with a [`Law`] and a [`Dilation`] (standard, by groups, or
//! mixed with a pressure of its own). Three procedures share its forces:
//!
//! ```text
//! StaticProblem --solve_static--> StaticPath     Newton with load steps, tools, friction
//! TimeProblem --solve_in_time--> TimePath        generalised-alpha, or creep and relaxation without inertia
//! ExplicitBody --InternalForce--> Dynamics       central difference, dynamic relaxation
//! ```
//!
//! A path that ends early keeps what it carried and says why.

// `!(x > 0.0)` refuses a NaN, `x <= 0.0` would let it pass.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

mod body;
mod condense;
mod constraint;
mod contact;
mod dilation;
mod eliminate;
mod error;
mod explicit;
mod grad_table;
mod implicit;
mod linear_solver;
mod load;
mod material;
mod modes;
mod nonlinear;
mod pattern;
mod problem;
mod recover;
mod reduction;
mod rigid;
mod solve;
mod stiffness;
mod support;
mod weak;

pub use body::Body;
pub use condense::Condensed;
pub use constraint::{ConstraintRow, multiplier_rows};
pub use contact::{
    ContactCounts, ContactError, ContactHistory, ContactLaw, ContactSurface, Contacts, Distance,
    PointContact, Slip, Tool, ToolShape,
};
pub use error::SolveError;
pub use explicit::{
    Balance, CriticalStep, Dynamics, DynamicsParams, ExplicitBody, ExplicitError, External, InternalForce,
    InvertedPoint, LanczosParams, LanePath, Lumping, MovingTool, Prescribed, Pressing, PressingTool,
    RelaxationInfo, RelaxationParams, Springs, StaticLoad, ToolEnergies, ToolMotion, Tools, critical_step,
    critical_step_touching, locality_order, lumped_mass, relax, relax_under,
};
pub use implicit::{
    Energy, Inertia, Mass, Motion, Ramp, Ramps, TimeError, TimeParams, TimePath, TimeProblem, TimeStep,
    solve_in_time,
};
pub use linear_solver::SolverPath;
pub use load::{Load, nodal_forces};
pub use material::{
    Hencky, Law, LinearElastic, Material, MaterialError, MooneyRivlin, NeoHookean, NeoHookeanIsochoric,
    Ogden, Prony, PronyStep, SaintVenantKirchhoff, Tangent, deviator, relaxed_stress_and_tangent,
    volume_change,
};
pub use modes::{Modes, modes};
pub use nonlinear::{
    Dilation, Drive, DrivenTool, Frames, HeldSurface, Inverted, Iteration, NewtonParams, Solid, StaticError,
    StaticParams, StaticPath, StaticProblem, StaticWork, Step, ToolState, Worst, solve_static,
};
pub use pattern::BlockPattern;
pub use problem::{Assembled, LinearProblem, assemble};
pub use recover::{body_stress, mean_pressure, strain_energy, stress};
pub use rigid::RigidMode;
pub use solve::{Factored, Solution, SolveInfo};
pub use stiffness::Stiffness;
pub use support::FixedDof;
pub use weak::{Weak, WeakSupport};

pub use shape::{Matrix3, Point3, Vector3};
