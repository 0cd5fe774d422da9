//! Sibson coordinates in a Delaunay mesh.
//!
//! A point put into the cloud takes from the Voronoi cell of each natural neighbour `i` the volume `V_i` (Sibson 1980).
//! That is the cell before less the cell after, and a Voronoi cell is made of one share of every tetrahedron at its
//! node: what is nearer to the node than the tetrahedron's other corners, cut along the perpendiculars from the
//! circumcentre, with a sign. So `V_i` is the shares of the tetrahedra whose circumsphere holds the point, known before,
//! less those of the tetrahedra that the point makes with the faces around them. No Voronoi cell is ever built.

use nalgebra::Matrix3;
use shape::{Point3, Vector3};

use crate::circumcentre::circumcentre;
use crate::delaunay::{Delaunay, FACES, NONE};
use crate::hull::DEPTH;
use crate::lanes::{LANES, Lanes};

/// A circumsphere holds a point up to half of this much of the tetrahedron's size beyond it. What is taken from a cell then is
/// wrong by the third power of that, and a point that lattices put on many spheres is constrained by all of them, in spite of
/// rounding.
const CLOSED: f64 = 1e-9;
/// Largest distance from a point to the mean of its neighbours, relative to the half-extent of the cloud, that is put right
/// as rounding.
const PRECISION: f64 = 1e-6;
/// Smaller ones are left.
const EXACT: f64 = 1e-14;
/// Coordinates much below this count as little, those much above it alike, where a linear field is fitted: beneath the hull
/// all but those of its own nodes are of the order of the depth.
const FADE: f64 = DEPTH;

/// A cloud of half-extent 1 about the origin, meshed, with all that does not depend on a target.
pub(crate) struct Voronoi {
    nodes: Vec<Point3>,
    cells: Vec<Cell>,
    /// Four of each cell, one after another.
    faces: Vec<Face>,
}

/// A tetrahedron.
struct Cell {
    corners: [u32; 4],
    /// Across each face; the number of cells, where there is none.
    neighbours: [u32; 4],
    /// Circumspheres of the neighbours: all are asked when a cell is, side by side.
    around: Spheres<4>,
    /// Planes of the faces, `n . x - d`, positive on the cell's side; always on the hull.
    walls: [Lanes<4>; 4],
    /// Three times the volume that is each corner's.
    shares: [f64; 4],
}

/// Circumspheres of tetrahedra.
#[derive(Clone, Copy)]
struct Spheres<const N: usize> {
    /// First corners.
    origin: [Lanes<N>; 3],
    /// Twice the circumcentres from there.
    centre: [Lanes<N>; 3],
    /// [`CLOSED`] times size and circumradius.
    reach: Lanes<N>,
}

/// A face, in the order of its corners in [`FACES`].
#[repr(align(64))] // one line of the cache
struct Face {
    nodes: [u32; 3],
    /// Normal, twice the area long; the cell is on its positive side.
    normal: Vector3,
    /// Areas of the triangle that are each corner's, over `|normal|`: times a circumcentre's height along the normal, what
    /// they make of three times a corner's share of the tetrahedron.
    shares: [f64; 3],
}

/// What one target needs, reused from target to target.
pub(crate) struct Workspace {
    /// Natural neighbours.
    pub(crate) nodes: Vec<u32>,
    /// Their coordinates.
    pub(crate) values: Vec<f64>,
    /// Rounding spoilt the volumes: the coordinates are those of the linear field that fits the neighbours best.
    pub(crate) fallback: bool,
    weights: Vec<f64>,
    volumes: Vec<f64>,
    listed: Vec<bool>,
    seen: Vec<u32>,
    stamp: u32,
    /// Cells that are opened, the first `cells` of a list that only grows: the next target writes over it.
    cavity: Vec<u32>,
    cells: usize,
    /// Faces around them, likewise.
    rim: Vec<u32>,
    faces: usize,
    last: u32,
}

