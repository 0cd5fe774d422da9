//! Scalar types of the kernels.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Neg, Sub};

use lanes::{LANES, madd, madd_f32};

use super::math;

/// Scalar type of a kernel: `f64`, or `f32` with twice the lanes in half the memory. One source serves both.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + Send
    + Sync
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + AddAssign
    + 'static
{
    /// Number of lanes of a block: one register of AVX-512 or two of AVX2.
    const LANES: usize;
    /// A number for each lane.
    type Lanes: Copy + PartialEq + Send + Sync + Index<usize, Output = Self> + IndexMut<usize>;
    /// Zero and one.
    const ZERO: Self;
    #[allow(missing_docs)]
    const ONE: Self;
    /// Zero and one in every lane.
    const ZEROS: Self::Lanes;
    #[allow(missing_docs)]
    const ONES: Self::Lanes;

    /// Rounds a number to this type.
    fn of(value: f64) -> Self;

    /// Returns the same number in double precision.
    fn double(self) -> f64;

    /// Returns `a b + c`; see [`lanes::madd`].
    fn madd<const FMA: bool>(a: Self, b: Self, c: Self) -> Self;

    /// Returns `ln(1 + j)`; see [`math::ln_1p`].
    fn ln_1p<const FMA: bool>(j: Self) -> Self;

    /// Returns `(1 + j)^(-1/3) - 1`; see [`math::inverse_cbrt_less_1`].
    fn inverse_cbrt_less_1<const FMA: bool>(j: Self) -> Self;
}

macro_rules! real {
    ($type:ident, $lanes:expr, $madd:ident, $ln_1p:ident, $inverse_cbrt_less_1:ident) => {
        impl Real for $type {
            const LANES: usize = $lanes;
            type Lanes = [$type; $lanes];
            const ZERO: $type = 0.0;
            const ONE: $type = 1.0;
            const ZEROS: [$type; $lanes] = [0.0; $lanes];
            const ONES: [$type; $lanes] = [1.0; $lanes];

            #[inline(always)]
            fn of(value: f64) -> $type {
                value as $type
            }

            #[inline(always)]
            fn double(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn madd<const FMA: bool>(a: $type, b: $type, c: $type) -> $type {
                $madd::<FMA>(a, b, c)
            }

            #[inline(always)]
            fn ln_1p<const FMA: bool>(j: $type) -> $type {
                math::$ln_1p::<FMA>(j)
            }

            #[inline(always)]
            fn inverse_cbrt_less_1<const FMA: bool>(j: $type) -> $type {
                math::$inverse_cbrt_less_1::<FMA>(j)
            }
        }
    };
}

real!(f64, LANES, madd, ln_1p, inverse_cbrt_less_1);
real!(f32, 2 * LANES, madd_f32, ln_1p_f32, inverse_cbrt_less_1_f32);
