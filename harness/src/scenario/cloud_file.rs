//! Clouds from files, checked against the body and the scene.

use std::collections::HashMap;

use cases::scene::MeshFile;
use geometry::shapes::Shape;
use geometry::{Cloud, Mesh, Point3, cloud_from_mesh, locate, read_points};

use crate::adapter::npy;
use crate::error::{Failure, Key};

/// Largest distance beyond the surface that counts as on the surface, over the body's diagonal: the rounding
/// of text with six digits.
const ON_SURFACE: f64 = 1e-6;

/// Nodes of a file, and the mesh if the file has cells.
pub struct Read {
    /// Nodes and their spacing.
    pub cloud: Cloud,
    /// The mesh, if the file has cells.
    pub mesh: Option<Mesh>,
    /// Line number of each node; empty if the file has cells or is an array.
    lines: Vec<usize>,
}

impl Read {
    /// Describes the location of a node in the file.
    fn place(&self, node: usize) -> String {
        self.lines.get(node).map_or(format!("node {node}"), |line| format!("line {line}"))
    }

    /// Refuses nodes outside the body. The body is its closed form, or else the background cells.
    ///
    /// # Errors
    /// Returns an error with the number of nodes outside and the farthest of them.
    pub fn within(
        &self,
        shape: Option<&(dyn Shape + Send + Sync)>,
        background: &Mesh,
    ) -> Result<(), Failure> {
        let [low, high] = match shape {
            Some(shape) => shape.bounds(),
            None => {
                let first = background.points()[0];
                let all = background.points().iter();
                all.fold([first, first], |[low, high], p| [low.inf(p), high.sup(p)])
            }
        };
        let beyond: Vec<f64> = match shape {
            Some(shape) => self.cloud.points.iter().map(|p| beyond(shape, p)).collect(),
            None => {
                let found = locate(background, &self.cloud.points).map_err(|bad| {
                    Failure::input(FILE, format!("can't be compared with the body: {bad}"), "")
                })?;
                found.iter().map(|location| location.outside).collect()
            }
        };
        let outside = |d: &f64| *d > ON_SURFACE * (high - low).norm();
        let count = beyond.iter().filter(|d| outside(d)).count();
        let farthest = (0..beyond.len()).max_by(|&a, &b| beyond[a].total_cmp(&beyond[b]));
        match farthest {
            Some(node) if count > 0 => {
                let problem = format!(
                    "has {count} of {} nodes outside the body; the farthest, {}, is {:.3e} m away",
                    beyond.len(),
                    self.place(node),
                    beyond[node]
                );
                let help = format!("the body spans {low} to {high} m; check the file's unit and origin");
                Err(Failure::input(FILE, problem, &help))
            }
            _ => Ok(()),
        }
    }
}

const FILE: Key = Key::Method("cloud.file");

/// Returns the distance of a point beyond the surface, m; 0 inside.
fn beyond(shape: &(dyn Shape + Send + Sync), p: &Point3) -> f64 {
    if shape.inside(p) { 0.0 } else { (shape.project_to_surface(p) - p).norm() }
}

/// Reads the nodes of a mesh file, of a `.npy` array, or of text lines `x, y, z`. `nodes` is the count stated
/// in the scene.
///
/// # Errors
/// Returns an error if the file cannot be read, has another number of nodes than `nodes`, or has coincident
/// nodes.
pub fn read(file: &MeshFile, nodes: Option<usize>) -> Result<Read, Failure> {
    let (points, lines, mesh) = if mesh_files::is_mesh(&file.path) {
        let mesh = mesh_files::read(&file.path, file.unit)
            .map_err(|bad| Failure::input(FILE, format!("can't be read: {bad}"), mesh_files::READ))?;
        (mesh.points().to_vec(), Vec::new(), Some(mesh))
    } else if file.path.extension().is_some_and(|suffix| suffix == "npy") {
        (array(file)?, Vec::new(), None)
    } else {
        let read = read_points(&file.path, file.unit).map_err(|bad| {
            Failure::input(
                FILE,
                format!("can't be read: {bad}"),
                "give x, y, z on each line, separated by commas",
            )
        })?;
        (read.points, read.lines, None)
    };
    if let Some(wanted) = nodes.filter(|&n| n != points.len()) {
        let problem = format!("disagrees with {}, which has {} nodes", file.path.display(), points.len());
        let help = format!("give nodes = {} instead of {wanted}, or leave the key out", points.len());
        return Err(Failure::input(Key::Method("nodes"), problem, &help));
    }
    // The spacing is defined only for a cloud without duplicates.
    let nothing = Cloud { points: Vec::new(), spacing: Vec::new() };
    let unspaced = Read { cloud: nothing, mesh, lines };
    if let Some([first, second]) = duplicate(&points) {
        let problem =
            format!("has {} and {} in the same place", unspaced.place(first), unspaced.place(second));
        return Err(Failure::input(FILE, problem, "remove the duplicate node"));
    }
    let cloud = match &unspaced.mesh {
        Some(mesh) => cloud_from_mesh(mesh),
        None => Cloud::from_points(points)
            .map_err(|bad| Failure::input(FILE, format!("makes no cloud: {bad}"), ""))?,
    };
    Ok(Read { cloud, ..unspaced })
}

/// Reads the nodes of a NumPy array with one row of x, y, z per node.
fn array(file: &MeshFile) -> Result<Vec<Point3>, Failure> {
    let wrong = |bad: String| {
        let problem = format!("can't be read: {} {bad}", file.path.display());
        Failure::input(FILE, problem, "give an array of shape (nodes, 3), a row of x, y, z for each node")
    };
    let array = npy::read(&file.path, disk::Kind::MESH).map_err(wrong)?;
    if !matches!(array.shape[..], [rows, 3] if rows > 0) {
        return Err(wrong(format!("has an array of shape {:?}", array.shape)));
    }
    if let Some(at) = array.values.iter().position(|x| !x.is_finite()) {
        return Err(wrong(format!("has {} in row {}, column {}", array.values[at], at / 3, at % 3)));
    }
    let rows = array.values.chunks_exact(3);
    Ok(rows.map(|x| Point3::new(x[0], x[1], x[2]) * file.unit).collect())
}

/// Returns the first duplicate node, after the node it coincides with.
fn duplicate(points: &[Point3]) -> Option<[usize; 2]> {
    let mut seen = HashMap::with_capacity(points.len());
    points.iter().enumerate().find_map(|(node, p)| {
        // Adding zero turns a negative zero into a positive zero.
        let bits = [p.x, p.y, p.z].map(|c| (c + 0.0).to_bits());
        seen.insert(bits, node).map(|first| [first, node])
    })
}
