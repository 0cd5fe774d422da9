//! Stress fields on the reference tetrahedron, the same for all cells by the contravariant Piola map
//! `sigma = G S G^T / |det G|`, which keeps symmetry, divergence and continuity of tractions.

use std::sync::LazyLock;

use nalgebra::{DMatrix, DVector, SVD};
use shape::{Matrix3, Vector3};

/// Number of independent fields: linear tractions on four faces (36) that satisfy six conditions of
/// equilibrium.
pub(super) const FIELDS: usize = 30;
/// Vertices of each face. Face `f` is opposite to vertex `3 - f`.
pub(super) const FACES: [[usize; 3]; 4] = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
/// Entries (i, j) of a symmetric matrix, in the order of its six components.
pub(super) const ENTRIES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)];
/// Index of the centroid among the vertices of the parts.
const CENTROID: usize = 4;

/// Fields of the reference tetrahedron, whose volume is 1/6 m^3.
pub(super) struct Reference {
    /// Stress components by row `6 (4 part + k) + component` and field. The sum over `k` of products of two
    /// fields is the integral over the part divided by its volume.
    pub stress: DMatrix<f64>,
    /// Moments of the tractions by row `3 (3 face + vertex) + axis` and field: integrals of the traction
    /// times the linear function of the vertex.
    pub moments: DMatrix<f64>,
}

/// The fields, computed at first use.
pub(super) static REFERENCE: LazyLock<Reference> = LazyLock::new(Reference::new);

/// Vertices of a part: the centroid replaces the vertex with the number of the part.
fn vertices(part: usize) -> [usize; 4] {
    let mut of = [0, 1, 2, 3];
    of[part] = CENTROID;
    of
}

fn position(vertex: usize) -> Vector3 {
    match vertex {
        0 => Vector3::zeros(),
        CENTROID => Vector3::repeat(0.25),
        _ => Vector3::ith(vertex - 1, 1.0),
    }
}

/// Index of a component of the stress at a vertex of a part.
fn index(part: usize, vertex: usize, (i, j): (usize, usize)) -> usize {
    let k = vertices(part).iter().position(|&v| v == vertex).expect("a vertex of the part");
    let component = ENTRIES.iter().position(|&entry| entry == (i.min(j), i.max(j)));
    6 * (4 * part + k) + component.expect("six entries are all")
}

/// Area vector of a triangle.
fn area(corners: [usize; 3]) -> Vector3 {
    let [a, b, c] = corners.map(position);
    (b - a).cross(&(c - a)) / 2.0
}

/// Gradients of the linear functions of a part's vertices.
fn gradients(part: usize) -> [Vector3; 4] {
    let [a, b, c, d] = vertices(part).map(position);
    let edges = Matrix3::from_columns(&[b - a, c - a, d - a]);
    let inverse = edges.try_inverse().expect("parts have a volume");
    let of = |row: usize| inverse.row(row).transpose();
    [-(of(0) + of(1) + of(2)), of(0), of(1), of(2)]
}

impl Reference {
    fn new() -> Reference {
        let values = balanced();
        // The fields by lower triangle L of the mass (1 + delta) / 20 of linear functions: values^T L L^T
        // values.
        let mass = nalgebra::Matrix4::from_fn(|i, j| if i == j { 0.1 } else { 0.05 });
        let lower = mass.cholesky().expect("a mass is definite").l();
        let stress = DMatrix::from_fn(96, FIELDS, |row, field| {
            let (part, k, component) = (row / 24, row / 6 % 4, row % 6);
            (0..4).map(|m| lower[(m, k)] * values[(24 * part + 6 * m + component, field)]).sum()
        });
        let mut moments = DMatrix::zeros(36, FIELDS);
        for (face, corners) in FACES.into_iter().enumerate() {
            let part = 3 - face;
            let outward = area(corners);
            let normal = outward * outward.dot(&(position(corners[0]) - position(part))).signum();
            for field in 0..FIELDS {
                let traction = corners.map(|vertex| {
                    Vector3::from_fn(|i, _| {
                        (0..3).map(|j| values[(index(part, vertex, (i, j)), field)] * normal[j]).sum()
                    })
                });
                for (vertex, moment) in linear_moments(&traction).into_iter().enumerate() {
                    moments.fixed_view_mut::<3, 1>(9 * face + 3 * vertex, field).copy_from(&moment);
                }
            }
        }
        Reference { stress, moments }
    }
}

