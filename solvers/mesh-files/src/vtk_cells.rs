//! Cells by VTK type, as in `.vtu` and `.vtk` files.

use geometry::{CellKind, FaceKind};

use crate::content::Content;
use crate::error::{Parsed, Place, Problem, ascending};
use crate::left_out::{Kind, LeftOut};
use crate::rows::Row;

/// Names of cell arrays that number regions, by the programs that write them, compared without regard to
/// case. The first row is the name used by this crate. Names in one row are synonyms: several such arrays in
/// one grid have to agree.
const REGIONS: [&[&str]; 8] = [
    &["region"],
    &["gmsh:physical"],
    &["physical"],
    &["medit:ref"],
    &["CellEntityIds"],
    &["MaterialIDs", "MaterialID", "material"],
    &["RegionId"],
    &["ElementBlockIds"],
];

/// Cell types that are read, for the message about other types.
fn known() -> String {
    let solids = ascending(CellKind::ALL.map(|kind| kind.entry().files.vtk));
    let faces = ascending(FaceKind::ALL.map(FaceKind::vtk));
    format!("supported types: {solids} (solids), {faces} (faces), lines and points")
}

/// An array with one number per cell.
#[derive(Clone)]
pub(super) struct Array {
    pub name: String,
    /// Place of the array in the file.
    pub place: Place,
    pub values: Vec<f64>,
}

/// Finds the first known array of region numbers in a grid; `array` looks up an array by name, without regard
/// to case.
pub(super) fn regions(array: impl Fn(&str) -> Parsed<Option<Array>>) -> Parsed<Option<Array>> {
    for names in REGIONS {
        let found: Vec<Option<Array>> = names.iter().map(|name| array(name)).collect::<Parsed<_>>()?;
        let mut found = found.into_iter().flatten();
        if let Some(first) = found.next() {
            found.try_for_each(|other| first.agree(&other))?;
            return Ok(Some(first));
        }
    }
    Ok(None)
}

impl Array {
    /// Values as integers. Some programs write region numbers as reals.
    ///
    /// # Errors
    /// A value that is not whole, or that exceeds 2^53.
    pub fn whole(&self) -> Parsed<Vec<i64>> {
        // Reals beyond 2^53 have no fractional part.
        let is_whole = |value: f64| value.fract() == 0.0 && value.abs() <= 9_007_199_254_740_992.0;
        match self.values.iter().position(|&value| !is_whole(value)) {
            None => Ok(self.values.iter().map(|&value| value as i64).collect()),
            Some(cell) => {
                let array = self.name.clone();
                let value = self.values[cell].to_string();
                Err((self.place, Problem::NotWhole { array, cell, value }))
            }
        }
    }

    /// Rejects another array with different numbers.
    fn agree(&self, other: &Array) -> Parsed<()> {
        let (own, others) = (self.whole()?, other.whole()?);
        let Some(cell) = own.iter().zip(&others).position(|(a, b)| a != b) else { return Ok(()) };
        let arrays = [self.name.clone(), other.name.clone()];
        Err((other.place, Problem::TwoRegions { arrays, cell, values: [own[cell], others[cell]] }))
    }
}

/// Describes an array that is not used; `taken` states whether another array provides the regions.
pub(super) fn lost(array: &Array, of_cells: bool, taken: bool) -> LeftOut {
    let whole = array.values.iter().all(|value| value.fract() == 0.0);
    let (low, high) =
        array.values.iter().fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x)));
    let regions = of_cells && !taken && whole && low < high;
    let of = if of_cells { "cells" } else { "points" };
    let (kind, range) =
        if regions { (Kind::Regions, format!(", {low} to {high}")) } else { (Kind::Values, String::new()) };
    LeftOut { place: array.place, what: format!("array '{}' of {of}{range}", array.name), kind }
}

