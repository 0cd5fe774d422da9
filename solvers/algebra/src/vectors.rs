//! Operations on long vectors, in parallel.
//!
//! Sums are taken over chunks of fixed length, and the sums of the chunks are added in order. The bits
//! therefore do not depend on the number of threads.

use rayon::prelude::*;
use shape::Vector3;

/// Number of entries in a chunk of a sum.
pub(crate) const CHUNK: usize = 1024;
/// Smallest number of chunks in a task.
const TASK: usize = 8;
/// Smallest number of entries in a task. A vector of less than twice this length stays on one thread:
/// waking another thread takes longer than its half of the work.
pub(crate) const GRAIN: usize = TASK * CHUNK;

/// Adds the sums of chunks in order.
pub(crate) fn sums<const N: usize>(chunks: impl IndexedParallelIterator<Item = [f64; N]>) -> [f64; N] {
    let chunks: Vec<[f64; N]> = chunks.with_min_len(TASK).collect();
    chunks.iter().fold([0.0; N], |sums, chunk| std::array::from_fn(|n| sums[n] + chunk[n]))
}

/// Returns `a . b`.
pub(crate) fn dot(a: &[Vector3], b: &[Vector3]) -> f64 {
    let [sum] = sums(a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK)).map(|(a, b)| [of_chunk(a, b)]));
    sum
}

/// Returns `a . b` of one chunk.
pub(crate) fn of_chunk(a: &[Vector3], b: &[Vector3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

pub(crate) fn norm(x: &[Vector3]) -> f64 {
    dot(x, x).sqrt()
}

/// Returns the largest magnitude of all components.
pub(crate) fn largest(x: &[Vector3]) -> f64 {
    x.par_iter().with_min_len(GRAIN).map(|x| x.amax()).reduce(|| 0.0, f64::max)
}

/// Computes `out = a - b`.
pub(crate) fn subtract(a: &[Vector3], b: &[Vector3], out: &mut [Vector3]) {
    out.par_iter_mut().zip(a.par_iter().zip(b)).with_min_len(GRAIN).for_each(|(out, (a, b))| *out = a - b);
}

/// Returns equal entries, written by all threads: the first use of memory takes as long as its later use.
pub(crate) fn repeated<T: Copy + Send + Sync>(value: T, count: usize) -> Vec<T> {
    rayon::iter::repeat_n(value, count).with_min_len(GRAIN).collect()
}
