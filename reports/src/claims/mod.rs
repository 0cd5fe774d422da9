//! Published comparisons of methods, tested against results. A claim consists of scenes, methods, relations
//! and tolerances, and of published numbers with their place.

mod claim;
mod judge;
mod named;
mod numbers;
mod published;
mod relation;

pub(crate) use claim::reproduced;
pub use claim::{Claim, ClaimVerdict, own_claims, read_claims};
pub use judge::Judged;
pub(crate) use judge::findings;
pub(crate) use numbers::{Pair, Split, pairs, splits};
