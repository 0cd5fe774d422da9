//! Consistent orientation of triangles across their common edges.

use super::sides::Side;
use super::soup::Soup;

/// Parts of triangles that are connected across edges of two triangles, and the triangles of each part that
/// have to be reversed, so that neighbours have the same orientation. Of each part the fewer triangles are
/// reversed.
pub(super) struct Orientation {
    /// Part of each triangle.
    pub(super) part: Vec<u32>,
    /// Number of parts.
    pub(super) parts: usize,
    /// Whether each triangle is reversed.
    pub(super) turned: Vec<bool>,
    /// Whether a consistent orientation exists.
    pub(super) orientable: bool,
}

/// Finds the orientation from the edges of all triangles.
pub(super) fn consistent(soup: &Soup, sides: &[Side]) -> Orientation {
    let count = soup.triangles.len();
    let mut near: Vec<Vec<(u32, bool)>> = vec![Vec::new(); count];
    for around in sides.chunk_by(|a, b| a.edge == b.edge) {
        if let [a, b] = around {
            let same = a.upwards != b.upwards;
            near[a.triangle as usize].push((b.triangle, same));
            near[b.triangle as usize].push((a.triangle, same));
        }
    }
    let mut part = vec![u32::MAX; count];
    let mut turned = vec![false; count];
    let (mut parts, mut orientable) = (0, true);
    for start in 0..count {
        if part[start] != u32::MAX {
            continue;
        }
        part[start] = parts;
        let mut list = vec![start as u32];
        let mut next = 0;
        while next < list.len() {
            let triangle = list[next] as usize;
            next += 1;
            for &(other, same) in &near[triangle] {
                let (other, wanted) = (other as usize, turned[triangle] == same);
                if part[other] == u32::MAX {
                    (part[other], turned[other]) = (parts, wanted);
                    list.push(other as u32);
                } else {
                    orientable &= turned[other] == wanted;
                }
            }
        }
        if 2 * list.iter().filter(|&&t| turned[t as usize]).count() > list.len() {
            list.iter().for_each(|&t| turned[t as usize] ^= true);
        }
        parts += 1;
    }
    Orientation { part, parts: parts as usize, turned, orientable }
}

impl Orientation {
    /// Reverses the triangles of the marked parts.
    pub(super) fn turn_parts(&mut self, marked: &[bool]) {
        self.turned.iter_mut().zip(&self.part).for_each(|(turned, part)| *turned ^= marked[*part as usize]);
    }

    /// Returns the triangles with this orientation.
    pub(super) fn apply(&self, soup: &mut Soup) {
        let turned = soup.triangles.iter_mut().zip(&self.turned).filter(|(_, turned)| **turned);
        turned.for_each(|(triangle, _)| triangle.swap(1, 2));
    }

    /// Triangles that are reversed.
    pub(super) fn reversed(&self) -> Vec<usize> {
        (0..self.turned.len()).filter(|&triangle| self.turned[triangle]).collect()
    }
}
