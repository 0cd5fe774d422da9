//! Global allocator of the process. It tracks peak memory, requests huge pages for large blocks, and lets the
//! process keep freed memory.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

#[global_allocator]
static ALLOCATOR: Counted = Counted { now: AtomicUsize::new(0), peak: AtomicUsize::new(0) };

/// System allocator with counters of the current and the peak size, bytes.
///
/// Zeroed allocation and growth are left to the system, which knows which pages are already zero. With
/// `peak_alloc`, which writes zeros and copies, and before huge pages were requested, 985,527 unknowns took
/// 3.3 s (hex8), 2.4 s (tet4) and 2.5 s (tet10) instead of 2.6, 2.2 and 2.3 s.
///
/// Most Linux systems give a program huge pages only on request. A solver fills tens of megabytes once and
/// reads them in no particular order: with huge pages, 107,811 unknowns take 7 % less time with hex8 and 4 %
/// less with tet10.
struct Counted {
    now: AtomicUsize,
    peak: AtomicUsize,
}

impl Counted {
    fn add(&self, size: usize) {
        let now = self.now.fetch_add(size, Relaxed) + size;
        // A load is cheaper than `fetch_max`, which takes exclusive ownership of the cache line.
        if now > self.peak.load(Relaxed) {
            self.peak.fetch_max(now, Relaxed);
        }
    }

    /// Counts a new block, requests huge pages for it and returns it. A null pointer passes through.
    fn taken(&self, block: *mut u8, size: usize) -> *mut u8 {
        if !block.is_null() {
            self.add(size);
            ask_for_large_pages(block, size);
        }
        block
    }
}

/// Smallest block for which huge pages are requested, bytes. The quick study, whose blocks are 4 to 8 MB,
/// takes as long with huge pages as without.
#[cfg(target_os = "linux")]
const LARGE: usize = 16 << 20;

// SAFETY: every block is allocated, resized and freed by `System`; the counters do not touch it.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller upholds the contract of the same method.
        self.taken(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller upholds the contract of the same method.
        self.taken(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller upholds the contract of the same method.
        let block = unsafe { System.realloc(block, layout, size) };
        if !block.is_null() {
            self.now.fetch_sub(layout.size(), Relaxed);
        }
        self.taken(block, size)
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: the caller upholds the contract of the same method.
        unsafe { System.dealloc(block, layout) };
        self.now.fetch_sub(layout.size(), Relaxed);
    }
}

/// Advises the system to use huge pages for a large block. If the advice is refused, the pages stay small.
#[cfg(target_os = "linux")]
fn ask_for_large_pages(block: *mut u8, size: usize) {
    use rustix::mm::{Advice, madvise};
    if size < LARGE {
        return;
    }
    let page = rustix::param::page_size();
    let skip = block.align_offset(page);
    // SAFETY: the range consists of whole pages within the block, and the advice does not change their
    // contents.
    let _ = unsafe { madvise(block.add(skip).cast(), (size - skip) / page * page, Advice::LinuxHugepage) };
}

#[cfg(not(target_os = "linux"))]
fn ask_for_large_pages(_: *mut u8, _: usize) {}

/// Lets this process keep the memory that it frees, until `return_freed_memory`. By default, glibc returns
/// every large block to the system, which clears each page again before its next use. For 985,527 unknowns
/// with tet4 the system then cleared 3.43 GB instead of 1.35 GB, in 1.5 to 2.8 s of CPU time instead of 0.5
/// to 1.3 s.
///
/// One heap serves all threads, because a heap of a single thread is limited to 64 MB. The mimalloc allocator
/// cleared 3.8 GB.
pub fn keep_freed_memory() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    for (setting, value) in
        [(libc::M_ARENA_MAX, 1), (libc::M_MMAP_MAX, 0), (libc::M_TRIM_THRESHOLD, libc::c_int::MAX)]
    {
        // SAFETY: `mallopt` changes settings of the allocator under its own lock. A refused setting keeps its
        // default.
        unsafe { libc::mallopt(setting, value) };
    }
}

/// Returns freed memory to the system if there is much of it, so that the process memory of a run does not
/// include memory that only an earlier run used.
pub(super) fn return_freed_memory() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        let now = ALLOCATOR.now.load(Relaxed);
        if ALLOCATOR.peak.load(Relaxed).saturating_sub(now) > LARGE {
            // SAFETY: `malloc_trim` returns only whole pages of free blocks, under the allocator's own lock.
            unsafe { libc::malloc_trim(0) };
        }
    }
}

/// Memory allocated at the start of a measurement, bytes.
pub struct Baseline(usize);

impl Baseline {
    /// Starts a measurement at the current allocation. The buffers that the linear algebra keeps for good are
    /// allocated first, so that they do not count.
    #[allow(clippy::new_without_default)] // it is taken at a moment
    pub fn new() -> Baseline {
        algebra::reserve_workspaces();
        let now = ALLOCATOR.now.load(Relaxed);
        ALLOCATOR.peak.store(now, Relaxed);
        Baseline(now)
    }

    /// Peak memory allocated since the start beyond the baseline, bytes.
    pub fn peak(&self) -> u64 {
        ALLOCATOR.peak.load(Relaxed).saturating_sub(self.0) as u64
    }
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[cfg(test)]
mod tests {
    use super::*;

    /// Pages that this thread touched for the first time.
    fn faults() -> i64 {
        // SAFETY: the structure is plain numbers, which the call fills.
        let mut usage = unsafe { std::mem::zeroed::<libc::rusage>() };
        // SAFETY: the pointer is valid for the call.
        assert_eq!(unsafe { libc::getrusage(libc::RUSAGE_THREAD, &raw mut usage) }, 0);
        usage.ru_minflt
    }

    #[test]
    fn memory_that_was_freed_is_used_again_without_new_pages() {
        keep_freed_memory();
        // glibc returns larger blocks than 32 MB whenever they are freed. A heap of a thread holds 64 MB.
        let touch = || {
            let before = faults();
            drop(std::hint::black_box(vec![1_u8; 48 << 20]));
            faults() - before
        };
        touch();
        assert!(touch() < 8);
    }
}
