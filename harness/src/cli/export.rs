//! `tissuebench export`: writes the problem of one method as files that any solver can read.

use crate::cli::args::{ExportArgs, SceneArgs};
use crate::cli::errors::fail;
use crate::cli::scenes::{affordable_methods, open};
use crate::measure::Repeats;
use crate::run::Group;

/// Writes the folder and returns the exit code.
pub(super) fn export(args: &ExportArgs) -> u8 {
    let ExportArgs { scene: file, method, set, .. } = args;
    let wanted = SceneArgs { file: file.clone(), methods: vec![method.clone()], set: set.clone() };
    let (scene, chosen) = match open(&wanted) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    if let Err(code) = affordable_methods(&scene, &chosen, false) {
        return code;
    }
    if let Err(bad) = std::fs::create_dir_all(&args.out) {
        eprintln!("tissuebench: --out {}: can't be made: {bad}", args.out.display());
        return 5;
    }
    let exported = Group::unreferenced(&scene, Repeats::ONCE).and_then(|group| {
        let scenario = group.scenario(scene.methods[chosen[0]].clone(), 0);
        group.export(&scenario, &args.out)
    });
    match exported {
        Ok(exported) => {
            let (id, nodes, cells) = (exported.id, exported.nodes, exported.cells);
            println!("{}: problem {id}, {nodes} nodes, {cells} cells", args.out.display());
            0
        }
        Err(failure) => fail(&failure),
    }
}
