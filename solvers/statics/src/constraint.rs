//! General linear constraints `sum_k c_k u_k = g`, enforced by Lagrange multipliers or eliminated.

use shape::{Rows, SurfaceRows, Vector3};

use crate::body::check_len;
use crate::error::SolveError;

/// One linear equation between nodal parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstraintRow {
    /// Terms (node, axis, coefficient) of the left-hand side. Coefficients of a repeated (node, axis) add up.
    pub terms: Vec<(u32, u8, f64)>,
    /// Right-hand side: metres times the unit of the coefficients.
    pub value: f64,
}

/// Returns the rows `sum_q w M_m(x_q) (u_a(x_q) - g_a(x_q)) = 0` for each multiplier node `m` that is present
/// on the surface and each selected axis `a`.
///
/// `multiplier` holds the multiplier basis `M` at the surface points, and `values` the prescribed
/// displacement `g` there (m).
pub fn multiplier_rows(
    surface: &SurfaceRows,
    multiplier: &Rows,
    axes: [bool; 3],
    values: &[Vector3],
) -> Result<Vec<ConstraintRow>, SolveError> {
    let points = surface.weights().len();
    check_len("rows of the multiplier basis", multiplier.len(), points)?;
    check_len("prescribed displacements", values.len(), points)?;
    // For every multiplier node: its pairs (point, w M), in order of points.
    let mut seen: Vec<Vec<(usize, f64)>> = vec![Vec::new(); multiplier.node_count()];
    for q in 0..points {
        let (nodes, m) = multiplier.row(q);
        for (&node, m) in nodes.iter().zip(m) {
            seen[node as usize].push((q, surface.weights()[q] * m));
        }
    }
    let mut rows = Vec::new();
    let mut coefficient = vec![0.0; surface.rows().node_count()];
    for list in seen.iter().filter(|list| !list.is_empty()) {
        let mut touched = Vec::new();
        for &(q, w) in list {
            let (nodes, n) = surface.rows().row(q);
            for (&node, n) in nodes.iter().zip(n) {
                coefficient[node as usize] += w * n;
                touched.push(node);
            }
        }
        touched.sort_unstable();
        touched.dedup();
        let terms: Vec<(u32, f64)> =
            touched.into_iter().map(|n| (n, std::mem::take(&mut coefficient[n as usize]))).collect();
        for axis in (0..3).filter(|&a| axes[a]) {
            rows.push(ConstraintRow {
                terms: terms.iter().map(|&(n, c)| (n, axis as u8, c)).collect(),
                value: list.iter().map(|&(q, w)| w * values[q][axis]).sum(),
            });
        }
    }
    Ok(rows)
}

/// A checked row without repeated terms or zero coefficients: pairs `(dof, coefficient)` in ascending order,
/// and the value.
pub(crate) struct Row {
    pub terms: Vec<(usize, f64)>,
    pub value: f64,
}

impl Row {
    /// Returns the contribution of the prescribed degrees of freedom to the row, `sum c u` over them.
    /// `prescribed` has one entry per degree of freedom `3 node + axis`, m.
    pub fn held_part(&self, prescribed: &[Option<f64>]) -> f64 {
        self.terms.iter().filter_map(|&(dof, c)| prescribed[dof].map(|v| c * v)).sum()
    }

    /// Returns the row over the free degrees of freedom; the contribution of the prescribed degrees of
    /// freedom moves to the value.
    pub fn without(&self, prescribed: &[Option<f64>]) -> Row {
        let terms = self.terms.iter().filter(|t| prescribed[t.0].is_none()).copied().collect();
        Row { terms, value: self.value - self.held_part(prescribed) }
    }
}

/// Checks and sorts the rows.
pub(crate) fn sorted(rows: &[ConstraintRow], node_count: usize) -> Result<Vec<Row>, SolveError> {
    let mut out = Vec::with_capacity(rows.len());
    for (index, row) in rows.iter().enumerate() {
        let mut terms: Vec<(usize, f64)> = Vec::with_capacity(row.terms.len());
        for &(node, axis, c) in &row.terms {
            if node as usize >= node_count {
                let node = node as usize;
                let nodes = node_count;
                return Err(SolveError::NodeOutOfRange { what: "a constraint row", node, nodes });
            }
            if axis > 2 {
                return Err(SolveError::BadAxis { what: "a constraint row", axis });
            }
            if !c.is_finite() {
                return Err(SolveError::NotFinite { what: "coefficient of constraint row", index });
            }
            terms.push((3 * node as usize + axis as usize, c));
        }
        if !row.value.is_finite() {
            return Err(SolveError::NotFinite { what: "value of constraint row", index });
        }
        terms.sort_by_key(|t| t.0);
        terms.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        terms.retain(|t| t.1 != 0.0);
        out.push(Row { terms, value: row.value });
    }
    Ok(out)
}
