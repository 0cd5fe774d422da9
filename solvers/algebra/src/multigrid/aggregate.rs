//! Aggregates of nodes and the modes on them: the piecewise rigid functions of the next level.
//!
//! Source: Vanek, Mandel and Brezina 1996, Computing 56, 179 (algorithm 5.1, and section 3 for several
//! modes).

use rayon::prelude::*;

use super::graph::Graph;
use super::operator::Operator;

/// Marks a node that is in no aggregate.
pub(super) const NONE: u32 = u32::MAX;
/// Number of rigid motions, the block size of the coarse levels.
pub(super) const MODES: usize = 6;
/// Relative length below which a mode counts as dependent: its length after orthogonalisation over its length
/// before.
const DEPENDENT: f64 = 1e-9;

/// Aggregates of nodes: the nodes of the next level.
pub(super) struct Aggregates {
    /// Aggregate of each node.
    pub of: Vec<u32>,
    pub count: usize,
}

/// Forms aggregates in passes over the nodes, in their order. A node founds an aggregate of all its
/// neighbours if none of them is taken. A remaining node joins the aggregate of its most strongly coupled
/// neighbour. Nodes without any neighbour stay out.
pub(super) fn aggregates<const B: usize>(matrix: &Operator<B>, graph: &Graph) -> Aggregates {
    let nodes = graph.nodes();
    let mut of = vec![NONE; nodes];
    let mut count = 0;
    for i in 0..nodes {
        let neighbours = graph.columns(i);
        if neighbours.len() > 1 && neighbours.iter().all(|&j| of[j as usize] == NONE) {
            neighbours.iter().for_each(|&j| of[j as usize] = count);
            count += 1;
        }
    }
    let founded = of;
    let joined = |i: usize| {
        if founded[i] != NONE {
            return founded[i];
        }
        let strongest = graph
            .range(i)
            .map(|k| matrix.at(graph, i, k))
            .filter(|(j, _)| founded[*j] != NONE)
            .map(|(j, block)| (block.iter().flatten().map(|a| a * a).sum::<f32>(), founded[j]))
            .reduce(|best, next| if next.0 > best.0 { next } else { best });
        strongest.map_or(NONE, |(_, aggregate)| aggregate)
    };
    let mut of: Vec<u32> = (0..nodes).into_par_iter().with_min_len(1024).map(joined).collect();
    for i in 0..nodes {
        let neighbours = graph.columns(i);
        if of[i] == NONE && neighbours.len() > 1 {
            neighbours
                .iter()
                .filter(|&&j| of[j as usize] == NONE)
                .copied()
                .collect::<Vec<_>>()
                .into_iter()
                .for_each(|j| of[j as usize] = count);
            count += 1;
        }
    }
    Aggregates { of, count: count as usize }
}

/// Values of the modes at a node: each degree of freedom in each mode.
pub(super) type Modes<const B: usize> = [[f64; MODES]; B];

/// Returns orthonormal functions on each aggregate that span its modes, and the modes in terms of these
/// functions.
pub(super) fn orthonormal<const B: usize>(
    aggregates: &Aggregates,
    modes: &[Modes<B>],
) -> (Vec<Modes<B>>, Vec<Modes<MODES>>) {
    let mut members = vec![Vec::new(); aggregates.count];
    for (node, &aggregate) in aggregates.of.iter().enumerate().filter(|(_, a)| **a != NONE) {
        members[aggregate as usize].push(node);
    }
    let parts: Vec<(Vec<Modes<B>>, Modes<MODES>)> = members
        .par_iter()
        .with_min_len(64)
        .map(|members| {
            let mut functions: Vec<Modes<B>> = members.iter().map(|&i| modes[i]).collect();
            let coarse = gram_schmidt(&mut functions);
            (functions, coarse)
        })
        .collect();
    let mut functions = vec![[[0.0; MODES]; B]; modes.len()];
    let mut coarse = Vec::with_capacity(aggregates.count);
    for (members, (part, modes)) in members.iter().zip(parts) {
        members.iter().zip(part).for_each(|(&i, values)| functions[i] = values);
        coarse.push(modes);
    }
    (functions, coarse)
}

/// Orthonormalises the columns in place, twice because of rounding, and returns `R` of `modes = Q R`. Columns
/// that depend on earlier columns become zero in both.
fn gram_schmidt<const B: usize>(rows: &mut [Modes<B>]) -> Modes<MODES> {
    let inner = |rows: &[Modes<B>], c: usize, d: usize| -> f64 {
        rows.iter().flatten().map(|row| row[c] * row[d]).sum()
    };
    let mut r = [[0.0; MODES]; MODES];
    for c in 0..MODES {
        let before = inner(rows, c, c).sqrt();
        for _ in 0..2 {
            for d in 0..c {
                let part = inner(rows, c, d);
                r[d][c] += part;
                rows.iter_mut().flatten().for_each(|row| row[c] -= part * row[d]);
            }
        }
        let left = inner(rows, c, c).sqrt();
        let keep = left > DEPENDENT * before;
        r[c][c] = if keep { left } else { 0.0 };
        rows.iter_mut().flatten().for_each(|row| row[c] = if keep { row[c] / left } else { 0.0 });
    }
    r
}
