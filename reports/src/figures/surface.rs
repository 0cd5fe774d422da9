//! Bodies seen from outside, deformed and coloured by displacement magnitude.

use catalogue::metric;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use records::store::slug;
use records::text::significant;
use records::{Family, SurfaceField};

use super::backend::{Attributed, Paths};
use super::colour::Scale;
use super::drawing::{
    Area, BLACK_INK, Drawing, Drawn, GREY, LINE, TEXT, bold, noted, text, text_width, wrapped,
};
use super::figure::{Data, Figure, Pictured};
use super::grid::WIDTH;
use super::silhouette;
use crate::select::Run;

/// Largest number of bodies in a figure and in a row.
const SHOWN: usize = 4;
/// Largest number of bodies between tools in a figure, whose shapes are the subject of such cases.
pub(super) const GRASPED: usize = 8;

/// One figure per case: fields side by side with one colour scale, at true scale of deformation.
pub(super) fn figures(fields: &[SurfaceField], runs: &[Run]) -> Vec<Figure> {
    let mut cases: Vec<&str> = fields.iter().map(|f| f.case.as_str()).collect();
    cases.sort();
    cases.dedup();
    cases
        .into_iter()
        .map(|case| {
            let own: Vec<&SurfaceField> =
                fields.iter().filter(|f| f.case == case && !f.triangles.is_empty()).collect();
            let room = if own.iter().any(|f| !f.tools.is_empty()) { GRASPED } else { SHOWN };
            (case, pictured(own, runs, room))
        })
        .filter(|(_, own)| !own.is_empty())
        .map(|(case, own)| figure(case, &own, runs))
        .collect()
}

/// A body in a figure, with the reason for its choice if there is no room for all.
pub(super) type Chosen<'f> = (&'f SurfaceField, &'static str);

/// Bodies in the order of the report, or a selection if there is no room for all.
pub(super) fn pictured<'f>(mut fields: Vec<&'f SurfaceField>, runs: &[Run], room: usize) -> Vec<Chosen<'f>> {
    fields.sort_by_key(|f| runs.iter().position(|r| r.is.case == f.case && r.is.method == f.method));
    if fields.len() <= room { fields.into_iter().map(|f| (f, "")).collect() } else { chosen(fields, runs) }
}

/// The fraction of the load reached by a method that ended early, in words; empty for a complete run.
pub(super) fn carried(field: &SurfaceField, runs: &[Run]) -> String {
    let own = |r: &&Run| r.is.case == field.case && r.is.method == field.method;
    match runs.iter().filter(own).find_map(|r| r.value(&metric::LOAD_CARRIED)) {
        Some(load) if load < 0.9995 => format!("ended at {} % of the load", significant(100.0 * load, 2)),
        _ => String::new(),
    }
}

/// Selects elements and clouds: for each family the run farthest from the reference, then the nearest.
/// Intermediate runs are visually indistinguishable from these.
fn chosen<'f>(fields: Vec<&'f SurfaceField>, runs: &[Run]) -> Vec<Chosen<'f>> {
    let of = |family: Family| -> Vec<(&'f SurfaceField, f64)> {
        let error = |f: &SurfaceField| {
            let own = |r: &&Run| r.is.case == f.case && r.is.method == f.method && r.is.family == family;
            runs.iter().find(own).and_then(|r| r.value(&metric::RMS))
        };
        let mut known: Vec<_> = fields.iter().filter_map(|f| Some((*f, error(f)?))).collect();
        known.sort_by(|a, b| b.1.total_cmp(&a.1));
        known
    };
    let families = [of(Family::Fem), of(Family::Efg)];
    let mut picked: Vec<Chosen> =
        families.iter().filter_map(|f| f.first()).map(|(f, _)| (*f, "farthest")).collect();
    for (field, error) in families.iter().filter(|f| f.len() > 1).filter_map(|f| f.last()) {
        picked.push((field, if *error == 0.0 { "reference" } else { "nearest" }));
    }
    // Without a reference there is no distance, so the first fields are chosen.
    for field in fields.iter().take(SHOWN) {
        if picked.len() < 2 && !picked.iter().any(|p| p.0.method == field.method) {
            picked.push((field, ""));
        }
    }
    picked
}

/// Title of a field, `tet4 (405 nodes)`, with the reason for its choice.
pub(super) fn titled((field, why): &Chosen) -> String {
    match field.title.strip_suffix(')') {
        Some(open) if !why.is_empty() => format!("{open}, {why})"),
        _ => field.title.clone(),
    }
}

fn magnitude(u: &[f64; 3]) -> f64 {
    (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]).sqrt()
}

