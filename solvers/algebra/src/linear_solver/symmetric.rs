//! Symmetric matrices in the form that factorisations take: the upper triangle, column by column.

use crate::stiffness::Stiffness;

/// Static regularisation of a saddle matrix, added to or subtracted from the diagonal, relative to its
/// largest entry.
const REGULARISATION: f64 = 1e-9;

/// Known definiteness of a matrix, which selects the factorisation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Positive definite: `L L^T`.
    Definite,
    /// Unknowns from [`Symmetric::multipliers`] on have a zero or negative block: `L D L^T`, statically
    /// regularised.
    Saddle,
    /// Symmetric, of unknown definiteness (a tangent past a limit point): `L D L^T` without regularisation;
    /// the residual check decides.
    Indefinite,
}

/// A symmetric matrix: its upper triangle by columns, rows ascending, the diagonal entry always present.
/// Unknowns from `multipliers` on are Lagrange multipliers or pressures (zero or negative diagonal block).
#[derive(Clone)]
pub struct Symmetric {
    /// Start of each column in `rows` and `values`; columns + 1 entries.
    pub offsets: Vec<usize>,
    /// Row of each entry.
    pub rows: Vec<usize>,
    /// The entries.
    pub values: Vec<f64>,
    /// First unknown that is a multiplier or a pressure; the number of unknowns if there is none.
    pub multipliers: usize,
    /// First unknown of each vertex of the graph (a node or a multiplier), followed by the number of
    /// unknowns.
    pub vertices: Vec<usize>,
}

impl Symmetric {
    /// Number of unknowns.
    #[inline]
    pub fn dim(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Returns [`Kind::Definite`] without multipliers, [`Kind::Saddle`] with them.
    pub fn kind(&self) -> Kind {
        if self.multipliers < self.dim() { Kind::Saddle } else { Kind::Definite }
    }

    /// Extracts the free part of a stiffness. `place` maps each degree of freedom to its unknown
    /// (`usize::MAX` if constrained); `free` is the number of unknowns.
    pub fn displacements(stiffness: &Stiffness, place: &[usize], free: usize) -> Symmetric {
        let capacity = 9 * stiffness.pattern().block_count();
        let mut m = Symmetric {
            offsets: vec![0],
            rows: Vec::with_capacity(capacity),
            values: Vec::with_capacity(capacity),
            multipliers: free,
            vertices: vec![0],
        };
        for i in 0..place.len() / 3 {
            let (columns, blocks) = stiffness.row(i);
            for a in (0..3).filter(|a| place[3 * i + a] != usize::MAX) {
                for (&j, block) in columns.iter().zip(blocks) {
                    let j = j as usize;
                    for b in 0..3 {
                        let at = place[3 * j + b];
                        if at != usize::MAX && (j < i || b <= a) {
                            m.rows.push(at);
                            m.values.push(block[(a, b)]);
                        }
                    }
                }
                m.offsets.push(m.rows.len());
            }
            if *m.vertices.last().expect("starts with 0") < m.offsets.len() - 1 {
                m.vertices.push(m.offsets.len() - 1);
            }
        }
        m
    }

    /// Returns `A + factor B` of two matrices over the same unknowns, whose patterns may differ.
    pub(super) fn plus(&self, other: &Symmetric, factor: f64) -> Symmetric {
        let (mut offsets, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for j in 0..self.dim() {
            let column =
                |m: &Symmetric| (m.offsets[j]..m.offsets[j + 1]).map(|k| (m.rows[k], m.values[k])).collect();
            let [a, b]: [Vec<(usize, f64)>; 2] = [column(self), column(other)];
            let (mut a, mut b) = (a.into_iter().peekable(), b.into_iter().peekable());
            while let Some(row) = [a.peek(), b.peek()].into_iter().flatten().map(|e| e.0).min() {
                let of = |e: &(usize, f64)| e.0 == row;
                rows.push(row);
                values.push(a.next_if(of).map_or(0.0, |e| e.1) + factor * b.next_if(of).map_or(0.0, |e| e.1));
            }
            offsets.push(rows.len());
        }
        Symmetric { offsets, rows, values, multipliers: self.multipliers, vertices: self.vertices.clone() }
    }

    /// Sets each diagonal entry to `1 + shift` times its unshifted value in `diagonal`. The entries of the
    /// multipliers stay as they are.
    pub fn shift(&mut self, diagonal: &[f64], shift: f64) {
        for (j, d) in diagonal.iter().enumerate().take(self.multipliers) {
            self.values[self.offsets[j + 1] - 1] = d * (1.0 + shift);
        }
    }

    /// Computes `y -= A x`. The three columns of a node have the same rows outside the node and are
    /// multiplied together. The order of summation, and so every bit, is that of the separate columns.
    pub fn subtract_product(&self, x: &[f64], y: &mut [f64]) {
        for vertex in self.vertices.windows(2) {
            let (first, end) = (vertex[0], vertex[1]);
            let mut sums = [0.0; 3];
            let common = self.offsets[first + 1] - self.offsets[first] - 1;
            let in_common = match end - first {
                3 => {
                    let starts = [self.offsets[first], self.offsets[first + 1], self.offsets[first + 2]];
                    let of = x[first..end].try_into().expect("three columns");
                    sums = self.subtract_three(starts, common, of, x, y);
                    common
                }
                _ => 0,
            };
            for j in first..end {
                let mut sum = if in_common > 0 { sums[j - first] } else { 0.0 };
                for k in self.offsets[j] + in_common..self.offsets[j + 1] {
                    let (i, a) = (self.rows[k], self.values[k]);
                    sum += a * x[i];
                    if i != j {
                        y[i] -= a * x[j];
                    }
                }
                y[j] -= sum;
            }
        }
    }

    /// Multiplies the `common` entries of three columns, which begin at `starts`. `of` are the entries of x
    /// in the columns' own rows. Returns the sums of the columns.
    #[inline]
    fn subtract_three(
        &self,
        starts: [usize; 3],
        common: usize,
        of: [f64; 3],
        x: &[f64],
        y: &mut [f64],
    ) -> [f64; 3] {
        let column = |k: usize| &self.values[starts[k]..starts[k] + common];
        let (a, b, c) = (column(0), column(1), column(2));
        let mut sums = [0.0; 3];
        for (k, &i) in self.rows[starts[0]..starts[0] + common].iter().enumerate() {
            let xi = x[i];
            sums[0] += a[k] * xi;
            sums[1] += b[k] * xi;
            sums[2] += c[k] * xi;
            y[i] = y[i] - a[k] * of[0] - b[k] * of[1] - c[k] * of[2];
        }
        sums
    }

    /// The diagonal entry of column `j`.
    #[inline]
    pub fn diagonal(&self, j: usize) -> f64 {
        // Rows ascend in the upper triangle, so the diagonal entry is the last entry of a column.
        self.values[self.offsets[j + 1] - 1]
    }

    /// Returns the values with static regularisation, which makes a saddle matrix quasi-definite: it then has
    /// an `L D L^T` in any order (Vanderbei 1995).
    pub(super) fn regularised(&self) -> Vec<f64> {
        let largest = self.values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let mut values = self.values.clone();
        for j in 0..self.dim() {
            let shift = REGULARISATION * largest;
            values[self.offsets[j + 1] - 1] += if j < self.multipliers { shift } else { -shift };
        }
        values
    }
}
