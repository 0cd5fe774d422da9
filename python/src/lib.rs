//! The engine as a Python module: scenes, studies, meshes, shape tables and comparisons, with numpy arrays.
//!
//! Nothing is computed in this crate. `tissuebench/_engine.pyi` has the types and the documentation for
//! users.

mod arrays;
mod columns;
mod error;
mod mesh;
mod problem;
mod reference;
mod results;
mod rows;
mod run;
mod scene;
mod study;
mod table;
mod worker;

use pyo3::prelude::*;

#[pymodule]
mod _engine {
    #[pymodule_export]
    use crate::mesh::Mesh;
    #[pymodule_export]
    use crate::problem::Problem;
    #[pymodule_export]
    use crate::results::Results;
    #[pymodule_export]
    use crate::rows::{ShapeTable, Transposed, schemes, transfer};
    #[pymodule_export]
    use crate::run::Run;
    #[pymodule_export]
    use crate::scene::{Scene, load, parse};
    #[pymodule_export]
    use crate::study::{Study, verify};
    #[pymodule_export]
    use crate::table::{Table, read};
}
