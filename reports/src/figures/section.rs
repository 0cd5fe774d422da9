//! A deformed section between the tools, with every cell in the colour of its own pressure. Nothing is
//! smoothed, so that checkerboards of a locking or unstable method remain visible.

use plotters::prelude::*;
use records::store::slug;
use records::text::significant;
use records::{Section, SurfaceField};

use super::colour::Scale;
use super::figure::{Data, Figure};
use super::grid::{WIDTH, with_foot};
use super::silhouette;
use super::surface::{Chosen, GRASPED, Pose, carried, pictured, titled};
use crate::select::Run;

/// Fraction of a section's cells whose pressures lie within the colour scale, for the median method.
const SHOWN: f64 = 0.98;

/// One figure per case with sections.
pub(super) fn figures(fields: &[SurfaceField], runs: &[Run]) -> Vec<Figure> {
    let mut cases: Vec<&str> = fields.iter().map(|f| f.case.as_str()).collect();
    cases.sort();
    cases.dedup();
    let of = |case: &str| -> Vec<Chosen> {
        let cut =
            |f: &&SurfaceField| f.case == case && f.section.as_ref().is_some_and(|s| !s.cells.is_empty());
        pictured(fields.iter().filter(cut).collect(), runs, GRASPED)
    };
    cases
        .into_iter()
        .map(|case| (case, of(case)))
        .filter(|(_, own)| !own.is_empty())
        .map(|(case, own)| figure(case, &own, runs))
        .collect()
}

/// Largest pressure of the colour scale, Pa: the median over the methods of the pressure that 98 % of the
/// method's cells do not exceed. A method with unbounded alternating pressures would leave no colours for the
/// others.
fn limit(fields: &[&SurfaceField]) -> f64 {
    let mut each: Vec<f64> = fields.iter().filter_map(|f| f.section.as_ref()).map(percentile).collect();
    each.sort_by(f64::total_cmp);
    each.get((each.len().max(1) - 1) / 2).copied().unwrap_or(0.0)
}

fn percentile(section: &Section) -> f64 {
    let mut all: Vec<f64> = section.cells.iter().map(|c| c.pressure.abs()).collect();
    all.sort_by(f64::total_cmp);
    let at = (SHOWN * all.len() as f64).ceil() as usize;
    all.get(at.saturating_sub(1)).copied().unwrap_or(0.0)
}

fn figure(case: &str, chosen: &[Chosen], runs: &[Run]) -> Figure {
    let fields: Vec<&SurfaceField> = chosen.iter().map(|c| c.0).collect();
    let limit = limit(&fields);
    let scale = Scale::Signed(limit * 1e-3);
    let sections: Vec<(&SurfaceField, &Section)> =
        fields.iter().filter_map(|f| f.section.as_ref().map(|s| (*f, s))).collect();
    let frame = sections[0].1;
    let on = |p: &[f64; 3]| {
        let along = |axis: &[f64; 3]| (0..3).map(|i| p[i] * axis[i]).sum::<f64>();
        (along(&frame.right), along(&frame.up))
    };
    let tools = |f: &SurfaceField| -> Vec<Vec<(f64, f64)>> {
        f.tools.iter().map(|t| silhouette::outline(t, &frame.right, &frame.up)).collect()
    };
    let corners = sections.iter().flat_map(|(_, s)| s.cells.iter().flat_map(|c| c.corners.iter().map(on)));
    let outlines = sections.iter().flat_map(|(f, _)| tools(f)).flatten();
    let pose = Pose::new(sections.len(), corners.chain(outlines));
    let note = format!(
        "Orthographic view onto the plane of the tools' travel and the body's length; tools grey. Cells have straight \
         edges. The pressure is the mean over each cell, positive in compression, not smoothed. The colours end at {} \
         kPa, the median over the methods of the pressure that 98 % of the cells stay below.",
        significant(limit * 1e-3, 3)
    );
    let drawing = with_foot(WIDTH, pose.height(), Vec::new(), &note, |area| {
        let (areas, bar) = pose.areas(area);
        for (i, (field, section)) in sections.iter().enumerate() {
            let pressures = || section.cells.iter().map(|cell| cell.pressure * 1e-3);
            let (least, most) = (pressures().fold(f64::MAX, f64::min), pressures().fold(f64::MIN, f64::max));
            let range = format!("{} to {} kPa", significant(least, 2), significant(most, 2));
            let mut body = pose.body(&areas[i], &titled(&chosen[i]), &range, &carried(field, runs))?;
            let tools = tools(field);
            body.draw_series(tools.iter().map(|o| silhouette::metal(o)))?;
            let mut cells: Vec<_> = section.cells.iter().collect();
            // Cells of a section do not overlap, so those of equal colour may share a path in the file.
            cells.sort_by(|a, b| a.pressure.total_cmp(&b.pressure));
            body.draw_series(cells.into_iter().map(|cell| {
                Polygon::new(
                    cell.corners.iter().map(on).collect::<Vec<_>>(),
                    scale.colour(cell.pressure * 1e-3),
                )
            }))?;
            body.draw_series(tools.iter().map(|o| silhouette::edge(o)))?;
        }
        scale.bar(&bar, "p [kPa]")
    });
    Figure {
        name: format!("pressure-{}", slug(case)),
        title: format!("Pressure between the tools, {case}"),
        caption: "Section through the deformed body in the plane of the tools' travel. Each cell is coloured by its \
                  mean pressure as used by the method (from the projected dilation or the pressure field, if any), \
                  with one colour scale"
            .into(),
        drawing,
        data: Data::Picture(case.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use records::{Family, SectionCell};

    #[test]
    fn one_wild_method_does_not_take_the_colours_of_the_others() {
        let of = |scale: f64| SurfaceField {
            case: "grasp".into(),
            method: "any".into(),
            family: Family::Fem,
            title: String::new(),
            points: Vec::new(),
            triangles: Vec::new(),
            displacement: Vec::new(),
            tools: Vec::new(),
            body: None,
            section: Some(Section {
                right: [0.0, 0.0, 1.0],
                up: [0.0, 1.0, 0.0],
                cells: (1..=100)
                    .map(|k| SectionCell {
                        corners: Vec::new(),
                        pressure: scale * f64::from(k) * if k % 2 == 0 { -1.0 } else { 1.0 },
                    })
                    .collect(),
            }),
        };
        let (calm, usual, wild) = (of(0.9), of(1.0), of(1e6));
        assert_eq!(limit(&[&wild, &calm, &usual]), 98.0);
        assert_eq!(limit(&[&wild, &usual]), 98.0);
    }
}
