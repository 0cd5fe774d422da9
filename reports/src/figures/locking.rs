//! Error against Poisson's ratio at one size, which shows locking.

use catalogue::metric::{self, Metric};
use records::Family;

use super::axes::Axis;
use super::efficiency::helper;
use super::figure::{Data, Figure, PAGE, continued, paged};
use super::grid::{Content, multiples};
use super::style::styles;
use crate::fronts::FLOOR;
use crate::plot::{self, Curve, Plot, Scale};
use crate::select::{Run, competing, labels};

/// A quantity that shows locking.
struct Measure {
    metric: &'static Metric,
    /// Name in titles.
    what: &'static str,
}

impl Measure {
    /// Whether the quantity is an error; otherwise it is a ratio to the exact value.
    fn is_error(&self) -> bool {
        self.metric.lower_is_better()
    }
}

static MEASURES: [Measure; 3] = [
    Measure { metric: &metric::L2, what: "displacement" },
    Measure { metric: &metric::PRESSURE, what: "pressure" },
    Measure { metric: &metric::TIP, what: "tip deflection" },
];

/// A method as `(label, family, runs of one size by ascending Poisson's ratio)`.
pub(crate) type Sweep<'r> = (String, Family, Vec<Run<'r>>);

/// Solvers of a case that ran at two or more Poisson's ratios, at their middle size.
pub(crate) fn sweeps<'r>(case: &[Run<'r>]) -> Vec<Sweep<'r>> {
    let mut found: Vec<Vec<Run<'r>>> = Vec::new();
    for run in case {
        let same = |s: &&mut Vec<Run>| {
            let is = s[0].is;
            (&is.method, &is.variant, is.settings(), is.nodes, is.seed)
                == (&run.is.method, &run.is.variant, run.is.settings(), run.is.nodes, run.is.seed)
        };
        match found.iter_mut().find(same) {
            Some(sweep) => sweep.push(run.clone()),
            None => found.push(vec![run.clone()]),
        }
    }
    found.retain(|s| s.len() > 1);
    let mut picked: Vec<Vec<Run<'r>>> = Vec::new();
    let approximation = |s: &[Run<'r>]| (s[0].name(), &s[0].is.variant, s[0].is.settings(), s[0].is.seed);
    for sweep in &found {
        if picked.iter().any(|p| approximation(p) == approximation(sweep)) {
            continue;
        }
        let mut sizes: Vec<&Vec<Run<'r>>> =
            found.iter().filter(|s| approximation(s) == approximation(sweep)).collect();
        let most = sizes.iter().map(|s| s.len()).max().unwrap_or(0);
        sizes.retain(|s| s.len() == most);
        sizes.sort_by_key(|s| s[0].is.nodes);
        picked.push(sizes[sizes.len() / 2].clone());
    }
    let labels = labels(picked.iter().map(|s| s[0].is));
    labels.into_iter().zip(picked).map(|(label, s)| (label, s[0].is.family, s)).collect()
}

/// Figures of displacement error, pressure error and tip deflection for every case with such sweeps.
pub(super) fn figures(runs: &[Run]) -> Vec<Figure> {
    let mut panels = Vec::new();
    for case in competing(runs) {
        let sweeps = sweeps(case);
        for measure in &MEASURES {
            let drawn =
                sweeps.iter().any(|s| s.2.iter().filter(|r| usable(r, measure).is_some()).count() > 1);
            if drawn {
                panels.push((case[0].is.case.clone(), measure, sweeps.clone()));
            }
        }
    }
    panels.chunks(PAGE).enumerate().map(|(page, panels)| figure(page, panels)).collect()
}

fn usable(run: &Run, measure: &Measure) -> Option<f64> {
    run.value(measure.metric).map(|v| if measure.is_error() { v.max(FLOOR) } else { v })
}

/// A measure that grows without bound as the material becomes incompressible.
fn stiffness(poisson: f64) -> f64 {
    1.0 / (1.0 - 2.0 * poisson)
}

fn figure(page: usize, panels: &[(String, &'static Measure, Vec<Sweep>)]) -> Figure {
    let plots: Vec<Plot> = panels.iter().map(plotted).collect();
    let styles = styles(&plot::labels(&plots));
    let contents = plots.iter().zip(panels).map(|(plot, (case, measure, sweeps))| {
        let drawn = sweeps.iter().flat_map(|s| &s.2).filter(|r| usable(r, measure).is_some());
        let mut ratios: Vec<f64> = drawn.map(|r| r.is.poisson).collect();
        ratios.sort_by(f64::total_cmp);
        ratios.dedup();
        let points = || plot.curves.iter().flat_map(|curve| &curve.points);
        let content = Content {
            title: format!("{case}: {}", measure.what),
            x: Axis::of(&plot.x, points().map(|p| p.0)).with_ticks(spread_out(&ratios)),
            // A ratio is compared with one.
            y: Axis::of(&plot.y, points().map(|p| p.1).chain((!measure.is_error()).then_some(1.0))),
            ..Content::of(plot, &styles)
        };
        content.over(move |chart| {
            let x = chart.x_range();
            let one = helper(vec![(x.start, 1.0), (x.end, 1.0)]);
            chart.draw_series((!measure.is_error()).then_some(one))?;
            Ok(())
        })
    });
    Figure {
        name: paged("locking", page),
        title: continued("Locking: error against Poisson's ratio", page),
        caption: "Each method at one size as the material becomes incompressible; the error of a method that locks \
                  grows to the right, and its tip deflection falls".into(),
        drawing: multiples(contents.collect(), &styles, "Errors below 10⁻⁶ are drawn at 10⁻⁶."),
        data: Data::Plots(plots),
    }
}

/// Data of a panel, as a function of 1/(1 - 2 nu).
fn plotted((case, measure, sweeps): &(String, &'static Measure, Vec<Sweep>)) -> Plot {
    let curve = |(name, family, runs): &Sweep| {
        let own = runs.iter().filter_map(|r| Some((r, usable(r, measure)?)));
        let (points, ids) = own.map(|(r, y)| ((stiffness(r.is.poisson), y), r.is.run.clone())).unzip();
        Curve::new(name.clone(), *family, points, ids)
    };
    let y = if measure.is_error() {
        Scale::errors(measure.metric)
    } else {
        Scale::linear("tip deflection / exact", "1")
    };
    Plot {
        case: case.clone(),
        title: format!("{case}: {} against Poisson's ratio", measure.what),
        x: Scale::poisson_ratios(),
        y,
        curves: sweeps.iter().map(curve).collect(),
    }
}

/// Ticks at the ratios, omitting those too close to the previous tick.
fn spread_out(ratios: &[f64]) -> Vec<(f64, String)> {
    let mut ticks: Vec<(f64, String)> = Vec::new();
    let whole = ratios.last().map_or(1.0, |r| stiffness(*r).ln().max(1.0));
    for ratio in ratios {
        let at = stiffness(*ratio);
        if ticks.last().is_none_or(|t| (at / t.0).ln() > 0.1 * whole) {
            ticks.push((at, ratio.to_string()));
        }
    }
    ticks
}
