//! Arrays of numbers with elementwise operations, which the compiler maps to wide registers if the machine
//! has them.

use std::ops::{Add, Div, Mul, Sub};

pub(crate) use lanes::LANES;

/// An array of `N` numbers.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<const N: usize = LANES>(pub(crate) [f64; N]);

macro_rules! each_lane {
    ($($operator:ident $method:ident $sign:tt),*) => {$(
        impl<const N: usize> $operator for Lanes<N> {
            type Output = Lanes<N>;

            #[inline(always)]
            fn $method(self, other: Lanes<N>) -> Lanes<N> {
                let mut result = self;
                for lane in 0..N {
                    result.0[lane] = self.0[lane] $sign other.0[lane];
                }
                result
            }
        }
    )*};
}

each_lane!(Add add +, Sub sub -, Mul mul *, Div div /);

impl<const N: usize> Lanes<N> {
    /// Returns the same number in all lanes.
    #[inline(always)]
    pub(crate) fn all(value: f64) -> Lanes<N> {
        Lanes([value; N])
    }

    /// Returns the larger numbers, lane by lane.
    #[inline(always)]
    pub(crate) fn max(self, other: Lanes<N>) -> Lanes<N> {
        let mut result = self;
        for lane in 0..N {
            result.0[lane] = if self.0[lane] > other.0[lane] { self.0[lane] } else { other.0[lane] };
        }
        result
    }
}

/// Returns the scalar products of `N` pairs of vectors.
#[inline(always)]
pub(crate) fn dot<const N: usize>(a: &[Lanes<N>; 3], b: &[Lanes<N>; 3]) -> Lanes<N> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
