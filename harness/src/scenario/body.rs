//! Meshes the scene's body in the requested size, or gives its closed form for clouds.

use std::sync::Arc;

use cases::scene::{Body, Element, ErrorKind, Jitter, MeshFile, Size};
use geometry::generate::{
    self, Drawn, GenerateError, ShellExtent, ball_mesh, box_mesh, cylinder_mesh, half_kidney_mesh,
    is_convertible, kidney_mesh, raise_order, sphere_shell_mesh, ventricle_mesh,
};
use geometry::quality::InvertedElement;
use geometry::shapes::{Ball, Cuboid, Cylinder, HalfKidney, Kidney, Shape, SphereShell};
use geometry::{CellKind, Mesh, Point3};

use super::expected::{self, narrowest};
use super::file_body::{self, Fill};
use super::mesh_file::read;
use crate::error::{Failure, Key};

/// Most nodes of a mesh; a larger number in a scene for one machine is taken for a typing error.
pub(super) const MOST_NODES: usize = 3_000_000;

/// Returns the body in closed form; `None` for the octant of a shell, for a ventricle and for a file, whose shape comes from
/// [`file_body::load`].
pub fn shape(body: &Body) -> Option<Arc<dyn Shape + Send + Sync>> {
    match *body {
        Body::Box { min, max } => Some(Arc::new(Cuboid { min: min.into(), max: max.into() })),
        Body::Cylinder { radius, height } => Some(Arc::new(Cylinder { radius, height })),
        Body::Ball { radius } => Some(Arc::new(Ball { radius })),
        Body::SphereShell { inner, outer, octant: false } => Some(Arc::new(SphereShell { inner, outer })),
        Body::Kidney { half: false, .. } => Some(Arc::new(Kidney)),
        Body::Kidney { half: true, .. } => Some(Arc::new(HalfKidney)),
        Body::SphereShell { octant: true, .. } | Body::Ventricle(_) | Body::File(_) => None,
    }
}

/// Meshes the body in cells of one kind, without a check for inversion.
///
/// # Errors
/// Returns an error if the size or jitter does not apply to the body or if the mesh has too many nodes.
pub(super) fn unchecked(
    body: &Body,
    kind: CellKind,
    size: &Size,
    jitter: Option<Jitter>,
) -> Result<Mesh, Failure> {
    let is_box = matches!(body, Body::Box { .. });
    if jitter.is_some() && !is_box && !matches!(size, Size::File(_)) {
        let problem = format!("applies to boxes only, not to a {}", body.name());
        return Err(Failure::input(Key::Method("jitter"), problem, "leave it out"));
    }
    let family = |n: usize| -> Result<Mesh, Failure> {
        if !is_box {
            few_enough(expected::of_family(body, kind, n as f64))?;
        }
        let mesh = match *body {
            Body::Box { min, max } => {
                let cells = nearly_cubic(min, max, n)?;
                few_enough(expected::of_family(body, kind, n as f64))?;
                cuboid(kind, min, max, cells, [1.0; 3], jitter)
            }
            Body::Cylinder { radius, height } => {
                let along = (height / (2.0 * radius) * 2.0 * n as f64).round().max(1.0) as usize;
                cylinder_mesh(kind, radius, height, [n, along], 1.0)
            }
            Body::Ball { radius } => ball_mesh(kind, radius, n),
            Body::SphereShell { inner, outer, octant } => {
                let extent = if octant { ShellExtent::Octant } else { ShellExtent::Whole };
                sphere_shell_mesh(kind, inner, outer, [n, n], 1.0, extent)
            }
            Body::Ventricle(ref wall) => ventricle_mesh(kind, wall, [expected::VENTRICLE * n, n]),
            Body::Kidney { half: false, .. } => kidney_mesh(kind, n),
            Body::Kidney { half: true, mildly_graded } => {
                let drawn = if mildly_graded { Drawn::Mildly } else { Drawn::Strongly };
                half_kidney_mesh(kind, n, drawn)
            }
            Body::File(ref file) => {
                return inside(file, kind, Inside::Spacing(narrowest(body) / n as f64));
            }
        };
        let mesh = mesh.map_err(|bad| ungenerated(bad, size, jitter))?;
        few_enough(mesh.points().len() as f64)?;
        Ok(mesh)
    };
    match *size {
        Size::Level(level) => family(base(body) << (level - 1).min(16)),
        Size::Nodes(wanted) => {
            few_enough(wanted as f64)?;
            match body {
                Body::File(file) => inside(file, kind, Inside::Nodes(wanted)),
                _ => nearest_count(family, wanted),
            }
        }
        Size::Spacing(spacing) => {
            if let Body::File(file) = body {
                return inside(file, kind, Inside::Spacing(spacing));
            }
            let n = narrowest(body) / spacing;
            if !(n.is_finite() && n < 1e3) {
                let problem = format!("gives {n:.0} cells across the body");
                return Err(Failure::input(Key::Size("spacing"), problem, "at most 1000 are supported"));
            }
            family(n.round().max(1.0) as usize)
        }
        Size::Cells { cells, grading } => match *body {
            Body::Box { min, max } => {
                few_enough(expected::of_box(kind, cells.map(|n| n as f64)))?;
                cuboid(kind, min, max, cells, grading, jitter).map_err(|bad| ungenerated(bad, size, jitter))
            }
            _ => {
                let problem = format!("is for boxes, not for a {}", body.name());
                Err(Failure::input(Key::Size("cells"), problem, "give level, nodes or spacing"))
            }
        },
        Size::File(ref file) => from_file(&joined(body, file), kind),
    }
}

