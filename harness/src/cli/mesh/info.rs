//! `tissuebench mesh info`: prints the contents of a file and the quality of its cells, as a table or JSON.

use std::path::Path;

use geometry::quality::CellShape;
use geometry::surface::Region;
use geometry::{CellKind, Facet, Mesh, Point3, Surface, Vector3, pieces, quality};
use mesh_files::Row;
use serde_json::{Value, json};

use crate::cli::args::{Format, LengthUnit};
use crate::cli::errors::input;
use crate::cli::text::{digits, row};
use crate::error::Failure;

/// Unit of printed volumes (cubed) and areas (squared), m.
const CENTIMETRE: f64 = 1e-2;
/// Lower bounds of the bins of the aspect histogram.
const ASPECTS: [f64; 6] = [1.0, 1.5, 2.0, 3.0, 5.0, 10.0];
/// Number of worst cells listed.
const WORST: usize = 5;
/// Range of lengths of organs and tissue specimens, m.
const LONG: [f64; 2] = [5e-3, 1.0];

/// Prints the contents of a mesh or surface file. Inverted cells are an error.
pub fn info(file: &Path, unit: LengthUnit, format: Format) -> Result<(), Failure> {
    if mesh_files::is_surface(file) {
        let surface = mesh_files::read_surface(file, unit.metres).map_err(input)?;
        return of_surface(file, &surface, unit, format);
    }
    let bytes =
        disk::read(file, disk::Kind::MESH).map_err(|bad| input(format!("{}: {bad}", file.display())))?;
    let (mesh, rows) = mesh_files::read_bytes(&bytes, file, unit.metres).map_err(input)?;
    let found = Found::new(&mesh, rows);
    match format {
        Format::Json => println!("{}", found.json(file, unit)),
        Format::Table => {
            found.table(file, unit);
            for (at, line) in mesh_files::summary(&mesh_files::left_out(file)).iter().enumerate() {
                row(if at == 0 { "left out" } else { "" }, line);
            }
        }
    }
    match quality::check(&mesh) {
        Ok(_) => Ok(()),
        Err(bad) => Err(input(format!("{}: {}", file.display(), mesh_files::inverted(file, &bad)))),
    }
}

fn of_surface(file: &Path, surface: &Surface, unit: LengthUnit, format: Format) -> Result<(), Failure> {
    let (points, triangles) = (surface.points().len(), surface.triangles().len());
    let [low, high] = surface.bounds();
    let groups = groups(surface);
    if format == Format::Json {
        let named = groups.iter().map(|(name, triangles)| json!({ "name": name, "triangles": triangles }));
        let named: Vec<Value> = named.collect();
        let volume = |region: &Region| json!({ "name": region.name, "volume_m3": region.surface.volume() });
        let regions: Vec<Value> = surface.regions().iter().map(volume).collect();
        let object = json!({
            "file": file, "kind": "surface", "points": points, "triangles": triangles, "area_m2": surface.area(),
            "volume_m3": surface.volume(), "regions": regions, "surfaces": named, "extent_m": extent_json(low, high), "unit": unit.name,
            "unit_guess": guess((high - low).amax(), unit),
        });
        println!("{object}");
        return Ok(());
    }
    println!("{}: a closed surface of {triangles} triangles, {points} corners", file.display());
    for (at, (name, triangles)) in groups.iter().enumerate() {
        row(if at == 0 { "surfaces" } else { "" }, &format!("{name}: {triangles} triangles"));
    }
    row("extent", &extent(low, high, unit));
    row("unit", &of_unit((high - low).amax(), unit));
    row("area", &format!("{} cm^2", digits(surface.area() / CENTIMETRE.powi(2))));
    row("volume", &format!("{} cm^3", digits(surface.volume() / CENTIMETRE.powi(3))));
    for (at, region) in surface.regions().iter().enumerate() {
        let volume = digits(region.surface.volume() / CENTIMETRE.powi(3));
        row(if at == 0 { "regions" } else { "" }, &format!("{}: {volume} cm^3", region.name));
    }
    row("next", "tissuebench mesh make fills the surface with tetrahedra");
    Ok(())
}

/// Returns the names of a surface's groups, with their numbers of triangles.
fn groups(surface: &Surface) -> Vec<(&str, usize)> {
    let mut found: Vec<(&str, usize)> = surface.groups().names().iter().map(|name| (&**name, 0)).collect();
    for triangle in 0..surface.triangles().len() {
        surface.groups().of(triangle).iter().for_each(|&group| found[group as usize].1 += 1);
    }
    found
}

/// Properties of a mesh.
struct Found<'a> {
    mesh: &'a Mesh,
    rows: Vec<Row>,
    shapes: Vec<CellShape>,
    /// Cells in order from the worst.
    worst: Vec<usize>,
    low: Point3,
    high: Point3,
    /// Number of pieces, and of coincident faces of different pieces.
    pieces: [usize; 2],
}

