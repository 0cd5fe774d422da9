//! Mesh files in and out: Gmsh (.msh 1, 2.2, 4.0, 4.1), Abaqus and CalculiX (.inp), VTK (.vtu, .vtk). Closed
//! surfaces: STL, OBJ, PLY.
//!
//! Groups and sets are kept: those of cells become regions, those of faces facet groups. Every reader fills a
//! `Content`, which alone builds the mesh. All formats are therefore checked for the same errors, which are
//! reported with the place and number in the file.

mod abaqus;
mod content;
mod error;
mod format;
mod gmsh;
mod left_out;
mod lines;
mod middles;
mod names;
mod numbers;
mod open;
mod overlap;
mod read;
mod rows;
mod surface;
mod text;
mod vtk;
mod vtk_cells;
mod vtu;
mod write;

pub use error::{FileError, Place, Problem, SurfaceError};
pub use format::Format;
pub use gmsh::GmshVersion;
pub use left_out::{Kind, LeftOut, summary};
pub use read::{READ, included, inverted, is_mesh, left_out, read, read_bytes, read_without_unused};
pub use rows::Row;
pub use surface::{SURFACES, is_surface, read_surface, read_surface_bytes};
pub use vtu::write::{Values, solution_vtu, surface_vtu};
pub use write::{write, write_as};
