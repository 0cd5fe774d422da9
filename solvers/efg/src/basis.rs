//! Polynomial bases in shifted and scaled coordinates `xi = (x_I - x) / s`.

/// Complete polynomial basis of moving least squares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Basis {
    /// `1, x, y, z`: 4 terms.
    Linear,
    /// `1, x, y, z, xx, yy, zz, xy, yz, zx`: 10 terms.
    Quadratic,
}

impl Basis {
    /// Both bases.
    pub const ALL: [Basis; 2] = [Basis::Linear, Basis::Quadratic];

    /// The name used in scene files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Basis::Linear => "linear",
            Basis::Quadratic => "quadratic",
        }
    }

    /// The basis of that name.
    pub fn from_name(name: &str) -> Option<Basis> {
        Basis::ALL.into_iter().find(|basis| basis.name() == name)
    }

    /// Number of terms: 4 or 10. At least so many neighbours are needed at every point.
    pub fn terms(self) -> usize {
        match self {
            Basis::Linear => 4,
            Basis::Quadratic => 10,
        }
    }
}

/// The `M` terms at one scaled offset; `M` is 4 or 10, and the terms beyond the fourth are the quadratic block.
#[inline(always)]
pub(crate) fn terms<const M: usize>([x, y, z]: [f64; 3]) -> [f64; M] {
    let all = [1.0, x, y, z, x * x, y * y, z * z, x * y, y * z, z * x];
    // A loop, not `array::from_fn`: that is not always inlined, and then not on wide registers.
    let mut first = [0.0; M];
    first.copy_from_slice(&all[..M]);
    first
}
