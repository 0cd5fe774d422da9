//! Points in contact with a tool.

use shape::{Matrix3, SurfaceRows, Vector3};

use crate::law::Slip;
use crate::surface::ContactSurface;
use crate::tool::Tool;

/// Points in contact with one tool, in ascending order, with their resultants.
#[derive(Clone, Debug, PartialEq)]
pub struct Contacts {
    points: Vec<u32>,
    tractions: Vec<Vector3>,
    stiffness: Vec<Matrix3>,
    slip: Vec<Slip>,
    pressures: Vec<f64>,
    force: Vector3,
    moment: Vector3,
    area: f64,
    max_penetration: f64,
    carriers: f64,
    dissipated: f64,
}

/// A point in contact, with a tangent if one is computed.
pub(super) struct Found<T> {
    pub(super) point: u32,
    pub(super) gap: f64,
    pub(super) traction: Vector3,
    pub(super) slip: Slip,
    pub(super) pressure: f64,
    pub(super) dissipated: f64,
    pub(super) tangent: T,
}

impl Contacts {
    pub(super) fn new<T>(
        surface: &ContactSurface,
        tool: &Tool,
        closure: f64,
        u: &[Vector3],
        found: Vec<Found<T>>,
        stiffness: Vec<Matrix3>,
    ) -> Contacts {
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        let (mut area, mut max_penetration, mut dissipated) = (0.0, 0.0f64, 0.0);
        let (mut load, mut squares) = (0.0, 0.0);
        let place = tool.place(closure);
        for f in &found {
            let w = surface.rows().weights()[f.point as usize];
            let arm = surface.position(f.point as usize, u) - place;
            force -= f.traction * w;
            moment -= arm.cross(&f.traction) * w;
            area += w;
            max_penetration = max_penetration.max(-f.gap);
            dissipated += f.dissipated * w;
            load += w * f.pressure;
            squares += (w * f.pressure).powi(2);
        }
        Contacts {
            points: found.iter().map(|f| f.point).collect(),
            tractions: found.iter().map(|f| f.traction).collect(),
            stiffness,
            slip: found.iter().map(|f| f.slip).collect(),
            pressures: found.iter().map(|f| f.pressure).collect(),
            force,
            moment,
            area,
            max_penetration,
            carriers: if squares > 0.0 { load * load / squares } else { 0.0 },
            dissipated,
        }
    }

    /// Indices of the points in contact, ascending. All other arrays of the contacts are in this order.
    pub fn points(&self) -> &[u32] {
        &self.points
    }

    /// Tractions on the tissue per undeformed area, Pa, one vector per point in contact.
    pub fn tractions(&self) -> &[Vector3] {
        &self.tractions
    }

    /// Contact tangents `dt/dx` (3, 3), Pa/m, one per point in contact, unsymmetric in slip; empty from
    /// [`ContactSurface::tractions`]. On a straight leg the derivative with respect to the tool's displacement
    /// is `dt/dclosure = -(dt/dx) along`.
    pub fn stiffness(&self) -> &[Matrix3] {
        &self.stiffness
    }

    /// Friction histories, one per point in contact, for
    /// [`ContactHistory::commit`](crate::ContactHistory::commit).
    pub fn slip(&self) -> &[Slip] {
        &self.slip
    }

    /// Normal pressures per undeformed area, Pa, one per point in contact; positive.
    pub fn pressures(&self) -> &[f64] {
        &self.pressures
    }

    /// Force on the tool, N: `-sum_q w t`.
    pub fn force(&self) -> Vector3 {
        self.force
    }

    /// Moment on the tool about its current [`Tool::place`], N m.
    pub fn moment(&self) -> Vector3 {
        self.moment
    }

    /// Undeformed area of the points in contact, m^2: `sum_q w`. A point counts with its whole weight or not
    /// at all, so the edge of the contact is known only to half the width of a face.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Deepest penetration, m; 0 if no point is inside.
    pub fn max_penetration(&self) -> f64 {
        self.max_penetration
    }

    /// Effective number of points that carry the load: `(sum F_q)^2 / sum F_q^2` with the normal forces
    /// `F_q = w p`. This is n for n points with the same force, 1 if a single point carries all of it, and 0
    /// without contact.
    pub fn carriers(&self) -> f64 {
        self.carriers
    }

    /// Frictional work since the last commit, J.
    pub fn dissipated(&self) -> f64 {
        self.dissipated
    }

    /// Adds the nodal forces `f_I += w N_I t` (N) on the tissue.
    pub fn add_force(&self, rows: &SurfaceRows, force: &mut [Vector3]) {
        for (&q, t) in self.points.iter().zip(&self.tractions) {
            let (nodes, values) = rows.rows().row(q as usize);
            let load = t * rows.weights()[q as usize];
            for (&node, value) in nodes.iter().zip(values) {
                force[node as usize] += load * *value;
            }
        }
    }
}
