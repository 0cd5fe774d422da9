//! Upright cylinders in five blocks: a square core and four sectors around it.

use super::{GenerateError, check_cells, check_positive, check_total, graded, into_kind, lattice, surfaces};
use crate::Point3;
use crate::element::CellKind;
use crate::mesh::Mesh;

/// Half side of the inner square in the parameter space, in which the section is the square [-1, 1]^2.
const INNER: f64 = 0.5;
/// Radius at which the core's sides cross the axes, and the fraction by which its corners are drawn in (0:
/// square, 1: disc).
const CORE: f64 = 0.5;
const BULGE: f64 = 0.35;

/// Meshes a cylinder of `radius` and `height` (m) on the plane z = 0 around the z axis.
///
/// `cells = [across, along]` are the hexahedra along each side of the core square, which has `(across + 1) /
/// 2` layers around it, and along the height. `grading` is the ratio of the last to the first interval along
/// the height (1: uniform). Facet groups: [`surfaces::CYLINDER`]. Quadratic nodes of the side lie on the
/// cylinder.
///
/// # Errors
/// A radius, height, grading or number of cells out of range.
pub fn cylinder_mesh(
    kind: CellKind,
    radius: f64,
    height: f64,
    cells: [usize; 2],
    grading: f64,
) -> Result<Mesh, GenerateError> {
    check_positive("the radius", radius)?;
    check_positive("the height", height)?;
    upright(kind, cells, grading, surfaces::CYLINDER, |[x, y], z| {
        Point3::new(radius * x, radius * y, height * z)
    })
}

/// Meshes the image of the cylinder of radius 1 and height 1 under `map`, which takes a point of the unit disc
/// and a height. `names` are those of the side, the bottom and the top.
pub(super) fn upright(
    kind: CellKind,
    [n, along]: [usize; 2],
    grading: f64,
    [side, bottom, top]: [&str; 3],
    map: impl Fn([f64; 2], f64) -> Point3,
) -> Result<Mesh, GenerateError> {
    check_positive("the grading", grading)?;
    check_cells("the number of cells across the cylinder", n)?;
    check_cells("the number of cells along the cylinder", along)?;
    let layers = n.div_ceil(2);
    check_total([n, n + 4 * layers, along])?;

    let heights = graded(along, grading);
    let place = |key: lattice::Key| {
        let scale = INNER + (1.0 - INNER) * key[3] as f64 / layers as f64;
        let q = |c: u32| scale * (2.0 * c as f64 / n as f64 - 1.0);
        Point3::new(q(key[0]), q(key[1]), heights[key[2] as usize])
    };
    let mut mesh = lattice::Lattice::default();
    for (i, j, k) in lattice::triples([n, n, along]) {
        mesh.hexahedron(lattice::CORNERS.map(|(a, b, c)| [i + a, j + b, k + c, 0].map(|v| v as u32)), place);
    }
    for side in 0..4 {
        for (i, layer, k) in lattice::triples([n, layers, along]) {
            let key = |(a, b, c): (usize, usize, usize)| {
                // (around, outwards, up) is right-handed if 'around' runs clockwise as seen from above.
                let i = i + a;
                let [x, y] = [[n - i, 0], [n, n - i], [i, n], [0, i]][side];
                [x, y, k + c, layer + b].map(|v| v as u32)
            };
            mesh.hexahedron(lattice::CORNERS.map(key), place);
        }
    }
    let mesh = mesh.finish(&[
        (side, &|q: &Point3| q.x.abs().max(q.y.abs()) == 1.0),
        (bottom, &|q: &Point3| q.z == 0.0),
        (top, &|q: &Point3| q.z == 1.0),
    ])?;
    Ok(into_kind(mesh, kind).moved(|q| map(onto_disc(q.x, q.y), q.z))?)
}

/// Maps the square [-1, 1]^2 onto the unit disc. The map is continuous, and smooth within each of the five
/// blocks.
fn onto_disc(x: f64, y: f64) -> [f64; 2] {
    let size = x.abs().max(y.abs());
    if size <= INNER {
        return core(x / INNER, y / INNER);
    }
    let [u, v] = [x / size, y / size];
    let t = (size - INNER) / (1.0 - INNER);
    let tangent = |c: f64| if c.abs() == 1.0 { c } else { (std::f64::consts::FRAC_PI_4 * c).tan() };
    let [a, b] = [tangent(u), tangent(v)];
    let length = a.hypot(b);
    let [cx, cy] = core(u, v);
    [cx * (1.0 - t) + a / length * t, cy * (1.0 - t) + b / length * t]
}

/// Maps the square onto the core, a blend of a square and a disc in which no corner is flat.
fn core(u: f64, v: f64) -> [f64; 2] {
    let round = [u * (1.0 - v * v / 2.0).sqrt(), v * (1.0 - u * u / 2.0).sqrt()];
    [CORE * (u * (1.0 - BULGE) + round[0] * BULGE), CORE * (v * (1.0 - BULGE) + round[1] * BULGE)]
}
