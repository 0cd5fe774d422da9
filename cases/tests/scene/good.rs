use geometry::CellKind;
use tissuebench_cases::scene::*;

use crate::{SCENE, edited};

fn scene() -> Scene {
    parse(SCENE, "cases/block.toml").unwrap_or_else(|errors| panic!("{}", errors[0]))
}

#[test]
fn a_scene_arrives_in_si() {
    let scene = scene();
    assert_eq!(scene.body, Body::Box { min: [-0.02, -0.02, 0.0], max: [0.02, 0.02, 0.02] });
    let material::Law::LinearElastic(law) = scene.material.law() else { panic!("linear") };
    assert_eq!((law.young(), law.poisson(), scene.material.density), (2e4, 0.45, Some(1000.0)));
    assert_eq!(scene.regions[0].material.constant("young"), Some(4e4));
    assert_eq!(scene.output.probes, [[0.0, 0.0, 0.005]]);
    assert_eq!(scene.procedure, Procedure::Linear { solver: LinearSolver::Auto });
    assert_eq!(scene.checks[0].bound, Bound::Within { at_least: None, at_most: Some(1e-4) });
    assert_eq!(scene.checks[0].methods, ["tet4", "efg-83"]);
    let Bound::KnownBand { low, high, reason } = &scene.checks[1].bound else { panic!("a band") };
    assert_eq!((*low, *high, reason.as_str()), (1e-4, 1e-2, "inconsistent integration"));
    let Some(Reference::Exact { entry, values }) = &scene.reference else { panic!("exact") };
    assert_eq!((entry.name, values.get("curvature")), ("pure-bending", Some(0.5)));
    assert!(scene.unavailable().is_empty());
}

#[test]
fn methods_keep_every_setting() {
    let scene = scene();
    let Family::Fem(fem) = &scene.methods[0].family else { panic!("fem") };
    assert_eq!(fem.size, Size::Cells { cells: [4, 4, 2], grading: [1.0, 1.0, 2.0] });
    assert_eq!((fem.element, fem.dilation), (CellKind::Tet4.into(), Dilation::NodalMean));
    assert_eq!(fem.jitter, Some(Jitter { fraction: 0.2, seed: 7 }));
    let Family::Efg(efg) = &scene.methods[1].family else { panic!("efg") };
    assert_eq!(efg.cloud, Cloud::Uniform { nodes: 83, seed: 1 });
    let Functions::MovingLeastSquares { kernel, support, .. } = efg.functions else { panic!("a kernel") };
    assert_eq!(Some(kernel), efg::Kernel::from_name("gaussian"));
    assert_eq!(support, SupportRule::Scale(1.6));
    assert_eq!(efg.essential, Essential::Nitsche { factor: Some(10.0) });
    assert_eq!(efg.background, Some(Size::Spacing(0.005)));
    let Family::Efg(efg) = &scene.methods[2].family else { panic!("efg") };
    assert_eq!(efg.cloud, Cloud::Mesh { size: Size::Level(2), jitter: None });
    let Functions::MovingLeastSquares { support, .. } = efg.functions else { panic!("a kernel") };
    assert_eq!(support, SupportRule::Neighbours { k: 15, factor: 1.2 });
    assert_eq!(efg.integration, Integration::CellSmoothed { order: 1, face_points: 1 });
}

#[test]
fn maximum_entropy_takes_a_locality_and_nothing_else() {
    for (given, gamma) in [("", 1.8), ("\ngamma = 0.8", 0.8)] {
        let kernel = "kernel = \"cubic-spline\"\nneighbours = 15\nfactor = 1.2\nbasis = \"linear\"";
        let text = edited(kernel, &format!("basis = \"maximum-entropy\"{given}"));
        let Family::Efg(efg) = &parse(&text, "block.toml").unwrap().methods[2].family else { panic!("efg") };
        assert_eq!(
            (efg.functions, efg.functions.basis()),
            (Functions::MaximumEntropy { gamma }, "maximum-entropy")
        );
    }
    let text = edited("essential = \"multipliers\"", "essential = \"elimination\"");
    let Family::Efg(efg) = &parse(&text, "block.toml").unwrap().methods[2].family else { panic!("efg") };
    assert_eq!(efg.essential, Essential::Elimination { rows: ConstraintRows::Means });
}

