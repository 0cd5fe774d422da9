//! Which instructions the lane kernels run on, chosen once at run time.

/// Lanes of one block: eight f64 fill one AVX-512 register or two of AVX2.
pub(crate) const LANES: usize = 8;

/// Instruction set of the lane kernels. Results have the same bits at any number of threads on one path; another path
/// changes the last bits (fused multiply-add, width of sums), so a record names its path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LanePath(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl LanePath {
    /// No instruction beyond the target's own: everywhere available.
    pub const PORTABLE: LanePath = LanePath(Kind::Portable);

    /// The widest path of this processor.
    pub fn best() -> LanePath {
        LanePath::available().pop().unwrap_or(LanePath::PORTABLE)
    }

    /// All paths of this processor, the widest last.
    pub fn available() -> Vec<LanePath> {
        #[allow(unused_mut)]
        let mut paths = vec![LanePath::PORTABLE];
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                paths.push(LanePath(Kind::Avx2));
                if is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
                {
                    paths.push(LanePath(Kind::Avx512));
                }
            }
        }
        paths
    }

    /// Name for the record: `portable`, `avx2` or `avx512`.
    pub fn name(self) -> &'static str {
        match self.0 {
            Kind::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2 => "avx2",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => "avx512",
        }
    }

    pub(crate) fn kind(self) -> Kind {
        self.0
    }
}

/// Defines `fn $name(path, args)` that runs `$kernel::<FMA>(args)` compiled for the instructions of `path`.
macro_rules! on_path {
    ($(#[$doc:meta])* $vis:vis fn $name:ident($($arg:ident: $ty:ty),* $(,)?) $(-> $out:ty)? = $kernel:ident) => {
        $(#[$doc])*
        $vis fn $name(path: $crate::explicit::path::LanePath, $($arg: $ty),*) $(-> $out)? {
            match path.kind() {
                $crate::explicit::path::Kind::Portable => $kernel::<false>($($arg),*),
                #[cfg(target_arch = "x86_64")]
                $crate::explicit::path::Kind::Avx2 => {
                    #[target_feature(enable = "avx2,fma")]
                    fn run($($arg: $ty),*) $(-> $out)? { $kernel::<true>($($arg),*) }
                    // SAFETY: a path of this kind is made only where these features were detected.
                    unsafe { run($($arg),*) }
                }
                #[cfg(target_arch = "x86_64")]
                $crate::explicit::path::Kind::Avx512 => {
                    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
                    fn run($($arg: $ty),*) $(-> $out)? { $kernel::<true>($($arg),*) }
                    // SAFETY: as above.
                    unsafe { run($($arg),*) }
                }
            }
        }
    };
}
pub(crate) use on_path;
