//! Bodies from files: a closed surface, or a mesh and its boundary surface. Meshes of any size are made
//! inside.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::time::SystemTime;

use cases::scene::MeshFile;
use geometry::generate::to_tets;
use geometry::stuffing::{Stuffing, stuff, stuff_quadratic, stuff_quadratic_with_nodes, stuff_with_nodes};
use geometry::surface::{BoundaryFaces, Change, Gaps, SurfaceProblem, Treated};
use geometry::{Facet, Mesh, Point3, Surface, Vector3, locate};
use mesh_files::SurfaceError;

use super::mesh_file;
use crate::error::{Failure, Key};

/// The surface of a file, and the mesh it bounds if the file has one.
pub struct FileBody {
    pub surface: Arc<Surface>,
    /// Changes of the file's triangles by a repair or a wrap.
    pub changes: Vec<Change>,
    /// Distances of a wrap from the triangles of the file.
    pub gaps: Option<Gaps>,
    mesh: Option<(Mesh, Vec<Facet>)>,
    /// Meshes made inside the surface, by size.
    made: Mutex<HashMap<Fill, Mesh>>,
}

/// Size of a mesh inside a surface, and whether its tetrahedra are quadratic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fill {
    /// Approximate number of nodes.
    Nodes { nodes: usize, quadratic: bool },
    /// Mean distance of neighbouring corners (m), as bits.
    Spacing { bits: u64, quadratic: bool },
}

/// Identity of a body when it was read: paths, unit, joining and treatment of the files, their lengths and
/// times of modification.
type Known = (Vec<PathBuf>, u64, (bool, String), Vec<(u64, Option<SystemTime>)>);

/// Files already read. Every method requests the body, and searching a surface for intersections takes as
/// long as reading it.
static READ: LazyLock<Mutex<HashMap<Known, Arc<FileBody>>>> = LazyLock::new(Mutex::default);

/// Reads the body of a file once.
///
/// # Errors
/// Returns an error if the file cannot be read or has no closed surface.
pub fn load(file: &MeshFile) -> Result<Arc<FileBody>, Failure> {
    let age = |path: &PathBuf| {
        let about = std::fs::metadata(path).ok();
        about.map_or((0, None), |about| (about.len(), about.modified().ok()))
    };
    let paths = file.paths();
    let how = (file.join, format!("{:?}", file.treatment));
    let known = (paths.clone(), file.unit.to_bits(), how, paths.iter().map(age).collect());
    if let Some(body) = READ.lock().unwrap_or_else(PoisonError::into_inner).get(&known) {
        return Ok(body.clone());
    }
    let key = || Key::Scene("body.path".into());
    let (treated, mesh) = if mesh_files::is_surface(&file.path) {
        (mesh_files::read_together(&paths, file.unit, file.treatment).map_err(unread)?, None)
    } else {
        let mesh = mesh_file::read(file, key())?;
        let boundary = BoundaryFaces::new(&mesh).map_err(|bad| {
            let problem = format!(
                "has a boundary that is not a closed surface (faces counted from 1, lengths in m): {bad}"
            );
            Failure::input(
                key(),
                problem,
                "use the nodes and cells of the file in methods: size = { file = \"...\" }",
            )
        })?;
        let surface = boundary.surface;
        (Treated { surface, changes: Vec::new(), gaps: None }, Some((mesh, boundary.faces)))
    };
    let Treated { surface, changes, gaps } = treated;
    let surface = Arc::new(surface);
    let body = Arc::new(FileBody { surface, changes, gaps, mesh, made: Mutex::default() });
    READ.lock().unwrap_or_else(PoisonError::into_inner).insert(known, body.clone());
    Ok(body)
}

fn unread(bad: SurfaceError) -> Failure {
    let of_wrap =
        matches!(&bad, SurfaceError::Surface { problem, .. } if matches!(**problem, SurfaceProblem::Wrap(_)));
    let key = if of_wrap { "body.wrap" } else { "body.path" };
    let help = if matches!(bad, SurfaceError::File(_)) { mesh_files::SURFACES } else { "" };
    Failure::input(Key::Scene(key.into()), format!("can't be read: {bad}"), help)
}

