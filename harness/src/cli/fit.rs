//! `tissuebench fit`: fits constants of a scene to a measured curve.

use std::path::{Path, PathBuf};

use cases::scene::{FittedKey, Scene};
use clap::Args;
use records::store::{files_ending, remove_files};
use records::{Fit, RecordError};

use crate::cli::args::SceneArgs;
use crate::cli::errors::{refuse, unreported};
use crate::cli::interrupt;
use crate::cli::results::{close, take};
use crate::cli::scenes::{affordable, open};
use crate::cli::vary::of_scene;
use crate::cli::verify::write;
use crate::study::{self, StudyPlan, VerifyArgs, folder};

/// Arguments of `fit`.
#[derive(Args)]
pub struct FitArgs {
    /// The scene whose constants are fitted; it has [fit]
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Number of concurrent runs; a Jacobian has as many runs as there are constants
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: u16,
    /// Keep stored results of runs whose scene, method and program have not changed
    #[arg(long)]
    pub resume: bool,
    /// Run even if the estimate exceeds twice the memory of this machine or half a day
    #[arg(long)]
    pub force: bool,
    /// Print only the constants and errors
    #[arg(short, long)]
    pub quiet: bool,
    /// Folder for the fit, its table, its figure, the fitted scene and the report; replaces the results of an
    /// earlier run of the scene
    #[arg(long, value_name = "DIR", default_value = "results")]
    pub out: PathBuf,
}

/// Runs the scene as written and the fit, writes the results and the report, and returns the exit code.
pub(super) fn fit(args: &FitArgs) -> u8 {
    let (scene, chosen) = match open(&args.scene) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    let file = &args.scene.file;
    let Some(fit) = scene.fit.clone() else {
        let help = "has no [fit]: give it data = \"curve.csv\" and keys = [\"material.young\"]";
        eprintln!("{}: {help}; see the guide 'Fitting constants'", file.display());
        return 2;
    };
    let methods: Vec<String> = chosen.iter().map(|&index| scene.methods[index].id.clone()).collect();
    let study = VerifyArgs {
        jobs: args.jobs,
        resume: args.resume,
        quiet: args.quiet,
        out: args.out.clone(),
        ..VerifyArgs::of(file)
    };
    let several = methods.len() > 1;
    // Uncertain inputs are not sampled.
    let mut alone = scene.clone();
    alone.vary = None;
    let plan = match StudyPlan::new(of_scene(&alone, &args.scene, methods)) {
        Ok(plan) => plan,
        Err(errors) => return refuse(&errors),
    };
    let entered = affordable(&plan.too_large(&study), args.force).and_then(|()| take(file, &args.out));
    let folder = match entered {
        Ok(folder) => folder,
        Err(code) => return code,
    };
    if let Err(bad) = clear(&args.out) {
        return unreported(bad);
    }
    interrupt::at_last(interrupt::resumable(args.out.clone()));
    let mut finished = plan.execute(&study);
    finished.set.provenance.source = folder::source(file);
    finished.set.provenance.set = args.scene.set.iter().map(ToString::to_string).collect();
    let mut code = write(&finished, &folder, &study);
    for of in &finished.set.fits {
        print!("{}", reports::fitted_text(of));
        code = code.max(fitted_scene(&scene, of, &fit.keys, args, several));
    }
    close(folder, &args.out, code, || study::clean(&args.out))
}

/// Removes the fitted scenes of an earlier fit.
fn clear(out: &Path) -> Result<(), RecordError> {
    let is_other = |path: &PathBuf| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        name != "fitted" && !name.starts_with("fitted-")
    };
    let others: Vec<PathBuf> = files_ending(out, &["toml"])?.into_iter().filter(is_other).collect();
    remove_files(out, &["toml"], &others)
}

/// Writes the scene with the fitted constants, and prints how to run it; returns the exit code.
fn fitted_scene(scene: &Scene, fit: &Fit, keys: &[FittedKey], args: &FitArgs, several: bool) -> u8 {
    let values: Vec<f64> = fit.constants.iter().map(|constant| constant.value).collect();
    let file = args.scene.file.display();
    let own = args.scene.set.iter().map(|set| format!("--set '{set}'"));
    let fitted = keys.iter().zip(&values);
    let fitted = fitted.map(|(key, value)| format!("--set '{}={}'", key.key, key.written(*value)));
    let set: Vec<String> = own.chain(fitted).collect();
    println!("  tissuebench run {file} {}", set.join(" "));
    let name = if several {
        format!("fitted-{}.toml", records::store::slug(&fit.method))
    } else {
        "fitted.toml".into()
    };
    let path = args.out.join(name);
    match scene.fitted_text(&values).filter(|_| args.scene.set.is_empty()) {
        Some(text) => written(&path, &text),
        None => {
            println!(
                "  no {}: a constant is not in the scene's own file, or --set changes the scene",
                path.display()
            );
            0
        }
    }
}

fn written(path: &Path, text: &str) -> u8 {
    match records::write_text(path, text) {
        Ok(()) => {
            println!("  fitted scene {}", path.display());
            0
        }
        Err(bad) => unreported(bad),
    }
}