impl Workspace {
    pub(crate) fn new(voronoi: &Voronoi) -> Workspace {
        let (nodes, cells) = (voronoi.nodes.len(), voronoi.cells.len());
        Workspace {
            nodes: Vec::new(),
            values: Vec::new(),
            fallback: false,
            weights: Vec::new(),
            volumes: vec![0.0; nodes],
            listed: vec![false; nodes],
            // One more for what is beyond the hull.
            seen: vec![0; cells + 1],
            stamp: 0,
            cavity: vec![0; 64],
            cells: 0,
            rim: vec![0; 64],
            faces: 0,
            last: 0,
        }
    }
}

impl Voronoi {
    /// Of nodes with the origin amid them and coordinates of the order of 1.
    pub(crate) fn new(nodes: Vec<Point3>, mesh: &Delaunay) -> Voronoi {
        let count = mesh.cells.len();
        let (mut spheres, mut faces) = (Vec::with_capacity(count + 1), Vec::with_capacity(4 * count));
        let mut shares = vec![[0.0; 4]; count];
        for (corners, shares) in mesh.cells.iter().zip(&mut shares) {
            let at = corners.map(|v| nodes[v as usize]);
            let centre = circumcentre(&at);
            for corner in FACES {
                let face = Face::new(corner.map(|i| corners[i]), corner.map(|i| at[i]));
                let height = (centre - (at[corner[0]] - at[0])).dot(&face.normal);
                for (i, share) in corner.into_iter().zip(face.shares) {
                    shares[i] += height * share;
                }
                faces.push(face);
            }
            let size = at.iter().map(|x| (x - at[0]).norm()).fold(0.0, f64::max);
            spheres.push((at[0].coords, 2.0 * centre, CLOSED * size * centre.norm()));
        }
        // Beyond the hull there is no sphere.
        spheres.push((Vector3::zeros(), Vector3::zeros(), f64::NEG_INFINITY));
        let cells = (mesh.cells.iter().zip(&mesh.neighbours).zip(shares).zip(faces.as_chunks::<4>().0))
            .map(|(((&corners, neighbours), shares), faces)| {
                let mut walls = [Lanes::all(0.0); 4];
                walls[3] = Lanes::all(f64::NEG_INFINITY);
                for k in (0..4).filter(|&k| neighbours[k] != NONE) {
                    let face: &Face = &faces[k];
                    (0..3).for_each(|axis| walls[axis].0[k] = face.normal[axis]);
                    walls[3].0[k] = face.normal.dot(&nodes[face.nodes[0] as usize].coords);
                }
                let neighbours = neighbours.map(|n| if n == NONE { count as u32 } else { n });
                Cell {
                    corners,
                    neighbours,
                    around: Spheres::new(neighbours.map(|n| &spheres[n as usize])),
                    walls,
                    shares,
                }
            })
            .collect();
        Voronoi { nodes, cells, faces }
    }

    /// The coordinates of a point within the hull, and of `inner` in its stead if that is given: the point then takes the
    /// linear field that fits the neighbours of `inner` best.
    #[inline(always)]
    pub(crate) fn coordinates(&self, x: &Point3, inner: Option<&Point3>, at: &mut Workspace) {
        let inside = inner.unwrap_or(x);
        at.nodes.clear();
        at.values.clear();
        at.fallback = false;
        let cell = self.locate(inside, at.last);
        at.last = cell;
        let corners = self.cells[cell as usize].corners;
        if let Some(&node) = corners.iter().find(|&&v| self.nodes[v as usize] == *x) {
            at.nodes.push(node);
            at.values.push(1.0);
            return;
        }
        self.open(inside, cell, at);
        self.volumes(inside, at);
        let total: f64 = at.values.iter().sum();
        at.values.iter_mut().for_each(|v| *v /= total);
        let gap = self.gap(inside, at);
        // Written so that a NaN is no sound coordinate, either.
        if !(gap.norm() < PRECISION) {
            at.values.fill(1.0 / at.nodes.len() as f64);
            at.fallback = true;
        }
        self.extend(x, at);
    }

    /// From the point to the mean of the neighbours by their coordinates: zero but for rounding (Sibson 1980).
    #[inline(always)]
    fn gap(&self, x: &Point3, at: &Workspace) -> Vector3 {
        // Loops here and below: closures of sums would not be inlined, and then not on wide registers.
        let mut gap = Vector3::zeros();
        for (&node, &value) in at.nodes.iter().zip(&at.values) {
            gap += (self.nodes[node as usize] - x) * value;
        }
        gap
    }

