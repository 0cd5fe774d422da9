//! Stress of eight points at once, or of sixteen in single precision. A loop over lanes becomes vector
//! instructions if its body is straight-line arithmetic. All functions here are therefore free of branches
//! on a lane and of calls.

pub mod invariants;
pub mod math;
mod real;
pub(super) mod series;
pub(super) mod stretch;

use invariants::{Invariants, Minors};

pub use lanes::LANES;
pub use real::Real;

/// A number for each of eight points.
pub type Lanes = [f64; LANES];

/// Displacement gradients of one point in each lane with derived quantities that every kernel needs. The
/// structure is aligned, because otherwise registers of 64 bytes might straddle cache lines, depending on
/// the stack (up to 1.5 times the time).
#[derive(Clone, Copy)]
#[repr(align(64))]
pub struct LaneStrain<T: Real = f64> {
    /// `H_ij`, [3 i + j].
    pub h: [T::Lanes; 9],
    /// `tr H` and `II(H) + det H`; their sum is `J - 1`.
    pub invariants: [T::Lanes; 2],
    /// First row of the minors of each point ([`Minors`]): (1, 1) of `cof H`, (1, 2) and (1, 3) of
    /// `cof H - H^T`.
    pub minors: [T::Lanes; 3],
}

impl<T: Real> LaneStrain<T> {
    /// Zero displacement.
    pub const ZERO: LaneStrain<T> =
        LaneStrain { h: [T::ZEROS; 9], invariants: [T::ZEROS; 2], minors: [T::ZEROS; 3] };

    /// Returns the displacement gradient of a lane, row by row.
    #[inline(always)]
    pub fn lane(&self, l: usize) -> [T; 9] {
        of_lane::<T>(&self.h, l)
    }

    /// Returns the invariants and minors of a lane.
    #[inline(always)]
    pub fn invariants(&self, l: usize) -> (Invariants<T>, Minors<T>) {
        let minors = [self.minors[0][l], self.minors[1][l], self.minors[2][l]];
        (Invariants::new(self.invariants[0][l], self.invariants[1][l]), minors)
    }

    /// Stores the gradient, invariants and minors of a lane.
    #[inline(always)]
    pub fn set<const FMA: bool>(&mut self, l: usize, h: &[T; 9]) {
        let (x, minors) = Invariants::of::<FMA>(h);
        for k in 0..9 {
            self.h[k][l] = h[k];
        }
        (self.invariants[0][l], self.invariants[1][l]) = (x.trace, x.rest);
        (self.minors[0][l], self.minors[1][l], self.minors[2][l]) = (minors[0], minors[1], minors[2]);
    }

    /// Sets `good` of a lane to 0 if its `J` is not positive. This is a separate loop, because together with
    /// [`LaneStrain::set`] it becomes a branch for each lane.
    #[inline(always)]
    pub fn check(&self, good: &mut T::Lanes) {
        for l in 0..T::LANES {
            let j = self.invariants[0][l] + self.invariants[1][l];
            good[l] = if T::ONE + j > T::ZERO { good[l] } else { T::ZERO };
        }
    }
}

/// Returns one lane of nine numbers.
#[inline(always)]
pub(super) fn of_lane<T: Real>(h: &[T::Lanes; 9], l: usize) -> [T; 9] {
    [h[0][l], h[1][l], h[2][l], h[3][l], h[4][l], h[5][l], h[6][l], h[7][l], h[8][l]]
}
