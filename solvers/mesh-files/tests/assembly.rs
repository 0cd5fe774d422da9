//! Decks of several parts: shared names, and surfaces of the free faces of elements.

mod common;

use common::assert_refused;
use geometry::Mesh;

fn deck(text: &str) -> Result<Mesh, String> {
    common::read("deck.inp", text)
}

/// A tetrahedron with a node set, an element set and a surface.
fn part(name: &str, sets: &str) -> String {
    format!(
        "*PART, NAME={name}\n*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n{sets}*END PART\n"
    )
}

/// Default names of Abaqus/CAE.
const SETS: &str = "*NSET, NSET=Set-1\n1, 2, 3\n*ELSET, ELSET=Set-1\n1\n*ELSET, ELSET=Only\n1\n*SURFACE, NAME=Surf-1\n1, S2\n\
    *SOLID SECTION, ELSET=Set-1, MATERIAL=m\n1.,\n";

fn assembly(parts: &str, instances: &[(&str, &str)], sets: &str) -> String {
    let placed = instances.iter().enumerate().map(|(k, (name, part))| {
        format!("*INSTANCE, NAME={name}, PART={part}\n{}., 0., 0.\n*END INSTANCE\n", 2 * k)
    });
    format!("{parts}*ASSEMBLY, NAME=all\n{}{sets}*END ASSEMBLY\n", placed.collect::<String>())
}

fn groups(mesh: &Mesh) -> Vec<(&str, usize)> {
    mesh.group_names().map(|name| (name, mesh.group(name).unwrap().len())).collect()
}

#[test]
fn names_that_two_parts_share_stay_apart() {
    let parts = part("P", SETS) + &part("Q", &SETS.to_uppercase().replace("SURF-1", "Other"));
    let mesh = deck(&assembly(&parts, &[("P-1", "P"), ("Q-1", "Q")], "")).unwrap();
    assert_eq!(mesh.region_names(), ["P-1.Set-1", "Q-1.SET-1"]);
    assert_eq!([0, 1].map(|cell| mesh.region(cell)), [0, 1]);
    // A name that occurs in only one part is kept.
    assert_eq!(groups(&mesh), [("Other", 1), ("P-1.Set-1", 1), ("Q-1.SET-1", 1), ("Surf-1", 1)]);
    assert_eq!(mesh.group("P-1.Set-1").unwrap()[0].cell, 0);
    assert_eq!(mesh.group("Q-1.SET-1").unwrap()[0].cell, 1);
}

#[test]
fn instances_of_one_part_have_their_own_names() {
    let twice = [("a", "P"), ("b", "P")];
    let mesh = deck(&assembly(&part("P", SETS), &twice, "")).unwrap();
    assert_eq!(mesh.region_names(), ["a.Set-1", "b.Set-1"]);
    assert_eq!(groups(&mesh), [("a.Set-1", 1), ("a.Surf-1", 1), ("b.Set-1", 1), ("b.Surf-1", 1)]);
    let once = deck(&assembly(&part("P", SETS), &twice[..1], "")).unwrap();
    assert_eq!(once.region_names(), ["Set-1"]);
    assert_eq!(groups(&once), [("Set-1", 1), ("Surf-1", 1)]);
    // Elements outside of sets form no regions.
    let plain = deck(&assembly(&part("P", ""), &twice, "")).unwrap();
    assert_eq!(plain.region_names(), ["body"]);
    let same = assembly(&part("P", SETS), &[("a", "P"), ("A", "P")], "");
    let bad = deck(&same).unwrap_err();
    assert!(bad.starts_with("deck.inp:24: instance 'A' occurs a second time"), "{bad}");
}

/// A set of the assembly is separate from the sets of its parts, even with the same name.
#[test]
fn sets_of_the_assembly_keep_their_names() {
    let sets = "*NSET, NSET=Set-1, INSTANCE=P-1\n1, 3, 4\n*NSET, NSET=both\nP-1.Set-1, P-1.4\n";
    let mesh = deck(&assembly(&part("P", SETS), &[("P-1", "P")], sets)).unwrap();
    assert_eq!(mesh.region_names(), ["Set-1"]);
    assert_eq!(groups(&mesh), [("P-1.Set-1", 1), ("Set-1", 1), ("Surf-1", 1), ("both", 4)]);
    let nodes = |name: &str| mesh.facet_group_nodes(mesh.group(name).unwrap());
    assert_eq!((nodes("Set-1"), nodes("P-1.Set-1")), (vec![0, 2, 3], vec![0, 1, 2]));
}

