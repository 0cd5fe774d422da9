//! Building blocks for outlines of tools in pictures.

use shape::Vector3;

/// Returns unit vectors of the octant of positive coordinates, every 15 degrees. The silhouette of a rounding
/// of radius r is too small by r / 100 at most.
pub(super) fn octant() -> Vec<Vector3> {
    let sine = |k: i32| {
        if k == 0 {
            0.0
        } else if k == 6 {
            1.0
        } else {
            (f64::from(k) * 15.0).to_radians().sin()
        }
    };
    let mut out = vec![Vector3::z()];
    for up in 0..6 {
        out.extend(
            (0..=6)
                .map(|turn| Vector3::new(sine(6 - up) * sine(6 - turn), sine(6 - up) * sine(turn), sine(up))),
        );
    }
    out
}

/// Adds the mirror images at the planes normal to the selected axes.
pub(super) fn mirrored(mut points: Vec<Vector3>, axes: [bool; 3]) -> Vec<Vector3> {
    for axis in (0..3).filter(|&a| axes[a]) {
        for mut image in points.clone() {
            image[axis] = -image[axis];
            points.push(image);
        }
    }
    points
}

/// Number of cells along each edge of the cube below.
const CELLS: usize = 12;

/// Returns the surface of the cube from -1 to 1: points and outward quadrangles. The cells grow towards the
/// middle of each face, because tools are rounded at their edges.
pub(super) fn cube() -> (Vec<Vector3>, Vec<[u32; 4]>) {
    let ticks: Vec<f64> = (0..=CELLS)
        .map(|k| (std::f64::consts::FRAC_PI_2 * (2.0 * k as f64 / CELLS as f64 - 1.0)).sin())
        .collect();
    let mut number = std::collections::BTreeMap::new();
    let mut points = Vec::new();
    let mut quads = Vec::new();
    for (axis, side) in [(0, 0), (0, CELLS), (1, 0), (1, CELLS), (2, 0), (2, CELLS)] {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut corner = |i: usize, j: usize| {
            let mut at = [0; 3];
            (at[axis], at[u], at[v]) = (side, i, j);
            *number.entry(at).or_insert_with(|| {
                points.push(Vector3::from(at.map(|k| ticks[k])));
                points.len() as u32 - 1
            })
        };
        for i in 0..CELLS {
            for j in 0..CELLS {
                let mut quad = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                if side == 0 {
                    quad.reverse();
                }
                quads.push(quad);
            }
        }
    }
    (points, quads)
}
