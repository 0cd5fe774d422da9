//! Cubes of several sizes: the smallest along a surface, larger ones inside, none more than twice as large as one it touches.

use std::collections::HashMap;

use rayon::prelude::*;

use crate::{Point3, Surface, Vector3};

/// Cubes nearer to the surface than this are of the smallest size, over their edge: all tetrahedra at a node that may be moved, which
/// is no farther from the surface than 0.36, lie between cubes whose middles are at most 1 farther.
const NEAR: f64 = 1.4;
/// Cubes along the longest extent at the level that the search begins with.
const FIRST: f64 = 6.0;
/// Cubes per parallel task at least.
const CHUNK: usize = 64;

/// Number of a cube along x, y and z, among those of its size.
pub(super) type Cube = [i32; 3];

/// What a cube is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    /// Not divided.
    Leaf,
    /// Divided into eight of the next smaller size.
    Divided,
}

/// Where the cubes are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub origin: Point3,
    /// Half the edge of the smallest cube, m.
    pub half: f64,
}

impl Frame {
    /// The position of a point given in halves of the smallest cube.
    pub(super) fn place(&self, key: [i32; 3]) -> Point3 {
        self.origin + Vector3::from(key.map(|x| f64::from(x) * self.half))
    }
}

/// Cubes by level, 0 the smallest. Those far outside are left out.
pub(super) struct Octree {
    pub levels: Vec<HashMap<Cube, State>>,
}

/// The middle of a cube, in halves of the smallest.
pub(super) fn middle(cube: Cube, level: usize) -> [i32; 3] {
    cube.map(|x| (x << (level + 1)) + (1 << level))
}

impl Octree {
    /// Cubes around and in a surface, those inside up to the level `coarsest`.
    pub(super) fn new(surface: &Surface, frame: Frame, coarsest: usize) -> Octree {
        let edge = 2.0 * frame.half;
        let [low, high] = surface.bounds();
        let longest = (high - low).amax() / edge;
        let top = ((longest / FIRST).log2().ceil().max(0.0) as usize).clamp(coarsest, 24);
        let size = edge * f64::from(1 << top);
        let number = |p: &Point3, round: fn(f64) -> f64| {
            <[i32; 3]>::from((p - frame.origin).map(|x| round(x / size) as i32))
        };
        let (from, to) = (number(&low, f64::floor), number(&high, f64::ceil));
        let mut cubes: Vec<Cube> = Vec::new();
        for x in from[0] - 2..to[0] + 2 {
            for y in from[1] - 2..to[1] + 2 {
                cubes.extend((from[2] - 2..to[2] + 2).map(|z| [x, y, z]));
            }
        }
        let mut levels: Vec<HashMap<Cube, State>> = vec![HashMap::new(); top + 1];
        for level in (0..=top).rev() {
            let size = edge * f64::from(1 << level);
            // From the middle of a cube to that of its farthest smallest cube.
            let reach = NEAR * edge + 0.5 * 3f64.sqrt() * (size - edge);
            let state = |cube: &Cube| {
                let distance = surface.signed_distance(&frame.place(middle(*cube, level)));
                match distance {
                    d if d > reach => None,
                    d if level > 0 && (d > -reach || level > coarsest) => Some(State::Divided),
                    _ => Some(State::Leaf),
                }
            };
            let states: Vec<_> = cubes.par_iter().with_min_len(CHUNK).map(state).collect();
            let found = cubes.iter().zip(states).filter_map(|(cube, state)| Some((*cube, state?)));
            levels[level] = found.collect();
            let divided = cubes.iter().filter(|cube| levels[level].get(*cube) == Some(&State::Divided));
            cubes = divided.flat_map(children).collect();
        }
        let mut octree = Octree { levels };
        octree.balance();
        octree
    }

    /// What a cube is; `None` if it is a part of a larger one, or far outside.
    pub(super) fn state(&self, cube: Cube, level: usize) -> Option<State> {
        self.levels.get(level)?.get(&cube).copied()
    }

    /// The undivided cubes of a level, sorted.
    pub(super) fn leaves(&self, level: usize) -> Vec<Cube> {
        let leaves = self.levels[level].iter().filter(|(_, state)| **state == State::Leaf);
        let mut leaves: Vec<Cube> = leaves.map(|(cube, _)| *cube).collect();
        leaves.sort_unstable();
        leaves
    }

    /// Divides cubes until none touches one of less than half its size: every cube around a divided one is of its size at the most.
    fn balance(&mut self) {
        for level in 1..self.levels.len() {
            let divided = self.levels[level].iter().filter(|(_, state)| **state == State::Divided);
            let mut divided: Vec<Cube> = divided.map(|(cube, _)| *cube).collect();
            divided.sort_unstable();
            for cube in divided {
                for step in around() {
                    self.make(std::array::from_fn(|a| cube[a] + step[a]), level);
                }
            }
        }
    }

    /// Divides the larger cube that a cube is a part of, if there is one.
    fn make(&mut self, cube: Cube, level: usize) {
        if level + 1 >= self.levels.len() || self.levels[level].contains_key(&cube) {
            return;
        }
        let parent = cube.map(|x| x >> 1);
        self.make(parent, level + 1);
        if let Some(state @ State::Leaf) = self.levels[level + 1].get_mut(&parent) {
            *state = State::Divided;
            self.levels[level].extend(children(&parent).map(|child| (child, State::Leaf)));
        }
    }
}

fn children(cube: &Cube) -> impl Iterator<Item = Cube> + use<> {
    let cube = *cube;
    (0..8).map(move |child| std::array::from_fn(|a| 2 * cube[a] + (child >> a & 1)))
}

fn around() -> impl Iterator<Item = Cube> {
    (0..27).filter(|&n| n != 13).map(|n| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1])
}
