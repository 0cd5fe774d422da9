//! `tissuebench baseline`: compares stored results with accepted ones.

use std::io::{BufRead, IsTerminal, Write};

use reports::ReportError;
use reports::baseline::{Baseline, Change, Comparison};

use crate::cli::args::BaselineArgs;
use crate::outcome::provenance::processor;

/// Number of differences printed; further ones are only counted.
const SHOWN: usize = 40;

/// Compares the results and accepts the selected differences. Returns the exit code: 0 if no difference is
/// left, 1 otherwise, 2 without accepted results.
pub fn baseline(args: &BaselineArgs) -> Result<u8, ReportError> {
    let now = Baseline::of(&records::read_numbers(&args.results, "compare")?.records, &processor());
    if !args.accepted.exists() {
        return first(args, &now);
    }
    let mut accepted = Baseline::load(&args.accepted)?;
    let found = accepted.compare(&now, !args.part);
    if found.compared == 0 && found.changes.is_empty() {
        eprintln!("tissuebench: {}: nothing was compared", args.accepted.display());
        return Ok(2);
    }
    println!(
        "{}: {} numbers compared, {}; {} differences",
        args.accepted.display(),
        found.compared,
        if found.bitwise { "bit by bit" } else { "within 1e-6, because the kind of processor differs" },
        found.changes.len()
    );
    let chosen = choose(&found, args);
    let left = found.changes.len() - chosen.len();
    if !chosen.is_empty() {
        if !found.bitwise && (left > 0 || args.part) {
            eprintln!(
                "tissuebench: {} comes from another kind of processor ({}): accept all differences or none",
                args.accepted.display(),
                accepted.processor
            );
            return Ok(1);
        }
        chosen.iter().for_each(|change| accepted.accept(change, &now));
        if found.bitwise { &accepted } else { &now }.save(&args.accepted)?;
        println!("accepted {}, not accepted {left}", chosen.len());
    }
    Ok(u8::from(left > 0))
}

/// Writes the folder of accepted results if all of them are accepted.
fn first(args: &BaselineArgs, now: &Baseline) -> Result<u8, ReportError> {
    if args.accept.as_deref() != Some("") {
        eprintln!("tissuebench: {} does not exist; `--accept` creates it", args.accepted.display());
        return Ok(2);
    }
    now.save(&args.accepted)?;
    println!("{}: {} numbers of {} runs", args.accepted.display(), now.count(), now.runs.len());
    Ok(0)
}

/// Prints the differences and returns the accepted ones, selected by `--accept` or one by one on a terminal.
fn choose<'a>(found: &'a Comparison, args: &BaselineArgs) -> Vec<&'a Change> {
    let ask = args.accept.is_none() && !args.check && std::io::stdin().is_terminal();
    if ask {
        return review(&found.changes);
    }
    for change in found.changes.iter().take(SHOWN) {
        println!("{}", describe(change));
    }
    if found.changes.len() > SHOWN {
        println!("... and {} more", found.changes.len() - SHOWN);
    }
    let accepted =
        |change: &&Change| args.accept.as_ref().is_some_and(|text| describe(change).contains(text));
    found.changes.iter().filter(accepted).collect()
}

/// Asks for each difference: yes, no, all remaining, or quit.
fn review(changes: &[Change]) -> Vec<&Change> {
    let mut chosen = Vec::new();
    let mut lines = std::io::stdin().lock().lines();
    for (index, change) in changes.iter().enumerate() {
        print!(
            "{}\n  [{} of {}] accept? (y)es, (n)o, (a)ll, (q)uit: ",
            describe(change),
            index + 1,
            changes.len()
        );
        let _ = std::io::stdout().flush();
        match lines.next().and_then(Result::ok).as_deref().map(str::trim) {
            Some("y") => chosen.push(change),
            Some("a") => {
                chosen.extend(&changes[index..]);
                break;
            }
            Some("n") => {}
            _ => break,
        }
    }
    chosen
}

pub(super) fn describe(change: &Change) -> String {
    match change {
        Change::Added { run } => format!("new run       {run}"),
        Change::Removed { run } => format!("run missing   {run}"),
        Change::Renamed { from, to } => format!("run renamed   {from}\n           to {to}"),
        Change::Number { run, quantity, before, now } => {
            let worst = before.iter().zip(now).max_by(|a, b| change_of(a).total_cmp(&change_of(b)));
            let text = match worst {
                Some((before, now)) => format!("{before:e} -> {now:e} ({:.1e})", change_of(&(before, now))),
                None if before.is_empty() => "is new".into(),
                None => "is missing".into(),
            };
            let steps =
                if before.len() == now.len() && now.len() > 1 { ", the largest of its steps" } else { "" };
            format!("{run}\n  {quantity}: {text}{steps}")
        }
    }
}

/// Returns the relative change of a number.
fn change_of((before, now): &(&f64, &f64)) -> f64 {
    let scale = before.abs().max(now.abs());
    if scale > 0.0 { (*now - *before).abs() / scale } else { 0.0 }
}
