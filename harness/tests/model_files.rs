//! Files that contain more than a mesh: ignored parts, cells in several groups, and mirrored cells.

mod common;

use common::{assert_fails, inside, objects, tissuebench, write};

const NODES: &str = "*NODE\n1,0,0,0\n2,10,0,0\n3,20,0,0\n4,0,10,0\n5,10,10,0\n6,20,10,0\n7,0,0,10\n8,10,0,10\n9,20,0,10\n10,0,10,10\n\
                     11,10,10,10\n12,20,10,10\n*ELEMENT, TYPE=C3D8, ELSET=ALL\n1,1,2,5,4,7,8,11,10\n2,2,3,6,5,8,9,12,11\n\
                     *ELSET, ELSET=LEFT\n1\n*ELSET, ELSET=RIGHT\n2\n*SOLID SECTION, ELSET=LEFT, MATERIAL=A\n*SOLID SECTION, ELSET=RIGHT, MATERIAL=A\n";

fn scene(file: &str, regions: &str) -> String {
    format!(
        "title = \"a deck\"\nbody = {{ shape = \"file\", path = \"{file}\", unit = \"mm\" }}\n\
         material = {{ law = \"linear\", young = \"20 kPa\", poisson = 0.3 }}\n\
         support = [{{ where = \"x == 0 mm\", fix = \"xyz\" }}]\n{regions}\
         load = [{{ where = \"x == 20 mm\", traction = [\"100 Pa\", \"0 Pa\", \"0 Pa\"] }}]\n\
         method = [{{ id = \"hex8\", family = \"fem\", element = \"hex8\", size = {{ file = \"{file}\" }} }}]\n"
    )
}

