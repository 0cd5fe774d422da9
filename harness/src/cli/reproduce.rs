//! `tissuebench reproduce`: makes stored runs again and says how far off they are.

use super::baseline::describe;
use super::colour::{self, BAD, GOOD};
use super::errors::{fail, refuse};
use crate::outcome::provenance;
use crate::study::merge::Unmerged;
use crate::study::reproduce::{Chosen, Repetition, ReproduceArgs};

/// Number of differences of a run that are printed; further ones are only counted.
const SHOWN: usize = 10;

/// Makes the runs again. Returns 0 if all numbers are those stored, and 1 otherwise.
pub(super) fn reproduce(args: &ReproduceArgs) -> u8 {
    let chosen = match Chosen::of(args) {
        Ok(chosen) => chosen,
        Err(Unmerged::Scenes(errors)) => return refuse(&errors),
        Err(Unmerged::Other(failure)) => return fail(&failure),
    };
    let (then, now) = (&chosen.from.program, provenance::program());
    if *then != now {
        println!(
            "stored by version {} ({}), made again by {} ({})",
            then.version,
            then.revision(),
            now.version,
            now.revision()
        );
    }
    let mut different = 0;
    for run in &chosen.runs {
        let again = chosen.again(run);
        different += usize::from(!again.is_same());
        print(&run.name, &again);
    }
    let count = chosen.runs.len();
    println!("made again: {count}, with the stored numbers: {}", count - different);
    u8::from(different > 0)
}

fn print(name: &str, again: &Repetition) {
    let Repetition { changes, compared, bitwise, failures, seconds: [then, now], .. } = again;
    let how = if *bitwise { "bit by bit" } else { "within 1e-6, because the kind of processor differs" };
    let verdict = match again.is_same() {
        true => colour::out(GOOD, "same    "),
        false => colour::out(BAD, "differs "),
    };
    println!("{verdict} {name}\n  {compared} numbers compared {how}; {now:.2} s for {then:.2} s");
    if let Some([then, now]) = failures {
        println!("  failure then: {then}\n  failure now: {now}");
    }
    for change in changes.iter().take(SHOWN) {
        println!("  {}", describe(change).replace('\n', "\n  "));
    }
    if changes.len() > SHOWN {
        println!("  ... and {} more", changes.len() - SHOWN);
    }
}
