//! Conditioning and neighbours of the meshfree methods as a function of the support scale.

use catalogue::metric;
use records::Family;

use super::axes::Axis;
use super::figure::{Data, Figure, PAGE, continued, paged};
use super::grid::{Content, multiples};
use super::style::{find, styles};
use crate::plot::{Curve, Plot, Scale};
use crate::select::{Run, by_case};

/// A kernel or case as `(label, points)`, each point as `(support scale, value, low, high)`.
type Line = (String, Vec<(f64, f64, f64, f64)>);

/// Condition number of the moment matrix: one panel per case, one line per kernel and basis.
pub(super) fn conditioning(runs: &[Run]) -> Vec<Figure> {
    let point = |r: &Run| {
        let (median, worst) = (r.value(&metric::CONDITION_MEDIAN), r.value(&metric::CONDITION_MAX));
        let value = median.or(worst).filter(|v| *v > 0.0)?;
        Some((value, median.unwrap_or(value), worst.unwrap_or(value)))
    };
    let panels = panels(runs, point, |r| [vec![r.is.variant.clone()], settings(r)].concat().join(", "));
    let figure = |(page, panels): (usize, &[(String, Vec<Line>)])| Figure {
        name: paged("conditioning", page),
        title: continued("Conditioning of the moment matrix", page),
        caption: "Median condition number over all integration points; the bar extends to the largest".into(),
        canvas: canvas(
            panels,
            "condition number [1]",
            true,
            "Marker: median over the points; bar: up to the largest.",
        ),
        data: Data::Plots(plotted(panels, "condition number [1]", true)),
    };
    panels.chunks(PAGE).enumerate().map(figure).collect()
}

/// Neighbours per integration point: one panel, one line per case and basis.
pub(super) fn neighbours(runs: &[Run]) -> Vec<Figure> {
    let point = |r: &Run| {
        let mean = r.value(&metric::NEIGHBOURS_MEAN)?;
        Some((
            mean,
            r.value(&metric::NEIGHBOURS_MIN).unwrap_or(mean),
            r.value(&metric::NEIGHBOURS_MAX).unwrap_or(mean),
        ))
    };
    let mut lines: Vec<Line> = Vec::new();
    for (case, of_case) in panels(runs, point, |r| settings(r).join(", ")) {
        for (basis, points) in of_case {
            let label = if basis.is_empty() { case.clone() } else { format!("{case}, {basis}") };
            lines.push((label, points));
        }
    }
    if lines.is_empty() {
        return Vec::new();
    }
    let panels = [("Neighbours".to_string(), lines)];
    vec![Figure {
        name: "neighbours".into(),
        title: "Neighbours per integration point".into(),
        caption: "Mean number of nodes whose support covers an integration point; the bar spans the smallest and the \
                  largest number".into(),
        canvas: canvas(&panels, "neighbours [1]", false, "Marker: mean over the points; bar: smallest to largest number."),
        data: Data::Plots(plotted(&panels, "neighbours [1]", false)),
    }]
}

/// Settings that are constant along a line, apart from the support scale: all that the rows of a cloud depend
/// on. Default settings are omitted: the linear basis, spherical supports, and a cloud without coupling to
/// finite elements. Other ways to prescribe displacements do not affect the rows.
fn settings(run: &Run) -> Vec<String> {
    let is = run.is;
    let basis = is.basis.clone().filter(|basis| basis != "linear");
    let coupled =
        is.essential.as_ref().filter(|e| *e == "coupling").map(|_| "coupled to elements".to_string());
    [basis, is.integration.clone(), is.neighbourhood.clone(), is.refine.clone(), coupled]
        .into_iter()
        .flatten()
        .collect()
}

/// Smallest number of support scales in a sweep. One, or two from different methods, show no trend.
const SWEEP: usize = 3;

/// Panels by case and lines by label, at the Poisson's ratio and node count with the most support scales;
/// each scale has one run.
fn panels(
    runs: &[Run],
    point: impl Fn(&Run) -> Option<(f64, f64, f64)>,
    label: impl Fn(&Run) -> String,
) -> Vec<(String, Vec<Line>)> {
    let mut out = Vec::new();
    for case in by_case(runs) {
        let mut lines: Vec<Line> = Vec::new();
        let mut labels: Vec<String> =
            case.iter().filter(|r| r.is.family == Family::Efg).map(&label).collect();
        labels.sort();
        labels.dedup();
        for name in labels {
            let mut best: Vec<(f64, f64, f64, f64)> = Vec::new();
            let own: Vec<&Run> =
                case.iter().filter(|r| r.is.family == Family::Efg && label(r) == name).collect();
            let mut sizes: Vec<(u64, u64)> =
                own.iter().map(|r| (r.is.nodes, r.is.poisson.to_bits())).collect();
            sizes.sort();
            sizes.dedup();
            for size in sizes {
                let mut points: Vec<(f64, f64, f64, f64)> = own
                    .iter()
                    .filter(|r| (r.is.nodes, r.is.poisson.to_bits()) == size)
                    .filter_map(|r| {
                        point(r).zip(r.is.support_scale).map(|((v, low, high), d)| (d, v, low, high))
                    })
                    .collect();
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                points.dedup_by(|a, b| a.0 == b.0);
                if points.len() >= best.len() {
                    best = points;
                }
            }
            if best.len() >= SWEEP {
                lines.push((name, best));
            }
        }
        if !lines.is_empty() {
            out.push((case[0].is.case.clone(), lines));
        }
    }
    out
}

