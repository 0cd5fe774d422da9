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
    /// Further closed surfaces of the same body.
    pub further: Vec<PathBuf>,
    /// Whether pieces of the mesh are joined at faces that coincide.
    pub join: bool,
    /// Treatment of a surface that need not be closed.
    pub treatment: Treatment,
}

impl MeshFile {
    /// All files.
    pub fn paths(&self) -> Vec<PathBuf> {
        std::iter::once(&self.path).chain(&self.further).cloned().collect()
    }

    /// The file whose path is the value of `key`; its numbers are millimetres unless a unit is given.
    pub(crate) fn read(path: &str, unit: Option<Unit<Length>>, key: &str, report: &Report) -> MeshFile {
        MeshFile::together(&[path.into()], unit, key, report)
    }

    /// The files, at least one, whose paths are the value of `key`.
    pub(crate) fn together(
        paths: &[String],
        unit: Option<Unit<Length>>,
        key: &str,
        report: &Report,
    ) -> MeshFile {
        let found = |path: &String| {
            let path = report.path(path, key);
            if !path.is_file() {
                let place = path.display();
                let help =
                    format!("no file at {place}; paths are relative to the folder of the file they are in");
                report.add(key, Problem::new("can't be found").help(help));
            }
            path
        };
        let (path, further) = (found(&paths[0]), paths[1..].iter().map(found).collect());
        let unit = unit.map_or(MILLIMETRE, |unit| unit.0);
        MeshFile { path, unit, further, join: false, treatment: Treatment::AsGiven }
    }
}
