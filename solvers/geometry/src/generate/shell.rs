//! Thick spheres, whole or one octant.

use super::{GenerateError, check_cells, check_positive, check_total, graded, into_kind, lattice, surfaces};
use crate::Point3;
use crate::element::CellKind;
use crate::mesh::Mesh;

/// Part of a sphere shell to mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShellExtent {
    /// The whole shell.
    Whole,
    /// The part with x, y, z >= 0; its cut faces are the groups "x-min", "y-min" and "z-min".
    Octant,
}

/// Meshes the shell between the radii `inner` and `outer` (m) around the origin.
///
/// The shell consists of the six faces of a cube projected to the sphere. `cells = [around, through]` are the
/// numbers of hexahedra along each edge of a face and through the thickness. An octant consists of three
/// quarter faces, with `around` hexahedra along each half edge. `grading` is the ratio of the outermost to
/// the innermost interval (1: uniform). Facet groups: "inner", "outer", and the cuts of an octant. Quadratic
/// nodes lie exactly on the two spheres.
///
/// # Errors
/// A radius, grading or number of cells out of range.
pub fn sphere_shell_mesh(
    kind: CellKind,
    inner: f64,
    outer: f64,
    cells: [usize; 2],
    grading: f64,
    extent: ShellExtent,
) -> Result<Mesh, GenerateError> {
    check_positive("the inner radius", inner)?;
    check_positive("the thickness", outer - inner)?;
    check_positive("the grading", grading)?;
    let [around, through] = cells;
    check_cells("the number of cells around the shell", around)?;
    check_cells("the number of cells through the shell", through)?;
    // Lattice of a whole cube edge, of which an octant uses the upper half.
    let (n, start, sides): (usize, usize, &[usize]) = match extent {
        ShellExtent::Whole => (around, 0, &[0, 1, 2, 3, 4, 5]),
        ShellExtent::Octant => (2 * around, around, &[1, 3, 5]),
    };
    check_total([sides.len() * around, around, through])?;

    let thickness = graded(through, grading);
    // Parameters: a point on the cube's surface, scaled by 1 (inner sphere) to 2 (outer sphere).
    let place = |key: lattice::Key| {
        let scale = 1.0 + thickness[key[3] as usize];
        let q = |c: u32| scale * (2.0 * c as f64 / n as f64 - 1.0);
        Point3::new(q(key[0]), q(key[1]), q(key[2]))
    };
    let mut mesh = lattice::Lattice::default();
    for &side in sides {
        for (i, j, layer) in lattice::triples([around, around, through]) {
            let key = |(a, b, c)| {
                let [x, y, z] = lattice::on_cube_side(side, [n; 3], start + i + a, start + j + b);
                [x, y, z, layer + c].map(|v| v as u32)
            };
            mesh.hexahedron(lattice::CORNERS.map(key), place);
        }
    }
    let ([inside, outside], [x, y, z]) = (surfaces::SHELL, surfaces::OCTANT);
    let mut groups: Vec<lattice::Group> =
        vec![(inside, &|q| q.coords.amax() == 1.0), (outside, &|q| q.coords.amax() == 2.0)];
    if extent == ShellExtent::Octant {
        groups.push((x, &|q| q.x == 0.0));
        groups.push((y, &|q| q.y == 0.0));
        groups.push((z, &|q| q.z == 0.0));
    }
    let mesh = into_kind(mesh.finish(&groups)?, kind);
    Ok(mesh.moved(|q| {
        let size = q.coords.amax();
        let t = size - 1.0;
        let radius = inner * (1.0 - t) + outer * t;
        Point3::from(lattice::onto_sphere(&(q.coords / size)) * radius)
    })?)
}
