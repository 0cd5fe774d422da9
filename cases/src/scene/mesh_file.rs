//! Files of meshes and positions that a scene names.

use std::path::PathBuf;

use catalogue::Problem;
use geometry::surface::Treatment;

use super::report::Report;
use super::units::{Length, Unit};

/// Default unit of a mesh file's numbers, which CAD programs and Gmsh models of organs use, in metres.
const MILLIMETRE: f64 = 1e-3;

/// A file of a mesh or of positions.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// Path; relative paths are resolved from the folder of the file that names it.
    pub path: PathBuf,
    /// Metres per unit of the numbers in the file.
    pub unit: f64,
    /// Whether pieces of the mesh are joined at faces that coincide.
    pub join: bool,
    /// Treatment of a surface that need not be closed.
    pub treatment: Treatment,
}

impl MeshFile {
    /// The file whose path is the value of `key`; its numbers are millimetres unless a unit is given.
    pub(crate) fn read(path: &str, unit: Option<Unit<Length>>, key: &str, report: &Report) -> MeshFile {
        let path = report.path(path, key);
        if !path.is_file() {
            let place = path.display();
            let help =
                format!("no file at {place}; paths are relative to the folder of the file they are in");
            report.add(key, Problem::new("can't be found").help(help));
        }
        let unit = unit.map_or(MILLIMETRE, |unit| unit.0);
        MeshFile { path, unit, join: false, treatment: Treatment::AsGiven }
    }
}
