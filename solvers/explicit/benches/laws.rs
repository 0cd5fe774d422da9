//! Benchmark of internal forces for every law relative to the neo-Hookean law, on one thread, with one group
//! for each kernel and one entry for each law. At the end, `cargo bench` prints the ratios again from turns
//! that take the laws one after the other. These are the ratios to read on a machine that is not idle.
//!
//! The table gives the floating-point operations per point in vector instructions (a fused product counts
//! once), counted in the source of the law alone. It also gives the measured time of the whole kernel
//! relative to the neo-Hookean law at strains near 0.1, AVX2 / AVX-512 (Intel family 6, model 167, 2 shared
//! cores, one thread, in cache):
//!
//! | law | instructions | tet4 | tet4 nodal | hex8 | hex8 mean | rows |
//! |---|---|---|---|---|---|---|
//! | neo-Hookean, ns | 55 | 10.8 / 10.8 | 21.6 / 19.9 | 67 / 53 | 80 / 59 | 63 / 61 |
//! | linear | 10 | 0.79 / 0.73 | - | 0.85 / 0.88 | - | 1.01 / 1.02 |
//! | St. Venant-Kirchhoff | 60 | 0.90 / 0.78 | - | 0.99 / 0.97 | - | 1.04 / 1.02 |
//! | isochoric neo-Hookean | 85 | 1.12 / 0.90 | 1.09 / 1.00 | 1.20 / 1.15 | 1.15 / 1.12 | 1.06 / 1.06 |
//! | Mooney-Rivlin | 130 | 1.39 / 1.03 | 1.23 / 1.08 | 1.54 / 1.35 | 1.40 / 1.32 | 1.10 / 1.08 |
//! | Hencky | 165 | 1.41 / 1.08 | 1.21 / 1.07 | 1.58 / 1.52 | 1.38 / 1.31 | 1.10 / 1.09 |
//! | Ogden, three terms | 190 | 1.58 / 1.14 | 1.33 / 1.15 | 1.70 / 1.60 | 1.63 / 1.52 | 1.12 / 1.10 |
//!
//! The bound of Ogden's law on hex8 in AVX2: 8 points x 190 instructions on 4 lanes at two per cycle of some
//! 3.5 GHz take 54 ns per element, in addition to the 55 ns of the kernel with the linear law. This is 1.63
//! of the neo-Hookean time. Bytes are those of the kernel, whatever the law (see the benchmark `explicit`).
//!
//! A whole step of a run (`element-step` of a block of 18^3 hex8 or 10^3 cells of tet4, one thread, medians
//! of ten and three) includes gather, update and energies. The time with Ogden's law relative to the
//! neo-Hookean law, AVX2 / AVX-512, is: hex8 1.60 (148 over 92 ns) / 1.47 (115 over 78), hex8 mean 1.52 /
//! 1.42, tet4 1.48 / 1.13.

mod common;

use std::time::{Duration, Instant};

use common::{cloud, solid};
use criterion::{Criterion, Throughput};
use geometry::CellKind;
use lanes::LanePath;
use material::Law;
use shape::{DilationGroups, Vector3, VolumeRows};
use tissuebench_explicit::{ExplicitBody, InternalForce, Kernel};

/// Number of turns of the final table; the shortest time counts.
const TURNS: usize = 60;
/// Number of evaluations of one law in each turn.
const IN_TURN: usize = 4;

/// Returns all laws, the neo-Hookean law first.
fn laws() -> Vec<Law> {
    let mut laws = Law::all(20e3, 0.495).unwrap();
    laws.sort_by_key(|law| !matches!(law, Law::NeoHookean(_)));
    laws
}

/// One table for each kernel.
struct Bodies {
    tet4: (VolumeRows, DilationGroups, Vec<Vector3>),
    hex8: (VolumeRows, DilationGroups, Vec<Vector3>),
    rows: (VolumeRows, Vec<Vector3>),
}

impl Bodies {
    fn new() -> Bodies {
        Bodies { tet4: solid(CellKind::Tet4, 10), hex8: solid(CellKind::Hex8, 18), rows: cloud(6, 28) }
    }

    /// Returns volume, groups, displacements and points per item.
    fn each(&self) -> [(&VolumeRows, Option<&DilationGroups>, &[Vector3], usize); 5] {
        let ((tet4, nodal, u), (hex8, mean, v), (rows, w)) = (&self.tet4, &self.hex8, &self.rows);
        [
            (tet4, None, u, 1),
            (tet4, Some(nodal), u, 1),
            (hex8, None, v, 8),
            (hex8, Some(mean), v, 8),
            (rows, None, w, 1),
        ]
    }
}

/// Returns the kernels of one table with each law, without laws that need the plain loop.
fn forces<'a>(
    laws: &'a [Law],
    (volume, groups): (&'a VolumeRows, Option<&'a DilationGroups>),
    path: LanePath,
) -> Vec<(&'a str, InternalForce<'a>)> {
    let force = |law: &'a Law| {
        let body = ExplicitBody { volume, laws: std::slice::from_ref(law), region: &[], axes: &[], groups };
        (law.name(), InternalForce::new(body, path).unwrap())
    };
    laws.iter().map(force).filter(|(_, force)| force.info().kernel.is_parallel()).collect()
}

fn kernel_of(forces: &[(&str, InternalForce)]) -> Kernel {
    forces[0].1.info().kernel
}

fn groups(c: &mut Criterion, laws: &[Law], bodies: &Bodies) {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for (volume, groups, u, per_item) in bodies.each() {
        let mut forces = forces(laws, (volume, groups), LanePath::best());
        let mut group = c.benchmark_group(format!("laws of {}", kernel_of(&forces).name()));
        group
            .sample_size(20)
            .measurement_time(Duration::from_secs(1))
            .warm_up_time(Duration::from_millis(300));
        group.throughput(Throughput::Elements((volume.weights().len() / per_item) as u64));
        let mut f = vec![Vector3::zeros(); u.len()];
        for (name, force) in &mut forces {
            group.bench_function(*name, |b| one.install(|| b.iter(|| force.evaluate(u, &mut f).unwrap())));
        }
        group.finish();
    }
}

/// Prints nanoseconds per element (per point for rows) and the ratio to the first law, for every kernel and
/// path.
fn table(laws: &[Law], bodies: &Bodies) {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for path in LanePath::available() {
        for (volume, groups, u, per_item) in bodies.each() {
            let mut forces = forces(laws, (volume, groups), path);
            let mut best = vec![f64::INFINITY; forces.len()];
            let mut f = vec![Vector3::zeros(); u.len()];
            for _ in 0..TURNS {
                for ((_, force), best) in forces.iter_mut().zip(&mut best) {
                    for _ in 0..IN_TURN {
                        let start = Instant::now();
                        one.install(|| force.evaluate(u, &mut f).unwrap());
                        *best = best.min(start.elapsed().as_secs_f64());
                    }
                }
            }
            println!("{}, {}:", path.name(), kernel_of(&forces).name());
            for ((name, _), time) in forces.iter().zip(&best) {
                let each = time * 1e9 * per_item as f64 / volume.weights().len() as f64;
                println!("  {name:24} {each:7.1} ns {:6.2}", time / best[0]);
            }
        }
    }
}

fn main() {
    let laws = laws();
    let bodies = Bodies::new();
    let mut criterion = Criterion::default().configure_from_args();
    groups(&mut criterion, &laws, &bodies);
    criterion.final_summary();
    // Without `--bench` the benchmark runs as a test.
    if std::env::args().any(|argument| argument == "--bench") {
        table(&laws, &bodies);
    }
}
