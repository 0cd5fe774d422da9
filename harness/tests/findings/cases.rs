//! A valid scene, and edits that make it invalid.

pub const SCENE: &str = r#"title = "A block"

[body]
shape = "box"
size = ["40 mm", "40 mm", "20 mm"]

[material]
law = "linear"
young = "20 kPa"
poisson = 0.3

[[support]]
where = "z == 0 mm"
fix = "xyz"

[[load]]
on = "z-max"
pressure = "1 kPa"

[[method]]
id = "tet4"
family = "fem"
element = "tet4"
size = { cells = [2, 2, 2] }

[[method]]
id = "efg"
family = "efg"
nodes = 60
kernel = "cubic-spline"
support_scale = 1.6
basis = "linear"
integration = { rule = "gauss", points = 4 }
essential = "nitsche"
"#;

/// Two tetrahedra with a common face and a named surface `roof`, in millimetres.
pub const MESH: &str = r#"$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "roof"
3 2 "tissue"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 40 0 0
3 0 40 0
4 0 0 20
5 40 40 20
$EndNodes
$Elements
3
1 2 2 1 1 3 4 5
2 4 2 2 1 1 2 3 4
3 4 2 2 1 2 3 4 5
$EndElements
"#;

const OF_FILE: &[(&str, &str)] = &[
    (
        "shape = \"box\"\nsize = [\"40 mm\", \"40 mm\", \"20 mm\"]",
        "shape = \"file\"\npath = \"two.msh\"\nunit = \"mm\"",
    ),
    ("size = { cells = [2, 2, 2] }", "size = { file = \"two.msh\", unit = \"mm\" }"),
    ("nodes = 60", "size = { file = \"two.msh\", unit = \"mm\" }"),
    ("on = \"z-max\"", "on = \"roof\""),
];

const OCTANT: &[(&str, &str)] = &[
    (
        "shape = \"box\"\nsize = [\"40 mm\", \"40 mm\", \"20 mm\"]",
        "shape = \"sphere-shell\"\ninner = \"10 mm\"\nouter = \"20 mm\"\noctant = true",
    ),
    ("size = { cells = [2, 2, 2] }", "size = { level = 1 }"),
    ("nodes = 60", "size = { level = 1 }"),
    ("on = \"z-max\"", "on = \"outer\""),
];

/// An edit that makes the valid scene invalid, and the expected error.
pub struct Case {
    pub name: &'static str,
    /// Replacements made before `edit`, which leave the scene valid.
    pub base: &'static [(&'static str, &'static str)],
    /// Replacement in the scene; the line that the error must name ends in `#<`.
    pub edit: (&'static str, &'static str),
    /// Replacement in the mesh file.
    pub mesh: (&'static str, &'static str),
    pub code: i32,
    pub key: &'static str,
    pub says: &'static [&'static str],
    /// Methods that cannot run; the others must run.
    pub stops: &'static [&'static str],
}

pub const SOUND: Case = Case {
    name: "",
    base: &[],
    edit: ("", ""),
    mesh: ("", ""),
    code: 2,
    key: "",
    says: &[],
    stops: &["tet4", "efg"],
};

