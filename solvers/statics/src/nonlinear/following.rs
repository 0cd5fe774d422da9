//! Pressures and tractions on the deformed surface.
//!
//! A pressure p acts on the deformed surface with the nodal forces `f_I = -sum_q w p N_I m`. The vector
//! `m = cof(F) n = F t1 x F t2` is the directed area of the deformed surface per undeformed area, with unit
//! tangents for which `t1 x t2 = n`. Only tangential gradients of the displacement enter.
//!
//! The tangent is `-df_I = sum_J w p N_I (du_J x b_J)` with `b_J = g1_J F t2 - g2_J F t1` and the tangential
//! gradients `g_J` of the shape functions. Its skew part vanishes if the pressure is uniform and the surface
//! is closed or its rim is held. Source: Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element
//! Analysis, 2nd edition, section 8.5.
//!
//! A traction t of fixed direction per deformed area has the nodal forces `f_I = sum_q w N_I |m| t` and,
//! with the deformed normal `n = m / |m|`, the tangent `-df_I = -sum_J w N_I t ((b_J x n) . du_J)`, of rank
//! one and unsymmetric.

use algebra::{Connectivity, Incidence};
use shape::{FluxRows, Matrix3, Vector3};

use super::sorted_rows::Sorted;
use crate::body::check_len;
use crate::error::SolveError;

/// Shape values and tangential gradients below this fraction of the largest in their row are rounding: those
/// of an element's nodes off the face.
const ROUNDING: f64 = 1e-12;
/// Part of its terms below which the skew part of a pair of nodes is rounding.
const CANCELLED: f64 = 1e-10;

/// Load at a point times its weight, N.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Push {
    /// Against the deformed normal.
    Pressure(f64),
    /// In a fixed direction.
    Traction(Vector3),
}

impl Push {
    fn times(self, factor: f64) -> Push {
        match self {
            Push::Pressure(p) => Push::Pressure(p * factor),
            Push::Traction(t) => Push::Traction(t * factor),
        }
    }
}

/// A pressure or a traction per area of the deformed surface.
#[derive(Clone, Debug)]
pub struct FollowingLoad {
    /// `(N, grad N . t1, grad N . t2)` of each point and node; gradients in 1/m.
    rows: Sorted<Vector3>,
    of_node: Incidence,
    /// Tangents `t1` and `t2` of each point.
    tangents: Vec<[Vector3; 2]>,
    /// Load of each point times its weight.
    forces: Vec<Push>,
}

/// Deformed tangents `F t1` and `F t2` of each point, and its load.
pub(crate) type Pressed = Vec<([Vector3; 2], Push)>;

impl FollowingLoad {
    /// Prepares a pressure with one of `values` (Pa) at each point of the undeformed surface. It acts against
    /// the outward normal.
    ///
    /// # Errors
    /// A number of values other than that of the points, or a value that is not finite.
    pub fn pressure(surface: &FluxRows, values: &[f64]) -> Result<FollowingLoad, SolveError> {
        FollowingLoad::new(surface, values, |p| p.is_finite(), |p, w| Push::Pressure(w * p))
    }

    /// Prepares a traction of fixed direction with one of `values` (Pa, per deformed area) at each point of
    /// the undeformed surface.
    ///
    /// # Errors
    /// As for [`FollowingLoad::pressure`].
    pub fn traction(surface: &FluxRows, values: &[Vector3]) -> Result<FollowingLoad, SolveError> {
        let finite = |t: &Vector3| t.iter().all(|x| x.is_finite());
        FollowingLoad::new(surface, values, finite, |t, w| Push::Traction(t * w))
    }

