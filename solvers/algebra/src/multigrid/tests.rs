//! Checks the parts of the hierarchy against their definitions.

use shape::{Matrix3, Point3, Vector3};

use super::aggregate::{MODES, aggregates, orthonormal};
use super::galerkin::galerkin;
use super::graph::Graph;
use super::level::{Cycle, Level, by_aggregates};
use super::lower_triangle::{Block, Lower, LowerRows};
use super::operator::Operator;
use super::patch::Patch;
use super::tangents::TangentLevels;
use super::transfer::{Dense, Transfer, Weight};
use super::{Multigrid, PressureGroup};
use crate::pattern::{BlockPattern, Connectivity, Incidence};
use crate::stiffness::Stiffness;

/// Grid of n x n x n nodes connected to their neighbours by springs, with the first face on ground springs.
fn grid(n: usize) -> (Lower<3>, Vec<[[f64; MODES]; 3]>) {
    let node = |x: usize, y: usize, z: usize| (x * n + y) * n + z;
    let at = |i: usize| [i / (n * n), i / n % n, i % n];
    let nodes = n * n * n;
    let mut rows = vec![std::collections::BTreeMap::<usize, Block<3>>::new(); nodes];
    let mut add = |i: usize, j: usize, a: usize, b: usize, v: f64| {
        rows[i].entry(j).or_insert([[0.0; 3]; 3])[b][a] += v;
    };
    for i in 0..nodes {
        let [x, y, z] = at(i);
        for a in 0..3 {
            add(i, i, a, a, if x == 0 { 5.0 } else { 0.0 });
        }
        for (dx, dy, dz) in [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1), (1, 0, 1)] {
            if x + dx < n && y + dy < n && z + dz < n {
                let j = node(x + dx, y + dy, z + dz);
                let d = [dx as f64, dy as f64, dz as f64];
                let square: f64 = d.iter().map(|d| d * d).sum();
                for a in 0..3 {
                    for b in 0..3 {
                        let stiffness = d[a] * d[b] / square;
                        add(i, i, a, b, stiffness);
                        add(j, j, a, b, stiffness);
                        add(j, i, a, b, -stiffness);
                    }
                }
            }
        }
    }
    let (mut offsets, mut columns, mut blocks) = (vec![0], Vec::new(), Vec::new());
    for row in rows {
        for (j, block) in row {
            columns.push(j as u32);
            blocks.push(block);
        }
        offsets.push(columns.len());
    }
    let modes = (0..nodes)
        .map(|i| {
            let [x, y, z] = at(i).map(|c| c as f64 / n as f64);
            [[1.0, 0.0, 0.0, 0.0, z, -y], [0.0, 1.0, 0.0, -z, 0.0, x], [0.0, 0.0, 1.0, y, -x, 0.0]]
        })
        .collect();
    (Lower { offsets, columns, blocks, unit: 10.0 }, modes)
}

/// All entries of a symmetric matrix.
fn dense<const B: usize>(lower: &Lower<B>) -> Vec<Vec<f64>> {
    let dim = B * lower.nodes();
    let mut matrix = vec![vec![0.0; dim]; dim];
    for i in 0..lower.nodes() {
        for (at, &j) in lower.columns(i).iter().enumerate() {
            let block = lower.block(i, at);
            for a in 0..B {
                for b in 0..B {
                    let (r, c) = (B * i + a, B * j as usize + b);
                    matrix[r][c] = block[b][a];
                    matrix[c][r] = block[b][a];
                }
            }
        }
    }
    matrix
}

/// Column `c` of a prolongation.
fn column<const B: usize>(transfer: &Transfer<Dense<B>>, nodes: usize, c: usize) -> Vec<f64> {
    let mut coarse = vec![[0.0; MODES]; transfer.count];
    coarse[c / MODES][c % MODES] = 1.0;
    let mut fine = vec![[0.0; B]; nodes];
    transfer.prolong(&coarse, &mut fine);
    fine.into_iter().flatten().map(f64::from).collect()
}

#[test]
fn a_coarse_matrix_is_the_triple_product() {
    let (lower, modes) = grid(6);
    let graph = Graph::new(&lower);
    let matrix = Operator::new(&lower, &graph, 0.1);
    let (functions, _) = orthonormal(&aggregates(&matrix, &graph), &modes);
    let transfer = Transfer::smoothed(&matrix, &graph, &aggregates(&matrix, &graph), &functions);
    let coarse = dense(&galerkin::<3, MODES, Dense<3>>(&lower, &graph, &transfer));
    let fine = dense(&lower);
    assert!(transfer.count > 4, "{} aggregates", transfer.count);
    let columns: Vec<Vec<f64>> = (0..MODES * transfer.count).map(|c| column(&transfer, 216, c)).collect();
    for (r, left) in columns.iter().enumerate() {
        let image: Vec<f64> = fine.iter().map(|row| row.iter().zip(left).map(|(a, p)| a * p).sum()).collect();
        for (c, right) in columns.iter().enumerate() {
            let exact: f64 = image.iter().zip(right).map(|(a, p)| a * p).sum();
            assert!((coarse[r][c] - exact).abs() < 1e-12, "{r} {c}: {} for {exact}", coarse[r][c]);
        }
    }
}

