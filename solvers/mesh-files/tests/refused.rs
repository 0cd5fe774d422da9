//! Errors that other readers accept silently: blocks whose dimension or range contradicts their head, ranges
//! of sets beyond the mesh, and misspelt keywords.

mod common;

use common::{assert_refused, read};

/// Two tetrahedra, a triangle, a line and a point, with gaps in their numbers.
const BLOCKS: &str = "$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
2 5 \"held\"
$EndPhysicalNames
$Entities
1 1 1 1
1 0 0 0 0
1 0 0 0 1 0 0 0 0
1 0 0 0 1 1 0 1 5 0
1 0 0 0 1 1 1 0 0
$EndEntities
$Nodes
2 5 2 11
2 1 0 3
2
5
3
0 0 0
1 0 0
0 1 0
3 1 0 2
11
7
0 0 1
1 1 1
$EndNodes
$Elements
4 5 4 20
0 1 15 1
4 2
1 1 1 1
9 2 5
2 1 2 1
20 2 3 5
3 1 4 2
5 2 5 3 11
6 5 7 3 11
$EndElements
";

/// The same mesh in version 4.0, whose heads have the tag first and no smallest and largest number.
fn older() -> String {
    BLOCKS
        .replace("4.1 0 8", "4.0 0 8")
        .replace("\n1 0 0 0 0\n", "\n1 0 0 0 0 0 0 0\n")
        .replace(
            "2 5 2 11\n2 1 0 3\n2\n5\n3\n0 0 0\n1 0 0\n0 1 0\n",
            "2 5\n1 2 0 3\n2 0 0 0\n5 1 0 0\n3 0 1 0\n",
        )
        .replace("3 1 0 2\n11\n7\n0 0 1\n1 1 1\n", "1 3 0 2\n11 0 0 1\n7 1 1 1\n")
        .replace("4 5 4 20\n0 1 15 1", "4 5\n1 0 15 1")
        .replace("2 1 2 1\n20", "1 2 2 1\n20")
        .replace("3 1 4 2\n5", "1 3 4 2\n5")
}

#[test]
fn blocks_of_gmsh_are_what_they_say() {
    for text in [BLOCKS.to_string(), older()] {
        let mesh = read("a.msh", &text).unwrap_or_else(|bad| panic!("{bad}"));
        assert_eq!((mesh.points().len(), mesh.cell_count()), (5, 2));
        assert_eq!(mesh.group("held").map(<[_]>::len), Some(1));
    }
    let changes = [
        (
            "3 1 4 2\n5",
            "2 1 4 2\n5",
            "a.msh:38: a block of an entity of dimension 2 has elements of type 4, whose dimension is 3",
        ),
        (
            "2 1 2 1\n20",
            "3 1 2 1\n20",
            "a.msh:36: a block of an entity of dimension 3 has elements of type 2, whose dimension is 2",
        ),
        (
            "0 1 15 1",
            "1 1 15 1",
            "a.msh:32: a block of an entity of dimension 1 has elements of type 15, whose dimension is 0",
        ),
        (
            "1 1 1 1\n9",
            "-1 1 1 1\n9",
            "a block of an entity of dimension -1 has elements of type 1, whose dimension is 1",
        ),
        (
            "2 5 2 11",
            "2 5 1 11",
            "a.msh:16: the section says that its nodes are numbered 1 to 11, but they are 2 to 11",
        ),
        ("2 5 2 11", "2 5 2 5", "the section says that its nodes are numbered 2 to 5, but they are 2 to 11"),
        (
            "4 5 4 20",
            "4 5 4 5",
            "a.msh:31: the section says that its elements are numbered 4 to 5, but they are 4 to 20",
        ),
        (
            "4 5 4 20",
            "4 5 0 20",
            "the section says that its elements are numbered 0 to 20, but they are 4 to 20",
        ),
        ("4 5 4 20", "4 5 x 20", "a.msh:31: expected the least number, found 'x'"),
    ];
    assert_refused("a.msh", BLOCKS, changes);
    let says = "a block of an entity of dimension 2 has elements of type 4";
    assert_refused("a.msh", &older(), [("1 3 4 2\n5", "1 2 4 2\n5", says)]);
}

/// Nodes and elements numbered in steps of ten, with a gap.
const DECK: &str = "*NODE
10, 0, 0, 0
20, 1, 0, 0
30, 0, 1, 0
40, 0, 0, 1
60, 1, 1, 1
*ELEMENT, TYPE=C3D4
100, 10, 20, 30, 40
300, 20, 60, 30, 40
*NSET, NSET=face, GENERATE
10, 30, 10
*ELSET, ELSET=all, GENERATE
100, 300, 100
*NSET, NSET=most, GENERATE
20, 60, 10
*STEP
*KEYWORDS THAT NOBODY KNOWS
";

