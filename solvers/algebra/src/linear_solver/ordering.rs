//! Fill-reducing order: METIS nested dissection of the vertex graph, composed with a postorder of its
//! elimination tree.
//!
//! faer does not postorder a given permutation. Without the postorder, supernodes are half as wide.

use std::sync::Mutex;

use metis_sys as metis;

use super::symmetric::Symmetric;
use crate::error::AlgebraError;

/// METIS draws from the global random generator of the C library: concurrent orderings would change each
/// other's bits.
static METIS: Mutex<()> = Mutex::new(());

/// Returns the order of unknowns, `forward[new] = old`, and its inverse. The graph of vertices (nodes) is
/// nine times smaller than that of unknowns.
pub(super) fn nested_dissection(matrix: &Symmetric) -> Result<(Vec<usize>, Vec<usize>), AlgebraError> {
    let graph = Graph::of(matrix);
    let order = graph.dissect()?;
    let order = graph.postordered(&order);
    let forward: Vec<usize> =
        order.iter().flat_map(|&v| matrix.vertices[v]..matrix.vertices[v + 1]).collect();
    let mut inverse = vec![0; forward.len()];
    for (new, &old) in forward.iter().enumerate() {
        inverse[old] = new;
    }
    Ok((forward, inverse))
}

/// Neighbours of each vertex, without the vertex itself.
struct Graph {
    offsets: Vec<usize>,
    neighbours: Vec<i32>,
    /// Unknowns per vertex.
    weights: Vec<i32>,
}

impl Graph {
    fn of(matrix: &Symmetric) -> Graph {
        let count = matrix.vertices.len() - 1;
        let mut vertex_of = vec![0usize; matrix.dim()];
        for v in 0..count {
            vertex_of[matrix.vertices[v]..matrix.vertices[v + 1]].fill(v);
        }
        // All unknowns of a vertex have the same earlier neighbours: its first column names them all.
        let mut pairs: Vec<(usize, usize)> = Vec::new();
        for v in 0..count {
            let column = matrix.vertices[v];
            let mut last = usize::MAX;
            for &row in &matrix.rows[matrix.offsets[column]..matrix.offsets[column + 1]] {
                let u = vertex_of[row];
                if u != v && u != last {
                    pairs.push((u, v));
                    last = u;
                }
            }
        }
        let mut offsets = vec![0usize; count + 1];
        for &(u, v) in &pairs {
            offsets[u + 1] += 1;
            offsets[v + 1] += 1;
        }
        for v in 0..count {
            offsets[v + 1] += offsets[v];
        }
        let mut next = offsets.clone();
        let mut neighbours = vec![0i32; 2 * pairs.len()];
        for (u, v) in pairs {
            for (a, b) in [(u, v), (v, u)] {
                neighbours[next[a]] = b as i32;
                next[a] += 1;
            }
        }
        let weights = matrix.vertices.windows(2).map(|p| (p[1] - p[0]) as i32).collect();
        Graph { offsets, neighbours, weights }
    }

    /// Returns the order found by METIS: the vertex at each position.
    fn dissect(&self) -> Result<Vec<usize>, AlgebraError> {
        let count = self.weights.len();
        let too_large = |_| AlgebraError::TooLarge {
            dofs: count,
            why: "the graph of the matrix has more than 2^31 edges".into(),
        };
        let mut offsets = self
            .offsets
            .iter()
            .map(|&o| i32::try_from(o))
            .collect::<Result<Vec<i32>, _>>()
            .map_err(too_large)?;
        let mut nvtxs = i32::try_from(count).map_err(too_large)?;
        let (mut neighbours, mut weights) = (self.neighbours.clone(), self.weights.clone());
        let (mut order, mut place) = (vec![0i32; count], vec![0i32; count]);
        let mut options = [0i32; metis::METIS_NOPTIONS as usize];
        let _one_at_a_time = METIS.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        // SAFETY: the arrays have the lengths METIS documents (nvtxs + 1, number of neighbours, nvtxs, the
        // options' own) and outlive the call.
        let status = unsafe {
            metis::METIS_SetDefaultOptions(options.as_mut_ptr());
            options[metis::moptions_et_METIS_OPTION_SEED as usize] = 1;
            options[metis::moptions_et_METIS_OPTION_NUMBERING as usize] = 0;
            // The graph is compressed already: no two vertices have equal neighbourhoods.
            options[metis::moptions_et_METIS_OPTION_COMPRESS as usize] = 0;
            metis::METIS_NodeND(
                &mut nvtxs,
                offsets.as_mut_ptr(),
                neighbours.as_mut_ptr(),
                weights.as_mut_ptr(),
                options.as_mut_ptr(),
                order.as_mut_ptr(),
                place.as_mut_ptr(),
            )
        };
        if status != metis::rstatus_et_METIS_OK {
            return Err(AlgebraError::Ordering { status });
        }
        Ok(order.into_iter().map(|v| v as usize).collect())
    }

    /// Composes `order` with a postorder of its elimination tree: same fill, wide supernodes.
    fn postordered(&self, order: &[usize]) -> Vec<usize> {
        let count = order.len();
        let mut place = vec![0; count];
        for (new, &old) in order.iter().enumerate() {
            place[old] = new;
        }
        // Elimination tree by path compression (Liu 1986).
        const NONE: usize = usize::MAX;
        let (mut parent, mut ancestor) = (vec![NONE; count], vec![NONE; count]);
        for new in 0..count {
            let old = order[new];
            for &u in &self.neighbours[self.offsets[old]..self.offsets[old + 1]] {
                let mut at = place[u as usize];
                while at < new {
                    let next = std::mem::replace(&mut ancestor[at], new);
                    if next == NONE {
                        parent[at] = new;
                        break;
                    }
                    at = next;
                }
            }
        }
        // Children in ascending order, then depth first without recursion (a chain may be as deep as the
        // matrix).
        let (mut first, mut sibling) = (vec![NONE; count], vec![NONE; count]);
        for v in (0..count).rev() {
            if parent[v] != NONE {
                sibling[v] = std::mem::replace(&mut first[parent[v]], v);
            }
        }
        let mut out = Vec::with_capacity(count);
        for root in (0..count).filter(|&v| parent[v] == NONE) {
            let mut stack = vec![root];
            while let Some(&v) = stack.last() {
                match std::mem::replace(&mut first[v], NONE) {
                    NONE => {
                        out.push(order[v]);
                        stack.pop();
                        if sibling[v] != NONE && v != root {
                            stack.push(sibling[v]);
                        }
                    }
                    child => stack.push(child),
                }
            }
        }
        out
    }
}