#[test]
fn smoothing_takes_its_points_and_its_share() {
    for (rule, read) in [
        ("\"cell-smoothed\", order = 2", Integration::CellSmoothed { order: 2, face_points: 6 }),
        (
            "\"node-smoothed\", stabilisation = 0",
            Integration::NodeSmoothed { stabilisation: 0.0, face_points: 1 },
        ),
        (
            "\"node-smoothed\", stabilisation = 0.05, points = 3",
            Integration::NodeSmoothed { stabilisation: 0.05, face_points: 3 },
        ),
    ] {
        let scene =
            parse(&edited("\"cell-smoothed\"", rule), "s.toml").unwrap_or_else(|e| panic!("{}", e[0]));
        let Family::Efg(efg) = &scene.methods[2].family else { panic!("efg") };
        assert_eq!(efg.integration, read);
    }
}

#[test]
fn conditions_are_fields_over_space() {
    let scene = scene();
    let x = [0.01, 0.0, 0.02];
    let LoadKind::Pressure(pressure) = &scene.loads[0].kind else { panic!("pressure") };
    assert!((pressure.value(x).expect("finite") - 4e-4).abs() < 1e-18);
    let LoadKind::Traction(VectorField::Components(traction)) = &scene.loads[1].kind else {
        panic!("traction")
    };
    assert_eq!(traction[1].value(x), Ok(1000.0));
    assert_eq!(traction[2].value(x), Ok(10.0));
    let LoadKind::Body(VectorField::Components(body)) = &scene.loads[2].kind else { panic!("body") };
    assert_eq!(body[2].value(x), Ok(-9810.0));
    let [Some(Prescribed::Exact), None, Some(Prescribed::Field(z))] = &scene.supports[1].motion else {
        panic!("x exact, y free, z given")
    };
    assert!((z.value(x).expect("finite") + 1e-7).abs() < 1e-20, "-x^2 mm at x = 0.01 m");
}

#[test]
fn a_region_takes_its_tolerance_from_the_caller() {
    let scene = scene();
    let Place::Where(floor) = &scene.supports[0].place else { panic!("a region") };
    assert!(floor.contains([0.0, 0.0, 1e-12], 1e-10) && !floor.contains([0.0, 0.0, 1e-9], 1e-10));
    let Place::Where(core) = &scene.regions[0].place else { panic!("a region") };
    assert!(core.contains([0.005, 1.0, 1.0], 1e-10) && !core.contains([0.0051, 0.0, 0.0], 1e-10));
    let open = edited("z == 0 mm", "z > 0 mm and z < 1 mm");
    let scene = parse(&open, "s.toml").expect("sound");
    let Place::Where(slab) = &scene.supports[0].place else { panic!("a region") };
    assert!(slab.contains([0.0, 0.0, 5e-4], 1e-10));
    assert!(!slab.contains([0.0; 3], 1e-10) && !slab.contains([0.0, 0.0, 1e-3], 1e-10));
}

/// The scene in a static procedure, with essential conditions that this supports.
fn still() -> String {
    let text =
        SCENE.replace("kind = \"linear\"", "kind = \"static\"").replace("\"multipliers\"", "\"penalty\"");
    text.replace("{ method = \"nitsche\", factor = 10 }", "{ method = \"penalty\", factor = 1e4 }")
}

const JAW: &str = "[[tool]]\nname = \"upper jaw\"\nshape = \"rounded-box\"\nhalf = [\"5 mm\", \"10 mm\", \"4 mm\"]\n\
    radius = \"1.5 mm\"\nat = [\"0 mm\", \"0 mm\", \"19 mm\"]\nalong = [0, 0, -2]\n\
    drive = { closure = \"7 mm\" }\npenalty = \"0.5 MPa/mm\"\nfriction = 0.15\nstick = \"100 N/mm^3\"\n";

#[test]
fn what_moves_a_body_is_known() {
    let still = without_sections(SCENE, &["[[load]]", "[[check]]", "[reference]", "[output]"])
        .replace("move = { x = \"exact\", z = { unit = \"mm\", of = \"-x^2\" } }", "fix = \"x\"");
    let moved = |text: &str| parse(text, "s.toml").unwrap_or_else(|e| panic!("{}", e[0])).is_moved();
    assert!(moved(SCENE) && !moved(&still));
    assert!(!moved(&still.replace("fix = \"x\"\n", "move = { x = \"0 mm\" }\n")));
    assert!(moved(&still.replace("fix = \"x\"\n", "move = { x = \"1 mm\" }\n")));
    // Nothing is solved, so nothing has to move.
    assert!(moved(&still.replace("kind = \"linear\"", "kind = \"prepare\"")));
}

/// A scene without the tables under the given heads.
fn without_sections(text: &str, heads: &[&str]) -> String {
    let mut kept = true;
    let lines = text.lines().filter(|line| {
        if line.starts_with('[') {
            kept = !heads.contains(line);
        }
        kept
    });
    lines.map(|line| format!("{line}\n")).collect()
}