    fn new<T>(
        surface: &FluxRows,
        values: &[T],
        finite: impl Fn(&T) -> bool,
        push: impl Fn(&T, f64) -> Push,
    ) -> Result<FollowingLoad, SolveError> {
        check_len("load values", values.len(), surface.weights().len())?;
        if let Some(index) = values.iter().position(|value| !finite(value)) {
            return Err(SolveError::NotFinite { what: "load at point", index });
        }
        let tangents: Vec<[Vector3; 2]> = surface.normals().iter().map(tangents).collect();
        let (table, grads) = (surface.at().rows(), |q: usize| surface.at().row(q).1);
        let rows = Sorted::new((0..values.len()).map(|q| {
            let (nodes, shape) = table.row(q);
            let [t1, t2] = tangents[q];
            let data = |(n, g): (&f64, &Vector3)| Vector3::new(*n, g.dot(&t1), g.dot(&t2));
            let each: Vec<Vector3> = shape.iter().zip(grads(q)).map(data).collect();
            let largest = |axis: usize| each.iter().map(|d| d[axis].abs()).fold(0.0, f64::max);
            let [value, first, second] = [0, 1, 2].map(|axis| ROUNDING * largest(axis));
            let gradient = first.max(second);
            let counts = move |d: &Vector3| d.x.abs() > value || d.y.abs() > gradient || d.z.abs() > gradient;
            nodes.iter().copied().zip(each).filter(move |(_, d)| counts(d))
        }));
        let of_node = rows.incidence(table.node_count());
        let forces = surface.weights().iter().zip(values).map(|(w, value)| push(value, *w)).collect();
        Ok(FollowingLoad { rows, of_node, tangents, forces })
    }

    /// Number of points on the surface.
    pub fn len(&self) -> usize {
        self.forces.len()
    }

    /// Whether the surface has no points.
    pub fn is_empty(&self) -> bool {
        self.forces.is_empty()
    }

    /// Adds the nodal forces (N) of `part` of the load at the nodal parameters `u` (m) to `out`.
    pub fn add_force(&self, u: &[Vector3], part: f64, out: &mut [Vector3]) {
        for (q, ([first, second], push)) in self.pressed(u, part).iter().enumerate() {
            let force = match push {
                Push::Pressure(p) => second.cross(first) * *p,
                Push::Traction(t) => t * first.cross(second).norm(),
            };
            let (nodes, data) = self.rows.row(q);
            nodes.iter().zip(data).for_each(|(&node, d)| out[node as usize] += force * d.x);
        }
    }

    /// Returns the deformed tangents of each point and its load for `part` of the load.
    pub(crate) fn pressed(&self, u: &[Vector3], part: f64) -> Pressed {
        let at = |q: usize| {
            let (nodes, data) = self.rows.row(q);
            let [mut first, mut second] = self.tangents[q];
            for (&node, d) in nodes.iter().zip(data) {
                first += u[node as usize] * d.y;
                second += u[node as usize] * d.z;
            }
            ([first, second], self.forces[q].times(part))
        };
        (0..self.len()).map(at).collect()
    }

    /// Nodes of the points and points of the nodes, for the pattern of the tangent.
    pub(crate) fn pattern(&self) -> (Connectivity<'_>, &Incidence) {
        (self.rows.connectivity(), &self.of_node)
    }

    /// Calls `add` with the symmetric part of the tangent (N/m) for node `i` and each node `j <= i`.
    pub(crate) fn symmetric_part(&self, pressed: &Pressed, i: usize, mut add: impl FnMut(u32, Matrix3)) {
        for &(q, k) in self.of_node.of(i) {
            let (q, k) = (q as usize, k as usize);
            let here = &self.rows.data[k];
            let (lever_here, normal) = (lever(&pressed[q], here), normal(&pressed[q]));
            for j in self.rows.offsets[q]..k {
                let there = &self.rows.data[j];
                let by_there = block(&pressed[q], &normal, here, &lever(&pressed[q], there));
                let by_here = block(&pressed[q], &normal, there, &lever_here);
                add(self.rows.nodes[j], (by_there + by_here.transpose()) * 0.5);
            }
            if let Push::Traction(_) = pressed[q].1 {
                let own = block(&pressed[q], &normal, here, &lever_here);
                add(i as u32, (own + own.transpose()) * 0.5);
            }
        }
    }

