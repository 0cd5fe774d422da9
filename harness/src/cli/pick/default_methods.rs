//! The usual methods, of which a scene receives the suitable ones for its body, law, procedure and contact.

use cases::scene::{self, Scene, SceneError};

use crate::cli::args::SceneArgs;

/// Methods as TOML by id. Their size is the first of a ladder.
const USUAL: [(&str, &str); 6] = [
    ("tet4", "family = \"fem\"\nelement = \"tet4\"\nsize = { nodes = 100 }"),
    ("tet4-nodal", "family = \"fem\"\nelement = \"tet4\"\ndilation = \"nodal-mean\"\nsize = { nodes = 100 }"),
    ("tet10", "family = \"fem\"\nelement = \"tet10\"\nsize = { nodes = 100 }"),
    (
        "hex8-mean",
        "family = \"fem\"\nelement = \"hex8\"\ndilation = \"element-mean\"\nsize = { nodes = 100 }",
    ),
    ("hex20", "family = \"fem\"\nelement = \"hex20\"\nsize = { nodes = 100 }"),
    (
        "efg",
        "family = \"efg\"\nnodes = 100\nkernel = \"cubic-spline\"\nsupport_scale = 1.6\nbasis = \"linear\"\n\
         integration = { rule = \"cell-smoothed\", points = 1 }\nessential = \"penalty\"",
    ),
];

/// Returns the scene with the usual methods that suit it added to its own, and the number of its own methods.
/// A scene with other errors than missing methods is refused unchanged.
pub(super) fn with_usual(args: &SceneArgs, always: bool) -> Result<(Scene, usize), Vec<SceneError>> {
    let path = &args.file;
    let own = scene::load_with(path, &args.set);
    let bare = own.as_ref().err().is_some_and(|errors| errors.iter().all(|error| error.key == "method"));
    let (text, mut count) = match &own {
        Ok(scene) if always => (scene.text().to_string(), scene.methods.len()),
        Err(_) if bare => (disk::read_text(path, disk::Kind::SCENE).unwrap_or_default(), 0),
        _ => return own.map(|scene| (scene.methods.len(), scene)).map(|(count, scene)| (scene, count)),
    };
    let Ok(mut table) = text.parse::<toml::Table>() else { return own.map(|scene| (scene, count)) };
    let mut best = own;
    for (id, keys) in USUAL {
        let mut with = table.clone();
        let method: toml::Table = format!("id = \"{id}\"\n{keys}").parse().expect("a table of ours");
        match with.entry("method").or_insert_with(|| toml::Value::Array(Vec::new())) {
            toml::Value::Array(methods) => methods.push(method.into()),
            _ => return best.map(|scene| (scene, count)),
        }
        let Ok(text) = toml::to_string(&with) else { continue };
        // A method that the scene has already, or that does not suit it, is left out.
        if let Ok(scene) = scene::parse_with(&text, &path.display().to_string(), &args.set)
            && scene.unavailable().is_empty()
        {
            (table, best) = (with, Ok(scene));
        }
    }
    count = count.min(best.as_ref().map_or(0, |scene| scene.methods.len()));
    best.map(|scene| (scene, count))
}