#[test]
fn ranges_end_at_nodes_and_elements_that_are_there() {
    let mesh = read("a.inp", DECK).unwrap();
    assert_eq!(mesh.region_names(), ["all"]);
    assert_eq!(mesh.facet_group_nodes(mesh.group("face").unwrap()), [0, 1, 2]);
    // Node 50 and element 200 do not exist: the sets contain the existing nodes and elements only.
    assert_eq!(mesh.facet_group_nodes(mesh.group("most").unwrap()), [1, 2, 3, 4]);
    let changes = [
        ("10, 30, 10", "10, 70, 10", "a.inp:11: node set 'face' names node 70, which the file does not have"),
        ("10, 30, 10", "1, 31, 10", "a.inp:11: node set 'face' names node 1, which the file does not have"),
        (
            "10, 30, 10",
            "10, 30, 7",
            "a.inp:11: expected a last number that is a whole number of steps from the first, found '10, 30, 7'",
        ),
        ("10, 30, 10", "1000, 2000, 10", "node set 'face' names node 1000"),
        ("100, 300, 100", "100, 400, 100", "a.inp:13: element set 'all' names element 400"),
        ("100, 300, 100", "100, 301", "a.inp:13: element set 'all' names element 301"),
        ("100, 300, 100", "100, 300, 150", "a last number that is a whole number of steps from the first"),
    ];
    assert_refused("a.inp", DECK, changes);
}

/// Ranges in sets of an assembly, whose numbers are those of an instance.
#[test]
fn ranges_of_an_assembly_end_at_what_is_there() {
    let (mesh, sets) = DECK.split_at(DECK.find("*NSET").unwrap());
    let sets = sets.split("*STEP").next().unwrap().replace(", GENERATE", ", GENERATE, INSTANCE=i");
    let text = format!(
        "*PART, NAME=p\n{mesh}*END PART\n*ASSEMBLY, NAME=a\n*INSTANCE, NAME=i, PART=p\n*END INSTANCE\n{sets}*END ASSEMBLY\n"
    );
    let mesh = read("a.inp", &text).unwrap_or_else(|bad| panic!("{bad}"));
    assert_eq!(mesh.facet_group_nodes(mesh.group("most").unwrap()), [1, 2, 3, 4]);
    let changes = [
        ("10, 30, 10", "10, 70, 10", "a.inp:16: node set 'face' names node 70"),
        (
            "100, 300, 100",
            "100, 300, 150",
            "a.inp:18: expected a last number that is a whole number of steps",
        ),
        ("100, 300, 100", "200, 300, 100", "a.inp:18: element set 'all' names element 200"),
    ];
    assert_refused("a.inp", &text, changes);
}

#[test]
fn keywords_that_nobody_has_are_refused_with_the_nearest() {
    let changes = [
        (
            "*NODE\n",
            "*NODES\n",
            "a.inp:1: *NODES is not a keyword of Abaqus or CalculiX; did you mean *NODE?",
        ),
        (
            "*ELEMENT, ",
            "*ELEMNT, ",
            "a.inp:7: *ELEMNT is not a keyword of Abaqus or CalculiX; did you mean *ELEMENT?",
        ),
        (
            "*ELSET, ",
            "*ELSTE, ",
            "a.inp:12: *ELSTE is not a keyword of Abaqus or CalculiX; did you mean *ELSET?",
        ),
        ("*ELSET, ", "*El Sett, ", "*EL SETT is not a keyword of Abaqus or CalculiX; did you mean *ELSET?"),
        ("*STEP", "*PART_INERTIA\n*STEP", "a.inp:16: *PART_INERTIA is not a keyword of Abaqus or CalculiX"),
        ("*STEP", "*\n*STEP", "a.inp:16: * is not a keyword of Abaqus or CalculiX"),
        ("*STEP", "*END_STEP\n*STEP", "did you mean *END STEP?"),
    ];
    assert_refused("a.inp", DECK, changes);
    // Keywords that do not belong to the mesh are skipped; blanks in a keyword are ignored, as in CalculiX.
    let others = "*Pre-tension Section, SURFACE=none, NODE=10\n*USERMATERIAL, CONSTANTS=1\n1.\n*VALUES AT INFINITY\n1.\n";
    let more = DECK.replace("*STEP", &format!("{others}*SOLIDSECTION, ELSET=all, MATERIAL=m\n*STEP"));
    assert_eq!(read("a.inp", &more).unwrap(), read("a.inp", DECK).unwrap());
    let keys = read("a.k", "*KEYWORD\n*NODE\n1, 0, 0, 0\n").unwrap_err();
    assert_eq!(keys, "a.k:1: *KEYWORD is not a keyword of Abaqus or CalculiX");
}
