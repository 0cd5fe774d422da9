//! Contradictions between the parts of a scene.

use tissuebench_cases::scene::parse;

use crate::SCENE;
use crate::good::{JAW, still};

/// The static scene with a jaw.
fn grasped() -> String {
    still().replacen("[procedure]\n", &format!("{JAW}[procedure]\n"), 1)
}

/// Checks that each edit (from, to) is refused at its key with the given words.
fn refused(sound: &str, edits: &[[&str; 4]]) {
    for [from, to, key, said] in edits {
        assert!(sound.contains(from), "{from}");
        let errors = parse(&sound.replacen(from, to, 1), "s.toml").expect_err(to);
        let found = errors.iter().find(|e| e.key == *key).unwrap_or_else(|| panic!("{key}: {errors:?}"));
        assert!(found.to_string().contains(said), "{found}");
    }
}

#[test]
fn contradictions_of_a_static_scene_name_their_key() {
    let tet4 = "dilation = \"nodal-mean\"";
    let edits = [
        ["penalty = \"0.5 MPa/mm\"\n", "", "tool[0].penalty", "is missing; add a pressure per length"],
        [
            "penalty = \"0.5 MPa/mm\"",
            "penalty = \"0.5 MPa\"",
            "tool[0].penalty",
            "is a pressure, where a pressure per length",
        ],
        ["penalty = \"0.5 MPa/mm\"", "penalty = 5e8", "tool[0].penalty", "has no unit"],
        ["stick = \"100 N/mm^3\"\n", "", "tool[0].stick", "is missing; friction needs"],
        ["friction = 0.15\n", "", "tool[0].stick", "goes with friction only"],
        [
            "essential = \"penalty\"",
            "essential = \"nitsche\"",
            "method[2].essential",
            "'nitsche' is available for linear procedures and modes, not for kind = \"static\"; take \"penalty\" or \"coupling\"",
        ],
        [
            "essential = \"penalty\"",
            "essential = \"multipliers\"",
            "method[2].essential",
            "'multipliers' is available for linear procedures",
        ],
        [
            "essential = { method = \"penalty\", factor = 1e4 }",
            "essential = { method = \"nitsche\", factor = 10 }",
            "method[1].essential.method",
            "'nitsche' is available for linear procedures",
        ],
        [
            "essential = \"penalty\"",
            "essential = \"elimination\"",
            "method[2].essential",
            "'elimination' is available for linear procedures",
        ],
        ["friction = 0.15", "friction = -1", "tool[0].friction", "is negative"],
        [
            "friction = 0.15",
            "friction = 0.15\naxis = [0, 0, 1]",
            "tool[0].axis",
            "does not belong to shape = \"rounded-box\"; leave it out; it goes with plate, cylinder, capsule",
        ],
        ["[0, 0, -2]", "[0, 0, 0]", "tool[0].along", "has no direction"],
        ["closure = \"7 mm\" }", "force = \"-1 N\" }", "tool[0].drive.force", "is not positive"],
        [
            "closure = \"7 mm\" }",
            "closure = \"7 mm\", over = \"1 s\" }",
            "tool[0].drive.over",
            "is the time of a ramp",
        ],
        [
            "[0, 0, -2]\ndrive = { closure = \"7 mm\" }",
            "[0, 1, -2]\ndrive = { pressure = \"1 kPa\" }",
            "tool[0].drive.pressure",
            "has no face to act on",
        ],
        [
            "kind = \"static\"",
            "kind = \"linear\"",
            "tool[0]",
            "'upper jaw' touches the body, but the procedure is linear",
        ],
        [
            tet4,
            "dilation = \"mixed\"",
            "method[0].dilation",
            "'mixed' has no stable pressure field with tet4",
        ],
        [
            "element = \"tet4\"",
            "element = \"tet10\"",
            "method[0].dilation",
            "'nodal-mean' averages over a negative volume at the corners of tet10",
        ],
        [
            "element = \"tet4\"",
            "element = \"hex20\"",
            "method[0].dilation",
            "take \"element-mean\" or \"nodal-near\" with hex20, or \"nodal-mean\" with tet4 or hex8",
        ],
        ["steps = 10", "steps = 10\ntolerance = 1", "procedure.tolerance", "is no tolerance"],
        [
            "kind = \"static\"",
            "kind = \"prepare\"",
            "reference",
            "is of a displacement, and kind = \"prepare\" solves for none",
        ],
    ];
    refused(&grasped(), &edits);
}

