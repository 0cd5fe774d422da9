//! Bodies seen from outside, deformed and coloured by displacement.

use super::axes::{Axis, TEXT};
use super::canvas::{Anchor, BLACK_INK, Canvas, Colour, GREY};
use super::grid::WIDTH;
use super::{Figure, Pictured};
use crate::record::SurfaceField;
use crate::select::Run;
use crate::store::slug;
use crate::text::significant;

/// Viridis at eleven even steps (van der Walt and Smith, 2015).
const VIRIDIS: [Colour; 11] = [
    [68, 1, 84],
    [72, 36, 117],
    [65, 68, 135],
    [53, 95, 141],
    [42, 120, 142],
    [33, 145, 140],
    [34, 168, 132],
    [68, 191, 112],
    [122, 209, 81],
    [189, 223, 38],
    [253, 231, 37],
];

/// Bodies in one figure.
const SHOWN: usize = 4;

/// One figure per case: fields side by side under one colour scale, true deformation.
pub(super) fn figures(fields: &[SurfaceField], runs: &[Run]) -> Vec<Figure> {
    let mut cases: Vec<&str> = fields.iter().map(|f| f.case.as_str()).collect();
    cases.sort();
    cases.dedup();
    cases
        .into_iter()
        .map(|case| {
            let mut own: Vec<&SurfaceField> =
                fields.iter().filter(|f| f.case == case && !f.triangles.is_empty()).collect();
            own.sort_by_key(|f| (f.method.starts_with("efg"), &f.method));
            (case, chosen(own, runs))
        })
        .filter(|(_, own)| !own.is_empty())
        .map(|(case, own)| figure(case, &own))
        .collect()
}

/// Elements beside clouds, as far from the reference as any, then as near: what is between them can't be told from either by eye.
fn chosen<'f>(fields: Vec<&'f SurfaceField>, runs: &[Run]) -> Vec<&'f SurfaceField> {
    if fields.len() <= SHOWN {
        return fields;
    }
    let mut picked: Vec<&SurfaceField> = Vec::new();
    let of = |family: &str| -> Vec<&'f SurfaceField> {
        let error = |f: &&SurfaceField| {
            let run = |r: &&Run| r.is.case == f.case && r.is.method == f.method && r.is.family == family;
            runs.iter().find(run).and_then(|r| r.value("rms"))
        };
        let mut known: Vec<_> = fields.iter().filter_map(|f| Some((error(f)?, *f))).collect();
        known.sort_by(|a, b| b.0.total_cmp(&a.0));
        known.into_iter().map(|k| k.1).collect()
    };
    let families = [of("fem"), of("efg")];
    picked.extend(families.iter().filter_map(|f| f.first()));
    picked.extend(families.iter().filter(|f| f.len() > 1).filter_map(|f| f.last()));
    for field in fields.iter().take(SHOWN) {
        if picked.len() < 2 && !picked.iter().any(|p| p.method == field.method) {
            picked.push(field);
        }
    }
    picked
}

fn magnitude(u: &[f64; 3]) -> f64 {
    (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]).sqrt()
}

