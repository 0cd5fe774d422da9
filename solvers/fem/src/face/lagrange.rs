//! Shape functions on a face.

/// Lagrange element of `N` nodes on a reference face.
pub(crate) trait Face<const N: usize> {
    /// Reference coordinates of the nodes, corners first.
    const NODES: [[f64; 2]; N];

    /// Returns the shape functions at `s`.
    fn shape(s: [f64; 2]) -> [f64; N];

    /// Returns the gradients of the shape functions with respect to `s`.
    fn shape_grad(s: [f64; 2]) -> [[f64; 2]; N];
}
