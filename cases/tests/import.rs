//! Models of other programs: their scenes, and what of them is refused.

use std::path::Path;

use tissuebench_cases::import::{Finding, Imported, Units, import, import_bytes};
use tissuebench_cases::scene;

fn model(name: &str) -> std::path::PathBuf {
    Path::new("tests/models").join(name)
}

fn imported(name: &str, units: Units) -> Imported {
    step(name, units, None)
}

fn step(name: &str, units: Units, step: Option<usize>) -> Imported {
    import(&model(name), name, units, step).unwrap_or_else(|findings| panic!("{}", lines(&findings)))
}

fn lines(findings: &[Finding]) -> String {
    findings.iter().map(|finding| format!("{finding}\n")).collect()
}

#[test]
fn a_model_becomes_a_scene() {
    for name in ["two-blocks.feb", "pressed-block.feb", "fibres.feb", "beam.inp"] {
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
fn each_step_of_a_deck_becomes_a_scene() {
    for number in [1, 2, 5] {
        let imported = step("vibration.inp", Units::Metres, Some(number));
        insta::assert_snapshot!(format!("vibration-step-{number}"), imported.scene);
        let file = model("vibration.toml").display().to_string();
        assert!(scene::parse(&imported.scene, &file).is_ok(), "step {number}");
    }
    let last = step("vibration.inp", Units::Metres, None).scene;
    assert_eq!(last, step("vibration.inp", Units::Metres, Some(5)).scene);
}

#[test]
fn a_step_that_begins_with_the_state_of_another_is_refused() {
    for (number, words) in [
        (0, "vibration.inp: has 5 steps, so no step 0"),
        (6, "vibration.inp: has 5 steps, so no step 6"),
        (3, "vibration.inp:57: *STEP 3 begins with the state of *STEP 2"),
        (3, "vibration.inp:61: a displacement other than zero in a dynamic step"),
        (4, "vibration.inp:63: PERTURBATION: *STEP 4 begins with the stress of *STEP 2"),
    ] {
        let findings = import(&model("vibration.inp"), "vibration.inp", Units::Metres, Some(number));
        let found = lines(&findings.expect_err("refused"));
        assert!(found.contains(words), "{words} in {found}");
    }
    let found = import(&model("two-blocks.feb"), "two-blocks.feb", Units::Metres, Some(2));
    assert!(lines(&found.expect_err("refused")).contains("is no deck of CalculiX"));
}

/// A deck of one element of this type.
fn one_element(kind: &str, nodes: usize) -> String {
    let places: String = (1..=nodes).map(|node| format!("{node}, {node}., 0., 0.\n")).collect();
    let list: Vec<String> = (1..=nodes).map(|node| node.to_string()).collect();
    format!(
        "*NODE\n{places}*ELEMENT, TYPE={kind}, ELSET=E\n1, {}\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n\
         *SOLID SECTION, ELSET=E, MATERIAL=M\n*STEP\n*STATIC\n*END STEP\n",
        list.join(", ")
    )
}

#[test]
fn elements_have_the_points_of_calculix_or_a_note() {
    let scene = |kind, nodes| {
        let deck = one_element(kind, nodes);
        import_bytes(deck.as_bytes(), "one.inp", "one.inp", Units::Metres, None).expect("imported").scene
    };
    for (kind, nodes, reduced) in [
        ("C3D8", 8, false),
        ("C3D10", 10, false),
        ("C3D15", 15, true),
        ("C3D20", 20, false),
        ("C3D20R", 20, true),
    ] {
        assert_eq!(scene(kind, nodes).contains("reduced = true"), reduced, "{kind}");
    }
    assert!(scene("C3D8", 11).contains("# * line 14: nodes after the eight of an element"));
    assert!(scene("C3D6", 6).contains("# * line 8: the two points of C3D6: wedge6 has six"));
    for (kind, nodes) in [("C3D8R", 8), ("C3D8I", 8), ("S8", 8), ("B31", 2)] {
        let deck = one_element(kind, nodes);
        let refused = import_bytes(deck.as_bytes(), "one.inp", "one.inp", Units::Metres, None);
        let found = lines(&refused.expect_err("refused"));
        let line = nodes + 2;
        assert!(found.contains(&format!("one.inp:{line}: elements {kind} can't be expressed")), "{found}");
    }
}

#[test]
fn the_committed_scene_is_that_of_today() {
    let folder = Path::new("scenes/import");
    let deck = folder.join("pulled-in-steps.inp");
    let committed = std::fs::read_to_string(folder.join("pulled-in-steps.toml")).expect("read");
    for _ in 0..2 {
        let today = import(&deck, "pulled-in-steps.inp", Units::Millimetres, None).expect("imported").scene;
        assert_eq!(committed, today, "import the deck again: tissuebench import --unit mm");
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
        let findings = import(&model(name), name, Units::Metres, None).expect_err("refused");
        insta::assert_snapshot!(format!("refused-{name}"), lines(&findings));
    }
}

/// A model that is cut short or changed in one place is refused or imported, but never panics.
#[test]
fn spoilt_models_are_refused_or_imported() {
    for name in [
        "two-blocks.feb",
        "pressed-block.feb",
        "fibres.feb",
        "beam.inp",
        "vibration.inp",
        "hostile.feb",
        "hostile.inp",
    ] {
        let bytes = std::fs::read(model(name)).expect("read");
        for at in 0..bytes.len() {
            let _ = import_bytes(&bytes[..at], name, name, Units::Metres, None);
            for other in [b'0', b'<', b',', b'-', 0xff] {
                let mut spoilt = bytes.clone();
                spoilt[at] = other;
                let _ = import_bytes(&spoilt, name, name, Units::Metres, None);
            }
        }
        // A line that is missing.
        let text = String::from_utf8_lossy(&bytes);
        let all: Vec<&str> = text.lines().collect();
        for gone in 0..all.len() {
            let rest: Vec<&str> =
                all.iter().enumerate().filter(|(at, _)| *at != gone).map(|(_, l)| *l).collect();
            let _ = import_bytes(rest.join("\n").as_bytes(), name, name, Units::Metres, None);
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
    differ("two-blocks.feb", &text, &whole, &changes);
    let text = std::fs::read_to_string(model("fibres.feb")).expect("read");
    let whole = imported("fibres.feb", Units::Metres).scene;
    let changes = [
        ("<c3>0</c3>", "<c3>1</c3>"),
        ("<lambda>1.1<", "<lambda>1.2<"),
        ("<solid type=\"neo-Hookean\">", "<solid type=\"Mooney-Rivlin\">"),
        ("\t\t</material>", "\t\t\t<solid type=\"neo-Hookean\"/></material>"),
        ("<T0 lc=\"1\">50<", "<T0 lc=\"1\">60<"),
        ("<phi>90<", "<phi>80<"),
        ("<c2>0<", "<c2>1<"),
        ("<k>400<", "<k>500<"),
        ("<N>9<", "<N>10<"),
        ("<N>9<", "<N>0<"),
        ("<cp>700<", "<cp>0<"),
        ("<phi0>0.2<", "<phi0>0.3<"),
        ("<linear>0<", "<linear>1<"),
        ("3*(2 - Y*Y", "3*(2 - X*Y"),
        ("3*(2 - Y*Y", "3*(2 - sin(Y)*Y"),
        ("<rhoi>-2<", "<rhoi>1<"),
        ("<beta>0.25<", "<beta>0.3<"),
        ("ElementData type=\"fiber\"", "ElementData type=\"mat_axis\""),
        ("<fiber type=\"user\"/>", "<fiber type=\"map\"/>"),
    ];
    differ("fibres.feb", &text, &whole, &changes);
}

#[track_caller]
fn differ(name: &str, text: &str, whole: &str, changes: &[(&str, &str)]) {
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        let changed = text.replacen(from, to, 1);
        let now = import_bytes(changed.as_bytes(), name, name, Units::Metres, None);
        assert!(now.map_or(true, |now| now.scene != whole), "{from} -> {to}");
    }
}

#[test]
fn nothing_of_a_step_is_dropped_in_silence() {
    let file = "scenes/import/pulled-in-steps.inp";
    let text = std::fs::read_to_string(file).expect("read");
    let whole = import_bytes(text.as_bytes(), file, file, Units::Metres, None).expect("imported").scene;
    let changes = [
        ("*BOUNDARY, OP=NEW", "*BOUNDARY"),
        ("*CLOAD, OP=NEW", "*CLOAD"),
        ("*CLOAD, OP=NEW", "*CLOAD, OP=KEEP"),
        ("*DLOAD, AMPLITUDE=GROWTH", "*DLOAD"),
        ("*DLOAD, AMPLITUDE=GROWTH", "*DLOAD, AMPLITUDE=OTHER"),
        ("1., 1.5", "2., 1.5"),
        ("1., 1.5", "1., 1.5, 1., 1.5"),
        ("LAST, P4, -2.", "3, P4, -2."),
        ("LAST, P4, -1.", "BAR, P1, -1."),
        ("LAST, P4, -1.", "BAR, P4, -1."),
        ("LAST, P4, -2.", "LAST, P4NP, 20"),
        ("LAST, P4, -2.", "BAR, GRAV, 9.81, 0., 0., -1."),
        ("LEFT, 1\n", "LEFT, 1, 1, 0.1\n"),
        ("*STATIC", "*STATIC, RIKS"),
        ("*STEP\n", "*STEP, NLGEOM\n"),
        ("*NODE PRINT", "*EQUATION"),
        ("*ELASTIC\n", "*ELASTIC, TYPE=ORTHO\n"),
    ];
    // The last step decides, and each of these words also stands in it.
    differ(file, &text, &whole, &changes[..6]);
    let last = text.rfind("*STEP").expect("a step");
    let (before, step) = text.split_at(last);
    for (from, to) in &changes[7..] {
        let (first, second) = (before.replace(from, to), step.replace(from, to));
        assert!(first != before || second != step, "{from}");
        let changed = first + &second;
        let now = import_bytes(changed.as_bytes(), file, file, Units::Metres, None);
        assert!(now.map_or(true, |now| now.scene != whole), "{from} -> {to}");
    }
}

/// Friction acts where the source has it: by the penalty of the contact, or by one of its own.
#[test]
fn friction_is_that_of_the_kind_of_contact() {
    let text = std::fs::read_to_string(model("pressed-block.feb")).expect("read");
    let rough = text.replace("<fric_coeff>0<", "<fric_coeff>0.5<");
    let nodes = rough.replace("sliding-elastic", "sliding-node-on-facet");
    let facets = rough.replace("sliding-elastic", "sliding-facet-on-facet");
    let own = nodes.replace("<fric_coeff>", "<fric_penalty>50</fric_penalty><fric_coeff>");
    for (text, stick) in [(rough, Some("100000.0")), (nodes, None), (facets, None), (own, Some("50.0"))] {
        let imported =
            import_bytes(text.as_bytes(), "a.feb", "a.feb", Units::Metres, None).expect("imported");
        let line = stick.map(|stick| format!("friction = 0.5\nstick = \"{stick} Pa/m\""));
        assert_eq!(line.as_ref().is_some_and(|line| imported.scene.contains(line)), stick.is_some());
        let left_out = imported.left_out.iter().any(|part| part.what.contains("without effect"));
        assert_eq!(left_out, stick.is_none(), "{}", imported.scene);
        assert_eq!(imported.scene.contains("friction"), stick.is_some(), "{}", imported.scene);
    }
    for (tag, value, said) in
        [("penalty", "0", "<penalty> is 0"), ("flip_secondary", "1", "<flip_secondary> is 1")]
    {
        let changed = match text.contains(&format!("<{tag}>")) {
            true => text.replace("<penalty>100000<", &format!("<penalty>{value}<")),
            false => text.replace("<fric_coeff>", &format!("<{tag}>{value}</{tag}><fric_coeff>")),
        };
        let refused = import_bytes(changed.as_bytes(), "a.feb", "a.feb", Units::Metres, None).unwrap_err();
        assert!(lines(&refused).contains(said), "{}", lines(&refused));
    }
}
