//! What outlines of tools are made of in pictures.

use shape::Vector3;

/// Unit vectors of the octant of positive coordinates, every 15 degrees: a silhouette of a rounding of radius r is r / 100 too
/// small at most.
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

/// With the mirror images at the planes of the axes named.
pub(super) fn mirrored(mut points: Vec<Vector3>, axes: [bool; 3]) -> Vec<Vector3> {
    for axis in (0..3).filter(|&a| axes[a]) {
        for mut image in points.clone() {
            image[axis] = -image[axis];
            points.push(image);
        }
    }
    points
}
