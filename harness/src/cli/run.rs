//! `tissuebench run`: runs one scene with some or all of its methods.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use cases::scene::{self, Check, Scene};
use records::{Machine, RunSet, Status};
use reports::Seconds;

use crate::cli::args::{Format, RunArgs};
use crate::cli::errors::unreported;
use crate::cli::json::RunObject;
use crate::cli::results::{described, take, write_results};
use crate::cli::scenes::{affordable_methods, open};
use crate::cli::{fields, interrupt, text};
use crate::error::Failure;
use crate::measure::Repeats;
use crate::outcome::{Outcome, Unfinished, provenance};
use crate::run::{Group, RunOptions, case_name};
use crate::study::folder::{self, Folder};
use crate::study::{self, check, failed, stalled};

/// Time between two progress lines.
const EVERY: Duration = Duration::from_secs(10);
/// Repeats of timing a single run.
const REPEATS: Repeats = Repeats { most: 5, seconds: 1.0 };

/// Reports that uncertain inputs are not sampled and constants are not fitted.
fn as_written(scene: &Scene, file: &Path) {
    let file = file.display();
    if let Some(vary) = &scene.vary {
        let keys = vary.keys.len();
        eprintln!(
            "{file}: runs as written; tissuebench vary {file} runs the samples of its {keys} uncertain keys"
        );
    }
    if let Some(fit) = &scene.fit {
        let (keys, data) = (fit.keys.len(), fit.data.path.display());
        eprintln!("{file}: runs as written; tissuebench fit {file} fits its {keys} constants to {data}");
    }
}

/// Runs the scene, reports the results and returns the exit code.
pub(super) fn run(args: &RunArgs) -> u8 {
    let (scene, chosen) = match open(&args.scene) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    if !args.quiet {
        as_written(&scene, &args.scene.file);
    }
    if let Err(code) = affordable_methods(&scene, &chosen, args.force) {
        return code;
    }
    let machine = provenance::machine();
    let folder = match args.out.as_ref().map(|out| take(&args.scene.file, out)).transpose() {
        Ok(folder) => folder,
        Err(code) => return code,
    };
    if let Some(out) = &args.out
        && let Err(bad) = fields::clear(&out.join(fields::FOLDER))
    {
        return unreported(bad);
    }
    let scene = Arc::new(scene);
    let made = Arc::new(Mutex::new(Made {
        now: String::new(),
        args: args.clone(),
        case: case_name(&scene),
        scene: scene.clone(),
        machine,
        left: chosen.iter().map(|&index| scene.methods[index].id.clone()).collect(),
        set: RunSet::default(),
        outcomes: Vec::new(),
        code: 0,
    }));
    let shared = made.clone();
    interrupt::at_last(move || {
        if let Ok(mut made) = shared.lock() {
            made.interrupted();
            // The lock is never released, so that no result is added any more.
            std::mem::forget(made);
        }
    });
    if !args.quiet && !std::io::stderr().is_terminal() {
        report_now_and_then(made.clone());
    }
    let made = || made.lock().expect("no other thread panics");
    if scene.reference.is_some() {
        made().begins("reference".into());
    }
    let repeats = if args.once { Repeats::ONCE } else { REPEATS };
    let group = match Group::new(&scene, None, repeats) {
        Ok(group) => group,
        Err(failure) => {
            folder.into_iter().for_each(Folder::leave);
            return made().unreferenced(&chosen, &failure);
        }
    };
    if let Some(failure) = group.reference_stalled() {
        made().reference_stalled(failure, group.reference_carried());
    }
    for (count, &index) in (1..).zip(&chosen) {
        let method = &scene.methods[index];
        made().begins(format!("{} ({count} of {})", method.id, chosen.len()));
        let kept = args.out.is_some();
        let options = RunOptions { picture: kept, states: kept, frames: true, split: None };
        match group.run(&group.scenario(method.clone(), 0), options) {
            Ok(outcome) => made().finished(method, outcome),
            Err(unfinished) => made().failed(method, unfinished),
        }
    }
    made().conclude()
}

/// Prints a progress line at intervals if stderr is not a terminal.
fn report_now_and_then(made: Arc<Mutex<Made>>) {
    let begin = Instant::now();
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(EVERY);
            let Ok(made) = made.lock() else { return };
            eprintln!("{} is running, {:.0} s since the start", made.now, begin.elapsed().as_secs_f64());
        }
    });
}

/// Results of the scene's methods so far.
struct Made {
    /// Name of the running method, or of the reference.
    now: String,
    args: RunArgs,
    case: String,
    scene: Arc<Scene>,
    machine: Machine,
    /// Methods that have not ended yet.
    left: Vec<String>,
    set: RunSet,
    outcomes: Vec<Outcome>,
    code: u8,
}

impl Made {
    /// Reports that no method ran because the reference failed, with each method's plan, and returns the exit
    /// code.
    fn unreferenced(&self, chosen: &[usize], failure: &Failure) -> u8 {
        if self.args.format == Format::Json {
            for &index in chosen {
                let method = &self.scene.methods[index];
                let planned = Group::unreferenced(&self.scene, Repeats::ONCE)
                    .and_then(|group| group.plan(&group.scenario(method.clone(), 0)));
                let (plan, size) = planned.unwrap_or_default();
                let unfinished = Unfinished { failure: failure.clone(), plan, size };
                print_json(&RunObject::failed(&self.case, &method.id, &unfinished));
            }
        }
        eprintln!("{failure} (every method)");
        failure.exit_code()
    }