/// Integrals of a linear vector field times the linear function of each corner, over a triangle of area 1,
/// from the values at the corners.
pub(super) fn linear_moments(values: &[Vector3; 3]) -> [Vector3; 3] {
    let sum: Vector3 = values.iter().sum();
    values.map(|value| (sum + value) / 12.0)
}

/// Orthonormal basis of the values at the vertices of all parts, without divergence and with tractions that
/// balance on the six faces between parts.
fn balanced() -> DMatrix<f64> {
    // 12 equations of divergence and 54 of balance have rank 66; the other rows stay zero.
    let mut equations = DMatrix::zeros(96, 96);
    let mut row = 0;
    for part in 0..4 {
        for i in 0..3 {
            for (vertex, gradient) in vertices(part).into_iter().zip(gradients(part)) {
                (0..3).for_each(|j| equations[(row, index(part, vertex, (i, j)))] += gradient[j]);
            }
            row += 1;
        }
    }
    for (s, t) in (0..4).flat_map(|s| (s + 1..4).map(move |t| (s, t))) {
        let shared: Vec<usize> = (0..=CENTROID).filter(|v| ![s, t].contains(v)).collect();
        let normal = area([shared[0], shared[1], shared[2]]).normalize();
        for (vertex, i) in shared.iter().flat_map(|&vertex| (0..3).map(move |i| (vertex, i))) {
            for j in 0..3 {
                equations[(row, index(s, vertex, (i, j)))] += normal[j];
                equations[(row, index(t, vertex, (i, j)))] -= normal[j];
            }
            row += 1;
        }
    }
    let svd = SVD::new(equations, false, true);
    let (values, right): (DVector<f64>, DMatrix<f64>) = (svd.singular_values, svd.v_t.expect("requested"));
    let mut order: Vec<usize> = (0..96).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    DMatrix::from_fn(96, FIELDS, |row, field| right[(order[field], row)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Resultant and moment about the origin of the tractions of a field, by the exact integrals of
    /// `x = sum of x_k phi_k`.
    fn resultants(field: usize) -> (Vector3, Vector3) {
        let mut sums = (Vector3::zeros(), Vector3::zeros());
        for (face, corners) in FACES.into_iter().enumerate() {
            for (k, corner) in corners.into_iter().enumerate() {
                let m = REFERENCE.moments.fixed_view::<3, 1>(9 * face + 3 * k, field).into_owned();
                sums.0 += m;
                sums.1 += position(corner).cross(&m);
            }
        }
        sums
    }

    #[test]
    fn tractions_are_in_equilibrium_and_determine_the_stress() {
        for field in 0..FIELDS {
            let (force, moment) = resultants(field);
            assert!(force.norm() < 1e-14 && moment.norm() < 1e-14, "{field}: {force} {moment}");
        }
        let singular = REFERENCE.moments.clone().svd(false, false).singular_values;
        let (least, most) = (singular.min(), singular.max());
        assert!(least > 1e-3 * most, "{least} {most}");
    }

    #[test]
    fn a_constant_stress_is_among_the_fields() {
        let values = balanced();
        let constant = DMatrix::from_fn(96, 6, |row, c| if row % 6 == c { 1.0 } else { 0.0 });
        let inside = &values * (values.transpose() * &constant);
        assert!((inside - constant).amax() < 1e-14);
    }
}
