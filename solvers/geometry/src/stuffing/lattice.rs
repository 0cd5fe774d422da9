//! Lattice of tetrahedra between the centres and corners of cubes (Labelle and Shewchuk 2007, section 3).
//!
//! Two cubes of equal size that share a face have four tetrahedra between them, one for each edge of the
//! face. All their angles are 60 or 90 degrees. At changes of the cube size, these tetrahedra are cut into
//! two or four parts, or a pyramid on the smaller face is cut into two.

use std::collections::HashMap;

use super::octree::{Cube, Octree, State, middle};

/// Points in units of half the smallest cube, and the tetrahedra between them.
#[derive(Default)]
pub(super) struct Lattice {
    pub points: Vec<[i32; 3]>,
    /// Tetrahedra between two smallest cubes, as indices into `points`: the centres of both cubes, then two
    /// corners of their common face. The edge between the centres and the edge between the corners are as
    /// long as the edge of a cube; the other four edges are shorter.
    pub regular: Vec<[u32; 4]>,
    /// All other tetrahedra, as indices into `points`: between larger cubes, and at changes of the cube size.
    pub coarse: Vec<[u32; 4]>,
    index: HashMap<[i32; 3], u32>,
}

/// A cube and one of its faces.
#[derive(Clone, Copy)]
struct Face {
    cube: Cube,
    level: usize,
    axis: usize,
    /// Side of the cube along the axis, -1 or 1.
    side: i32,
}

impl Face {
    /// The adjacent cube of the same size across the face.
    fn across(&self) -> Cube {
        let mut cube = self.cube;
        cube[self.axis] += self.side;
        cube
    }

    /// Axes within the face.
    fn within(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// Corners in order around the face, in halves of the smallest cube.
    fn corners(&self) -> [[i32; 3]; 4] {
        let half = 1 << self.level;
        let [u, v] = self.within();
        [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(|[a, b]| {
            let mut key = middle(self.cube, self.level);
            key[self.axis] += self.side * half;
            key[u] += a * half;
            key[v] += b * half;
            key
        })
    }

    /// Step to the adjacent cube across an edge, which runs from a corner to the next.
    fn beyond(&self, edge: usize) -> [i32; 3] {
        let [u, v] = self.within();
        let mut step = [0; 3];
        match edge {
            0 => step[v] = -1,
            1 => step[u] = 1,
            2 => step[v] = 1,
            _ => step[u] = -1,
        }
        step
    }
}

fn between(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    std::array::from_fn(|axis| (a[axis] + b[axis]) / 2)
}

impl Lattice {
    pub(super) fn new(octree: &Octree) -> Lattice {
        let mut lattice = Lattice::default();
        for level in 0..octree.levels.len() {
            for cube in octree.leaves(level) {
                for (axis, side) in [(0, -1), (0, 1), (1, -1), (1, 1), (2, -1), (2, 1)] {
                    lattice.face(octree, Face { cube, level, axis, side });
                }
            }
        }
        lattice
    }

    fn face(&mut self, octree: &Octree, face: Face) {
        let own = middle(face.cube, face.level);
        match octree.state(face.across(), face.level) {
            // Each face between equal cubes is added only once.
            Some(State::Leaf) if face.side == 1 => self.equal(octree, face),
            Some(State::Leaf) => {}
            Some(State::Divided) => {
                let corners = face.corners();
                let centre = between(corners[0], corners[2]);
                for edge in 0..4 {
                    let (from, to) = (corners[edge], corners[(edge + 1) % 4]);
                    let half = between(from, to);
                    self.add(false, [own, centre, from, half]);
                    self.add(false, [own, centre, half, to]);
                }
            }
            None => {
                let parent = face.across().map(|x| x >> 1);
                if octree.state(parent, face.level + 1) != Some(State::Leaf) {
                    return;
                }
                // The diagonal starts at the centre of the larger face.
                let larger = middle(parent, face.level + 1);
                let corners = face.corners();
                let is_centre =
                    |corner: &[i32; 3]| face.within().iter().all(|&axis| corner[axis] == larger[axis]);
                let centre = corners.iter().position(is_centre).unwrap_or(0);
                let [a, b, c, d] = [0, 1, 2, 3].map(|next| corners[(centre + next) % 4]);
                self.add(false, [own, a, b, c]);
                self.add(false, [own, a, c, d]);
            }
        }
    }

    /// Adds the tetrahedra between two cubes of equal size. Edges of the face that smaller cubes halve are
    /// halved here too.
    fn equal(&mut self, octree: &Octree, face: Face) {
        let across = face.across();
        let own = middle(face.cube, face.level);
        let other = middle(across, face.level);
        let corners = face.corners();
        for edge in 0..4 {
            let step = face.beyond(edge);
            let halved = [face.cube, across].iter().any(|cube| {
                let next = std::array::from_fn(|a| cube[a] + step[a]);
                octree.state(next, face.level) == Some(State::Divided)
            });
            let (from, to) = (corners[edge], corners[(edge + 1) % 4]);
            if halved {
                let half = between(from, to);
                self.add(false, [own, other, from, half]);
                self.add(false, [own, other, half, to]);
            } else {
                self.add(face.level == 0, [own, other, from, to]);
            }
        }
    }

    fn add(&mut self, regular: bool, keys: [[i32; 3]; 4]) {
        let points = &mut self.points;
        let mut place = |key: [i32; 3]| {
            *self.index.entry(key).or_insert_with(|| {
                points.push(key);
                points.len() as u32 - 1
            })
        };
        let tet = keys.map(&mut place);
        if regular { self.regular.push(tet) } else { self.coarse.push(tet) }
    }
}
