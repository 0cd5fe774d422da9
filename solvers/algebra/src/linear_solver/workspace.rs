//! Workspaces of faer.

use std::mem::MaybeUninit;

use faer::dyn_stack::MemBuffer;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

/// Rows of a product that is too large for faer's small kernels.
const ROWS: usize = 64;

/// Fills a workspace with zeros.
///
/// Vector registers reach beyond the ends of faer's matrices, into memory that other tables have used.
/// Indices left there are denormal if read as numbers, and each costs a processor assist. Without zeros a
/// dense factor of 249 unknowns took 1.8 ms instead of 0.6 ms.
pub(super) fn zeroed(mut memory: MemBuffer) -> MemBuffer {
    memory.fill(MaybeUninit::new(0));
    memory
}

/// Makes every thread of the pool allocate the buffers that faer keeps for dense products.
///
/// The buffers are twice the size of the largest cache, of which a product touches only a part: 0.96 GB of
/// address space on a processor with 480 MB of cache. Memory counted after this call belongs to the
/// computation alone. Without this call the first factorisation was charged for the buffers.
pub fn reserve_workspaces() {
    rayon::broadcast(|_| {
        let ones = Mat::from_fn(ROWS, ROWS, |_, _| 1.0);
        let mut product = Mat::zeros(ROWS, ROWS);
        matmul(&mut product, Accum::Replace, &ones, &ones, 1.0, Par::Seq);
    });
}