#[test]
fn a_support_can_be_moved_by_a_list() {
    let motion = |given: &str| {
        let text = edited("move = { x = \"exact\", z = { unit = \"mm\", of = \"-x^2\" } }", given);
        let scene = parse(&text, "s.toml").unwrap_or_else(|e| panic!("{}", e[0]));
        format!("{:?}", scene.supports[1].motion)
    };
    let by_axes = motion("move = { x = \"exact\", y = \"0 mm\", z = \"6 mm\" }");
    assert_eq!(motion("move = [\"exact\", \"0 mm\", \"6 mm\"]"), by_axes);
}

#[test]
fn clouds_coupled_to_finite_elements_go_with_every_procedure_that_clouds_do() {
    let coupled = edited("\"multipliers\"", "\"coupling\"");
    let Family::Efg(efg) = &parse(&coupled, "s.toml").expect("sound").methods[2].family else {
        panic!("efg")
    };
    assert_eq!(efg.essential, Essential::Coupling);
    for text in [coupled, still().replacen("essential = \"penalty\"", "essential = \"coupling\"", 1)] {
        assert!(parse(&text, "s.toml").unwrap_or_else(|e| panic!("{}", e[0])).unavailable().is_empty());
    }
}

#[test]
fn a_static_scene_runs_with_everything_it_knows() {
    let text = still().replacen("[procedure]\n", &format!("{JAW}[procedure]\n"), 1);
    let scene = parse(&text, "s.toml").unwrap_or_else(|e| panic!("{}", e[0]));
    assert!(scene.unavailable().is_empty());
    let tool = &scene.tools[0];
    assert_eq!((tool.along, tool.axis, tool.drive), ([0.0, 0.0, -1.0], None, Drive::Closure(0.007)));
    assert_eq!(tool.penalty, 5e8);
    assert_eq!(tool.friction, Some(Friction { coefficient: 0.15, stick: 1e11 }));
    assert!((tool.shape.face_area(&tool.along.into()).unwrap() - 2e-4).abs() < 1e-18);
    let slanted = text.replace("[0, 0, -2]", "[0, 1, -2]");
    let tool = &parse(&slanted, "s.toml").expect("sound").tools[0];
    assert_eq!(tool.shape.face_area(&tool.along.into()), None);
    // By default a plate faces its direction of motion, and a roller lies along z.
    let plate = |more: &str| {
        let jaw = format!(
            "[[tool]]\nname = \"p\"\nshape = \"plate\"\nat = [\"0 mm\", \"0 mm\", \"19 mm\"]\nalong = [0, 0, -2]\n\
            drive = {{ closure = \"7 mm\" }}\npenalty = \"1 kPa/mm\"\n{more}\n[procedure]\n"
        );
        parse(&still().replacen("[procedure]\n", &jaw, 1), "s.toml").expect("sound").tools[0].clone()
    };
    assert_eq!((plate("").axis, plate("").friction), (Some([0.0, 0.0, -1.0]), None));
    assert_eq!(plate("axis = [0, 3, 0]").axis, Some([0.0, 1.0, 0.0]));
    let steps =
        still().replace("steps = 10", "steps = 5\ntolerance = 1e-6\niterations = 12\naugmentations = 2");
    let newton = Newton { tolerance: 1e-6, iterations: 12, augmentations: 2 };
    let procedure = parse(&steps, "s.toml").expect("sound").procedure;
    let limit_within = None;
    let on_stall = OnStall::Stop;
    assert_eq!(procedure, Procedure::Static(Static { steps: 5, newton, limit_within, on_stall }));
}

#[test]
fn only_a_motion_needs_time() {
    let start = SCENE.find("[reference]").expect("there");
    let dense = ("poisson = 0.3 }", "poisson = 0.3, density = \"1000 kg/m^3\" }");
    let wave = "[reference]\nexact = \"bar-wave\"\npull = \"1 kPa\"\nlength = \"40 mm\"\ndensity = \"1000 kg/m^3\"\n\
                [[check]]\nmetric = \"history-error\"\nat_most = 0.01\n[[check]]\nmetric = \"period\"\nat_most = \"1 s\"\n";
    let text = format!("{}{wave}", &SCENE[..start]).replacen(dense.0, dense.1, 1).replacen(
        "kind = \"linear\"",
        "kind = \"explicit\"\nduration = \"1 s\"\nover = \"0.1 s\"",
        1,
    );
    assert_eq!(parse(&text, "s.toml").unwrap().procedure.ramp().unwrap().over, Some(0.1));
    let held =
        text.replacen("move = { x = \"exact\", z = { unit = \"mm\", of = \"-x^2\" } }", "fix = \"x\"", 1);
    assert!(parse(&held.replacen("over = \"0.1 s\"", "over = \"0 s\"", 1), "s.toml").is_ok());
}

