//! `tissuebench pick`: finds the cheapest method of a scene within an error bound, and the Pareto front of
//! run time against error.

mod args;
mod default_methods;
mod ladder;
mod quantity;
mod search;

use std::io::IsTerminal;

use cases::scene::Scene;
use records::Reference;
use reports::Seconds;
use serde::Serialize;

use crate::cli::args::{Format, SceneArgs};
use crate::cli::results::{described, take, write_results};
use crate::cli::scenes::{choose, refuse_scene};
use crate::cli::{interrupt, text};
use crate::measure::Repeats;
use crate::outcome::provenance;
use crate::run::{Group, RunOptions, case_name};
use crate::study::{self, folder};
use ladder::ladders;
use quantity::Quantity;
use search::{Demand, Found, Tried, search};

pub use args::PickArgs;

/// Repeats of a run's timing. The median of three excludes the page faults of the first run.
const REPEATS: Repeats = Repeats { most: 3, seconds: 0.5 };
/// Factor from the error bound of a single number to that of the displacement, unless the user gives one.
const BESIDE: f64 = 3.0;

/// Searches and prints. Returns 0 if a method is within the bound, 1 if none is, 2 for invalid input, 3 if
/// nothing could run.
pub(super) fn pick(args: &PickArgs) -> u8 {
    let (scene, chosen) = match opened(args) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    let demand = match demand(args, scene.reference.is_none()) {
        Ok(demand) => demand,
        Err(bad) => return wrong(&bad),
    };
    let machine = provenance::machine();
    let folder = match args.out.as_ref().map(|out| take(&args.scene.file, out)).transpose() {
        Ok(folder) => folder,
        Err(code) => return code,
    };
    interrupt::at_last(interrupt::incomplete(args.out.clone()));
    if scene.reference.is_none() {
        eprintln!("the scene has no [reference]: errors are estimated (output.estimate)");
    } else if std::io::stderr().is_terminal() {
        eprintln!("reference ...");
    }
    let group = match Group::new(&scene, None, REPEATS) {
        Ok(group) => group,
        Err(failure) => {
            folder.into_iter().for_each(folder::Folder::leave);
            eprintln!("{failure} (every method)");
            return failure.exit_code();
        }
    };
    if let Some(failure) = group.reference_stalled() {
        eprintln!("reference stalled: {failure} (no method can be compared with its final state)");
        folder.into_iter().for_each(folder::Folder::leave);
        return failure.exit_code();
    }
    let reference = group.reference();
    if let Some((quantity, most, own)) = reference.as_ref().and_then(|reference| demand.beyond(reference)) {
        folder.into_iter().for_each(folder::Folder::leave);
        let sentence = beyond(&demand, quantity, most, own);
        print(args, &scene, &demand, &Found::default(), reference.as_ref(), sentence);
        return 1;
    }
    let options = RunOptions { picture: args.out.is_some(), ..RunOptions::default() };
    let mut found = match search(&scene, &group, ladders(&scene, &chosen), &demand, &machine, options) {
        Ok(found) => found,
        Err(bad) => {
            folder.into_iter().for_each(folder::Folder::leave);
            return wrong(&format!("{}: {bad}", args.scene.file.display()));
        }
    };
    let of_scene = (case_name(&scene), scene.text().to_string());
    found.set.provenance = provenance::provenance(machine, &[of_scene]);
    found.set.provenance.source = folder::source(&args.scene.file);
    study::warn_if_busy(&mut found.set);
    let sentence = sentence(&demand, &found);
    print(args, &scene, &demand, &found, reference.as_ref(), sentence);
    let code = match (found.cheapest(), found.tried.is_empty()) {
        (Some(_), _) => 0,
        (None, false) => 1,
        (None, true) => found.code.max(3),
    };
    code.max(write(args, &scene, found))
}

fn wrong(what: &str) -> u8 {
    eprintln!("tissuebench: {what}");
    2
}

/// Returns the accuracy requirements. For a single number they include the displacement, unless the user
/// requires another field. Without a reference, errors are estimates.
fn demand(args: &PickArgs, estimated: bool) -> Result<Demand, String> {
    let named = |name: &str| if estimated { Quantity::estimated(name) } else { Quantity::named(name) };
    let quantity = named(&args.quantity).map_err(|bad| format!("--quantity {bad}"))?;
    let of_field = |(name, most): &(String, f64)| Ok((named(name)?, *most));
    let also: Result<Vec<_>, String> = args.also.iter().map(of_field).collect();
    let mut also = also.map_err(|bad| format!("--also {bad}"))?;
    if quantity.scalar && also.iter().all(|(other, _)| other.scalar) {
        also.push((named("displacement").expect("a word"), BESIDE * args.error));
    }
    Ok(Demand { quantity, error: args.error, also, at_most: args.at_most })
}

/// Loads the scene and selects the methods to try. Errors are estimated in a scene without a reference.
fn opened(args: &PickArgs) -> Result<(Scene, Vec<usize>), u8> {
    let load = |from: &SceneArgs| {
        default_methods::with_usual(from, args.usual).map_err(|errors| refuse_scene(&from.file, &errors))
    };
    let (mut scene, mut own) = load(&args.scene)?;
    if scene.reference.is_none() {
        let mut estimated = args.scene.clone();
        estimated.set.push("output.estimate=true".parse().expect("a key and a value"));
        (scene, own) = load(&estimated)?;
    }
    if own == 0 || args.usual {
        let ids: Vec<&str> = scene.methods[own..].iter().map(|m| m.id.as_str()).collect();
        eprintln!("usual methods that suit the scene: {}", ids.join(", "));
    }
    let chosen = choose(&scene, &args.scene)?;
    Ok((scene, chosen))
}

