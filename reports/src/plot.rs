//! Data of a figure, which is drawn on paper, written as CSV next to the figure, and redrawn by the page.

use catalogue::metric::Metric;
use records::Family;
use records::cell::csv_line;
use serde::Serialize;

use crate::quantity::unit;

/// A pair of axes with its curves.
#[derive(Clone, Debug)]
pub(crate) struct Plot {
    /// Case of the plot; empty if it shows several.
    pub(crate) case: String,
    pub(crate) title: String,
    pub(crate) x: Scale,
    pub(crate) y: Scale,
    pub(crate) curves: Vec<Curve>,
}

/// An axis.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Scale {
    name: String,
    unit: &'static str,
    pub(crate) log: bool,
    shows: Shows,
}

/// Kind of the values of an axis, by which the page writes its tick labels.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Shows {
    Numbers,
    Times,
    RelativeErrors,
    /// `1/(1 - 2 nu)` of Poisson's ratios `nu`, which spreads nearly incompressible materials.
    PoissonRatios,
}

impl Scale {
    pub(crate) fn log(name: &str, unit: &'static str) -> Scale {
        Scale { log: true, ..Scale::linear(name, unit) }
    }

    pub(crate) fn linear(name: &str, unit: &'static str) -> Scale {
        Scale { name: name.into(), unit, log: false, shows: Shows::Numbers }
    }

    /// Logarithmic scale of times in seconds.
    pub(crate) fn times(name: &str) -> Scale {
        Scale { shows: Shows::Times, ..Scale::log(name, "s") }
    }

    /// Logarithmic scale of an error.
    pub(crate) fn errors(of: &'static Metric) -> Scale {
        let of = of.whole();
        let shows = if unit(of) == "1" { Shows::RelativeErrors } else { Shows::Numbers };
        Scale { shows, ..Scale::log(&of.label(), unit(of)) }
    }

    /// Logarithmic scale of Poisson's ratios `nu`, with positions `1/(1 - 2 nu)`.
    pub(crate) fn poisson_ratios() -> Scale {
        Scale { shows: Shows::PoissonRatios, ..Scale::log("Poisson's ratio ν, as 1/(1 − 2ν)", "1") }
    }

    /// Name with the unit.
    pub(crate) fn label(&self) -> String {
        format!("{} [{}]", self.name, self.unit)
    }
}

/// Curve of one method.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    pub(crate) label: String,
    pub(crate) family: Family,
    pub(crate) points: Vec<(f64, f64)>,
    /// `(x, low, high)` of an uncertainty or a range.
    pub(crate) band: Vec<(f64, f64, f64)>,
    /// Ids of the runs: one for each point, or one for all.
    pub(crate) runs: Vec<String>,
}

impl Curve {
    pub(crate) fn new(label: String, family: Family, points: Vec<(f64, f64)>, runs: Vec<String>) -> Curve {
        Curve { label, family, points, band: Vec::new(), runs }
    }
}

/// Labels with their families, which determine the looks.
pub(crate) fn labels(plots: &[Plot]) -> Vec<(String, Family)> {
    plots.iter().flat_map(|p| p.curves.iter().map(|c| (c.label.clone(), c.family))).collect()
}

/// CSV with a row for each point and for each end of a band.
pub(crate) fn csv(plots: &[Plot]) -> String {
    let mut out = csv_line(&["case", "panel", "series", "what", "x", "y", "x axis", "y axis", "run"]);
    for plot in plots {
        let axes = (plot.x.label(), plot.y.label());
        let mut row = |curve: &Curve, what: &str, at: (f64, f64), run: &str| {
            let (x, y) = (format!("{:e}", at.0), format!("{:e}", at.1));
            out.push_str(&csv_line(&[
                &plot.case,
                &plot.title,
                &curve.label,
                what,
                &x,
                &y,
                &axes.0,
                &axes.1,
                run,
            ]));
        };
        for curve in &plot.curves {
            for (k, at) in curve.points.iter().enumerate() {
                let run = if curve.runs.len() == 1 { curve.runs.first() } else { curve.runs.get(k) };
                row(curve, "value", *at, run.map_or("", String::as_str));
            }
            for (x, low, high) in &curve.band {
                row(curve, "low", (*x, *low), "");
                row(curve, "high", (*x, *high), "");
            }
        }
    }
    out
}
