//! The process's allocator: the peak of what passes through it is counted, and large blocks get large pages.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

#[global_allocator]
static ALLOCATOR: Counted = Counted { now: AtomicUsize::new(0), peak: AtomicUsize::new(0) };

/// The system's allocator, with a count on it, bytes.
///
/// Zeros and growth are the system's own: fresh pages are zero already, and those of a block that grows are mapped anew, not copied.
/// With `peak_alloc`, which writes zeros and copies, and so before large pages are asked for, 985,527 unknowns take 3.3 s (hex8), 2.4 (tet4)
/// and 2.5 (tet10), not 2.6, 2.2 and 2.3.
///
/// Linux gives most systems' programs large pages only where they ask. A solver fills tens of megabytes once and reads them in no
/// order: 107,811 unknowns of hex8 take 7 % less time with them, of tet10 4 %.
struct Counted {
    now: AtomicUsize,
    peak: AtomicUsize,
}

impl Counted {
    fn add(&self, size: usize) {
        let now = self.now.fetch_add(size, Relaxed) + size;
        // A load is cheaper than a maximum, which takes the cache line for itself.
        if now > self.peak.load(Relaxed) {
            self.peak.fetch_max(now, Relaxed);
        }
    }

    /// A new block, if there is one, counted and advised.
    fn taken(&self, block: *mut u8, size: usize) -> *mut u8 {
        if !block.is_null() {
            self.add(size);
            ask_for_large_pages(block, size);
        }
        block
    }
}

/// Smaller blocks are as they are: the quick study, whose blocks are 4 to 8 MB, takes as long with large pages as without.
const LARGE: usize = 16 << 20;

// SAFETY: blocks are the system's.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller's.
        self.taken(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller's.
        self.taken(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as the caller's.
        let block = unsafe { System.realloc(block, layout, size) };
        if !block.is_null() {
            self.now.fetch_sub(layout.size(), Relaxed);
        }
        self.taken(block, size)
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: as the caller's.
        unsafe { System.dealloc(block, layout) };
        self.now.fetch_sub(layout.size(), Relaxed);
    }
}

/// An advice: without it, or where it is refused, the pages are small.
#[cfg(target_os = "linux")]
fn ask_for_large_pages(block: *mut u8, size: usize) {
    use rustix::mm::{Advice, madvise};
    if size < LARGE {
        return;
    }
    let page = rustix::param::page_size();
    let skip = block.align_offset(page);
    // SAFETY: whole pages within the block, whose contents an advice does not change.
    let _ = unsafe { madvise(block.add(skip).cast(), (size - skip) / page * page, Advice::LinuxHugepage) };
}

#[cfg(not(target_os = "linux"))]
fn ask_for_large_pages(_: *mut u8, _: usize) {}

/// What is allocated now.
pub struct Baseline(usize);

impl Baseline {
    /// Forgets the peak so far, and what the libraries keep for good.
    #[allow(clippy::new_without_default)] // it is taken at a moment
    pub fn new() -> Baseline {
        algebra::reserve_workspaces();
        let now = ALLOCATOR.now.load(Relaxed);
        ALLOCATOR.peak.store(now, Relaxed);
        Baseline(now)
    }

    /// The largest amount allocated at once since then beyond what was there, bytes.
    pub fn peak(&self) -> u64 {
        ALLOCATOR.peak.load(Relaxed).saturating_sub(self.0) as u64
    }
}