/// The result as JSON for scripts.
#[derive(Serialize)]
struct Answer<'a> {
    scene: String,
    quantity: &'a str,
    /// Error bound of the quantity.
    error: f64,
    /// Error bounds of additional quantities.
    also: Vec<(&'a str, f64)>,
    /// The fastest run within all bounds.
    cheapest: Option<&'a Tried>,
    /// Time that is compared: `wall`, `cpu` or `least`.
    by: Seconds,
    /// All runs, sorted by time.
    runs: &'a [Tried],
    /// The runs' reference, with its own error.
    reference: Option<&'a Reference>,
    /// The result in words.
    sentence: String,
}

fn print(
    args: &PickArgs,
    scene: &Scene,
    demand: &Demand,
    found: &Found,
    reference: Option<&Reference>,
    sentence: String,
) {
    if args.format == Format::Json {
        let answer = Answer {
            scene: case_name(scene),
            quantity: &demand.quantity.name,
            error: demand.error,
            also: demand.also.iter().map(|(quantity, most)| (quantity.name.as_str(), *most)).collect(),
            cheapest: found.cheapest(),
            by: found.by,
            runs: &found.tried,
            reference,
            sentence,
        };
        println!("{}", serde_json::to_string(&answer).expect("finite numbers and text"));
        return;
    }
    if !found.tried.is_empty() {
        println!("{}\n", table(demand, &found.tried, found.by));
    }
    reference.iter().for_each(|reference| print!("{}", text::compared_with(reference)));
    print!("{}", text::warnings(&found.set.warnings));
    println!("{sentence}");
    for (method, seconds) in &found.too_long {
        println!(
            "The next size of {method} was not tried: its estimated time is {} s (--at-most).",
            text::digits(*seconds)
        );
    }
}

/// Formats all runs sorted by time, with the Pareto front marked.
fn table(demand: &Demand, tried: &[Tried], by: Seconds) -> String {
    let mut others: Vec<&str> = Vec::new();
    for (name, _) in tried.iter().flat_map(|run| &run.errors) {
        if !others.contains(&name.as_str()) {
            others.push(name);
        }
    }
    let percent = |error: Option<f64>| error.map_or("-".into(), |error| text::digits(100.0 * error));
    let mut head = vec!["method".to_string(), "nodes".into(), format!("{} [%]", demand.quantity.name)];
    head.extend(others.iter().map(|name| format!("{name} [%]")));
    let time = if by == Seconds::Wall { "time [s]".into() } else { format!("{} time [s]", by.word()) };
    head.extend([time, "within".into(), "front".into()]);
    let mut rows = vec![head];
    for run in tried {
        let mut row = vec![run.method.clone(), run.nodes.to_string(), percent(run.error)];
        row.extend(others.iter().map(|name| percent(error_of(run, name))));
        let within = match (run.status, run.within) {
            ("ok" | "relaxed", true) => "yes",
            ("ok" | "relaxed", false) => "no",
            (status, _) => status,
        };
        row.extend([text::digits(run.seconds), within.into(), if run.front { "*" } else { "" }.into()]);
        rows.push(row);
    }
    text::aligned(&rows)
}

fn error_of(run: &Tried, name: &str) -> Option<f64> {
    run.errors.iter().find(|(other, _)| other == name).map(|(_, error)| *error)
}

/// Formats a fraction as the user gave it: 3 %, not 3.000 %.
fn asked(part: f64) -> String {
    format!("{} %", (1e8 * part).round() / 1e6)
}

/// Describes all requirements.
fn bound(demand: &Demand) -> String {
    let also =
        demand.also.iter().map(|(quantity, most)| format!(" and {} of {}", asked(*most), quantity.name));
    format!("{} of {}{}", asked(demand.error), demand.quantity.name, also.collect::<String>())
}

/// Returns the result for a reference with a larger error than the bound.
fn beyond(demand: &Demand, quantity: &Quantity, most: f64, own: f64) -> String {
    format!(
        "No method can be shown to be within {}: the reference's own error of {} is about {} %, more than {}. No run \
         was made: take a finer reference (reference.size).",
        bound(demand),
        quantity.name,
        text::digits(100.0 * own),
        asked(most)
    )
}

/// Returns the result in one sentence.
fn sentence(demand: &Demand, found: &Found) -> String {
    let percent = |part: f64| format!("{} %", text::digits(100.0 * part));
    let name = &demand.quantity.name;
    let bound = bound(demand);
    if let Some(best) = found.cheapest() {
        let error = best.error.unwrap_or_default();
        return format!(
            "Cheapest within {bound}: {} with {} nodes, {} {}, in {} s.",
            best.method,
            best.nodes,
            demand.quantity.word(),
            percent(error),
            text::digits(best.seconds)
        );
    }
    let others = found.tried.iter().filter(|run| run.status != "reference");
    let close = others.filter_map(|run| Some((run, run.error?))).min_by(|a, b| a.1.total_cmp(&b.1));
    match close {
        Some((run, error)) if error <= demand.error => format!(
            "No method is within {bound}: {} with {} nodes meets the bound on {name} (error {}), but not the other bounds.",
            run.method,
            run.nodes,
            percent(error)
        ),
        Some((run, error)) => format!(
            "No method is within {bound}; the nearest is {} with {} nodes, error {}: give finer sizes, or a longer --at-most.",
            run.method,
            run.nodes,
            percent(error)
        ),
        None => format!("No method is within {bound}: no run gave a number."),
    }
}

/// Writes the folder of results, if requested.
fn write(args: &PickArgs, scene: &Scene, mut found: Found) -> u8 {
    let Some(out) = &args.out else { return 0 };
    found.set.records.extend(study::reference_records(scene));
    match write_results(out, &found.set, None, false) {
        0 => described(out),
        code => code,
    }
}