    /// Returns the skew part of the tangent: for pairs of nodes i <= j the block `S` (N/m) of (i, j); that
    /// of (j, i) is `-S^T`. Pairs whose terms cancel are left out.
    pub(crate) fn skew_part(&self, pressed: &Pressed) -> Vec<([u32; 2], Matrix3)> {
        let mut terms = Vec::new();
        for (q, pressed) in pressed.iter().enumerate() {
            let (nodes, data) = self.rows.row(q);
            let levers: Vec<Vector3> = data.iter().map(|d| lever(pressed, d)).collect();
            let normal = normal(pressed);
            for j in 0..nodes.len() {
                for i in 0..=j {
                    let upper = block(pressed, &normal, &data[i], &levers[j]);
                    let lower = block(pressed, &normal, &data[j], &levers[i]);
                    terms.push(([nodes[i], nodes[j]], (upper - lower.transpose()) * 0.5));
                }
            }
        }
        // A stable sort keeps the order of the terms of a pair, hence the bits of their sum.
        terms.sort_by_key(|term| term.0);
        let sum = |pair: &[([u32; 2], Matrix3)]| {
            let size: f64 = pair.iter().map(|(_, block)| block.norm()).sum();
            let sum: Matrix3 = pair.iter().map(|(_, block)| block).sum();
            (sum.norm() > CANCELLED * size).then_some((pair[0].0, sum))
        };
        terms.chunk_by(|a, b| a.0 == b.0).filter_map(sum).collect()
    }
}

/// Returns `b = g1 F t2 - g2 F t1` of a node, times a pressure, N/m.
fn lever(([first, second], push): &([Vector3; 2], Push), node: &Vector3) -> Vector3 {
    let lever = second * node.y - first * node.z;
    match push {
        Push::Pressure(p) => lever * *p,
        Push::Traction(_) => lever,
    }
}

/// Deformed unit normal of a point.
fn normal(([first, second], _): &([Vector3; 2], Push)) -> Vector3 {
    let m = first.cross(second);
    m / m.norm()
}

/// Returns the tangent `-df_I / du_J` (N/m) of a point by the row of node I and the lever of node J.
fn block((_, push): &([Vector3; 2], Push), normal: &Vector3, here: &Vector3, lever: &Vector3) -> Matrix3 {
    match push {
        Push::Pressure(_) => lever.cross_matrix() * -here.x,
        Push::Traction(t) => t * lever.cross(normal).transpose() * -here.x,
    }
}

/// Returns unit tangents with `t1 x t2 = n`.
fn tangents(n: &Vector3) -> [Vector3; 2] {
    let first = Vector3::ith(n.iamin(), 1.0);
    let first = (first - n * n.dot(&first)).normalize();
    [first, n.cross(&first)]
}

#[cfg(test)]
mod tests {
    use fem::SurfaceRule;
    use geometry::generate::{Jitter, box_mesh};
    use geometry::{CellKind, Mesh};
    use shape::Point3;

    use super::*;

    fn mesh(kind: CellKind) -> Mesh {
        let jitter = Some(Jitter { fraction: 0.2, seed: 7 });
        box_mesh(kind, Point3::origin(), Point3::new(0.01, 0.012, 0.009), [2; 3], [1.0; 3], jitter).unwrap()
    }

    /// An asymmetric displacement of up to a fifth of the body, m.
    fn field(mesh: &Mesh) -> Vec<Vector3> {
        let wave = |x: &Point3| {
            let s = x.coords * 150.0;
            Vector3::new((s.y + 2.0 * s.z).sin(), (s.x - s.z).cos(), (s.x + s.y).sin()) * 2e-3
        };
        mesh.points().iter().map(wave).collect()
    }