/// The panels as data; the title of a panel of a case is the case name.
fn plotted(panels: &[(String, Vec<Line>)], y: &str, log: bool) -> Vec<Plot> {
    let curve = |(label, at): &Line| Curve {
        band: at.iter().map(|p| (p.0, p.2, p.3)).collect(),
        ..Curve::new(label.clone(), Family::Efg, at.iter().map(|p| (p.0, p.1)).collect(), Vec::new())
    };
    let plot = |(title, lines): &(String, Vec<Line>)| Plot {
        case: if log { title.clone() } else { String::new() },
        title: title.clone(),
        x: Scale::linear("support radius / node spacing [1]"),
        y: Scale { label: y.into(), log },
        curves: lines.iter().map(curve).collect(),
    };
    panels.iter().map(plot).collect()
}

fn canvas(panels: &[(String, Vec<Line>)], y: &str, log: bool, note: &str) -> super::canvas::Canvas {
    let styles = styles(
        &panels.iter().flat_map(|p| p.1.iter().map(|l| (l.0.clone(), Family::Efg))).collect::<Vec<_>>(),
    );
    let contents = panels
        .iter()
        .map(|(title, lines)| {
            let points = || lines.iter().flat_map(|l| l.1.iter());
            let values = || points().flat_map(|p| [p.1, p.2, p.3]);
            let styles = &styles;
            Content {
                title: title.clone(),
                x: Axis::linear("support radius / node spacing [1]", points().map(|p| p.0), false)
                    .with_ticks(ticks(points().map(|p| p.0).collect())),
                y: if log { Axis::log(y, values()) } else { Axis::linear(y, values(), true) },
                plot: Box::new(move |canvas, panel| {
                    for (i, (label, points)) in lines.iter().enumerate() {
                        let Some(style) = find(styles, label) else { continue };
                        // Bars are placed side by side, because they would hide each other.
                        let aside = 2.4 * (i as f64 - 0.5 * (lines.len() as f64 - 1.0));
                        let place = |x: f64, y: f64| {
                            let at = panel.at(x, y);
                            (at.0 + aside, at.1)
                        };
                        for p in points {
                            canvas.line(&[place(p.0, p.2), place(p.0, p.3)], style.look.colour, 0.8);
                        }
                        let at: Vec<_> = points.iter().map(|p| place(p.0, p.1)).collect();
                        style.curve(canvas, &at);
                    }
                }),
            }
        })
        .collect();
    multiples(contents, &styles, note)
}

/// Ticks at the support scales.
fn ticks(mut values: Vec<f64>) -> Vec<(f64, String)> {
    values.sort_by(f64::total_cmp);
    let span = values.last().zip(values.first()).map_or(0.0, |(high, low)| high - low);
    values.dedup_by(|next, kept| *next - *kept <= 0.06 * span);
    values.into_iter().map(|v| (v, v.to_string())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blank::Blank as _;
    use crate::select::runs;
    use records::Record;

    #[test]
    fn coupled_clouds_are_no_points_of_a_line_of_plain_ones() {
        let cloud = |method: &str, scale: f64, essential: &str, condition: f64| {
            Record {
                case: "block".into(),
                method: method.into(),
                family: Family::Efg,
                variant: "cubic-spline".into(),
                basis: Some("linear".into()),
                integration: Some("gauss-4".into()),
                essential: Some(essential.into()),
                support_scale: Some(scale),
                nodes: 216,
                value: condition,
                ..Record::blank()
            }
            .with(&metric::CONDITION_MEDIAN)
            .of_its_run()
        };
        let mut records = vec![cloud("a-coupled", 1.6, "coupling", 9e4)];
        for (scale, condition) in [(1.2, 31.0), (1.6, 23.0), (2.0, 24.0)] {
            records.push(cloud("plain", scale, "nitsche", condition));
        }
        let lines = |records: &[Record]| {
            let point = |r: &Run| r.value(&metric::CONDITION_MEDIAN).map(|v| (v, v, v));
            panels(&runs(records), point, |r| settings(r).join(", ")).remove(0).1
        };
        let plain = (
            "gauss-4".to_string(),
            [(1.2, 31.0), (1.6, 23.0), (2.0, 24.0)].map(|(d, v)| (d, v, v, v)).to_vec(),
        );
        assert_eq!(lines(&records), std::slice::from_ref(&plain));
        // A sweep of coupled clouds is a separate line.
        records.extend([1.2, 2.0].map(|scale| cloud("a-coupled", scale, "coupling", 9e4)));
        let both = lines(&records);
        assert_eq!(
            (both[0].clone(), both[1].0.as_str(), both.len()),
            (plain, "gauss-4, coupled to elements", 2)
        );
    }
}
