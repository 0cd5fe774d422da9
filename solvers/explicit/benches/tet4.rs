//! Benchmark of the tetrahedron with four nodes: in cache relative to its own arithmetic, out of cache
//! relative to in cache, and a whole step of the published ramp relative to its internal forces.
//!
//! Everything runs on one thread. Ratios are taken within turns that process everything one after the other.
//! Only such ratios are meaningful on a machine that is not idle, so this is a plain program without
//! criterion.
//!
//! *The arithmetic alone* does the work of the kernel on eight elements (gradient, invariants, neo-Hookean
//! law, stress, forces of four nodes, in the same three passes). It reads 16 blocks in the first-level cache
//! and writes there, 26 KB in and 12 KB out. It reads and writes no node, and keeps nothing in registers that
//! the kernel has to load.
//!
//! Measured on AVX-512 of AMD family 26 (Zen 5, 4.1 GHz, 1 MB and 32 MB of cache, two cores, both busy with
//! other work), best of 60 turns:
//!
//! | | ns per element | ratio |
//! |---|---|---|
//! | arithmetic alone | 2.45 | |
//! | 6,000 elements, in cache | 4.75 | 1.95 of the arithmetic |
//! | 105,456 elements, 9 MB | 5.5 to 5.9 | 1.15 to 1.25 of those in cache |
//! | 1,296,000 elements, 114 MB | 9 to 13 (memory shared with others) | 1.8 to 2.8 |
//! | step of the ramp | 6.1 | 1.23 of its internal forces |
//!
//! Limits, in cycles per block of eight elements. Measured throughputs per cycle: products 2, sums 2,
//! shuffles across 128 bits 2, any four of them together 4; loads of 64 bytes 2, stores of 64 bytes 1.
//!
//! | | products | sums | shuffles | instructions | at best | measured |
//! |---|---|---|---|---|---|---|
//! | arithmetic alone | 116 | 42 | 0 | 256 | 58 (products) | 80 |
//! | kernel | 116 | 80 | 112 | 596 | 84 (all vector units) | 141 |
//!
//! Gather and scatter of 32 nodes add 150 vector instructions to the 170 of the arithmetic. With all units
//! always busy the kernel would take 1.45 times the 58 cycles of the products. It comes as near to its bound
//! (1.7) as such code does (1.4 without nodes). Copying displacements to the chunks and summing their copies
//! takes 12 % more. A factor of 1.6 over the arithmetic would be 113 cycles for the kernel.
//!
//! Variants without gain, as ratios of the time in cache:
//!
//! - node numbers multiplied beforehand, 64 instructions less (0.98);
//! - scatter in a fourth pass (1.03), or by permutations of two registers (1.02);
//! - passes of eight blocks (1.0);
//! - chunks of 512, 1024, 1536, 3072 elements (1.13, 1.06, 1.03, 1.0);
//! - patches of the six elements of a cut cell, whose eight nodes are read once and added to once, from and
//!   to scratch (1.0: a fifth fewer instructions, which are not the bottleneck).
//!
//! The sum of a node that waits for the previous sum costs 0.07. Out of cache: displacements in scratch
//! memory of a thread (1.0), prefetching the nodes of the next chunk (1.0).
//!
//! Memory: an element takes 88 bytes and some 56 for its part of the nodes, and one core reads 37 GB/s: 2.4 +
//! 1.5 ns. The former is hidden behind the arithmetic, because blocks are prefetched. Internal forces take
//! 0.81 of the step. Contact took 0.33 of the step until its search kept lists of points from step to step;
//! the step then took 1.63 of its forces. At the end of the ramp, with twice as many points in contact, the
//! step takes 1.3 of its forces.

mod common;
mod ramp;

use std::hint::black_box;
use std::time::Instant;

use common::solid;
use geometry::CellKind;
use lanes::{LANES, LanePath, Lanes, madd, on_path};
use material::lane::LaneStrain;
use material::lane::invariants::piola;
use material::{Law, Material, NeoHookean};
use rayon::ThreadPoolBuilder;
use shape::Vector3;
use tissuebench_explicit::{ExplicitBody, InternalForce};

/// Number of turns, each of which takes one time of everything.
const TURNS: usize = 60;
/// Number of blocks of the arithmetic alone.
const BLOCKS: usize = 16;
/// Number of blocks that go through a pass together, as in the kernel.
const TOGETHER: usize = 4;
/// Cells along an edge of the cubes, of six elements each: in the second-level cache, in the third-level
/// cache, in memory.
const CELLS: [usize; 3] = [10, 26, 60];

