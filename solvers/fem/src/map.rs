//! Isoparametric map at one point: `x(xi) = sum_a N_a x_a`, `J_ik = dx_i / dxi_k`, `grad N = J^-T dN/dxi`.

use geometry::{Mesh, Point3, Vector3};

/// Node positions of a cell relative to its first node. Sums over shape gradients then cancel to the last
/// bits of the cell's size, not of its distance from the origin.
pub(crate) struct Nodes<const N: usize> {
    pub(crate) origin: Point3,
    pub(crate) dx: [Vector3; N],
}

impl<const N: usize> Nodes<N> {
    /// Gathers the nodes of a cell or a face; the list must have `N` entries.
    #[inline]
    pub(crate) fn gather(mesh: &Mesh, nodes: &[u32; N]) -> Nodes<N> {
        let points = mesh.points();
        let origin = points[nodes[0] as usize];
        let mut dx = [Vector3::zeros(); N];
        for a in 1..N {
            dx[a] = points[nodes[a] as usize] - origin;
        }
        Nodes { origin, dx }
    }

    /// Returns the position relative to the origin, m.
    #[inline]
    pub(crate) fn offset(&self, n: &[f64; N]) -> Vector3 {
        let mut x = Vector3::zeros();
        for a in 1..N {
            x += n[a] * self.dx[a];
        }
        x
    }

    /// Returns the position in space, m.
    #[inline]
    pub(crate) fn position(&self, n: &[f64; N]) -> Point3 {
        self.origin + self.offset(n)
    }

    /// Returns the columns `dx/dxi_k` of the Jacobian, for `D` reference coordinates.
    #[inline]
    pub(crate) fn tangents<const D: usize>(&self, dn: &[[f64; D]; N]) -> [Vector3; D] {
        let mut t = [Vector3::zeros(); D];
        for a in 1..N {
            for k in 0..D {
                t[k] += dn[a][k] * self.dx[a];
            }
        }
        t
    }
}

/// Returns `det J` (m^3) of the columns `t_k = dx/dxi_k`, and the cofactors `c_k` with
/// `grad xi_k = c_k / det J`.
#[inline]
pub(crate) fn cofactors([t0, t1, t2]: &[Vector3; 3]) -> (f64, [Vector3; 3]) {
    let c = [t1.cross(t2), t2.cross(t0), t0.cross(t1)];
    (t0.dot(&c[0]), c)
}

/// Returns `det J` (m^3) and `grad xi_k` (1/m), or the determinant as an error if it is not positive or NaN.
#[inline]
pub(crate) fn inverse(tangents: &[Vector3; 3]) -> Result<(f64, [Vector3; 3]), f64> {
    let (det_j, c) = cofactors(tangents);
    if det_j > 0.0 { Ok((det_j, c.map(|c| c / det_j))) } else { Err(det_j) }
}

/// Returns `grad N = sum_k dN/dxi_k grad xi_k`, 1/m.
#[inline]
pub(crate) fn physical(dn: &[f64; 3], grad_xi: &[Vector3; 3]) -> Vector3 {
    dn[0] * grad_xi[0] + dn[1] * grad_xi[1] + dn[2] * grad_xi[2]
}
