//! Conditioning and neighbours of the meshfree methods as a function of the support scale.

use catalogue::metric;
use plotters::prelude::*;
use records::Family;

use super::axes::Axis;
use super::drawing::Drawing;
use super::figure::{Data, Figure, PAGE, continued, paged};
use super::grid::{Content, multiples};
use super::style::{find, styles};
use crate::plot::{self, Curve, Plot, Scale};
use crate::select::{Run, by_case};

const SCALES: &str = "support radius / node spacing";

/// Condition number of the moment matrix: one panel per case, one line per kernel and basis.
pub(super) fn conditioning(runs: &[Run]) -> Vec<Figure> {
    let point = |r: &Run| {
        let (median, worst) = (r.value(&metric::CONDITION_MEDIAN), r.value(&metric::CONDITION_MAX));
        let value = median.or(worst).filter(|v| *v > 0.0)?;
        Some((value, median.unwrap_or(value), worst.unwrap_or(value)))
    };
    let label = |r: &Run| [vec![r.is.variant.clone()], settings(r)].concat().join(", ");
    let plot = |(case, curves): (String, Vec<Curve>)| Plot {
        title: case.clone(),
        case,
        x: Scale::linear(SCALES, "1"),
        y: Scale::log("condition number", "1"),
        curves,
    };
    let plots: Vec<Plot> = panels(runs, point, label).into_iter().map(plot).collect();
    let figure = |(page, plots): (usize, &[Plot])| Figure {
        name: paged("conditioning", page),
        title: continued("Conditioning of the moment matrix", page),
        caption: "Median condition number over all integration points; the bar extends to the largest".into(),
        drawing: drawing(plots, "Marker: median over the points; bar: up to the largest."),
        data: Data::Plots(plots.to_vec()),
    };
    plots.chunks(PAGE).enumerate().map(figure).collect()
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
    let mut curves = Vec::new();
    for (case, of_case) in panels(runs, point, |r| settings(r).join(", ")) {
        for curve in of_case {
            let label =
                if curve.label.is_empty() { case.clone() } else { format!("{case}, {}", curve.label) };
            curves.push(Curve { label, ..curve });
        }
    }
    if curves.is_empty() {
        return Vec::new();
    }
    let (x, y) = (Scale::linear(SCALES, "1"), Scale::linear("neighbours", "1"));
    let plots = vec![Plot { case: String::new(), title: "Neighbours".into(), x, y, curves }];
    vec![Figure {
        name: "neighbours".into(),
        title: "Neighbours per integration point".into(),
        caption: "Mean number of nodes whose support covers an integration point; the bar spans the smallest and the \
                  largest number".into(),
        drawing: drawing(&plots, "Marker: mean over the points; bar: smallest to largest number."),
        data: Data::Plots(plots),
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
/// each scale has one run. `point` gives the value, its low and its high.
fn panels(
    runs: &[Run],
    point: impl Fn(&Run) -> Option<(f64, f64, f64)>,
    label: impl Fn(&Run) -> String,
) -> Vec<(String, Vec<Curve>)> {
    let mut out = Vec::new();
    for case in by_case(runs) {
        let mut lines: Vec<Curve> = Vec::new();
        let mut labels: Vec<String> =
            case.iter().filter(|r| r.is.family == Family::Efg).map(&label).collect();
        labels.sort();
        labels.dedup();
        for name in labels {
            let mut best: Vec<(f64, (f64, f64, f64))> = Vec::new();
            let own: Vec<&Run> =
                case.iter().filter(|r| r.is.family == Family::Efg && label(r) == name).collect();
            let mut sizes: Vec<(u64, u64)> =
                own.iter().map(|r| (r.is.nodes, r.is.poisson.to_bits())).collect();
            sizes.sort();
            sizes.dedup();
            for size in sizes {
                let same = own.iter().filter(|r| (r.is.nodes, r.is.poisson.to_bits()) == size);
                let mut points: Vec<_> = same.filter_map(|r| r.is.support_scale.zip(point(r))).collect();
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                points.dedup_by(|a, b| a.0 == b.0);
                if points.len() >= best.len() {
                    best = points;
                }
            }
            if best.len() >= SWEEP {
                let points = best.iter().map(|(scale, value)| (*scale, value.0)).collect();
                let band = best.iter().map(|(scale, value)| (*scale, value.1, value.2)).collect();
                lines.push(Curve { band, ..Curve::new(name, Family::Efg, points, Vec::new()) });
            }
        }
        if !lines.is_empty() {
            out.push((case[0].is.case.clone(), lines));
        }
    }
    out
}

fn drawing(plots: &[Plot], note: &str) -> Drawing {
    let styles = styles(&plot::labels(plots));
    let contents = plots.iter().map(|plot| {
        let scales = || plot.curves.iter().flat_map(|curve| curve.points.iter().map(|p| p.0));
        let styles = &styles;
        Content {
            x: Axis::linear(&plot.x.label(), scales(), false).with_ticks(ticks(scales().collect())),
            series: Box::new(move |chart| {
                let x = chart.x_range();
                for (i, curve) in plot.curves.iter().enumerate() {
                    let Some(style) = find(styles, &curve.label) else { continue };
                    // Bars are placed side by side, because they would hide each other.
                    let aside =
                        ASIDE * (x.end - x.start) * (i as f64 - 0.5 * (plot.curves.len() as f64 - 1.0));
                    let points: Vec<_> = curve.points.iter().map(|p| (p.0 + aside, p.1)).collect();
                    let thin = style.look.colour.stroke_width(8);
                    let bars = points.iter().zip(&curve.band);
                    chart.draw_series(
                        bars.map(|(p, b)| ErrorBar::new_vertical(p.0, b.1, p.1, b.2, thin, 24)),
                    )?;
                    style.curve(chart, &points, 1)?;
                }
                Ok(())
            }),
            ..Content::of(plot, styles)
        }
    });
    multiples(contents.collect(), &styles, note)
}

/// Distance between the bars of neighbouring curves over the length of the axis.
const ASIDE: f64 = 0.015;

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
        let found = |records: &[Record]| -> Vec<(String, Vec<(f64, f64)>)> {
            lines(records).into_iter().map(|curve| (curve.label, curve.points)).collect()
        };
        let plain = ("gauss-4".to_string(), vec![(1.2, 31.0), (1.6, 23.0), (2.0, 24.0)]);
        assert_eq!(lines(&records)[0].band, [(1.2, 31.0, 31.0), (1.6, 23.0, 23.0), (2.0, 24.0, 24.0)]);
        assert_eq!(found(&records), std::slice::from_ref(&plain));
        // A sweep of coupled clouds is a separate line.
        records.extend([1.2, 2.0].map(|scale| cloud("a-coupled", scale, "coupling", 9e4)));
        let both = found(&records);
        assert_eq!(
            (both[0].clone(), both[1].0.as_str(), both.len()),
            (plain, "gauss-4, coupled to elements", 2)
        );
    }
}