/// Smoothing changes a rigid motion only next to the supports.
#[test]
fn rigid_motions_are_prolonged_exactly_away_from_supports() {
    let (lower, modes) = grid(8);
    let graph = Graph::new(&lower);
    let matrix = Operator::new(&lower, &graph, 0.1);
    let aggregates = aggregates(&matrix, &graph);
    let (functions, coarse) = orthonormal(&aggregates, &modes);
    let transfer = Transfer::smoothed(&matrix, &graph, &aggregates, &functions);
    for m in 0..MODES {
        let values: Vec<[f32; MODES]> =
            coarse.iter().map(|rows| std::array::from_fn(|d| rows[d][m] as f32)).collect();
        let mut fine = vec![[0.0f32; 3]; 512];
        transfer.prolong(&values, &mut fine);
        for i in 64..512 {
            for a in 0..3 {
                let off = f64::from(fine[i][a]) - modes[i][a][m];
                assert!(off.abs() < 1e-5, "mode {m} at node {i}: {off}");
            }
        }
    }
}

#[test]
fn restriction_is_the_transpose_of_prolongation() {
    let weight = Dense([[1.0, -2.0, 3.0, 0.5, 0.0, 7.0], [0.0; 6], [2.0, 4.0, -1.0, 1.0, 1.0, 3.0]]);
    let (coarse, fine) = ([1.0, 2.0, -1.0, 0.5, 3.0, 0.25], [2.0, 5.0, -3.0]);
    let inner = |a: &[f32], b: &[f32]| -> f32 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let [(mut up, mut down), (mut fused_up, mut fused_down)] = [([0.0; 3], [0.0; 6]); 2];
    weight.add::<false>(&coarse, &mut up);
    weight.add_transposed::<false>(&fine, &mut down);
    assert_eq!(inner(&up, &fine), inner(&down, &coarse));
    weight.add::<true>(&coarse, &mut fused_up);
    weight.add_transposed::<true>(&fine, &mut fused_down);
    assert_eq!((fused_up, fused_down), (up, down));
}

/// A preconditioner of conjugate gradients must be symmetric and positive, also with several chunks, and with
/// a patch of the nodes on the first face.
#[test]
fn a_cycle_is_symmetric_and_positive() {
    // 17,576 nodes: two chunks of the sweeps.
    let (lower, modes) = grid(26);
    let face: Vec<u32> = (0..26 * 26).collect();
    for patch in [&[][..], &face] {
        let level = by_aggregates(&lower, &modes, 0.1, patch).unwrap_or_else(|_| panic!("definite"));
        assert_eq!(level.has_patch(), !patch.is_empty());
        check_cycles(&lower, &modes, &*level);
    }
}

fn check_cycles(lower: &Lower<3>, modes: &[[[f64; MODES]; 3]], level: &dyn Level<3>) {
    let vector = |seed: f64| -> Vec<[f32; 3]> {
        (0..lower.nodes())
            .map(|i| std::array::from_fn(|a| ((3 * i + a) as f64 * seed).fract() as f32 - 0.5))
            .collect()
    };
    let cycle = |b: &[[f32; 3]], cycle: Cycle| {
        let mut x = vec![[0.0; 3]; b.len()];
        level.solve(b, &mut x, cycle);
        x
    };
    let solve = |b: &[[f32; 3]]| cycle(b, Cycle::W);
    let inner = |a: &[[f32; 3]], b: &[[f32; 3]]| -> f64 {
        a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| f64::from(a * b)).sum()
    };
    let (first, second) = (vector(0.618034), vector(0.414214));
    let (left, right) = (inner(&solve(&first), &second), inner(&first, &solve(&second)));
    let size = inner(&solve(&first), &first);
    assert!(size > 0.0 && inner(&solve(&second), &second) > 0.0);
    assert!((left - right).abs() < 1e-5 * size, "{left} and {right} of {size}");
    // Cycles approximate the inverse from below, and a W-cycle is closer to it.
    let smooth: Vec<[f32; 3]> = modes.iter().map(|rows| std::array::from_fn(|a| rows[a][0] as f32)).collect();
    let once = inner(&cycle(&smooth, Cycle::V), &smooth);
    let twice = inner(&solve(&smooth), &smooth);
    assert!(once > 0.0 && twice > 1.01 * once, "{once} and {twice}");
}

