//! Meshes of the ball and the kidney, its image. The ball has seven blocks: a cube and six pyramid frustums
//! around it.

use super::{GenerateError, check_cells, check_positive, check_total, into_kind, lattice, surfaces};
use crate::element::CellKind;
use crate::mesh::Mesh;
use crate::shapes::Kidney;
use crate::{Point3, Vector3, quality};

/// Half side of the inner cube in the parameter space, in which the whole ball is the cube [-1, 1]^3.
const INNER: f64 = 0.5;
/// Fraction by which the corners of the inner cube are drawn in towards a sphere: 0 leaves a cube, 1 makes a
/// ball.
const BULGE: f64 = 0.35;
/// Radius at which the faces of the inner block cross the axes, as a fraction of the ball's radius.
const CORE: f64 = 0.45;

/// Meshes a ball of `radius` (m) around the origin, with `n` hexahedra along each edge of an inner cube and
/// `(n + 1) / 2` layers around it. The total is `n^3 + 6 n^2 ((n + 1) / 2)` hexahedra, or six times as many
/// tetrahedra. Facet group: "surface". Quadratic surface nodes lie on the sphere.
///
/// The mesh is the image of a mesh of the cube [-1, 1]^3. For even `n`, the hexahedra of this cube for `2 n`
/// are those for `n`, halved along each axis. The corner nodes of `n` are therefore also corner nodes of
/// `2 n`, `4 n`, ...
///
/// # Errors
/// A radius that is not positive, or `n` out of range.
pub fn ball_mesh(kind: CellKind, radius: f64, n: usize) -> Result<Mesh, GenerateError> {
    check_positive("the radius", radius)?;
    let unit = unit_ball(kind, n)?;
    Ok(unit.moved(|p| Point3::from(p.coords * radius))?)
}

/// Meshes the kidney: the mesh of [`ball_mesh`] with unit radius and the same `n`, with every node mapped by
/// [`Kidney::map`]. Mid-edge nodes are mapped too, so those of the boundary lie on the surface of the kidney.
/// Facet group: "surface". Tet10 cells need `n` of at least 2.
///
/// # Errors
/// `n` out of range, or inverted cells.
pub fn kidney_mesh(kind: CellKind, n: usize) -> Result<Mesh, GenerateError> {
    let mesh = unit_ball(kind, n)?.moved(|p| Kidney.map(p))?;
    if n == 1 {
        // With n = 1, tet10 cells cannot follow the bend and are inverted. From n = 2 on all kinds are valid.
        quality::check_inversion(&mesh)?;
    }
    Ok(mesh)
}

/// Strength of the grading of [`half_kidney_mesh`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// Cells of 0.27 of the uniform size under the jaw's edges and 0.30 under the surface, the strongest
    /// grading that a coarse mesh allows. The inner block has `3 n` cells along x, `7 n / 2` along y and
    /// `(n - 1) / 2` along z from z = 0 to its top, with `n` layers around it.
    ///
    /// Between jaws that close by 7 mm, the force of 5,149 hex20 nodes is within 0.6 % of that of 14,219
    /// nodes with mild grading, from 1.4 mm on. Finer meshes fold: with 11,216 nodes, hex20-p1 was unstable
    /// from 6.0 mm on and a cell of hex20-reduced inverted at 6.3 mm.
    Strongly,
    /// Cells of 0.38 of the uniform size under the edges and 0.55 under the surface, for fine meshes, whose
    /// cells fold under the stronger grading. The counts in the same order are `16 n / 5`, `4 n`, `3 n / 5`
    /// and `4 n / 5`.
    Mildly,
}

