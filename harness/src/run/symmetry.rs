//! Mirror symmetry of a stored reference: the file has points of the whole body, and a scene may model only
//! half of the body.

use cases::scene::Body;
use geometry::{Point3, Vector3};

/// Mapping of points to the modelled half z >= 0. If `half` is set, points with z < 0 are replaced by their
/// mirror images.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mirror {
    half: bool,
}

impl Mirror {
    pub(crate) fn of(body: &Body) -> Mirror {
        Mirror { half: matches!(body, Body::Kidney { half: true, .. }) }
    }

    /// Returns the point of the modelled body that corresponds to `x`.
    pub(crate) fn place(self, x: &Point3) -> Point3 {
        if self.below(x) { mirrored(x.coords).into() } else { *x }
    }

    /// Converts a displacement between `x` and its corresponding point, in either direction.
    pub(crate) fn displacement(self, x: &Point3, u: Vector3) -> Vector3 {
        if self.below(x) { mirrored(u) } else { u }
    }

    fn below(self, x: &Point3) -> bool {
        self.half && x.z < 0.0
    }
}

fn mirrored(v: Vector3) -> Vector3 {
    Vector3::new(v.x, v.y, -v.z)
}
