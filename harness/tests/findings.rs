//! What only a run can find: every finding names file, line, key and what would be right, and costs no other method.

mod common;

use common::{Done, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

const SCENE: &str = r#"title = "A block"

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

/// Two tetrahedra on a common face, a named roof; millimetres.
const MESH: &str = r#"$MeshFormat
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

/// A sound scene made unsound.
struct Case {
    name: &'static str,
    /// Done first, to get at what is to be spoilt.
    base: &'static [(&'static str, &'static str)],
    /// Replaced in the scene; the line to be blamed ends in `#<`.
    edit: (&'static str, &'static str),
    /// Replaced in the mesh file.
    mesh: (&'static str, &'static str),
    code: i32,
    key: &'static str,
    says: &'static [&'static str],
    /// Methods that can't run; the others must.
    stops: &'static [&'static str],
}

const SOUND: Case = Case {
    name: "",
    base: &[],
    edit: ("", ""),
    mesh: ("", ""),
    code: 2,
    key: "",
    says: &[],
    stops: &["tet4", "efg"],
};

const CASES: &[Case] = &[
    Case {
        name: "a support beside the body",
        edit: ("where = \"z == 0 mm\"", "where = \"z == 90 mm\" #<"),
        key: "support[0].where",
        says: &[
            "'z == 90 mm' touches nothing",
            "x = 0 to 40, y = 0 to 40, z = 0 to 20 mm",
            "signs and the unit",
        ],
        ..SOUND
    },
    Case {
        name: "a load beside the body, its region off by the unit",
        edit: ("on = \"z-max\"", "where = \"z >= 20 m\" #<"),
        key: "load[0].where",
        says: &["'z >= 20 m' touches nothing", "z = 0 to 20 mm"],
        ..SOUND
    },
    Case {
        name: "the second of two supports",
        edit: ("[[load]]", "[[support]]\nwhere = \"x < 0 mm\" #<\nfix = \"x\"\n\n[[load]]"),
        key: "support[1].where",
        says: &["'x < 0 mm' touches nothing"],
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
        says: &["'z >= 30 mm' holds no cell", "z = 0 to 20 mm"],
        ..SOUND
    },
    Case {
        name: "a cloud denser nowhere",
        edit: ("nodes = 60", "nodes = 60\ncloud = \"graded\"\ngraded_towards = \"z >= 30 mm\" #<"),
        key: "method[1].graded_towards",
        says: &["'z >= 30 mm' holds nowhere", "unit"],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "no support",
        base: &[("[[support]]\nwhere = \"z == 0 mm\"\nfix = \"xyz\"\n", "")],
        edit: ("[body]", "[body] #<"),
        code: 3,
        key: "body",
        says: &["held by no [[support]]", "translation along x", "rotation about z", "fix = \"xyz\""],
        ..SOUND
    },
    Case {
        name: "a support that lets slide",
        edit: ("fix = \"xyz\"", "fix = \"z\" #<"),
        code: 3,
        key: "support[0].fix",
        says: &["'z' does not hold", "translation along x, translation along y, rotation about z"],
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
        says: &["all 2 together (lines 12, 16)", "translation along y"],
        ..SOUND
    },
    Case {
        name: "supports that contradict each other",
        edit: (
            "[[support]]\nwhere = \"z == 0 mm\"\nfix = \"xyz\"",
            "[[support]] #<\nwhere = \"z == 0 mm\"\nfix = \"xyz\"\n\n[[support]]\nwhere = \"x == 0 mm\"\nmove = { x = \"1 mm\" }",
        ),
        key: "support",
        says: &["fixed along axis 0 at", "values agree"],
        stops: &["tet4"],
        ..SOUND
    },
    Case {
        name: "supports of a cloud too narrow",
        // Nodes on two faces 40 mm apart, 5 mm from each other.
        base: &[("nodes = 60", "size = { cells = [1, 8, 8] }")],
        edit: ("support_scale = 1.6", "support_scale = 1.2 #<"),
        code: 3,
        key: "method[1].support_scale",
        says: &["'1.2'", "neighbours", "wider"],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "neighbours of a cloud too near",
        base: &[("nodes = 60", "size = { cells = [1, 8, 8] }")],
        edit: ("support_scale = 1.6", "neighbours = 4 #<"),
        code: 3,
        key: "method[1].neighbours",
        says: &["'4'", "neighbours", "wider"],
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
        says: &["'1 um' makes 20000 cells", "1000"],
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
        says: &["two.msh:15: ", "Gmsh 2.2"],
        ..SOUND
    },
    Case {
        name: "a surface that the mesh file does not name",
        base: OF_FILE,
        edit: ("on = \"roof\"", "on = \"bottom\" #<"),
        key: "load[0].on",
        says: &["'bottom'", "it has surface, roof"],
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
        says: &["'tumor' holds no cell", "the mesh has tissue"],
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
        says: &["'two.msh' gives a mesh in which element 0 is inverted: det J = -3.2", "order"],
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
        says: &["holds tet4 cells, not hex8", "mesh convert"],
        stops: &["tet4"],
        ..SOUND
    },
    Case {
        name: "a grid clipped by a mesh file",
        base: OF_FILE,
        edit: (
            "integration = { rule = \"gauss\", points = 4 }",
            "integration = { rule = \"grid\", points = 8 } #<",
        ),
        code: 3,
        key: "method[1].integration.rule",
        says: &["'grid' clips a grid", "\"gauss\" or \"cell-smoothed\""],
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
        says: &["'grid' does not know the region"],
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
        says: &["'element-mean' wants points that go by background cells", "\"nodal-mean\""],
        stops: &["efg"],
        ..SOUND
    },
    Case {
        name: "a cloud of an exact count in a mesh file",
        base: &[OF_FILE[0], OF_FILE[1], OF_FILE[3]],
        edit: ("nodes = 60", "nodes = 60 #<"),
        code: 3,
        key: "method[1].nodes",
        says: &["'60' makes a cloud of an exact count", "the nodes of a mesh"],
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
        says: &["'two.msh' can't be read", "two.msh:14: ", "Gmsh 2.2"],
        ..SOUND
    },
    Case {
        name: "a reference of an absurd size",
        edit: (
            "[[method]]\nid = \"tet4\"",
            "[reference]\nmethod = \"tet4\"\nsize = { spacing = \"1 um\" } #<\n\n[[method]]\nid = \"tet4\"",
        ),
        key: "reference.size.spacing",
        says: &["'1 um' makes 20000 cells"],
        ..SOUND
    },
];

