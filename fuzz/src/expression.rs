//! Texts within a scene: expressions of position, quantities with units, and regions, each in its own key.

use cases::scene;

use crate::messages::sound;

pub(crate) fn run(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let plain: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let quoted = format!("\"{}\"", plain.replace('\\', "\\\\").replace('"', "\\\""));
    for [of, size, region] in [
        [quoted.as_str(), "\"20 mm\"", "\"z >= 1 mm\""],
        ["\"x\"", &quoted, "\"z >= 1 mm\""],
        ["\"x\"", "\"20 mm\"", &quoted],
    ] {
        let scene = format!(
            "title = \"fuzz\"\nbody = {{ shape = \"box\", size = [\"10 mm\", \"10 mm\", {size}] }}\n\
             material = {{ law = \"linear\", young = \"20 kPa\", poisson = 0.3 }}\n\
             support = [{{ on = \"z-min\", fix = \"xyz\" }}]\n\
             load = [{{ where = {region}, traction = [\"0 Pa\", \"0 Pa\", {{ unit = \"kPa\", of = {of} }}] }}]\n\
             method = [{{ id = \"hex8\", family = \"fem\", element = \"hex8\", size = {{ cells = [1, 1, 1] }} }}]\n"
        );
        match scene::parse(&scene, "fuzz.toml") {
            Err(errors) => sound(&errors, &scene, "fuzz.toml"),
            Ok(scene) => evaluate(&scene),
        }
    }
}

/// Checks that every value of an expression is a finite number or an error.
fn evaluate(scene: &scene::Scene) {
    for load in &scene.loads {
        let scene::LoadKind::Traction(scene::VectorField::Components(fields)) = &load.kind else { continue };
        for x in [[0.0; 3], [0.01, 0.02, 0.03], [-1e300, 1e-300, f64::MAX]] {
            if let Ok(value) = fields[2].value(x) {
                assert!(value.is_finite(), "{value} at {x:?}");
            }
        }
    }
}