    /// The cell that holds the point, by walking towards it, each time through the face beyond which the point is farthest: its
    /// circumsphere does, too.
    #[inline(always)]
    fn locate(&self, x: &Point3, start: u32) -> u32 {
        let mut cell = start;
        for _ in 0..self.cells.len() {
            let Cell { walls: [x_of, y_of, z_of, from], neighbours, .. } = &self.cells[cell as usize];
            let mut deepest = (0.0, cell);
            for k in 0..4 {
                let height = x_of.0[k] * x.x + y_of.0[k] * x.y + z_of.0[k] * x.z - from.0[k];
                deepest = if height < deepest.0 { (height, neighbours[k]) } else { deepest };
            }
            if deepest.1 == cell {
                break;
            }
            cell = deepest.1;
        }
        // A flat cell may seem to hold any point of its plane, or turn the walk in a circle.
        let sphere_holds = |cell: &u32| {
            let across = self.cells[*cell as usize].neighbours;
            let seen_from = across.into_iter().find(|&n| (n as usize) < self.cells.len());
            seen_from.is_none_or(|from| {
                let Cell { neighbours, around, .. } = &self.cells[from as usize];
                neighbours.iter().zip(around.hold(x)).any(|(n, holds)| n == cell && holds)
            })
        };
        if sphere_holds(&cell) {
            return cell;
        }
        (0..self.cells.len() as u32).find(sphere_holds).unwrap_or(cell)
    }

    /// Collects the cells whose circumsphere holds the point, and the rim of faces around them, all of which see the
    /// point from within: of the two cells at a face it is on the side of the one whose sphere it is deeper in.
    ///
    /// Every neighbour is written to either list and counted in one: as many are within as without, and a branch would be
    /// mispredicted.
    #[inline(always)]
    fn open(&self, x: &Point3, start: u32, at: &mut Workspace) {
        at.stamp = match at.stamp.checked_add(1) {
            Some(stamp) => stamp,
            None => {
                at.seen.fill(0);
                1
            }
        };
        at.seen[start as usize] = at.stamp;
        let Workspace { cavity, rim, seen, stamp, .. } = at;
        cavity[0] = start;
        let (mut next, mut cells, mut faces) = (0, 1, 0);
        while next < cells {
            let cell = cavity[next];
            next += 1;
            grow(cavity, cells + 4);
            grow(rim, faces + 4);
            let (found, open) = (&mut cavity[cells..cells + 4], &mut rim[faces..faces + 4]);
            let (mut new, mut closed) = (0, 0);
            let Cell { neighbours, around, .. } = &self.cells[cell as usize];
            let holds = around.hold(x);
            for k in 0..4 {
                let seen = &mut seen[neighbours[k] as usize];
                let known = *seen == *stamp;
                let within = holds[k] | known;
                *seen = if within { *stamp } else { *seen };
                // At most `k` are counted so far.
                found[new % 4] = neighbours[k];
                new += usize::from(holds[k] & !known);
                open[closed % 4] = 4 * cell + k as u32;
                closed += usize::from(!within);
            }
            cells += new;
            faces += closed;
        }
        (at.cells, at.faces) = (cells, faces);
    }

    /// Three times the volumes that the point takes from its neighbours.
    #[inline(always)]
    fn volumes(&self, x: &Point3, at: &mut Workspace) {
        for &cell in &at.cavity[..at.cells] {
            let Cell { corners, shares, .. } = &self.cells[cell as usize];
            let listed = at.nodes.len();
            at.nodes.extend_from_slice(corners);
            let mut new = 0;
            for (&node, share) in corners.iter().zip(shares) {
                at.nodes[listed + new % 4] = node;
                new += usize::from(!std::mem::replace(&mut at.listed[node as usize], true));
                at.volumes[node as usize] += share;
            }
            at.nodes.truncate(listed + new);
        }
        for group in at.rim[..at.faces].chunks(LANES) {
            // Lanes beyond the last face repeat it, and are not read.
            let mut tets = Tetrahedra::new();
            let mut nodes = [[0; 3]; LANES];
            for lane in 0..LANES {
                let face = &self.faces[group[lane.min(group.len() - 1)] as usize];
                nodes[lane] = face.nodes;
                tets.set(lane, face, face.nodes.map(|v| self.nodes[v as usize] - x));
            }
            let shares = tets.shares();
            for (lane, nodes) in nodes.iter().enumerate().take(group.len()) {
                for (&node, share) in nodes.iter().zip(&shares) {
                    at.volumes[node as usize] -= share.0[lane];
                }
            }
        }
        for &node in &at.nodes {
            at.values.push(std::mem::take(&mut at.volumes[node as usize]));
            at.listed[node as usize] = false;
        }
    }