#[repr(align(64))]
struct Block {
    /// Displacements of nodes 1 to 3 relative to node 0.
    d: [Lanes; 9],
    grads: [Lanes; 9],
    weight: Lanes,
}

impl Block {
    /// Fills a block with numbers of realistic size.
    fn new(block: usize) -> Block {
        let wave = |k: usize| std::array::from_fn(|l| ((97 * block + 13 * k + l) as f64).sin());
        let scaled = |k: usize, by: f64| wave(k).map(|x: f64| by * x);
        Block {
            d: std::array::from_fn(|k| scaled(k, 1e-4)),
            grads: std::array::from_fn(|k| scaled(k, 250.0)),
            weight: [1e-9; LANES],
        }
    }
}

#[repr(align(64))]
struct Forces([Lanes; 12]);

#[repr(align(64))]
struct Coefficients([Lanes; 3]);

on_path! {
    fn arithmetic(blocks: &[Block], moduli: [f64; 2], out: &mut [Forces], good: &mut Lanes) = arithmetic_lanes
}

#[inline(always)]
fn arithmetic_lanes<const FMA: bool>(
    blocks: &[Block],
    moduli: [f64; 2],
    out: &mut [Forces],
    good: &mut Lanes,
) {
    let mut x = [LaneStrain::ZERO; TOGETHER];
    let mut c = [const { Coefficients([[0.0; LANES]; 3]) }; TOGETHER];
    for (blocks, out) in blocks.chunks(TOGETHER).zip(out.chunks_mut(TOGETHER)) {
        for (block, x) in blocks.iter().zip(&mut x) {
            strain::<FMA>(block, x);
            x.check(good);
        }
        for ((block, x), c) in blocks.iter().zip(&x).zip(&mut c) {
            law::<FMA>(&block.weight, x, moduli, &mut c.0);
        }
        for (((block, x), c), out) in blocks.iter().zip(&x).zip(&c).zip(out) {
            forces::<FMA>(block, x, &c.0, &mut out.0);
        }
    }
}

#[inline(always)]
fn strain<const FMA: bool>(Block { d, grads: g, .. }: &Block, out: &mut LaneStrain) {
    let m = madd::<FMA>;
    for l in 0..LANES {
        let mut h = [0.0; 9];
        for k in 0..9 {
            let (i, j) = (k / 3, k % 3);
            h[k] = m(d[i][l], g[j][l], m(d[3 + i][l], g[3 + j][l], d[6 + i][l] * g[6 + j][l]));
        }
        out.set::<FMA>(l, &h);
    }
}

#[inline(always)]
fn law<const FMA: bool>(weight: &Lanes, x: &LaneStrain, [mu, lambda]: [f64; 2], out: &mut [Lanes; 3]) {
    for l in 0..LANES {
        let c = x.invariants(l).0.stress::<FMA>(weight[l], mu, lambda);
        (out[0][l], out[1][l], out[2][l]) = (c[0], c[1], c[2]);
    }
}

#[inline(always)]
fn forces<const FMA: bool>(block: &Block, x: &LaneStrain, c: &[Lanes; 3], out: &mut [Lanes; 12]) {
    let (m, g) = (madd::<FMA>, &block.grads);
    for l in 0..LANES {
        let p = piola::<FMA, _>(&x.lane(l), x.invariants(l).1, [c[0][l], c[1][l], c[2][l]]);
        for i in 0..3 {
            let row = |a: usize| {
                m(p[3 * i], g[3 * a][l], m(p[3 * i + 1], g[3 * a + 1][l], p[3 * i + 2] * g[3 * a + 2][l]))
            };
            let (x, y, z) = (row(0), row(1), row(2));
            (out[i][l], out[3 + i][l], out[6 + i][l], out[9 + i][l]) = (x, y, z, -x - y - z);
        }
    }
}

on_path! {
    fn sum(x: &[f64]) -> f64 = sum_lanes
}

#[inline(always)]
fn sum_lanes<const FMA: bool>(x: &[f64]) -> f64 {
    let mut sums = [[0.0; LANES]; 4];
    for x in x.as_chunks::<{ 4 * LANES }>().0 {
        for k in 0..4 {
            for l in 0..LANES {
                sums[k][l] += x[LANES * k + l];
            }
        }
    }
    sums.iter().flatten().sum()
}

/// Returns the nanoseconds per item when `work` is repeated `times` times, after one run without a clock.
fn time(items: usize, times: usize, mut work: impl FnMut()) -> f64 {
    work();
    let start = Instant::now();
    for _ in 0..times {
        work();
    }
    start.elapsed().as_secs_f64() * 1e9 / (items * times) as f64
}

/// Times of one quantity, one from each turn.
#[derive(Default)]
struct Times(Vec<f64>);

