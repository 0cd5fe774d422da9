//! Rows in blocks of eight, for tables that are applied repeatedly.

use lanes::{LANES, LanePath, on_path};

use crate::Vector3;
use crate::rows::Rows;

/// One number for each row of a block, in one cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(64))]
struct Lanes([f64; LANES]);

/// A table packed for repeated products (register blocks; Im, Yelick and Vuduc 2004).
///
/// Eight rows with mostly common nodes form a block. A block covers the nodes of all its rows, with zeros for
/// nodes that a row lacks. A nodal vector is loaded once for eight rows, and no sum waits for another. Each
/// row is summed by ascending node in a lane of its own, with separate multiplication and addition. For a
/// table with ascending rows the bits are therefore those of [`Rows::apply`] on any machine.
///
/// ```
/// use tissuebench_shape::{RowBlocks, Rows, Unity, Vector3};
/// # fn main() -> Result<(), tissuebench_shape::ShapeError> {
/// let rows = Rows::new(3, vec![0, 2, 4], vec![0, 1, 1, 2], vec![0.5, 0.5, 0.25, 0.75], Unity::Within(0.0))?;
/// let (blocks, u) = (RowBlocks::new(&rows), [Vector3::x(), Vector3::y(), Vector3::z()]);
/// let mut field = [Vector3::zeros(); 2];
/// blocks.apply_into(&u, &mut field);
/// assert_eq!(field[..], rows.apply(&u));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RowBlocks {
    node_count: usize,
    /// Rows in the order of their lanes; the last block may have unused lanes.
    order: Vec<u32>,
    /// Start of each block in `nodes` and `values`, blocks + 1 entries; the number of blocks is even.
    offsets: Vec<usize>,
    nodes: Vec<u32>,
    values: Vec<Lanes>,
}

impl RowBlocks {
    /// Packs a table. This takes the time of about six calls of [`Rows::apply`] (moving least squares), so it
    /// pays off for more calls than that.
    pub fn new(rows: &Rows) -> RowBlocks {
        let order = alike(rows);
        let (mut offsets, mut nodes) = (vec![0], Vec::new());
        let mut named = Named::new(rows.node_count());
        for block in order.chunks(LANES) {
            for &row in block {
                named.add(rows.row(row as usize).0);
            }
            named.drain_into(&mut nodes);
            offsets.push(nodes.len());
        }
        if offsets.len() % 2 == 0 {
            // Blocks are processed in pairs; the last block may be paired with an empty block.
            offsets.push(nodes.len());
        }
        // Values are filled by node and lane, then read by ascending node: each is moved twice, without a
        // search.
        let mut values = Vec::with_capacity(nodes.len());
        let mut of_nodes = vec![Lanes::default(); rows.node_count()];
        for (block, range) in order.chunks(LANES).zip(offsets.windows(2)) {
            for (lane, &row) in block.iter().enumerate() {
                let (nodes, values) = rows.row(row as usize);
                for (&node, &value) in nodes.iter().zip(values) {
                    of_nodes[node as usize].0[lane] += value;
                }
            }
            let taken = nodes[range[0]..range[1]].iter();
            values.extend(taken.map(|&node| std::mem::take(&mut of_nodes[node as usize])));
        }
        RowBlocks { node_count: rows.node_count(), order, offsets, nodes, values }
    }

    /// Number of rows (points).
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether the table has no rows.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Evaluates the field with nodal parameters `u` at every row's point, `u(x_q) = sum_I N_I(x_q) u_I`,
    /// into the buffer `field` without allocation.
    pub fn apply_into(&self, u: &[Vector3], field: &mut [Vector3]) {
        assert_eq!(u.len(), self.node_count, "one vector per node");
        assert_eq!(field.len(), self.len(), "one vector per row");
        apply(LanePath::best(), self, u, field)
    }