/// Numbers of nearly cubic cells along the edges of a box, `n` along the shortest.
fn nearly_cubic(min: [f64; 3], max: [f64; 3], n: usize) -> Result<[usize; 3], Failure> {
    let extent: [f64; 3] = std::array::from_fn(|a| max[a] - min[a]);
    let shortest = extent.iter().copied().fold(f64::MAX, f64::min);
    let h = shortest / n as f64;
    let cells = extent.map(|e| (e / h).round().max(1.0) as usize);
    let Some(most) = cells.into_iter().max().filter(|most| *most > MOST_NODES) else { return Ok(cells) };
    let problem = format!(
        "is {:.3e} times as long as it is narrow: it would take {most} nearly cubic cells along its length",
        extent.iter().copied().fold(0.0, f64::max) / shortest
    );
    let help = "check the units of its extents; for flat cells, give the method size = { cells = [...] }";
    Err(Failure::input(Key::Scene("body".into()), problem, help))
}

/// The mesh file of a method, whose pieces are joined if the scene requests it of the body.
pub(super) fn joined(body: &Body, file: &MeshFile) -> MeshFile {
    let join = matches!(body, Body::File(of_body) if of_body.join);
    MeshFile { join, ..file.clone() }
}

/// Size of the tetrahedra inside a surface.
enum Inside {
    /// Edge length, m.
    Spacing(f64),
    /// Number of nodes.
    Nodes(usize),
}

/// Meshes the interior of a surface file, or of the boundary of a mesh file.
fn inside(file: &MeshFile, kind: CellKind, size: Inside) -> Result<Mesh, Failure> {
    if kind.of_order(1) != Some(CellKind::Tet4) {
        let problem =
            format!("fills the surface of {} with tetrahedra, not with {}", file.path.display(), kind.name());
        let help = "take element = \"tet4\" or \"tet10\", or a mesh: size = { file = \"...\" }";
        return Err(Failure::input(Key::Size(""), problem, help));
    }
    let from_file = file_body::load(file)?;
    let quadratic = kind.order() == 2;
    let fill = match size {
        Inside::Spacing(spacing) => {
            few_enough(expected::of_spacing(&Body::File(file.clone()), kind, spacing))?;
            Fill::Spacing { bits: spacing.to_bits(), quadratic }
        }
        Inside::Nodes(nodes) => Fill::Nodes { nodes, quadratic },
    };
    from_file.mesh(fill)
}

/// Refuses a mesh of too many nodes before it is made, because making it takes seconds and gigabytes.
fn few_enough(nodes: f64) -> Result<(), Failure> {
    if nodes <= MOST_NODES as f64 {
        return Ok(());
    }
    let problem = format!("gives {nodes:.0} nodes; at most {MOST_NODES} are supported");
    Err(Failure::input(Key::Size(""), problem, "take a coarser mesh"))
}

