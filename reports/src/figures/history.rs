//! Histories of a closing tool (force against travel and time, and energies over time), and frequency errors
//! by mode.

use catalogue::metric::{self, Metric};
use plotters::prelude::*;
use records::Family;

use super::drawing::Drawing;
use super::figure::{Data, Figure, PAGE, continued, paged};
use super::grid::{Content, multiples};
use super::style::styles;
use crate::history::{band, between, curve, reference};
use crate::plot::{self, Curve, Plot, Scale};
use crate::select::{Run, by_case, labels, series};

/// Grey of an uncertainty band, light enough for every line on it.
const UNCERTAIN: RGBColor = RGBColor(0xd6, 0xd6, 0xd6);
/// Name and unit of an axis.
type Named = (&'static str, &'static str);

const CLOSURE: Named = ("closure", "mm");
const FORCE: Named = ("tool force", "N");
const TIME: Named = ("time", "s");
const ENERGIES: [(&Metric, &str); 9] = [
    (&metric::EXTERNAL_WORK, "work of loads and tools"),
    (&metric::WORK_ON_BODY, "work on the body"),
    (&metric::STRAIN_ENERGY, "strain"),
    (&metric::INTERNAL_WORK, "work of the stress"),
    (&metric::KINETIC_ENERGY, "kinetic"),
    (&metric::CONTACT_ENERGY, "contact springs"),
    (&metric::FRICTION_DISSIPATION, "lost in friction"),
    (&metric::DAMPING_DISSIPATION, "lost in damping"),
    (&metric::SCHEME_DISSIPATION, "lost in the scheme"),
];

/// Figures of the tool force for the finest run of every method: against travel, against time (if there is
/// one), and as the difference from the reference at the same travel, with its uncertainty.
pub(super) fn forces(runs: &[Run]) -> Vec<Figure> {
    let mut panels = Vec::new();
    for case in by_case(runs) {
        let mut all = series(case);
        // The reference is drawn below the methods compared with it.
        all.sort_by_key(|s| s.is().family != Family::Reference);
        let names = labels(all.iter().map(|s| s.is()));
        let each = |x: &'static Metric, scale: f64| -> Vec<Curve> {
            let lines = all.iter().zip(&names).map(|(s, name)| {
                let run = s.finest();
                let points = curve(run, x, &metric::TOOL_FORCE).into_iter().map(|p| (p.0 * scale, p.1));
                let around = band(run, x, &metric::TOOL_FORCE).into_iter().map(|b| (b.0 * scale, b.1, b.2));
                Curve { band: around.collect(), ..line(name.clone(), run, points.collect()) }
            });
            lines.filter(drawn).collect()
        };
        let closing = each(&metric::CLOSURE, 1e3);
        let off = against(case, &closing);
        let is = &case[0].is.case;
        panels.push(Pane::new(is, "", (CLOSURE, FORCE), closing));
        panels.push(Pane::new(is, ", over time", (TIME, FORCE), each(&metric::TIME, 1.0)));
        panels.push(Pane::new(is, ", minus the reference", (CLOSURE, ("difference of force", "N")), off));
    }
    figures(
        metric::TOOL_FORCE.name,
        "Tool force",
        "Force on the tool during closure, for the finest run of each method: over the closure, over time if the \
         scene is dynamic, and minus the reference force at the same closure",
        panels,
    )
}

/// Differences between forces and the reference at equal travel. The reference itself becomes zero with its
/// uncertainty.
fn against(case: &[Run], closing: &[Curve]) -> Vec<Curve> {
    let Some(known) = reference(case) else { return Vec::new() };
    let scaled = curve(known, &metric::CLOSURE, &metric::TOOL_FORCE).into_iter().map(|p| (p.0 * 1e3, p.1));
    let force: Vec<(f64, f64)> = scaled.collect();
    let minus = |x: f64, value: f64| Some(value - between(&force, x)?);
    let off = closing.iter().map(|line| Curve {
        points: line.points.iter().filter_map(|p| Some((p.0, minus(p.0, p.1)?))).collect(),
        band: line.band.iter().filter_map(|b| Some((b.0, minus(b.0, b.1)?, minus(b.0, b.2)?))).collect(),
        ..line.clone()
    });
    let off: Vec<Curve> = off.filter(drawn).collect();
    // Without another method, the reference only differs from itself by zero.
    if off.iter().all(|line| line.points.iter().all(|p| p.1 == 0.0)) { Vec::new() } else { off }
}

