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

#[cfg(test)]
mod tests {
    use shape::{Matrix3, Point3, PointRows, Rows, SurfaceRows, Unity};

    use super::*;
    use crate::{ContactCounts, ContactHistory, ContactLaw, Sphere, Tool, ToolShape};

    /// Cells along each side of a face.
    const CELLS: u32 = 20;

    /// Left face (outward normal -x) and top (+z) of a cube of 1 m, one point per vertex; those of the common
    /// edge occur in both.
    fn two_faces() -> SurfaceRows {
        let step = |k: u32| f64::from(k) / f64::from(CELLS);
        let grid = || (0..=CELLS).flat_map(move |i| (0..=CELLS).map(move |j| (step(i), step(j))));
        let left = grid().map(|(y, z)| (Point3::new(0.0, y, z), -Vector3::x()));
        let top = grid().map(|(x, y)| (Point3::new(x, y, 1.0), Vector3::z()));
        let (points, normals): (Vec<Point3>, Vec<Vector3>) = left.chain(top).unzip();
        let count = points.len();
        let (offsets, own) = ((0..=count).collect(), (0..count as u32).collect());
        let rows = Rows::new(count, offsets, own, vec![1.0; count], Unity::Within(0.0));
        let at = PointRows::new(points, rows.unwrap()).unwrap();
        SurfaceRows::new(at, vec![1.0; count], normals).unwrap()
    }

    /// Checks the side of a ball of 30 mm, of which only points within this distance of its middle touch.
    fn check(middle: Point3) -> Result<(), ContactError> {
        let rows = two_faces();
        let surface = ContactSurface::new(&rows);
        let shape = ToolShape::Sphere(Sphere { radius: 0.03 });
        let law = ContactLaw::frictionless(1e6).unwrap();
        let tool = Tool::new(shape, middle, Matrix3::identity(), Vector3::x(), law).unwrap();
        let at_rest = vec![Vector3::zeros(); rows.points().len()];
        let history = ContactHistory::new(&tool, at_rest.len());
        let counts = &mut ContactCounts::default();
        let contacts = surface.tractions(&tool, 0.0, &at_rest, &history, counts).unwrap().unwrap();
        surface.check_side(&contacts, &at_rest)
    }

    #[test]
    fn a_push_from_within_is_refused_at_faces_and_accepted_on_their_common_edge() {
        let from_within = check(Point3::new(0.02, 0.5, 0.5));
        assert!(matches!(from_within, Err(ContactError::WithinBody { share: 1.0, .. })), "{from_within:?}");
        assert!(check(Point3::new(-0.02, 0.5, 0.5)).is_ok());
        // The ball presses the left face from outside, 10 mm below the edge, and thereby lifts the top there.
        assert!(check(Point3::new(-0.02, 0.5, 0.99)).is_ok());
    }
}