impl Found<'_> {
    fn new(mesh: &Mesh, rows: Vec<Row>) -> Found<'_> {
        let shapes = quality::shapes(mesh);
        let mut worst: Vec<usize> = (0..shapes.len()).collect();
        worst.sort_by(|&a, &b| shapes[b].aspect.total_cmp(&shapes[a].aspect).then(a.cmp(&b)));
        let first = mesh.points()[0];
        let (low, high) =
            mesh.points().iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
        let pieces = [pieces::count(mesh), pieces::coincident(mesh)];
        Found { mesh, rows, shapes, worst, low, high, pieces }
    }

    fn volume(&self) -> f64 {
        self.shapes.iter().map(|shape| shape.volume).sum()
    }

    /// Returns the number of cells of each kind present.
    fn kinds(&self) -> Vec<(&'static str, usize)> {
        let count = |kind| (0..self.mesh.cell_count()).filter(|&c| self.mesh.kind(c) == kind).count();
        let kinds = CellKind::ALL.map(|kind| (kind.name(), count(kind)));
        kinds.into_iter().filter(|(_, count)| *count > 0).collect()
    }

    /// Returns cells and volume (m^3) of each region and of each group of cells.
    fn regions(&self) -> Vec<(&str, usize, f64)> {
        let mut found: Vec<_> = self.mesh.region_names().iter().map(|name| (name.as_str(), 0, 0.0)).collect();
        for (cell, shape) in self.shapes.iter().enumerate() {
            let region = &mut found[self.mesh.region(cell) as usize];
            (region.1, region.2) = (region.1 + 1, region.2 + shape.volume);
        }
        let of_groups = self.mesh.cell_groups().map(|(name, cells)| {
            (name, cells.len(), cells.iter().map(|&cell| self.shapes[cell as usize].volume).sum())
        });
        found.into_iter().chain(of_groups).collect()
    }

    /// Describes pieces without a common node, if there are several, and their coincident faces.
    fn apart(&self) -> Option<String> {
        let [count, faces] = self.pieces;
        let join = if faces > 0 { " (join = true in a scene's body, or mesh convert --join)" } else { "" };
        (count > 1).then(|| format!("{count} pieces that share no node, {faces} coincident faces{join}"))
    }

    /// Returns faces and area (m^2) of each named surface.
    fn surfaces(&self) -> Vec<(&str, usize, f64)> {
        let of = |name| self.mesh.group(name).unwrap_or_default();
        let area = |name| of(name).iter().map(|&facet| area(self.mesh, facet)).sum();
        self.mesh.group_names().map(|name| (name, of(name).len(), area(name))).collect()
    }

    /// Returns the number of cells in each bin of aspects.
    fn histogram(&self) -> [usize; ASPECTS.len()] {
        let mut counts = [0; ASPECTS.len()];
        for shape in &self.shapes {
            counts[ASPECTS.partition_point(|&from| from <= shape.aspect).saturating_sub(1)] += 1;
        }
        counts
    }

    fn table(&self, file: &Path, unit: LengthUnit) {
        let cubed = |volume: f64| digits(volume / CENTIMETRE.powi(3));
        println!("{}: {} nodes, {} cells", file.display(), self.mesh.points().len(), self.mesh.cell_count());
        let kinds: Vec<String> = self.kinds().iter().map(|(name, count)| format!("{count} {name}")).collect();
        row("cells", &kinds.join(", "));
        for (at, (name, cells, volume)) in self.regions().into_iter().enumerate() {
            row(
                if at == 0 { "regions" } else { "" },
                &format!("{name}: {cells} cells, {} cm^3", cubed(volume)),
            );
        }
        if let Some(line) = self.apart() {
            row("pieces", &line);
        }
        let surfaces = self.surfaces();
        if surfaces.is_empty() {
            row("surfaces", "none (select with where)");
        }
        for (at, (name, faces, area)) in surfaces.into_iter().enumerate() {
            let area = digits(area / CENTIMETRE.powi(2));
            row(if at == 0 { "surfaces" } else { "" }, &format!("{name}: {faces} faces, {area} cm^2"));
        }
        for (at, (name, nodes)) in self.mesh.node_groups().enumerate() {
            row(if at == 0 { "node sets" } else { "" }, &format!("{name}: {} nodes", nodes.len()));
        }
        row("extent", &extent(self.low, self.high, unit));
        row("unit", &of_unit((self.high - self.low).amax(), unit));
        let volumes = || self.shapes.iter().map(|shape| shape.volume);
        let (least, most) = (volumes().fold(f64::MAX, f64::min), volumes().fold(f64::MIN, f64::max));
        row(
            "volume",
            &format!("{} cm^3; cells of {} to {} cm^3", cubed(self.volume()), cubed(least), cubed(most)),
        );
        let [sharp, blunt] = self.angles();
        row("angles", &format!("{sharp:.1} to {blunt:.1} degrees between two faces of a cell"));
        let from: Vec<String> = ASPECTS.iter().map(|aspect| format!("{aspect:>8}")).collect();
        row("aspect", &format!("{}  and more (a regular cell has 1)", from.join("")));
        let counts: Vec<String> = self.histogram().iter().map(|count| format!("{count:>8}")).collect();
        row("", &counts.join(""));
        for (at, &cell) in self.worst.iter().take(WORST).enumerate() {
            let CellShape { aspect, angles: [sharp, blunt], .. } = self.shapes[cell];
            let aspect = if aspect.is_finite() { format!("aspect {aspect:.2}") } else { "inverted".into() };
            let line = format!("{aspect}, angles {sharp:.1} to {blunt:.1}, {}", self.rows[cell]);
            row(if at == 0 { "worst" } else { "" }, &line);
        }
    }

    /// Returns the smallest and the largest dihedral angle, degrees.
    fn angles(&self) -> [f64; 2] {
        let all = self.shapes.iter().map(|shape| shape.angles);
        all.fold([f64::MAX, f64::MIN], |[low, high], [a, b]| [low.min(a), high.max(b)])
    }

    fn json(&self, file: &Path, unit: LengthUnit) -> Value {
        let kinds: serde_json::Map<String, Value> =
            self.kinds().into_iter().map(|(name, count)| (name.into(), count.into())).collect();
        let regions = self.regions().into_iter();
        let regions: Vec<Value> = regions
            .map(|(name, cells, volume)| json!({ "name": name, "cells": cells, "volume_m3": volume }))
            .collect();
        let surfaces = self.surfaces().into_iter();
        let surfaces: Vec<Value> = surfaces
            .map(|(name, faces, area)| json!({ "name": name, "faces": faces, "area_m2": area }))
            .collect();
        let bins = ASPECTS.iter().zip(self.histogram());
        let bins: Vec<Value> = bins.map(|(from, cells)| json!({ "from": from, "cells": cells })).collect();
        let worst = self.worst.iter().take(WORST).map(|&cell| {
            let (row, shape) = (self.rows[cell], self.shapes[cell]);
            let aspect = shape.aspect.is_finite().then_some(shape.aspect);
            json!({
                "element": row.tag, "place": row.place.to_string(), "aspect": aspect, "angles_degrees": shape.angles,
                "volume_m3": shape.volume,
            })
        });
        let worst: Vec<Value> = worst.collect();
        json!({
            "file": file, "kind": "mesh", "nodes": self.mesh.points().len(), "cells": self.mesh.cell_count(),
            "kinds": kinds, "pieces": self.pieces[0], "coincident_faces": self.pieces[1], "regions": regions, "surfaces": surfaces, "extent_m": extent_json(self.low, self.high),
            "unit": unit.name, "unit_guess": guess((self.high - self.low).amax(), unit), "volume_m3": self.volume(),
            "angles_degrees": self.angles(), "aspects": bins, "worst": worst, "left_out": mesh_files::summary(&mesh_files::left_out(file)),
        })
    }
}

