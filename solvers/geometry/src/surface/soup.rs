//! Triangles as listed in a file, and the merging of coinciding corners.

use std::collections::{HashMap, HashSet};

use super::groups::Groups;
use super::polygon::{self, PolygonFault};
use crate::{Point3, Vector3};

/// Fraction of the surface's diagonal below which corners of a file coincide, from the rounding of single
/// precision.
pub(super) const WELD: f64 = 1e-6;

/// Triangles, each of which may have its own copies of the corners, as in STL.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Soup {
    /// Positions, in the unit of the file.
    pub points: Vec<Point3>,
    /// Corners of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Number of each triangle's face in the file, from 1; a face with many corners gives several triangles.
    pub faces: Vec<u32>,
    /// Named groups of triangles.
    pub groups: Groups,
}

impl Soup {
    /// Adds a face with any number of corners as triangles.
    ///
    /// # Errors
    /// A face that crosses itself or has too many corners.
    pub fn face(&mut self, number: usize, corners: &[u32]) -> Result<(), PolygonFault> {
        let points: Vec<Point3> = corners.iter().map(|&corner| self.points[corner as usize]).collect();
        for triangle in polygon::cut(&points)? {
            self.triangle(number, triangle.map(|place| corners[place]));
        }
        Ok(())
    }

    /// Adds a triangle.
    pub fn triangle(&mut self, number: usize, corners: [u32; 3]) {
        self.triangles.push(corners);
        self.faces.push(number as u32);
    }

    /// Merges corners closer to each other than `tolerance`, and drops triangles that collapse.
    pub(super) fn welded(&self, tolerance: f64) -> Soup {
        let mut points: Vec<Point3> = Vec::new();
        let mut bins: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        let mut same: HashMap<[u64; 3], u32> = HashMap::new();
        let bin = |p: &Point3| [p.x, p.y, p.z].map(|x| (x / tolerance).floor() as i64);
        let mut place = |p: &Point3| {
            // The sum turns a negative zero into a positive zero.
            let bits = [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits());
            if let Some(&known) = same.get(&bits) {
                return known;
            }
            let found = if tolerance > 0.0 { near(&bins, &points, bin(p), p, tolerance) } else { None };
            let index = found.unwrap_or_else(|| {
                points.push(*p);
                let index = points.len() as u32 - 1;
                if tolerance > 0.0 {
                    bins.entry(bin(p)).or_default().push(index);
                }
                index
            });
            same.insert(bits, index);
            index
        };
        let new: Vec<u32> = self.points.iter().map(&mut place).collect();
        let corners = |t: usize| self.triangles[t].map(|p| new[p as usize]);
        let has_area = |&t: &usize| {
            let [a, b, c] = corners(t);
            a != b && b != c && a != c
        };
        let kept: Vec<usize> = (0..self.triangles.len()).filter(has_area).collect();
        let (triangles, faces) = kept.iter().map(|&t| (corners(t), self.faces[t])).unzip();
        Soup { points, triangles, faces, groups: self.groups.of_triangles(&kept) }
    }

    /// Merges the triangles of several files. The name of a file is a group of its triangles, before their
    /// own groups, and faces are numbered on from file to file.
    pub fn of_files(files: Vec<(String, Soup)>) -> Soup {
        let mut all = Soup::default();
        files.iter().for_each(|(name, _)| {
            all.groups.set([&**name]);
        });
        for (name, soup) in files {
            let (first, faces) = (all.points.len() as u32, all.faces.iter().copied().max().unwrap_or(0));
            all.points.extend(soup.points);
            for (t, (corners, face)) in soup.triangles.into_iter().zip(soup.faces).enumerate() {
                let own = soup.groups.of(t).iter().map(|&group| &*soup.groups.names()[group as usize]);
                let set = all.groups.set(std::iter::once(&*name).chain(own));
                all.triangle((faces + face) as usize, corners.map(|corner| first + corner));
                all.groups.fill(all.triangles.len(), set);
            }
        }
        all
    }

    /// Adds a triangle with the face and the groups of another triangle.
    pub(super) fn add_beside(&mut self, other: usize, corners: [u32; 3]) {
        self.triangle(self.faces[other] as usize, corners);
        self.groups.copy(other, self.triangles.len() - 1);
    }

    /// The triangles without points that none has.
    pub(super) fn used(&self) -> Soup {
        let mut index = vec![u32::MAX; self.points.len()];
        let mut points = Vec::new();
        let mut place = |p: u32| {
            let index = &mut index[p as usize];
            if *index == u32::MAX {
                *index = points.len() as u32;
                points.push(self.points[p as usize]);
            }
            *index
        };
        let triangles = self.triangles.iter().map(|t| t.map(&mut place)).collect();
        Soup { triangles, points, faces: self.faces.clone(), groups: self.groups.clone() }
    }

    /// The given triangles, in this order.
    pub(super) fn of_triangles(&self, kept: &[usize]) -> Soup {
        let (triangles, faces) = kept.iter().map(|&t| (self.triangles[t], self.faces[t])).unzip();
        let groups = self.groups.of_triangles(kept);
        Soup { points: self.points.clone(), triangles, faces, groups }
    }

    /// The triangles without those whose corners an earlier triangle has, in any order; and the
    /// centres of these.
    pub(super) fn without_doubles(&self) -> (Soup, Vec<Point3>) {
        let mut known = HashSet::new();
        let is_new = |&t: &usize| {
            let mut corners = self.triangles[t];
            corners.sort_unstable();
            known.insert(corners)
        };
        let (kept, doubles): (Vec<usize>, Vec<usize>) = (0..self.triangles.len()).partition(is_new);
        (self.of_triangles(&kept), doubles.into_iter().map(|t| self.middle(t)).collect())
    }

    /// Length of the diagonal of the bounding box of all points, in the unit of the file.
    pub(super) fn diagonal(&self) -> f64 {
        let (low, high) = super::tree::bounds(self.points.iter().copied());
        (high - low).norm()
    }

    /// Centre of a triangle, in the unit of the file.
    pub(super) fn middle(&self, triangle: usize) -> Point3 {
        Point3::from(self.corners(triangle).iter().map(|p| p.coords).sum::<Vector3>() / 3.0)
    }

    pub(super) fn corners(&self, triangle: usize) -> [Point3; 3] {
        self.triangles[triangle].map(|p| self.points[p as usize])
    }
}

/// The lowest known point within the tolerance.
fn near(
    bins: &HashMap<[i64; 3], Vec<u32>>,
    points: &[Point3],
    [x, y, z]: [i64; 3],
    p: &Point3,
    tolerance: f64,
) -> Option<u32> {
    let around = (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [i, j, k])));
    let key = |[i, j, k]: [i64; 3]| [x.saturating_add(i), y.saturating_add(j), z.saturating_add(k)];
    let near = around.filter_map(|step| bins.get(&key(step))).flatten();
    near.copied().filter(|&other| nalgebra::distance(&points[other as usize], p) <= tolerance).min()
}
