//! `tissuebench mesh make`: fills a closed surface with tetrahedra.

use geometry::stuffing::{self, Stuffed, Stuffing};
use geometry::surface::{Gaps, Treated, Treatment};
use geometry::{Mesh, Surface, quality};

use crate::cli::args::MakeArgs;
use crate::cli::errors::{input, spare};
use crate::cli::text::{digits, row};
use crate::error::Failure;

/// Relative difference between requested and actual node count above which the request is printed.
const NEAR: f64 = 0.1;

/// Fills a surface, writes the mesh and prints how closely it fits.
pub fn make(args: &MakeArgs) -> Result<(), Failure> {
    let MakeArgs { surface: files, unit, out, .. } = args;
    let treatment = treatment(args)?;
    let treated = mesh_files::read_together(files, unit.metres, treatment).map_err(input)?;
    let surface = &treated.surface;
    let doublings = if args.uniform { 0 } else { args.coarser };
    spare(out)?;
    let (Stuffed { mesh, left_out }, spacing) = match (args.size, args.nodes) {
        (Some(spacing), _) => {
            (stuffing::stuff(surface, Stuffing { spacing, doublings }).map_err(input)?, spacing)
        }
        (_, nodes) => {
            let nodes = nodes.unwrap_or_default() as usize;
            stuffing::stuff_with_nodes(surface, nodes, doublings).map_err(input)?
        }
    };
    mesh_files::write(&mesh, out, unit.metres).map_err(input)?;
    println!("{}: {} nodes, {} cells", out.display(), mesh.points().len(), mesh.cell_count());
    let length = |x: f64| format!("{} {}", digits(x / unit.metres), unit.name);
    let inside = match doublings {
        0 => String::new(),
        doublings => format!(", up to {} times that inside", 1 << doublings),
    };
    if treatment != Treatment::AsGiven {
        report(&treated, args);
    }
    row("surface", &described(surface));
    for (at, name) in surface.groups().names().iter().enumerate() {
        let facets = mesh.group(name).map_or(0, <[_]>::len);
        row(if at == 0 { "surfaces" } else { "" }, &format!("{name}: {facets} faces"));
    }
    if let Some(nodes) = args.nodes {
        wanted(nodes, mesh.points().len());
    }
    row("spacing", &format!("{}{inside}", length(spacing)));
    let fit = stuffing::fit(surface, &mesh);
    let (volume, of_surface) = (1e6 * fit.volume, 1e6 * fit.of_surface);
    let off = 100.0 * (volume / of_surface - 1.0);
    row("volume", &format!("{} cm^3, {off:+.2} % of the surface's {}", digits(volume), digits(of_surface)));
    row(
        "distance",
        &format!(
            "at most {} between mesh and surface (Hausdorff, at points of both)",
            length(fit.hausdorff())
        ),
    );
    regions(surface, &mesh);
    let quality = quality::check(&mesh).map_err(input)?;
    let (sharpest, bluntest) = (quality.min_dihedral.value, quality.max_dihedral.value);
    row("angles", &format!("{sharpest:.1} to {bluntest:.1} degrees between two faces of a cell"));
    if left_out > 0 {
        row(
            "left out",
            &format!("{left_out} parts thinner than the cells; smaller cells would include these parts"),
        );
    }
    Ok(())
}

/// Returns what is done with the surface. Both options are for surfaces only.
fn treatment(args: &MakeArgs) -> Result<Treatment, Failure> {
    let (option, treatment) = match args.wrap {
        Some(size) => ("--wrap", Treatment::Wrap { size }),
        None if args.repair => ("--repair", Treatment::Repair),
        None => return Ok(Treatment::AsGiven),
    };
    if let Some(file) = args.surface.iter().find(|file| file.is_file() && !mesh_files::is_surface(file)) {
        let name = file.display();
        return Err(input(format!("{option}: {name} is not a surface; {}", mesh_files::SURFACES)));
    }
    Ok(treatment)
}

/// Prints the changes of the surface, and how far a wrap is from its triangles.
fn report(treated: &Treated, args: &MakeArgs) {
    let word = if args.wrap.is_some() { "wrap" } else { "repair" };
    let length = |x: f64| format!("{} {}", digits(x / args.unit.metres), args.unit.name);
    let mut lines = Vec::new();
    if let Some(Gaps { from_wrap, from_triangles }) = treated.gaps {
        lines.push(format!("{} cm^3", digits(1e6 * treated.surface.volume())));
        lines.push(format!(
            "at most {} from the given triangles; the triangles at most {} from it",
            length(from_wrap),
            length(from_triangles)
        ));
    } else if treated.changes.is_empty() {
        lines.push("none is needed".into());
    }
    let changes = treated.changes.iter();
    lines.extend(changes.map(|change| if args.quiet { change.brief() } else { change.to_string() }));
    lines.iter().enumerate().for_each(|(at, line)| row(if at == 0 { word } else { "" }, line));
}

/// Prints the requested number of nodes if the mesh differs from it.
fn wanted(nodes: u32, made: usize) {
    if (made as f64 / f64::from(nodes) - 1.0).abs() > NEAR {
        row("wanted", &format!("{nodes} nodes; no tried cell size gives a closer number"));
    }
}

/// Prints the volume of each region, if there are several.
fn regions(surface: &Surface, mesh: &Mesh) {
    let mut volumes = vec![0.0; mesh.region_names().len()];
    for (cell, volume) in quality::volumes(mesh).into_iter().enumerate() {
        volumes[usize::from(mesh.region(cell))] += volume;
    }
    for (at, (region, volume)) in surface.regions().iter().zip(volumes).enumerate() {
        let (volume, of_surface) = (1e6 * volume, 1e6 * region.surface.volume());
        let off = 100.0 * (volume / of_surface - 1.0);
        let line = format!(
            "{}: {} cm^3, {off:+.2} % of the surfaces' {}",
            region.name,
            digits(volume),
            digits(of_surface)
        );
        row(if at == 0 { "regions" } else { "" }, &line);
    }
}

fn described(surface: &Surface) -> String {
    let triangles = surface.triangles().len();
    let area = 1e4 * surface.area();
    format!("{triangles} triangles, {} cm^2, closed", digits(area))
}
