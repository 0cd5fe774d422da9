//! Kernels (weight functions) of moving least squares: radial, with compact support, one at the centre.
//!
//! Each kernel is a file with its function and its [`Entry`], and a line in the list below. Parameters
//! are checked when a kernel is built, so every [`Kernel`] is valid.

mod weight;

use catalogue::{Build, Entry, Values};

use self::weight::Weight;

/// A kernel that scene files can name.
pub type KernelEntry = Entry<Build<Kernel>>;

/// Declares the files of the kernels, the enum that dispatches to them without a call through a pointer, and
/// the slice of their entries.
macro_rules! kernels {
    ($($file:ident::$kernel:ident,)*) => {
        $(
            mod $file;
            pub use $file::$kernel;
            impl From<$kernel> for Kernel {
                fn from(kernel: $kernel) -> Kernel {
                    Kernel::$kernel(kernel)
                }
            }
        )*

        /// A weight function `w(q)` of the relative distance `q = d / R`, with the distance `d` from the node
        /// and the support radius `R`. The weight is zero for `q >= 1` and one at `q = 0`.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(missing_docs)] // each is its type
        pub enum Kernel {
            $($kernel($kernel),)*
        }

        /// Entries of all kernels, in the order of tables.
        pub static KERNELS: &[KernelEntry] =
            &[$($file::ENTRY.built_by(|values| Ok(($file::ENTRY.build)(values)?.into()))),*];

        impl Kernel {
            /// Returns the name used in scene files and tables.
            pub fn name(self) -> &'static str {
                match self {
                    $(Kernel::$kernel(_) => $file::ENTRY.name,)*
                }
            }

            /// Returns value and derivative `(w, dw/dq)` at the relative distance `q >= 0`.
            #[inline]
            pub fn eval(self, q: f64) -> (f64, f64) {
                if q >= 1.0 {
                    return (0.0, 0.0);
                }
                match self {
                    $(Kernel::$kernel(kernel) => kernel.weight()(q),)*
                }
            }

            /// Evaluates [`Kernel::eval`] over a list with all `q < 1`, with one branch on the kind per list
            /// instead of per node.
            #[inline(always)]
            pub(crate) fn eval_all(self, q: &[f64], w: &mut [f64], dw: &mut [f64]) {
                match self {
                    $(Kernel::$kernel(kernel) => each(q, w, dw, kernel.weight()),)*
                }
            }
        }
    };
}

kernels! {
    cubic_spline::CubicSpline,
    quartic_spline::QuarticSpline,
    gaussian::Gaussian,
    exponential::Exponential,
    wendland_c2::WendlandC2,
    wendland_c4::WendlandC4,
    wendland_c6::WendlandC6,
    regularised_interpolating::RegularisedInterpolating,
}

impl Kernel {
    /// Returns every kernel with its default parameters, in the order of tables.
    pub fn all() -> impl Iterator<Item = Kernel> {
        // No parameter of a kernel is required.
        KERNELS.iter().filter_map(|entry| (entry.build)(&Values::new(entry.parameters)).ok())
    }

    /// Returns the kernel with this name and default parameters, or `None` for an unknown name.
    pub fn from_name(name: &str) -> Option<Kernel> {
        Kernel::all().find(|kernel| kernel.name() == name)
    }
}

#[inline(always)]
fn each(q: &[f64], w: &mut [f64], dw: &mut [f64], kernel: impl Fn(f64) -> (f64, f64)) {
    for ((&q, w), dw) in q.iter().zip(w).zip(dw) {
        (*w, *dw) = kernel(q);
    }
}
