//! Shape functions: moving least squares with gradients per point, compared with a plain loop over dynamic
//! matrices, and the whole preparation of a kidney-sized cloud.
//!
//! The estimates per point assume eight points in parallel in registers and separate multiplication and
//! addition (no fused products: the bits are the same on every path). A quotient or square root counts as one
//! operation. 30 Gflop/s are one operation on eight numbers per cycle at 3.7 GHz:
//!
//! | basis, neighbours | flops | bytes read and written | arithmetic at 30 Gflop/s | memory at 20 GB/s |
//! |---|---|---|---|---|
//! | linear, 24 | 2 900 | 1 700 | 0.10 us | 0.09 us |
//! | quadratic, 35 | 10 900 | 3 500 | 0.36 us | 0.18 us |
//!
//! The flops of the linear basis are 24 x 112 for the neighbours and 220 for factors and condition; those of
//! the quadratic basis are 35 x 240 and 2 500. The bytes of the linear basis are 32 per candidate of 50 and
//! 36 per entry.
//!
//! Medians measured at 2.6 GHz on a busy machine are 0.38 us (linear) and 0.90 us (quadratic), 4 and 2.5
//! times the arithmetic. They are 10 and 12 times less than the plain loop, which does no search. For the
//! linear point about a quarter is the search, which keeps every second candidate. Another quarter is the
//! transfer of neighbours into lanes and of values out of lanes, one number at a time. Passing such a batch
//! to the pool and waiting would take 0.6 us per point, so the batch stays on the calling thread. The
//! preparation of a run on 83 nodes takes two threads 2.7 ms (6144 points, 29 neighbours).
//!
//! Maximum-entropy functions take 4.8 us at 89 neighbours (gamma = 1.8) and 2.9 us at 27 (gamma = 4),
//! compared with 0.38 us for the linear point at 24. This is 54 ns per neighbour instead of 16, because every
//! step of Newton's method visits all neighbours.
//!
//! Not covered: search structures of millions of nodes, other kernels.

use std::hint::black_box;

use criterion::{Bencher, Criterion, Throughput, criterion_group, criterion_main};
use geometry::generate::kidney_mesh;
use geometry::{CellKind, Kidney, cloud};
use nalgebra::{DMatrix, DVector};
use shape::{Point3, Vector3};
use tissuebench_efg::{
    Approximation, Basis, CubicSpline, Kernel, Smoothing, Support, gauss_rows, node_smoothed_rows,
    smoothed_rows,
};

const KERNEL: Kernel = Kernel::CubicSpline(CubicSpline);

/// Number of points per measurement: one parallel task, so that a single thread works.
const POINTS: usize = 128;

/// A lattice of 12^3 nodes with inner points, at which the mean number of neighbours is close to `wanted`.
fn lattice(wanted: usize, basis: Basis) -> (Approximation, Vec<Point3>) {
    let n = 12;
    let node = |i: usize| Point3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64) * 0.01;
    let nodes: Vec<Point3> = (0..n * n * n).map(node).collect();
    let radius = 0.01 * (wanted as f64 * 3.0 / (4.0 * std::f64::consts::PI)).cbrt();
    let radii = vec![radius; nodes.len()];
    // Low-discrepancy points: multiples of irrational steps.
    let at = |q: usize, step: f64| 0.03 + 0.05 * (q as f64 * step).fract();
    let points =
        (1..=POINTS).map(|q| Point3::new(at(q, 0.8191725), at(q, 0.6710436), at(q, 0.5497005))).collect();
    (Approximation::new(nodes, radii, KERNEL, basis).unwrap(), points)
}

/// Reference implementation with dynamic matrices, moment derivatives as matrices, and one LU factorisation
/// per point. The neighbours are known beforehand.
fn textbook(
    mls: &Approximation,
    basis: Basis,
    x: &Point3,
    neighbours: &[u32],
    values: &mut Vec<f64>,
    grads: &mut Vec<Vector3>,
) {
    let m = basis.terms();
    let s = mls.radius(neighbours[0] as usize);
    let terms = |p: &Point3| {
        let d = (p - x) / s;
        let all = [1.0, d.x, d.y, d.z, d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.y * d.z, d.z * d.x];
        DVector::from_column_slice(&all[..m])
    };
    let mut a = DMatrix::zeros(m, m);
    let mut da = [DMatrix::zeros(m, m), DMatrix::zeros(m, m), DMatrix::zeros(m, m)];
    let mut list = Vec::with_capacity(neighbours.len());
    for &node in neighbours {
        let p = &mls.nodes()[node as usize];
        let r = x - p;
        let radius = mls.radius(node as usize);
        let d = r.norm();
        let (w, slope) = KERNEL.eval(d / radius);
        let dw = if d > 0.0 { r * (slope / (d * radius)) } else { Vector3::zeros() };
        let t = terms(p);
        let outer = &t * t.transpose();
        a += &outer * w;
        for axis in 0..3 {
            da[axis] += &outer * dw[axis];
        }
        list.push((t, w, dw));
    }
    let lu = a.lu();
    let solve = |b: DVector<f64>| lu.solve(&b).expect("well determined");
    let unit = |i: usize, v: f64| DVector::from_fn(m, |k, _| if k == i { v } else { 0.0 });
    let c = solve(unit(0, 1.0));
    let dc: Vec<DVector<f64>> = (0..3).map(|axis| solve(unit(axis + 1, 1.0 / s) - &da[axis] * &c)).collect();
    for (t, w, dw) in list {
        let fit = c.dot(&t);
        values.push(w * fit);
        grads.push(Vector3::from_fn(|axis, _| w * dc[axis].dot(&t) + dw[axis] * fit));
    }
}

