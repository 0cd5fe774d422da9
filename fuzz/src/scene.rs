//! A scene: read, checked, and planned if it is small; tables are built if the scene requests only tables.

use cases::scene::{self, Procedure, Scene};
use harness::run::{Group, Repeats, RunOptions};

use crate::inputs::beside;
use crate::messages::sound;

/// Largest number of nodes of a planned method. A plan generates the mesh, and a large mesh legitimately
/// takes time.
const NODES: f64 = 300.0;

pub(crate) fn run(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let file = beside("fuzz.toml");
    match scene::parse(text, &file) {
        Err(errors) => {
            assert!(!errors.is_empty());
            sound(&errors, text, &file);
        }
        Ok(scene) => plan(&scene),
    }
}

fn plan(scene: &Scene) {
    if !scene.unavailable().is_empty() {
        return;
    }
    let Ok(group) = Group::unreferenced(scene, Repeats::ONCE) else { return };
    for method in scene.methods.iter().take(2) {
        let scenario = group.scenario(method.clone(), 0);
        if scenario.expected_nodes() > NODES {
            continue;
        }
        let planned = group.plan(&scenario);
        if planned.is_ok() && matches!(scene.procedure, Procedure::Prepare) {
            let _ = group.run(&scenario, RunOptions::default());
        }
    }
}
