//! Outlines of the tools in figures.

use plotters::prelude::*;
use records::ToolHull;

const METAL: RGBColor = RGBColor(0xdd, 0xdd, 0xdd);
const EDGE: RGBColor = RGBColor(0x45, 0x45, 0x45);

/// Outline (m) of a tool: the convex hull of its points projected on the axes `right` and `up`.
pub(super) fn outline(tool: &ToolHull, right: &[f64; 3], up: &[f64; 3]) -> Vec<(f64, f64)> {
    let on = |p: &[f64; 3], axis: &[f64; 3]| (0..3).map(|i| p[i] * axis[i]).sum::<f64>();
    hull(tool.points.iter().map(|p| [on(p, right), on(p, up)]).collect())
        .into_iter()
        .map(|[x, y]| (x, y))
        .collect()
}

/// A tool in the colour of metal; later shapes may cover it.
pub(super) fn metal(outline: &[(f64, f64)]) -> Polygon<(f64, f64)> {
    Polygon::new(outline.to_vec(), METAL)
}

/// Closed edge of a tool.
pub(super) fn edge(outline: &[(f64, f64)]) -> PathElement<(f64, f64)> {
    let closed: Vec<_> = outline.iter().chain(outline.first()).copied().collect();
    PathElement::new(closed, EDGE.stroke_width(8))
}

/// Convex hull, counter-clockwise (Andrew's monotone chain, 1979).
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let turn =
        |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut out = half(&mut points.iter().copied());
    out.extend(half(&mut points.iter().rev().copied()));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_outlined_by_its_four_corners() {
        let mut points = vec![[0.5, 0.5, 0.0], [1.0, 0.5, 3.0]];
        for k in 0..8 {
            points.push([f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)]);
        }
        let tool = ToolHull { name: "jaw".into(), points };
        let seen = outline(&tool, &[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0]);
        assert_eq!(seen, [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
    }
}