/// On its own nodes a patch leaves no residual. Elsewhere it keeps the residual up to date.
#[test]
fn a_patch_solves_its_part_of_the_matrix() {
    let (lower, _) = grid(8);
    let nodes = lower.nodes();
    let matrix = Operator::new(&lower, &Graph::new(&lower), 0.1);
    let of_patch: Vec<u32> = (0..nodes as u32).filter(|i| i % 7 == 3).collect();
    let Ok(Some(patch)) = Patch::new(&lower, &of_patch, 0.1) else { panic!("a patch") };
    let value = |i: usize| (i as f64 * 0.618034).fract() as f32 - 0.5;
    let b: Vec<[f32; 3]> = (0..nodes).map(|i| [0, 1, 2].map(|a| value(3 * i + a))).collect();
    let residual = |x: &[[f32; 3]]| {
        let mut out = vec![[0.0; 3]; nodes];
        matrix.residual(&b, x, &mut out);
        out
    };
    let start: Vec<[f32; 3]> = b.iter().rev().copied().collect();
    let (mut corrected, mut rest) = (start.clone(), residual(&start));
    patch.correct(&mut corrected, &mut rest);
    let mut solved = start.clone();
    patch.solve(&b, &mut solved);
    let exact = residual(&corrected);
    for i in 0..nodes {
        for a in 0..3 {
            assert!((rest[i][a] - exact[i][a]).abs() < 1e-5, "node {i}: {} for {}", rest[i][a], exact[i][a]);
            assert!((solved[i][a] - corrected[i][a]).abs() < 1e-5, "node {i}");
            assert!(i % 7 != 3 || exact[i][a].abs() < 1e-5, "node {i}: {}", exact[i][a]);
        }
    }
    let half: Vec<u32> = (0..nodes as u32 / 2).collect();
    assert!(matches!(Patch::new(&lower, &half, 0.1), Ok(None)));
}

/// Checks that one stored triangle serves as both, across two chunks: in residuals, and in the sweeps that
/// update them.
#[test]
fn sweeps_leave_the_residual_and_are_transposes() {
    let (lower, _) = grid(26);
    let matrix = Operator::new(&lower, &Graph::new(&lower), 1.0);
    assert!(matrix.is_chunked());
    let nodes = lower.nodes();
    let vector = |seed: f64| -> Vec<[f32; 3]> {
        (0..nodes)
            .map(|i| std::array::from_fn(|a| ((3 * i + a) as f64 * seed).fract() as f32 - 0.5))
            .collect()
    };
    let near = |a: &[[f32; 3]], b: &[[f32; 3]], what: &str| {
        let off = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off < 1e-4, "{what}: {off}");
    };
    let inner = |a: &[[f32; 3]], b: &[[f32; 3]]| -> f64 {
        a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| f64::from(a * b)).sum()
    };
    let (b, x) = (vector(0.618034), vector(0.414214));
    let mut exact = b.clone();
    for i in 0..nodes {
        for (at, &j) in lower.columns(i).iter().enumerate() {
            let j = j as usize;
            let block = lower.block(i, at);
            for c in 0..3 {
                for r in 0..3 {
                    exact[i][r] -= block[c][r] as f32 * x[j][c];
                    exact[j][c] -= if j < i { block[c][r] as f32 * x[i][r] } else { 0.0 };
                }
            }
        }
    }
    let zero = vec![[0.0; 3]; nodes];
    let residual = |x: &[[f32; 3]]| {
        let mut out = zero.clone();
        matrix.residual(&b, x, &mut out);
        out
    };
    near(&residual(&x), &exact, "residual");

    let (mut forward, mut rest) = (zero.clone(), zero.clone());
    matrix.sweep_forward(&b, &mut forward, &mut rest);
    near(&rest, &residual(&forward), "what a sweep forward leaves");
    let backward = |b: &[[f32; 3]], x: &[[f32; 3]]| {
        let mut x = x.to_vec();
        matrix.sweep_backward(b, &mut x, &mut zero.clone());
        x
    };
    let (left, right) = (inner(&forward, &x), inner(&b, &backward(&x, &zero)));
    assert!((left - right).abs() < 1e-5 * inner(&forward, &forward), "{left} and {right}");
    // A backward sweep from `x` adds to `x` a sweep from zero on its residual.
    let mut corrected = backward(&exact, &zero);
    corrected.iter_mut().flatten().zip(x.iter().flatten()).for_each(|(c, x)| *c += x);
    near(&backward(&b, &x), &corrected, "a sweep backward");
}

