//! `tissuebench loop`: the frames of a scene's methods in real time, against their deadlines.

use cases::scene::Scene;
use catalogue::{metric, warning};
use clap::Args;
use serde_json::{Value, json};

use super::args::{Format, SceneArgs};
use super::scenes::{affordable_methods, open};
use super::text::digits;
use crate::measure::Repeats;
use crate::outcome::{Latency, Outcome, provenance};
use crate::run::{Group, RunOptions, case_name};

/// Arguments of `loop`.
#[derive(Args)]
pub struct LoopArgs {
    /// The scene
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Run even if the estimate exceeds twice the memory of this machine or half a day
    #[arg(long)]
    pub force: bool,
    /// Output format on stdout
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,
}

/// A number of a row: its name in JSON, the head of its column, and the factor from SI to the column's unit.
struct Column(&'static str, &'static str, f64);

const COLUMNS: [Column; 9] = [
    Column("misses", "misses [1/1000]", 1.0),
    Column("longest-run", "longest run", 1.0),
    Column("median", "median [ms]", 1e3),
    Column("p99", "p99 [ms]", 1e3),
    Column("p99.9", "p99.9 [ms]", 1e3),
    Column("max", "max [ms]", 1e3),
    Column("touch", "touch [ms]", 1e3),
    Column("force-error", "force error [%]", 1e2),
    Column("displacement-error", "displacement error [%]", 1e2),
];

/// Plays the loop of each method, prints a row for each rate, and returns the exit code.
pub(super) fn played(args: &LoopArgs) -> u8 {
    let (scene, chosen) = match open(&args.scene) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    let Some(asked) = &scene.real_time else {
        let help = "give it [loop] with rates = [30, 60, 1000] and, in a static procedure, a duration";
        eprintln!("{}: key 'loop': is missing; {help}", args.scene.file.display());
        return 2;
    };
    if let Err(code) = affordable_methods(&scene, &chosen, args.force) {
        return code;
    }
    let group = match Group::new(&scene, None, Repeats::ONCE) {
        Ok(group) => group,
        Err(failure) => {
            eprintln!("{failure} (every method)");
            return failure.exit_code();
        }
    };
    let width = chosen.iter().map(|&index| scene.methods[index].id.chars().count()).fold(6, usize::max);
    if args.format == Format::Table {
        print!("{}", head(&scene, asked.duration(&scene.procedure), width));
    }
    let mut code = 0;
    for &index in &chosen {
        let method = &scene.methods[index];
        let options = RunOptions { frames: true, ..RunOptions::default() };
        match group.run(&group.scenario(method.clone(), 0), options) {
            Ok(outcome) => {
                let paced = outcome.latencies.iter().filter(|latency| latency.deadline.is_some());
                for (index, (latency, rate)) in paced.zip(&asked.rates).enumerate() {
                    let values = values(&outcome, index, latency);
                    match args.format {
                        Format::Table => println!("{}", row(&outcome, *rate, &values, width)),
                        Format::Json => println!("{}", object(&outcome, *rate, latency, &values)),
                    }
                }
                let ended = outcome.warnings.iter().filter(|w| *w.kind == warning::LOOP_ENDED);
                ended.for_each(|warning| eprintln!("{} (method '{}')", warning.message, method.id));
                if let Some(failure) = &outcome.stalled {
                    eprintln!("{failure} (method '{}', which has no loop)", method.id);
                    code = code.max(failure.exit_code());
                }
            }
            Err(unfinished) => {
                eprintln!("{} (method '{}')", unfinished.failure, method.id);
                code = code.max(unfinished.failure.exit_code());
            }
        }
    }
    code
}

/// The machine, and the heads of the columns.
fn head(scene: &Scene, seconds: f64, width: usize) -> String {
    let machine = provenance::machine();
    let load = machine.load.map_or(String::new(), |load| format!(", load {load}"));
    let heads = COLUMNS.map(|Column(_, head, _)| head).join("  ");
    format!(
        "{}: the loading passes in {} s; {}, {} threads{load}\n\n{:width$}  {:>7}  rate [1/s]  {heads}\n",
        case_name(scene),
        digits(seconds),
        machine.processor(),
        machine.threads,
        "method",
        "nodes",
    )
}

/// Values of a rate in SI units, in the order of the columns; `None` for one that the loop does not give.
fn values(outcome: &Outcome, index: usize, latency: &Latency) -> Vec<Option<f64>> {
    let statistics = latency.statistics();
    let value = |Column(name, ..): &Column| match *name {
        "force-error" => outcome.value(metric::LOOP_FORCE_ERROR.at(index)),
        "displacement-error" => outcome.value(metric::LOOP_PROBE_ERROR.at(index)),
        name => statistics.iter().find(|(statistic, ..)| *statistic == name).map(|(.., value)| *value),
    };
    COLUMNS.iter().map(value).collect()
}

fn row(outcome: &Outcome, rate: usize, values: &[Option<f64>], width: usize) -> String {
    let cells = COLUMNS.iter().zip(values).map(|(Column(_, head, factor), value)| {
        let cell = value.map_or("-".into(), |value| digits(factor * value));
        format!("{cell:>width$}", width = head.len())
    });
    let cells = cells.collect::<Vec<_>>().join("  ");
    let (method, nodes) = (&outcome.identity.method, outcome.size.nodes);
    format!("{method:width$}  {nodes:>7}  {rate:>10}  {cells}")
}

fn object(outcome: &Outcome, rate: usize, latency: &Latency, values: &[Option<f64>]) -> Value {
    let mut object = json!({
        "scene": outcome.identity.case,
        "method": outcome.identity.method,
        "nodes": outcome.size.nodes,
        "rate": rate,
        "frames": latency.seconds.len(),
        "broke-off": latency.broke_off,
    });
    for (Column(name, ..), value) in COLUMNS.iter().zip(values) {
        object[*name] = json!(value);
    }
    object
}