/// Abaqus/CAE writes the mesh of an independent instance inside the instance, and its part without a mesh.
#[test]
fn the_mesh_of_an_instance_is_its_own() {
    let body = part("", SETS);
    let mesh = body.split_once('\n').unwrap().1.replace("*END PART\n", "");
    let independent =
        |name: &str, shift: &str| format!("*INSTANCE, NAME={name}, PART=P\n{shift}{mesh}*END INSTANCE\n");
    let around = |placed: &str| {
        format!(
            "*PART, NAME=P\n*END PART\n*ASSEMBLY, NAME=all\n{placed}*NSET, NSET=tip, INSTANCE=a\n1, 3, 4\n*END ASSEMBLY\n"
        )
    };
    let one = deck(&around(&independent("a", "5., 0., 0.\n"))).unwrap();
    assert_eq!(one.region_names(), ["Set-1"]);
    assert_eq!(groups(&one), [("Set-1", 1), ("Surf-1", 1), ("tip", 1)]);
    assert_eq!(one.points()[3], geometry::Point3::new(5.0, 0.0, 1.0));
    let two = deck(&around(&(independent("a", "") + &independent("b", "2., 0., 0.\n")))).unwrap();
    assert_eq!(two.region_names(), ["a.Set-1", "b.Set-1"]);
    assert_eq!((two.cell_count(), two.points()[7].x), (2, 2.0));
    // An instance may add sets to the mesh of its part.
    let twice = [("a", "P"), ("b", "P")];
    let added = assembly(&part("P", SETS), &twice, "").replacen(
        "*END INSTANCE",
        "*NSET, NSET=more\n2, 3, 4\n*END INSTANCE",
        1,
    );
    let mesh = deck(&added).unwrap();
    assert_eq!(
        groups(&mesh),
        [("a.Set-1", 1), ("a.Surf-1", 1), ("b.Set-1", 1), ("b.Surf-1", 1), ("more", 1)]
    );
    assert_eq!(mesh.facet_group_nodes(mesh.group("more").unwrap()), [1, 2, 3]);
    let changes = [
        (
            "*END INSTANCE\n*NSET, NSET=tip",
            "*NSET, NSET=tip",
            "deck.inp:4: expected *END INSTANCE, found 'instance a is still open'",
        ),
        ("1, 2, 3\n", "1, 2, 9\n", "deck.inp:13: node set 'Set-1' names node 9"),
        ("*END INSTANCE", "*END PART", "expected *PART before *END PART, found 'none'"),
        ("*END INSTANCE", "*PART, NAME=Q", "expected *END INSTANCE before the next *PART"),
        ("*END INSTANCE", "*INSTANCE, NAME=b, PART=P", "expected *END INSTANCE before the next *INSTANCE"),
    ];
    let text = around(&independent("a", ""));
    assert_refused("deck.inp", &text, changes);
}

/// Three hexahedra in a row along x.
const ROW: &str = "*NODE
1, 0, 0, 0
2, 0, 1, 0
3, 0, 1, 1
4, 0, 0, 1
5, 1, 0, 0
6, 1, 1, 0
7, 1, 1, 1
8, 1, 0, 1
9, 2, 0, 0
10, 2, 1, 0
11, 2, 1, 1
12, 2, 0, 1
13, 3, 0, 0
14, 3, 1, 0
15, 3, 1, 1
16, 3, 0, 1
*ELEMENT, TYPE=C3D8, ELSET=row
1, 1, 2, 3, 4, 5, 6, 7, 8
2, 5, 6, 7, 8, 9, 10, 11, 12
3, 9, 10, 11, 12, 13, 14, 15, 16
*ELSET, ELSET=middle
2
*ELSET, ELSET=left
1, 2
";

#[test]
fn a_surface_of_elements_alone_has_their_free_faces() {
    let surfaces = "*SURFACE, NAME=ring\nmiddle\n*SURFACE, NAME=open, TYPE=ELEMENT\nleft,\n*SURFACE, NAME=all\nrow\n\
        *SURFACE, NAME=some\nmiddle\n3, S2\n";
    let wanted = [("all", 14), ("open", 9), ("ring", 4), ("some", 5)];
    let flat = deck(&format!("{ROW}{surfaces}")).unwrap();
    assert_eq!(groups(&flat), wanted);
    let nodes = |mesh: &Mesh, name: &str| mesh.facet_group_nodes(mesh.group(name).unwrap());
    assert_eq!(nodes(&flat, "open"), (0..12).collect::<Vec<u32>>());
    // Faces of the part and of an assembly; the instances share no nodes.
    let inner = format!("*PART, NAME=P\n{ROW}{surfaces}*END PART\n");
    let outer = "*SURFACE, NAME=second\nb.left\n";
    let mesh = deck(&assembly(&inner, &[("a", "P"), ("b", "P")], outer)).unwrap();
    let count = |name: &str| mesh.group(name).map(<[_]>::len);
    let both = ["a.ring", "b.ring", "a.open", "b.open", "second"].map(count);
    assert_eq!(both, [Some(4), Some(4), Some(9), Some(9), Some(9)]);
    assert_eq!(nodes(&mesh, "second"), (16..28).collect::<Vec<u32>>());
}

#[test]
fn surfaces_without_free_faces_are_refused() {
    let text = format!("{ROW}*SURFACE, NAME=top\n1, S1\n*SURFACE, NAME=inner\nmiddle\n");
    let changes = [
        ("middle\n2\n", "middle\n", "deck.inp:28: surface 'inner' has no face: give the faces (S1, S2, ..)"),
        ("inner\nmiddle", "inner\nother", "deck.inp:29: surface 'inner' names set other"),
        ("inner\nmiddle", "inner\n7", "deck.inp:29: surface 'inner' names element 7"),
        ("1, S1", "1, S9", "deck.inp:27: expected a face that the element has, found 'S9 of element 1'"),
        ("1, S1", "1, T1", "deck.inp:27: expected the face of an element, such as S1, found 'T1'"),
    ];
    assert_refused("deck.inp", &text, changes);
}
