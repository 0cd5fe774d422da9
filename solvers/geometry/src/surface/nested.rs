//! Orientation of the parts of a surface, and which part surrounds which: a body is counter-clockwise as seen
//! from outside, a cavity clockwise.

use super::error::SurfaceProblem;
use super::soup::Soup;
use super::winding::solid_angle;
use crate::Point3;

/// Volume, relative to the area to the power 3/2, below which the volume is rounding.
const FLAT: f64 = 1e-12;

/// Largest number of parts, each of which is compared with all triangles of the others.
pub(super) const MOST: usize = 200;

/// Parts of a surface, each connected across edges.
pub(super) struct Nest {
    /// Triangles of each part.
    pub(super) triangles: Vec<Vec<usize>>,
    /// Whether each part is a body, and no cavity.
    pub(super) is_body: Vec<bool>,
    /// Innermost part around each part.
    pub(super) parent: Vec<Option<usize>>,
}

/// Rejects parts that are inside out, and bodies within bodies.
pub(super) fn refuse(soup: &Soup, neighbours: &[[u32; 3]]) -> Result<(), SurfaceProblem> {
    Nest::find(soup, neighbours, &vec![None; soup.triangles.len()], |is_body, parents| {
        is_body == parents.len().is_multiple_of(2)
    })
    .map(|_| ())
}

/// Finds the parts of a surface whose bodies may lie within others and touch at the triangles of `opposite`.
/// Rejects cavities outside of bodies.
pub(super) fn find(
    soup: &Soup,
    neighbours: &[[u32; 3]],
    opposite: &[Option<u32>],
) -> Result<Nest, SurfaceProblem> {
    Nest::find(soup, neighbours, opposite, |is_body, parents| is_body || parents.first() == Some(&true))
}

impl Nest {
    /// `is_right` decides by whether a part is a body, and whether the parts around it are, from inside out.
    fn find(
        soup: &Soup,
        neighbours: &[[u32; 3]],
        opposite: &[Option<u32>],
        is_right: impl Fn(bool, &[bool]) -> bool,
    ) -> Result<Nest, SurfaceProblem> {
        let part = parts(neighbours);
        let count = part.iter().max().map_or(0, |&last| last as usize + 1);
        if count > MOST {
            return Err(SurfaceProblem::Parts { parts: count, most: MOST });
        }
        let mut triangles: Vec<Vec<usize>> = vec![Vec::new(); count];
        part.iter().enumerate().for_each(|(triangle, part)| triangles[*part as usize].push(triangle));
        let volumes = triangles.iter().map(|list| volume(soup, list)).collect::<Result<Vec<f64>, _>>()?;
        let is_body: Vec<bool> = volumes.iter().map(|&volume| volume > 0.0).collect();
        let corners: Vec<Vec<[u32; 3]>> =
            triangles.iter().map(|list| list.iter().map(|&t| soup.triangles[t]).collect()).collect();
        let is_around = |other: usize, inner: usize| {
            // The centre of a triangle that is not a wall between both.
            let is_apart =
                |t: &&usize| opposite[**t].is_none_or(|back| part[back as usize] as usize != other);
            match triangles[inner].iter().find(is_apart) {
                Some(&t) => winding(&soup.points, &corners[other], &soup.middle(t)).round().abs() >= 1.0,
                // A body fills a cavity.
                None => is_body[inner] && !is_body[other],
            }
        };
        let around: Vec<Vec<usize>> = (0..count)
            .map(|inner| (0..count).filter(|&other| other != inner && is_around(other, inner)).collect())
            .collect();
        let mut parent = vec![None; count];
        for (inner, mut list) in around.iter().cloned().enumerate() {
            list.sort_by_key(|&other| std::cmp::Reverse(around[other].len()));
            let parents: Vec<bool> = list.iter().map(|&other| is_body[other]).collect();
            if !is_right(is_body[inner], &parents) {
                let first = triangles[inner][0];
                return Err(SurfaceProblem::InsideOut {
                    triangle: soup.faces[first],
                    at: soup.middle(first),
                    volume: volumes[inner],
                    within: list.len(),
                    part: [triangles[inner].len(), soup.triangles.len()],
                });
            }
            parent[inner] = list.first().copied();
        }
        Ok(Nest { triangles, is_body, parent })
    }

    /// Whether a part is a body within a body.
    pub(super) fn is_inner(&self, part: usize) -> bool {
        self.is_body[part] && self.parent[part].is_some_and(|parent| self.is_body[parent])
    }
}

/// Volume that a part encloses, negative for a cavity.
fn volume(soup: &Soup, triangles: &[usize]) -> Result<f64, SurfaceProblem> {
    let origin = soup.points[soup.triangles[0][0] as usize];
    let corners = triangles.iter().map(|&t| soup.corners(t).map(|p| p - origin));
    let (volume, area) = corners.fold((0.0, 0.0), |(volume, area), [a, b, c]| {
        (volume + a.dot(&b.cross(&c)) / 6.0, area + 0.5 * (b - a).cross(&(c - a)).norm())
    });
    if volume.abs() <= FLAT * area.powf(1.5) { Err(SurfaceProblem::Flat) } else { Ok(volume) }
}

/// Part of each triangle, numbered in the order of their first triangles.
pub(super) fn parts(neighbours: &[[u32; 3]]) -> Vec<u32> {
    let mut parts = vec![u32::MAX; neighbours.len()];
    let mut next = 0;
    for start in 0..neighbours.len() {
        if parts[start] != u32::MAX {
            continue;
        }
        let mut open = vec![start as u32];
        while let Some(triangle) = open.pop() {
            if std::mem::replace(&mut parts[triangle as usize], next) == u32::MAX {
                open.extend(neighbours[triangle as usize].iter().filter(|&&t| parts[t as usize] == u32::MAX));
            }
        }
        next += 1;
    }
    parts
}

/// Winding number of triangles around a point, from their solid angles: 1 inside, 0 outside.
pub(super) fn winding(points: &[Point3], triangles: &[[u32; 3]], p: &Point3) -> f64 {
    let angle = |t: &[u32; 3]| solid_angle(&t.map(|q| points[q as usize]), p);
    triangles.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}
