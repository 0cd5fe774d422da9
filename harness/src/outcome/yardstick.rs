//! The same piece of work before and after every pass, timed like a phase: how fast the machine was at that moment.
//!
//! On a machine with other work to do a core is slower by several percent from one minute to the next, by clock and by caches
//! that it shares. Times of two runs are told from that by the ratio of their yardsticks (`tissuebench compare`).

use std::hint::black_box;
use std::sync::LazyLock;

/// Name of its phase.
pub(crate) const PHASE: &str = "yardstick";

/// Rows of a sparse matrix, and entries in each: 0.8 MB with their columns, as much as a second cache holds.
const ROWS: usize = 4096;
const EACH: usize = 16;
/// Rows and columns of a dense matrix.
const DENSE: usize = 48;

struct Work {
    columns: Vec<u32>,
    values: Vec<f64>,
    dense: Vec<f64>,
}

static WORK: LazyLock<Work> = LazyLock::new(|| {
    // Weyl's sequence: spread evenly, the same everywhere.
    let spread = |k: usize| (k as f64 * 0.618_033_988_749_895).fract();
    let columns = (0..ROWS * EACH).map(|k| (spread(k) * ROWS as f64) as u32).collect();
    let values = (0..ROWS * EACH).map(|k| spread(k + 1) - 0.5).collect();
    let dense = (0..DENSE * DENSE).map(|k| spread(k + 2) - 0.5).collect();
    Work { columns, values, dense }
});

/// A sparse matrix times a vector, as solvers and transfers do, and a dense product, as factors do: a fifth of a millisecond.
pub(crate) fn yardstick() {
    let Work { columns, values, dense } = &*WORK;
    let x = black_box(vec![1.0; ROWS]);
    let row = |(columns, values): (&[u32], &[f64])| -> f64 {
        columns.iter().zip(values).map(|(&c, v)| v * x[c as usize]).sum()
    };
    let y: Vec<f64> = columns.chunks(EACH).zip(values.chunks(EACH)).map(row).collect();
    let mut product = vec![0.0; DENSE * DENSE];
    for (i, row) in product.chunks_mut(DENSE).enumerate() {
        for k in 0..DENSE {
            let a = dense[i * DENSE + k];
            row.iter_mut().zip(&dense[k * DENSE..]).for_each(|(p, b)| *p += a * b);
        }
    }
    black_box((y, product));
}
