//! Faces of many corners: concave faces are triangulated as they are, and self-crossing faces are rejected.

use std::fmt::Write;
use std::path::Path;

use geometry::Surface;
use proptest::prelude::*;
use tissuebench_mesh_files as files;

fn read(name: &str, text: &str) -> Result<Surface, String> {
    files::read_surface_bytes(text.as_bytes(), Path::new(name), 1.0).map_err(|bad| bad.to_string())
}

fn refusal(name: &str, text: &str) -> String {
    read(name, text).err().unwrap_or_else(|| panic!("{name} is read"))
}

/// A prism over an outline that is counter-clockwise from above, with its first corner and its coordinates
/// shifted cyclically.
fn prism(outline: &[[f64; 2]], first: usize, axis: usize) -> String {
    let count = outline.len();
    let mut text = String::new();
    for height in [0.0, 1.0] {
        for [x, y] in outline {
            let mut p = [*x, *y, height];
            p.rotate_right(axis);
            let _ = writeln!(text, "v {} {} {}", p[0], p[1], p[2]);
        }
    }
    let list = |numbers: Vec<usize>| numbers.iter().map(|n| format!(" {}", n + 1)).collect::<String>();
    let around = |k: usize| (first + k) % count;
    let bottom = (0..count).rev().map(around).collect();
    let top = (0..count).map(|k| count + around(k)).collect();
    let _ = writeln!(text, "f{}\nf{}", list(bottom), list(top));
    for k in 0..count {
        let next = (k + 1) % count;
        let _ = writeln!(text, "f{}", list(vec![k, next, count + next, count + k]));
    }
    text
}

fn area(outline: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

/// Converts an OBJ text to PLY.
fn ply(obj: &str) -> String {
    let of = |word: &str| obj.lines().filter_map(|line| line.strip_prefix(word)).collect::<Vec<_>>();
    let (points, faces) = (of("v "), of("f "));
    let face = |line: &str| {
        let corners: Vec<usize> = line.split(' ').map(|n| n.parse::<usize>().unwrap() - 1).collect();
        let list: Vec<String> = corners.iter().map(usize::to_string).collect();
        format!("{} {}\n", corners.len(), list.join(" "))
    };
    format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\nelement face {}\n\
         property list uchar int vertex_indices\nend_header\n{}\n{}",
        points.len(),
        faces.len(),
        points.join("\n"),
        faces.iter().map(|line| face(line)).collect::<String>()
    )
}

const ARROW: [[f64; 2]; 4] = [[0.0, 0.0], [2.0, -1.0], [0.5, 0.0], [2.0, 1.0]];
const ELL: [[f64; 2]; 6] = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
/// An outline with corners on straight edges.
const COMB: [[f64; 2]; 14] = [
    [0.0, 0.0],
    [2.0, 0.0],
    [5.0, 0.0],
    [5.0, 3.0],
    [4.0, 3.0],
    [4.0, 1.0],
    [3.0, 1.0],
    [3.0, 3.0],
    [2.0, 3.0],
    [2.0, 1.0],
    [1.0, 1.0],
    [1.0, 2.0],
    [1.0, 3.0],
    [0.0, 3.0],
];

#[test]
fn concave_faces_are_cut_from_any_corner_in_any_plane() {
    for outline in [&ARROW[..], &ELL, &COMB] {
        for first in 0..outline.len() {
            for axis in 0..3 {
                let text = prism(outline, first, axis);
                for (name, text) in [("a.obj", text.clone()), ("a.ply", ply(&text))] {
                    let surface =
                        read(name, &text).unwrap_or_else(|bad| panic!("{name} {first} {axis}: {bad}"));
                    let n = outline.len();
                    assert_eq!(surface.triangles().len(), 2 * (n - 2) + 2 * n);
                    assert!((surface.volume() - area(outline)).abs() < 1e-14, "{}", surface.volume());
                }
            }
        }
    }
}

