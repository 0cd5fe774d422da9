//! Figures of a report, and their common parts.

mod axes;
mod backend;
mod bars;
mod canvas;
mod cloud;
mod colour;
mod convergence;
mod efficiency;
mod grid;
mod history;
mod locking;
mod over_commits;
mod pdf;
mod pixels;
mod profile;
mod section;
mod silhouette;
mod stability;
mod style;
mod surface;
mod transfer;

pub(crate) use canvas::{Canvas, png_and_pdf};
pub(crate) use locking::sweeps;
pub use over_commits::svg as svg_over_commits;

use records::RunSet;

use crate::commits::Trend;
use crate::plot::{Plot, csv};
use crate::select::{Run, solved};

/// Largest number of panels on a figure.
const PAGE: usize = 6;

/// A named drawing.
pub(crate) struct Figure {
    pub(crate) name: String,
    pub(crate) title: String,
    pub(crate) caption: String,
    pub(crate) canvas: Canvas,
    pub(crate) data: Data,
}

/// Data of a figure, so that it can be read and redrawn.
pub(crate) enum Data {
    /// Curves over axes.
    Plots(Vec<Plot>),
    /// Curves of time against error, which the page draws from the runs that answer its questions.
    Fronts(Vec<Plot>),
    /// Rows of CSV.
    Rows(String),
    /// Case of a picture of its body, whose numbers are in the folder `fields` of the results.
    Picture(String),
}

impl Data {
    /// The data as CSV, `None` for a picture.
    pub(crate) fn csv(&self) -> Option<String> {
        match self {
            Data::Plots(plots) | Data::Fronts(plots) => Some(csv(plots)),
            Data::Rows(rows) => Some(rows.clone()),
            Data::Picture(_) => None,
        }
    }
}

/// A triangle on paper with its value.
struct Pictured {
    corners: [[f64; 2]; 3],
    value: f64,
}

/// Every figure with content, in the order of the report.
pub(crate) fn all(set: &RunSet, runs: &[Run], trends: &[Trend]) -> Vec<Figure> {
    let solved = solved(runs);
    let mut figures = efficiency::figures(&solved);
    figures.extend(profile::figure(&solved));
    figures.extend(stability::maps(&set.axes));
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

/// Title of a page; further pages have their number.
fn continued(title: &str, page: usize) -> String {
    if page == 0 { title.into() } else { format!("{title}, page {}", page + 1) }
}

/// Name of a page; further pages have their number.
fn paged(name: &str, page: usize) -> String {
    if page == 0 { name.into() } else { format!("{name}-{}", page + 1) }
}
