//! `tissuebench mesh`: what a mesh file holds, and the same body in other cells.

use geometry::generate::{raise_order, to_tets};
use geometry::{CellKind, Mesh, msh, quality};

use crate::Failure;
use crate::cli::args::MeshAction;

/// Millimetre files are read and written in their own unit.
const MILLIMETRE: f64 = 1e-3;

/// Runs one mesh command.
pub fn act(action: &MeshAction) -> Result<(), Failure> {
    match action {
        MeshAction::Info { files, unit } => files.iter().try_for_each(|file| {
            let mesh = msh::read(file, *unit).map_err(input)?;
            print_info(&file.display().to_string(), &mesh)
        }),
        MeshAction::Convert { from, to, element } => {
            let mesh = msh::read(from, MILLIMETRE).map_err(input)?;
            let mesh = match element.as_deref() {
                None => mesh,
                Some(name) => into(&mesh, name)?,
            };
            msh::write(&mesh, to, MILLIMETRE).map_err(input)?;
            println!("{}: {} nodes, {} cells", to.display(), mesh.points().len(), mesh.cell_count());
            Ok(())
        }
    }
}

fn input(error: impl std::fmt::Display) -> Failure {
    Failure::Input(error.to_string())
}

fn into(mesh: &Mesh, name: &str) -> Result<Mesh, Failure> {
    let is = |kinds: &[CellKind]| (0..mesh.cell_count()).all(|c| kinds.contains(&mesh.kind(c)));
    let from = mesh.uniform_kind().map_or("mixed", CellKind::name);
    match name {
        _ if mesh.uniform_kind().is_some_and(|k| k.name() == name) => Ok(mesh.clone()),
        "tet4" => Ok(to_tets(mesh)),
        "tet10" if is(&[CellKind::Tet4, CellKind::Hex8]) => Ok(raise_order(&to_tets(mesh))),
        "hex20" if is(&[CellKind::Hex8]) => Ok(raise_order(mesh)),
        "tet10" | "hex8" | "hex20" => Err(Failure::Input(format!("{from} cells do not convert to {name}"))),
        _ => Err(Failure::Input(format!("no element '{name}'; there are tet4, tet10, hex8 and hex20"))),
    }
}

fn print_info(name: &str, mesh: &Mesh) -> Result<(), Failure> {
    println!("{name}: {} nodes, {} cells", mesh.points().len(), mesh.cell_count());
    for kind in CellKind::ALL {
        let count = (0..mesh.cell_count()).filter(|&c| mesh.kind(c) == kind).count();
        if count > 0 {
            println!("  {:6} {count}", kind.name());
        }
    }
    println!("  regions  {}", mesh.region_names().join(", "));
    println!("  surfaces {}", mesh.group_names().collect::<Vec<_>>().join(", "));
    let quality = quality::check(mesh).map_err(|bad| Failure::Input(format!("{name}: {bad}")))?;
    println!("  volume   {:.6e} m^3", quality.volume);
    println!("{quality:#?}");
    Ok(())
}
