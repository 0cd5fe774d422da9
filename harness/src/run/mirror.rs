//! A stored reference holds points of the whole body; a scene may have the half of it.

use cases::scene::Body;
use geometry::{Point3, Vector3};

/// Where a body is the half z >= 0 of another: points below are taken at their mirror images.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mirror {
    half: bool,
}

impl Mirror {
    pub(crate) fn of(body: &Body) -> Mirror {
        Mirror { half: matches!(body, Body::Kidney { half: true, .. }) }
    }

    /// The point of the body that stands for `x`.
    pub(crate) fn place(self, x: &Point3) -> Point3 {
        if self.below(x) { mirrored(x.coords).into() } else { *x }
    }

    /// The displacement `u` at `x` from that at the point that stands for it, and the other way round.
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
