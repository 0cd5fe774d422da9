//! `tissuebench plan`: prints the stages of a scene's methods without running them.

use crate::cli::args::SceneArgs;
use crate::cli::scenes::{affordable_methods, open};
use crate::cli::text;
use crate::measure::Repeats;
use crate::run::Group;

/// Prints the plan of each method and returns the exit code.
pub(super) fn plan(args: &SceneArgs, force: bool) -> u8 {
    let (scene, chosen) = match open(args) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    if let Err(code) = affordable_methods(&scene, &chosen, force) {
        return code;
    }
    let mut code = 0;
    for index in chosen {
        let method = &scene.methods[index];
        // A plan describes the run itself and needs no reference.
        let stages = Group::unreferenced(&scene, Repeats::ONCE)
            .and_then(|group| group.plan(&group.scenario(method.clone(), 0)));
        match stages {
            Ok((stages, size)) => print!("{}", text::stages(&method.id, size.nodes, &stages)),
            Err(failure) => {
                eprintln!("{failure} (method '{}')", method.id);
                code = code.max(failure.exit_code());
            }
        }
    }
    code
}