fn points(criterion: &mut Criterion) {
    for (basis, wanted) in [(Basis::Linear, 24), (Basis::Quadratic, 35)] {
        let (mls, points) = lattice(wanted, basis);
        let (rows, info) = mls.grad_rows(&points).unwrap();
        assert_eq!(info.fallbacks(), 0, "{info:?}");
        let mut group =
            criterion.benchmark_group(format!("mls-{}-{:.1}-neighbours", basis.name(), info.neighbours_mean));
        group.throughput(Throughput::Elements(POINTS as u64));
        let (mut values, mut grads) = (Vec::new(), Vec::new());
        let all = |values: &mut Vec<f64>, grads: &mut Vec<Vector3>| {
            values.clear();
            grads.clear();
            for (q, x) in points.iter().enumerate() {
                textbook(&mls, basis, x, rows.rows().row(q).0, values, grads);
            }
        };
        all(&mut values, &mut grads);
        // Both must compute the same values, otherwise the comparison is meaningless.
        let off = values.iter().zip(rows.rows().values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let steep = grads.iter().zip(rows.grads()).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(off < 1e-11 && steep < 1e-8, "{off:e} {steep:e}");
        group.bench_function("dynamic-matrices-without-search", |b| b.iter(|| all(&mut values, &mut grads)));
        group.bench_function("search-shape-gradient", |b| {
            b.iter(|| mls.grad_rows(black_box(&points)).unwrap())
        });
        group.finish();
    }
}

/// Maximum-entropy functions at the same points.
fn entropy(criterion: &mut Criterion) {
    let (mls, points) = lattice(24, Basis::Linear);
    for gamma in [1.8, 4.0] {
        let spacing = vec![0.01; mls.nodes().len()];
        let functions = Approximation::maximum_entropy(mls.nodes().to_vec(), &spacing, gamma).unwrap();
        let (_, info) = functions.grad_rows(&points).unwrap();
        let name = format!("maximum-entropy-{gamma}-{:.1}-neighbours", info.neighbours_mean);
        let mut group = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements(POINTS as u64));
        group.bench_function("search-shape-gradient", |b| {
            b.iter(|| functions.grad_rows(black_box(&points)).unwrap())
        });
        group.finish();
    }
}

/// Measures on a thread of the pool, as in a run.
fn on_pool<T>(bencher: &mut Bencher, make: impl Fn() -> T + Send + Sync) {
    rayon::scope(|_| bencher.iter(make));
}

/// Preparation of a run on 83 nodes, with the kidney divided into 1536 cells.
fn prepare(criterion: &mut Criterion) {
    let background = kidney_mesh(CellKind::Tet4, 4).unwrap();
    let cloud = cloud(&Kidney, 83, 1, &[]).unwrap();
    let make = || {
        let radii = Support::Dilatation { factor: 1.6 }.radii(&cloud.points, &cloud.spacing).unwrap();
        Approximation::new(cloud.points.clone(), radii, Kernel::CubicSpline(CubicSpline), Basis::Linear)
            .unwrap()
    };
    let name = format!("prepare-{}-nodes-{}-cells", cloud.points.len(), background.cell_count());
    let mut group = criterion.benchmark_group(name);
    group.bench_function("supports-and-buckets", |b| on_pool(b, make));
    group.bench_function("gauss-4", |b| on_pool(b, || gauss_rows(&make(), &background, 4).unwrap()));
    group.bench_function("cell-smoothed", |b| {
        on_pool(b, || smoothed_rows(&make(), &background, Smoothing::Constant, 1).unwrap())
    });
    group.bench_function("cell-smoothed-order-2", |b| {
        on_pool(b, || smoothed_rows(&make(), &background, Smoothing::Linear, 6).unwrap())
    });
    group.bench_function("node-smoothed-stabilised", |b| {
        on_pool(b, || node_smoothed_rows(&make(), &background, 0.05, 1).unwrap())
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).measurement_time(std::time::Duration::from_secs(2)).warm_up_time(std::time::Duration::from_millis(500));
    targets = points, entropy, prepare
}
criterion_main!(benches);
