//! The ball as seven blocks (a cube in the middle, six pyramids' frustums around it), and the kidney as its image.

use super::{GenerateError, check_cells, check_positive, check_total, into_kind, lattice, surfaces};
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

/// How far the cells of [`half_kidney_mesh`] are drawn together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// To 0.27 of equal cells under the jaw's edges and to 0.30 under the surface: the most that a coarse mesh can do. `3 n` and `7 n / 2`
    /// cells across the inner block along x and y, `(n - 1) / 2` from z = 0 to its top, and `n` layers around it.
    ///
    /// Between jaws that close by 7 mm, the force by 5,149 nodes of hex20 is within 0.6 % of that by 14,219, drawn mildly,
    /// from 1.4 mm on. Finer ones fold: on 11,216 nodes hex20-p1 was unstable from 6.0 mm on, hex20-reduced turned inside out at 6.3 mm.
    Strongly,
    /// To 0.38 and 0.55: for fine meshes, of which cells so thin fold. `16 n / 5`, `4 n`, `3 n / 5` and `4 n / 5`.
    Mildly,
}

impl Drawn {
    /// Cells across the inner block, of both halves along z, and layers around it; each at least 1 on a side.
    fn cells(self, n: usize) -> ([usize; 3], usize) {
        match self {
            Drawn::Strongly => ([3 * n, 7 * n / 2, 2 * (n.saturating_sub(1) / 2).max(1)], n),
            Drawn::Mildly => ([16 * n / 5, 4 * n, 2 * (3 * n / 5).max(1)], (4 * n / 5).max(1)),
        }
    }

    /// Strengths of [`towards_edge`] and [`towards_surface`].
    fn strengths(self) -> [f64; 2] {
        match self {
            Drawn::Strongly => [6.0, 3.0],
            Drawn::Mildly => [5.0, 2.0],
        }
    }
}

/// The half z >= 0 of the kidney, cells drawn together under the surface and under the edges of a jaw of 10 x 20 mm
/// on the z axis, `n` about half of those across the jaw. Facet groups: "surface", and "symmetry" at z = 0.
pub fn half_kidney_mesh(kind: CellKind, n: usize, drawn: Drawn) -> Result<Mesh, GenerateError> {
    check_cells("the number of cells across the jaw", n)?;
    let (cells, layers) = drawn.cells(n);
    let blocks = Blocks { cells, layers, jaw: Some(drawn) };
    let mesh = parameter_ball(kind, blocks)?.moved(|p| Kidney.map(&onto_ball(p)))?;
    quality::check(&mesh)?;
    Ok(mesh)
}

/// How the parameter cube is cut.
#[derive(Clone, Copy)]
struct Blocks {
    /// Cells of the inner block along x, y and z.
    cells: [usize; 3],
    /// Layers around it.
    layers: usize,
    /// If only the half above z = 0 is wanted, graded towards a jaw on it; `cells[2]` is even then.
    jaw: Option<Drawn>,
}

fn unit_ball(kind: CellKind, n: usize) -> Result<Mesh, GenerateError> {
    check_cells("the number of cells across the ball", n)?;
    let mesh = parameter_ball(kind, Blocks { cells: [n; 3], layers: n.div_ceil(2), jaw: None })?;
    Ok(mesh.moved(onto_ball)?)
}

/// The parameter cube [-1, 1]^3, or its upper half, as hexahedra, cut into the cells asked for.
fn parameter_ball(kind: CellKind, blocks: Blocks) -> Result<Mesh, GenerateError> {
    let Blocks { cells: [nx, ny, nz], layers, jaw } = blocks;
    check_total([nx, ny, nz + 6 * layers])?;
    let mut mesh = lattice::Lattice::default();
    let below = jaw.map_or(0, |_| nz / 2);
    let mut add = |corners: [lattice::Key; 8]| {
        if corners.iter().all(|c| c[2] as usize >= below) {
            mesh.hexahedron(corners, |key| parameters(key, blocks));
        }
    };
    for (i, j, k) in lattice::triples([nx, ny, nz]) {
        add(lattice::CORNERS.map(|(a, b, c)| [i + a, j + b, k + c, 0].map(|v| v as u32)));
    }
    for side in 0..6 {
        let [across, along] = lattice::side_cells(side, [nx, ny, nz]);
        for (i, j, layer) in lattice::triples([across, along, layers]) {
            let key = |(a, b, c)| {
                let [x, y, z] = lattice::on_cube_side(side, [nx, ny, nz], i + a, j + b);
                [x, y, z, layer + c].map(|v| v as u32)
            };
            add(lattice::CORNERS.map(key));
        }
    }
    // On the surface one parameter is +-1 exactly; mid-edge nodes between two of them keep it.
    let surface = |q: &Point3| q.coords.amax() == 1.0;
    let symmetry = |q: &Point3| q.z == 0.0;
    let groups: [lattice::Group; 2] = [(surfaces::BALL[0], &surface), (surfaces::HALF[0], &symmetry)];
    Ok(into_kind(mesh.finish(&groups[..1 + jaw.is_some() as usize])?, kind))
}

/// Key (i, j, k, layer) to the parameter cube: layer 0 is the inner cube, the last layer the surface.
fn parameters(key: lattice::Key, blocks: Blocks) -> Point3 {
    let out = key[3] as f64 / blocks.layers as f64;
    let across = |d: usize| 2.0 * key[d] as f64 / blocks.cells[d] as f64 - 1.0;
    let (out, [x, y]) = match blocks.jaw {
        Some(drawn) => {
            let [edge, surface] = drawn.strengths();
            (towards_surface(out, surface), [across(0), across(1)].map(|u| towards_edge(u, edge)))
        }
        None => (out, [across(0), across(1)]),
    };
    Point3::from((INNER + (1.0 - INNER) * out) * Vector3::new(x, y, across(2)))
}

/// Where the jaw's edges stand in the parameters: they leave the flat at 3.5 and 8.5 mm and end at 5 and 10 mm, which
/// are the parameters 0.26 and 0.29 to 0.37 and 0.35. Of 0.27 to 0.36 the force was least off, by 1.0 %, with 0.30 (3,519 nodes).
const EDGE: f64 = 0.30;

/// Draws [-1, 1] together around +-[`EDGE`] (Roberts 1971, as in Tannehill, Anderson & Pletcher 1997, section 5.6).
fn towards_edge(u: f64, strength: f64) -> f64 {
    let at = 0.5 / strength * ((1.0 + strength.exp_m1() * EDGE) / (1.0 + (-strength).exp_m1() * EDGE)).ln();
    let share = EDGE * (1.0 + (strength * (u.abs() - at)).sinh() / (strength * at).sinh());
    if u.abs() == 1.0 { u } else { share.copysign(u) }
}

/// Draws [0, 1] together towards 1.
fn towards_surface(t: f64, strength: f64) -> f64 {
    1.0 - (strength * (1.0 - t)).sinh() / strength.sinh()
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
