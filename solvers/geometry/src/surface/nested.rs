//! Checks the orientation of the parts of a surface: a body is counter-clockwise as seen from outside, a
//! cavity clockwise.

use super::error::SurfaceProblem;
use super::soup::Soup;
use super::winding::solid_angle;
use crate::Point3;

/// Volume, relative to the area to the power 3/2, below which the volume is rounding.
const FLAT: f64 = 1e-12;

/// Largest number of parts, each of which is compared with all triangles of the others.
pub(super) const MOST: usize = 200;

/// Rejects parts that are inside out.
pub(super) fn refuse(soup: &Soup, neighbours: &[[u32; 3]]) -> Result<(), SurfaceProblem> {
    let parts = parts(neighbours);
    let count = parts.iter().max().map_or(0, |&last| last as usize + 1);
    if count > MOST {
        return Err(SurfaceProblem::Parts { parts: count, most: MOST });
    }
    let mut triangles: Vec<Vec<[u32; 3]>> = vec![Vec::new(); count];
    let mut first = vec![usize::MAX; count];
    for (triangle, &part) in parts.iter().enumerate() {
        triangles[part as usize].push(soup.triangles[triangle]);
        first[part as usize] = first[part as usize].min(triangle);
    }
    let origin = soup.points[soup.triangles[0][0] as usize];
    for (part, list) in triangles.iter().enumerate() {
        let corners = list.iter().map(|t| t.map(|p| soup.points[p as usize] - origin));
        let (volume, area) = corners.fold((0.0, 0.0), |(volume, area), [a, b, c]| {
            (volume + a.dot(&b.cross(&c)) / 6.0, area + 0.5 * (b - a).cross(&(c - a)).norm())
        });
        if volume.abs() <= FLAT * area.powf(1.5) {
            return Err(SurfaceProblem::Flat);
        }
        let at = soup.points[list[0][0] as usize];
        let others = triangles.iter().enumerate().filter(|(other, _)| *other != part);
        let around = others.map(|(_, other)| winding(&soup.points, other, &at).round().abs() as usize);
        let within: usize = around.sum();
        if (volume > 0.0) != within.is_multiple_of(2) {
            let triangle = soup.faces[first[part]];
            let at = soup.middle(first[part]);
            let part = [list.len(), soup.triangles.len()];
            return Err(SurfaceProblem::InsideOut { triangle, at, volume, within, part });
        }
    }
    Ok(())
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
