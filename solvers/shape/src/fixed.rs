//! A nodal parameter with a prescribed value.

/// One nodal parameter prescribed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedDof {
    /// The node.
    pub node: u32,
    /// 0, 1, 2 for x, y, z.
    pub axis: u8,
    /// Prescribed value, m (zero is a value like any other).
    pub value: f64,
}
