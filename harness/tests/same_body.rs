//! Mesh files of methods must match the scene's body in position, extent and volume.

mod common;

use common::{assert_fails, cases, tissuebench, write};

fn scene(body: &str, size: &str) -> String {
    format!(
        r#"title = "A kidney from files"
body = {{ {body} }}
material = {{ law = "linear", young = "20 kPa", poisson = 0.3 }}
support = [{{ where = "z <= 0 mm", fix = "xyz" }}]
load = [{{ where = "z >= 5 mm", pressure = "1 kPa" }}]
method = [{{ id = "tet4", family = "fem", element = "tet4", size = {{ {size} }} }}]
"#
    )
}

#[test]
fn a_mesh_of_another_body_or_unit_is_refused() {
    let mesh = cases("kidney/kidney-1331.msh");
    let dir = tempfile::tempdir().unwrap();
    let (mm, m) = (format!("file = \"{mesh}\""), format!("file = \"{mesh}\", unit = \"m\""));
    let file = |unit: &str| format!("shape = \"file\", path = \"{mesh}\", unit = \"{unit}\"");
    let run = |body: &str, size: &str| {
        tissuebench(&[
            "run",
            &write(&dir, "organ.toml", &scene(body, size)),
            "--out",
            &common::inside(&dir, "out"),
        ])
    };
    for body in [file("mm"), "shape = \"kidney\"".into()] {
        let done = run(&body, &mm);
        assert_eq!(done.code, 0, "{}", done.stderr);
        assert_fails(&run(&body, &m), 2, "organ.toml:6: key 'method[0].size.file'");
    }
    // The unit of the body does not apply to the method, and the message says what to write.
    assert_fails(&run(&file("m"), &mm), 2, "if the file is in m, add unit = \"m\"");
    let cube = "shape = \"box\", size = [\"40 mm\", \"40 mm\", \"20 mm\"]";
    assert_fails(&run(cube, &mm), 2, "give a mesh of the same body");
}
