//! Mesh files in and out: Gmsh (.msh 1, 2.2, 4.0, 4.1), Abaqus and CalculiX (.inp), VTK (.vtu, .vtk). FEBio
//! models (.feb) are read only. Closed surfaces: STL, OBJ, PLY, OFF, VTK (.vtp), Medit (.mesh).
//!
//! Groups and sets are kept: those of cells become regions, those of faces facet groups. Every reader fills a
//! `Content`, which alone builds the mesh. All formats are therefore checked for the same errors, which are
//! reported with the place and number in the file.

mod abaqus;
mod content;
mod data_array;
mod error;
mod febio;
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
mod vectors;
mod vtk;
mod vtk_cells;
mod vtu;
mod write;
mod xml;

pub use abaqus::{DeckCard, deck_cards, load_group};
pub use error::{FileError, Place, Problem, SurfaceError};
pub use febio::{model_text, node_set_group, solid_of};
pub use format::Format;
pub use gmsh::GmshVersion;
pub use left_out::{Kind, LeftOut, summary};
pub use read::{
    READ, included, inverted, is_mesh, left_out, read, read_bytes, read_numbered, read_without_unused,
};
pub use rows::{Row, Rows};
pub use surface::{
    SURFACES, is_surface, read_surface, read_surface_bytes, read_together, read_treated, read_treated_bytes,
};
pub use vectors::{Vectors, read_vectors, read_vectors_bytes};
pub use vtu::write::{Values, solution_vtu, surface_vtu};
pub use write::{write, write_as};
pub use xml::Lines;
