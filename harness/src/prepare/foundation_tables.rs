//! Tables of surfaces on springs and dampers.

use geometry::Vector3;
use shape::{FluxRows, SurfaceRows};
use statics::{PenaltySurface, Weak, WeakSupport};

/// A surface on springs and dampers, with its tables.
pub(super) struct OwnedFoundation {
    /// Index in the scene.
    pub(super) index: usize,
    pub(super) flux: FluxRows,
    pub(super) surface: SurfaceRows,
    /// Displacement of the ground, m: zero at every point.
    pub(super) ground: Vec<Vector3>,
    pub(super) stiffness: f64,
    pub(super) damping: f64,
    pub(super) along_normal: bool,
}

impl OwnedFoundation {
    /// Returns the springs for the linear solver; `None` for dampers alone.
    pub(super) fn weak(&self) -> Option<WeakSupport<'_>> {
        let &OwnedFoundation { stiffness, along_normal, .. } = self;
        (stiffness > 0.0).then(|| WeakSupport {
            flux: &self.flux,
            axes: [true; 3],
            values: self.ground.clone(),
            region: &[],
            method: Weak::Spring { stiffness, along_normal },
            h: 1.0,
            trace: None,
        })
    }

    /// Returns the springs and dampers for Newton's method.
    pub(super) fn penalty(&self) -> PenaltySurface<'_> {
        PenaltySurface {
            surface: &self.surface,
            axes: [true; 3],
            along_normal: self.along_normal,
            values: self.ground.clone(),
            from: Vec::new(),
            beta: self.stiffness,
            damping: self.damping,
        }
    }

    /// Calls `add` with each point and the force on the body there (N), at displacements `u` (m) and velocities `v`
    /// (m/s; empty for none).
    pub(super) fn each_force(&self, u: &[Vector3], v: &[Vector3], mut add: impl FnMut(usize, Vector3)) {
        let rows = self.surface.rows();
        for (q, (w, n)) in self.surface.weights().iter().zip(self.surface.normals()).enumerate() {
            let (nodes, values) = rows.row(q);
            let at = |field: &[Vector3]| -> Vector3 {
                nodes.iter().zip(values).map(|(&node, value)| field[node as usize] * *value).sum()
            };
            let mut force = at(u) * -(w * self.stiffness);
            if self.damping > 0.0 && !v.is_empty() {
                force -= at(v) * (w * self.damping);
            }
            add(q, if self.along_normal { n * n.dot(&force) } else { force });
        }
    }
}
