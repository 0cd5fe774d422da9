//! Peak of allocated memory, by counting what passes through the allocator.

use peak_alloc::PeakAlloc;

/// The process's allocator, with a count on it: a relaxed add per allocation.
#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// What is allocated now.
pub struct Baseline(usize);

impl Baseline {
    /// Forgets the peak so far, and what the libraries keep for good.
    #[allow(clippy::new_without_default)] // it is taken at a moment
    pub fn new() -> Baseline {
        algebra::reserve_workspaces();
        ALLOCATOR.reset_peak_usage();
        Baseline(ALLOCATOR.current_usage())
    }

    /// The largest amount allocated at once since then beyond what was there, bytes.
    pub fn peak(&self) -> u64 {
        ALLOCATOR.peak_usage().saturating_sub(self.0) as u64
    }
}
