//! `tissuebench merge`: joins the parts of a study.

use crate::cli::errors::{fail, refuse};
use crate::cli::results::{close, take};
use crate::cli::verify::write;
use crate::study::folder;
use crate::study::merge::{self, MergeArgs, Unmerged};

/// Joins the parts, checks them as `verify` does and returns the exit code.
pub(super) fn merge(args: &MergeArgs) -> u8 {
    let (study, plan, verify) = match merge::plan(args) {
        Ok(found) => found,
        Err(Unmerged::Scenes(errors)) => return refuse(&errors),
        Err(Unmerged::Other(failure)) => return fail(&failure),
    };
    let folder = match take(&study, &args.out) {
        Ok(folder) => folder,
        Err(code) => return code,
    };
    let merged = merge::note(&verify, &study).and_then(|()| plan.merge(&verify, &args.shares));
    let mut merged = match merged {
        Ok(merged) => merged,
        Err(failure) => return fail(&failure),
    };
    if merged.machines > 1 {
        eprintln!("the times come from {} kinds of machines", merged.machines);
    }
    if !merged.missing.is_empty() {
        for run in &merged.missing {
            eprintln!("missing: {run}");
        }
        eprintln!(
            "tissuebench: {} of {} runs are missing from the shares; {} is incomplete: tissuebench verify {} --resume \
             --out {} executes the missing runs",
            merged.missing.len(),
            plan.len(),
            args.out.display(),
            study.display(),
            args.out.display()
        );
        return 5;
    }
    merged.finished.set.provenance.source = folder::source(&study);
    let code = write(&merged.finished, &folder, &verify);
    close(folder, &args.out, code, || ())
}
