//! Tables of a report, and their common parts.

mod cheapest;
mod closure;
mod conditioning;
mod cost;
mod error_split;
mod errors;
mod face_results;
mod fit;
mod modes;
mod orders;
mod outcome;
mod over_commits;
mod peers;
mod placement;
mod published;
mod real_time;
mod repeated;
mod solvers;
mod stability;
mod timing;
mod transfer;
mod uncertainty;

pub(crate) use error_split::{Parts as ErrorParts, parts as error_parts};

use records::RunSet;

use crate::clouds::Clouds;
use crate::commits::Trend;
use crate::select::Run;
use crate::table::Table;
use crate::uncertain::Uncertain;

/// Every table with at least one row, in the order of the report.
pub(crate) fn all(
    set: &RunSet,
    (runs, clouds): (&[Run], &[Clouds]),
    uncertain: &[Uncertain],
    trends: &[Trend],
) -> Vec<Table> {
    let tables = [
        cheapest::within(runs),
        stability::stability(set),
        uncertainty::uncertainty(uncertain),
        uncertainty::shares(uncertain),
        fit::constants(&set.fits),
        fit::correlations(&set.fits),
        fit::quality(&set.fits),
        errors::relative(runs),
        errors::rms(runs),
        errors::maxima(runs),
        face_results::supports(runs),
        face_results::foundations(runs),
        face_results::support_moments(runs),
        face_results::tool_moments(runs),
        face_results::means(runs),
        face_results::probes(runs),
        face_results::probe_stresses(runs),
        face_results::peaks(runs),
        face_results::stretches(runs),
        face_results::volumes(runs),
        face_results::energies(runs),
        orders::observed(runs),
        orders::convergence_index(runs),
        modes::modes(runs),
        face_results::frequencies(runs),
        timing::phases(runs, &set.provenance.machine),
        repeated::repeated(runs),
        real_time::real_time(runs),
        cost::cost(runs),
        transfer::schemes(runs),
        error_split::error_split(runs),
        conditioning::conditioning(runs),
        placement::placement(clouds),
        published::beside_ours(runs),
        published::rms_parts(runs),
        closure::force_closure(runs),
        solvers::solvers(set),
        peers::peers(runs),
        outcome::checks(set),
        outcome::failures(set),
        outcome::warnings(set),
        outcome::plan(set),
        over_commits::over_commits(trends),
    ];
    tables.into_iter().filter(|t| !t.is_empty()).collect()
}
