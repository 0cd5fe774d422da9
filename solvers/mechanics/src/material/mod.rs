//! Pointwise constitutive laws. A law sees a displacement gradient `H = grad u` and knows no mesh. It offers
//! `energy_density(H)` and `stress(H)`.

mod linear;

pub use linear::{LinearElastic, MaterialError};
