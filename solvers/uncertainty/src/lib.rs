//! Uncertainty of inputs: from the distributions of some numbers to the distribution of a result.
//!
//! A [`Distribution`] turns a number between 0 and 1 into a value of an input. [`point`] gives such numbers
//! for all inputs of a sample, from a scrambled Sobol sequence. [`statistics`] takes the results of the
//! samples and returns their mean, their quantiles and the share of each input in their variance, from a
//! polynomial in the inputs ([`Chaos`]) if one fits, and else from the samples themselves.
//!
//! [`fit`] goes the other way: from measured values to the constants of a model, with their confidence.
//!
//! ```
//! use tissuebench_uncertainty::{Distribution, point, statistics};
//! // A spring with an uncertain stiffness and an uncertain end, of which the force is the product.
//! let inputs = [
//!     Distribution::Uniform { low: 9.0, high: 11.0 },
//!     Distribution::Normal { mean: 2.0, sd: 0.1, within: None },
//! ];
//! let samples: Vec<Vec<f64>> = (0..64).map(|index| point(&inputs, index)).collect();
//! let forces: Vec<f64> = samples.iter().map(|x| x[0] * x[1]).collect();
//! let of = statistics(&inputs, &samples, &forces).unwrap();
//! assert!((of.mean.value - 20.0).abs() < 1e-9);
//! // The stiffness has 1.33 / 2.33 of the variance (its own is 1 / 3, times 4).
//! assert!((of.indices[0].first.value - 0.571).abs() < 0.001);
//! ```

mod basis;
mod chaos;
mod confidence;
mod constant;
mod distribution;
mod fit;
mod normal;
mod resample;
mod sequence;
mod statistics;

pub use chaos::Chaos;
pub use confidence::{Collinear, Confidence};
pub use constant::{Constant, Measured};
pub use distribution::Distribution;
pub use fit::{FitError, Fitted, Models, fit};
pub use sequence::{MOST_INPUTS, MOST_SAMPLES, SEED, point};
pub use statistics::{Estimate, Index, LEAST_Q2, LEVELS, Source, Statistics, quantiles, statistics};
