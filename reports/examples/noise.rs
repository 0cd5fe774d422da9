//! Error rate of `tissuebench compare` on this machine, from folders of results of one study, which was run
//! repeatedly. The folders are given in the order in which they were made.
//!
//! `cargo run --release --package tissuebench-reports --example noise -- FOLDER...`
//!
//! Neighbouring folders are compared, in one pair or in several pairs. They are compared unchanged, and with
//! 10 % added to the times of the second folder of each pair.

use std::path::PathBuf;

use records::{RunSet, read_run};
use tissuebench_reports::compare::{Comparison, Scope, Times};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folders: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let runs: Vec<RunSet> = folders.iter().map(|folder| read_run(folder)).collect::<Result<_, _>>()?;
    println!(
        "| pairs | comparisons | metrics | called by mistake | share | 10 % called, of all | of a phase |"
    );
    println!("| ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for pairs in [1, 2, 3, 5] {
        if runs.len() >= 2 * pairs {
            println!("{}", row(&runs, pairs));
        }
    }
    Ok(())
}

fn row(runs: &[RunSet], pairs: usize) -> String {
    let (mut tested, mut called, mut count, mut whole, mut phase) = (0, 0, 0, 0, 0);
    for chosen in runs.windows(2 * pairs) {
        let plain = times(chosen, |_| false);
        tested += plain.tested + plain.groups.len() + 1;
        called += plain.called.len();
        count += 1;
        let slower = |times: &Times, scope| times.called.iter().any(|r| r.scope == scope && r.ratio > 1.0);
        whole += usize::from(slower(&times(chosen, |_| true), Scope::Whole));
        phase += usize::from(slower(&times(chosen, |phase| phase == "solve"), Scope::Phase));
    }
    let share = 100.0 * called as f64 / tested as f64;
    format!(
        "| {pairs} | {count} | {tested} | {called} | {share:.2} % | {whole} of {count} | {phase} of {count} |"
    )
}

/// Comparison of the times of neighbouring folders, in pairs of before and after. Phases for which `slow` is
/// true take 10 % longer after.
fn times(chosen: &[RunSet], slow: impl Fn(&str) -> bool) -> Times {
    let longer = |set: &RunSet| {
        let mut set = RunSet { records: set.records.clone(), ..RunSet::default() };
        for record in &mut set.records {
            let time = record.quantity == "cpu-time" || record.quantity == "time" && record.step.is_none();
            if time && slow(&record.phase) {
                record.value *= 1.1;
            }
        }
        set
    };
    let pairs: Vec<(RunSet, RunSet)> =
        chosen.chunks(2).map(|two| (longer_not(&two[0]), longer(&two[1]))).collect();
    Comparison::of(&pairs, 1e-6, true).times.expect("asked for")
}

fn longer_not(set: &RunSet) -> RunSet {
    RunSet { records: set.records.clone(), ..RunSet::default() }
}