#[test]
fn what_a_deck_has_beside_its_mesh_is_said_in_info_and_run() {
    let dir = tempfile::tempdir().unwrap();
    let model = "*MATERIAL, NAME=A\n*ELASTIC\n.02,.3\n*TIE, NAME=GLUE\nM, S\n*STEP\n*STATIC\n*BOUNDARY\n1,1,3\n*END STEP\n";
    let deck = write(&dir, "model.inp", &format!("{NODES}{model}"));
    let plain = write(&dir, "plain.inp", NODES);
    let info = tissuebench(&["mesh", "info", &deck]);
    assert_eq!(info.code, 0, "{}", info.stderr);
    for line in
        ["left out    *TIE, NAME=GLUE (line 26)", "*MATERIAL, NAME=A (line 23)", "*BOUNDARY (line 30)"]
    {
        assert!(info.stdout.contains(line), "no {line} in {}", info.stdout);
    }
    assert!(!tissuebench(&["mesh", "info", &plain]).stdout.contains("left out"));
    let file = write(&dir, "model.toml", &scene("model.inp", ""));
    let done = tissuebench(&["run", &file, "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let warnings = objects(&done.stdout)[0]["warnings"].clone();
    let warned = warnings.as_array().unwrap().iter().find(|w| w["code"] == "left-out").expect("a warning");
    let message = warned["message"].as_str().unwrap();
    assert!(
        message.contains("*TIE, NAME=GLUE (line 26)") && message.contains("a different one"),
        "{message}"
    );
    let file = write(&dir, "plain.toml", &scene("plain.inp", ""));
    let done = tissuebench(&["run", &file, "--once", "--format", "json"]);
    assert!(done.code == 0 && !done.stdout.contains("left-out"), "{}", done.stdout);
}

/// Two blocks of 10 mm that share no node, with `*TIE` between them. The second block has `parts` cells along
/// y.
fn tied(parts: usize) -> String {
    let mut text = String::from(
        "*NODE\n1,0,0,0\n2,10,0,0\n3,0,10,0\n4,10,10,0\n5,0,0,10\n6,10,0,10\n7,0,10,10\n8,10,10,10\n",
    );
    let number = |y: usize, k: usize| 10 + 4 * y + k;
    for y in 0..=parts {
        for (k, [x, z]) in [[10, 0], [20, 0], [10, 10], [20, 10]].iter().enumerate() {
            text += &format!("{},{x},{},{z}\n", number(y, k), 10.0 * y as f64 / parts as f64);
        }
    }
    text += "*ELEMENT, TYPE=C3D8\n1,1,2,4,3,5,6,8,7\n";
    for y in 0..parts {
        let nodes = [(0, 0), (0, 1), (1, 1), (1, 0), (0, 2), (0, 3), (1, 3), (1, 2)];
        let nodes = nodes.map(|(more, k)| number(y + more, k).to_string());
        text += &format!("{},{}\n", 2 + y, nodes.join(","));
    }
    text + "*TIE, NAME=GLUE\nSLAVE, MASTER\n"
}

/// The tie is listed by its line, and the blocks that it would join are counted. Blocks with coincident faces
/// are joined on request, and then move as a mesh of one piece does.
#[test]
fn pieces_of_a_tie_are_counted_and_joined_on_request() {
    let dir = tempfile::tempdir().unwrap();
    let held = |file: &str, join: &str| {
        let text = scene(file, "").replace("unit = \"mm\" }", &format!("unit = \"mm\"{join} }}"));
        let support = "support = [{ where = \"z == 0 mm\", fix = \"xyz\" }]";
        text.replace("support = [{ where = \"x == 0 mm\", fix = \"xyz\" }]", support)
    };
    let largest = |text: &str| {
        let done = tissuebench(&["run", &write(&dir, "scene.toml", text), "--once", "--format", "json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let run = objects(&done.stdout).remove(0);
        let codes =
            run["warnings"].as_array().unwrap().iter().map(|w| w["code"].as_str().unwrap().to_string());
        (run["metrics"]["max-x"]["value"].as_f64().unwrap(), codes.collect::<Vec<_>>())
    };
    write(&dir, "plain.inp", NODES);
    let (whole, none) = largest(&held("plain.inp", ""));
    assert!(!none.iter().any(|code| code == "pieces-apart" || code == "left-out"), "{none:?}");
    for (parts, faces, line) in [(1, 1, 21), (2, 0, 26)] {
        let name = format!("tied-{parts}.inp");
        let join = ", join = true";
        let deck = write(&dir, &name, &tied(parts));
        let info = tissuebench(&["mesh", "info", &deck]);
        assert_eq!(info.code, 0, "{}", info.stderr);
        let pieces = format!("2 pieces that share no node, {faces} coincident faces");
        for part in [&pieces, &format!("left out    *TIE, NAME=GLUE (line {line})")] {
            assert!(info.stdout.contains(part), "no {part} in {}", info.stdout);
        }
        let (apart, codes) = largest(&held(&name, ""));
        assert!((apart / whole - 1.0).abs() > 0.05, "{apart} {whole}");
        assert!(
            codes.iter().any(|c| c == "pieces-apart") && codes.iter().any(|c| c == "left-out"),
            "{codes:?}"
        );
        if faces > 0 {
            let (joined, codes) = largest(&held(&name, join));
            assert!((joined / whole - 1.0).abs() < 1e-9, "{joined} {whole}");
            assert!(!codes.iter().any(|code| code == "pieces-apart"), "{codes:?}");
        } else {
            let path = write(&dir, "scene.toml", &held(&name, join));
            assert_fails(&tissuebench(&["run", &path]), 2, "have no coincident faces");
        }
    }
}

#[test]
fn a_region_may_be_any_group_but_a_cell_has_one_material() {
    let dir = tempfile::tempdir().unwrap();
    write(&dir, "plain.inp", NODES);
    let region = |name: &str, on: &str| {
        format!(
            "{{ name = \"{name}\", on = \"{on}\", material = {{ law = \"linear\", young = \"40 kPa\", poisson = 0.3 }} }}"
        )
    };
    let run = |regions: &[String]| {
        let file =
            write(&dir, "scene.toml", &scene("plain.inp", &format!("region = [{}]\n", regions.join(", "))));
        tissuebench(&["run", &file, "--once", "--format", "json"])
    };
    let largest = |regions: &[String]| {
        let done = run(regions);
        assert_eq!(done.code, 0, "{}", done.stderr);
        objects(&done.stdout)[0]["metrics"]["max-x"]["value"].as_f64().unwrap()
    };
    let all = largest(&[region("stiff", "ALL")]);
    assert!((all - largest(&[region("a", "LEFT"), region("b", "RIGHT")])).abs() < 1e-12 * all);
    let done = run(&[region("whole", "ALL"), region("end", "RIGHT")]);
    assert_fails(&done, 2, "'end' (RIGHT) and 'whole' (ALL) both contain cell 1");
}

#[test]
fn mirrored_cells_are_turned_on_request() {
    let dir = tempfile::tempdir().unwrap();
    let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 -3 0 0\n3 0 2 0\n4 0 0 1\n$EndNodes\n\
                $Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";
    let mirrored = write(&dir, "mirrored.msh", text);
    let turned = inside(&dir, "turned.msh");
    assert_fails(
        &tissuebench(&["mesh", "info", &mirrored]),
        2,
        "reverse the order with tissuebench mesh convert --turn",
    );
    let done = tissuebench(&["mesh", "convert", &mirrored, &turned, "--turn"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let info = tissuebench(&["mesh", "info", &turned]);
    assert!(info.code == 0 && info.stdout.contains("volume      1.000e-3 cm^3"), "{}", info.stdout);
}

#[test]
fn scenes_and_studies_name_the_other_verb() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "block.toml", common::BLOCK);
    let study = write(&dir, "study.toml", "title = \"One\"\n[[run]]\nscene = \"block.toml\"\n");
    for verb in [&["run"][..], &["plan"], &["pick", "--error", "5%"]] {
        let done = tissuebench(&[verb, &[&study]].concat());
        assert_fails(&done, 2, "is a study, not a scene: tissuebench verify ");
    }
    let body = write(&dir, "body.stl", "solid body\nendsolid body\n");
    assert_fails(&tissuebench(&["run", &body]), 2, "is a body, not a scene: tissuebench init --file ");
    let out = inside(&dir, "out");
    assert_fails(
        &tissuebench(&["verify", &scene, "--out", &out]),
        2,
        "is a scene, not a study: tissuebench run ",
    );
}