    /// Carries the coordinates on to a point apart from the mean of the neighbours, by the linear field that fits their values best,
    /// each weighted by `omega_i = lambda_i / (lambda_i + FADE)`: `lambda_i + omega_i (x - sum_j lambda_j x_j) . M^-1 (x_i - m)`,
    /// `m` and `M` mean and second moment of the neighbours so weighted. Twice, so that linear fields are exact to the last
    /// digits however far the point is, and however rounding left the volumes.
    ///
    /// Sibson (1981) weights by `lambda_i / |x_i - x|^2`; on a hull that is almost flat this leaves the slope across it to
    /// the neighbours just beneath, and weights of 37 at a tenth of the kidney beyond its hull, where these stay below 8.
    #[inline(always)]
    fn extend(&self, x: &Point3, at: &mut Workspace) {
        at.weights.clear();
        for _ in 0..2 {
            let gap = self.gap(x, at);
            let Workspace { nodes, values, weights, .. } = &mut *at;
            let offset = |i: u32| self.nodes[i as usize] - x;
            if gap.norm() < EXACT {
                return;
            }
            if weights.is_empty() {
                weights.extend(values.iter().map(|value| value.max(0.0) / (value.max(0.0) + FADE)));
            }
            let total: f64 = weights.iter().sum();
            let (mut mean, mut moment) = (Vector3::zeros(), Matrix3::zeros());
            for (&i, &w) in nodes.iter().zip(&*weights) {
                mean += offset(i) * w;
            }
            mean /= total;
            for (&i, &w) in nodes.iter().zip(&*weights) {
                moment += (offset(i) - mean) * (offset(i) - mean).transpose() * w;
            }
            let Some(inverse) = moment.try_inverse() else { return };
            let missing = 1.0 - values.iter().sum::<f64>();
            let slope = inverse * (gap + mean * missing);
            for ((&node, weight), value) in nodes.iter().zip(&*weights).zip(&mut *values) {
                *value += weight * (missing / total - slope.dot(&(offset(node) - mean)));
            }
        }
    }
}

/// Room for so many, and for as many again.
#[inline(always)]
fn grow(list: &mut Vec<u32>, length: usize) {
    if list.len() < length {
        list.resize(2 * length, 0);
    }
}

impl<const N: usize> Spheres<N> {
    /// From origins, centres and reaches.
    fn new(each: [&(Vector3, Vector3, f64); N]) -> Spheres<N> {
        Spheres {
            origin: [0, 1, 2].map(|axis| Lanes(each.map(|sphere| sphere.0[axis]))),
            centre: [0, 1, 2].map(|axis| Lanes(each.map(|sphere| sphere.1[axis]))),
            reach: Lanes(each.map(|sphere| sphere.2)),
        }
    }

    /// Which hold the point: `|x - c|^2 <= R^2`, without the difference of two large squares.
    #[inline(always)]
    fn hold(&self, x: &Point3) -> [bool; N] {
        let mut beyond = [0.0; N];
        for lane in 0..N {
            let y = [0, 1, 2].map(|axis| x[axis] - self.origin[axis].0[lane]);
            let z = [0, 1, 2].map(|axis| y[axis] - self.centre[axis].0[lane]);
            beyond[lane] = y[0] * z[0] + y[1] * z[1] + y[2] * z[2] - self.reach.0[lane];
        }
        beyond.map(|beyond| beyond <= 0.0)
    }
}

