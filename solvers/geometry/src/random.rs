//! Seeded uniform random numbers, bitwise reproducible from the seed.

use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};

/// ChaCha8 stream of uniform numbers. The conversion to f64 is explicit, so that an update of the random
/// number library cannot change a mesh.
pub(crate) struct Uniform(ChaCha8Rng);

impl Uniform {
    pub(crate) fn new(seed: u64) -> Uniform {
        Uniform(ChaCha8Rng::seed_from_u64(seed))
    }

    /// A number uniform in [0, 1), with 53 random bits.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// A number uniform in [low, high).
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}