    fn pressed(mesh: &Mesh, facets: &[geometry::Facet], value: impl Fn(&Point3) -> f64) -> FollowingLoad {
        let surface = fem::flux_rows(mesh, facets, &SurfaceRule::FINE).unwrap();
        let values: Vec<f64> = surface.points().iter().map(value).collect();
        FollowingLoad::pressure(&surface, &values).unwrap()
    }

    /// Product with the tangent, from its symmetric and its skew part.
    fn tangent(pressure: &FollowingLoad, u: &[Vector3], part: f64, along: &[Vector3]) -> Vec<Vector3> {
        let pressed = pressure.pressed(u, part);
        let mut out = vec![Vector3::zeros(); u.len()];
        for i in 0..u.len() {
            pressure.symmetric_part(&pressed, i, |j, block| {
                let j = j as usize;
                out[i] += block * along[j];
                if i != j {
                    out[j] += block.transpose() * along[i];
                }
            });
        }
        for ([i, j], block) in pressure.skew_part(&pressed) {
            let (i, j) = (i as usize, j as usize);
            out[i] += block * along[j];
            if i != j {
                out[j] -= block.transpose() * along[i];
            }
        }
        out
    }

    #[test]
    fn the_tangent_is_the_derivative_of_the_force() {
        for kind in [CellKind::Tet4, CellKind::Hex8, CellKind::Tet10, CellKind::Hex20] {
            let mesh = mesh(kind);
            // An open surface under a pressure that varies: both parts count.
            let pressure = pressed(&mesh, mesh.group("z-max").unwrap(), |x| 1e3 + 4e5 * x.x * x.y / 0.01);
            let u = field(&mesh);
            let along: Vec<Vector3> =
                (0..u.len()).map(|k| Vector3::new(1.0, -0.4, 0.7) * (k as f64).sin()).collect();
            let force = |step: f64| {
                let moved: Vec<Vector3> = u.iter().zip(&along).map(|(u, d)| u + d * step).collect();
                let mut out = vec![Vector3::zeros(); u.len()];
                pressure.add_force(&moved, 0.7, &mut out);
                out
            };
            // The force is quadratic in u, so central differences are exact but for rounding.
            let (up, down) = (force(1e-4), force(-1e-4));
            let found = tangent(&pressure, &u, 0.7, &along);
            let size = found.iter().map(Vector3::norm).fold(0.0, f64::max);
            for (k, found) in found.iter().enumerate() {
                let expected = (down[k] - up[k]) / 2e-4;
                assert!((found - expected).norm() < 1e-9 * size, "{kind:?} {k}: {found} for {expected}");
            }
        }
    }

    /// Central differences with a step d have the truncation error d^2 and the rounding error 1e-16 / d.
    #[test]
    fn the_tangent_of_a_traction_is_the_derivative_of_its_force() {
        for kind in [CellKind::Tet4, CellKind::Hex8, CellKind::Tet10, CellKind::Hex20] {
            let mesh = mesh(kind);
            let surface = fem::flux_rows(&mesh, mesh.group("z-max").unwrap(), &SurfaceRule::FINE).unwrap();
            let value = |x: &Point3| Vector3::new(1e3, -4e2, 2e3 + 4e5 * x.x);
            let values: Vec<Vector3> = surface.points().iter().map(value).collect();
            let traction = FollowingLoad::traction(&surface, &values).unwrap();
            let u = field(&mesh);
            let along: Vec<Vector3> =
                (0..u.len()).map(|k| Vector3::new(1.0, -0.4, 0.7) * (k as f64).sin()).collect();
            let force = |step: f64| {
                let moved: Vec<Vector3> = u.iter().zip(&along).map(|(u, d)| u + d * step).collect();
                let mut out = vec![Vector3::zeros(); u.len()];
                traction.add_force(&moved, 0.7, &mut out);
                out
            };
            let (up, down) = (force(1e-8), force(-1e-8));
            let found = tangent(&traction, &u, 0.7, &along);
            let size = found.iter().map(Vector3::norm).fold(0.0, f64::max);
            for (k, found) in found.iter().enumerate() {
                let expected = (down[k] - up[k]) / 2e-8;
                assert!((found - expected).norm() < 1e-6 * size, "{kind:?} {k}: {found} for {expected}");
            }
        }
    }

