//! What happens while a tool closes, its force over the closure and where the energy is over time; and how frequencies go
//! wrong from mode to mode.

use super::axes::Axis;
use super::canvas::{Canvas, Colour};
use super::grid::{Content, multiples};
use super::style::{find, styles};
use super::{Data, Figure, PAGE, continued, paged};
use crate::history::{band, curve};
use crate::plot::{self, Curve, Plot, Scale};
use crate::record::Family;
use crate::select::{Run, by_case, labels, series};

/// Grey of an uncertainty, light enough for every line over it.
const UNCERTAIN: Colour = [0xd6, 0xd6, 0xd6];
/// Markers on one line: more would hide it.
const MARKS: usize = 12;
const ENERGIES: [(&str, &str); 9] = [
    ("external-work", "work of loads and tools"),
    ("work-on-body", "work on the body"),
    ("strain-energy", "strain"),
    ("internal-work", "work of the stress"),
    ("kinetic-energy", "kinetic"),
    ("contact-energy", "contact springs"),
    ("friction-dissipation", "lost in friction"),
    ("damping-dissipation", "lost in damping"),
    ("scheme-dissipation", "lost in the scheme"),
];

/// Names and units of both axes.
type Axes = (&'static str, &'static str);

/// Tool force over closure: one panel per case, the finest run of every method, the reference with its uncertainty.
pub(super) fn forces(runs: &[Run]) -> Vec<Figure> {
    let mut panels = Vec::new();
    for case in by_case(runs) {
        let mut all = series(case);
        // The reference lies below what is compared with it.
        all.sort_by_key(|s| s.is().family != Family::Reference);
        let names = labels(all.iter().map(|s| s.is()));
        let lines = all.iter().zip(names).map(|(s, name)| {
            let run = s.finest();
            let points = curve(run, "closure", "tool-force").into_iter().map(|p| (p.0 * 1e3, p.1));
            let around = band(run, "closure", "tool-force").into_iter().map(|b| (b.0 * 1e3, b.1, b.2));
            Curve { band: around.collect(), ..line(name, run, points.collect()) }
        });
        panels.push((case[0].is.case.clone(), String::new(), lines.filter(drawn).collect()));
    }
    figures(
        "tool-force",
        "Tool force against closure",
        "Force on the tool while it closes, the finest run of each method",
        ("closure [mm]", "tool force [N]"),
        panels,
    )
}

/// Energies over time: one panel for the finest run of every method that recorded them.
pub(super) fn energies(runs: &[Run]) -> Vec<Figure> {
    let mut panels = Vec::new();
    for case in by_case(runs) {
        let all = series(case);
        let names = labels(all.iter().map(|s| s.is()));
        for (s, name) in all.iter().zip(names) {
            let lines = ENERGIES.iter().map(|(quantity, label)| {
                let points = curve(s.finest(), "time", quantity).into_iter().map(|p| (p.0, p.1 * 1e3));
                let ids = vec![s.finest().is.run.clone()];
                Curve::new(label.to_string(), Family::Reference, points.collect(), ids)
            });
            // What stays nothing has no line: it would only lie on the axis.
            let lines = lines.filter(drawn).filter(|l| l.points.iter().any(|p| p.1 != 0.0));
            panels.push((s.is().case.clone(), format!(", {name}"), lines.collect()));
        }
    }
    figures(
        "energy-time",
        "Energy over time",
        "Where the energy is at every step, the finest run of each method; the work of the loads is the sum of the others where none is lost",
        ("time [s]", "energy [mJ]"),
        panels,
    )
}

/// Computed over exact frequency, mode by mode: one panel for each mass of a case, the finest run of every method.
pub(super) fn spectra(runs: &[Run]) -> Vec<Figure> {
    let mut panels = Vec::new();
    for case in by_case(runs) {
        let all = series(case);
        let names = labels(all.iter().map(|s| s.is()));
        for mass in ["consistent", "lumped", "transformed"] {
            let of_mass = all.iter().zip(&names).filter(|(s, _)| s.is().mass.as_deref() == Some(mass));
            let lines = of_mass.map(|(s, name)| {
                let name = name.replacen(&format!("-{mass}"), "", 1);
                let points = curve(s.finest(), "mode", "omega-ratio");
                line(name, s.finest(), points)
            });
            panels.push((case[0].is.case.clone(), format!(", {mass} mass"), lines.filter(drawn).collect()));
        }
    }
    figures(
        "spectrum",
        "Frequency spectrum",
        "Computed over exact frequency of the lowest modes in order, the finest run of each method; a spurious slow mode lies near zero and \
         shifts all others",
        ("mode [1]", "computed over exact frequency [1]"),
        panels,
    )
}

fn line(name: String, run: &Run, points: Vec<(f64, f64)>) -> Curve {
    Curve::new(name, run.is.family, points, vec![run.is.run.clone()])
}

/// A single step is no history.
fn drawn(line: &Curve) -> bool {
    line.points.len() > 1
}

/// Case, what follows it in the title, and lines.
type Paned = (String, String, Vec<Curve>);

fn figures(name: &str, title: &str, caption: &str, axes: Axes, panels: Vec<Paned>) -> Vec<Figure> {
    let plotted = |(case, of, curves): Paned| Plot {
        title: format!("{case}{of}"),
        case,
        x: Scale::linear(axes.0),
        y: Scale::linear(axes.1),
        curves,
    };
    let plots: Vec<Plot> = panels.into_iter().filter(|p| !p.2.is_empty()).map(plotted).collect();
    let page = |(page, plots): (usize, &[Plot])| Figure {
        name: paged(name, page),
        title: continued(title, page),
        caption: caption.into(),
        canvas: canvas(plots),
        data: Data::Plots(plots.to_vec()),
    };
    plots.chunks(PAGE).enumerate().map(page).collect()
}

fn canvas(plots: &[Plot]) -> Canvas {
    let styles = styles(&plot::labels(plots));
    let uncertain = plots.iter().any(|p| p.curves.iter().any(|l| l.band.len() > 1));
    let contents = plots
        .iter()
        .map(|plot| {
            let lines = &plot.curves;
            let points = || lines.iter().flat_map(|l| l.points.iter());
            let ends = || lines.iter().flat_map(|l| l.band.iter().flat_map(|b| [b.1, b.2]));
            let styles = &styles;
            Content {
                title: plot.title.clone(),
                x: Axis::linear(&plot.x.label, points().map(|p| p.0), true),
                y: Axis::linear(&plot.y.label, points().map(|p| p.1).chain(ends()), true),
                plot: Box::new(move |canvas, panel| {
                    for around in lines.iter().map(|l| &l.band).filter(|band| band.len() > 1) {
                        let low = around.iter().map(|b| panel.at(b.0, b.1));
                        let high = around.iter().rev().map(|b| panel.at(b.0, b.2));
                        canvas.fill(&low.chain(high).collect::<Vec<_>>(), UNCERTAIN);
                    }
                    for line in lines {
                        let Some(style) = find(styles, &line.label) else { continue };
                        let at: Vec<_> = line.points.iter().map(|p| panel.at(p.0, p.1)).collect();
                        canvas.dashed(&at, style.look.colour, 1.3, style.look.dash);
                        for at in at.iter().step_by(at.len().div_ceil(MARKS)) {
                            style.mark(canvas, *at);
                        }
                    }
                }),
            }
        })
        .collect();
    multiples(contents, &styles, if uncertain { "Grey band: uncertainty of the reference." } else { "" })
}
