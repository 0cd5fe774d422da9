//! The interface of all kernels.

/// Weight function of a kernel: `q < 1` gives `(w, dw/dq)`. All terms that do not depend on `q` are computed
/// beforehand.
pub(super) trait Weight: Copy {
    fn weight(self) -> impl Fn(f64) -> (f64, f64);
}
