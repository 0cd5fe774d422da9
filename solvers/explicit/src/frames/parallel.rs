//! Loops over items that do not depend on each other.

use rayon::prelude::*;

/// Sets each item to a function of its number, in tasks of at least `chunk` items. Few items are not handed
/// to other threads, which would cost more than the items.
pub(super) fn fill<T: Send>(items: &mut [T], chunk: usize, of: impl Fn(usize) -> T + Sync) {
    if items.len() < 2 * chunk {
        items.iter_mut().enumerate().for_each(|(k, item)| *item = of(k));
    } else {
        items.par_iter_mut().enumerate().with_min_len(chunk).for_each(|(k, item)| *item = of(k));
    }
}
