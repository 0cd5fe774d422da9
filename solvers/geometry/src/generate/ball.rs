//! The ball as seven blocks (a cube in the middle, six pyramids' frustums around it), and the kidney as its image.

use super::{GenerateError, check_cells, check_positive, check_total, into_kind, lattice};
use crate::{CellKind, Mesh, Point3, Vector3, quality, shapes::Kidney};

/// Half side of the inner cube in the parameter space, where the whole ball is the cube [-1, 1]^3.
const INNER: f64 = 0.5;
/// How much of the inner cube's corners is drawn in towards a sphere: 0 leaves a cube, 1 makes a ball.
const BULGE: f64 = 0.35;
/// Radius at which the inner block's faces cross the axes, as a share of the ball's.
const CORE: f64 = 0.45;

/// A ball of `radius` (m) around the origin: `n` hexahedra along each edge of an inner cube and `(n + 1) / 2`
/// layers around it, `n^3 + 6 n^2 ((n + 1) / 2)` in all (six tetrahedra in each). Facet group: "surface".
/// Quadratic surface nodes lie on the sphere. Meshes of `n`, `2 n`, `4 n`, .. are nested in the parameters for even
/// `n`.
pub fn ball_mesh(kind: CellKind, radius: f64, n: usize) -> Result<Mesh, GenerateError> {
    check_positive("the radius", radius)?;
    let unit = unit_ball(kind, n)?;
    Ok(unit.moved(|p| Point3::from(p.coords * radius))?)
}

/// The kidney: the unit ball of [`ball_mesh`] through [`Kidney::map`], every node (mid-edge ones too) exactly on
/// its image. Facet group: "surface". Tet10 cells need `n` of at least 2.
pub fn kidney_mesh(kind: CellKind, n: usize) -> Result<Mesh, GenerateError> {
    let mesh = unit_ball(kind, n)?.moved(|p| Kidney.map(p))?;
    if n == 1 {
        // So few tet10 can't follow the bend and turn inside out; from n = 2 on all kinds are sound.
        quality::check(&mesh)?;
    }
    Ok(mesh)
}

fn unit_ball(kind: CellKind, n: usize) -> Result<Mesh, GenerateError> {
    check_cells("the number of cells across the ball", n)?;
    let layers = n.div_ceil(2);
    check_total([n, n, n + 6 * layers])?;
    let mut mesh = lattice::Lattice::default();
    let place = |key| parameters(key, n, layers);
    for (i, j, k) in lattice::triples([n, n, n]) {
        mesh.hexahedron(lattice::CORNERS.map(|(a, b, c)| [i + a, j + b, k + c, 0].map(|v| v as u32)), place);
    }
    for side in 0..6 {
        for (i, j, layer) in lattice::triples([n, n, layers]) {
            let key = |(a, b, c)| {
                let [x, y, z] = lattice::on_cube_side(side, n, i + a, j + b);
                [x, y, z, layer + c].map(|v| v as u32)
            };
            mesh.hexahedron(lattice::CORNERS.map(key), place);
        }
    }
    // On the surface one parameter is +-1 exactly; mid-edge nodes between two of them keep it.
    let surface = |q: &Point3| q.coords.amax() == 1.0;
    let mesh = into_kind(mesh.finish(&[("surface", &surface)])?, kind);
    Ok(mesh.moved(onto_ball)?)
}

/// Key (i, j, k, layer) to the parameter cube: layer 0 is the inner cube, the last layer the surface.
fn parameters(key: lattice::Key, n: usize, layers: usize) -> Point3 {
    let scale = INNER + (1.0 - INNER) * key[3] as f64 / layers as f64;
    Point3::from(Vector3::from_fn(|d, _| scale * (2.0 * key[d] as f64 / n as f64 - 1.0)))
}

/// The parameter cube onto the unit ball: continuous, smooth within each of the seven blocks.
fn onto_ball(q: &Point3) -> Point3 {
    let size = q.coords.amax();
    if size <= INNER {
        return core(&(q.coords / INNER));
    }
    let direction = q.coords / size;
    let t = (size - INNER) / (1.0 - INNER);
    let outer = lattice::onto_sphere(&direction);
    if t == 1.0 {
        return Point3::from(outer);
    }
    Point3::from(core(&direction).coords * (1.0 - t) + outer * t)
}

/// The unit cube onto the inner block: between a cube and a ball, so that no corner is flat.
fn core(u: &Vector3) -> Point3 {
    let [x2, y2, z2] = [u.x * u.x, u.y * u.y, u.z * u.z];
    // Smooth map of the cube onto the ball (Nowell 2005); degenerate at the edges when taken whole.
    let round = Vector3::new(
        u.x * (1.0 - y2 / 2.0 - z2 / 2.0 + y2 * z2 / 3.0).sqrt(),
        u.y * (1.0 - z2 / 2.0 - x2 / 2.0 + z2 * x2 / 3.0).sqrt(),
        u.z * (1.0 - x2 / 2.0 - y2 / 2.0 + x2 * y2 / 3.0).sqrt(),
    );
    Point3::from(CORE * (u * (1.0 - BULGE) + round * BULGE))
}
