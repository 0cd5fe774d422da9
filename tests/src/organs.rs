//! Surfaces of the organs of `cases/scenes/organ`, from formulas, as OBJ files in millimetres.
//!
//! Both are maps of the sphere, like the kidney. Coordinates are rounded to micrometres, so that the files are
//! the same on every machine.

use std::collections::HashMap;
use std::f64::consts::FRAC_PI_4;
use std::fmt::Write as _;

type Point = [f64; 3];
/// Corners of a triangle, counterclockwise seen from outside.
type Face = [Point; 3];

/// Name of a file and its text.
pub type File = (&'static str, String);

/// All surfaces.
pub fn all() -> [File; 2] {
    [("liver.obj", liver()), ("breast.obj", breast())]
}

/// The liver: 180 x 108 x 71 mm, thick on the right (-x) and thinner on the left, hollow below.
///
/// `(X, Y, Z)` on the unit sphere goes to `x = 90 X`, `y = (50 - 15 X) Y`, `z = (32 - 8 X) Z - 8 Y^2`, a
/// bijection of the ball: its Jacobian determinant is `90 (50 - 15 X) (32 - 8 X) > 0`.
fn liver() -> String {
    let map = |[x, y, z]: Point| [90.0 * x, (50.0 - 15.0 * x) * y, (32.0 - 8.0 * x) * z - 8.0 * y * y];
    obj(
        "the liver, 180 mm long",
        &[("liver", cube_sphere(10).into_iter().map(|face| face.map(map)).collect())],
    )
}

/// The breast: a dome of 55 mm on a chest of 120 x 120 mm, which is 20 mm deep below z = 0, fuller below (-y).
fn breast() -> String {
    // The horizontal circles of the dome move down between its foot and its tip.
    let map = |[x, y, z]: Point| {
        let height = z.max(0.0);
        [60.0 * x, 60.0 * y - 18.0 * height * (1.0 - height), if z > 0.0 { 55.0 * z } else { 20.0 * z }]
    };
    let (skin, chest): (Vec<Face>, Vec<Face>) =
        cube_sphere(10).into_iter().partition(|face| face.iter().any(|p| p[2] > 1e-9));
    let of = |faces: Vec<Face>| faces.into_iter().map(|face| face.map(map)).collect();
    obj("a breast on its chest, 120 mm wide", &[("skin", of(skin)), ("chest", of(chest))])
}

/// Triangles of the unit sphere: those of a cube with `n` x `n` squares on each side, evened out by the tangent.
fn cube_sphere(n: usize) -> Vec<Face> {
    let side = |axis: usize, side: f64| {
        let corner = move |[s, t]: [f64; 2]| {
            let mut p = [0.0; 3];
            p[axis] = side;
            p[(axis + 1) % 3] = (FRAC_PI_4 * s).tan();
            p[(axis + 2) % 3] = (FRAC_PI_4 * t).tan();
            let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            p.map(|x| x / length)
        };
        square(n, corner, side > 0.0)
    };
    (0..3).flat_map(|axis| [side(axis, -1.0), side(axis, 1.0)].concat()).collect()
}

/// Triangles of `n` x `n` squares of [-1, 1]^2 under a map, counterclockwise (`up`) or clockwise.
fn square(n: usize, map: impl Fn([f64; 2]) -> Point, up: bool) -> Vec<Face> {
    let at = |k: usize| 2.0 * k as f64 / n as f64 - 1.0;
    let corner = |i: usize, j: usize| map([at(i), at(j)]);
    let cut = |k: usize| {
        let (i, j) = (k / n, k % n);
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        // From the corner next to the middle of the square to the opposite one, for symmetry.
        let pair = if (2 * i < n) == (2 * j < n) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        pair.map(|[a, b, c]| if up { [a, b, c] } else { [a, c, b] })
    };
    (0..n * n).flat_map(cut).collect()
}

/// The text of a file with these groups of faces.
fn obj(title: &str, groups: &[(&str, Vec<Face>)]) -> String {
    let mut text = format!("# {title}; written by tests/src/organs.rs, in mm\n");
    let mut numbers: HashMap<String, usize> = HashMap::new();
    let mut faces = String::new();
    for (name, members) in groups {
        writeln!(faces, "g {name}").expect("a string");
        for face in members {
            let [a, b, c] = face.map(|p| {
                // Adding zero turns -0 into 0.
                let [x, y, z] = p.map(|x| (x * 1e3).round() / 1e3 + 0.0);
                let written = format!("v {x:.3} {y:.3} {z:.3}\n");
                let next = numbers.len() + 1;
                *numbers.entry(written.clone()).or_insert_with(|| {
                    text += &written;
                    next
                })
            });
            writeln!(faces, "f {a} {b} {c}").expect("a string");
        }
    }
    text + &faces
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// The committed files are those of the formulas. `TISSUEBENCH_ORGANS=write` writes them.
    #[test]
    fn files_are_those_of_the_formulas() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/scenes/organ");
        for (name, text) in all() {
            let file = folder.join(name);
            if std::env::var_os("TISSUEBENCH_ORGANS").is_some() {
                std::fs::write(&file, &text).expect("written");
            }
            assert!(std::fs::read_to_string(&file).is_ok_and(|old| old == text), "{name} is stale");
        }
    }

    /// The solid angle of the faces seen from inside is that of the whole sphere: closed and outwards.
    #[test]
    fn faces_close_a_volume_and_look_outwards() {
        for (name, text) in all() {
            let mut points: Vec<Point> = Vec::new();
            let mut edges: HashMap<[usize; 2], i32> = HashMap::new();
            let mut volume = 0.0;
            for line in text.lines() {
                let words: Vec<&str> = line.split_whitespace().collect();
                match words[0] {
                    "v" => points.push(std::array::from_fn(|x| words[x + 1].parse().unwrap())),
                    "f" => {
                        let at: [usize; 3] =
                            std::array::from_fn(|k| words[k + 1].parse::<usize>().unwrap() - 1);
                        let [a, b, c] = at.map(|k| nalgebra::Vector3::from(points[k]));
                        volume += a.dot(&b.cross(&c)) / 6.0;
                        for k in 0..3 {
                            let (from, to) = (at[k], at[(k + 1) % 3]);
                            *edges.entry([from.min(to), from.max(to)]).or_default() +=
                                if from < to { 1 } else { -1 };
                        }
                    }
                    _ => {}
                }
            }
            assert!(edges.values().all(|sum| *sum == 0), "{name} is open");
            // The exact volume (mm^3) of the liver, by its Jacobian determinant, and of the breast's two halves of
            // ellipsoids: circles that move sideways keep their volume.
            let exact = match name {
                "liver.obj" => 4.0 / 3.0 * std::f64::consts::PI * 90.0 * (50.0 * 32.0 + 15.0 * 8.0 / 5.0),
                _ => 2.0 / 3.0 * std::f64::consts::PI * 60.0 * 60.0 * (55.0 + 20.0),
            };
            assert!((volume / exact - 1.0).abs() < 0.03, "{name}: {volume} of {exact}");
        }
    }
}