fn figure(case: &str, fields: &[&SurfaceField]) -> Figure {
    let largest = fields.iter().flat_map(|f| f.displacement.iter()).map(magnitude).fold(0.0, f64::max);
    let columns = fields.len().min(SHOWN);
    let rows = fields.len().div_ceil(columns);
    let (bar, gap) = (54.0, 6.0);
    let width = (WIDTH - bar - gap * (columns as f64 + 1.0)) / columns as f64;
    let seen: Vec<Vec<Pictured>> = fields.iter().map(|f| project(f)).collect();
    let corners = || seen.iter().flatten().flat_map(|t| t.corners.iter());
    let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
    for c in corners() {
        for axis in 0..2 {
            low[axis] = low[axis].min(c[axis]);
            high[axis] = high[axis].max(c[axis]);
        }
    }
    let size = [(high[0] - low[0]).max(1e-12), (high[1] - low[1]).max(1e-12)];
    let scale = ((width - 10.0) / size[0]).min(300.0 / size[1]);
    let height = size[1] * scale + 54.0;
    let mut canvas = Canvas::new(WIDTH, height * rows as f64 + 34.0);
    for (i, (field, triangles)) in fields.iter().zip(&seen).enumerate() {
        let left = gap + (i % columns) as f64 * (width + gap);
        let top = (i / columns) as f64 * height;
        let own = field.displacement.iter().map(magnitude).fold(0.0, f64::max);
        let (name, rest) = field.title.split_once(" (").unwrap_or((&field.title, ""));
        let text = format!("max |u| {} mm", significant(own * 1e3, 3));
        let middle = left + width / 2.0;
        canvas.bold((middle, top + 12.0), name, TEXT, Anchor::Middle);
        canvas.text((middle, top + 24.0), rest.trim_end_matches(')'), TEXT, GREY, Anchor::Middle);
        canvas.text((middle, top + 36.0), &text, TEXT, GREY, Anchor::Middle);
        let origin = (middle - size[0] * scale / 2.0, top + 46.0 + size[1] * scale);
        let place = |c: &[f64; 2]| (origin.0 + (c[0] - low[0]) * scale, origin.1 - (c[1] - low[1]) * scale);
        for t in triangles {
            let at = t.corners.map(|c| place(&c));
            let fraction = if largest > 0.0 { t.value / largest } else { 0.0 };
            canvas.fill(&grown(at), viridis((fraction * SHADES).round() / SHADES));
        }
    }
    let bottom = height * rows as f64;
    axes(&mut canvas, (30.0, bottom + 6.0));
    canvas.text(
        (74.0, bottom + 12.0),
        "True deformation, orthographic view; one colour scale.",
        TEXT,
        GREY,
        Anchor::Start,
    );
    colour_bar(&mut canvas, (WIDTH - bar + 8.0, 46.0), (height - 66.0).clamp(80.0, 300.0), largest);
    Figure {
        name: format!("surface-{}", slug(case)),
        title: format!("Surface displacement, {case}"),
        caption: "Surface coloured by the magnitude of its displacement, at true deformation under one colour scale: of either family the run \
                  farthest from the reference, then the nearest".into(),
        canvas,
    }
}

/// Right, up and towards the viewer: the long axis upright, seen from the front and a little from the right and above.
fn view() -> [[f64; 3]; 3] {
    let (turn, tilt) = (35f64.to_radians(), 18f64.to_radians());
    let towards = [turn.sin() * tilt.cos(), tilt.sin(), turn.cos() * tilt.cos()];
    let right = [turn.cos(), 0.0, -turn.sin()];
    let up = [
        towards[1] * right[2] - towards[2] * right[1],
        towards[2] * right[0] - towards[0] * right[2],
        towards[0] * right[1] - towards[1] * right[0],
    ];
    [right, up, towards]
}

