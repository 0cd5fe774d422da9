//! `tissuebench compare`: compares results before and after a change.

use std::path::Path;

use records::RunSet;
use reports::compare::{Comparison, NumberChange, Numbers, Ratio, Scope, Times, across};

use super::args::{CompareArgs, Format};
use super::colour::{self, BAD, DOUBTFUL, GOOD};

/// Number of list entries printed; further ones are only counted.
const SHOWN: usize = 40;

/// Compares and prints. Returns 0 if nothing differs, 1 if anything differs, 2 if a folder cannot be
/// compared.
pub(super) fn compare(args: &CompareArgs) -> u8 {
    let pairs = match read(args) {
        Ok(pairs) => pairs,
        Err(bad) => {
            eprintln!("tissuebench: {bad}");
            return 2;
        }
    };
    let found = Comparison::of(&pairs, args.tolerance, !args.no_times);
    if found.numbers.compared == 0 && found.is_same() {
        eprintln!("tissuebench: nothing was compared: the results have no number in common");
        return 2;
    }
    match args.format {
        Format::Table => {
            numbers(&found.numbers);
            found.times.iter().for_each(times);
        }
        Format::Json => {
            println!("{}", serde_json::to_string_pretty(&found).expect("finite numbers and text"));
        }
    }
    u8::from(!found.is_same())
}

/// Reads the folders in pairs.
fn read(args: &CompareArgs) -> Result<Vec<(RunSet, RunSet)>, String> {
    if args.results.len() % 2 == 1 {
        let last = args.results.last().map_or(Path::new(""), |path| path.as_path());
        return Err(format!(
            "{}: has no counterpart; give pairs of results, before and after in turn",
            last.display()
        ));
    }
    if !(args.tolerance >= 0.0 && args.tolerance < 1.0) {
        return Err(format!(
            "--tolerance {}: is not a relative difference; give a number from 0 to below 1",
            args.tolerance
        ));
    }
    let one = |path: &Path| records::read_numbers(path, "compare").map_err(|bad| bad.to_string());
    let mut pairs: Vec<(RunSet, RunSet)> = args
        .results
        .chunks(2)
        .map(|two| Ok((one(&two[0])?, one(&two[1])?)))
        .collect::<Result<_, String>>()?;
    for ((before, after), two) in pairs.iter().zip(args.results.chunks(2)) {
        let (a, b) = (&before.provenance.source, &after.provenance.source);
        if a != b && !args.across.iter().any(|setting| setting == "case") {
            let [first, second] = [&two[0], &two[1]].map(|path| path.display());
            return Err(format!(
                "{first} holds the results of {a}, and {second} holds the results of {b}; compare results of one \
                 study, or results of two scenes with --across case"
            ));
        }
    }
    pairs.iter_mut().try_for_each(|pair| across(pair, &args.across))?;
    Ok(pairs)
}

fn numbers(found: &Numbers) {
    let Numbers { tolerance, compared, only_before, only_after, changes } = found;
    println!("numbers: {compared} compared, {} changed by more than {tolerance:e}", changes.len());
    for (runs, side) in [(only_before, "only before"), (only_after, "only after")] {
        shown(runs, |run| println!("  {}  {run}", colour::out(DOUBTFUL, side)));
    }
    shown(changes, |change| println!("{}", describe(change)));
}

fn describe(change: &NumberChange) -> String {
    let style = match change.verdict {
        "worse" => BAD,
        "better" => GOOD,
        _ => DOUBTFUL,
    };
    let value = |v: Option<f64>| v.map_or("none".into(), |v| format!("{v:.6e}"));
    format!(
        "  {}  {}\n           {}: {} -> {} ({:.1e})",
        colour::out(style, &format!("{:7}", change.verdict)),
        change.run,
        change.quantity,
        value(change.before),
        value(change.after),
        change.relative
    )
}

fn times(found: &Times) {
    let Some(whole) = &found.whole else {
        println!("times: {} runs in common, too few to compare", found.runs);
        return;
    };
    let pairs = if found.pairs == 1 { "one pair".into() } else { format!("{} pairs", found.pairs) };
    println!(
        "times: {} runs of {pairs} of results; {} phases and {} groups tested, {} outside noise",
        found.runs,
        found.tested,
        found.groups.len(),
        found.called.len()
    );
    println!("  {:8} {:32} {:>6} {:>8}  called beyond", "", "", "phases", "after/before");
    row(whole);
    found.groups.iter().for_each(row);
    let singles: Vec<&Ratio> = found.called.iter().filter(|ratio| ratio.scope == Scope::Run).collect();
    shown(&singles, |ratio| row(ratio));
    if whole.called && found.pairs == 1 {
        println!(
            "  one pair cannot distinguish a slower program from a slower machine; compare several pairs, run in turn"
        );
    }
}

fn row(ratio: &Ratio) {
    let scope = match ratio.scope {
        Scope::Whole => "whole",
        Scope::Phase => "phase",
        Scope::Case => "case",
        Scope::Method => "method",
        Scope::Run => "run",
    };
    let verdict = match (ratio.called, ratio.ratio > 1.0) {
        (false, _) => String::new(),
        (true, true) => format!("  {}", colour::out(BAD, "slower")),
        (true, false) => format!("  {}", colour::out(GOOD, "faster")),
    };
    let Ratio { name, count, ratio, limit, .. } = ratio;
    println!("  {scope:8} {name:32} {count:>6} {ratio:>12.3}  {:.3} to {limit:.3}{verdict}", 1.0 / limit);
}

/// Prints the first entries of a list and counts the rest.
fn shown<T>(list: &[T], print: impl Fn(&T)) {
    list.iter().take(SHOWN).for_each(print);
    if list.len() > SHOWN {
        println!("  ... and {} more", list.len() - SHOWN);
    }
}