pub const CASES: &[Case] = &[
    Case {
        name: "a support beside the body",
        edit: ("where = \"z == 0 mm\"", "where = \"z == 90 mm\" #<"),
        key: "support[0].where",
        says: &[
            "'z == 90 mm' touches no part of the body",
            "x = 0 to 40, y = 0 to 40, z = 0 to 20 mm",
            "signs and the unit",
        ],
        ..SOUND
    },
    Case {
        name: "a load beside the body, its region off by the unit",
        edit: ("on = \"z-max\"", "where = \"z >= 20 m\" #<"),
        key: "load[0].where",
        says: &["'z >= 20 m' touches no part of the body", "z = 0 to 20 mm"],
        ..SOUND
    },
    Case {
        name: "the second of two supports",
        edit: ("[[load]]", "[[support]]\nwhere = \"x < 0 mm\" #<\nfix = \"x\"\n\n[[load]]"),
        key: "support[1].where",
        says: &["'x < 0 mm' touches no part of the body"],
        ..SOUND
    },
    Case {
        name: "a material region that holds nothing",
        edit: (
            "[[support]]",
            "[[region]]\nname = \"tumour\"\nwhere = \"z >= 30 mm\" #<\nmaterial = { law = \"linear\", young = \"5 kPa\", \
             poisson = 0.3 }\n\n[[support]]",
        ),
        key: "region[0].where",
        says: &["'z >= 30 mm' contains no cell", "z = 0 to 20 mm"],
        ..SOUND
    },
    Case {
        name: "a cloud denser nowhere",
        edit: ("nodes = 60", "nodes = 60\ncloud = \"graded\"\ngraded_towards = \"z >= 30 mm\" #<"),
        key: "method[1].graded_towards",
        says: &["'z >= 30 mm' contains no point of the body", "unit"],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "no support",
        base: &[("[[support]]\nwhere = \"z == 0 mm\"\nfix = \"xyz\"\n", "")],
        edit: ("[body]", "[body] #<"),
        code: 3,
        key: "body",
        says: &["has no [[support]]", "translation along x", "rotation about z", "fix = \"xyz\""],
        ..SOUND
    },
    Case {
        name: "a support that lets slide",
        edit: ("fix = \"xyz\"", "fix = \"z\" #<"),
        code: 3,
        key: "support[0].fix",
        says: &[
            "'z' does not constrain the body",
            "translation along x, translation along y, rotation about z",
        ],
        ..SOUND
    },
    Case {
        name: "two supports that let slide",
        edit: (
            "[[support]]\nwhere = \"z == 0 mm\"\nfix = \"xyz\"",
            "[[support]] #<\nwhere = \"z == 0 mm\"\nfix = \"z\"\n\n[[support]]\nwhere = \"x == 0 mm\"\nfix = \"x\"",
        ),
        code: 3,
        key: "support",
        says: &["all 2 supports together (lines 12, 16)", "translation along y"],
        ..SOUND
    },
    Case {
        name: "supports that contradict each other",
        edit: (
            "[[support]]\nwhere = \"z == 0 mm\"\nfix = \"xyz\"",
            "[[support]]\nwhere = \"z == 0 mm\"\nfix = \"xyz\"\n\n[[support]] #<\nwhere = \"x == 0 mm\"\nmove = { x = \"1 mm\" }",
        ),
        key: "support[1]",
        says: &["1.000000e0 mm along x at (0.0, 0.0, 0.0) mm, where support[0]", "values agree"],
        stops: &["tet4", "efg"],
        ..SOUND
    },
    Case {
        name: "supports of a cloud too narrow",
        // The nodes lie on two faces 40 mm apart, at distances of 5 mm.
        base: &[("nodes = 60", "size = { cells = [1, 8, 8] }")],
        edit: ("support_scale = 1.6", "support_scale = 1.2 #<"),
        code: 3,
        key: "method[1].support_scale",
        says: &["'1.2'", "neighbours", "larger support"],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "neighbours of a cloud too near",
        base: &[("nodes = 60", "size = { cells = [1, 8, 8] }")],
        edit: ("support_scale = 1.6", "neighbours = 4 #<"),
        code: 3,
        key: "method[1].neighbours",
        says: &["'4'", "neighbours", "larger support"],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "a cloud of fewer nodes than its basis has terms",
        edit: (
            "nodes = 60\nkernel = \"cubic-spline\"\nsupport_scale = 1.6\nbasis = \"linear\"",
            "nodes = 8 #<\nkernel = \"cubic-spline\"\nsupport_scale = 1.6\nbasis = \"quadratic\"",
        ),
        key: "method[1].nodes",
        says: &["'8'", "at least 10"],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "a number of points without a rule",
        edit: ("rule = \"gauss\", points = 4 }", "rule = \"gauss\", points = 7 } #<"),
        key: "method[1].integration.points",
        says: &["'7'", "1, 4, 8, 14, 15"],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "a grid too fine",
        edit: ("rule = \"gauss\", points = 4 }", "rule = \"grid\", points = 8, spacing = \"1 um\" } #<"),
        key: "method[1].integration.spacing",
        says: &["'1 um'", "coarser"],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "a stabilisation too small",
        edit: ("essential = \"nitsche\"", "essential = { method = \"nitsche\", factor = 0.01 } #<"),
        code: 3,
        key: "method[1].essential",
        says: &["gamma = 0.01 is too small"],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "cells for a body that has none",
        base: &[
            (
                "shape = \"box\"\nsize = [\"40 mm\", \"40 mm\", \"20 mm\"]",
                "shape = \"ball\"\nradius = \"20 mm\"",
            ),
            ("on = \"z-max\"", "on = \"surface\""),
            ("z == 0 mm", "z <= 0 mm"),
        ],
        edit: ("size = { cells = [2, 2, 2] }", "size = { cells = [2, 2, 2] } #<"),
        key: "method[0].size.cells",
        says: &["is for boxes, not for a ball", "level, nodes or spacing"],
        stops: &["tet4"],
        ..SOUND
    },
    Case {
        name: "a mesh too fine to be meant",
        edit: ("size = { cells = [2, 2, 2] }", "size = { spacing = \"1 um\" } #<"),
        key: "method[0].size.spacing",
        says: &["'1 um' gives 20000 cells", "1000"],
        stops: &["tet4"],
        ..SOUND
    },
    Case {
        name: "jitter that folds cells",
        edit: ("cells = [2, 2, 2] }", "cells = [6, 6, 3] }\njitter = { fraction = 0.49, seed = 3 } #<"),
        key: "method[0].jitter.fraction",
        says: &["'0.49'", "is inverted: det J = -", "smaller"],
        stops: &["tet4"],
        ..SOUND
    },
    Case {
        name: "a pressure without a value",
        edit: ("pressure = \"1 kPa\"", "pressure = { unit = \"Pa\", of = \"1 / (x - x)\" } #<"),
        key: "load[0].pressure",
        says: &["'1 / (x - x)' is", "finite"],
        ..SOUND
    },
    Case {
        name: "a mesh file that is none",
        base: OF_FILE,
        edit: (
            "size = { file = \"two.msh\", unit = \"mm\" }\n\n",
            "size = { file = \"two.msh\", unit = \"mm\" } #<\n\n",
        ),
        mesh: ("5 40 40 20", "5 40 40 nan"),
        key: "method[0].size.file",
        says: &["two.msh:15: ", "Gmsh .msh (1, 2.2, 4.0 or 4.1)"],
        ..SOUND
    },
    Case {
        name: "a surface that the mesh file does not name",
        base: OF_FILE,
        edit: ("on = \"roof\"", "on = \"bottom\" #<"),
        key: "load[0].on",
        says: &["'bottom'", "the mesh has surface, roof"],
        ..SOUND
    },
    Case {
        name: "a material region that the mesh file does not name",
        base: OF_FILE,
        edit: (
            "[[support]]",
            "[[region]]\nname = \"tumour\"\non = \"tumor\" #<\nmaterial = { law = \"linear\", young = \"5 kPa\", \
             poisson = 0.3 }\n\n[[support]]",
        ),
        key: "region[0].on",
        says: &["'tumor' contains no cell", "the mesh has tissue"],
        ..SOUND
    },
    Case {
        name: "an inverted element in a mesh file",
        base: OF_FILE,
        edit: (
            "size = { file = \"two.msh\", unit = \"mm\" }\n\n",
            "size = { file = \"two.msh\", unit = \"mm\" } #<\n\n",
        ),
        mesh: ("2 4 2 2 1 1 2 3 4", "2 4 2 2 1 1 3 2 4"),
        key: "method[0].size.file",
        says: &["'two.msh' gives a mesh in which 1 of 2 cells is inverted (line 20, element 2)", "order"],
        ..SOUND
    },
    Case {
        name: "a mesh file of mirrored cells",
        base: OF_FILE,
        edit: (
            "size = { file = \"two.msh\", unit = \"mm\" }\n\n",
            "size = { file = \"two.msh\", unit = \"mm\" } #<\n\n",
        ),
        mesh: ("2 4 2 2 1 1 2 3 4\n3 4 2 2 1 2 3 4 5", "2 4 2 2 1 1 3 2 4\n3 4 2 2 1 3 2 4 5"),
        key: "method[0].size.file",
        says: &[
            "all 2 cells are inverted (first: line 20, element 2): the order of their corners is mirrored",
        ],
        ..SOUND
    },
    Case {
        name: "a mesh file of other cells",
        base: OF_FILE,
        edit: (
            "element = \"tet4\"\nsize = { file = \"two.msh\", unit = \"mm\" }",
            "element = \"hex8\"\nsize = { file = \"two.msh\", unit = \"mm\" } #<",
        ),
        key: "method[0].size.file",
        says: &[
            "holds tet4 cells, not hex8",
            "the cells can't be converted to hex8; take a method of tet4 or tet10",
        ],
        stops: &["tet4"],
        ..SOUND
    },
    Case {
        name: "a grid clipped by an octant",
        base: OCTANT,
        edit: (
            "integration = { rule = \"gauss\", points = 4 }",
            "integration = { rule = \"grid\", points = 8 } #<",
        ),
        key: "method[1].integration.rule",
        says: &["'grid' needs a test for points inside the body", "\"gauss\" or \"cell-smoothed\""],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "a grid over several regions",
        base: &[(
            "[[support]]",
            "[[region]]\nname = \"tumour\"\nwhere = \"z >= 10 mm\"\nmaterial = { law = \"linear\", young = \"5 kPa\", \
             poisson = 0.3 }\n\n[[support]]",
        )],
        edit: (
            "integration = { rule = \"gauss\", points = 4 }",
            "integration = { rule = \"grid\", points = 8 } #<",
        ),
        code: 3,
        key: "method[1].integration.rule",
        says: &["'grid' can't assign the points of a grid"],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "one dilation per cell with points at vertices",
        base: &[],
        edit: (
            "integration = { rule = \"gauss\", points = 4 }",
            "integration = { rule = \"node-smoothed\", stabilisation = 0 }\ndilation = \"element-mean\" #<",
        ),
        code: 3,
        key: "method[1].dilation",
        says: &["'element-mean' needs integration points that belong to background cells", "\"nodal-mean\""],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "a mean dilation over a negative volume",
        edit: (
            "nodes = 60\nkernel = \"cubic-spline\"\nsupport_scale = 1.6\nbasis = \"linear\"\nintegration = { rule = \"gauss\", points = 4 }",
            "size = { cells = [4, 4, 2] }\nkernel = \"cubic-spline\"\nsupport_scale = 2.6\nbasis = \"quadratic\"\ndilation = \"nodal-mean\" #<\n\
             integration = { rule = \"cell-smoothed\", order = 2, points = 6 }",
        ),
        code: 3,
        key: "method[1].dilation",
        says: &["'nodal-mean' averages over -6.265e-10 m^3 at node 0", "\"nodal-near\""],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "a cloud of an exact count in an octant",
        base: &[OCTANT[0], OCTANT[1], OCTANT[3]],
        edit: ("nodes = 60", "nodes = 60 #<"),
        key: "method[1].nodes",
        says: &["'60' places an exact number of nodes", "the nodes of a mesh"],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "targets in a mesh file that is none",
        edit: (
            "[[method]]\nid = \"tet4\"",
            "[output]\ntransfer = { to = { file = \"two.msh\" }, scheme = \"shepard\" } #<\n\n[[method]]\nid = \"tet4\"",
        ),
        mesh: ("4 0 0 20", "4 0 0"),
        key: "output.transfer.to.file",
        says: &["'two.msh' can't be read", "two.msh:14: ", "Gmsh .msh (1, 2.2, 4.0 or 4.1)"],
        ..SOUND
    },
    Case {
        name: "a reference of an absurd size",
        edit: (
            "[[method]]\nid = \"tet4\"",
            "[reference]\nmethod = \"tet4\"\nsize = { spacing = \"1 um\" } #<\n\n[[method]]\nid = \"tet4\"",
        ),
        key: "reference.size.spacing",
        says: &["'1 um' gives 20000 cells"],
        ..SOUND
    },
];
