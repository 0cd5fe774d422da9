//! Artificial times with the noise of a busy machine, and tests that only real changes are reported.
use crate::blank::Blank as _;

use super::*;

/// Pseudo-random numbers in (0, 1) from a seed (SplitMix64).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64 + 1e-17
    }

    /// Student's t with three degrees of freedom, whose tails are like those of times on a busy machine.
    fn noise(&mut self) -> f64 {
        let mut normal =
            || (-2.0 * self.unit().ln()).sqrt() * (2.0 * std::f64::consts::PI * self.unit()).cos();
        let squares: f64 = (0..3).map(|_| normal().powi(2)).sum();
        normal() / (squares / 3.0).sqrt()
    }
}

const METHODS: [&str; 9] =
    ["tet4", "tet4-mean", "tet10", "hex8", "hex8-mean", "hex20", "efg", "efg-83", "mixed"];
const PHASES: [&str; 4] = ["prepare", "assemble", "factor", "solve"];

/// Results of three cases with nine methods on two levels. Times have a drift of 1.5 %, a scatter of 3 % of
/// each run and of each phase, and of 2 % of each of three repeats. `slower` returns a factor for a case,
/// method and phase.
fn results(seed: u64, slower: impl Fn(&str, &str, &str) -> f64) -> RunSet {
    let mut random = Random(seed);
    let mut records = Vec::new();
    let drift = 0.015 * random.noise().clamp(-2.0, 2.0);
    for (case, method, level) in ["beam", "sphere", "patch"]
        .iter()
        .flat_map(|c| METHODS.iter().flat_map(move |m| [(c, m, 1u32), (c, m, 2)]))
    {
        let of_run = drift + 0.03 * random.noise();
        let mut totals = [0.0; 3];
        for (order, phase) in PHASES.iter().enumerate() {
            let base = 3e-3 * 7f64.powi(level as i32) * (1.0 + order as f64) * slower(case, method, phase);
            let of_phase = of_run + 0.03 * random.noise();
            for (repeat, total) in totals.iter_mut().enumerate() {
                let seconds = base * (of_phase + 0.02 * random.noise().abs()).exp();
                *total += seconds;
                records.push(record(case, method, level, phase, repeat, seconds));
            }
        }
        for (repeat, total) in totals.into_iter().enumerate() {
            records.push(record(case, method, level, "total", repeat, total));
        }
    }
    RunSet { records, ..RunSet::default() }
}

fn record(case: &str, method: &str, level: u32, phase: &str, repeat: usize, value: f64) -> Record {
    Record {
        run: format!("{case} {method} {level}"),
        case: case.into(),
        method: method.into(),
        level,
        quantity: "cpu-time".into(),
        phase: phase.into(),
        statistic: "repeat".into(),
        repeat: Some(repeat as u64 + 1),
        value,
        ..Record::blank()
    }
}

fn same(_: &str, _: &str, _: &str) -> f64 {
    1.0
}

#[test]
fn of_a_hundred_metrics_at_most_one_is_called_by_mistake() {
    let runs: Vec<RunSet> = (1..=20).map(|seed| results(seed, same)).collect();
    for pairs in [1, 2, 5] {
        let (mut called, mut tested, mut wholes) = (0, 0, 0);
        for chosen in runs.windows(2 * pairs) {
            let pairs: Vec<(RunSet, RunSet)> =
                chosen.chunks(2).map(|two| (two[0].clone(), two[1].clone())).collect();
            let times = Times::of(&pairs);
            called += times.called.len();
            tested += times.tested + times.groups.len() + 1;
            wholes += usize::from(times.whole.unwrap().called);
        }
        assert!(tested > 2000 && 100 * called <= tested, "{called} of {tested} with {pairs} pairs");
        // One in forty, of 19, 17 and 11 comparisons that share results.
        assert!(wholes <= 2, "{wholes}");
    }
}

