//! Contact over all points of a surface: tractions, tangents and the resultant on the tool.

use rayon::prelude::*;
use shape::SurfaceRows;
use shape::{Matrix3, Vector3};

use super::law::Response;
use super::{ContactError, ContactHistory, ContactSurface, Slip, Tool};

/// Clusters per task. Several tasks are used from twice this number of clusters; with fewer, handing work to
/// other threads costs more than the points.
const CHUNK: usize = 16;

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

/// Counters of evaluations and of the work that they skipped; they add up over calls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactCounts {
    /// Number of evaluations of one tool against the surface.
    pub evaluations: u64,
    /// Number of these evaluations that were skipped as a whole, because no point was near the tool.
    pub skipped: u64,
    /// Number of points whose distance was computed.
    pub distances: u64,
    /// Number of points found in contact.
    pub active: u64,
}

impl ContactSurface<'_> {
    /// Evaluates tractions and tangents at all points in contact in the state `u` (m, one vector per node).
    ///
    /// Returns `None` if no point can be near the tool. The bits do not depend on the number of threads.
    ///
    /// # Errors
    ///
    /// [`ContactError::PassedThrough`] if a point is too deep in the tool. [`ContactError::Length`],
    /// [`ContactError::Place`] or [`ContactError::NotFinite`] for invalid input.
    pub fn evaluate(
        &self,
        tool: &Tool,
        closure: f64,
        u: &[Vector3],
        history: &ContactHistory,
        counts: &mut ContactCounts,
    ) -> Result<Option<Contacts>, ContactError> {
        let reach = self.reach(tool, closure, u, history, counts)?;
        let near = self.near(tool, closure, reach, u)?;
        let found = self.scan(tool, closure, u, history, counts, &near, |response, p, normal| {
            tool.stiffness(response, p, normal)
        })?;
        Ok(found.map(|found| {
            let stiffness = found.iter().map(|f| f.tangent).collect();
            Contacts::new(self, tool, closure, u, found, stiffness)
        }))
    }

    /// Evaluates as [`ContactSurface::evaluate`], but without tangents: for explicit dynamics, line searches
    /// and reactions.
    ///
    /// # Errors
    ///
    /// As [`ContactSurface::evaluate`].
    pub fn tractions(
        &self,
        tool: &Tool,
        closure: f64,
        u: &[Vector3],
        history: &ContactHistory,
        counts: &mut ContactCounts,
    ) -> Result<Option<Contacts>, ContactError> {
        let reach = self.reach(tool, closure, u, history, counts)?;
        let near = self.near(tool, closure, reach, u)?;
        let found = self.scan(tool, closure, u, history, counts, &near, |_, _, _| ())?;
        Ok(found.map(|found| Contacts::new(self, tool, closure, u, found, Vec::new())))
    }

    /// Counts an evaluation and checks its input. Returns the gap (m) up to which a point may touch.
    pub(super) fn reach(
        &self,
        tool: &Tool,
        closure: f64,
        u: &[Vector3],
        history: &ContactHistory,
        counts: &mut ContactCounts,
    ) -> Result<f64, ContactError> {
        let rows = self.rows();
        check_len("displacements", u.len(), rows.rows().node_count())?;
        check_len("points of the contact history", history.points(), rows.points().len())?;
        if !closure.is_finite() {
            return Err(ContactError::Place { what: "the closure" });
        }
        counts.evaluations += 1;
        // A point with a multiplier touches from outside while l - k_n g > 0.
        Ok(history.largest_multiplier() / tool.law().penalty())
    }

    /// Evaluates contact at the points `near`; no other point can touch.
    pub(super) fn scan<T: Send>(
        &self,
        tool: &Tool,
        closure: f64,
        u: &[Vector3],
        history: &ContactHistory,
        counts: &mut ContactCounts,
        near: &[&[u32]],
        tangent: impl Fn(&Response, &Vector3, &Vector3) -> T + Sync,
    ) -> Result<Option<Vec<Found<T>>>, ContactError> {
        if near.is_empty() {
            counts.skipped += 1;
            return Ok(None);
        }
        counts.distances += near.iter().map(|points| points.len() as u64).sum::<u64>();
        let touch = |clusters: &[&[u32]]| {
            let mut found = Vec::new();
            for &q in clusters.iter().copied().flatten() {
                let point = q as usize;
                let p = tool.local(closure, &self.position(point, u));
                let (gap, normal) = tool.shape().foot(&p);
                let (slip, multiplier) = (history.slip(point), history.multiplier(point));
                if let Some(response) = tool.law().respond(gap, &normal, &p, &slip, multiplier) {
                    let tangent = tangent(&response, &p, &normal);
                    let traction = tool.to_world(&response.traction);
                    found.push(Found {
                        point: q,
                        gap,
                        traction,
                        slip: response.slip,
                        pressure: response.pressure,
                        dissipated: response.dissipated,
                        tangent,
                    });
                }
            }
            found
        };
        let mut found = if near.len() < 2 * CHUNK {
            touch(near)
        } else {
            near.par_chunks(CHUNK).map(touch).collect::<Vec<_>>().into_iter().flatten().collect()
        };
        found.sort_unstable_by_key(|f| f.point);
        counts.active += found.len() as u64;
        let limit = tool.deepest();
        match found.iter().find(|f| -f.gap > limit) {
            Some(f) => {
                Err(ContactError::PassedThrough { point: f.point as usize, penetration: -f.gap, limit })
            }
            None => Ok(Some(found)),
        }
    }
}

pub(super) struct Found<T> {
    point: u32,
    gap: f64,
    traction: Vector3,
    slip: Slip,
    pressure: f64,
    dissipated: f64,
    tangent: T,
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
        for f in &found {
            let w = surface.rows().weights()[f.point as usize];
            let arm = surface.position(f.point as usize, u) - tool.place(closure);
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
    /// [`ContactSurface::tractions`]. The derivative with respect to the tool's displacement is
    /// `dt/dclosure = -(dt/dx) along`.
    pub fn stiffness(&self) -> &[Matrix3] {
        &self.stiffness
    }

    /// Friction histories to commit, one per point in contact, see [`ContactHistory::commit`].
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

fn check_len(what: &'static str, found: usize, expected: usize) -> Result<(), ContactError> {
    if found == expected { Ok(()) } else { Err(ContactError::Length { what, found, expected }) }
}
