//! `tissuebench claims`: compares published claims with stored results.

use records::read_run;
use reports::{ClaimVerdict, own_claims, read_claims};

use crate::cli::args::ClaimsArgs;
use crate::cli::errors::unreported;

/// Prints the verdict of the results on each claim and returns the exit code.
pub(super) fn claims(args: &ClaimsArgs) -> u8 {
    let claims = args.file.as_deref().map_or_else(|| Ok(own_claims().to_vec()), read_claims);
    let read = claims.and_then(|claims| Ok((claims, read_run(&args.results)?)));
    let (claims, set) = match read {
        Ok(read) => read,
        Err(bad) => return unreported(bad),
    };
    let (mut tested, mut unexpected) = (0, 0);
    for claim in &claims {
        let judged = claim.judge(&set);
        println!("{}: {}: {} ({})", judged.verdict.name(), claim.id, claim.says, claim.source);
        judged.lines.iter().for_each(|line| println!("  {line}"));
        let known = judged.verdict != ClaimVerdict::Untested;
        tested += usize::from(known);
        if let Some(expected) = claim.expect.filter(|expected| known && *expected != judged.verdict) {
            eprintln!("tissuebench: {}: {} was expected", claim.id, expected.name());
            unexpected += 1;
        }
    }
    match (tested, unexpected) {
        (0, _) => 4,
        (_, 0) => 0,
        _ => 1,
    }
}