#[test]
fn a_tenth_slower_is_called() {
    let slow = |of: fn(&str, &str, &str) -> bool| {
        move |case: &str, method: &str, phase: &str| if of(case, method, phase) { 1.1 } else { 1.0 }
    };
    let found = |pairs: u64, of: fn(&str, &str, &str) -> bool, scope: Scope, name: &str| -> bool {
        let one = |pair: u64| (results(100 + pair, same), results(200 + pair, slow(of)));
        let times = Times::of(&(0..pairs).map(one).collect::<Vec<_>>());
        let named = |r: &&Ratio| r.scope == scope && r.name == name;
        times.called.iter().find(named).is_some_and(|r| (r.ratio - 1.1).abs() < 0.05)
    };
    assert!(found(2, |_, _, _| true, Scope::Whole, "all runs"));
    assert!(found(1, |_, _, phase| phase == "factor", Scope::Phase, "factor"));
    assert!(found(5, |_, method, _| method == "hex8", Scope::Method, "hex8"));
    assert!(found(2, |case, _, _| case == "beam", Scope::Case, "beam"));
    assert!(!found(2, |_, _, _| false, Scope::Whole, "all runs"));
}

#[test]
fn one_phase_of_one_run_that_takes_twice_as_long_is_called() {
    let twice = |case: &str, method: &str, phase: &str| {
        if (case, method, phase) == ("beam", "tet10", "solve") { 2.0 } else { 1.0 }
    };
    let times = Times::of(&[(results(1, same), results(2, twice))]);
    let named = |r: &&Ratio| r.scope == Scope::Run && r.name.starts_with("beam tet10 level");
    assert_eq!(times.called.iter().filter(named).filter(|r| r.ratio > 1.5).count(), 2, "{:?}", times.called);
}

/// The shortest repeat takes twice as long, but no longer than the longest before, as another program may
/// cause.
#[test]
fn repeats_that_overlap_are_not_called() {
    let with = |seed: u64, times: [f64; 3]| {
        let mut set = results(seed, same);
        let of_phase = |r: &&mut Record| r.run == "beam tet10 2" && r.phase == "solve";
        set.records.iter_mut().filter(of_phase).zip(times).for_each(|(r, time)| r.value = time);
        set
    };
    let called = |after: [f64; 3]| {
        let times = Times::of(&[(with(1, [0.1, 0.3, 0.3]), with(2, after))]);
        let of_phase = |r: &&Ratio| r.scope == Scope::Run && r.name.starts_with("beam tet10 level 2 ");
        times.called.iter().filter(of_phase).filter(|r| r.name.ends_with("solve")).count()
    };
    assert_eq!((called([0.2, 0.22, 0.24]), called([0.4, 0.42, 0.44])), (0, 1));
}

/// A single other program can disturb all of three repeats of 2 ms.
#[test]
fn of_one_pair_a_short_phase_is_not_called_by_itself() {
    let short = |mut set: RunSet| {
        set.records.iter_mut().for_each(|r| r.value *= 0.03);
        set
    };
    let twice = |case: &str, method: &str, phase: &str| {
        if (case, method, phase) == ("beam", "tet10", "solve") { 2.0 } else { 1.0 }
    };
    let pair = |seed: u64| (short(results(seed, same)), short(results(seed + 1, twice)));
    let named = |r: &&Ratio| r.scope == Scope::Run && r.name.starts_with("beam tet10 level 1");
    let called = |pairs: &[(RunSet, RunSet)]| Times::of(pairs).called.iter().filter(named).count();
    assert_eq!(called(&[pair(1)]), 0);
    assert!(called(&[pair(1), pair(3)]) >= 1);
}

#[test]
fn few_runs_and_runs_of_one_side_say_nothing() {
    let set = results(1, same);
    let few = RunSet { records: set.records[..20].to_vec(), ..RunSet::default() };
    let times = Times::of(&[(set, few)]);
    assert!(times.whole.is_none() && times.called.is_empty() && times.runs < FEWEST);
    assert_eq!(Times::of(&[]).runs, 0);
}
