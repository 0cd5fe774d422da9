//! Group names in STL and OBJ files, after corners are merged, and on the mesh that fills the surface.

use std::collections::BTreeMap;
use std::path::Path;

use geometry::stuffing::{Stuffing, stuff};
use geometry::{Mesh, Surface};
use tissuebench_mesh_files as files;

/// Corners of the unit cube, and its named faces, counter-clockwise from outside.
const CORNERS: [[u8; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
const FACES: [(&str, [usize; 4]); 6] = [
    ("bottom", [0, 3, 2, 1]),
    ("top", [4, 5, 6, 7]),
    ("front", [0, 1, 5, 4]),
    ("right", [1, 2, 6, 5]),
    ("back", [2, 3, 7, 6]),
    ("left", [3, 0, 4, 7]),
];

fn read(name: &str, text: &str) -> Surface {
    files::read_surface_bytes(text.as_bytes(), Path::new(name), 1.0).unwrap_or_else(|bad| panic!("{bad}"))
}

/// A cube as OBJ, with the given text before each face.
fn obj(before: impl Fn(usize, &str) -> String) -> String {
    let corners: String = CORNERS.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    let faces = FACES.iter().enumerate().map(|(at, (name, face))| {
        let corners: Vec<String> = face.iter().map(|corner| (corner + 1).to_string()).collect();
        format!("{}f {}\n", before(at, name), corners.join(" "))
    });
    corners + &faces.collect::<String>()
}

/// STL solids of some faces each; corners deviate by up to a rounding error of single precision.
fn stl(solids: &[(&str, &[usize])]) -> String {
    let mut text = String::new();
    for (name, faces) in solids {
        text += &format!("solid {name}\n");
        for &face in *faces {
            let [a, b, c, d] = FACES[face].1;
            for (turn, corners) in [[a, b, c], [a, c, d]].into_iter().enumerate() {
                text += "facet normal 0 0 0\n outer loop\n";
                for [x, y, z] in corners.map(|corner| CORNERS[corner].map(f64::from)) {
                    text += &format!("vertex {} {y} {z}\n", x + 1e-8 * (face + turn) as f64);
                }
                text += " endloop\nendfacet\n";
            }
        }
        text += &format!("endsolid {name}\n");
    }
    text
}

/// Number of triangles with each name.
fn counts(surface: &Surface) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for triangle in 0..surface.triangles().len() {
        for &group in surface.groups().of(triangle) {
            *counts.entry(surface.groups().names()[group as usize].clone()).or_insert(0) += 1;
        }
    }
    assert_eq!(counts.len(), surface.groups().names().len(), "every name has a triangle");
    counts
}

fn filled(surface: &Surface) -> Mesh {
    stuff(surface, Stuffing { spacing: 0.2, doublings: 1 }).unwrap().mesh
}

/// Area of a named group of the boundary.
fn area(mesh: &Mesh, name: &str) -> f64 {
    let of = |&facet: &geometry::Facet| {
        let corners: Vec<_> = mesh.facet_nodes(facet).map(|node| mesh.points()[node as usize]).collect();
        0.5 * (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm()
    };
    mesh.group(name).unwrap().iter().map(of).sum()
}

#[test]
fn solids_of_an_stl_are_groups_of_one_closed_surface() {
    let surface =
        read("cube.stl", &stl(&[("held end", &[5]), ("pressed", &[3]), ("", &[0, 1]), ("skin", &[2, 4])]));
    assert_eq!((surface.points().len(), surface.triangles().len()), (8, 12), "corners are joined");
    assert_eq!(surface.groups().names(), ["held end", "pressed", "skin"]);
    assert_eq!(counts(&surface).into_values().collect::<Vec<_>>(), [2, 2, 4]);
    let mesh = filled(&surface);
    assert_eq!(mesh.group_names().collect::<Vec<_>>(), ["held end", "pressed", "skin", "surface"]);
    assert_eq!(mesh.group("surface").unwrap(), mesh.boundary());
    for (name, wanted) in [("held end", 1.0), ("pressed", 1.0), ("skin", 2.0)] {
        // Edges are rounded off at the size of a cell.
        assert!((area(&mesh, name) / wanted - 1.0).abs() < 0.1, "{name}: {}", area(&mesh, name));
    }
    let close = mesh.group("held end").unwrap();
    let x = |node: u32| mesh.points()[node as usize].x;
    assert!(close.iter().all(|&facet| mesh.facet_nodes(facet).map(x).sum::<f64>() < 3.0 * 0.15));
    // A missing solid leaves a hole, whether it is named or not.
    let open = stl(&[("held", &[5]), ("skin", &[0, 1, 2, 3])]);
    let bad = files::read_surface_bytes(open.as_bytes(), Path::new("a.stl"), 1.0).err().unwrap().to_string();
    assert!(bad.contains("a.stl: the surface is open"), "{bad}");
}

#[test]
fn one_name_is_kept_and_does_no_harm() {
    let all: &[usize] = &[0, 1, 2, 3, 4, 5];
    let mesh = filled(&read("cube.stl", &stl(&[("Exported by \"A, B\" ", all)])));
    assert_eq!(mesh.group("Exported by _A_ B_").unwrap(), mesh.boundary());
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.msh", "a.inp", "a.vtu"] {
        let file = folder.path().join(name);
        files::write(&mesh, &file, 1.0).unwrap();
        assert!(files::read(&file, 1.0).unwrap() == mesh, "{name}");
    }
    assert_eq!(filled(&read("cube.stl", &stl(&[("", all)]))).group_names().collect::<Vec<_>>(), ["surface"]);
}

#[test]
fn groups_and_objects_of_an_obj_are_kept() {
    // A face with several names, a face before any group or object, and objects without a group.
    let surface = read(
        "cube.obj",
        &obj(|at, name| match at {
            0 => String::new(),
            1 => format!("g {name} ends\n"),
            2 => "g\no the organ\n".into(),
            3 => String::new(),
            4 => "g ends\n".into(),
            _ => "g unused\ng  \n".into(),
        }),
    );
    assert!(surface.groups().of(0).is_empty() && surface.groups().of(1).is_empty());
    let found: Vec<(String, usize)> = counts(&surface).into_iter().collect();
    assert_eq!(
        found,
        [("ends", 4), ("the organ", 6), ("top", 2)].map(|(name, count)| (name.to_string(), count))
    );
    assert_eq!(surface.groups().names(), ["top", "ends", "the organ"]);
    let mesh = filled(&surface);
    for (name, wanted) in [("ends", 2.0), ("top", 1.0), ("the organ", 3.0)] {
        assert!((area(&mesh, name) / wanted - 1.0).abs() < 0.1, "{name}: {}", area(&mesh, name));
    }
    let top = mesh.group("top").unwrap();
    assert!(top.iter().all(|facet| mesh.group("ends").unwrap().contains(facet)), "in both groups");
}

#[test]
fn files_without_names_have_none_and_many_names_are_refused() {
    let plain = read("cube.obj", &obj(|_, _| String::new()));
    assert!(plain.groups().names().is_empty());
    let mesh = filled(&plain);
    let named = filled(&read("cube.obj", &obj(|_, name| format!("g {name}\n"))));
    assert_eq!(
        (mesh.points(), mesh.cell_count()),
        (named.points(), named.cell_count()),
        "names move nothing"
    );
    let areas: Vec<f64> = FACES.iter().map(|(name, _)| area(&named, name)).collect();
    assert!((areas.iter().sum::<f64>() - area(&named, "surface")).abs() < 1e-12, "each face once");
    let many: String = (0..200).map(|k| format!(" g{k}")).collect();
    let text = obj(|at, _| if at == 2 { format!("g{many}\n") } else { String::new() });
    let bad = files::read_surface_bytes(text.as_bytes(), Path::new("a.obj"), 1.0).err().unwrap().to_string();
    assert!(bad.contains("a.obj:11: too many groups of a face: 200"), "{bad}");
}

/// A group far smaller than the cells is kept without facets; a group with the name of the whole boundary
/// replaces it.
#[test]
fn small_groups_and_groups_of_known_names() {
    let part =
        read("cube.obj", &obj(|at, _| if at == 0 { "g surface\n".into() } else { "g other\n".into() }));
    let mesh = filled(&part);
    assert!(area(&mesh, "surface") < 1.2 && mesh.boundary().len() > mesh.group("surface").unwrap().len());
}
