//! What faer keeps per thread from one product to the next.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

/// Rows of a product that is not one of faer's small ones.
const ROWS: usize = 64;

/// Has every thread of the pool take the buffers for dense products that faer keeps for good. They are twice the
/// largest cache, of which a product touches what it needs: 0.96 GB of address space on a processor with 480 MB of it.
/// Memory that is counted from here on is that of the work alone; before, the first factorisation was charged for it.
pub fn reserve_workspaces() {
    rayon::broadcast(|_| {
        let ones = Mat::from_fn(ROWS, ROWS, |_, _| 1.0);
        let mut product = Mat::zeros(ROWS, ROWS);
        matmul(&mut product, Accum::Replace, &ones, &ones, 1.0, Par::Seq);
    });
}
