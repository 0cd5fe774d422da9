//! Face-connected parts of a mesh, without parts that the lattice does not resolve.

use super::stencil::Side;

/// Smallest number of lattice points inside a part. A part with fewer is a tip that the lattice does not
/// resolve.
const FEWEST: usize = 8;

/// Tetrahedra of the parts that are kept.
pub(super) struct Parts {
    /// Indices of the tetrahedra.
    pub tets: Vec<usize>,
    /// Number of the face-connected part to which each tetrahedron belongs. Numbers may have gaps.
    pub part: Vec<u32>,
    /// Number of parts that are omitted.
    pub left_out: usize,
}

/// Finds the connected parts. `sides` are those of the lattice points; cuts have higher indices.
pub(super) fn connected(tets: &[[u32; 4]], sides: &[Side]) -> Parts {
    let mut faces: Vec<([u32; 3], u32)> = Vec::with_capacity(4 * tets.len());
    for (at, tet) in tets.iter().enumerate() {
        for skipped in 0..4 {
            let mut face: [u32; 3] = std::array::from_fn(|i| tet[(skipped + 1 + i) % 4]);
            face.sort_unstable();
            faces.push((face, at as u32));
        }
    }
    faces.sort_unstable();
    let mut root: Vec<u32> = (0..tets.len() as u32).collect();
    for two in faces.windows(2).filter(|two| two[0].0 == two[1].0) {
        let (a, b) = (find(&mut root, two[0].1), find(&mut root, two[1].1));
        root[a.max(b) as usize] = a.min(b);
    }
    let part: Vec<u32> = (0..tets.len() as u32).map(|tet| find(&mut root, tet)).collect();
    let is_inside = |p: u32| sides.get(p as usize) == Some(&Side::Inside);
    let mut inner: Vec<(u32, u32)> = Vec::new();
    for (tet, &part) in tets.iter().zip(&part) {
        inner.extend(tet.iter().filter(|&&p| is_inside(p)).map(|&p| (part, p)));
    }
    inner.sort_unstable();
    inner.dedup();
    let mut large = vec![false; tets.len()];
    for points in inner.chunk_by(|a, b| a.0 == b.0) {
        large[points[0].0 as usize] = points.len() >= FEWEST;
    }
    let mut roots = part.clone();
    roots.sort_unstable();
    roots.dedup();
    let left_out = roots.iter().filter(|&&part| !large[part as usize]).count();
    let (tets, part) = part.into_iter().enumerate().filter(|(_, part)| large[*part as usize]).unzip();
    Parts { tets, part, left_out }
}

/// Lowest tetrahedron of a part, with path halving.
fn find(root: &mut [u32], mut at: u32) -> u32 {
    while root[at as usize] != at {
        root[at as usize] = root[root[at as usize] as usize];
        at = root[at as usize];
    }
    at
}