/// Stiffness of a grid of n x n x n nodes, each tied to its six neighbours (beyond the faces to the ground)
/// by equal springs in all directions, minus `part` of its smallest eigenvalue on the diagonal.
fn shifted(n: usize, part: f64) -> Stiffness {
    let at = |i: usize| [i / (n * n), i / n % n, i % n];
    let near = |i: usize, j: usize| at(i).iter().zip(at(j)).map(|(a, b)| a.abs_diff(b)).sum::<usize>() == 1;
    let edges: Vec<[u32; 2]> = (0..n * n * n)
        .flat_map(|i| [1, n, n * n].map(|step| (i, i + step)))
        .filter(|&(i, j)| j < n * n * n && near(i, j))
        .map(|(i, j)| [i as u32, j as u32])
        .collect();
    let offsets: Vec<usize> = (0..=edges.len()).map(|e| 2 * e).collect();
    let table = Connectivity { offsets: &offsets, nodes: edges.as_flattened(), seen_by: &[] };
    let incidence = Incidence::new(n * n * n, table, 0..edges.len());
    let mut stiffness = Stiffness::zeros(BlockPattern::new(n * n * n, &[(table, &incidence)]));
    let smallest = 6.0 - 6.0 * (std::f64::consts::PI / (n + 1) as f64).cos();
    stiffness.for_each_row(|_, _, row| {
        row.fill(-Matrix3::identity());
        *row.last_mut().unwrap() = Matrix3::identity() * (6.0 - part * smallest);
    });
    stiffness
}

fn points(n: usize) -> Vec<Point3> {
    (0..n * n * n).map(|i| Point3::new((i / (n * n)) as f64, (i / n % n) as f64, (i % n) as f64)).collect()
}

/// The grid has two parts of the rows, and several tasks of every sum; every eight nodes are a group.
#[test]
fn solutions_have_the_same_bits_at_any_number_of_threads() {
    let n = 26;
    let (stiffness, nodes) = (shifted(n, 0.0), points(n));
    assert!(stiffness.pattern().parts().len() > 1);
    let groups: Vec<PressureGroup> = (0..nodes.len() as u32 / 8)
        .map(|g| PressureGroup {
            row: (8 * g..8 * g + 8).map(|node| (node, Vector3::new(0.1, -0.2, 0.3))).collect(),
            volume: 1.0,
            excess: 50.0,
            rest: 10.0,
        })
        .collect();
    let held = vec![false; 3 * nodes.len()];
    let solve = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let right: Vec<Vector3> = (0..nodes.len())
                .map(|i| Vector3::from_fn(|a, _| ((3 * i + a) as f64 * 0.618034).fract() - 0.5))
                .collect();
            let bits = |x: Vec<Vector3>| x.into_iter().flat_map(|x| x.data.0[0]).map(f64::to_bits);
            let levels = || Multigrid::new(&stiffness, &nodes, held.clone(), None, &[]).unwrap();
            let mut plain = right.clone();
            let done = levels().solve(&stiffness, &mut plain, 1e-8).unwrap();
            assert!(done.count > 4, "{}", done.count);
            let mut tangents = TangentLevels::new(&stiffness, &nodes, held.clone(), None).unwrap();
            tangents.set_pressures(&groups);
            let mut mixed = right;
            let product = |x: &[Vector3], out: &mut [Vector3]| stiffness.multiply_into(x, out);
            assert_eq!(tangents.solve(&product, &mut mixed, 1e-12, 20), (20, false));
            bits(plain).chain(bits(mixed)).collect::<Vec<u64>>()
        })
    };
    let one = solve(1);
    assert!(one == solve(2) && one == solve(3));
}

/// The parts of a product add up to the product by whole rows.
#[test]
fn a_product_in_parts_is_the_product() {
    let stiffness = shifted(26, 0.5);
    let nodes = stiffness.pattern().node_count();
    let x: Vec<Vector3> = (0..nodes).map(|i| Vector3::repeat((i as f64 * 0.618034).fract() - 0.5)).collect();
    let mut exact = vec![Vector3::zeros(); nodes];
    for i in 0..nodes {
        let (columns, blocks) = stiffness.row(i);
        for (&j, block) in columns.iter().zip(blocks) {
            exact[i] += block * x[j as usize];
            if j as usize != i {
                exact[j as usize] += block.tr_mul(&x[i]);
            }
        }
    }
    let off = stiffness.multiply(&x).iter().zip(&exact).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
    assert!(off < 1e-13, "{off}");
}

#[test]
fn a_convergent_iteration_proves_a_matrix_definite_and_only_a_definite_matrix() {
    let n = 12;
    let nodes = points(n);
    let of = |part| shifted(n, part);
    let levels = TangentLevels::new(&of(0.0), &nodes, vec![false; 3 * nodes.len()], None).unwrap();
    assert!(levels.proves_definite(&of(0.0)).is_some());
    assert!(levels.proves_definite(&of(0.99)).is_some());
    assert!(levels.proves_definite(&of(1.01)).is_none());
    assert!(levels.proves_definite(&of(1.5)).is_none());
}
