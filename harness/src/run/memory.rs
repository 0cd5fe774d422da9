//! Global allocator of the process. It tracks peak memory and requests huge pages for large blocks.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

#[global_allocator]
static ALLOCATOR: Counted = Counted { now: AtomicUsize::new(0), peak: AtomicUsize::new(0) };

/// System allocator with counters of the current and the peak size, bytes.
///
/// Zeroed allocation and growth are left to the system: fresh pages are already zero, and the pages of a
/// growing block are remapped, not copied. With `peak_alloc`, which writes zeros and copies, and before huge
/// pages were requested, 985,527 unknowns took 3.3 s (hex8), 2.4 s (tet4) and 2.5 s (tet10) instead of 2.6,
/// 2.2 and 2.3 s.
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