fn dot(a: &[f64; 4], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A triangle with every side a quarter of a point further out, or hairlines show between neighbours.
fn grown(at: [(f64, f64); 3]) -> [(f64, f64); 3] {
    let unit = |a: (f64, f64), b: (f64, f64)| {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let length = dx.hypot(dy).max(1e-9);
        (dx / length, dy / length)
    };
    std::array::from_fn(|i| {
        let (here, next, last) = (at[i], at[(i + 1) % 3], at[(i + 2) % 3]);
        let (to_next, to_last) = (unit(here, next), unit(here, last));
        // Away from both neighbours; a mitre that would run far out at a sharp corner is cut short.
        let sine = (to_next.0 * to_last.1 - to_next.1 * to_last.0).abs().max(0.3);
        let reach = 0.25 / sine;
        (here.0 - reach * (to_next.0 + to_last.0), here.1 - reach * (to_next.1 + to_last.1))
    })
}

/// Shades told apart on a body: more than an eye can, few enough for neighbours to share one.
const SHADES: f64 = 48.0;

/// Slabs of depth that are drawn one after the other, the farthest first.
const SLABS: f64 = 16.0;

/// How many triangles a picture may be cut into for the sake of smooth colours.
const FINEST: usize = 4000;

/// Cuts every triangle into four, its values linear between the corners, as often as the count stays moderate.
fn refined(mut triangles: Vec<Corners>) -> Vec<Corners> {
    while !triangles.is_empty() && triangles.len() * 4 <= FINEST {
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

/// Deformed position and value at three corners.
type Corners = [[f64; 4]; 3];

/// Triangles that face the viewer, farthest first.
fn project(field: &SurfaceField) -> Vec<Pictured> {
    let [right, up, towards] = view();
    let deformed = |triangle: &[u32; 3]| -> Corners {
        triangle.map(|t| {
            let (x, u) = (field.points[t as usize], field.displacement[t as usize]);
            [x[0] + u[0], x[1] + u[1], x[2] + u[2], magnitude(&u)]
        })
    };
    let flat = |c: &Corners| c.map(|x| [dot(&x, &right), dot(&x, &up)]);
    let faces = |c: &Corners| {
        let [a, b, c] = flat(c);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0
    };
    let visible: Vec<Corners> = field.triangles.iter().map(deformed).filter(faces).collect();
    let picture = |c: Corners| {
        let depth: f64 = c.iter().map(|x| dot(x, &towards)).sum();
        (depth, Pictured { corners: flat(&c), value: c.iter().map(|x| x[3]).sum::<f64>() / 3.0 })
    };
    let mut seen: Vec<(f64, Pictured)> = refined(visible).into_iter().map(picture).collect();
    let (near, far) = seen.iter().fold((f64::MIN, f64::MAX), |(n, f), s| (n.max(s.0), f.min(s.0)));
    // Inside a slab faces to the front don't hide each other, and sorted by value neighbours on paper share a colour in the file.
    let slab = |depth: f64| ((depth - far) / (near - far).max(1e-12) * SLABS).floor();
    seen.sort_by(|a, b| slab(a.0).total_cmp(&slab(b.0)).then(a.1.value.total_cmp(&b.1.value)));
    seen.into_iter().map(|(_, t)| t).collect()
}

fn viridis(fraction: f64) -> Colour {
    let at = fraction.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let (low, rest) = (at.floor() as usize, at.fract());
    let high = (low + 1).min(VIRIDIS.len() - 1);
    std::array::from_fn(|i| {
        (f64::from(VIRIDIS[low][i]) * (1.0 - rest) + f64::from(VIRIDIS[high][i]) * rest).round() as u8
    })
}

fn colour_bar(canvas: &mut Canvas, at: (f64, f64), height: f64, largest: f64) {
    let steps = 64;
    for i in 0..steps {
        let (from, to) = (i as f64 / steps as f64, (i + 1) as f64 / steps as f64);
        let (top, bottom) = (at.1 + height * (1.0 - to) - 0.2, at.1 + height * (1.0 - from));
        canvas.fill(
            &[(at.0, top), (at.0 + 12.0, top), (at.0 + 12.0, bottom), (at.0, bottom)],
            viridis((from + to) / 2.0),
        );
    }
    for (value, text) in Axis::linear("", [0.0, largest * 1e3].into_iter(), true).ticks() {
        let fraction = value / (largest * 1e3).max(1e-12);
        if fraction <= 1.0 + 1e-9 {
            let y = at.1 + height * (1.0 - fraction);
            canvas.line(&[(at.0 + 12.0, y), (at.0 + 15.0, y)], BLACK_INK, 0.6);
            canvas.text((at.0 + 18.0, y), text, TEXT, BLACK_INK, Anchor::Start);
        }
    }
    canvas.text((at.0, at.1 - 14.0), "|u| [mm]", TEXT, BLACK_INK, Anchor::Start);
}

/// The three axes as the viewer sees them.
fn axes(canvas: &mut Canvas, at: (f64, f64)) {
    let [right, up, _] = view();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let (dx, dy) = (right[axis] * 18.0, -up[axis] * 18.0);
        canvas.line(&[at, (at.0 + dx, at.1 + dy)], BLACK_INK, 1.0);
        canvas.text((at.0 + dx * 1.45, at.1 + dy * 1.45), name, TEXT, BLACK_INK, Anchor::Middle);
    }
}
