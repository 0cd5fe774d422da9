//! Shared methods: the same as methods written out.

use std::path::{Path, PathBuf};

use tissuebench_cases::scene::{ErrorKind, Scene, load};

use crate::SCENE;

/// Tables of methods; the first has no size.
const SHARED: &str = r#"# Shared.
[[method]]
id = "tet4"
family = "fem"
element = "tet4"
dilation = "nodal-mean"
jitter = { fraction = 0.2, seed = 7 }

[[method]]
id = "efg-83"
family = "efg"
nodes = 83
kernel = { name = "gaussian", alpha = 0.4 }
support_scale = 1.6
basis = "linear"
integration = { rule = "gauss", points = 4 }
essential = { method = "nitsche", factor = 10 }
background = { spacing = "5 mm" }
"#;

/// Methods of a scene that takes the shared methods.
const TAKEN: &str = r#"[[method]]
use = "tet4"
size = { cells = [4, 4, 2], grading = [1, 1, 2] }
[[method]]
use = "efg-83"
"#;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("shared").join(name)
}

/// The scene with other methods in place of its first two, read from a folder with the given name that holds
/// the shared methods.
fn taken(name: &str, shared: &str, methods: &str) -> Scene {
    let folder = folder(name);
    std::fs::create_dir_all(folder.join("scenes")).unwrap();
    std::fs::write(folder.join("methods.toml"), shared).unwrap();
    let scene = folder.join("scenes/block.toml");
    let (start, end) =
        (SCENE.find("[[method]]").unwrap(), SCENE.find("[[method]]\nid = \"efg-mesh\"").unwrap());
    let from = "methods_from = \"../methods.toml\"\n";
    std::fs::write(&scene, format!("{from}{}{methods}{}", &SCENE[..start], &SCENE[end..])).unwrap();
    load(&scene).unwrap_or_else(|errors| panic!("{}", errors[0]))
}

#[test]
fn a_shared_method_is_what_it_is_written_out() {
    let scene = taken("same", SHARED, TAKEN);
    let written = tissuebench_cases::scene::parse(SCENE, "block.toml").unwrap();
    assert_eq!(scene.methods, written.methods);
}

#[test]
fn a_key_of_the_scene_replaces_the_shared_one() {
    let own = "[[method]]\nuse = \"tet4\"\nid = \"fine\"\ndilation = \"standard\"\nseries = \"s\"\nsize = { level = 3 }\n\
               [[method]]\nuse = \"efg-83\"\nid = \"tet4\"\n[[method]]\nuse = \"efg-83\"\n";
    let written = "[[method]]\nid = \"fine\"\nfamily = \"fem\"\nelement = \"tet4\"\ndilation = \"standard\"\nseries = \"s\"\n\
                   size = { level = 3 }\njitter = { fraction = 0.2, seed = 7 }\n";
    let scene = taken("replaced", SHARED, own);
    let other = tissuebench_cases::scene::parse(
        &SCENE.replacen("[[method]]", &format!("{written}[[method]]"), 1),
        "s.toml",
    );
    let other = other.unwrap_or_else(|errors| panic!("{}", errors[0]));
    assert_eq!(scene.methods[0], other.methods[0]);
    assert_eq!(scene.methods[1].id, "tet4");
    assert_eq!(scene.methods[1].family, scene.methods[2].family);
}

#[test]
fn the_text_of_a_scene_has_the_methods_it_takes_and_no_others() {
    let scene = taken("text", SHARED, TAKEN);
    let written = tissuebench_cases::scene::parse(scene.text(), "block.toml").expect("a scene of its own");
    assert_eq!(scene.methods, written.methods);
    let comment = taken("text-comment", &SHARED.replace("# Shared.", "# Another."), TAKEN);
    assert_eq!(comment.text(), scene.text());
    let third = format!("{SHARED}[[method]]\nid = \"hex8\"\nfamily = \"fem\"\nelement = \"hex8\"\n");
    assert_eq!(taken("text-third", &third, TAKEN).text(), scene.text());
    let other = taken("text-other", &SHARED.replace("seed = 7", "seed = 8"), TAKEN);
    assert_ne!(other.text(), scene.text());
    let own = tissuebench_cases::scene::parse(SCENE, "block.toml").unwrap();
    assert_eq!(own.text(), SCENE);
}

#[test]
fn paths_of_a_shared_method_start_from_its_own_folder() {
    let shared = SHARED.replace("{ spacing = \"5 mm\" }", "{ file = \"organ.msh\" }");
    std::fs::create_dir_all(folder("paths")).unwrap();
    std::fs::write(folder("paths").join("organ.msh"), "").unwrap();
    let scene = taken("paths", &shared, TAKEN);
    let tissuebench_cases::scene::Family::Efg(efg) = &scene.methods[1].family else { panic!("a cloud") };
    let Some(tissuebench_cases::scene::Size::File(file)) = &efg.background else { panic!("a file") };
    assert_eq!(file.path, folder("paths").join("organ.msh"));
}

#[test]
fn what_only_a_run_finds_in_a_shared_method_is_at_its_own_file_and_line() {
    let scene = taken("run", SHARED, TAKEN);
    let error = scene.error(ErrorKind::NotRun, "method[1].support_scale", "is too small", Some("give more"));
    let folder = folder("run").display().to_string();
    assert_eq!(
        error.to_string(),
        format!(
            "{folder}/methods.toml:14: key 'method[1].support_scale': '1.6' is too small; give more; taken by \
             {folder}/scenes/block.toml:38"
        )
    );
    let error = scene.error(ErrorKind::NotRun, "method[0].size.cells", "is too coarse", None);
    assert!(
        error.to_string().starts_with(&format!("{folder}/scenes/block.toml:36: key 'method[0].size.cells'")),
        "{error}"
    );
}
