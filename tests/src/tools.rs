//! Tools of every shape, and the distance to the kinks of their distance functions.

use std::sync::{Arc, LazyLock};

use contact::{Capsule, Cylinder, Plate, RoundedBox, RoundedSurface, Sphere, ToolShape};
use geometry::surface::Soup;
use geometry::{Point3, Surface};
use proptest::prelude::*;
use shape::{Matrix3, Vector3};

/// Half extents of the surface below without its rounding, m.
const CORE: [f64; 3] = [3e-3, 4e-3, 2e-3];
const ROUNDING: f64 = 1e-3;

/// The box that the surface below is.
pub const BOXED: ToolShape = ToolShape::RoundedBox(RoundedBox { half: [4e-3, 5e-3, 3e-3], radius: ROUNDING });

/// One tool of each shape, and a box without rounding, with sizes of a few millimetres. The surface is that
/// of a box, so that its distances are known.
pub static SHAPES: LazyLock<[ToolShape; 7]> = LazyLock::new(|| {
    [
        ToolShape::Plate(Plate),
        ToolShape::RoundedBox(RoundedBox { half: [5e-3, 10e-3, 4e-3], radius: 1.5e-3 }),
        ToolShape::RoundedBox(RoundedBox { half: [3e-3, 2e-3, 4e-3], radius: 0.0 }),
        ToolShape::Sphere(Sphere { radius: 5e-3 }),
        ToolShape::Cylinder(Cylinder { radius: 4e-3, half_length: 6e-3 }),
        ToolShape::Capsule(Capsule { radius: 3e-3, half_length: 5e-3 }),
        ToolShape::RoundedSurface(RoundedSurface::new(boxed(CORE), ROUNDING).unwrap()),
    ]
});

/// Surface of a box about the origin.
fn boxed(half: [f64; 3]) -> Arc<Surface> {
    let mut soup = Soup::default();
    let side = |k: usize, a: usize| if (k >> a) & 1 == 1 { half[a] } else { -half[a] };
    soup.points.extend((0..8).map(|k| Point3::new(side(k, 0), side(k, 1), side(k, 2))));
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    for (number, quad) in quads.iter().enumerate() {
        soup.face(number, quad).expect("a quadrangle");
    }
    Arc::new(Surface::new(soup, 1.0).expect("a closed surface"))
}

/// Returns the distance (m), or a lower bound of it, from `p` to the nearest jump of the gradient or the
/// Hessian.
pub fn kink(shape: &ToolShape, p: &Vector3) -> f64 {
    let least = |values: &[f64]| values.iter().fold(f64::INFINITY, |m, v| m.min(v.abs()));
    let rho = p.x.hypot(p.y);
    match *shape {
        ToolShape::Plate(Plate) => f64::INFINITY,
        ToolShape::RoundedSurface(_) => kink(&BOXED, p),
        ToolShape::RoundedBox(RoundedBox { half, radius }) => {
            // The deepest axis comes last: inside the core the nearest face changes at a tie; outside, the
            // other axes contribute from q = 0.
            let mut q = [0, 1, 2].map(|a| (p[a].abs() - half[a] + radius, p[a]));
            q.sort_by(|a, b| a.0.total_cmp(&b.0));
            let [(low, _), (next, _), (top, along)] = q;
            if top < 0.0 { least(&[(top - next) / 2.0, along]) } else { least(&[low, next, along]) }
        }
        ToolShape::Sphere(Sphere { .. }) => p.norm(),
        ToolShape::Cylinder(Cylinder { radius, half_length }) => {
            let side = rho - radius;
            let flat = p.z.abs() - half_length;
            let along = if side > flat { rho } else { p.z };
            let inside = side.max(flat) < 0.0;
            least(&[if inside { (side - flat) / 2.0 } else { side.min(flat) }, along])
        }
        ToolShape::Capsule(Capsule { half_length, .. }) => {
            let beyond = p.z.abs() - half_length;
            least(&[beyond, if beyond > 0.0 { rho.hypot(beyond) } else { rho }])
        }
    }
}

/// Returns vectors with components up to `reach`.
pub fn vector(reach: f64) -> impl Strategy<Value = Vector3> {
    prop::array::uniform3(-reach..reach).prop_map(Vector3::from)
}

/// Returns arbitrary rotations.
pub fn rotation() -> impl Strategy<Value = Matrix3> {
    vector(3.0).prop_map(|axis| nalgebra::Rotation3::new(axis).into_inner())
}

/// Returns `df/dx` by central differences with step `h`.
pub fn differences(h: f64, f: impl Fn(&Vector3) -> Vector3) -> Matrix3 {
    let columns = [0, 1, 2].map(|a| {
        let mut step = Vector3::zeros();
        step[a] = h;
        (f(&step) - f(&-step)) / (2.0 * h)
    });
    Matrix3::from_columns(&columns)
}
