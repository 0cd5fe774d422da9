//! Numbers of several points side by side, one point to a lane. A point's arithmetic never leaves its lane, so that its bits
//! depend neither on the width of the registers nor on the points beside it.

/// Eight f64 fill one AVX-512 register or two of AVX2.
pub(crate) const LANES: usize = 8;

/// One number of each point.
pub(crate) type Lanes = [f64; LANES];