/// Cells of a VTK grid: the type and the points of each, with its region and groups.
pub(super) struct Cells {
    /// Number of points in the preceding grids of the file, from which the indices in `list` count.
    pub first: u64,
    pub types: Vec<i64>,
    /// End of the points of each cell in `list`.
    pub ends: Vec<usize>,
    pub list: Vec<i64>,
    /// Region number of each cell.
    pub regions: Option<Vec<i64>>,
    /// Surface number of each cell; negative for none.
    pub surfaces: Option<Vec<i64>>,
    /// Named groups of cells that may cross regions. Each has one number per cell, positive for its members.
    pub further: Vec<(String, Vec<i64>)>,
}

impl Cells {
    /// Adds solids and faces; names are indexed by the numbers of regions and surfaces.
    pub(super) fn add_to(
        &self,
        content: &mut Content,
        region_names: &[String],
        surface_names: &[String],
    ) -> Parsed<()> {
        let value = |of: &Option<Vec<i64>>, cell: usize| of.as_ref().map(|values| values[cell]);
        let offset = content.element_count() as u64;
        let mut start = 0;
        for (cell, (&kind, &end)) in self.types.iter().zip(&self.ends).enumerate() {
            let row = Row { place: Place::Cell(cell), tag: offset + cell as u64 };
            let own = &self.list[start..end];
            let nodes: Option<Vec<u64>> =
                own.iter().map(|&node| Some(self.first + u64::try_from(node).ok()?)).collect();
            let Some(nodes) = nodes else {
                let expected = "node numbers of 0 or more";
                return Err((row.place, Problem::Expected { expected, found: format!("{own:?}") }));
            };
            start = end;
            match of_type(kind) {
                Some((count, _)) if count != nodes.len() => {
                    let kind = kind.to_string();
                    let found = nodes.len();
                    let problem = Problem::Length { element: row.tag, kind, found, expected: count };
                    return Err((row.place, problem));
                }
                Some((_, What::Cell(kind))) => {
                    let region = value(&self.regions, cell);
                    let name = region.map_or("body".into(), |v| name_of(region_names, v, "region"));
                    let region = content.region(row.place, &name)?;
                    content.cell(row, kind, region, &nodes, kind.entry().files.vtk_order)?;
                    if kind.entry().cell.vtk_either {
                        content.turn_if_inverted(kind);
                    }
                    let index = content.cell_count() as u32 - 1;
                    for (name, _) in self.further.iter().filter(|(_, values)| values[cell] > 0) {
                        content.also(row.place, name, &[index])?;
                    }
                }
                Some((_, What::Face(corners))) => {
                    let of_face = value(&self.surfaces, cell).or_else(|| value(&self.regions, cell));
                    match of_face.filter(|&v| v >= 0) {
                        Some(v) => {
                            let group = content.group(&name_of(surface_names, v, "surface"));
                            content.face(row, &[group], &nodes, corners)?;
                        }
                        None => content.element(row, &nodes)?,
                    }
                }
                None if THIN.contains(&kind) => content.element(row, &nodes)?,
                None => {
                    let kind = kind.to_string();
                    return Err((row.place, Problem::UnknownType { element: row.tag, kind, known: known() }));
                }
            }
        }
        Ok(())
    }
}

/// Number of nodes and class of a VTK cell type.
fn of_type(kind: i64) -> Option<(usize, What)> {
    let cell = CellKind::ALL.into_iter().find(|cell| i64::from(cell.entry().files.vtk) == kind);
    let face = || FaceKind::ALL.into_iter().find(|face| i64::from(face.vtk()) == kind);
    cell.map(|cell| (cell.node_count(), What::Cell(cell)))
        .or_else(|| face().map(|face| (face.node_count(), What::Face(face.corner_count()))))
}

enum What {
    Cell(CellKind),
    /// A face with its number of corners.
    Face(usize),
}

/// Types of points and lines.
const THIN: [i64; 5] = [1, 2, 3, 4, 21];

fn name_of(names: &[String], value: i64, plain: &str) -> String {
    let known = usize::try_from(value).ok().and_then(|at| names.get(at));
    known.cloned().unwrap_or_else(|| format!("{plain}-{value}"))
}
