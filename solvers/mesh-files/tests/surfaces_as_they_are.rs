//! Surfaces as they are in public files, open, branched, crossing, reversed or with odd faces: repaired or
//! wrapped, they become bodies of the right volume.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::path::Path;

use geometry::surface::Treatment;
use tissuebench_mesh_files::{SurfaceError, read_surface, read_treated};

type Vector = [f64; 3];
type Triangles = Vec<[Vector; 3]>;

fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|x| a[x] * b[x]).sum()
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn volume(triangles: &Triangles) -> f64 {
    triangles.iter().map(|&[a, b, c]| dot(a, cross(b, c)) / 6.0).sum()
}

/// Triangles between rows of points; rows and columns that close are named.
fn sheet(rows: usize, columns: usize, at: impl Fn(usize, usize) -> Vector) -> Triangles {
    let mut triangles = Vec::new();
    for i in 0..rows {
        for j in 0..columns {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    triangles
}

/// An ellipsoid with its poles on z, from its north pole down to an angle.
fn cap(at: Vector, half: Vector, to: f64) -> Triangles {
    sheet(20, 32, |i, j| {
        let (t, p) = (to * i as f64 / 20.0, TAU * (j % 32) as f64 / 32.0);
        let ring = if i == 0 || (i == 20 && to == PI) { 0.0 } else { t.sin() };
        let n = [ring * p.cos(), ring * p.sin(), t.cos()];
        std::array::from_fn(|x| at[x] + half[x] * n[x])
    })
}

fn ball(at: Vector, radius: f64) -> Triangles {
    cap(at, [radius; 3], PI)
}

/// A ball of radius 10 with bumps.
fn bumpy() -> Triangles {
    let mut all = ball([0.0; 3], 10.0);
    for p in all.iter_mut().flatten() {
        let by = 1.0 + 0.1 * (0.4 * p[0]).sin() * (0.3 * p[1]).cos() + 0.06 * (0.5 * p[2]).sin();
        *p = p.map(|x| x * by);
    }
    all
}

/// The side at the end of an axis of a box, in `n` by `n` squares.
fn side(min: Vector, max: Vector, axis: usize, high: bool, n: usize) -> Triangles {
    let [u, v] = if high { [(axis + 1) % 3, (axis + 2) % 3] } else { [(axis + 2) % 3, (axis + 1) % 3] };
    sheet(n, n, |i, j| {
        let mut p = if high { max } else { min };
        p[u] = min[u] + (max[u] - min[u]) * i as f64 / n as f64;
        p[v] = min[v] + (max[v] - min[v]) * j as f64 / n as f64;
        p
    })
}

fn cuboid(min: Vector, max: Vector) -> Triangles {
    (0..6).flat_map(|k| side(min, max, k / 2, k % 2 == 1, 4)).collect()
}

/// A torus about z with the radii 10 and 4.
fn torus() -> Triangles {
    sheet(48, 20, |i, j| {
        let (u, v) = (TAU * (i % 48) as f64 / 48.0, TAU * (j % 20) as f64 / 20.0);
        let r = 10.0 + 4.0 * v.cos();
        [r * u.cos(), r * u.sin(), 4.0 * v.sin()]
    })
}

/// The side of a cylinder about z, of radius 5.
fn pipe(low: f64, high: f64) -> Triangles {
    sheet(12, 32, |i, j| {
        let p = TAU * (j % 32) as f64 / 32.0;
        [5.0 * p.cos(), 5.0 * p.sin(), high + (low - high) * i as f64 / 12.0]
    })
}

/// A disc across z with 32 corners, seen from below or above.
fn disc(radius: f64, z: f64, up: bool) -> Triangles {
    let at = |j: usize| {
        let p = TAU * (j % 32) as f64 / 32.0;
        [radius * p.cos(), radius * p.sin(), z]
    };
    let wedge = |j| if up { [[0.0, 0.0, z], at(j), at(j + 1)] } else { [[0.0, 0.0, z], at(j + 1), at(j)] };
    (0..32).map(wedge).collect()
}

fn cylinder() -> Triangles {
    [pipe(-15.0, 15.0), disc(5.0, -15.0, false), disc(5.0, 15.0, true)].concat()
}

fn turned(triangles: Triangles) -> Triangles {
    triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect()
}

/// The triangles without those at these places.
fn without(mut triangles: Triangles, places: &[usize]) -> Triangles {
    let mut at = 0..;
    triangles.retain(|_| !places.contains(&at.next().unwrap()));
    triangles
}

/// Common volume of two balls of one radius.
fn lens(radius: f64, apart: f64) -> f64 {
    PI * (4.0 * radius + apart) * (2.0 * radius - apart).powi(2) / 12.0
}

/// A case: its name, its triangles and its volume, if it is known.
type Case = (&'static str, Triangles, Option<f64>);

/// 19 open surfaces.
fn open() -> Vec<Case> {
    let egg = || cap([0.0; 3], [20.0, 15.0, 10.0], PI);
    let whole = |case: Triangles, full: Triangles| (case, Some(volume(&full)));
    let (min, max) = ([0.0; 3], [20.0, 10.0, 8.0]);
    let brick = cuboid(min, max);
    let lid = |axis: usize| {
        let all = (0..6).filter(|&k| k != 2 * axis + 1);
        all.flat_map(|k| side(min, max, k / 2, k % 2 == 1, 4)).collect::<Triangles>()
    };
    let flat = |to: f64| {
        let rim = 10.0 * to.sin();
        [cap([0.0; 3], [10.0; 3], to), disc(rim, 10.0 * to.cos(), false)].concat()
    };
    let sparse: Triangles =
        ball([0.0; 3], 10.0).into_iter().enumerate().filter(|(k, _)| k % 19 != 0).map(|(_, t)| t).collect();
    let cracked = {
        let mut all = bumpy();
        all.iter_mut().step_by(7).for_each(|t| t[0][0] += 2e-4);
        all
    };
    // The front has a corner at the middle of the upper edge, the top has none.
    let junction = {
        let top = [
            [[0.0, 0.0, 8.0], [20.0, 0.0, 8.0], [20.0, 10.0, 8.0]],
            [[0.0, 0.0, 8.0], [20.0, 10.0, 8.0], [0.0, 10.0, 8.0]],
        ];
        [lid(2), top.to_vec()].concat()
    };
    let two =
        [without(ball([0.0; 3], 6.0), &[100, 101]), without(ball([20.0, 0.0, 0.0], 5.0), &[7])].concat();
    let two_whole = [ball([0.0; 3], 6.0), ball([20.0, 0.0, 0.0], 5.0)].concat();
    let cases = [
        ("an egg without a triangle", whole(without(egg(), &[300]), egg())),
        ("an egg without three", whole(without(egg(), &[300, 301, 302]), egg())),
        (
            "an egg without twelve places",
            whole(without(egg(), &(0..12).map(|k| 97 * k + 40).collect::<Vec<_>>()), egg()),
        ),
        ("a bumpy ball with a hole", whole(without(bumpy(), &[500, 501, 564, 565]), bumpy())),
        ("a ball without a small cap", whole(cap([0.0; 3], [10.0; 3], 0.9 * PI), flat(0.9 * PI))),
        ("a ball without a cap", whole(cap([0.0; 3], [10.0; 3], 0.8 * PI), flat(0.8 * PI))),
        ("a ball without a large cap", whole(cap([0.0; 3], [10.0; 3], 0.65 * PI), flat(0.65 * PI))),
        ("half a ball", whole(cap([0.0; 3], [10.0; 3], 0.5 * PI), flat(0.5 * PI))),
        ("a box without its lid", whole(lid(2), brick.clone())),
        ("a box without a long side", whole(lid(1), brick.clone())),
        ("a box without an end", whole(lid(0), brick.clone())),
        ("a box without a triangle", whole(without(brick.clone(), &[5]), brick.clone())),
        ("a pipe", whole(pipe(-15.0, 15.0), cylinder())),
        ("a pipe with one end", whole([pipe(-15.0, 15.0), disc(5.0, -15.0, false)].concat(), cylinder())),
        ("a torus without a square", whole(without(torus(), &[444, 445]), torus())),
        ("a ball of which every 19th triangle is missing", whole(sparse, ball([0.0; 3], 10.0))),
        ("a bumpy ball with cracks", whole(cracked, bumpy())),
        ("a box with T-junctions", whole(junction, brick)),
        ("two balls with holes", whole(two, two_whole)),
    ];
    cases.map(|(name, (triangles, volume))| (name, triangles, volume)).to_vec()
}

/// 16 surfaces with several sheets at an edge, or at a triangle.
fn branched() -> Vec<Case> {
    let (min, max) = ([0.0; 3], [20.0, 10.0, 8.0]);
    // Four boxes side by side, of which inner sides are kept once or twice.
    let boxes = |cuts: &[f64], twice: bool| -> Triangles {
        let ends = [&[0.0], cuts, &[20.0]].concat();
        let mut all = Vec::new();
        for (k, two) in ends.windows(2).enumerate() {
            let (min, max) = ([two[0], 0.0, 0.0], [two[1], 10.0, 8.0]);
            let kept = (0..6).filter(|&side| side != 0 || k == 0 || twice);
            all.extend(kept.flat_map(|k| side(min, max, k / 2, k % 2 == 1, 4)));
        }
        all
    };
    let of_box = Some(volume(&cuboid(min, max)));
    let of = |triangles: &Triangles| Some(volume(triangles));
    let (egg, round, tube) = (cap([0.0; 3], [20.0, 15.0, 10.0], PI), ball([0.0; 3], 10.0), torus());
    let again = |triangles: &Triangles, from: usize, to: usize| {
        [triangles.clone(), triangles[from..to].to_vec()].concat()
    };
    let fin = vec![
        [round[640][0], round[640][1], [16.0, 0.0, 0.0]],
        [round[640][0], [16.0, 0.0, 0.0], [15.0, 2.0, 1.0]],
    ];
    let slice: Triangles = (0..20)
        .map(|j| {
            let at = |j: usize| {
                tube.iter().flatten().find(|p| {
                    let v = TAU * (j % 20) as f64 / 20.0;
                    p[1].abs() < 1e-9
                        && p[0] > 0.0
                        && (p[0] - 10.0 - 4.0 * v.cos()).abs() + (p[2] - 4.0 * v.sin()).abs() < 1e-6
                })
            };
            [[10.0, 0.0, 0.0], *at(j).unwrap(), *at(j + 1).unwrap()]
        })
        .collect();
    let tumour = [round.clone(), disc(10.0, 0.0, true)].concat();
    let corner = [cuboid([0.0; 3], [10.0; 3]), cuboid([10.0, 10.0, 0.0], [20.0, 20.0, 10.0])].concat();
    let grid = [boxes(&[8.0], false), side([0.0, 4.0, 0.0], [20.0, 4.0, 8.0], 1, true, 4)].concat();
    vec![
        ("two rooms", boxes(&[10.0], false), of_box),
        ("three rooms", boxes(&[6.0, 13.0], false), of_box),
        ("four rooms", boxes(&[5.0, 10.0, 15.0], false), of_box),
        ("two boxes face to face", boxes(&[10.0], true), of_box),
        ("three boxes face to face", boxes(&[4.0, 14.0], true), of_box),
        ("rooms with walls that cross", grid, of_box),
        ("two boxes at an edge", corner, Some(2000.0)),
        ("a ball with a membrane", tumour, of(&round)),
        ("a torus with a membrane", [tube.clone(), slice].concat(), of(&tube)),
        (
            "a cylinder with membranes",
            [cylinder(), disc(5.0, 5.0, true), disc(5.0, -5.0, true)].concat(),
            of(&cylinder()),
        ),
        ("a ball with a fin", [round.clone(), fin].concat(), of(&round)),
        ("an egg with doubles", again(&egg, 100, 180), of(&egg)),
        ("an egg with reversed doubles", [egg.clone(), turned(egg[100..180].to_vec())].concat(), of(&egg)),
        ("an egg twice", again(&egg, 0, egg.len()), of(&egg)),
        ("an egg with two sides", [egg.clone(), turned(egg.clone())].concat(), of(&egg)),
        (
            "an egg with three sheets",
            [again(&egg, 300, 340), turned(egg[300..340].to_vec())].concat(),
            of(&egg),
        ),
    ]
}

/// 12 surfaces that cross themselves.
fn crossing() -> Vec<Case> {
    let of_ball = volume(&ball([0.0; 3], 10.0));
    let pair = |apart: f64, reversed: bool| {
        let other = ball([apart, 0.0, 0.0], 10.0);
        let other = if reversed { turned(other) } else { other };
        let both = [ball([0.0; 3], 10.0), other].concat();
        (both, Some(2.0 * of_ball - lens(10.0, apart)))
    };
    let bars = |a: [Vector; 2], b: [Vector; 2]| {
        let size = |x: usize| a[1][x].min(b[1][x]) - a[0][x].max(b[0][x]);
        let (a, b) = (cuboid(a[0], a[1]), cuboid(b[0], b[1]));
        let common: f64 = (0..3).map(size).product();
        let union = volume(&a) + volume(&b) - common;
        ([a, b].concat(), Some(union))
    };
    let mut spiked = bumpy();
    let tip = spiked[200][0];
    spiked.iter_mut().flatten().filter(|p| **p == tip).for_each(|p| *p = p.map(|x| -1.3 * x));
    let mut folded = bumpy();
    let (from, to) = (folded[644][0], folded[644][2]);
    let beyond: Vector = std::array::from_fn(|x| from[x] + 2.2 * (to[x] - from[x]));
    folded.iter_mut().flatten().filter(|p| **p == from).for_each(|p| *p = beyond);
    let chain = (0..3).flat_map(|k| ball([13.0 * f64::from(k), 0.0, 0.0], 10.0)).collect::<Triangles>();
    let cases = [
        ("two balls, close", pair(4.0, false)),
        ("two balls", pair(10.0, false)),
        ("two crossing balls, one inside out", pair(17.0, true)),
        ("three balls", (chain, Some(3.0 * of_ball - 2.0 * lens(10.0, 13.0)))),
        ("two bars", bars([[0.0; 3], [20.0, 8.0, 8.0]], [[5.0, -6.0, 2.0], [13.0, 15.0, 6.0]])),
        ("two boxes at a corner", bars([[0.0; 3], [10.0; 3]], [[6.0, 5.0, 4.0], [16.0, 15.0, 14.0]])),
        ("two boxes with a common plane", bars([[0.0; 3], [10.0; 3]], [[5.0, 2.5, 0.0], [15.0, 12.5, 10.0]])),
        ("a ball and a pipe", ([ball([0.0; 3], 10.0), cylinder()].concat(), None)),
        ("a ball and an open pipe", ([ball([0.0; 3], 10.0), pipe(0.0, 15.0)].concat(), None)),
        ("a torus and a ball", ([torus(), ball([10.0, 0.0, 0.0], 6.0)].concat(), None)),
        ("a bumpy ball with a spike through it", (spiked, None)),
        ("a bumpy ball with a fold", (folded, Some(volume(&bumpy())))),
    ];
    cases.map(|(name, (triangles, volume))| (name, triangles, volume)).to_vec()
}

/// 4 reversed surfaces and 3 with odd faces.
fn turned_and_odd() -> Vec<Case> {
    let of = |triangles: &Triangles| Some(volume(triangles));
    let some: Triangles = bumpy()
        .into_iter()
        .enumerate()
        .map(|(k, [a, b, c])| if k % 10 < 3 { [a, c, b] } else { [a, b, c] })
        .collect();
    let (left, right) = (ball([0.0; 3], 8.0), ball([20.0, 0.0, 0.0], 6.0));
    let hollow = [ball([0.0; 3], 10.0), turned(ball([0.0; 3], 5.0))].concat();
    // Faces without area: a needle over an edge, and triangles of two corners.
    let [a, b, c] = bumpy()[400];
    let middle: Vector = std::array::from_fn(|x| 0.5 * (a[x] + b[x]));
    let needles = [bumpy(), vec![[a, b, middle]]].concat();
    let mut points = bumpy();
    points.extend([[a, a, b], [c, c, c]]);
    let mut near = bumpy();
    near.iter_mut().enumerate().for_each(|(k, t)| t.iter_mut().for_each(|p| p[2] += 5e-5 * (k % 5) as f64));
    vec![
        (
            "an egg inside out",
            turned(cap([0.0; 3], [20.0, 15.0, 10.0], PI)),
            of(&cap([0.0; 3], [20.0, 15.0, 10.0], PI)),
        ),
        ("a bumpy ball, partly reversed", some, of(&bumpy())),
        (
            "two balls, one inside out",
            [left.clone(), turned(right.clone())].concat(),
            of(&[left, right].concat()),
        ),
        ("a hollow ball inside out", turned(hollow.clone()), of(&hollow)),
        ("a bumpy ball with a needle", needles, of(&bumpy())),
        ("a bumpy ball with faces of two corners", [points, vec![[a, b, c]]].concat(), of(&bumpy())),
        ("a bumpy ball with scattered corners", near, of(&bumpy())),
    ]
}

/// Corners of triangles, and the triangles by corner.
fn indexed(triangles: &Triangles) -> (Vec<Vector>, Vec<[usize; 3]>) {
    let mut points: Vec<Vector> = Vec::new();
    let mut place = |p: &Vector| match points.iter().position(|known| known == p) {
        Some(at) => at,
        None => {
            points.push(*p);
            points.len() - 1
        }
    };
    let triangles = triangles.iter().map(|t| [place(&t[0]), place(&t[1]), place(&t[2])]).collect();
    (points, triangles)
}

fn rows<T: ToString, const N: usize>(rows: &[[T; N]], head: &str, tail: &str) -> String {
    let row = |row: &[T; N]| row.iter().map(T::to_string).collect::<Vec<_>>().join(" ");
    rows.iter().map(|values| format!("{head}{}{tail}\n", row(values))).collect()
}

/// 6 files of other formats, one of them with a hole.
fn formats() -> Vec<(&'static str, String, f64)> {
    let egg = cap([0.0; 3], [20.0, 15.0, 10.0], PI);
    let (points, faces) = indexed(&egg);
    let one: Vec<[usize; 3]> = faces.iter().map(|t| t.map(|p| p + 1)).collect();
    let (corners, count) = (points.len(), faces.len());
    let off = |head: &str, faces: &[[usize; 3]], tail: &str| {
        let list = rows(faces, "3 ", tail);
        format!("{head}\n# an egg\n{corners} {} 0\n{}{list}", faces.len(), rows(&points, "", ""))
    };
    let medit = |triangles: &[[usize; 3]]| {
        format!(
            "MeshVersionFormatted 2\nDimension\n3\nVertices {corners}\n{}Triangles\n{}\n{}Corners 1\n1\nEnd\n",
            rows(&points, "", " 0"),
            triangles.len(),
            rows(triangles, "", " 7")
        )
    };
    let vtp = |faces: &[[usize; 3]]| {
        let ends: Vec<[usize; 1]> = (1..=faces.len()).map(|k| [3 * k]).collect();
        let array = |kind: &str, more: &str, values: String| {
            format!("<DataArray type=\"{kind}\" {more} format=\"ascii\">\n{values}</DataArray>")
        };
        format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\">\n<PolyData>\n<Piece \
             NumberOfPoints=\"{corners}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" \
             NumberOfPolys=\"{}\">\n<Points>{}</Points>\n<Polys>{}{}</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n",
            faces.len(),
            array("Float64", "NumberOfComponents=\"3\"", rows(&points, "", "")),
            array("Int64", "Name=\"connectivity\"", rows(faces, "", "")),
            array("Int64", "Name=\"offsets\"", rows(&ends, "", "")),
        )
    };
    let volume = volume(&egg);
    vec![
        ("egg.off", off("OFF", &faces, ""), volume),
        ("coloured.off", off("COFF", &faces, " 255 0 0"), volume),
        ("egg.vtp", vtp(&faces), volume),
        ("open.vtp", vtp(&faces[..count - 1]), volume),
        ("egg.mesh", medit(&one), volume),
        ("open.mesh", medit(&one[1..]), volume),
    ]
}

/// Writes triangles as the text of an STL file.
fn stl(triangles: &Triangles) -> String {
    let mut text = "solid body\n".to_string();
    for corners in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        corners.iter().for_each(|[x, y, z]| writeln!(text, "vertex {x} {y} {z}").unwrap());
        text += "endloop\nendfacet\n";
    }
    text + "endsolid\n"
}

/// Takes the surface as a user does: as it is, or repaired, or wrapped at a fortieth of its diagonal.
fn body(path: &Path, diagonal: f64) -> Result<(f64, &'static str), SurfaceError> {
    if let Ok(surface) = read_surface(path, 1e-3) {
        return Ok((1e9 * surface.volume(), "as it is"));
    }
    let volume =
        |treatment| read_treated(path, 1e-3, treatment).map(|treated| 1e9 * treated.surface.volume());
    if let Ok(volume) = volume(Treatment::Repair) {
        return Ok((volume, "repaired"));
    }
    volume(Treatment::Wrap { size: 1e-3 * diagonal / 40.0 }).map(|volume| (volume, "wrapped"))
}

fn diagonal(triangles: &Triangles) -> f64 {
    let end =
        |x: usize, pick: fn(f64, f64) -> f64| triangles.iter().flatten().map(|p| p[x]).reduce(pick).unwrap();
    let size: Vector = std::array::from_fn(|x| end(x, f64::max) - end(x, f64::min));
    dot(size, size).sqrt()
}

/// The proportions of surfaces that public files have: 19 open, 16 branched, 12 crossing, 4 reversed, 3 with
/// odd faces, 6 by their format. A volume that is known is met within 1 %.
#[test]
fn surfaces_as_they_are_become_bodies() {
    let dir = tempfile::tempdir().unwrap();
    let kinds = [open(), branched(), crossing(), turned_and_odd()];
    assert_eq!(kinds.each_ref().map(Vec::len), [19, 16, 12, 7]);
    let mut found = Vec::new();
    for (name, triangles, volume) in kinds.into_iter().flatten() {
        let path = dir.path().join("body.stl");
        std::fs::write(&path, stl(&triangles)).unwrap();
        found.push((name, body(&path, diagonal(&triangles)), volume));
    }
    for (name, text, volume) in formats() {
        let path = dir.path().join(name);
        std::fs::write(&path, text).unwrap();
        found.push((name, body(&path, 53.9), Some(volume)));
    }
    assert_eq!(found.len(), 60);
    let report = |(name, body, volume): &(&str, Result<(f64, &str), SurfaceError>, Option<f64>)| match (
        body, volume,
    ) {
        (Err(bad), _) => format!("{name}: {bad}\n"),
        (Ok((found, how)), Some(volume)) => {
            format!("{name}: {how}, {:+.3} %\n", 100.0 * (found / volume - 1.0))
        }
        (Ok((found, how)), None) => format!("{name}: {how}, {found:.1}\n"),
    };
    let table: String = found.iter().map(report).collect();
    let fits = |(_, body, volume): &&(&str, Result<(f64, &str), SurfaceError>, Option<f64>)| {
        body.as_ref()
            .is_ok_and(|(found, _)| *found > 0.0 && volume.is_none_or(|v| (found / v - 1.0).abs() < 0.01))
    };
    let good = found.iter().filter(fits).count();
    // The ends of a short pipe bulge inwards: its volume is 1.3 % too small.
    assert!(good >= 59, "{good} of 60\n{table}");
    let repaired = found.iter().filter(|(_, body, _)| body.as_ref().is_ok_and(|(_, how)| *how == "repaired"));
    assert_eq!(repaired.count(), 22, "{table}");
}
