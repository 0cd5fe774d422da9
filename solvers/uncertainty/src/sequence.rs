//! Samples of inputs: a Sobol sequence with Owen's scrambling.

use sobol_burley::sample;

use crate::distribution::Distribution;

/// Largest number of inputs.
pub const MOST_INPUTS: usize = 256;
/// Largest number of samples.
pub const MOST_SAMPLES: u32 = 100_000;
/// Seed of the scrambling. It is written in results: the same seed gives the same samples.
pub const SEED: u32 = 1;

/// Length of one scrambled sequence. Later samples come from sequences of other seeds.
const LENGTH: u32 = 1 << 16;
/// Half of the spacing of the sequence's numbers, which begin at 0.
const HALF: f64 = 1.0 / (1 << 25) as f64;

/// Numbers between 0 and 1, both excluded, of the input `input` in the sample `index`.
pub(crate) fn uniform(index: u32, input: usize) -> f64 {
    f64::from(sample(index % LENGTH, input as u32, SEED + index / LENGTH)) + HALF
}

/// Values of the inputs in the sample `index`, which counts from 0.
///
/// # Panics
/// More inputs than [`MOST_INPUTS`].
pub fn point(inputs: &[Distribution], index: u32) -> Vec<f64> {
    inputs.iter().enumerate().map(|(input, of)| of.quantile(uniform(index, input))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_eighth_of_each_input_has_its_share_of_samples() {
        for input in [0, 1, 5, 255] {
            let mut counts = [0; 8];
            (0..64).for_each(|index| counts[(8.0 * uniform(index, input)) as usize] += 1);
            assert_eq!(counts, [8; 8], "{input}");
        }
    }

    #[test]
    fn samples_beyond_one_sequence_are_new() {
        assert_ne!(uniform(0, 0), uniform(LENGTH, 0));
        assert!((0..MOST_SAMPLES).step_by(997).all(|index| (HALF..1.0).contains(&uniform(index, 3))));
    }
}
