//! Peak of allocated memory, by counting what passes through the allocator.

use peak_alloc::PeakAlloc;

/// The process's allocator, with a count on it: a relaxed add per allocation.
#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Forgets the peak so far.
pub fn reset_peak() {
    ALLOCATOR.reset_peak_usage();
}

/// The largest amount allocated at once since the last reset, bytes.
pub fn peak() -> u64 {
    ALLOCATOR.peak_usage() as u64
}
