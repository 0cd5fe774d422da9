//! Gmsh 2.2 ASCII mesh files: tet4, tet10, hex8 and hex20 cells, physical groups as regions and facet groups.

mod error;
mod inverted;
mod lines;
mod order;
mod read;
mod write;

pub use error::{MshError, MshProblem};
pub use inverted::{Row, inverted, row_of_cell};
pub use read::{read, read_text};
pub use write::write;
