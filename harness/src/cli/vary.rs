//! `tissuebench vary`: runs the samples of a scene's uncertain inputs and prints their statistics.

use std::collections::BTreeMap;
use std::path::PathBuf;

use cases::scene::{Override, Run, Scene, Study};
use clap::Args;
use records::RunSet;

use crate::cli::args::SceneArgs;
use crate::cli::errors::refuse;
use crate::cli::interrupt;
use crate::cli::results::{close, take};
use crate::cli::scenes::{affordable, open};
use crate::cli::verify::write;
use crate::study::{self, StudyPlan, VerifyArgs, folder};

/// Samples from which the spread by the inputs is estimated, to choose a method.
const PILOT: u32 = 20;

/// Arguments of `vary`.
#[derive(Args)]
pub struct VaryArgs {
    /// The scene to run; it has [vary]
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Number of samples, in place of vary.samples
    #[arg(long, value_name = "N")]
    pub samples: Option<u32>,
    /// Sample only the first method whose estimated numerical error is at most a tenth of the spread by the
    /// inputs. The scene lists its methods from coarse to fine, and has output.estimate = true
    #[arg(long)]
    pub fine_enough: bool,
    /// Number of concurrent runs
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: u16,
    /// Keep stored results of samples whose scene, method and program have not changed
    #[arg(long)]
    pub resume: bool,
    /// Run even if the estimate exceeds twice the memory of this machine or half a day
    #[arg(long)]
    pub force: bool,
    /// Print only the statistics and errors
    #[arg(short, long)]
    pub quiet: bool,
    /// Folder for samples, tables, figures and the report; replaces the results of an earlier run of the
    /// scene
    #[arg(long, value_name = "DIR", default_value = "results")]
    pub out: PathBuf,
}

/// Runs the scene as written and all samples, writes the results and the report, and returns the exit code.
pub(super) fn vary(args: &VaryArgs) -> u8 {
    let mut of = args.scene.clone();
    let samples = args.samples.map(|samples| ("vary.samples", samples.to_string()));
    of.set.extend(samples.map(|(key, value)| Override { key: key.into(), value }));
    let (mut scene, chosen) = match open(&of) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    if scene.vary.is_none() {
        let help = "has no [vary]: give it samples, of = [\"tool-force\"] and [vary.keys]";
        eprintln!("{}: {help}; see the guide 'Uncertain inputs'", of.file.display());
        return 2;
    }
    // Constants are not fitted.
    scene.fit = None;
    let mut methods: Vec<String> = chosen.iter().map(|&index| scene.methods[index].id.clone()).collect();
    let mut study = VerifyArgs {
        jobs: args.jobs,
        resume: args.resume,
        quiet: args.quiet,
        out: args.out.clone(),
        ..VerifyArgs::of(&of.file)
    };
    if args.fine_enough && !scene.output.estimate {
        eprintln!(
            "{}: --fine-enough needs output.estimate = true: add it to [output], or --set it",
            of.file.display()
        );
        return 2;
    }
    let planned = |methods: &[String]| {
        let plan =
            StudyPlan::new(of_scene(&scene, &of, methods.to_vec())).map_err(|errors| refuse(&errors))?;
        affordable(&plan.too_large(&study), args.force).map(|()| plan)
    };
    let mut plan = match planned(&methods) {
        Ok(plan) => plan,
        Err(code) => return code,
    };
    let folder = match take(&of.file, &args.out) {
        Ok(folder) => folder,
        Err(code) => return code,
    };
    if args.fine_enough {
        methods = vec![fine_enough(&scene, &of, methods, &study)];
        plan = match planned(&methods) {
            Ok(plan) => plan,
            Err(code) => return code,
        };
        // The runs that decided are stored.
        study.resume = true;
    }
    if !args.quiet {
        eprintln!("{}: {} runs", of.file.display(), plan.len());
    }
    interrupt::at_last(interrupt::resumable(args.out.clone()));
    let mut finished = plan.execute(&study);
    finished.set.provenance.source = folder::source(&of.file);
    finished.set.provenance.set = of.set.iter().map(ToString::to_string).collect();
    let code = write(&finished, &folder, &study);
    reports::uncertain(&finished.set).iter().for_each(|of| print!("{}", of.text()));
    close(folder, &args.out, code, || study::clean(&args.out))
}

/// A study of one scene.
pub(super) fn of_scene(scene: &Scene, args: &SceneArgs, methods: Vec<String>) -> Study {
    Study {
        title: scene.title.clone(),
        runs: vec![Run { methods, ..Run::of(&args.file) }],
        scenes: BTreeMap::from([(args.file.clone(), scene.clone())]),
    }
}

/// The first method whose numerical error is at most a tenth of the spread by the inputs, or else the last.
/// The spread is that of the first method over a few samples, because it hardly depends on the mesh.
fn fine_enough(scene: &Scene, args: &SceneArgs, methods: Vec<String>, study: &VerifyArgs) -> String {
    let mut pilot = scene.clone();
    if let Some(vary) = &mut pilot.vary {
        vary.samples = vary.samples.min(PILOT);
    }
    let run = |scene: &Scene, id: &str, sampled: bool| {
        let study_of = of_scene(scene, args, vec![id.into()]);
        let plan =
            if sampled { StudyPlan::new(study_of) } else { StudyPlan::of_tables(study_of, &[0], None) };
        plan.map(|plan| plan.execute(study).set).unwrap_or_default()
    };
    let spread = methods.first().map(|first| run(&pilot, first, true)).unwrap_or_default();
    let spreads: Vec<f64> =
        reports::uncertain(&spread).iter().filter_map(|of| Some(of.statistics.as_ref()?.sd.value)).collect();
    let of: Vec<_> = scene.vary.iter().flat_map(|vary| &vary.of).copied().collect();
    let mut last = String::new();
    for id in methods {
        let RunSet { records, failures, .. } = run(scene, &id, false);
        failures.iter().for_each(|failure| eprintln!("{id}: {}", failure.reason));
        let shares: Vec<f64> = of
            .iter()
            .zip(&spreads)
            .filter_map(|(of, sd)| Some(study::numerical(*of, &records)? / sd))
            .collect();
        let share = shares.iter().copied().fold(0.0, f64::max);
        let known = !shares.is_empty();
        match known {
            true => {
                eprintln!("{id}: the numerical error is {:.1} % of the spread by the inputs", 100.0 * share)
            }
            false => eprintln!("{id}: the numerical error is not known for any metric of vary.of"),
        }
        last = id;
        if known && share <= reports::FINE_ENOUGH {
            eprintln!("{last} is fine enough, and is sampled");
            return last;
        }
    }
    eprintln!("no method is fine enough; the last, {last}, is sampled");
    last
}