impl FileBody {
    /// Returns half the smallest extent (m), comparable to the radius of a ball.
    pub fn narrowest(&self) -> f64 {
        let [low, high] = self.surface.bounds();
        (high - low).min() / 2.0
    }

    /// Fills the surface with tetrahedra of one size, with the regions and named surfaces of the file.
    ///
    /// # Errors
    /// Returns an error if the surface cannot be filled at this size.
    pub fn mesh(&self, fill: Fill) -> Result<Mesh, Failure> {
        if let Some(mesh) = self.made.lock().unwrap_or_else(PoisonError::into_inner).get(&fill) {
            return Ok(mesh.clone());
        }
        let stuffed = match fill {
            Fill::Nodes { nodes, quadratic: false } => {
                stuff_with_nodes(&self.surface, nodes, 0).map(|(stuffed, _)| stuffed)
            }
            Fill::Nodes { nodes, quadratic: true } => stuff_quadratic_with_nodes(&self.surface, nodes),
            Fill::Spacing { bits, quadratic } => {
                let how = Stuffing { spacing: f64::from_bits(bits), doublings: 0 };
                if quadratic { stuff_quadratic(&self.surface, how) } else { stuff(&self.surface, how) }
            }
        };
        let stuffed = stuffed.map_err(|bad| {
            Failure::input(Key::Size(""), format!("can't be meshed: {bad}"), "take a finer mesh")
        })?;
        let mesh = match &self.mesh {
            None => stuffed.mesh,
            Some((mesh, faces)) => self.named(stuffed.mesh, mesh, faces)?,
        };
        self.made.lock().unwrap_or_else(PoisonError::into_inner).insert(fill, mesh.clone());
        Ok(mesh)
    }

    /// Assigns regions and names of the file to a new mesh. A cell takes the region of the file's cell at its
    /// centre. A face takes the names of the closest boundary face of the file.
    fn named(&self, mesh: Mesh, of_file: &Mesh, faces: &[Facet]) -> Result<Mesh, Failure> {
        let unlocated = |bad| Failure::input(Key::Scene("body.path".into()), format!("{bad}"), "");
        let middle = |nodes: &mut dyn ExactSizeIterator<Item = u32>| {
            let count = nodes.len() as f64;
            Point3::from(nodes.map(|n| mesh.points()[n as usize].coords).sum::<Vector3>() / count)
        };
        let mut groups: HashMap<Facet, Vec<&str>> = HashMap::new();
        for name in of_file.group_names() {
            for facet in of_file.group(name).unwrap_or_default() {
                groups.entry(*facet).or_default().push(name);
            }
        }
        let mut named: HashMap<&str, Vec<Facet>> = HashMap::new();
        for facet in mesh.boundary() {
            let (_, triangle) = self.surface.closest(&middle(&mut mesh.facet_nodes(facet)));
            for name in groups.get(&faces[triangle]).into_iter().flatten() {
                named.entry(name).or_default().push(facet);
            }
        }
        let tets = to_tets(of_file);
        let middles: Vec<Point3> =
            (0..mesh.cell_count()).map(|cell| middle(&mut mesh.cell(cell).iter().copied())).collect();
        let found = locate(&tets, &middles).map_err(unlocated)?;
        let cells_in = |name: &str| -> Vec<u32> {
            let of = found.iter().zip(0..).filter(|(location, _)| tets.is_in(location.cell as usize, name));
            of.map(|(_, cell)| cell).collect()
        };
        let further: Vec<(&str, Vec<u32>)> =
            tets.cell_groups().map(|(name, _)| (name, cells_in(name))).collect();
        let regions = found.iter().map(|location| tets.region(location.cell as usize)).collect();
        let mut names: Vec<&str> = named.keys().copied().collect();
        names.sort_unstable();
        let mut mesh = mesh.with_regions(regions, of_file.region_names().to_vec());
        for (name, cells) in further {
            mesh = mesh.with_cell_group(name, cells);
        }
        for name in names {
            mesh = mesh.with_group(name, named[name].clone()).expect("faces of the mesh itself");
        }
        Ok(mesh)
    }
}