impl Drawn {
    /// Returns the cells of the inner block along x, y and z (both halves), and the layers around the block.
    /// The counts along z and of layers are at least 1 per half.
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

/// Meshes the half z >= 0 of the kidney for compression by a jaw, which is centred on the z axis and measures
/// 10 mm along x and 20 mm along y. Cells are graded towards the surface and towards the edges of the jaw;
/// `drawn` is the strength of the grading. `n` is about half the number of cells across the jaw in each
/// direction. Facet groups: "surface", and "symmetry" at z = 0.
///
/// # Errors
/// `n` out of range, or inverted cells.
pub fn half_kidney_mesh(kind: CellKind, n: usize, drawn: Drawn) -> Result<Mesh, GenerateError> {
    check_cells("the number of cells across the jaw", n)?;
    let (cells, layers) = drawn.cells(n);
    let blocks = Blocks { cells, layers, jaw: Some(drawn) };
    let mesh = parameter_ball(kind, blocks)?.moved(|p| Kidney.map(&onto_ball(p)))?;
    quality::check(&mesh)?;
    Ok(mesh)
}

/// Division of the parameter cube into cells.
#[derive(Clone, Copy)]
struct Blocks {
    /// Cells of the inner block along x, y and z.
    cells: [usize; 3],
    /// Layers around the inner block.
    layers: usize,
    /// Grading towards a jaw, for a mesh of only the half above z = 0; `cells[2]` is then even.
    jaw: Option<Drawn>,
}

fn unit_ball(kind: CellKind, n: usize) -> Result<Mesh, GenerateError> {
    check_cells("the number of cells across the ball", n)?;
    let mesh = parameter_ball(kind, Blocks { cells: [n; 3], layers: n.div_ceil(2), jaw: None })?;
    Ok(mesh.moved(onto_ball)?)
}

/// Meshes the parameter cube [-1, 1]^3, or its upper half, with cells of the requested kind.
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
    // On the surface one parameter is exactly +-1; a mid-edge node between two such nodes keeps this value.
    let surface = |q: &Point3| q.coords.amax() == 1.0;
    let symmetry = |q: &Point3| q.z == 0.0;
    let groups: [lattice::Group; 2] = [(surfaces::BALL[0], &surface), (surfaces::HALF[0], &symmetry)];
    Ok(into_kind(mesh.finish(&groups[..1 + jaw.is_some() as usize])?, kind))
}

/// Maps the key (i, j, k, layer) to the parameter cube. Layer 0 is the inner cube, the last layer the
/// surface.
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

/// Parameter of the jaw's edges. The jaw is flat up to 3.5 and 8.5 mm and ends at 5 and 10 mm: parameters
/// 0.26 and 0.29 to 0.37 and 0.35. Of the values 0.27 to 0.36, 0.30 gave the smallest force error, 1.0 %
/// (3,519 nodes).
const EDGE: f64 = 0.30;

/// Concentrates [-1, 1] around +-[`EDGE`] (Roberts 1971, as in Tannehill, Anderson & Pletcher 1997, section
/// 5.6).
fn towards_edge(u: f64, strength: f64) -> f64 {
    let at = 0.5 / strength * ((1.0 + strength.exp_m1() * EDGE) / (1.0 + (-strength).exp_m1() * EDGE)).ln();
    let share = EDGE * (1.0 + (strength * (u.abs() - at)).sinh() / (strength * at).sinh());
    if u.abs() == 1.0 { u } else { share.copysign(u) }
}

/// Concentrates [0, 1] towards 1.
fn towards_surface(t: f64, strength: f64) -> f64 {
    1.0 - (strength * (1.0 - t)).sinh() / strength.sinh()
}

/// Maps the parameter cube onto the unit ball. The map is continuous, and smooth within each of the seven
/// blocks.
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

/// Maps the unit cube onto the inner block, a blend of a cube and a ball in which no corner is flat.
fn core(u: &Vector3) -> Point3 {
    let [x2, y2, z2] = [u.x * u.x, u.y * u.y, u.z * u.z];
    // Smooth map of the cube onto the ball (Nowell 2005), which by itself is degenerate at the edges.
    let round = Vector3::new(
        u.x * (1.0 - y2 / 2.0 - z2 / 2.0 + y2 * z2 / 3.0).sqrt(),
        u.y * (1.0 - z2 / 2.0 - x2 / 2.0 + z2 * x2 / 3.0).sqrt(),
        u.z * (1.0 - x2 / 2.0 - y2 / 2.0 + x2 * y2 / 3.0).sqrt(),
    );
    Point3::from(CORE * (u * (1.0 - BULGE) + round * BULGE))
}