/// Returns the area of a face (m^2), approximated by flat triangles around the mean of its corners.
fn area(mesh: &Mesh, facet: Facet) -> f64 {
    let corners: Vec<Vector3> = mesh.facet_corners(facet).map(|n| mesh.points()[n as usize].coords).collect();
    let mean = corners.iter().sum::<Vector3>() / corners.len() as f64;
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| 0.5 * (a - mean).cross(&(b - mean)).norm()).sum()
}

/// Formats the bounding box in the file's unit, as used in `where`.
fn extent(low: Point3, high: Point3, unit: LengthUnit) -> String {
    let axes = ["x", "y", "z"].into_iter().enumerate().map(|(axis, name)| {
        // Rounding turns the coordinate of a corner at the origin into 1e-17.
        let end = |x: f64| digits(if x.abs() < 1e-9 { 0.0 } else { x });
        let [low, high] = [low, high].map(|p| end(p[axis] / unit.metres));
        format!("{name} = {low} to {high}")
    });
    format!("{} {}", axes.collect::<Vec<_>>().join(", "), unit.name)
}

fn extent_json(low: Point3, high: Point3) -> [[f64; 2]; 3] {
    [0, 1, 2].map(|axis| [low[axis], high[axis]])
}

/// Returns the unit in which a body is as long as organs are. `longest` is its longest extent (m, read in
/// `unit`). `unit` itself is preferred; `None` if no unit fits.
pub(crate) fn guess(longest: f64, unit: LengthUnit) -> Option<&'static str> {
    let own = longest / unit.metres;
    let known = [(unit.name, unit.metres), ("mm", 1e-3), ("cm", 1e-2), ("m", 1.0), ("um", 1e-6)];
    let fits = |metres: f64| (LONG[0]..=LONG[1]).contains(&(own * metres));
    known.into_iter().find(|(_, metres)| fits(*metres)).map(|(name, _)| name)
}

fn of_unit(longest: f64, unit: LengthUnit) -> String {
    let own = digits(longest / unit.metres);
    match guess(longest, unit) {
        Some(name) if name == unit.name => {
            format!("{name}: {own} {name} long, a plausible length for an organ")
        }
        Some(name) => format!("{own} {} long: if the file is in {name}, give --unit {name}", unit.name),
        None => format!("{own} {} long; organs are 5 mm to 1 m", unit.name),
    }
}