    /// A uniform traction on a plane face that is stretched within its plane has the resultant `t A` of the
    /// deformed area.
    #[test]
    fn a_traction_has_the_resultant_of_the_deformed_area() {
        for kind in [CellKind::Tet4, CellKind::Hex8, CellKind::Tet10, CellKind::Hex20] {
            let mesh =
                box_mesh(kind, Point3::origin(), Point3::new(0.01, 0.012, 0.009), [2; 3], [1.0; 3], None);
            let mesh = mesh.unwrap();
            let surface = fem::flux_rows(&mesh, mesh.group("z-max").unwrap(), &SurfaceRule::FINE).unwrap();
            let t = Vector3::new(3e3, -1e3, 2e3);
            let traction = FollowingLoad::traction(&surface, &vec![t; surface.weights().len()]).unwrap();
            let stretched = |x: &Point3| Vector3::new(0.3 * x.x + 0.2 * x.y, -0.1 * x.y, 0.5 * x.z);
            let u: Vec<Vector3> = mesh.points().iter().map(stretched).collect();
            let mut force = vec![Vector3::zeros(); u.len()];
            traction.add_force(&u, 0.5, &mut force);
            let expected = t * (0.5 * 0.01 * 0.012 * 1.3 * 0.9);
            let found = force.iter().sum::<Vector3>();
            assert!((found - expected).norm() < 1e-14 * expected.norm(), "{kind:?}: {found} {expected}");
        }
    }

    #[test]
    fn a_closed_body_under_uniform_pressure_is_in_balance_at_any_deformation() {
        for kind in [CellKind::Tet4, CellKind::Hex8, CellKind::Tet10, CellKind::Hex20] {
            let mesh = mesh(kind);
            let pressure = pressed(&mesh, &mesh.boundary(), |_| 1e3);
            let u = field(&mesh);
            let mut force = vec![Vector3::zeros(); u.len()];
            pressure.add_force(&u, 1.0, &mut force);
            let size: f64 = force.iter().map(Vector3::norm).sum();
            assert!(force.iter().sum::<Vector3>().norm() < 1e-14 * size, "{kind:?}");
            let at = mesh.points().iter().zip(&u).map(|(x, u)| x.coords + u);
            let moment: Vector3 = at.zip(&force).map(|(x, f)| x.cross(f)).sum();
            assert!(moment.norm() < 1e-14 * size, "{kind:?}: {moment}");
            assert!(pressure.skew_part(&pressure.pressed(&u, 1.0)).is_empty(), "{kind:?}");
        }
    }

    #[test]
    fn a_pressure_that_is_not_finite_is_refused() {
        let mesh = mesh(CellKind::Tet4);
        let surface = fem::flux_rows(&mesh, &mesh.boundary(), &SurfaceRule::FINE).unwrap();
        let mut values = vec![1.0; surface.weights().len()];
        values[3] = f64::NAN;
        assert!(matches!(
            FollowingLoad::pressure(&surface, &values),
            Err(SolveError::NotFinite { index: 3, .. })
        ));
        assert!(FollowingLoad::pressure(&surface, &values[1..]).is_err());
        let tractions: Vec<Vector3> = values.iter().map(|p| Vector3::new(1.0, *p, 0.0)).collect();
        assert!(matches!(
            FollowingLoad::traction(&surface, &tractions),
            Err(SolveError::NotFinite { index: 3, .. })
        ));
    }
}
