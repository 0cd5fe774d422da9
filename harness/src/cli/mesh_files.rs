//! `tissuebench mesh`: what a mesh file holds, and the same body in other cells.

use std::path::Path;

use geometry::generate::{raise_order, to_tets};
use geometry::quality::Extreme;
use geometry::{CellKind, Mesh, files, quality};

use crate::Failure;
use crate::cli::args::{LengthUnit, MeshAction};
use crate::cli::text::digits;

/// Millimetre files are read and written in their own unit.
const MILLIMETRE: f64 = 1e-3;

/// Volumes of organs are read in its cube.
const CENTIMETRE: f64 = 1e-2;

/// Runs one mesh command.
pub fn act(action: &MeshAction) -> Result<(), Failure> {
    match action {
        MeshAction::Info { files, unit } => {
            // Every file is reported; the first that is wrong gives the exit code.
            let each = files.iter().map(|file| info(file, *unit));
            each.fold(Ok(()), Result::and)
        }
        MeshAction::Make(args) => super::mesh_make::make(args),
        MeshAction::Convert { from, to, element } => convert(from, to, element.as_deref()),
    }
}

fn convert(from: &Path, to: &Path, element: Option<&str>) -> Result<(), Failure> {
    let mesh = files::read(from, MILLIMETRE).map_err(input)?;
    let real = |path: &Path| path.canonicalize().ok();
    if real(from) == real(to) {
        return Err(input(format!("{}: is the file that is read; give another name", to.display())));
    }
    let mesh = match element {
        None => mesh,
        Some(name) => into(&mesh, name)?,
    };
    files::write(&mesh, to, MILLIMETRE).map_err(input)?;
    println!("{}: {} nodes, {} cells", to.display(), mesh.points().len(), mesh.cell_count());
    Ok(())
}

pub(super) fn input(error: impl std::fmt::Display) -> Failure {
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

/// Prints what a file holds and how good its cells are.
fn info(file: &Path, unit: LengthUnit) -> Result<(), Failure> {
    let mesh = files::read(file, unit.metres).map_err(input)?;
    println!("{}: {} nodes, {} cells", file.display(), mesh.points().len(), mesh.cell_count());
    let count = |kind| (0..mesh.cell_count()).filter(|&c| mesh.kind(c) == kind).count();
    let kinds = CellKind::ALL.map(|kind| (kind.name(), count(kind)));
    let kinds = kinds.iter().filter(|(_, count)| *count > 0).map(|(name, count)| format!("{count} {name}"));
    row("cells", &kinds.collect::<Vec<_>>().join(", "));
    row("regions", &mesh.region_names().join(", "));
    let surfaces = mesh.group_names().collect::<Vec<_>>().join(", ");
    row("surfaces", if surfaces.is_empty() { "none (select with where)" } else { &surfaces });
    row("extent", &extent(&mesh, unit));
    let quality = quality::check(&mesh)
        .map_err(|bad| input(format!("{}: {}", file.display(), files::inverted(file, &bad))))?;
    let volume = |value: f64| digits(value / CENTIMETRE.powi(3));
    let (least, most) = (volume(quality.min_volume.value), volume(quality.max_volume.value));
    row("volume", &format!("{} cm^3; of a cell {least} to {most} cm^3", volume(quality.volume)));
    let (sharpest, bluntest) = (quality.min_dihedral.value, quality.max_dihedral.value);
    row("angles", &format!("{sharpest:.1} to {bluntest:.1} degrees between two faces of a cell"));
    let Extreme { element, value } = quality.max_aspect;
    let place = files::row_of_cell(file, element).map_or_else(String::new, |row| format!(", {row}"));
    row("worst cell", &format!("aspect {value:.2} (a regular cell has 1){place}"));
    Ok(())
}

pub(super) fn row(name: &str, value: &str) {
    println!("  {name:<10}  {value}");
}

/// The box around a mesh in the file's unit, as `where` takes it.
fn extent(mesh: &Mesh, unit: LengthUnit) -> String {
    let axes = ["x", "y", "z"].into_iter().enumerate().map(|(axis, name)| {
        let along = mesh.points().iter().map(|p| p[axis] / unit.metres);
        let (low, high) =
            along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        // Rounding leaves a corner at the origin a coordinate of 1e-17.
        let [low, high] = [low, high].map(|x| digits(if x.abs() < 1e-9 { 0.0 } else { x }));
        format!("{name} = {low} to {high}")
    });
    format!("{} {}", axes.collect::<Vec<_>>().join(", "), unit.name)
}
