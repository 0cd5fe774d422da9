//! VTK's unstructured grids, .vtu: text, base64 and appended data, plain or in blocks by zlib or lz4, of either byte order.
//!
//! Cells get their regions from the first array of cells that is named as programs name it (`region`, `gmsh:physical`, `material`, ..),
//! faces in the file their groups from `surface` or the same array; a value is a name by `region-names` and `surface-names`, else
//! "region-VALUE" and "surface-VALUE". (VTK file formats, "XML file formats".)

mod array;
mod grid;
pub(super) mod write;

pub(super) use grid::parse;
