//! What makes the constants of a law unusable.

/// Constants that a law refuses.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// Young's modulus must be positive and finite.
    #[error("Young's modulus is {young} Pa; it must be positive and finite")]
    Young {
        /// The modulus given, Pa.
        young: f64,
    },
    /// Poisson's ratio must lie between -1 and 0.5, both excluded.
    #[error("Poisson's ratio is {poisson}; it must lie between -1 and 0.5, both excluded")]
    Poisson {
        /// The ratio given.
        poisson: f64,
    },
}