/// Bodies of one scale side by side, with a colour bar.
pub(super) struct Pose {
    columns: usize,
    rows: usize,
    low: [f64; 2],
    size: [f64; 2],
    /// Lengths on paper per metre.
    scale: f64,
}

/// A body in coordinates of its view (m).
pub(super) type Body<'a> = ChartContext<'a, Paths, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Room for a colour bar with its numbers.
const BAR: i32 = 540;
/// Largest height of a body.
const TALL: f64 = 3000.0;
/// Room between bodies, above a body for its title, and below it.
const GAP: i32 = 80;
const HEAD: i32 = 580;
const BELOW: i32 = 80;
/// Width of bold text over that of regular text.
const WIDER: f64 = 1.12;

impl Pose {
    /// Lays out `count` bodies whose extent is given by the points (m).
    pub(super) fn new(count: usize, points: impl Iterator<Item = (f64, f64)>) -> Pose {
        let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
        for c in points {
            for (axis, value) in [c.0, c.1].into_iter().enumerate() {
                low[axis] = low[axis].min(value);
                high[axis] = high[axis].max(value);
            }
        }
        let columns = count.clamp(1, SHOWN);
        let size = [(high[0] - low[0]).max(1e-12), (high[1] - low[1]).max(1e-12)];
        let width = (WIDTH - BAR) / columns as i32 - 2 * GAP;
        Pose {
            columns,
            rows: count.div_ceil(columns),
            low,
            size,
            scale: (f64::from(width) / size[0]).min(TALL / size[1]),
        }
    }

    fn tall(&self) -> i32 {
        (self.size[1] * self.scale).round() as i32
    }

    /// Height of all rows.
    pub(super) fn height(&self) -> i32 {
        (HEAD + self.tall() + BELOW) * self.rows as i32
    }

    /// Areas of the bodies, and that of the colour bar.
    pub(super) fn areas(&self, area: &Area) -> (Vec<Area>, Area) {
        let (bodies, bar) = area.split_horizontally(WIDTH - BAR);
        let tall = (self.tall() - 200).clamp(800, 3000) + HEAD - 300;
        (bodies.split_evenly((self.rows, self.columns)), bar.shrink((80, 300), (BAR - 80, tall)))
    }

    /// Draws the name, the size in brackets and two more lines, and returns the body below them.
    pub(super) fn body<'a>(&self, area: &Area, title: &str, first: &str, second: &str) -> Drawn<Body<'a>> {
        let width = area.dim_in_pixel().0 as i32;
        let (name, rest) = title.split_once(" (").unwrap_or((title, ""));
        // The number of nodes is on the next line. A name that is still wider than the column is set in a
        // smaller size.
        let count = rest.split(' ').next().unwrap_or_default();
        let name = name.strip_suffix(count).and_then(|n| n.strip_suffix('-')).unwrap_or(name);
        let size = TEXT * (f64::from(width) / (WIDER * f64::from(text_width(name, TEXT)))).min(1.0);
        area.draw_text(name, &bold(size, HPos::Center), (width / 2, LINE))?;
        for (line, words) in (2..).zip([rest.trim_end_matches(')'), first, second]) {
            area.draw_text(words, &text(TEXT, HPos::Center).color(&GREY), (width / 2, line * LINE))?;
        }
        let middle = self.low[0] + self.size[0] / 2.0;
        let half = f64::from(width) / 2.0 / self.scale;
        ChartBuilder::on(area)
            .margin_top(HEAD)
            .margin_bottom(BELOW)
            .build_cartesian_2d(middle - half..middle + half, self.low[1]..self.low[1] + self.size[1])
    }
}

