//! Exact elimination of constraint rows: every independent row expresses one of its parameters by the others.
//!
//! Rows `C u = g` that share parameters form a block. Gauss-Jordan elimination with complete pivoting brings
//! the block to `u_p = E g - W u_o` with the pivots `p` and the other parameters `o`. A dependent row is
//! reduced to rounding; it is dropped and counted. Complete pivoting takes the parameter with the largest
//! remaining coefficient. For rows at the nodes of a cloud this is the node's own parameter, and the entries
//! of `W` stay of order one.

use crate::constraint::Row;
use crate::error::SolveError;

/// Remainder of a row, relative to its largest coefficient, below which the row counts as dependent on the
/// others. Exact repetitions leave 1e-16; no row of the committed scenes falls below this limit.
const DEPENDENT: f64 = 1e-8;

/// Rows that share parameters, solved for as many parameters as there are independent rows.
pub(crate) struct Block {
    /// Indices of the independent rows among all rows.
    pub rows: Vec<usize>,
    /// Degree of freedom that each independent row eliminates.
    pub pivots: Vec<usize>,
    /// The other degrees of freedom of the rows.
    pub others: Vec<usize>,
    /// Matrix `W` of `u_p = E g - W u_o`, (pivots, others), row by row.
    pub weights: Vec<f64>,
    /// Matrix `E` of `u_p = E g - W u_o`, (pivots, rows), row by row. It maps the right sides `g` of the
    /// constraint rows to the pivots; its transpose maps the forces on the pivots to the multipliers.
    pub inverse: Vec<f64>,
}

/// Returns the blocks of all rows, whose terms must be free degrees of freedom, and the number of dependent
/// rows.
pub(crate) fn blocks(rows: &[Row], dofs: usize) -> Result<(Vec<Block>, usize), SolveError> {
    let mut blocks = Vec::new();
    let mut dropped = 0;
    let largest = rows.iter().map(|row| row.value.abs()).fold(0.0, f64::max);
    for members in connected(rows, dofs) {
        let block = solve(rows, members, largest, &mut dropped)?;
        blocks.extend((!block.pivots.is_empty()).then_some(block));
    }
    Ok((blocks, dropped))
}

/// Groups the rows by block, ascending. A row without terms forms a block of its own.
fn connected(rows: &[Row], dofs: usize) -> Vec<Vec<usize>> {
    // Union-find over rows; each degree of freedom remembers the first row that contains it.
    let mut parent: Vec<usize> = (0..rows.len()).collect();
    fn find(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    let mut first = vec![usize::MAX; dofs];
    for (index, row) in rows.iter().enumerate() {
        for &(dof, _) in &row.terms {
            if first[dof] == usize::MAX {
                first[dof] = index;
            }
            let (a, b) = (find(&mut parent, first[dof]), find(&mut parent, index));
            parent[a.max(b)] = a.min(b);
        }
    }
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); rows.len()];
    for index in 0..rows.len() {
        members[find(&mut parent, index)].push(index);
    }
    members.retain(|m| !m.is_empty());
    members
}

/// Eliminates the rows of one block; `prescribed` is the largest value of all rows, to which rounding is
/// relative.
fn solve(
    rows: &[Row],
    members: Vec<usize>,
    prescribed: f64,
    dropped: &mut usize,
) -> Result<Block, SolveError> {
    let mut dofs: Vec<usize> = members.iter().flat_map(|&r| rows[r].terms.iter().map(|t| t.0)).collect();
    dofs.sort_unstable();
    dofs.dedup();
    let (m, n) = (members.len(), dofs.len());
    // [C | I], each row scaled to a largest coefficient of one.
    let width = n + m;
    let mut table = vec![0.0; m * width];
    for (r, &index) in members.iter().enumerate() {
        let row = &mut table[r * width..][..width];
        let size = rows[index].terms.iter().fold(0.0f64, |s, t| s.max(t.1.abs()));
        let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
        for &(dof, c) in &rows[index].terms {
            row[dofs.binary_search(&dof).expect("collected above")] = scale * c;
        }
        row[n + r] = scale;
    }
    let mut pivot_of = vec![None; m];
    while let Some((r, c)) = largest(&table, width, n, &pivot_of) {
        pivot_of[r] = Some(c);
        let pivot = table[r * width + c];
        table[r * width..][..width].iter_mut().for_each(|v| *v /= pivot);
        let row = table[r * width..][..width].to_vec();
        for (_, other) in table.chunks_exact_mut(width).enumerate().filter(|(k, _)| *k != r) {
            let factor = other[c];
            if factor != 0.0 {
                other.iter_mut().zip(&row).for_each(|(o, v)| *o -= factor * v);
                other[c] = 0.0;
            }
        }
    }
    let kept: Vec<usize> = (0..m).filter(|&r| pivot_of[r].is_some()).collect();
    for r in (0..m).filter(|&r| pivot_of[r].is_none()) {
        let terms = || members.iter().zip(&table[r * width + n..]).map(|(&k, e)| e * rows[k].value);
        let (gap, size) = terms().fold((0.0, prescribed), |(sum, size), t| (sum + t, size.max(t.abs())));
        if gap.abs() > DEPENDENT * size {
            return Err(SolveError::Dependent { row: members[r], gap });
        }
        *dropped += 1;
    }
    let pivots: Vec<usize> = kept.iter().filter_map(|&r| pivot_of[r]).collect();
    let others: Vec<usize> = (0..n).filter(|c| !pivots.contains(c)).collect();
    let of = |columns: &[usize], from: usize| -> Vec<f64> {
        kept.iter()
            .flat_map(|&r| columns.iter().map(move |&c| (r, c)))
            .map(|(r, c)| table[r * width + from + c])
            .collect()
    };
    Ok(Block {
        weights: of(&others, 0),
        inverse: of(&kept, n),
        rows: kept.iter().map(|&r| members[r]).collect(),
        pivots: pivots.iter().map(|&c| dofs[c]).collect(),
        others: others.iter().map(|&c| dofs[c]).collect(),
    })
}

/// Position of the largest coefficient in the rows without a pivot (the first of equal coefficients); `None`
/// if only rounding is left.
fn largest(table: &[f64], width: usize, n: usize, pivot_of: &[Option<usize>]) -> Option<(usize, usize)> {
    let (mut best, mut place) = (DEPENDENT, None);
    for (r, row) in table.chunks_exact(width).enumerate().filter(|(r, _)| pivot_of[*r].is_none()) {
        for (c, v) in row[..n].iter().enumerate() {
            if v.abs() > best {
                (best, place) = (v.abs(), Some((r, c)));
            }
        }
    }
    place
}