impl Face {
    fn new(nodes: [u32; 3], [a, b, c]: [Point3; 3]) -> Face {
        // `orient3d` is positive on the side from which the corners turn clockwise.
        let normal = (c - a).cross(&(b - a));
        let square = normal.norm_squared();
        let dots = [(b - a).dot(&(c - a)), (c - b).dot(&(a - b)), (a - c).dot(&(b - c))];
        let sides = [(c - b).norm_squared(), (a - c).norm_squared(), (b - a).norm_squared()];
        // The triangle's share of corner 0 is (|01|^2 cot 2 + |02|^2 cot 1) / 8, a cotangent the dot over |normal|.
        let shares = std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            (sides[k] * dots[k] + sides[j] * dots[j]) / (8.0 * square)
        });
        Face { nodes, normal, shares }
    }
}

/// The tetrahedra that eight faces make with the origin, which is on their positive side.
struct Tetrahedra {
    normal: [Lanes; 3],
    shares: [Lanes; 3],
    /// Of the faces, from the origin.
    corners: [[Lanes; 3]; 3],
}

impl Tetrahedra {
    #[inline(always)]
    fn new() -> Tetrahedra {
        let zeros = [Lanes::all(0.0); 3];
        Tetrahedra { normal: zeros, shares: zeros, corners: [zeros; 3] }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, face: &Face, corners: [Vector3; 3]) {
        for i in 0..3 {
            self.normal[i].0[lane] = face.normal[i];
            self.shares[i].0[lane] = face.shares[i];
            for axis in 0..3 {
                self.corners[i][axis].0[lane] = corners[i][axis];
            }
        }
    }

    /// Three times the volumes that are the faces' corners'. Lane by lane: sums and products of whole lanes the compiler takes
    /// apart, a loop over lanes it puts together.
    #[inline(always)]
    fn shares(&self) -> [Lanes; 3] {
        let mut shares = [[0.0; LANES]; 3];
        for lane in 0..LANES {
            let of = |lanes: &[Lanes; 3]| [lanes[0].0[lane], lanes[1].0[lane], lanes[2].0[lane]];
            let corners = [of(&self.corners[0]), of(&self.corners[1]), of(&self.corners[2])];
            let of_lane = corner_shares(&of(&self.normal), &of(&self.shares), &corners);
            (shares[0][lane], shares[1][lane], shares[2][lane]) = (of_lane[0], of_lane[1], of_lane[2]);
        }
        shares.map(Lanes)
    }
}

/// Three times the volumes that are the corners' of a face, of the tetrahedron that it makes with the origin.
#[inline(always)]
fn corner_shares(normal: &[f64; 3], areas: &[f64; 3], [a, b, c]: &[[f64; 3]; 3]) -> [f64; 3] {
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (aa, bb, cc) = (dot(a, a), dot(b, b), dot(c, c));
    let (ab, bc, ca) = (dot(a, b), dot(b, c), dot(c, a));
    // Products of the normals b x c, c x a and a x b: cofactors of the matrix of products above.
    let (naa, nbb, ncc) = (bb * cc - bc * bc, cc * aa - ca * ca, aa * bb - ab * ab);
    let (nab, nbc, nca) = (bc * ca - ab * cc, ca * ab - bc * aa, ab * bc - ca * bb);
    // Heights of the circumcentre over the four faces, times their normals, inwards.
    let height = -dot(normal, a);
    let scale = 0.5 / height;
    let ha = (aa * naa + bb * nab + cc * nca) * scale;
    let hb = (aa * nab + bb * nbb + cc * nbc) * scale;
    let hc = (aa * nca + bb * nbc + cc * ncc) * scale;
    let top = height - (ha + hb + hc);
    // Over eight times its product each; one division for three.
    let each = 0.125 / (naa * nbb * ncc);
    let (ha, hb, hc) = (ha * (nbb * ncc * each), hb * (ncc * naa * each), hc * (naa * nbb * each));
    // Share of a in the triangle (0, a, b): |b|^2 (|a|^2 + a.b) - 2 (a.b)^2 over 8 |a x b|.
    let share = |p: f64, q: f64, pq: f64| q * (p + pq) - (pq + pq) * pq;
    [
        top * areas[0] + hb * share(aa, cc, ca) + hc * share(aa, bb, ab),
        top * areas[1] + hc * share(bb, aa, ab) + ha * share(bb, cc, bc),
        top * areas[2] + ha * share(cc, bb, bc) + hb * share(cc, aa, ca),
    ]
}
