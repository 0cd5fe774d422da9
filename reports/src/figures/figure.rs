//! A figure with its data.

use super::drawing::Drawing;
use crate::plot::{Plot, csv};

/// Largest number of panels on a figure.
pub(super) const PAGE: usize = 6;

/// A named drawing.
pub(crate) struct Figure {
    pub(crate) name: String,
    pub(crate) title: String,
    pub(crate) caption: String,
    pub(crate) drawing: Drawing,
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
pub(super) struct Pictured {
    pub(super) corners: [(f64, f64); 3],
    pub(super) value: f64,
}

/// Title of a page; further pages have their number.
pub(super) fn continued(title: &str, page: usize) -> String {
    if page == 0 { title.into() } else { format!("{title}, page {}", page + 1) }
}

/// Name of a page; further pages have their number.
pub(super) fn paged(name: &str, page: usize) -> String {
    if page == 0 { name.into() } else { format!("{name}-{}", page + 1) }
}
