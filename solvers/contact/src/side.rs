//! Detection of tools that push the surface from within the body.

use shape::Vector3;

use crate::contacts::Contacts;
use crate::error::ContactError;
use crate::surface::ContactSurface;

impl ContactSurface<'_> {
    /// Checks that no more than a tenth of a tool's force points out of the body. A tool above this limit has
    /// slipped through between points and lifts them from within. `contacts` are those of one tool in the
    /// state `u` (m).
    ///
    /// The deformed normal of a point, `(x_b - x_a) x (x_c - x_a)`, is computed from two neighbouring points,
    /// which ignores any bending between them. Two cases are therefore accepted: a force that points out of
    /// the surface by less than 12 degrees, and a few points on a crease. Points at corners and on edges are
    /// not checked, because faces of different directions meet there.
    ///
    /// # Errors
    ///
    /// [`ContactError::WithinBody`] with the first point that is pushed outwards.
    pub fn check_side(&self, contacts: &Contacts, u: &[Vector3]) -> Result<(), ContactError> {
        let (mut all, mut outwards, mut first) = (0.0, 0.0, None);
        for (&point, traction) in contacts.points().iter().zip(contacts.tractions()) {
            let [b, c] = self.beside[point as usize].map(|q| self.position(q as usize, u));
            let at = self.position(point as usize, u);
            let normal = (b - at).cross(&(c - at));
            let push = traction.norm() * self.rows().weights()[point as usize];
            all += push;
            if traction.dot(&normal) > 0.2 * traction.norm() * normal.norm() {
                outwards += push;
                first = first.or(Some((point as usize, at)));
            }
        }
        match first {
            Some((point, at)) if outwards > 0.1 * all => {
                Err(ContactError::WithinBody { share: outwards / all, point, at })
            }
            _ => Ok(()),
        }
    }
}
