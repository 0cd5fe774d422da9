//! Traces: fields of a volume quadrature on a surface.

use crate::rows::ShapeError;

/// Fields on a surface as combinations of their values at points of the volume quadrature,
/// `f(x_s) = sum_q c_sq f(x_q)`, with the lengths of a trace inequality. The inequality bounds the integral
/// of `f^2` over the surface by that over the volume ([`TraceRows::new`]).
///
/// A boundary stress of this form consists of the quantities that the energy integrates. Nitsche's method is
/// then definite with a known factor, which does not hold for gradients of the shape functions at the
/// surface.
#[derive(Clone, Debug, PartialEq)]
pub struct TraceRows {
    offsets: Vec<usize>,
    points: Vec<u32>,
    coefficients: Vec<f64>,
    lengths: Vec<f64>,
    point_count: usize,
}

impl TraceRows {
    /// Checks the arrays and builds a trace over `point_count` volume points: `offsets` (surface points + 1),
    /// volume `points` and `coefficients` (one per entry), and `lengths` (m, one per surface point). The
    /// coefficients of a row sum to one.
    ///
    /// The lengths `h_s` must satisfy the trace inequality `sum_s w_s h_s f(x_s)^2 <= sum_q w_q f(x_q)^2` for
    /// every `f` on the volume's points, with the weights `w_s` (m^2) and `w_q` (m^3) of the surface and the
    /// volume. This condition is not checked.
    ///
    /// # Errors
    /// Arrays of unequal length, broken offsets, an empty row, a point out of range, a row that does not sum
    /// to one, or a length that is not positive.
    pub fn new(
        point_count: usize,
        offsets: Vec<usize>,
        points: Vec<u32>,
        coefficients: Vec<f64>,
        lengths: Vec<f64>,
    ) -> Result<TraceRows, ShapeError> {
        let entries = points.len();
        if coefficients.len() != entries {
            let found = coefficients.len();
            return Err(ShapeError::Length { what: "trace coefficients", found, expected: entries });
        }
        if offsets.len() != lengths.len() + 1 {
            let found = lengths.len();
            let expected = offsets.len().saturating_sub(1);
            return Err(ShapeError::Length { what: "trace lengths", found, expected });
        }
        if offsets.first() != Some(&0) || offsets.last() != Some(&entries) {
            return Err(ShapeError::BrokenOffsets { row: 0, offset: *offsets.last().unwrap_or(&0), entries });
        }
        for (row, pair) in offsets.windows(2).enumerate() {
            if pair[1] <= pair[0] {
                return Err(ShapeError::BrokenOffsets { row, offset: pair[1], entries });
            }
            if let Some(&point) = points[pair[0]..pair[1]].iter().find(|&&p| p as usize >= point_count) {
                return Err(ShapeError::NodeOutOfRange { row, node: point as usize, nodes: point_count });
            }
            let sum: f64 = coefficients[pair[0]..pair[1]].iter().sum();
            // The negations also reject NaN.
            if !((sum - 1.0).abs() < 1e-12) {
                return Err(ShapeError::NotUnity { row, sum, tolerance: 1e-12 });
            }
            if !(lengths[row] > 0.0 && lengths[row].is_finite()) {
                return Err(ShapeError::BadWeight { row, weight: lengths[row] });
            }
        }
        Ok(TraceRows { offsets, points, coefficients, lengths, point_count })
    }

    /// Number of surface points.
    pub fn len(&self) -> usize {
        self.lengths.len()
    }

    /// Whether there are no surface points.
    pub fn is_empty(&self) -> bool {
        self.lengths.is_empty()
    }

    /// Number of points of the volume quadrature.
    pub fn point_count(&self) -> usize {
        self.point_count
    }

    /// Volume points of all rows, one row after another.
    pub fn points(&self) -> &[u32] {
        &self.points
    }

    /// Returns the volume points and coefficients of a surface point.
    pub fn row(&self, row: usize) -> (&[u32], &[f64]) {
        let range = self.offsets[row]..self.offsets[row + 1];
        (&self.points[range.clone()], &self.coefficients[range])
    }

    /// Lengths `h_s` (m), one per surface point, of the trace inequality in [`TraceRows::new`].
    pub fn lengths(&self) -> &[f64] {
        &self.lengths
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broken_traces_are_refused() {
        let new = |points: Vec<u32>, coefficients: Vec<f64>, lengths: Vec<f64>| {
            TraceRows::new(4, vec![0, 1, 3], points, coefficients, lengths)
        };
        let good = new(vec![3, 0, 1], vec![1.0, 1.5, -0.5], vec![0.1, 0.2]).unwrap();
        assert_eq!(good.row(1), (&[0, 1][..], &[1.5, -0.5][..]));
        assert_eq!((good.len(), good.lengths()[1]), (2, 0.2));
        let bad = |p: [u32; 3], c: [f64; 3], l: &[f64]| new(p.into(), c.into(), l.into()).unwrap_err();
        assert!(matches!(
            bad([4, 0, 1], [1.0, 1.5, -0.5], &[0.1, 0.2]),
            ShapeError::NodeOutOfRange { node: 4, .. }
        ));
        assert!(matches!(bad([3, 0, 1], [1.0, 1.5, 0.5], &[0.1, 0.2]), ShapeError::NotUnity { row: 1, .. }));
        assert!(matches!(
            bad([3, 0, 1], [1.0, f64::NAN, 0.5], &[0.1, 0.2]),
            ShapeError::NotUnity { row: 1, .. }
        ));
        assert!(matches!(
            bad([3, 0, 1], [1.0, 1.5, -0.5], &[0.1, 0.0]),
            ShapeError::BadWeight { row: 1, .. }
        ));
        assert!(matches!(bad([3, 0, 1], [1.0, 1.5, -0.5], &[0.1]), ShapeError::Length { .. }));
    }
}
