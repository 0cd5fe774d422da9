//! Figures of a report, and their common parts.

mod axes;
pub(crate) mod backend;
mod bars;
mod cloud;
mod colour;
mod convergence;
mod drawing;
mod efficiency;
mod figure;
mod fit;
mod grid;
mod history;
mod locking;
mod over_commits;
mod pdf;
mod pixels;
mod profile;
mod real_time;
mod section;
mod silhouette;
mod stability;
mod style;
mod surface;
mod transfer;
mod uncertainty;

pub(crate) use drawing::png_and_pdf;
pub(crate) use figure::{Data, Figure};
pub(crate) use locking::sweeps;
pub use over_commits::svg as svg_over_commits;

use records::RunSet;

use crate::commits::Trend;
use crate::select::{Run, solved};
use crate::uncertain::Uncertain;

/// Every figure with content, in the order of the report.
pub(crate) fn all(set: &RunSet, runs: &[Run], uncertain: &[Uncertain], trends: &[Trend]) -> Vec<Figure> {
    let solved = solved(runs);
    let mut figures = efficiency::figures(&solved);
    figures.extend(real_time::figures(&solved));
    figures.extend(profile::figure(&solved));
    figures.extend(stability::maps(&set.axes));
    figures.extend(uncertainty::bands(uncertain));
    figures.extend(uncertainty::shares(uncertain));
    figures.extend(fit::figures(&set.fits));
    figures.extend(convergence::figures(&solved));
    figures.extend(locking::figures(&solved));
    figures.extend(history::forces(&solved));
    figures.extend(history::energies(&solved));
    figures.extend(history::spectra(&solved));
    figures.extend(surface::figures(&set.fields, &solved));
    figures.extend(section::figures(&set.fields, &solved));
    figures.extend(bars::rms(&solved));
    figures.extend(transfer::figures(runs));
    figures.extend(cloud::conditioning(runs));
    figures.extend(cloud::neighbours(runs));
    figures.extend(over_commits::figure(trends));
    figures
}

/// Names of the figures of errors over spacing.
pub(crate) fn of_convergence(runs: &[Run]) -> Vec<String> {
    convergence::figures(&solved(runs)).into_iter().map(|figure| figure.name).collect()
}

/// Names of the figures of uncertain results.
pub(crate) fn of_uncertainty(uncertain: &[Uncertain]) -> Vec<String> {
    let all = uncertainty::bands(uncertain).into_iter().chain(uncertainty::shares(uncertain));
    all.map(|figure| figure.name).collect()
}
