//! VTK's unstructured grids, .vtu, and surfaces, .vtp: text, base64 and appended data, uncompressed or in
//! blocks of zlib or lz4, with either byte order.
//!
//! The regions of the cells come from the first cell array with a known name (`region`, `gmsh:physical`,
//! `material`, ..). The groups of faces in the file come from `surface` or the same array. A value is an
//! index into `region-names` or `surface-names`; without a name, the region or group is called "region-VALUE"
//! or "surface-VALUE". (VTK file formats, "XML file formats".)

mod array;
mod grid;
mod poly;
pub(super) mod write;

pub(super) use grid::parse;
pub(super) use poly::{is_surface, surface};
