//! Surfaces held by stiffness and damping per area: supports by penalty, and springs and dampers (an elastic
//! foundation).

use shape::{Matrix3, Resultant, SurfaceRows, Vector3};

use super::system::SurfaceTable;

/// A surface constrained by a penalty, for bases whose parameters are not displacements, or a surface on springs
/// and dampers that are fixed to the ground.
#[derive(Clone, Debug)]
pub struct PenaltySurface<'a> {
    /// Shape values, weights and normals at the surface points.
    pub surface: &'a SurfaceRows,
    /// Axes x, y, z along which the surface is held.
    pub axes: [bool; 3],
    /// Whether the surface is held along its undeformed normal only, instead of along the axes.
    pub along_normal: bool,
    /// Prescribed displacement at each point at the end of the loading, m.
    pub values: Vec<Vector3>,
    /// Displacement at each point to which the prescribed one is added, m; empty for none.
    pub from: Vec<Vector3>,
    /// Penalty, or stiffness per undeformed area, Pa/m.
    pub beta: f64,
    /// Damping per undeformed area, Pa s/m.
    pub damping: f64,
}

/// Velocities at the end of a step as a function of the displacements: in free degrees of freedom
/// `still + factor (u - from)`, in constrained ones `still`.
#[derive(Clone, Debug)]
pub(crate) struct Rate {
    /// Derivative of the velocity with respect to the displacement, 1/s.
    pub factor: f64,
    /// Displacement at the start of the step, m.
    pub from: Vec<Vector3>,
    /// Velocity at the displacement `from`, m/s.
    pub still: Vec<Vector3>,
}

impl Rate {
    /// Returns the velocities at the displacements `u` (m), m/s. A degree of freedom `3 node + axis` is
    /// constrained if its entry of `prescribed` is `Some`.
    pub fn velocities(&self, u: &[Vector3], prescribed: &[Option<f64>]) -> Vec<Vector3> {
        let at = |i: usize| {
            Vector3::from_fn(|a, _| match prescribed[3 * i + a] {
                Some(_) => self.still[i][a],
                None => self.still[i][a] + self.factor * (u[i][a] - self.from[i][a]),
            })
        };
        (0..u.len()).map(at).collect()
    }
}

impl PenaltySurface<'_> {
    /// Returns the part of a vector at a point that the surface resists.
    fn held(&self, q: usize, v: &Vector3) -> Vector3 {
        if self.along_normal {
            let n = self.surface.normals()[q];
            return n * n.dot(v);
        }
        Vector3::from_fn(|a, _| if self.axes[a] { v[a] } else { 0.0 })
    }

    /// Returns the traction on the body at every point, Pa, for displacements `u` (m), velocities `v` (m/s; empty
    /// for none) and `part` of the prescribed displacements.
    pub(crate) fn tractions(&self, u: &[Vector3], v: &[Vector3], part: f64) -> Vec<Vector3> {
        let each = u.iter().zip(&self.values).enumerate();
        let mut tractions: Vec<Vector3> = each
            .map(|(q, (u, g))| self.held(q, &Vector3::from_fn(|a, _| self.beta * (g[a] * part - u[a]))))
            .collect();
        for (q, (traction, from)) in tractions.iter_mut().zip(&self.from).enumerate() {
            *traction += self.held(q, &(from * self.beta));
        }
        for (q, (traction, v)) in tractions.iter_mut().zip(v).enumerate() {
            *traction -= self.held(q, &(v * self.damping));
        }
        tractions
    }

    /// Returns the tangent `w (beta + rate damping) P` of every point, N/m, with the derivative `rate` of the
    /// velocity with respect to the displacement, 1/s.
    pub(crate) fn blocks(&self, rate: f64) -> Vec<Matrix3> {
        let stiffness = self.beta + rate * self.damping;
        let weights = self.surface.weights().iter();
        if self.along_normal {
            let normals = self.surface.normals();
            return weights.zip(normals).map(|(w, n)| n * n.transpose() * (stiffness * w)).collect();
        }
        let held = Vector3::from_fn(|a, _| if self.axes[a] { stiffness } else { 0.0 });
        weights.map(|w| Matrix3::from_diagonal(&(held * *w))).collect()
    }

    /// Returns the resultant of the forces on the body, without damping, for the nodal parameters `u` (m) and
    /// `part` of the prescribed displacements.
    pub(crate) fn resultant(&self, u: &[Vector3], part: f64) -> Resultant {
        let mut sum = Resultant::default();
        let moved = self.surface.rows().apply(u);
        let points = self.surface.points().iter().zip(&moved).zip(&self.values);
        for (q, (((x, u), g), w)) in points.zip(self.surface.weights()).enumerate() {
            let from = self.from.get(q).copied().unwrap_or_default();
            sum.add(&(x + u), &self.held(q, &((g * part + from - u) * (self.beta * w))));
        }
        sum
    }

    /// Adds to `right` the damping force (N) of the displacement increments `moves` (m) of constrained degrees of
    /// freedom, whose velocities do not depend on these moves.
    pub(crate) fn give_back(
        &self,
        table: &SurfaceTable,
        rate: f64,
        moves: &[Vector3],
        right: &mut [Vector3],
    ) {
        let at = table.displacement(moves);
        let each = at.iter().enumerate().map(|(q, u)| self.held(q, &(u * (rate * self.damping))));
        table.add_force(&each.collect::<Vec<_>>(), right);
    }
}

