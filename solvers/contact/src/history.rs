//! What contact keeps between converged steps: elastic slip for friction, multipliers for the augmented Lagrangian.

use shape::Vector3;

use super::{ContactSurface, Contacts, Slip, Tool};

/// History of all points of a surface against one tool. Evaluating contact never changes it: during the iterations of
/// a step every trial state starts from the last committed one.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactHistory {
    points: usize,
    /// Empty without friction.
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
    /// Nothing has touched yet. Without friction no slip is kept.
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

    /// Number of points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Committed slip of one point.
    pub fn slip(&self, point: usize) -> Slip {
        self.slip.get(point).copied().unwrap_or(Slip::NONE)
    }

    /// Multiplier of one point, Pa.
    pub fn multiplier(&self, point: usize) -> f64 {
        self.multiplier.get(point).copied().unwrap_or(0.0)
    }

    /// Largest multiplier, Pa.
    pub(super) fn largest_multiplier(&self) -> f64 {
        self.largest
    }

    /// As [`ContactHistory::commit`], and the place of every point that does not touch is kept too, so that one which
    /// touches in the next step has friction from its touch on. For large steps: it looks at every point.
    pub fn commit_all(
        &mut self,
        contacts: Option<&Contacts>,
        surface: &ContactSurface,
        tool: &Tool,
        closure: f64,
        u: &[Vector3],
    ) {
        self.commit(contacts);
        let touching = contacts.map_or(&[][..], |c| c.points());
        for (q, slip) in self.slip.iter_mut().enumerate() {
            if touching.binary_search(&(q as u32)).is_err() {
                let at = tool.local(closure, &surface.position(q, u));
                // A point that would touch were it not for its multiplier has no way left to its touch.
                *slip = Slip::at(&at, tool.shape().foot(&at).0.max(0.0));
                self.stuck.push(q as u32);
            }
        }
    }

    /// After a converged step: the slip of the points that touch is kept, all others forget theirs. `None` when the
    /// tool was skipped.
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

    /// One step of Uzawa, after a converged solve: `l <- max(0, l - k_n g)` at every point, which is the pressure just
    /// found. Repeat solve and augmentation until [`Contacts::max_penetration`] is small enough, then commit. Friction
    /// is bounded by the augmented pressure and keeps its elastic stick.
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
