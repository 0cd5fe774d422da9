//! State of contact between converged steps: elastic slip for friction, multipliers for the augmented
//! Lagrangian.

use shape::Vector3;

use crate::contacts::Contacts;
use crate::law::Slip;
use crate::surface::ContactSurface;
use crate::tool::Tool;

/// History of all points of a surface against one tool. Evaluating contact never changes the history: during
/// the iterations of a step, every trial state starts from the last committed state.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactHistory {
    points: usize,
    /// Slip of each point; empty without friction.
    slip: Vec<Slip>,
    /// Points whose slip is not [`Slip::NONE`].
    stuck: Vec<u32>,
    /// Multipliers, Pa; empty until the first augmentation.
    multiplier: Vec<f64>,
    /// Points whose multiplier is not zero.
    pressed: Vec<u32>,
    /// Largest multiplier, Pa.
    largest: f64,
}

impl ContactHistory {
    /// Starts a history for a surface with a number of `points`, none of which has touched. Without friction
    /// no slip is stored.
    pub fn new(tool: &Tool, points: usize) -> ContactHistory {
        let kept = if tool.law().friction() > 0.0 { points } else { 0 };
        ContactHistory {
            points,
            slip: vec![Slip::NONE; kept],
            stuck: Vec::new(),
            multiplier: Vec::new(),
            pressed: Vec::new(),
            largest: 0.0,
        }
    }

    /// Carries the history over to the points of another surface of the same body with displacement `u`
    /// (m): each point has the elastic slip and the multiplier of the point `nearest` of this history.
    pub fn carried(
        &self,
        nearest: &[u32],
        surface: &ContactSurface,
        tool: &Tool,
        closure: f64,
        u: &[Vector3],
    ) -> ContactHistory {
        let mut carried = ContactHistory::new(tool, nearest.len());
        carried.commit_all(None, surface, tool, closure, u);
        for (slip, &near) in carried.slip.iter_mut().zip(nearest) {
            *slip = slip.with_stretch(self.slip(near as usize).stretch());
        }
        if !self.multiplier.is_empty() {
            carried.multiplier = nearest.iter().map(|&near| self.multiplier(near as usize)).collect();
            carried.pressed =
                (0..nearest.len() as u32).filter(|&q| carried.multiplier(q as usize) > 0.0).collect();
            carried.largest = self.largest;
        }
        carried
    }

    /// Number of points of the surface.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Committed friction history of one point; [`Slip::NONE`] if none is stored.
    pub fn slip(&self, point: usize) -> Slip {
        self.slip.get(point).copied().unwrap_or(Slip::NONE)
    }

    /// Multiplier of one point, Pa; 0 if the point did not touch at the last augmentation.
    pub fn multiplier(&self, point: usize) -> f64 {
        self.multiplier.get(point).copied().unwrap_or(0.0)
    }

    /// Returns the largest multiplier, Pa.
    pub(super) fn largest_multiplier(&self) -> f64 {
        self.largest
    }

    /// Commits as [`ContactHistory::commit`], and also stores the position of every point that does not
    /// touch. A point that touches in the next step then has friction from its first contact on. For large
    /// steps: every point is processed.
    pub fn commit_all(
        &mut self,
        contacts: Option<&Contacts>,
        surface: &ContactSurface,
        tool: &Tool,
        closure: f64,
        u: &[Vector3],
    ) {
        self.commit(contacts);
        let pose = tool.pose(closure);
        let touching = contacts.map_or(&[][..], |c| c.points());
        for (q, slip) in self.slip.iter_mut().enumerate() {
            if touching.binary_search(&(q as u32)).is_err() {
                let at = pose.local(&surface.position(q, u));
                // A point that touches only through its multiplier has no path left to its contact.
                *slip = Slip::at(&at, tool.shape().foot(&at).0.max(0.0));
                self.stuck.push(q as u32);
            }
        }
    }

    /// Commits the slip of the points in contact after a converged step, and resets that of all others. Does
    /// nothing without friction. `contacts` is `None` if no point was near the tool.
    pub fn commit(&mut self, contacts: Option<&Contacts>) {
        if self.slip.is_empty() {
            return;
        }
        for &q in &self.stuck {
            self.slip[q as usize] = Slip::NONE;
        }
        self.stuck.clear();
        if let Some(contacts) = contacts {
            self.stuck.extend_from_slice(contacts.points());
            for (&q, &slip) in contacts.points().iter().zip(contacts.slip()) {
                self.slip[q as usize] = slip;
            }
        }
    }

    /// Performs one Uzawa step after a converged solve: `l <- max(0, l - k_n g)` at every point. The new
    /// multiplier is the pressure just computed.
    ///
    /// Repeat solve and augmentation until [`Contacts::max_penetration`] is small enough, then commit.
    /// Friction is bounded by the augmented pressure and keeps its elastic stick.
    pub fn augment(&mut self, contacts: Option<&Contacts>) {
        self.multiplier.resize(self.points, 0.0);
        for &q in &self.pressed {
            self.multiplier[q as usize] = 0.0;
        }
        self.pressed.clear();
        self.largest = 0.0;
        if let Some(contacts) = contacts {
            self.pressed.extend_from_slice(contacts.points());
            for (&q, &pressure) in contacts.points().iter().zip(contacts.pressures()) {
                self.multiplier[q as usize] = pressure;
                self.largest = self.largest.max(pressure);
            }
        }
    }
}
