//! Buffers that faer keeps per thread from one product to the next.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

/// Rows of a product that is too large for faer's small kernels.
const ROWS: usize = 64;

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