    /// Records the running method. A terminal shows it immediately, because a static run may take minutes.
    fn begins(&mut self, now: String) {
        if !self.args.quiet && std::io::stderr().is_terminal() {
            eprintln!("{now} ...");
        }
        self.now = now;
    }

    fn reference_stalled(&mut self, failure: &Failure, carried: Option<f64>) {
        eprintln!(
            "reference stalled: {failure} (every method is compared up to the last step of the reference)"
        );
        let reason = format!("reference stalled: {failure}");
        let case = self.case.clone();
        let method = "reference".into();
        let status = failure.status().into();
        self.set.failures.push(records::Failure {
            case,
            method,
            reason,
            carried,
            status,
            ..Default::default()
        });
        self.code = failure.exit_code();
    }

    fn finished(&mut self, method: &scene::Method, mut outcome: Outcome) {
        self.left.retain(|id| *id != method.id);
        if self.args.format == Format::Json {
            print_json(&RunObject::finished(&outcome));
        }
        let records = outcome.records();
        let own = |check: &&Check| check.methods.is_empty() || check.methods.contains(&method.id);
        let foreseen = check::foreseen_end(self.scene.checks.iter().filter(own), &records);
        for check in self.scene.checks.iter().filter(own).filter(|check| !check::is_of_many(check)) {
            let of = check.address;
            let (value, band) = (check::value(of, &records), check::band(of, &records));
            let verdict = check::judge(check, &self.case, &method.id, value, band);
            self.set.checks.push(records::Check { runs: check::run_ids(&records), ..verdict });
        }
        self.set.records.extend(records);
        self.set.plans.extend(outcome.plan_entries());
        self.set.warnings.extend(outcome.warning_rows());
        study::compared_with(&mut self.set, outcome.reference.as_ref());
        self.set.fields.extend(outcome.field.clone());
        if let (Some(out), Some(states)) = (&self.args.out, outcome.states.take())
            && let Err(bad) = fields::write(&states, &method.id, &out.join(fields::FOLDER))
        {
            self.code = self.code.max(unreported(bad));
        }
        if let Some(reason) = &outcome.relaxed {
            eprintln!("relaxed: {reason} (method '{}')", method.id);
        }
        if let Some(failure) = &outcome.stalled {
            eprintln!("{}: {failure} (method '{}')", outcome.status, method.id);
            self.set.failures.push(stalled(&outcome, failure));
            if !foreseen {
                self.code = self.code.max(failure.exit_code());
            }
        }
        self.outcomes.push(outcome);
    }

    fn failed(&mut self, method: &scene::Method, unfinished: Unfinished) {
        self.left.retain(|id| *id != method.id);
        if self.args.format == Format::Json {
            print_json(&RunObject::failed(&self.case, &method.id, &unfinished));
        }
        let failure = unfinished.failure;
        eprintln!("{failure} (method '{}')", method.id);
        self.set.failures.push(failed(&self.case, method, &failure));
        self.code = self.code.max(failure.exit_code());
    }

    /// Prints and writes the finished results, and records the unfinished methods as failed.
    fn interrupted(&mut self) {
        eprintln!("tissuebench: interrupted before the end of {}", self.left.join(", "));
        for id in std::mem::take(&mut self.left) {
            self.set.failures.push(records::Failure {
                case: self.case.clone(),
                method: id,
                reason: "interrupted".into(),
                status: "interrupted".into(),
                ..Default::default()
            });
        }
        if !self.outcomes.is_empty() {
            self.conclude();
        } else if let Some(out) = &self.args.out {
            eprintln!("tissuebench: no method has finished; {} is incomplete", out.display());
        }
    }

    /// Prints the table and the checks that did not pass, and writes the folder of results. Returns the exit
    /// code.
    fn conclude(&mut self) -> u8 {
        let text = self.scene.text().to_string();
        self.set.provenance = provenance::provenance(self.machine.clone(), &[(self.case.clone(), text)]);
        self.set.provenance.set = self.args.scene.set.iter().map(ToString::to_string).collect();
        self.set.provenance.source = folder::source(&self.args.scene.file);
        study::warn_if_busy(&mut self.set);
        if self.args.format == Format::Table && !self.outcomes.is_empty() {
            let took = self.outcomes.iter().filter_map(|outcome| Some(outcome.total()?.took()));
            println!("{}", text::outcomes(&self.outcomes, Seconds::of(&self.set.provenance.machine, took)));
            let compared = self.set.references.iter().map(text::compared_with).collect::<String>();
            print!("{}{compared}{}", text::places(&self.outcomes), text::warnings(&self.set.warnings));
        }
        for check in self.set.checks.iter().filter(|check| text::is_told(check)) {
            eprintln!("{}", text::painted_verdict(check));
            self.code = self.code.max(u8::from(check.status != Status::Pass));
        }
        let Some(out) = &self.args.out else { return self.code };
        self.set.records.extend(study::reference_records(&self.scene));
        let written = write_results(out, &self.set, None, self.args.quiet);
        self.code.max(if written == 0 { described(out) } else { written })
    }
}

fn print_json(object: &RunObject) {
    println!("{}", serde_json::to_string(object).expect("finite numbers and text"));
}