/// Figures of energies over time: one panel for the finest run of every method that recorded them.
pub(super) fn energies(runs: &[Run]) -> Vec<Figure> {
    let mut panels = Vec::new();
    for case in by_case(runs) {
        let all = series(case);
        let names = labels(all.iter().map(|s| s.is()));
        for (s, name) in all.iter().zip(names) {
            let lines = ENERGIES.iter().map(|(quantity, label)| {
                let points = curve(s.finest(), &metric::TIME, quantity).into_iter().map(|p| (p.0, p.1 * 1e3));
                let ids = vec![s.finest().is.run.clone()];
                Curve::new(label.to_string(), Family::Reference, points.collect(), ids)
            });
            // An energy that remains zero has no line, which would only lie on the axis.
            let lines = lines.filter(drawn).filter(|l| l.points.iter().any(|p| p.1 != 0.0));
            let of = format!(", {name}");
            panels.push(Pane::new(&s.is().case, &of, (TIME, ("energy", "mJ")), lines.collect()));
        }
    }
    figures(
        "energy-time",
        "Energy over time",
        "Energy balance at every step, for the finest run of each method; without numerical loss, the work of the \
         loads equals the sum of the other terms",
        panels,
    )
}

/// Figures of computed over exact frequency by mode: one panel for each mass of a case, with the finest run
/// of every method.
pub(super) fn spectra(runs: &[Run]) -> Vec<Figure> {
    let mut panels = Vec::new();
    for case in by_case(runs) {
        let all = series(case);
        let names = labels(all.iter().map(|s| s.is()));
        for mass in ["consistent", "at-points", "lumped", "transformed"] {
            let of_mass = all.iter().zip(&names).filter(|(s, _)| s.is().mass.as_deref() == Some(mass));
            let lines = of_mass.map(|(s, name)| {
                let name = name.replacen(&format!("-{mass}"), "", 1);
                let points = curve(s.finest(), &metric::MODE, &metric::OMEGA_RATIO);
                line(name, s.finest(), points)
            });
            let axes = (("mode", "1"), ("computed over exact frequency", "1"));
            panels.push(Pane::new(
                &case[0].is.case,
                &format!(", {mass} mass"),
                axes,
                lines.filter(drawn).collect(),
            ));
        }
    }
    figures(
        "spectrum",
        "Frequency spectrum",
        "Ratio of computed to exact frequency of the lowest modes in order, for the finest run of each method; a \
         spurious slow mode lies near zero and shifts all others",
        panels,
    )
}

fn line(name: String, run: &Run, points: Vec<(f64, f64)>) -> Curve {
    Curve::new(name, run.is.family, points, vec![run.is.run.clone()])
}

/// Whether a line has more than one step.
fn drawn(line: &Curve) -> bool {
    line.points.len() > 1
}

/// Data of a panel.
struct Pane {
    case: String,
    /// Part of the title after the case.
    of: String,
    /// Names and units of both axes.
    axes: (Named, Named),
    curves: Vec<Curve>,
}

impl Pane {
    fn new(case: &str, of: &str, axes: (Named, Named), curves: Vec<Curve>) -> Pane {
        Pane { case: case.into(), of: of.into(), axes, curves }
    }
}

fn figures(name: &str, title: &str, caption: &str, panels: Vec<Pane>) -> Vec<Figure> {
    let plotted = |Pane { case, of, axes, curves }: Pane| Plot {
        title: format!("{case}{of}"),
        case,
        x: Scale::linear(axes.0.0, axes.0.1),
        y: Scale::linear(axes.1.0, axes.1.1),
        curves,
    };
    let plots: Vec<Plot> = panels.into_iter().filter(|p| !p.curves.is_empty()).map(plotted).collect();
    let page = |(page, plots): (usize, &[Plot])| Figure {
        name: paged(name, page),
        title: continued(title, page),
        caption: caption.into(),
        drawing: drawing(plots),
        data: Data::Plots(plots.to_vec()),
    };
    plots.chunks(PAGE).enumerate().map(page).collect()
}

fn drawing(plots: &[Plot]) -> Drawing {
    let styles = styles(&plot::labels(plots));
    let uncertain = plots.iter().any(|p| p.curves.iter().any(|l| l.band.len() > 1));
    let content = |plot| {
        Content::of(plot, &styles).over(move |chart| {
            for band in plot.curves.iter().map(|curve| &curve.band).filter(|band| band.len() > 1) {
                let low = band.iter().map(|b| (b.0, b.1));
                let high = band.iter().rev().map(|b| (b.0, b.2));
                chart.draw_series([Polygon::new(low.chain(high).collect::<Vec<_>>(), UNCERTAIN)])?;
            }
            Ok(())
        })
    };
    let note = if uncertain { "Grey band: uncertainty of the reference." } else { "" };
    multiples(plots.iter().map(content).collect(), &styles, note)
}
