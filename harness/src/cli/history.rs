//! `tissuebench history`: errors and times of a study over commits.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use reports::commits::{Point, Step, Trend, add, trends};
use reports::{ReportError, svg_over_commits};

use super::args::Format;
use super::colour::{self, BAD, DOUBTFUL, GOOD};
use super::errors::unreported;

/// Actions on a history.
#[derive(Subcommand)]
pub enum HistoryAction {
    /// Add the errors and times of results to a history, as one small file to be committed
    Add {
        /// Folder of results
        results: PathBuf,
        /// Folder of the history
        #[arg(long, value_name = "DIR", default_value = "history")]
        to: PathBuf,
        /// Label next to the commit, such as v1.2 or "new assembly"
        #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true)]
        label: String,
    },
    /// Show accuracy and time by commit, and the changes beyond noise
    Show(ShowArgs),
}

/// Arguments of `history show`.
#[derive(Args)]
pub struct ShowArgs {
    /// Folder of the history
    #[arg(default_value = "history")]
    pub history: PathBuf,
    /// Output format on stdout: a table or one JSON object
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,
    /// Figure to write, as SVG
    #[arg(long, value_name = "FILE")]
    pub figure: Option<PathBuf>,
}

/// Number of lines printed per change; further ones are only counted.
const SHOWN: usize = 5;

pub(super) fn act(action: &HistoryAction) -> u8 {
    let done = match action {
        HistoryAction::Add { results, to, label } => {
            let added = records::read_numbers(results, "keep").map_err(ReportError::from);
            added.and_then(|set| add(to, &set, label)).map(|path| {
                println!("{}", path.display());
                0
            })
        }
        HistoryAction::Show(args) => show(args),
    };
    done.unwrap_or_else(unreported)
}

fn show(args: &ShowArgs) -> Result<u8, ReportError> {
    let found = trends(&args.history)?;
    if found.is_empty() {
        let history = args.history.display();
        eprintln!(
            "tissuebench: {history} holds no history; tissuebench history add RESULTS --to {history} starts one"
        );
        return Ok(2);
    }
    match args.format {
        Format::Table => found.iter().for_each(print),
        Format::Json => {
            println!("{}", serde_json::to_string_pretty(&found).expect("finite numbers and text"))
        }
    }
    if let Some(path) = &args.figure {
        records::write_text(path, svg_over_commits(&found)?)?;
    }
    Ok(0)
}

fn print(trend: &Trend) {
    println!("{} on {}", trend.source, trend.machine);
    let longest = trend.points.iter().map(|point| point.name().chars().count()).fold(12, usize::max) + 2;
    println!(
        "{:>6}  {:longest$}{:>6}{:>8}{:>7}{:>11}{:>9}{:>9}  ",
        "number", "commit", "runs", "failed", "quiet", "CPU [s]", "CPU", "errors"
    );
    for point in &trend.points {
        println!("{}", row(point, longest));
        point.step.iter().for_each(step);
    }
}

/// Formats one commit, with its name padded to `longest` characters. Ratios are relative to the first commit.
fn row(point: &Point, longest: usize) -> String {
    let ratio = |ratio: Option<f64>| ratio.map_or("-".into(), |ratio| format!("{ratio:.3}"));
    let quiet = match point.quiet {
        Some(true) => "yes",
        Some(false) => "no",
        None => "-",
    };
    let commit = point.name();
    format!(
        "{:>6}  {commit:longest$}{:>6}{:>8}{quiet:>7}{:>11.3}{:>9}{:>9}",
        point.number,
        point.runs,
        point.checks_failed,
        point.seconds,
        ratio(point.seconds_ratio),
        ratio(point.error_ratio),
    )
}

/// Prints the changes beyond noise since the previous commit.
fn step(step: &Step) {
    let Step { worse, better, lost, new, called, .. } = step;
    if lost + new > 0 {
        println!("        {}  {lost} runs no longer exist, {new} are new", colour::out(DOUBTFUL, "runs  "));
    }
    for (list, style, word) in [(worse, BAD, "worse "), (better, GOOD, "better")] {
        some(list, |e| println!("        {}  {e}", colour::out(style, word)));
    }
    some(called, |ratio| {
        let (style, word) = if ratio.ratio > 1.0 { (BAD, "slower") } else { (GOOD, "faster") };
        println!("        {}  {ratio}", colour::out(style, word));
    });
}

fn some<T>(list: &[T], print: impl Fn(&T)) {
    list.iter().take(SHOWN).for_each(print);
    if list.len() > SHOWN {
        println!("                ... and {} more", list.len() - SHOWN);
    }
}
