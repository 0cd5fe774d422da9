#![allow(non_snake_case)] // G and K as in the formulas
//! The stiffness of a linear body.

use std::ops::Range;

use algebra::{Incidence, Stiffness};
use lanes::LanePath;
use shape::Matrix3;

use crate::grad_table::{GradTable, Pair, gather};

/// Number of gradients of the bundles that the rows of a task traverse together: 256 KB, which stay in the
/// second-level cache for all rows.
const TILE: usize = 4096;

/// Adds `integral of lambda div v div u + 2 mu eps(v) : eps(u)` to the stiffness.
///
/// With `g = grad N` the block of nodes i, j is
/// `K_ij = sum_q w (lambda g_i g_j^T + mu g_j g_i^T + mu (g_i . g_j) I)`. The moduli are constant over many
/// points. The inner loop therefore sums only `G_ij = sum_q w g_i g_j^T`, and
/// `K_ij += lambda G + mu G^T + mu tr(G) I` is formed once per law. This takes a third of the arithmetic.
pub(crate) fn add_volume(stiffness: &mut Stiffness, table: &GradTable, incidence: &Incidence) {
    let laws: Vec<Range<usize>> = table.laws().iter().map(|law| law.0.clone()).collect();
    let path = LanePath::best();
    let gather =
        |seen: &[(u32, u32)], slot: &[u32], sums: &mut [[Pair; 3]]| gather(path, table, seen, slot, sums);
    stiffness.by_tiles(
        incidence,
        &laws,
        table.bundles_of(TILE),
        [[0.0; 8]; 3],
        gather,
        |law, _, _, sums, row| {
            flush(sums, row, table.laws()[law].1);
        },
    );
}

/// Adds `lambda G + mu G^T + mu tr(G) I` to a whole row of `K` and resets the sums to zero.
fn flush(sums: &mut [[Pair; 3]], row: &mut [Matrix3], (lambda, mu): (f64, f64)) {
    for (K, s) in row.iter_mut().zip(sums) {
        let G = Matrix3::from_fn(|a, b| s[a][b] + s[a][4 + b]);
        *K += G * lambda + G.transpose() * mu + Matrix3::identity() * (mu * G.trace());
        *s = [[0.0; 8]; 3];
    }
}
