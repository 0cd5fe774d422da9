//! Instruction sets of the lane kernels, chosen once at run time; the only code that queries the processor.
//!
//! A kernel is plain scalar code over arrays of [`LANES`] numbers. [`on_path!`] compiles it once for each
//! instruction set and relies on the compiler's vectorisation. The generated function calls the copy that a
//! [`LanePath`] names.
//!
//! ```
//! use tissuebench_lanes::{LANES, LanePath, madd, on_path};
//!
//! on_path! {
//!     /// `y += a x`.
//!     fn add(a: f64, x: &[f64; LANES], y: &mut [f64; LANES]) = add_lanes
//! }
//! #[inline(always)]
//! fn add_lanes<const FMA: bool>(a: f64, x: &[f64; LANES], y: &mut [f64; LANES]) {
//!     for l in 0..LANES {
//!         y[l] = madd::<FMA>(a, x[l], y[l]);
//!     }
//! }
//! let mut y = [1.0; LANES];
//! add(LanePath::best(), 2.0, &[3.0; LANES], &mut y);
//! assert_eq!(y, [7.0; LANES]);
//! ```

/// Number of lanes in a block: eight f64 fill one AVX-512 register or two of AVX2.
pub const LANES: usize = 8;

/// One number for each lane.
pub type Lanes = [f64; LANES];

/// Returns `a b + c`, fused if the path has the instruction (a fused product is a library call otherwise).
#[inline(always)]
pub fn madd<const FMA: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

/// Returns `a b + c` in single precision; see [`madd`].
#[inline(always)]
pub fn madd_f32<const FMA: bool>(a: f32, b: f32, c: f32) -> f32 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

/// Prefetches the cache lines of a value at any address. The hardware prefetcher stops at the end of a page.
#[inline(always)]
pub fn fetch<T>(at: *const T) {
    #[cfg(target_arch = "x86_64")]
    for line in 0..size_of::<T>().div_ceil(64) {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: a prefetch is only a hint and reads nothing.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(at.cast::<i8>().wrapping_add(64 * line)) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = at;
}

/// Instruction set of the lane kernels.
///
/// On one path the results have the same bits at any number of threads. Another path changes the last bits
/// (fused multiply-add, width of sums), so a record names its path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LanePath(Kind);

/// Kind of a path; only for use by [`on_path!`].
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl LanePath {
    /// The target's baseline instructions, available everywhere.
    pub const PORTABLE: LanePath = LanePath(Kind::Portable);

    /// Returns the widest path of this processor, without allocating.
    pub fn best() -> LanePath {
        #[cfg(target_arch = "x86_64")]
        {
            if has_avx512() {
                return LanePath(Kind::Avx512);
            }
            if has_avx2() {
                return LanePath(Kind::Avx2);
            }
        }
        LanePath::PORTABLE
    }

    /// Returns all paths of this processor, the widest last.
    pub fn available() -> Vec<LanePath> {
        #[allow(unused_mut)]
        let mut paths = vec![LanePath::PORTABLE];
        #[cfg(target_arch = "x86_64")]
        {
            paths.extend(has_avx2().then_some(LanePath(Kind::Avx2)));
            paths.extend(has_avx512().then_some(LanePath(Kind::Avx512)));
        }
        paths
    }

    /// Returns the name for records: `portable`, `avx2` or `avx512`.
    pub fn name(self) -> &'static str {
        match self.0 {
            Kind::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2 => "avx2",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => "avx512",
        }
    }

    /// Returns the kind; only for use by [`on_path!`].
    #[doc(hidden)]
    #[inline]
    pub fn kind(self) -> Kind {
        self.0
    }
}

#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    has_avx2()
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
}

/// Defines `fn $name(path, args)`, which runs `$kernel::<FMA>(args)` compiled for the instructions of `path`.
///
/// For `fn $name<const B: usize; W: [Weight<B>]>` the call is `$kernel::<FMA, B, W>(args)`; constants may be
/// missing, as in `fn $name<; T: [Real]>`. A kernel written
/// as `$kernel::<BITS>` gets the register width after `FMA`: 64, 256 or 512 bits.
#[macro_export]
macro_rules! on_path {
    ($(#[$doc:meta])* $vis:vis fn $name:ident $(<$(const $size:ident: usize),* $(; $($kind:ident: [$($bound:tt)+]),+)?>)? ($($arg:ident: $ty:ty),* $(,)?) $(-> $out:ty)? = $kernel:ident $(::<$bits:ident>)?) => {
        $(#[$doc])*
        $vis fn $name $(<$(const $size: usize,)* $($($kind: $($bound)+,)+)?>)? (path: $crate::LanePath, $($arg: $ty),*) $(-> $out)? {
            match path.kind() {
                $crate::Kind::Portable => {
                    $(const $bits: usize = 64;)?
                    $kernel::<false $(, $bits)? $($(, $size)* $($(, $kind)+)?)?>($($arg),*)
                }
                #[cfg(target_arch = "x86_64")]
                $crate::Kind::Avx2 => {
                    $(const $bits: usize = 256;)?
                    #[target_feature(enable = "avx2,fma")]
                    fn run $(<$(const $size: usize,)* $($($kind: $($bound)+,)+)?>)? ($($arg: $ty),*) $(-> $out)? { $kernel::<true $(, $bits)? $($(, $size)* $($(, $kind)+)?)?>($($arg),*) }
                    // SAFETY: a path of this kind is constructed only if these features were detected.
                    unsafe { run $(::<$($size,)* $($($kind,)+)?>)? ($($arg),*) }
                }
                #[cfg(target_arch = "x86_64")]
                $crate::Kind::Avx512 => {
                    $(const $bits: usize = 512;)?
                    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
                    fn run $(<$(const $size: usize,)* $($($kind: $($bound)+,)+)?>)? ($($arg: $ty),*) $(-> $out)? { $kernel::<true $(, $bits)? $($(, $size)* $($(, $kind)+)?)?>($($arg),*) }
                    // SAFETY: as above.
                    unsafe { run $(::<$($size,)* $($($kind,)+)?>)? ($($arg),*) }
                }
            }
        }
    };
}