#[cfg(test)]
mod tests {
    use fem::SurfaceRule;
    use geometry::generate::box_mesh;
    use geometry::{CellKind, Point3};

    use super::*;

    #[test]
    fn the_blocks_are_the_derivative_of_the_force_with_the_velocity() {
        let mesh = box_mesh(
            CellKind::Hex8,
            Point3::origin(),
            Point3::new(0.01, 0.02, 0.01),
            [1, 2, 1],
            [1.0; 3],
            None,
        );
        let mesh = mesh.unwrap();
        let surface = fem::surface_rows(&mesh, &mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
        let points = surface.weights().len();
        for along_normal in [false, true] {
            let penalty = PenaltySurface {
                surface: &surface,
                axes: [true, true, false],
                along_normal,
                values: vec![Vector3::new(1e-3, -2e-3, 3e-3); points],
                from: Vec::new(),
                beta: 2e5,
                damping: 30.0,
            };
            let n = mesh.points().len();
            let rate = Rate {
                factor: 4e3,
                from: vec![Vector3::new(1e-4, 0.0, 2e-4); n],
                still: vec![Vector3::x(); n],
            };
            let field = |s: f64| -> Vec<Vector3> {
                (0..n).map(|i| Vector3::new((s + i as f64).sin(), (2.0 * i as f64).cos(), s) * 1e-3).collect()
            };
            let table = SurfaceTable::new(&surface);
            let force = |u: &[Vector3]| {
                let v = rate.velocities(u, &vec![None; 3 * n]);
                let mut out = vec![Vector3::zeros(); n];
                let tractions = penalty.tractions(&table.displacement(u), &table.displacement(&v), 0.5);
                table.add_force(&tractions, &mut out);
                out
            };
            // The force is linear in u.
            let (a, b) = (field(0.3), field(1.1));
            let step: Vec<Vector3> = b.iter().zip(&a).map(|(b, a)| b - a).collect();
            let at = table.displacement(&step);
            let blocks = penalty.blocks(rate.factor);
            let mut expected = vec![Vector3::zeros(); n];
            let tractions: Vec<Vector3> =
                (0..points).map(|q| blocks[q] * at[q] * (-1.0 / surface.weights()[q])).collect();
            table.add_force(&tractions, &mut expected);
            let found = force(&b).into_iter().zip(force(&a)).map(|(b, a)| b - a);
            let size = expected.iter().map(Vector3::norm).fold(0.0, f64::max);
            for (found, expected) in found.zip(&expected) {
                assert!((found - expected).norm() < 1e-12 * size, "{along_normal}: {found} {expected}");
            }
        }
    }
}
