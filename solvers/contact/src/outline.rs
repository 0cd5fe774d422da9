//! The surface between the contact points.

use shape::{Point3, PointRows, Vector3};

use crate::error::ContactError;

/// Triangulated surface without quadrature: it carries no force, but represents the body between the contact
/// points.
#[derive(Clone, Copy, Debug)]
pub struct Outline<'a> {
    pub(super) rows: &'a PointRows,
    pub(super) triangles: &'a [[u32; 3]],
}

impl<'a> Outline<'a> {
    /// Makes the outline from triangles. Their corners are indices of points of `rows`, and the shape
    /// functions of `rows` move these points with the body.
    ///
    /// # Errors
    ///
    /// [`ContactError::Length`] if a corner is not a point of `rows`.
    pub fn new(rows: &'a PointRows, triangles: &'a [[u32; 3]]) -> Result<Outline<'a>, ContactError> {
        let expected = rows.points().len();
        match triangles.iter().flatten().find(|&&k| k as usize >= expected) {
            Some(&k) => {
                Err(ContactError::Length { what: "corners of the outline", found: k as usize + 1, expected })
            }
            None => Ok(Outline { rows, triangles }),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.rows.points().len()
    }

    /// Position `X + sum_I N_I u_I` of a corner, m.
    pub(super) fn position(&self, corner: usize, u: &[Vector3]) -> Point3 {
        let (nodes, values) = self.rows.rows().row(corner);
        let moved: Vector3 = nodes.iter().zip(values).map(|(&node, value)| u[node as usize] * *value).sum();
        self.rows.points()[corner] + moved
    }
}
