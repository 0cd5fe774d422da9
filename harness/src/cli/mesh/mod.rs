//! `tissuebench mesh`: prints the contents of mesh files and converts their cells.

pub(super) mod info;
mod make;

use std::path::Path;

use geometry::generate::{converted, turned};
use geometry::{CellKind, Mesh, pieces, quality};
use mesh_files::{Format, GmshVersion};

use crate::cli::args::{ConvertArgs, MeshAction};
use crate::cli::errors::{input, spare};
use crate::cli::text::row;
use crate::error::Failure;
use info::info;

/// Unit in which files are read and written, m; their coordinates stay the same.
const MILLIMETRE: f64 = 1e-3;

/// Runs one mesh command.
pub fn act(action: &MeshAction) -> Result<(), Failure> {
    match action {
        MeshAction::Info { files, unit, format } => {
            // Every file is reported; the first invalid one gives the exit code.
            let each = files.iter().map(|file| info(file, *unit, *format));
            each.fold(Ok(()), Result::and)
        }
        MeshAction::Make(args) => make::make(args),
        MeshAction::Convert(args) => convert(args),
    }
}

fn convert(args: &ConvertArgs) -> Result<(), Failure> {
    let ConvertArgs { from, to, element, drop_unused, join, turn, version } = args;
    let format = format(to, *version)?;
    let read = if *drop_unused { mesh_files::read_without_unused } else { mesh_files::read };
    let mesh = read(from, MILLIMETRE).map_err(input)?;
    let mesh = if *turn { turned(&mesh) } else { mesh };
    quality::check(&mesh)
        .map_err(|bad| input(format!("{}: {}", from.display(), mesh_files::inverted(from, &bad))))?;
    spare(to)?;
    let (mesh, joined) = if *join { joined(mesh, from)? } else { (mesh, String::new()) };
    let mesh = match element.as_deref() {
        None => mesh,
        Some(name) => into(mesh, name)?,
    };
    mesh_files::write_as(&mesh, to, MILLIMETRE, format).map_err(input)?;
    let boundary = if format == Format::Stl { "the boundary of " } else { "" };
    println!(
        "{}: {boundary}{} nodes, {} cells{joined}",
        to.display(),
        mesh.points().len(),
        mesh.cell_count()
    );
    let left_out = mesh_files::left_out(from);
    mesh_files::summary(&left_out).iter().for_each(|line| row("left out", line));
    Ok(())
}

/// Joins the pieces of a mesh; returns the mesh and the text to print.
fn joined(mesh: Mesh, from: &Path) -> Result<(Mesh, String), Failure> {
    let count = pieces::count(&mesh);
    let Some((mesh, faces)) = pieces::join(&mesh) else {
        let problem =
            format!("{}: --join found no coincident faces of two pieces ({count} pieces)", from.display());
        return Err(input(problem));
    };
    Ok((mesh, format!("; {count} pieces joined at {faces} faces")))
}

/// Returns the output format; a version applies only to Gmsh.
fn format(to: &Path, version: Option<GmshVersion>) -> Result<Format, Failure> {
    match (Format::of(to).map_err(input)?, version) {
        (Format::Gmsh(_), Some(version)) => Ok(Format::Gmsh(version)),
        (format, None) => Ok(format),
        (_, Some(_)) => Err(input(format!(
            "{}: --version applies to Gmsh's format only; write a .msh file",
            to.display()
        ))),
    }
}

fn into(mesh: Mesh, name: &str) -> Result<Mesh, Failure> {
    let Some(kind) = CellKind::ALL.into_iter().find(|kind| kind.name() == name) else {
        let problem = format!("no element '{name}'; give {}", CellKind::ALL.map(CellKind::name).join(", "));
        return Err(Failure::Input(problem));
    };
    let from = mesh.uniform_kind().map_or("mixed", CellKind::name);
    converted(mesh, kind).ok_or_else(|| Failure::Input(format!("{from} cells can't be converted to {name}")))
}
