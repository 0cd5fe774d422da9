//! Detection of tools that overlap the body but touch no contact point: they have no force, without any other
//! sign of error.

use shape::{Point3, Vector3};

use crate::error::ContactError;
use crate::surface::ContactSurface;
use crate::tool::Tool;
use crate::tool_travel::Stand;

/// Largest accepted overlap during the loading, if a tool overlaps the surface between its contact points and
/// touches none of them yet. The overlap is the depth of a surface location in the tool, divided by the
/// distance (undeformed) from this location to the nearest contact point.
pub const ON_THE_WAY: f64 = 0.5;
/// Largest accepted overlap as [`ON_THE_WAY`], at the end of the loading, when no contact can follow.
const IN_THE_END: f64 = 0.01;
/// Number of subdivisions of a triangle into four, to find its deepest location.
const DIVISIONS: usize = 5;

impl ContactSurface<'_> {
    /// Checks that a tool that touches no contact point does not overlap the outline by too much. Only the
    /// corners of the outline are tested. A corner may be as deep as [`ON_THE_WAY`] allows, because a contact
    /// point may be about to touch, but no deeper than [`Tool::deepest`]. Use this check for reported states
    /// during the loading, and [`ContactSurface::check_end`] at the end. Without an outline the check passes.
    ///
    /// # Errors
    ///
    /// [`ContactError::Overlap`] with the deepest corner.
    pub fn check_overlap(&self, tool: &Tool, stand: Stand) -> Result<(), ContactError> {
        let Some(outline) = self.outline else { return Ok(()) };
        let mut worst = Deepest::default();
        for k in 0..outline.len() {
            let at = outline.position(k, stand.u);
            let depth = -tool.shape().foot(&tool.local(stand.closure, &at)).0;
            if depth > worst.depth && depth > self.allowed(tool, &outline.rows.points()[k], ON_THE_WAY) {
                worst = Deepest { depth, at, reference: outline.rows.points()[k] };
            }
        }
        self.refuse(worst)
    }

    /// Checks at the end of the loading that a tool that touches no contact point does not overlap the
    /// outline. All of the outline is searched, between its corners too. The depth may be up to a hundredth
    /// of the distance to the nearest contact point, but no more than [`Tool::deepest`]. Without an outline
    /// the check passes.
    ///
    /// # Errors
    ///
    /// [`ContactError::Overlap`] with the deepest location.
    pub fn check_end(&self, tool: &Tool, stand: Stand) -> Result<(), ContactError> {
        let Some(outline) = self.outline else { return Ok(()) };
        let mut worst = Deepest::default();
        for k in 0..outline.len() {
            worst.meet(tool, stand.closure, outline.position(k, stand.u), outline.rows.points()[k]);
        }
        for triangle in outline.triangles {
            let corners = triangle.map(|k| {
                let (k, at) = (k as usize, outline.position(k as usize, stand.u));
                (at, outline.rows.points()[k])
            });
            worst.search(tool, stand.closure, corners, 0);
        }
        let allowed = self.allowed(tool, &worst.reference, IN_THE_END);
        self.refuse(if worst.depth > allowed { worst } else { Deepest::default() })
    }

    /// Returns the depth (m) that is allowed without a force.
    fn allowed(&self, tool: &Tool, reference: &Point3, part: f64) -> f64 {
        (part * self.apart(reference)).min(tool.deepest())
    }

    /// Returns the distance (m) to the nearest contact point in the undeformed body.
    fn apart(&self, reference: &Point3) -> f64 {
        let squares = self.rows().points().iter().map(|p| (p - reference).norm_squared());
        squares.fold(f64::INFINITY, f64::min).sqrt()
    }

    fn refuse(&self, Deepest { depth, at, reference }: Deepest) -> Result<(), ContactError> {
        if depth > 0.0 {
            return Err(ContactError::Overlap { depth, at, apart: self.apart(&reference) });
        }
        Ok(())
    }
}

/// Deepest location found, m; none if the depth is 0.
#[derive(Default)]
struct Deepest {
    depth: f64,
    at: Point3,
    reference: Point3,
}

impl Deepest {
    /// Updates the deepest location with one location, and returns its depth.
    fn meet(&mut self, tool: &Tool, closure: f64, at: Point3, reference: Point3) -> f64 {
        let depth = -tool.shape().foot(&tool.local(closure, &at)).0;
        if depth > self.depth {
            *self = Deepest { depth, at, reference };
        }
        depth
    }

    /// Searches a triangle for a deeper location. Each corner has a current and an undeformed position.
    fn search(&mut self, tool: &Tool, closure: f64, corners: [(Point3, Point3); 3], divided: usize) {
        let middle =
            |points: [Point3; 3]| Point3::from(points.iter().map(|p| p.coords).sum::<Vector3>() / 3.0);
        let (at, reference) = (middle(corners.map(|c| c.0)), middle(corners.map(|c| c.1)));
        let depth = self.meet(tool, closure, at, reference);
        // The distance function changes by no more than the distance travelled.
        let size = corners.iter().map(|c| (c.0 - at).norm()).fold(0.0, f64::max);
        if divided == DIVISIONS || depth + size <= self.depth {
            return;
        }
        let between = |a: usize, b: usize| {
            let ((a, x), (b, y)) = (corners[a], corners[b]);
            (nalgebra::center(&a, &b), nalgebra::center(&x, &y))
        };
        let [ab, bc, ca] = [between(0, 1), between(1, 2), between(2, 0)];
        for part in [[corners[0], ab, ca], [ab, corners[1], bc], [ca, bc, corners[2]], [ab, bc, ca]] {
            self.search(tool, closure, part, divided + 1);
        }
    }
}
