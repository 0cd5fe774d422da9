//! Four numbers worked on alike, so that the compiler takes them in one register where the machine has such.

use std::ops::{Add, Div, Mul, Sub};

/// How many.
pub(crate) const LANES: usize = 4;

/// Four numbers.
#[derive(Clone, Copy, Default)]
pub(crate) struct Lanes(pub(crate) [f64; LANES]);

macro_rules! each_lane {
    ($($operator:ident $method:ident $sign:tt),*) => {$(
        impl $operator for Lanes {
            type Output = Lanes;

            #[inline(always)]
            fn $method(self, other: Lanes) -> Lanes {
                let mut result = self;
                for lane in 0..LANES {
                    result.0[lane] = self.0[lane] $sign other.0[lane];
                }
                result
            }
        }
    )*};
}

each_lane!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Lanes {
    /// One number in all lanes.
    #[inline(always)]
    pub(crate) fn all(value: f64) -> Lanes {
        Lanes([value; LANES])
    }

    /// The larger, lane by lane.
    #[inline(always)]
    pub(crate) fn max(self, other: Lanes) -> Lanes {
        let mut result = self;
        for lane in 0..LANES {
            result.0[lane] = if self.0[lane] > other.0[lane] { self.0[lane] } else { other.0[lane] };
        }
        result
    }
}

/// Scalar product of two vectors of four.
#[inline(always)]
pub(crate) fn dot(a: &[Lanes; 3], b: &[Lanes; 3]) -> Lanes {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
