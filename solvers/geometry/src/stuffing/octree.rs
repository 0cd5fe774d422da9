//! Octree of cubes: the smallest cubes along a surface and larger cubes inside, with a ratio of at most two
//! between touching cubes.

use std::collections::HashMap;

use rayon::prelude::*;

use super::walls::Walls;
use crate::surface::Surface;
use crate::{Point3, Vector3};

/// Distance from the surface, over the edge of the smallest cube, within which cubes have the smallest size.
/// A node that may be moved is at most 0.36 from the surface. All tetrahedra at such a node lie between cubes
/// whose centres are at most 1 farther.
const NEAR: f64 = 1.4;
/// Number of cubes along the longest extent at the level at which the subdivision begins.
const FIRST: f64 = 6.0;
/// Smallest number of cubes per parallel task.
const CHUNK: usize = 64;

/// Index of a cube along x, y and z, among the cubes of its size.
pub(super) type Cube = [i32; 3];

/// State of a cube.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    /// Not divided.
    Leaf,
    /// Divided into eight cubes of the next smaller size.
    Divided,
}

/// Position and scale of the cubes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub origin: Point3,
    /// Half the edge of the smallest cube, m.
    pub half: f64,
}

impl Frame {
    /// Position (m) of a point given in halves of the smallest cube.
    pub(super) fn place(&self, key: [i32; 3]) -> Point3 {
        self.origin + Vector3::from(key.map(|x| f64::from(x) * self.half))
    }
}

/// Cubes by level, level 0 the smallest. Cubes far outside are omitted.
pub(super) struct Octree {
    pub levels: Vec<HashMap<Cube, State>>,
}

/// Centre of a cube, in halves of the smallest cube.
pub(super) fn middle(cube: Cube, level: usize) -> [i32; 3] {
    cube.map(|x| (x << (level + 1)) + (1 << level))
}

impl Octree {
    /// Divides cubes in and around a surface, and along its walls. Cubes inside are at most of the level
    /// `coarsest`.
    pub(super) fn new(surface: &Surface, frame: Frame, coarsest: usize) -> Octree {
        let walls = Walls(surface.regions());
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
            // Distance from the centre of a cube to that of its farthest smallest cube, plus the margin.
            let reach = NEAR * edge + 0.5 * 3f64.sqrt() * (size - edge);
            let state = |cube: &Cube| {
                let middle = frame.place(middle(*cube, level));
                match surface.signed_distance(&middle) {
                    d if d > reach => None,
                    _ if level == 0 => Some(State::Leaf),
                    d if d > -reach || level > coarsest => Some(State::Divided),
                    _ if walls.are_near(&middle, reach) => Some(State::Divided),
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

    /// State of a cube; `None` if it is part of a larger cube, or far outside.
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

    /// Divides cubes until no cube touches one of less than half its size: cubes around a divided cube are at
    /// most as large.
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

    /// Divides the larger cube that contains the given cube, if there is one.
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
