//! Coefficients of traces sum to one.

use tissuebench_shape::{ShapeError, TraceRows};

#[test]
fn coefficients_sum_to_one_but_for_rounding() {
    let of = |last: f64| TraceRows::new(2, vec![0, 2], vec![0, 1], vec![1.5, last], vec![0.1]);
    assert!(of(-0.5).is_ok() && of(-0.5 + 1e-14).is_ok());
    for last in [-0.501, -0.5 + 1e-9] {
        assert!(matches!(of(last), Err(ShapeError::NotUnity { row: 0, .. })), "{last}");
    }
}