#[test]
fn settings_that_a_static_procedure_cannot_have_are_refused() {
    let edits = [
        ["steps = 10", "steps = 10\nlimit_within = 2", "procedure.limit_within", "is no part of the load"],
        ["steps = 10", "steps = 10\niterations = 0", "procedure.iterations", "is zero"],
        ["steps = 10", "steps = 10\niterations = 4000000000", "procedure.iterations", "are too many"],
        ["steps = 10", "steps = 10\naugmentations = 4000000000", "procedure.augmentations", "are too many"],
        [
            "steps = 10",
            "steps = 10\nduration = \"1 s\"",
            "procedure.duration",
            "it goes with explicit, implicit-dynamic",
        ],
        [
            "steps = 10",
            "steps = 10\nover = \"1 s\"",
            "procedure.over",
            "does not belong to kind = \"static\"",
        ],
    ];
    refused(&grasped(), &edits);
}

#[test]
fn contradictions_of_a_material_name_their_key() {
    let edits = [
        [
            "poisson = 0.45\n",
            "poisson = 0.45\nprony = [{ g = 0.3, tau = \"1 s\" }]\n",
            "material.prony",
            "relaxes over time, but a static procedure has no time",
        ],
        [
            "poisson = 0.45\n",
            "poisson = 0.45\nprony = [{ g = 1.3, tau = \"1 s\" }]\n",
            "material.prony",
            "relaxes everything",
        ],
        [
            "law = \"linear\"\nyoung = \"20 kPa\"\npoisson = 0.45",
            "law = \"ogden\"\nmu = [\"1 kPa\"]\nalpha = [-2]\nbulk = \"1 MPa\"",
            "material.mu",
            "does not give a positive shear modulus",
        ],
        [
            "law = \"linear\"\nyoung = \"20 kPa\"\npoisson = 0.45",
            "law = \"mooney-rivlin\"\nyoung = \"20 kPa\"\npoisson = 0.45",
            "material.law",
            "does not have the constants of this law",
        ],
        [
            "poisson = 0.45\n",
            "poisson = 0.45\nc10 = \"1 kPa\"\n",
            "material.c10",
            "it goes with mooney-rivlin",
        ],
    ];
    refused(&still(), &edits);
    let large = SCENE.replacen("law = \"linear\"", "law = \"hencky\"", 1);
    let errors = parse(&large, "s.toml").expect_err("linear");
    assert!(errors.len() == 1 && errors[0].key == "material.law", "{errors:?}");
    assert!(errors[0].to_string().contains("'hencky' is a law of large strain, but the procedure is linear"));
}

#[test]
fn what_moves_needs_time() {
    let start = SCENE.find("[reference]").expect("there");
    let checks = "[[check]]\nmetric = \"history-error\"\nat_most = 0.01\n[[check]]\nmetric = \"period\"\nat_most = \"1 s\"\n";
    let wave = "[reference]\nexact = \"bar-wave\"\npull = \"1 kPa\"\nlength = \"40 mm\"\ndensity = \"1000 kg/m^3\"\n";
    let regional = "poisson = 0.3 }";
    let text = format!("{}{wave}{checks}", &SCENE[..start])
        .replacen(regional, "poisson = 0.3, density = \"1000 kg/m^3\" }", 1)
        .replacen("kind = \"linear\"", "kind = \"explicit\"\nduration = \"1 s\"\nover = \"0.1 s\"", 1);
    let scene = parse(&text, "s.toml").unwrap();
    assert_eq!(scene.procedure.ramp().unwrap().over, Some(0.1));
    let at_once = "over = \"0 s\"";
    for (from, to, key, said) in [
        ("over = \"0.1 s\"", at_once, "procedure.over", "leaves no time for the motion of support[1]"),
        ("over = \"0.1 s\"", "over = \"-1 s\"", "procedure.over", "is negative"),
        (
            "kind = \"explicit\"\nduration = \"1 s\"\nover = \"0.1 s\"",
            "kind = \"static\"",
            "reference.exact",
            "'bar-wave' depends on time, but a static procedure has no time",
        ),
        (wave, "", "check[0].metric", "'history-error' needs output.probes and dynamics"),
    ] {
        assert!(text.contains(from), "{from}");
        let errors = parse(&text.replacen(from, to, 1), "s.toml").expect_err(to);
        let found = errors.iter().find(|e| e.key == key).unwrap_or_else(|| panic!("{key}: {errors:?}"));
        assert!(found.to_string().contains(said), "{found}");
    }
    let held =
        text.replacen("move = { x = \"exact\", z = { unit = \"mm\", of = \"-x^2\" } }", "fix = \"x\"", 1);
    assert!(parse(&held.replacen("over = \"0.1 s\"", at_once, 1), "s.toml").is_ok());
}