fn replaced(text: &str, (from, to): (&str, &str), name: &str) -> String {
    let new = text.replacen(from, to, 1);
    assert!(from.is_empty() || new != text, "{name}: '{from}' is not in the scene");
    new
}

/// Writes the case; the scene's path and the line to be blamed.
fn written(case: &Case, dir: &TempDir) -> (String, usize) {
    let base = case.base.iter().fold(SCENE.to_string(), |text, edit| replaced(&text, *edit, case.name));
    let text = replaced(&base, case.edit, case.name);
    write(dir, "two.msh", &replaced(MESH, case.mesh, case.name));
    let line = 1 + text.lines().position(|l| l.ends_with("#<")).expect(case.name);
    (write(dir, "scene.toml", &text), line)
}

fn json(done: &Done) -> Vec<Value> {
    done.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn a_finding_names_file_line_and_key_and_stops_only_its_method() {
    for case in CASES {
        let dir = tempfile::tempdir().unwrap();
        let (path, line) = written(case, &dir);
        let done = tissuebench(&["run", &path, "--format", "json"]);
        let name = case.name;
        assert_eq!(done.code, case.code, "{name}: {}", done.stderr);
        let place = format!("{path}:{line}: key '{}':", case.key);
        let blamed: Vec<&str> = done.stderr.lines().filter(|l| l.starts_with(&place)).collect();
        assert!(!blamed.is_empty(), "{name}: no '{place}' in {}", done.stderr);
        for text in case.says {
            assert!(blamed[0].contains(text), "{name}: no '{text}' in {}", blamed[0]);
        }
        // What was found before anything could be planned leaves no objects.
        for object in json(&done) {
            let method = object["method"].as_str().unwrap();
            if case.stops.contains(&method) {
                let status = if case.code == 2 { "bad-input" } else { "could-not-run not-available" };
                assert!(status.contains(object["status"].as_str().unwrap()), "{name}: {}", object["status"]);
                let message = object["message"].as_str().unwrap();
                assert!(message.starts_with(path.as_str()), "{name}: {message}");
            } else {
                assert_eq!(object["status"], "ok", "{name} {method}: {}", done.stderr);
                assert!(object["metrics"]["max-z"]["value"].as_f64().unwrap() > 0.0, "{name}");
            }
        }
        assert_eq!(json(&done).len(), 2, "{name}");
    }
}

#[test]
fn a_plan_finds_empty_places_as_a_run_does() {
    let mut found = 0;
    for case in CASES.iter().filter(|c| c.code == 2 && (c.key.ends_with(".where") || c.key.ends_with(".on")))
    {
        let dir = tempfile::tempdir().unwrap();
        let (path, _) = written(case, &dir);
        let (run, plan) = (tissuebench(&["run", &path]), tissuebench(&["plan", &path]));
        assert_eq!((plan.code, &plan.stderr), (2, &run.stderr), "{}", case.name);
        assert!(plan.stdout.is_empty(), "{}: {}", case.name, plan.stdout);
        found += 1;
    }
    assert_eq!(found, 6);
}

const SECOND_ORDER: &str = "{ rule = \"cell-smoothed\", order = 2 }\nbackground = { cells = [4, 4, 4] }";
const NODAL: &str = "{ rule = \"node-smoothed\", stabilisation = 0 }\nbackground = { cells = [4, 4, 4] }";
const STABILISED: &str =
    "{ rule = \"node-smoothed\", stabilisation = 0.05 }\nbackground = { cells = [4, 4, 4] }";

#[test]
fn a_plan_holds_a_cloud_wherever_a_run_holds_it() {
    // No facet lies in a slab inside the body: points of the volume do, or nodes where multipliers hold those.
    for (essential, integration, place, code) in [
        ("nitsche", "{ rule = \"gauss\", points = 4 }", "z >= 5 mm and z <= 12 mm", 0),
        ("penalty", "{ rule = \"cell-smoothed\", points = 1 }", "z >= 5 mm and z <= 12 mm", 0),
        ("penalty", "{ rule = \"grid\", points = 8 }", "z >= 5 mm and z <= 12 mm", 0),
        // One of a cell's four points, but not its centroid.
        ("penalty", SECOND_ORDER, "z >= 2.75 mm and z <= 3 mm", 0),
        // Vertices at z = 0, 5, .. 20 mm; points of the cells between only where those have a share.
        ("penalty", NODAL, "z >= 9.5 mm and z <= 10.5 mm", 0),
        ("penalty", NODAL, "z >= 1 mm and z <= 4 mm", 2),
        ("penalty", STABILISED, "z >= 1 mm and z <= 4 mm", 0),
        ("nitsche", "{ rule = \"gauss\", points = 4 }", "z > 9.999 mm and z < 9.9991 mm", 2),
        ("multipliers", "{ rule = \"gauss\", points = 4 }", "z > 9.999 mm and z < 9.9991 mm", 2),
    ] {
        let dir = tempfile::tempdir().unwrap();
        let text = SCENE
            .replace("\"nitsche\"", &format!("\"{essential}\""))
            .replace("{ rule = \"gauss\", points = 4 }", integration)
            .replace("z == 0 mm", place);
        let path = write(&dir, "scene.toml", &text);
        for command in ["plan", "run"] {
            let done = tissuebench(&[command, &path, "--method", "efg"]);
            assert_eq!(done.code, code, "{command} {essential} {integration} {place}: {}", done.stderr);
        }
    }
}

#[test]
fn a_failed_run_still_says_what_it_would_have_done() {
    let dir = tempfile::tempdir().unwrap();
    let path = write(&dir, "free.toml", &SCENE.replace("\"xyz\"", "\"z\""));
    let objects = json(&tissuebench(&["run", &path, "--format", "json"]));
    // 3 x 3 x 3 nodes and 2 x 2 x 2 boxes of six.
    assert_eq!((&objects[0]["nodes"], &objects[0]["elements"]), (&27.into(), &48.into()));
    assert_eq!(objects[1]["nodes"], 60);
    for object in &objects {
        assert_eq!(object["status"], "could-not-run");
        let stages: Vec<&str> =
            object["plan"].as_array().unwrap().iter().map(|s| s["stage"].as_str().unwrap()).collect();
        assert!(stages.contains(&"factorisation") && stages.contains(&"contact search"), "{stages:?}");
        assert_eq!(object["metrics"], Value::Object(serde_json::Map::new()));
    }
}