#[test]
fn faces_that_are_not_simple_are_refused_with_their_line() {
    let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 3.0]];
    let even = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    let spike = [[0.0, 0.0], [3.0, 0.0], [2.0, 0.0], [2.0, 2.0]];
    let touching = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 0.0], [0.0, 3.0]];
    let star = [0, 2, 4, 1, 3].map(|k| {
        let angle = std::f64::consts::TAU * f64::from(k) / 5.0;
        [angle.cos(), angle.sin()]
    });
    for (outline, edges) in [
        (&bow_tie[..], "1 and 3"),
        (&even, "1 and 3"),
        (&spike, "1 and 2"),
        (&touching, "1 and 3"),
        (&star, "1 and 3"),
    ] {
        let text = prism(outline, 0, 0);
        // The top has the orientation of the outline, which determines its edge numbers.
        let bad = refusal("a.obj", &text);
        let line = 1 + 2 * outline.len();
        assert!(bad.starts_with(&format!("a.obj:{line}: edges ")), "{bad}");
        assert!(bad.contains("of face 1 (numbered by their first corners) cross or touch"), "{bad}");
        let top = text
            .lines()
            .filter(|line| !line.starts_with('f'))
            .chain(text.lines().skip(line))
            .collect::<Vec<_>>();
        let bad = refusal("a.obj", &top.join("\n"));
        assert!(bad.starts_with(&format!("a.obj:{line}: edges {edges} of face 1")), "{bad}");
        assert!(refusal("a.ply", &ply(&text)).contains("of face 1 (numbered"));
    }
    let large: Vec<[f64; 2]> = (0..1200)
        .map(|k| {
            let angle = std::f64::consts::TAU * f64::from(k) / 1200.0;
            let radius = if k % 2 == 0 { 1.0 } else { 0.9 };
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect();
    let bad = refusal("a.obj", &prism(&large, 0, 0));
    assert!(bad.starts_with("a.obj:2401: face 1 is concave and has 1200 corners"), "{bad}");
}

/// Many programs repeat a polygon's first corner at the end, or list a corner twice.
#[test]
fn corners_given_twice_in_a_row_are_one() {
    let text = prism(&ELL, 0, 0).replace("f 7 8 9", "f 7 7 8 9").replace("f 1 2 8 7", "f 1 2 2 8 7");
    assert_eq!(read("a.obj", &text).unwrap().triangles().len(), 20);
}

#[test]
fn faces_may_come_before_their_corners() {
    let text = prism(&ELL, 0, 0);
    let (corners, faces): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| line.starts_with('v'));
    let first = [faces.join("\n"), corners.join("\n")].join("\n");
    let surface = read("a.obj", &first).unwrap();
    assert!((surface.volume() - area(&ELL)).abs() < 1e-14);
    let bad = refusal("a.obj", &first.replacen("f 6", "f 13", 1));
    assert_eq!(bad, "a.obj:1: face 1 names corner 13, which the file does not have");
    // Negative numbers refer only to corners before the face.
    let bad = refusal("a.obj", &first.replacen("f 6", "f -1", 1));
    assert_eq!(bad, "a.obj:1: face 1 names corner -1, which the file does not have");
}

#[test]
fn a_mark_of_the_encoding_is_no_part_of_a_surface() {
    let facet = |corners: [[u8; 3]; 3]| {
        let lines = corners.map(|[x, y, z]| format!("vertex {x} {y} {z}\n"));
        format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", lines.concat())
    };
    let [o, x, y, z] = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let facets = [[o, y, x], [o, x, z], [x, y, z], [o, z, y]].map(facet).concat();
    let obj = prism(&ELL, 0, 0);
    let texts = [("a.stl", format!("solid a\n{facets}endsolid a\n")), ("a.ply", ply(&obj)), ("a.obj", obj)];
    for (name, text) in texts {
        let plain = read(name, &text).unwrap();
        let marked = read(name, &format!("\u{feff}{text}")).unwrap_or_else(|bad| panic!("{bad}"));
        assert_eq!((marked.points(), marked.triangles()), (plain.points(), plain.triangles()), "{name}");
        let bytes = format!("\u{feff}{text}").into_bytes();
        let bad = files::read_bytes(&bytes, Path::new(name), 1.0).unwrap_err().to_string();
        assert!(bad.contains("is a surface, not a mesh"), "{bad}");
    }
}

proptest! {
    /// Star-shaped outlines with random radii.
    #[test]
    fn any_simple_face_is_filled(radii in prop::collection::vec(0.1f64..1.0, 4..40), first in 0usize..40) {
        let count = radii.len();
        let outline: Vec<[f64; 2]> = radii.iter().enumerate().map(|(k, radius)| {
            let angle = std::f64::consts::TAU * k as f64 / count as f64;
            [radius * angle.cos(), radius * angle.sin()]
        }).collect();
        let surface = read("a.obj", &prism(&outline, first % count, 1)).unwrap();
        prop_assert_eq!(surface.triangles().len(), 2 * (count - 2) + 2 * count);
        prop_assert!((surface.volume() / area(&outline) - 1.0).abs() < 1e-12);
    }
}