    /// Processes two blocks together: a sum waits four cycles for the previous one, and the sums and products
    /// of a block for one node take three. All six sums are in one array of one function; otherwise the
    /// compiler shuffles them at every node.
    #[inline(always)]
    fn apply_plain(&self, u: &[Vector3], field: &mut [Vector3]) {
        let block = |range: std::ops::Range<usize>| (&self.nodes[range.clone()], &self.values[range]);
        for (starts, rows) in self.offsets.windows(3).step_by(2).zip(self.order.chunks(2 * LANES)) {
            let (first, second) = (block(starts[0]..starts[1]), block(starts[1]..starts[2]));
            let both = first.0.len().min(second.0.len());
            let mut sums = [[0.0; LANES]; 6];
            for k in 0..both {
                let (u, v) = (u[first.0[k] as usize], u[second.0[k] as usize]);
                let (of_u, of_v) = (first.1[k].0, second.1[k].0);
                for axis in 0..3 {
                    for l in 0..LANES {
                        sums[axis][l] += of_u[l] * u[axis];
                    }
                }
                for axis in 0..3 {
                    for l in 0..LANES {
                        sums[3 + axis][l] += of_v[l] * v[axis];
                    }
                }
            }
            let [ax, ay, az, bx, by, bz] = sums;
            let (rows, others) = rows.split_at(rows.len().min(LANES));
            for (mut sums, (nodes, values), rows) in
                [([ax, ay, az], first, rows), ([bx, by, bz], second, others)]
            {
                for (&node, values) in nodes[both..].iter().zip(&values[both..]) {
                    let values = values.0;
                    let u = u[node as usize];
                    for axis in 0..3 {
                        for l in 0..LANES {
                            sums[axis][l] += values[l] * u[axis];
                        }
                    }
                }
                scatter(&sums, rows, field);
            }
        }
    }
}

on_path! {
    /// Calls [`RowBlocks::apply_plain`] in wide registers. The bits are the same on every path because
    /// multiplication and addition stay separate.
    fn apply(blocks: &RowBlocks, u: &[Vector3], field: &mut [Vector3]) = apply_in
}

#[inline(always)]
fn apply_in<const FMA: bool>(blocks: &RowBlocks, u: &[Vector3], field: &mut [Vector3]) {
    blocks.apply_plain(u, field)
}

/// Writes the vectors of a block. As a separate function it prevents the compiler from pairing x and y of a
/// row in the sums, which doubles the time.
#[inline(never)]
fn scatter([x, y, z]: &[[f64; LANES]; 3], rows: &[u32], field: &mut [Vector3]) {
    for (l, &row) in rows.iter().enumerate() {
        field[row as usize] = Vector3::new(x[l], y[l], z[l]);
    }
}

/// Returns the rows in an order that groups similar rows: by the nodes of their two largest values, if a
/// table has more columns than a row has entries.
fn alike(rows: &Rows) -> Vec<u32> {
    let order: Vec<u32> = (0..rows.len() as u32).collect();
    if rows.uniform_len() == Some(rows.node_count()) {
        return order;
    }
    let (firsts, seconds): (Vec<u32>, Vec<u32>) =
        (0..rows.len()).map(|row| two_largest(rows.row(row))).unzip();
    let order = sorted(&order, &seconds, rows.node_count());
    sorted(&order, &firsts, rows.node_count())
}

/// Returns the nodes of the two largest values (the first of equal values), or node 0 if there are no values.
fn two_largest((nodes, values): (&[u32], &[f64])) -> (u32, u32) {
    let (most, next) = two_highest(values);
    let place = |value: f64, from: usize| (from..values.len()).find(|&at| values[at] == value);
    let Some(first) = place(most, 0) else { return (0, 0) };
    let second = place(next, if next == most { first + 1 } else { 0 });
    (nodes[first], second.map_or(0, |at| nodes[at]))
}

