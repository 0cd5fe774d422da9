//! Fitted curves over the measured points, with their residuals.

use catalogue::metric;
use plotters::prelude::*;
use records::cell::csv_line;
use records::store::slug;
use records::{Fit, FitPoint};

use super::axes::Axis;
use super::drawing::{BLACK_INK, GREY};
use super::figure::{Data, Figure};
use super::grid::{Content, Series, multiples};
use super::style::{find, styles};
use crate::quantity;

/// Radius of a measured point.
const POINT: i32 = 28;

/// A figure for each fit.
pub(super) fn figures(fits: &[Fit]) -> Vec<Figure> {
    fits.iter().map(figure).collect()
}

/// Factors from SI to what the axes show.
struct Axes {
    across: f64,
    up: f64,
}

fn figure(fit: &Fit) -> Figure {
    let x = metric::find(&fit.along).unwrap_or(metric::CLOSURE.whole());
    let y = metric::find(&fit.of).unwrap_or(metric::TOOL_FORCE.whole());
    let axes = Axes { across: quantity::scale(x), up: quantity::scale(y) };
    let styles = styles(&[(fit.method.clone(), fit.family)]);
    let line: Vec<(f64, f64)> = fit.curve.iter().map(|(x, y)| (x * axes.across, y * axes.up)).collect();
    let series: Series = Box::new(|chart| {
        if let Some(style) = find(&styles, &fit.method) {
            style.curve(chart, &line, line.len().div_ceil(12))?;
        }
        points(fit, &axes, |point| point.measured).into_iter().try_for_each(|(at, bar)| {
            chart.draw_series([PathElement::new(bar, BLACK_INK.stroke_width(8))])?;
            chart.draw_series([Circle::new(at, POINT, BLACK_INK.filled())])?;
            Ok(())
        })
    });
    let label = quantity::label(y);
    let ends =
        |of: fn(&FitPoint) -> f64| points(fit, &axes, of).into_iter().flat_map(|(_, bar)| bar.map(|p| p.1));
    let measured = Content {
        title: fit.case.clone(),
        x: Axis::linear(&quantity::label(x), line.iter().map(|p| p.0), true),
        y: Axis::linear(&label, ends(|point| point.measured).chain(line.iter().map(|p| p.1)), true),
        series,
    };
    let apart = |point: &FitPoint| point.measured - point.fitted;
    let ahead = line.iter().map(|p| p.0).fold(0.0, f64::max);
    let series: Series = Box::new(|chart| {
        chart.draw_series([PathElement::new([(0.0, 0.0), (ahead, 0.0)], GREY.stroke_width(8))])?;
        points(fit, &axes, apart).into_iter().try_for_each(|(at, bar)| {
            chart.draw_series([PathElement::new(bar, BLACK_INK.stroke_width(8))])?;
            chart.draw_series([Circle::new(at, POINT, BLACK_INK.filled())])?;
            Ok(())
        })
    });
    let residual = Content {
        title: "Residuals".into(),
        x: Axis::linear(&quantity::label(x), line.iter().map(|p| p.0), true),
        y: Axis::linear(&format!("measured minus fitted [{}]", quantity::unit(y)), ends(apart), true),
        series,
    };
    let bars = if fit.points.iter().any(|point| point.sd.is_some()) {
        ", with bars of the stated standard deviations"
    } else {
        ""
    };
    let note = format!("Dots: measured{bars}. Line: the scene with the fitted constants.");
    let drawing = multiples(vec![measured, residual], &styles, &note);
    Figure {
        name: format!("fit-{}-{}", slug(&fit.case), slug(&fit.method)),
        title: format!("Fit of the {} of {}", y.label(), fit.data),
        caption: format!(
            "Measured {} with that of the fitted scene, and the residuals, whose RMS is {} {}",
            y.label(),
            records::text::significant(fit.rms * axes.up, 3),
            quantity::unit(y)
        ),
        drawing,
        data: Data::Rows(csv(fit)),
    }
}

/// Places of the points on an axis, with the ends of their bars.
type Places = Vec<((f64, f64), [(f64, f64); 2])>;

fn points(fit: &Fit, axes: &Axes, of: fn(&FitPoint) -> f64) -> Places {
    let place = |point: &FitPoint| {
        let (x, y, bar) = (point.x * axes.across, of(point) * axes.up, point.sd.unwrap_or(0.0) * axes.up);
        ((x, y), [(x, y - bar), (x, y + bar)])
    };
    fit.points.iter().map(place).collect()
}

/// The points, then the curve at its load steps, SI.
fn csv(fit: &Fit) -> String {
    let (x, y) = (format!("{} [SI]", fit.along), format!("{} [SI]", fit.of));
    let mut out = csv_line(&["what", &x, &y, "fitted", "measured minus fitted", "sd"]);
    for FitPoint { x, measured, sd, fitted } in &fit.points {
        let numbers = [*x, *measured, *fitted, measured - fitted].map(|v| format!("{v:e}"));
        let sd = sd.map_or(String::new(), |sd| format!("{sd:e}"));
        out.push_str(&csv_line(&["measured", &numbers[0], &numbers[1], &numbers[2], &numbers[3], &sd]));
    }
    for (x, y) in &fit.curve {
        out.push_str(&csv_line(&["step", &format!("{x:e}"), "", &format!("{y:e}"), "", ""]));
    }
    out
}
