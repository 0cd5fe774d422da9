//! Models of other programs: their scenes, and what of them is refused.

use std::path::Path;

use tissuebench_cases::import::{Finding, Imported, Units, import, import_bytes};
use tissuebench_cases::scene;

fn model(name: &str) -> std::path::PathBuf {
    Path::new("tests/models").join(name)
}

fn imported(name: &str, units: Units) -> Imported {
    import(&model(name), name, units).unwrap_or_else(|findings| panic!("{}", lines(&findings)))
}

fn lines(findings: &[Finding]) -> String {
    findings.iter().map(|finding| format!("{finding}\n")).collect()
}

#[test]
fn a_model_becomes_a_scene() {
    for name in ["two-blocks.feb", "beam.inp"] {
        let first = imported(name, Units::Metres);
        insta::assert_snapshot!(name, first.scene);
        assert_eq!(first.scene, imported(name, Units::Metres).scene, "importing twice");
        let file = model(name).with_extension("toml").display().to_string();
        let scene = scene::parse(&first.scene, &file);
        assert!(
            scene.is_ok(),
            "{name}: {}",
            scene.unwrap_err().iter().map(|e| format!("{e}\n")).collect::<String>()
        );
    }
}

#[test]
fn lengths_in_millimetres_imply_tonnes_and_megapascals() {
    let text = imported("two-blocks.feb", Units::Millimetres).scene;
    for line in [
        "unit = \"mm\"",
        "young = \"1000.0 MPa\"",
        "density = \"1000000000000.0 kg/m^3\"",
        "move = { z = \"0.1 mm\" }",
    ] {
        assert!(text.contains(line), "{line} in\n{text}");
    }
    // 1 t/mm^3 times 10 mm/s^2 is 1e10 N/m^3.
    assert!(text.contains("\"-10000000000.0 N/m^3\""), "{text}");
}

#[test]
fn parts_that_change_the_answer_are_refused_with_their_lines() {
    for name in ["hostile.feb", "hostile.inp"] {
        let findings = import(&model(name), name, Units::Metres).expect_err("refused");
        insta::assert_snapshot!(format!("refused-{name}"), lines(&findings));
    }
}

/// A model that is cut short or changed in one place is refused or imported, but never panics.
#[test]
fn spoilt_models_are_refused_or_imported() {
    for name in ["two-blocks.feb", "beam.inp", "hostile.feb", "hostile.inp"] {
        let bytes = std::fs::read(model(name)).expect("read");
        for at in 0..bytes.len() {
            let _ = import_bytes(&bytes[..at], name, name, Units::Metres);
            for other in [b'0', b'<', b',', b'-', 0xff] {
                let mut spoilt = bytes.clone();
                spoilt[at] = other;
                let _ = import_bytes(&spoilt, name, name, Units::Metres);
            }
        }
        // A line that is missing.
        let text = String::from_utf8_lossy(&bytes);
        let all: Vec<&str> = text.lines().collect();
        for gone in 0..all.len() {
            let rest: Vec<&str> =
                all.iter().enumerate().filter(|(at, _)| *at != gone).map(|(_, l)| *l).collect();
            let _ = import_bytes(rest.join("\n").as_bytes(), name, name, Units::Metres);
        }
    }
}

/// A missing condition, material or controller must not go unnoticed: it is refused, or the scene differs.
#[test]
fn nothing_is_dropped_in_silence() {
    let text = std::fs::read_to_string(model("two-blocks.feb")).expect("read");
    let whole = imported("two-blocks.feb", Units::Metres).scene;
    let changes = [
        ("<linear>0</linear>", "<linear>1</linear>"),
        ("<value lc=\"1\">0.1</value>", "<value lc=\"1\" type=\"map\">0.1</value>"),
        ("type=\"neo-Hookean\">\n\t\t\t<density>", "type=\"neo-Hookean\">\n\t\t\t<other>1</other><density>"),
        ("<Rw_dof>1</Rw_dof>", "<Rw_dof>0</Rw_dof>"),
        ("<extend>CONSTANT</extend>", "<extend>REPEAT</extend>"),
        ("<pt>1,2</pt>", "<pt>1,3</pt>"),
        ("version=\"4.0\"", "version=\"2.5\""),
        ("type=\"solid\"/>", "type=\"biphasic\"/>"),
        ("<analysis>STATIC", "<analysis>DYNAMIC"),
        ("mat=\"Firm\"/>", "mat=\"Firm\" type=\"ut4-solid\"/>"),
        ("mat=\"Firm\"/>", "mat=\"Firm\"><laugon>1</laugon></SolidDomain>"),
        ("mat=\"Firm\"/>", "mat=\"Firm\" elem_type=\"HEX8G1\"/>"),
    ];
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        let changed = text.replacen(from, to, 1);
        let now = import_bytes(changed.as_bytes(), "two-blocks.feb", "two-blocks.feb", Units::Metres);
        assert!(now.map_or(true, |now| now.scene != whole), "{from} -> {to}");
    }
}