#[test]
fn modes_and_masses_are_read() {
    let text = without_sections(
        &still(),
        &["[[load]]", "[[check]]", "[reference]", "[output]", "[procedure]", "[[method]]"],
    )
    .replace("move = { x = \"exact\", z = { unit = \"mm\", of = \"-x^2\" } }", "fix = \"x\"")
    .replace("poisson = 0.3 }", "poisson = 0.3, density = \"1000 kg/m^3\" }");
    let tet4 = "id = \"tet4\"\nfamily = \"fem\"\nelement = \"tet4\"\nsize = { level = 1 }\nmass = \"lumped\"";
    let text = format!("{text}[procedure]\nkind = \"modes\"\nmodes = 12\n[[method]]\n{tet4}\n");
    let scene = parse(&text, "s.toml").unwrap_or_else(|e| panic!("{}", e[0]));
    assert_eq!(scene.procedure, Procedure::Modes { count: 12 });
    assert_eq!(scene.methods[0].mass, Some(Mass::Lumped));
    assert!(scene.unavailable().is_empty());
}

#[test]
fn an_error_found_while_running_names_its_line() {
    let error =
        scene().error(ErrorKind::Invalid, "support[0].where", "holds no node", Some("check the unit"));
    let line = 1 + SCENE[..SCENE.find("where = \"z").expect("there")].matches('\n').count();
    let said =
        format!("cases/block.toml:{line}: key 'support[0].where': 'z == 0 mm' holds no node; check the unit");
    assert_eq!(error.to_string(), said);
}

#[test]
fn all_shapes_and_laws_are_read() {
    let body = &SCENE[SCENE.find("[body]").expect("body")..SCENE.find("[material]").expect("material")];
    for shape in [
        "shape = \"cylinder\"\nradius = \"10 mm\"\nheight = \"10 mm\"",
        "shape = \"ball\"\nradius = \"10 mm\"",
        "shape = \"sphere-shell\"\ninner = \"1 cm\"\nouter = \"2 cm\"\noctant = true",
        "shape = \"kidney\"",
        "shape = \"kidney\"\nhalf = true\nmildly_graded = true",
        "shape = \"box\"\nsize = [\"1 mm\", \"1 mm\", \"1 mm\"]",
    ] {
        // These shapes have no surfaces with the names of a box.
        let text =
            edited(body, &format!("[body]\n{shape}\n")).replace("[\"x-min\", \"x-max\"]", "\"surface\"");
        let text = text.replace("\"z-max\"", "\"surface\"").replace("\"y-max\"", "\"surface\"");
        let scene = parse(&text, "s.toml").unwrap_or_else(|e| panic!("{}", e[0]));
        assert!(shape.contains(&format!("\"{}\"", scene.body.name())));
    }
    for law in [
        "law = \"saint-venant-kirchhoff\"\nyoung = \"1 kPa\"\npoisson = 0.3",
        "law = \"neo-hookean-isochoric\"\nyoung = \"1 kPa\"\npoisson = 0.3",
        "law = \"mooney-rivlin\"\nyoung = \"1 kPa\"\npoisson = 0.3\nshare = 0.2",
        "law = \"mooney-rivlin\"\nc10 = \"1 kPa\"\nc01 = \"1 kPa\"\nbulk = \"1 MPa\"",
        "law = \"ogden\"\nmu = [\"2 kPa\", \"1 kPa\"]\nalpha = [2, -2]\nbulk = \"1 MPa\"",
    ] {
        let text = still().replace("law = \"linear\"\nyoung = \"20 kPa\"\npoisson = 0.45", law);
        let scene = parse(&text, "s.toml").unwrap_or_else(|e| panic!("{}", e[0]));
        assert!(law.contains(&format!("\"{}\"", scene.material.name())));
    }
}

#[test]
fn the_schema_knows_every_key_of_the_outline() {
    let schema = schema();
    let methods = schema["properties"]["method"]["items"]["oneOf"].as_array().expect("kinds of methods");
    assert!(methods.len() == 4 && methods[3]["properties"]["use"]["type"] == "string");
    let keys = schema["properties"].as_object().expect("an object");
    for key in [
        "title",
        "source",
        "methods_from",
        "body",
        "material",
        "region",
        "support",
        "load",
        "tool",
        "procedure",
        "method",
        "output",
        "reference",
        "check",
    ] {
        assert!(keys.contains_key(key), "{key}");
    }
    assert_eq!(schema["additionalProperties"], false);
    assert!(study_schema()["properties"]["run"].is_object());
}