fn cuboid(
    kind: CellKind,
    min: [f64; 3],
    max: [f64; 3],
    cells: [usize; 3],
    grading: [f64; 3],
    jitter: Option<Jitter>,
) -> Result<Mesh, generate::GenerateError> {
    let jitter = jitter.map(|j| generate::Jitter { fraction: j.fraction, seed: j.seed });
    box_mesh(kind, min.into(), max.into(), cells, grading, jitter)
}

/// Returns the error for an inverted cell, at the key of its cause: the file, the jitter or the size.
pub(super) fn inverted(bad: InvertedElement, size: &Size, jitter: Option<Jitter>) -> Failure {
    let (key, help) = match (size, jitter) {
        (Size::File(file), _) => {
            let problem = format!("gives a mesh in which {}", mesh_files::inverted(&file.path, &bad));
            let help = "the nodes of a cell have to follow the order of the format";
            return Failure::input(Key::Size("file"), problem, help);
        }
        (_, Some(_)) => (Key::Method("jitter.fraction"), "take a smaller fraction"),
        _ => (Key::Size(""), "take a grading closer to 1, or a finer mesh"),
    };
    Failure::input(key, format!("gives a mesh in which {bad}"), help)
}

fn ungenerated(bad: GenerateError, size: &Size, jitter: Option<Jitter>) -> Failure {
    match bad {
        GenerateError::Inverted(bad) => inverted(bad, size, jitter),
        GenerateError::Cells { .. } | GenerateError::Value { .. } => {
            Failure::input(Key::Size(""), format!("makes no mesh: {bad}"), "")
        }
        GenerateError::Mesh(_) => {
            Failure::at(ErrorKind::NotRun, Key::Size(""), format!("makes no mesh: {bad}"), "")
        }
    }
}

/// Returns the number of cells across the narrowest extent at level 1. Each level doubles it.
pub(super) fn base(body: &Body) -> usize {
    match body {
        // Two cells of depth, because a single one cannot bend.
        Body::Box { .. }
        | Body::Cylinder { .. }
        | Body::Ball { .. }
        | Body::Kidney { .. }
        | Body::SphereShell { .. }
        | Body::Ventricle(_)
        | Body::File(_) => 2,
    }
}

/// Returns the mesh of the family with the node count nearest to `wanted`.
fn nearest_count(family: impl Fn(usize) -> Result<Mesh, Failure>, wanted: usize) -> Result<Mesh, Failure> {
    let off = |mesh: &Mesh| mesh.points().len().abs_diff(wanted);
    let mut best = family(1)?;
    for n in 2.. {
        if best.points().len() >= wanted {
            break;
        }
        let next = family(n)?;
        if off(&next) > off(&best) {
            break;
        }
        best = next;
    }
    Ok(best)
}

/// Reads a mesh file in cells of one kind. Linear cells are raised to their quadratic kind with straight
/// edges.
fn from_file(file: &MeshFile, kind: CellKind) -> Result<Mesh, Failure> {
    let mesh = read(file, Key::Size("file"))?;
    let found = mesh.uniform_kind();
    if found == Some(kind) {
        return Ok(mesh);
    }
    if found.is_some() && found == kind.of_order(1) {
        return Ok(raise_order(&mesh));
    }
    let problem = format!("holds {} cells, not {}", found.map_or("mixed", CellKind::name), kind.name());
    let becomes: Vec<&str> =
        CellKind::ALL.into_iter().filter(|k| is_convertible(&mesh, *k)).map(CellKind::name).collect();
    let help = match is_convertible(&mesh, kind) {
        _ if found.is_none() => {
            format!(
                "take element = \"{}\", which takes the cells as they are",
                Element::mixed(kind.order()).name()
            )
        }
        true => format!("tissuebench mesh convert ... --element {}", kind.name()),
        false => format!(
            "the cells can't be converted to {}; take a method of {}",
            kind.name(),
            becomes.join(" or ")
        ),
    };
    Err(Failure::input(Key::Size("file"), problem, &help))
}

/// Converts coordinates to a point.
pub fn point(x: [f64; 3]) -> Point3 {
    Point3::from(x)
}
