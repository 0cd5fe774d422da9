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
    let (mirrored, turned) = (write(&dir, "mirrored.msh", text), inside(&dir, "turned.msh"));
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
