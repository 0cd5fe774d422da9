//! Contact over all points of a surface: tractions and tangents.

use rayon::prelude::*;
use shape::Vector3;

use crate::contacts::{Contacts, Found};
use crate::error::ContactError;
use crate::history::ContactHistory;
use crate::law::Response;
use crate::motion::Pose;
use crate::surface::ContactSurface;
use crate::tool::Tool;

/// Clusters per task. Several tasks are used from twice this number of clusters; with fewer, handing work to
/// other threads costs more than the points.
const CHUNK: usize = 16;

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
        let found = self.scan(tool, closure, u, history, counts, &near, |pose, response, p, normal| {
            tool.stiffness(pose, response, p, normal)
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
        let found = self.scan(tool, closure, u, history, counts, &near, |_, _, _, _| ())?;
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
        tangent: impl Fn(&Pose, &Response, &Vector3, &Vector3) -> T + Sync,
    ) -> Result<Option<Vec<Found<T>>>, ContactError> {
        if near.is_empty() {
            counts.skipped += 1;
            return Ok(None);
        }
        counts.distances += near.iter().map(|points| points.len() as u64).sum::<u64>();
        let pose = tool.pose(closure);
        let touch = |clusters: &[&[u32]]| {
            let mut found = Vec::new();
            for &q in clusters.iter().copied().flatten() {
                let point = q as usize;
                let p = pose.local(&self.position(point, u));
                let (gap, normal) = tool.shape().foot(&p);
                let (slip, multiplier) = (history.slip(point), history.multiplier(point));
                if let Some(response) = tool.law().respond(gap, &normal, &p, &slip, multiplier) {
                    let tangent = tangent(&pose, &response, &p, &normal);
                    let traction = pose.to_world(&response.traction);
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

fn check_len(what: &'static str, found: usize, expected: usize) -> Result<(), ContactError> {
    if found == expected { Ok(()) } else { Err(ContactError::Length { what, found, expected }) }
}
