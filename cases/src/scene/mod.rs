//! Scene and study files: parsed, checked and converted to SI numbers, or refused with all errors and their
//! locations.
//!
//! A scene is one TOML file. Each part of a scene (the body, a material, a method) has one file here. It
//! defines the keys of the part, as types from which the schema is generated; the value that the program
//! uses; the reader that converts the keys; and the demands on other parts. Every scene is checked against
//! the schema, so the reader and the schema cannot diverge. A valid file becomes a [`Scene`], which has no
//! text left to parse. Methods that several scenes share are in a separate file (`shared`).

mod altered;
mod available;
mod axis;
mod body;
mod check;
mod condition;
mod conform;
mod coverage;
mod curve;
mod demands;
mod direction;
mod document;
mod drive;
mod error;
mod expression;
mod field;
mod fit;
mod fitted;
mod foundation;
mod frames;
mod goal;
mod limits;
mod load;
mod material;
mod measured;
mod mesh_file;
mod method;
mod output;
mod procedure;
mod purpose;
mod ramp;
mod real_time;
mod reference;
mod region;
mod report;
mod sample;
#[allow(clippy::module_inception)] // the scene itself
mod scene;
mod selection;
mod set;
mod shared;
mod sources;
mod study;
mod table;
mod timing;
mod tissue;
mod tool;
mod touch;
mod trained;
mod training;
mod units;
mod vary;
mod vocabulary;
mod words;

pub use axis::Axis;
pub use body::Body;
pub use check::{Bound, Check};
pub use condition::{Load, LoadKind, Prescribed, Support};
pub use curve::NamedCurve;
pub use direction::{Direction, WallHelix, WallRule};
pub use document::Origin;
pub use drive::{Drive, Leg, Turn};
pub use error::{ErrorKind, SceneError};
pub use expression::{Expression, NotFinite};
pub use field::{ScalarField, VectorField};
pub use fit::{Fit, FitCheck, FitStatistic, FittedKey};
pub use foundation::Foundation;
pub use frames::{ImplicitCg, Swept};
pub use goal::Goal;
pub use load::{load, load_with, parse, parse_with, schema};
pub use material::{Directions, Material, MaterialRegion, Relaxation, medium};
pub use measured::Measured;
pub use mesh_file::MeshFile;
pub use method::{
    Adapt, Basis, Cloud, ConstraintRows, Dilation, Efg, Element, Essential, EssentialKind, External, Family,
    Fem, Functions, Hourglass, HourglassModulus, Integration, Jitter, Mass, Method, Pod, Refine, Regions,
    Setting, Size, SupportRule, SupportShape,
};
pub use output::{Enclosed, Output, Repeated, Stretch, Target, Transfer};
pub use procedure::{
    Explicit, Implicit, LinearSolver, Newton, OnStall, Precision, Procedure, ProcedureKind, Static,
};
pub use purpose::{Publication, Purpose};
pub use ramp::Ramp;
pub use real_time::RealTime;
pub use reference::Reference;
pub use region::{Comparison, Region, Relation};
pub use scene::Scene;
pub use selection::Place;
pub use set::Override;
pub use study::{Run, Study, load_study, load_study_for, parse_study, study_schema};
pub use tool::{Friction, Tool};
pub use training::Training;
pub use vary::{Statistic, StatisticCheck, VariedKey, Vary};