impl Times {
    fn best_and_median(&self) -> [f64; 2] {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        [sorted[0], sorted[sorted.len() / 2]]
    }

    fn print(&self, name: &str, over: Option<(&str, &Times)>) {
        let [best, median] = self.best_and_median();
        print!("{name:34} best {best:6.2} ns, median {median:6.2} ns");
        if let Some((what, other)) = over {
            let ratios = Times(self.0.iter().zip(&other.0).map(|(a, b)| a / b).collect());
            let [_, ratio] = ratios.best_and_median();
            print!("; {what} best {:.2}, median {ratio:.2}", best / other.best_and_median()[0]);
        }
        println!();
    }
}

fn main() {
    // Without `--bench` the benchmark runs as a test.
    let turns = if std::env::args().any(|argument| argument == "--bench") { TURNS } else { 1 };
    let path = LanePath::best();
    let pools = [1, 2].map(|n| ThreadPoolBuilder::new().num_threads(n).build().unwrap());
    let neo_hookean = NeoHookean::new(20e3, 0.495).unwrap();
    let moduli = [neo_hookean.mu(), neo_hookean.lambda()];
    let laws = [Law::NeoHookean(neo_hookean)];

    let blocks: Vec<Block> = (0..BLOCKS).map(Block::new).collect();
    let mut out: Vec<Forces> = (0..BLOCKS).map(|_| Forces([[0.0; LANES]; 12])).collect();
    let mut good = [1.0; LANES];
    let solids = CELLS.map(|cells| solid(CellKind::Tet4, cells));
    let mut cubes = [0, 1, 2].map(|k| {
        let (volume, _, u) = &solids[k];
        let body = ExplicitBody { volume, laws: &laws, region: &[], axes: &[], groups: None };
        let bytes = vec![1.0; 11 * volume.weights().len()];
        (InternalForce::new(body, path).unwrap(), u, vec![Vector3::zeros(); u.len()], bytes)
    });
    let ramp = ramp::Body::new();
    let (mut force, mut other) = (ramp.force(&laws), ramp.force(&laws));
    let (prescribed, contact) = (ramp.prescribed(), ramp.contact());
    let mut motion = ramp.motion(&mut force, &prescribed, &contact);

    let mut alone = Times::default();
    let [mut one, mut two, mut read] = [(); 3].map(|()| [(); 3].map(|()| Times::default()));
    let [mut step, mut kernel] = [(); 2].map(|()| Times::default());
    let mut none = |_: f64, _: &[Vector3], _: &[Vector3], _: &mut [Vector3]| ();
    // Steps until the jaws touch with some force.
    pools[0].install(|| motion.run(50 * turns, 0, &mut none, &mut |_, _| ()).unwrap());
    for _ in 0..turns {
        alone.0.push(time(BLOCKS * LANES, 200, || {
            arithmetic(path, black_box(&blocks), moduli, black_box(&mut out), &mut good);
        }));
        for (k, (force, u, f, bytes)) in cubes.iter_mut().enumerate() {
            let items = bytes.len() / 11;
            let times = (20_000 / items).max(1);
            for (pool, to) in pools.iter().zip([&mut one[k], &mut two[k]]) {
                to.0.push(pool.install(|| time(items, times, || force.evaluate(u, f).unwrap())));
            }
            read[k].0.push(time(items, times, || {
                black_box(sum(path, bytes));
            }));
        }
        pools[0].install(|| {
            step.0.push(time(ramp.elements(), 20, || motion.run(1, 0, &mut none, &mut |_, _| ()).unwrap()));
            let (u, mut f) = (motion.displacements(), vec![Vector3::zeros(); ramp.nodes()]);
            kernel.0.push(time(ramp.elements(), 20, || other.evaluate(u, &mut f).unwrap()));
        });
    }
    assert!(good == [1.0; LANES] && out.iter().all(|f| f.0.as_flattened().iter().all(|f| f.is_finite())));
    alone.print("arithmetic alone", None);
    one[0].print("6,000 elements, in cache", Some(("over the arithmetic", &alone)));
    for (k, name) in [(1, "105,456 elements"), (2, "1,296,000 elements")] {
        one[k].print(name, Some(("over in cache", &one[0])));
    }
    for (k, name) in ["6,000", "105,456", "1,296,000"].into_iter().enumerate() {
        two[k].print(&format!("{name}, two threads"), Some(("over one", &one[k])));
        read[k].print(&format!("{name}, their bytes read"), None);
    }
    kernel.print("internal forces of the ramp", None);
    step.print("step of the ramp", Some(("over its forces", &kernel)));
}