fn figure(case: &str, chosen: &[Chosen], runs: &[Run]) -> Figure {
    let fields: Vec<&SurfaceField> = chosen.iter().map(|c| c.0).collect();
    let largest = fields.iter().flat_map(|f| f.displacement.iter()).map(magnitude).fold(0.0, f64::max) * 1e3;
    let scale = Scale::Rising(largest);
    let tools = fields.iter().any(|f| !f.tools.is_empty());
    let view = if tools { beside(&fields) } else { view(&fields) };
    let outlines: Vec<Vec<Vec<(f64, f64)>>> = fields
        .iter()
        .map(|f| f.tools.iter().map(|t| silhouette::outline(t, &view[0], &view[1])).collect())
        .collect();
    let finest = FINEST.min(FINEST_OF_ALL / fields.len());
    let seen: Vec<Vec<Pictured>> = fields.iter().map(|f| project(f, finest, &view)).collect();
    let corners = seen.iter().flatten().flat_map(|t| t.corners);
    let pose = Pose::new(fields.len(), corners.chain(outlines.iter().flatten().flatten().copied()));
    let note = match tools {
        true => {
            "True deformation, orthographic view; one colour scale. Outlines: the tools, including the parts hidden by the body."
        }
        false => "True deformation, orthographic view; one colour scale.",
    };
    let drawing = Drawing::new(WIDTH, pose.height() + FOOT, |page| {
        let (upper, lower) = page.split_vertically(pose.height());
        let (areas, bar) = pose.areas(&upper);
        for (i, area) in areas.iter().take(fields.len()).enumerate() {
            let own = fields[i].displacement.iter().map(magnitude).fold(0.0, f64::max);
            let text = format!("max |u| {} mm", significant(own * 1e3, 3));
            let mut body = pose.body(area, &titled(&chosen[i]), &text, &carried(fields[i], runs))?;
            body.draw_series(outlines[i].iter().map(|o| silhouette::metal(o)))?;
            body.draw_series(
                seen[i].iter().map(|t| Attributed::facet(t.corners.to_vec(), scale.colour(t.value * 1e3))),
            )?;
            body.draw_series(outlines[i].iter().map(|o| silhouette::edge(o)))?;
        }
        axes(&lower, (360, 240), &view)?;
        noted(&lower.margin(160, 0, 740, 0), &wrapped(note, WIDTH - 840))?;
        scale.bar(&bar, "|u| [mm]")
    });
    Figure {
        name: format!("surface-{}", slug(case)),
        title: format!("Surface displacement, {case}"),
        caption: caption(tools, chosen),
        drawing,
        data: Data::Picture(case.into()),
    }
}

/// Room for the axes of the view and the note.
const FOOT: i32 = 460;

fn caption(tools: bool, chosen: &[Chosen]) -> String {
    let mut text = "The deformed surface, coloured by the magnitude of its displacement; one colour scale for all panels".to_string();
    if tools {
        text += "; the tools stand where each run ended";
    }
    if chosen.iter().any(|c| !c.1.is_empty()) {
        text += "; for each family, the run farthest from the reference and the nearest run, or the reference itself";
    }
    text
}

/// Axes of a view: right, up and towards the viewer.
type View = [[f64; 3]; 3];

/// View from the front, slightly from the right and above. The z axis points up, or the y axis if the body is
/// longest along y.
fn view(fields: &[&SurfaceField]) -> View {
    let extent = |axis: usize| {
        let values = || fields.iter().flat_map(|f| f.points.iter().map(move |p| p[axis]));
        values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
    };
    let [x, y, z] = [0, 1, 2].map(extent);
    let front = match y > 1.05 * x.max(z) {
        true => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        false => [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]],
    };
    turned(front, 35.0, 18.0)
}

