//! Converts a region of comparisons to a ball in which a cloud is denser.

use cases::scene::{Region, Relation};
use geometry::shapes::Shape;
use geometry::{Point3, Refinement};

use crate::error::{Failure, Key};

/// Ratio of coarse to fine spacing of a graded cloud.
const RATIO: f64 = 2.5;

/// Returns the ball around the part of the body's bounding box that satisfies the region's comparisons.
///
/// # Errors
/// Returns an error if the region contains no part of the body's bounding box.
pub fn refinement(shape: &(dyn Shape + Send + Sync), region: &Region) -> Result<Refinement, Failure> {
    let [low, high] = shape.bounds();
    let (mut from, mut to) = (low, high);
    for c in &region.comparisons {
        let a = c.axis;
        match c.relation {
            Relation::Greater | Relation::GreaterEqual => from[a] = from[a].max(c.value),
            Relation::Less | Relation::LessEqual => to[a] = to[a].min(c.value),
            Relation::Equal => (from[a], to[a]) = (from[a].max(c.value), to[a].min(c.value)),
        }
    }
    if (0..3).any(|a| from[a] > to[a]) {
        let problem = format!("contains no point of the body, which spans {low} to {high} m");
        let help = "check the signs and the unit of the region";
        return Err(Failure::input(Key::Method("graded_towards"), problem, help));
    }
    let centre = Point3::from((from.coords + to.coords) / 2.0);
    let radius = (to - from).norm() / 2.0;
    Ok(Refinement { centre, radius, reach: (high - low).norm() / 4.0, ratio: RATIO })
}
