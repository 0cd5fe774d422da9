//! Shared methods: the same as methods written out, with every error at its own file, line and key.

use std::path::{Path, PathBuf};

use tissuebench_cases::scene::{ErrorKind, Scene, SceneError, load};

use crate::{SCENE, marked_line};

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

/// Writes a scene and its shared methods into a folder with the given name, and reads the scene.
fn read(name: &str, shared: &str, top: &str, methods: &str) -> Result<Scene, Vec<SceneError>> {
    let folder = folder(name);
    std::fs::create_dir_all(folder.join("scenes")).unwrap();
    std::fs::write(folder.join("methods.toml"), shared).unwrap();
    let scene = folder.join("scenes/block.toml");
    std::fs::write(&scene, text(top, methods)).unwrap();
    load(&scene)
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("shared").join(name)
}

/// The scene with other methods in place of its first two.
fn text(top: &str, methods: &str) -> String {
    let (start, end) =
        (SCENE.find("[[method]]").unwrap(), SCENE.find("[[method]]\nid = \"efg-mesh\"").unwrap());
    format!("{top}{}{methods}{}", &SCENE[..start], &SCENE[end..])
}

const FROM: &str = "methods_from = \"../methods.toml\"\n";

fn taken(name: &str, shared: &str, methods: &str) -> Scene {
    read(name, shared, FROM, methods).unwrap_or_else(|errors| panic!("{}", errors[0]))
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

/// Errors in the shared file: replaced text, replacement with the mark, key in that file, parts of the
/// message.
const IN_SHARED: &[(&str, &str, &str, &[&str])] = &[
    (
        "dilation = \"nodal-mean\"",
        "dilation = \"nodal-meen\" #<",
        "method[0].dilation",
        &["did you mean 'nodal-mean'"],
    ),
    ("support_scale = 1.6", "support_scale = = 1.6 #<", "", &["not valid TOML"]),
    (
        "support_scale = 1.6",
        "suport_scale = 1.6 #<",
        "method[1].suport_scale",
        &["is not a known key", "support_scale"],
    ),
    (
        "support_scale = 1.6",
        "support_scale = 0.3 #<",
        "method[1].support_scale",
        &["0.3", "taken by", "block.toml:38"],
    ),
    ("alpha = 0.4 }", "alpha = 0.4, beta = 1 } #<", "method[1].kernel.beta", &["beta"]),
    ("points = 4 }", "points = 0 } #<", "method[1].integration.points", &["is zero"]),
    ("id = \"efg-83\"", "id = \"tet4\" #<", "method[1].id", &["is the id of another method", "unique"]),
    ("id = \"efg-83\"", "use = \"tet4\" #<\nid = \"efg-83\"", "method[1].use", &["is not a known key"]),
    ("family = \"efg\"\n", "family = \"emg\" #<\n", "method[1].family", &["did you mean"]),
    ("[[method]]\nid = \"efg-83\"", "[[method]] #<\n", "method[1].id", &["is missing"]),
    (
        "{ spacing = \"5 mm\" }",
        "{ file = \"no.msh\" } #<",
        "method[1].background.file",
        &["can't be found", "paths/no.msh"],
    ),
];

#[test]
fn a_mistake_in_a_shared_method_is_at_its_own_file_and_line() {
    for (from, to, key, fragments) in IN_SHARED {
        assert_eq!(SHARED.matches(from).count(), 1, "'{from}' must occur once");
        let shared = SHARED.replace(from, to);
        let errors = read("paths", &shared, FROM, TAKEN).expect_err(to);
        let file = folder("paths").join("methods.toml").display().to_string();
        let said: Vec<String> = errors.iter().map(ToString::to_string).collect();
        let fits = errors.len() == 1
            && errors[0].file == file
            && errors[0].line == marked_line(&shared)
            && errors[0].key == *key
            && fragments.iter().all(|fragment| said[0].contains(fragment));
        assert!(fits, "'{to}' wants {file}:{} {key} {fragments:?}, got {said:#?}", marked_line(&shared));
    }
}

/// Errors in the scene: its top, its methods, the key, parts of the message.
const IN_SCENE: &[(&str, &str, &str, &[&str])] = &[
    (
        FROM,
        "[[method]]\nuse = \"tet5\" #<\nsize = { level = 2 }\n",
        "method[0].use",
        &["'tet5' is not a method of", "did you mean 'tet4'? (there are tet4, efg-83)"],
    ),
    (FROM, "[[method]]\nuse = 4 #<\n", "method[0].use", &["'4' is not a method of"]),
    (
        "",
        "[[method]]\nuse = \"tet4\" #<\n",
        "method[0].use",
        &["'tet4' needs a file of methods", "methods_from = "],
    ),
    ("methods_from = 3 #<\n", TAKEN, "methods_from", &["is not the path of a file"]),
    (
        "methods_from = \"none.toml\" #<\n",
        TAKEN,
        "methods_from",
        &["none.toml' can't be read", "relative to the folder"],
    ),
    (FROM, "[[method]] #<\nuse = \"tet4\"\n", "method[0].size", &["is missing"]),
    (
        FROM,
        "[[method]]\nuse = \"tet4\"\nsize = { level = 2 }\ndilation = \"nodal-meen\" #<\n",
        "method[0].dilation",
        &["did you mean 'nodal-mean'"],
    ),
    (
        FROM,
        "[[method]]\nuse = \"tet4\"\nsize = { level = 2 }\nmas = \"lumped\" #<\n",
        "method[0].mas",
        &["is not a known key"],
    ),
    (
        FROM,
        "[[method]]\nuse = \"tet4\"\nsize = { level = 9 } #<\n",
        "method[0].size.level",
        &["'9' is not a valid level"],
    ),
    (
        FROM,
        "[[method]]\nuse = \"efg-83\"\n[[method]]\nuse = \"efg-83\" #<\n",
        "method[1].id",
        &["'efg-83' is the id of another method"],
    ),
];

#[test]
fn a_mistake_in_what_a_scene_takes_is_at_the_scene() {
    // A check of the scene names both of its methods.
    let rest = "[[method]]\nid = \"tet4\"\nfamily = \"fem\"\nelement = \"tet4\"\nsize = { level = 1 }\n";
    for (top, methods, key, fragments) in IN_SCENE {
        let methods = if methods.contains("level = 9") || methods.contains("efg-83\" #<") {
            format!("{methods}{}", rest.replace("\"tet4\"\nfamily", "\"other\"\nfamily"))
        } else {
            (*methods).to_string()
        };
        let errors = read("scene", SHARED, top, &methods).expect_err(&methods);
        let line = marked_line(&text(top, &methods));
        let fits = errors.iter().any(|error| {
            let said = error.to_string();
            error.file.ends_with("scenes/block.toml")
                && error.line == line
                && error.key == *key
                && fragments.iter().all(|fragment| said.contains(fragment))
        });
        assert!(fits, "{methods}\nwants line {line} {key} {fragments:?}, got {errors:#?}");
    }
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
