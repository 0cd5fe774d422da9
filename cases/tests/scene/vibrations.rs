//! Scenes of free vibrations: accepted settings, and parts without a meaning for them.

use tissuebench_cases::scene::{Mass, Procedure, parse};

const SCENE: &str = r#"title = "A box on rollers"
body = { shape = "box", size = ["40 mm", "30 mm", "20 mm"] }
material = { law = "linear", young = "20 kPa", poisson = 0.3, density = "1000 kg/m^3" }
support = [{ on = "x-min", fix = "x" }]
procedure = { kind = "modes", modes = 12 }
reference = { exact = "roller-box", length = "40 mm", depth = "30 mm", width = "20 mm", density = "1000 kg/m^3" }
method = [{ id = "tet4", family = "fem", element = "tet4", size = { level = 1 }, mass = "lumped" }]
check = [{ metric = "slow-modes", at_most = 0 }]
"#;

#[test]
fn modes_and_masses_are_read() {
    let scene = parse(SCENE, "s.toml").expect("sound");
    assert_eq!(scene.procedure, Procedure::Modes { count: 12 });
    assert_eq!(scene.methods[0].mass, Some(Mass::Lumped));
    assert!(scene.unavailable().is_empty());
}

#[test]
fn what_has_no_part_in_vibrations_names_its_key() {
    for (from, to, key, said) in [
        (
            ", density = \"1000 kg/m^3\" }\nsupport",
            " }\nsupport",
            "material.density",
            "vibrations need a mass",
        ),
        (", mass = \"lumped\"", "", "method[0].mass", "is missing; add mass = \"consistent\""),
        ("\"lumped\"", "\"lumpd\"", "method[0].mass", "did you mean 'lumped'?"),
        ("modes = 12", "modes = 0", "procedure.modes", "is no number of modes"),
        (
            "modes = 12",
            "modes = 12, duration = \"1 s\"",
            "procedure.duration",
            "does not belong to kind = \"modes\"; leave it out; it goes with explicit, implicit-dynamic",
        ),
        (
            "\"modes\", modes = 12",
            "\"linear\", modes = 12",
            "procedure.modes",
            "does not belong to kind = \"linear\"; leave it out; it goes with modes",
        ),
        ("\"modes\", modes = 12", "\"linear\"", "method[0].mass", "applies to vibrations only"),
        ("\"modes\", modes = 12", "\"linear\"", "check[0].metric", "needs [procedure] kind = \"modes\""),
        (
            "fix = \"x\"",
            "move = { x = \"1 mm\" }",
            "support[0].move",
            "prescribes a motion, but the body vibrates freely",
        ),
        (
            "method =",
            "load = [{ on = \"x-max\", pressure = \"1 Pa\" }]\nmethod =",
            "load[0]",
            "has no part in free",
        ),
        (
            "method =",
            "output = { probes = [[\"1 mm\", \"1 mm\", \"1 mm\"]] }\nmethod =",
            "output.probes",
            "no part",
        ),
        ("\"linear\", young", "\"hencky\", young", "material.law", "is a law of large strain"),
        (
            "\"roller-box\", length = \"40 mm\", depth = \"30 mm\", width = \"20 mm\", density = \"1000 kg/m^3\"",
            "\"rigid\"",
            "reference.exact",
            "'rigid' is not available for vibrations; take \"lame-cube\" or \"roller-box\"",
        ),
        (
            "depth = \"30 mm\"",
            "depth = \"0 mm\"",
            "reference.depth",
            "'0 mm' does not go with roller-box; it must be above zero",
        ),
    ] {
        assert!(SCENE.contains(from), "{from}");
        let errors = parse(&SCENE.replacen(from, to, 1), "s.toml").expect_err(to);
        let found = errors.iter().find(|e| e.key == key).unwrap_or_else(|| panic!("{key}: {errors:?}"));
        assert!(found.to_string().contains(said), "{found}");
    }
    let mixed = SCENE.replace("\"tet4\", size", "\"tet10\", dilation = \"mixed\", size");
    let refused = parse(&mixed, "s.toml").expect("sound").unavailable();
    assert!(
        refused[0].to_string().contains("dilation = \"mixed\" in vibrations is not available"),
        "{refused:?}"
    );
}
