//! A nodal parameter with a prescribed value.

/// A prescribed nodal parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedDof {
    /// Index of the node.
    pub node: u32,
    /// Axis: 0, 1, 2 for x, y, z.
    pub axis: u8,
    /// Prescribed value, m; zero is allowed.
    pub value: f64,
}
