//! Strain energies of regions.

mod common;

use common::{assert_fails, objects, tissuebench, write};

/// A block with a stiff half, pressed, by methods with each kind of dilation.
fn scene(procedure: &str, energies: &str) -> String {
    let method = |id: &str, element: &str, dilation: &str| {
        format!(
            "[[method]]\nid = \"{id}\"\nfamily = \"fem\"\nelement = \"{element}\"\ndilation = \"{dilation}\"\nsize = {{ cells = [2, 2, 2] }}\n"
        )
    };
    let methods = [
        method("hex8", "hex8", "standard"),
        method("hex8-mean", "hex8", "element-mean"),
        method("tet4-nodal", "tet4", "nodal-mean"),
        method("hex8-reduced", "hex8", "standard").replace("size", "reduced = true\nsize"),
    ];
    format!(
        r#"title = "A block with a stiff half"
body = {{ shape = "box", size = ["20 mm", "20 mm", "20 mm"] }}
material = {{ law = "neo-hookean", young = "20 kPa", poisson = 0.45, density = "1000 kg/m^3" }}
region = [{{ name = "stiff", where = "z >= 10 mm", material = {{ law = "neo-hookean", young = "80 kPa", poisson = 0.45, density = "1000 kg/m^3" }} }}]
support = [{{ on = "z-min", fix = "xyz" }}]
load = [{{ on = "z-max", traction = ["1 kPa", "0 kPa", "-2 kPa"] }}]
procedure = {procedure}
output = {{ energies = {energies} }}
{}"#,
        methods.join("\n")
    )
}

#[test]
fn energies_of_all_regions_add_up_to_the_strain_energy() {
    for procedure in [
        r#"{ kind = "static", steps = 2 }"#,
        r#"{ kind = "explicit", duration = "10 ms", steps = 2 }"#,
        r#"{ kind = "implicit-dynamic", duration = "10 ms", steps = 2 }"#,
    ] {
        let dir = tempfile::tempdir().unwrap();
        let scene = write(&dir, "scene.toml", &scene(procedure, r#"["stiff", "body"]"#));
        let done = tissuebench(&["run", &scene, "--once", "--format", "json"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        for object in objects(&done.stdout) {
            let number = |name: &str| object["metrics"][name]["value"].as_f64().unwrap();
            let [stiff, soft] = ["region-energy", "region-energy-2"].map(number);
            let whole =
                object["steps"].as_array().unwrap().last().unwrap()["strain_energy"].as_f64().unwrap();
            assert!(0.0 < stiff && stiff < soft, "{stiff} {soft}");
            assert!((stiff + soft - whole).abs() < 1e-9 * whole, "{procedure}: {stiff} {soft} {whole}");
        }
    }
}

#[test]
fn energies_of_no_region_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |energies: &str, says: &str| {
        let scene = write(&dir, "scene.toml", &scene(r#"{ kind = "static", steps = 2 }"#, energies));
        assert_fails(&tissuebench(&["run", &scene, "--once"]), 2, says);
    };
    refused(r#"["stif"]"#, "key 'output.energies[0]': 'stif' is not a region of the scene");
    refused("[]", "key 'output.energies': is empty");
}