/// Returns the two largest values, or minus infinity if there are none. The search goes lane by lane and then
/// over the lanes, without branches that a new maximum would mispredict.
fn two_highest(values: &[f64]) -> (f64, f64) {
    let larger = |a: f64, b: f64| if b > a { b } else { a };
    let smaller = |a: f64, b: f64| if b < a { b } else { a };
    let (mut most, mut next) = ([f64::NEG_INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
    let (groups, rest) = values.as_chunks::<LANES>();
    let mut last = [f64::NEG_INFINITY; LANES];
    last[..rest.len()].copy_from_slice(rest);
    for group in groups.iter().chain([&last]) {
        for l in 0..LANES {
            next[l] = larger(next[l], smaller(most[l], group[l]));
            most[l] = larger(most[l], group[l]);
        }
    }
    for half in [4, 2, 1] {
        for l in 0..half {
            next[l] = larger(larger(next[l], next[l + half]), smaller(most[l], most[l + half]));
            most[l] = larger(most[l], most[l + half]);
        }
    }
    (most[0], next[0])
}

/// Sorts the rows by their keys, all below `count`; rows with equal keys keep their order (counting sort).
fn sorted(order: &[u32], keys: &[u32], count: usize) -> Vec<u32> {
    let mut next = vec![0; count + 1];
    for &key in keys {
        next[key as usize + 1] += 1;
    }
    for key in 0..count {
        next[key + 1] += next[key];
    }
    let mut sorted = vec![0; order.len()];
    for &row in order {
        let place = &mut next[keys[row as usize] as usize];
        sorted[*place] = row;
        *place += 1;
    }
    sorted
}

/// The set of nodes of a block, as bits.
struct Named {
    bits: Vec<u64>,
    /// Range of the words of `bits` that may be nonzero.
    span: (usize, usize),
}

impl Named {
    fn new(node_count: usize) -> Named {
        Named { bits: vec![0; node_count.div_ceil(64)], span: (usize::MAX, 0) }
    }

    fn add(&mut self, nodes: &[u32]) {
        // Bits of a word are collected locally, because a word in memory would wait for every previous bit.
        let (mut word, mut bits) = (0, 0);
        for &node in nodes {
            if node as usize / 64 != word {
                self.set(word, bits);
                (word, bits) = (node as usize / 64, 0);
            }
            bits |= 1 << (node % 64);
        }
        self.set(word, bits);
    }

    fn set(&mut self, word: usize, bits: u64) {
        if bits != 0 {
            self.bits[word] |= bits;
            self.span = (self.span.0.min(word), self.span.1.max(word + 1));
        }
    }

    /// Appends the nodes in ascending order and clears the set.
    fn drain_into(&mut self, nodes: &mut Vec<u32>) {
        let (low, high) = std::mem::replace(&mut self.span, (usize::MAX, 0));
        for word in low..high {
            let mut bits = std::mem::take(&mut self.bits[word]);
            while bits != 0 {
                nodes.push(64 * word as u32 + bits.trailing_zeros());
                bits &= bits - 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unity;

    /// Returns `count` rows over 83 nodes, of every length up to a full row.
    fn table(count: usize) -> Rows {
        let (mut offsets, mut nodes, mut values) = (vec![0], Vec::new(), Vec::new());
        for row in 0..count {
            let every = 1 + row % 11;
            for node in (row % 7..83).step_by(every).take(row % 90) {
                nodes.push(node as u32);
                values.push((0.7 * (row * node) as f64 + row as f64).sin());
            }
            offsets.push(nodes.len());
        }
        Rows::new(83, offsets, nodes, values, Unity::NotPromised).unwrap()
    }

    #[test]
    fn blocks_give_the_bits_of_rows_on_every_path() {
        let u: Vec<Vector3> = (0..83).map(|i| Vector3::new(i as f64, 1.0, -0.3).map(f64::cos)).collect();
        // Full blocks, unused lanes, and no rows.
        for count in [0, 1, 7, 8, 200, 1331] {
            let rows = table(count);
            let blocks = RowBlocks::new(&rows);
            assert_eq!((blocks.len(), blocks.is_empty()), (count, count == 0));
            for path in LanePath::available() {
                let mut field = vec![Vector3::repeat(f64::NAN); count];
                apply(path, &blocks, &u, &mut field);
                assert!(field == rows.apply(&u), "{} {count}", path.name());
            }
        }
    }

    #[test]
    fn a_node_named_twice_counts_twice_and_nodes_may_come_in_any_order() {
        let (nodes, values) = (vec![4, 70, 4, 70, 4], vec![0.25, 0.5, 0.25, 0.125, 0.875]);
        let rows = Rows::new(71, vec![0, 3, 5], nodes, values, Unity::Within(0.0)).unwrap();
        let u: Vec<Vector3> = (0..71).map(|i| Vector3::repeat(i as f64)).collect();
        let mut field = [Vector3::zeros(); 2];
        RowBlocks::new(&rows).apply_into(&u, &mut field);
        assert_eq!(field, [Vector3::repeat(37.0), Vector3::repeat(12.25)]);
    }

    #[test]
    fn alike_rows_share_a_block() {
        // Sixteen rows of two nodes each, of two alternating kinds, form two blocks of two nodes.
        let nodes = (0..16).flat_map(|row| if row % 2 == 0 { [3, 9] } else { [5, 6] }).collect();
        let offsets = (0..=16).map(|row| 2 * row).collect();
        let rows = Rows::new(10, offsets, nodes, [0.75, 0.25].repeat(16), Unity::Within(0.0)).unwrap();
        let blocks = RowBlocks::new(&rows);
        assert_eq!((&blocks.nodes[..], &blocks.offsets[..]), (&[3, 9, 5, 6][..], &[0, 2, 4][..]));
    }
}
