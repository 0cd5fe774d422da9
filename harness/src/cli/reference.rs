//! `tissuebench reference`: runs all methods of a scene and stores their common result.

use std::path::PathBuf;

use crate::cli::args::ReferenceArgs;
use crate::cli::errors::fail;
use crate::cli::scenes::open;
use crate::cli::text;
use crate::error::Failure;
use crate::run::stored_reference::Stored;
use crate::study::make_reference::make;
use crate::study::{folder, note_inputs};

/// Runs the methods and writes their common result.
pub(super) fn reference(args: &ReferenceArgs) -> Result<(), u8> {
    let (scene, chosen) = open(&args.scene)?;
    let chosen: Vec<String> = chosen.iter().map(|&index| scene.methods[index].id.clone()).collect();
    note_inputs(&scene);
    args.from.iter().chain(&args.alongside).chain([&args.points]).for_each(|file| disk::input(file));
    folder::ready_file(&args.out).map_err(|problem| fail(&Failure::Input(problem)))?;
    let text = scene.text().to_string();
    let mesh = mesh_files::read(&args.points, args.unit.metres)
        .map_err(|bad| fail(&Failure::Input(format!("{}: {bad}", args.points.display()))))?;
    let read = |path: &PathBuf| -> Result<Stored, u8> {
        let of_file = |problem| fail(&Failure::Input(format!("{}: {problem}", path.display())));
        let stored = Stored::read(path).map_err(|problem| fail(&Failure::Input(problem)))?;
        stored.belongs(&text, mesh.points()).map_err(of_file)?;
        Ok(stored)
    };
    let from = args.from.as_ref().map(read).transpose()?;
    let mut used: Vec<String> = match &from {
        Some(from) => from.methods().map(Into::into).collect(),
        None => chosen.clone(),
    };
    // Conflicts are refused before hours are spent on the methods.
    let mut alongside = Vec::new();
    for path in &args.alongside {
        let other = read(path)?;
        // A solution cannot confirm itself.
        if let Some(twice) = other.methods().find(|id| used.iter().any(|u| u == id)) {
            let problem = format!(
                "{}: '{twice}' is already stored; select other methods with --method",
                path.display()
            );
            return Err(fail(&Failure::Input(problem)));
        }
        used.extend(other.methods().map(Into::into));
        alongside.push(other);
    }
    let mut stored = match from {
        Some(from) => from,
        None => make(&scene, &text, mesh.points(), &chosen).map_err(|failure| fail(&failure))?,
    };
    alongside.iter().for_each(|other| stored.widen(other));
    print!("{}", text::reference(&stored));
    let json = serde_json::to_string(&stored).expect("finite numbers and text");
    disk::write(&args.out, json + "\n")
        .map_err(|bad| fail(&Failure::Run(format!("{} can't be written: {bad}", args.out.display()))))
}
