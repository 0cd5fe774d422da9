#![allow(non_snake_case)] // G as in the formulas
//! Least squares with few nonnegative weights.

use nalgebra::{DMatrix, DVector};

/// Part of the first gradient below which no further column helps.
const FLAT: f64 = 1e-12;

/// Finds weights `w >= 0`, most of them zero, with `|G w - b| <= tolerance |b|`. Columns are taken one by
/// one, the one along which the square error falls fastest first, until the tolerance is reached, `most`
/// weights are positive, or no column helps. Returns the positive weights with the numbers of their columns,
/// ascending, and the relative error.
///
/// Source: Lawson and Hanson, Solving Least Squares Problems (1974), ch. 23; stopped early as by Farhat et
/// al., Int. J. Numer. Meth. Engng 98 (2014), 625-662.
pub fn nonnegative_weights(
    columns: &[Vec<f64>],
    b: &[f64],
    tolerance: f64,
    most: usize,
) -> (Vec<(usize, f64)>, f64) {
    let size = norm(b);
    let mut active = Active { columns, b, taken: Vec::new(), weights: Vec::new(), products: Vec::new() };
    let mut closed = vec![false; columns.len()];
    let (mut residual, mut first) = (b.to_vec(), None);
    while norm(&residual) > tolerance * size && active.taken.len() < most {
        let gradients = columns.iter().map(|column| dot(column, &residual)).enumerate();
        let steepest = gradients.filter(|(k, _)| !closed[*k]).max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((at, gradient)) = steepest else { break };
        if gradient <= FLAT * *first.get_or_insert(gradient) {
            break;
        }
        // Dropped columns may return, unless rounding alone made the gradient of a column positive.
        closed[at] = true;
        for dropped in active.take(at).into_iter().filter(|dropped| *dropped != at) {
            closed[dropped] = false;
        }
        residual = active.residual();
    }
    let mut found: Vec<(usize, f64)> = active.taken.into_iter().zip(active.weights).collect();
    found.sort_by_key(|(column, _)| *column);
    (found, if size > 0.0 { norm(&residual) / size } else { 0.0 })
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

/// Columns with a positive weight.
struct Active<'a> {
    columns: &'a [Vec<f64>],
    b: &'a [f64],
    taken: Vec<usize>,
    weights: Vec<f64>,
    /// Products of each taken column with those before it and with itself.
    products: Vec<Vec<f64>>,
}

impl Active<'_> {
    /// Takes a column and solves for the weights of all taken ones. Columns whose weight would be negative
    /// are dropped and returned.
    fn take(&mut self, column: usize) -> Vec<usize> {
        self.taken.push(column);
        self.weights.push(0.0);
        let new = &self.columns[column];
        self.products.push(self.taken.iter().map(|&other| dot(&self.columns[other], new)).collect());
        let mut dropped = Vec::new();
        loop {
            let Some(wanted) = self.unbounded() else {
                // The column depends on the others.
                dropped.push(self.drop(self.taken.len() - 1));
                return dropped;
            };
            let negative = |place: &usize| wanted[*place] <= 0.0;
            // Part of the way to the wanted weights at which a weight becomes zero.
            let part = |place: usize| self.weights[place] / (self.weights[place] - wanted[place]);
            let places = (0..wanted.len()).filter(negative);
            let Some(least) = places.min_by(|&a, &b| part(a).total_cmp(&part(b))) else {
                self.weights = wanted;
                return dropped;
            };
            let part = part(least);
            self.weights.iter_mut().zip(&wanted).for_each(|(now, wanted)| *now += part * (wanted - *now));
            dropped.push(self.drop(least));
        }
    }

    /// Drops the column at a place and returns it.
    fn drop(&mut self, place: usize) -> usize {
        self.weights.remove(place);
        self.products.remove(place);
        for row in &mut self.products[place..] {
            row.remove(place);
        }
        self.taken.remove(place)
    }

    /// Solves for the weights of the taken columns without bounds; `None` if they depend on each other.
    fn unbounded(&self) -> Option<Vec<f64>> {
        let count = self.taken.len();
        let G = DMatrix::from_fn(count, count, |i, j| self.products[i.max(j)][i.min(j)]);
        let right = DVector::from_fn(count, |i, _| dot(&self.columns[self.taken[i]], self.b));
        Some(G.cholesky()?.solve(&right).as_slice().to_vec())
    }

    fn residual(&self) -> Vec<f64> {
        let mut residual = self.b.to_vec();
        for (column, weight) in self.taken.iter().zip(&self.weights) {
            residual.iter_mut().zip(&self.columns[*column]).for_each(|(r, g)| *r -= weight * g);
        }
        residual
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pseudo-random columns with entries between -0.5 and 0.5.
    fn columns(count: usize, rows: usize) -> Vec<Vec<f64>> {
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        (0..count).map(|_| (0..rows).map(|_| next()).collect()).collect()
    }

    #[test]
    fn a_sparse_sum_is_found() {
        let columns = columns(60, 100);
        let known = [(3, 2.0), (17, 0.5), (41, 7.0)];
        let mut b = vec![0.0; 100];
        for (k, weight) in known {
            b.iter_mut().zip(&columns[k]).for_each(|(b, c)| *b += weight * c);
        }
        let (found, error) = nonnegative_weights(&columns, &b, 1e-12, 60);
        assert!(error <= 1e-12, "{error:e}");
        for k in 0..60 {
            let of = |list: &[(usize, f64)]| list.iter().find(|(at, _)| *at == k).map_or(0.0, |(_, w)| *w);
            assert!((of(&found) - of(&known)).abs() < 1e-10, "{k}: {} for {}", of(&found), of(&known));
        }
    }

    /// The conditions of Karush, Kuhn and Tucker: gradients vanish where weights are positive and point to
    /// negative weights elsewhere.
    #[test]
    fn no_weight_is_negative_and_none_lowers_the_error() {
        let columns = columns(40, 25);
        let b: Vec<f64> = (0..25).map(|i| f64::from(i).sin()).collect();
        let (found, error) = nonnegative_weights(&columns, &b, 0.0, 40);
        assert!(found.iter().all(|(_, weight)| *weight > 0.0) && found.len() > 3 && error < 1.0);
        let mut residual = b.clone();
        for (k, weight) in &found {
            residual.iter_mut().zip(&columns[*k]).for_each(|(r, c)| *r -= weight * c);
        }
        assert!((norm(&residual) / norm(&b) - error).abs() < 1e-12);
        for (k, column) in columns.iter().enumerate() {
            let gradient = dot(column, &residual);
            let taken = found.iter().any(|(at, _)| *at == k);
            assert!(gradient < 1e-9 && (!taken || gradient > -1e-9), "{k}: {gradient:e}, {taken}");
        }
    }

    #[test]
    fn it_ends_at_the_tolerance_or_at_the_number_asked() {
        let columns = columns(40, 25);
        let b: Vec<f64> = (0..25).map(|i| columns[..10].iter().map(|c| c[i]).sum()).collect();
        let (few, error) = nonnegative_weights(&columns, &b, 0.0, 4);
        assert!(few.len() == 4 && error > 0.1, "{few:?} {error}");
        let (found, error) = nonnegative_weights(&columns, &b, 0.1, 40);
        assert!(found.len() < 11 && error <= 0.1, "{found:?} {error}");
        assert_eq!(nonnegative_weights(&columns, &[0.0; 25], 0.1, 40), (Vec::new(), 0.0));
    }
}