/// View almost normal to the section between the tools, which then stand on either side of the body and not
/// in front.
fn beside(fields: &[&SurfaceField]) -> View {
    let [right, up] = match fields.iter().find_map(|f| f.section.as_ref()) {
        Some(section) => [section.right, section.up],
        None => [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
    };
    turned([right, up, cross(right, up)], -12.0, 10.0)
}

/// A view turned to the right about its vertical axis and then tilted upwards, by angles in degrees.
fn turned([right, up, towards]: View, turn: f64, tilt: f64) -> View {
    let (turn, tilt) = (turn.to_radians(), tilt.to_radians());
    let mixed = |a: [f64; 3], c: f64, b: [f64; 3], s: f64| -> [f64; 3] {
        std::array::from_fn(|i| a[i] * c + b[i] * s)
    };
    let level = mixed(towards, turn.cos(), right, turn.sin());
    [
        mixed(right, turn.cos(), towards, -turn.sin()),
        mixed(up, tilt.cos(), level, -tilt.sin()),
        mixed(level, tilt.cos(), up, tilt.sin()),
    ]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: &[f64; 4], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Number of depth slabs, which are drawn one after the other from the farthest.
const SLABS: f64 = 16.0;

/// Largest number of triangles for smooth colours, of a body and of all bodies of a figure (33 bytes per
/// triangle).
const FINEST: usize = 4000;
const FINEST_OF_ALL: usize = 11_000;

/// Divides every triangle into four, with linear values between the corners, as long as their number is at
/// most `finest`.
fn refined(mut triangles: Vec<Corners>, finest: usize) -> Vec<Corners> {
    while !triangles.is_empty() && triangles.len() * 4 <= finest {
        let half = |a: &[f64; 4], b: &[f64; 4]| std::array::from_fn(|i| 0.5 * (a[i] + b[i]));
        triangles = triangles
            .iter()
            .flat_map(|[a, b, c]| {
                let (ab, bc, ca) = (half(a, b), half(b, c), half(c, a));
                [[*a, ab, ca], [ab, *b, bc], [ca, bc, *c], [ab, bc, ca]]
            })
            .collect();
    }
    triangles
}

/// Deformed position and value at each of three corners.
type Corners = [[f64; 4]; 3];

/// Triangles that face the viewer, farthest first.
fn project(field: &SurfaceField, finest: usize, [right, up, towards]: &View) -> Vec<Pictured> {
    let deformed = |triangle: &[u32; 3]| -> Corners {
        triangle.map(|t| {
            let (x, u) = (field.points[t as usize], field.displacement[t as usize]);
            [x[0] + u[0], x[1] + u[1], x[2] + u[2], magnitude(&u)]
        })
    };
    let flat = |c: &Corners| c.map(|x| (dot(&x, right), dot(&x, up)));
    let faces = |c: &Corners| {
        let [a, b, c] = flat(c);
        (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0) > 0.0
    };
    let visible: Vec<Corners> = field.triangles.iter().map(deformed).filter(faces).collect();
    let picture = |c: Corners| {
        let depth: f64 = c.iter().map(|x| dot(x, towards)).sum();
        (depth, Pictured { corners: flat(&c), value: c.iter().map(|x| x[3]).sum::<f64>() / 3.0 })
    };
    let mut seen: Vec<(f64, Pictured)> = refined(visible, finest).into_iter().map(picture).collect();
    let (near, far) = seen.iter().fold((f64::MIN, f64::MAX), |(n, f), s| (n.max(s.0), f.min(s.0)));
    // Within a slab, front faces do not hide each other. Sorting them by value lets neighbours share a colour
    // in the file.
    let slab = |depth: f64| ((depth - far) / (near - far).max(1e-12) * SLABS).floor();
    seen.sort_by(|a, b| slab(a.0).total_cmp(&slab(b.0)).then(a.1.value.total_cmp(&b.1.value)));
    seen.into_iter().map(|(_, t)| t).collect()
}

/// Draws the three axes of the view.
fn axes(area: &Area, at: (i32, i32), [right, up, _]: &View) -> Drawn {
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let (dx, dy) = (right[axis] * 180.0, -up[axis] * 180.0);
        // The name is placed beyond the end of the arrow, even if the arrow is short in this view.
        let beyond = 1.0 + 80.0 / dx.hypot(dy).max(10.0);
        let along = |part: f64| (at.0 + (part * dx).round() as i32, at.1 + (part * dy).round() as i32);
        area.draw(&PathElement::new([at, along(1.0)], BLACK_INK.stroke_width(10)))?;
        area.draw_text(name, &text(TEXT, HPos::Center), along(beyond))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fronts::tests::run;
    use crate::select::runs;

    fn field(method: &str, family: Family, far: [f64; 3]) -> SurfaceField {
        SurfaceField {
            case: "jaws".into(),
            method: method.into(),
            family,
            title: format!("{method} (100 nodes)"),
            points: vec![[0.0; 3], far],
            triangles: vec![[0, 1, 1]],
            displacement: vec![[0.0; 3]; 2],
            tools: Vec::new(),
            section: None,
            body: None,
        }
    }

    #[test]
    fn a_panel_says_why_it_was_chosen_where_there_is_no_room_for_all() {
        let methods = [
            ("tet10", Family::Fem, 0.0),
            ("efg", Family::Efg, 0.1),
            ("tet4", Family::Fem, 0.4),
            ("hex8", Family::Fem, 0.2),
            ("efg-smoothed", Family::Efg, 0.3),
        ];
        let records: Vec<_> = methods
            .iter()
            .flat_map(|&(id, family, error)| run((id, family), 100, 1.0, &[("rms", error)]))
            .collect();
        let fields: Vec<_> = methods.iter().map(|m| field(m.0, m.1, [1.0; 3])).collect();
        let titles = |room| -> Vec<String> {
            pictured(fields.iter().collect(), &runs(&records), room).iter().map(titled).collect()
        };
        assert_eq!(
            titles(4),
            [
                "tet4 (100 nodes, farthest)",
                "efg-smoothed (100 nodes, farthest)",
                "tet10 (100 nodes, reference)",
                "efg (100 nodes, nearest)"
            ]
        );
        // The names are those of the tables.
        let names = ["tet4", "tet10", "hex8", "efg", "efg-smoothed"];
        assert_eq!(titles(5), names.map(|name| format!("{name} (100 nodes)")));
    }

    #[test]
    fn z_is_upright_unless_the_body_is_longest_along_y() {
        let up = |far| view(&[&field("tet4", Family::Fem, far)])[1];
        let [flat, long] = [up([2.0, 2.0, 1.0]), up([1.0, 2.0, 1.0])];
        assert!(flat[2] > 0.9 && long[1] > 0.9, "{flat:?} {long:?}");
    }
}
