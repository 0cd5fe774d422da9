//! The body in a file: its extent, named surfaces, and points inside.

use std::path::Path;

use geometry::surface::{BoundaryFaces, Treatment};
use geometry::{Point3, Surface};

use super::args::Side;
use super::meshes::Meshes;
use crate::cli::args::LengthUnit;
use crate::cli::errors::input;
use crate::error::Failure;

/// Number of grid points along each axis in the search for the middle of a bent body.
const GRID: usize = 11;
/// Smallest depth of probes over the body's smallest extent: coarse meshes cut off the surface.
const BELOW: f64 = 0.05;

/// Number of intervals between a tip and the middle in the search for a probe.
const STRIDES: i32 = 20;

/// A body to be pressed by a plate.
pub(super) struct Organ {
    /// Boundary of the body, m.
    pub surface: Surface,
    /// Named surfaces of the file.
    pub names: Vec<String>,
    /// Lowest and highest corner of the bounding box, m.
    pub bounds: [Point3; 2],
}

impl Organ {
    /// Reads a closed surface or a mesh.
    pub fn read(file: &Path, unit: LengthUnit, treatment: Treatment) -> Result<Organ, Failure> {
        let (surface, names) = if mesh_files::is_surface(file) {
            let surface = mesh_files::read_treated(file, unit.metres, treatment).map_err(input)?.surface;
            let names = surface.groups().names().to_vec();
            (surface, names)
        } else if treatment != Treatment::AsGiven {
            let option = if treatment == Treatment::Repair { "--repair" } else { "--wrap" };
            let name = file.display();
            return Err(input(format!("{option}: {name} is not a surface; {}", mesh_files::SURFACES)));
        } else {
            let mesh = mesh_files::read(file, unit.metres).map_err(input)?;
            let boundary = BoundaryFaces::new(&mesh);
            let boundary = boundary.map_err(|bad| input(format!("{}: {bad}", file.display())))?;
            (boundary.surface, mesh.group_names().map(String::from).collect())
        };
        let bounds = surface.bounds();
        Ok(Organ { surface, names, bounds })
    }

    /// Returns the length of the bounding box along an axis, m.
    pub fn extent(&self, axis: usize) -> f64 {
        self.bounds[1][axis] - self.bounds[0][axis]
    }

    /// Returns the smallest extent of the bounding box, m.
    pub fn smallest_extent(&self) -> f64 {
        (0..3).map(|axis| self.extent(axis)).fold(f64::MAX, f64::min)
    }

    /// Returns the largest extent of the bounding box, m.
    pub fn largest_extent(&self) -> f64 {
        (0..3).map(|axis| self.extent(axis)).fold(0.0, f64::max)
    }

    /// Returns the point that a plate from this side touches first, m.
    pub fn first_touched(&self, side: Side) -> Point3 {
        let ahead = |p: &Point3| side.sign() * p[side.axis()];
        let first = self.surface.points()[0];
        self.surface.points().iter().fold(first, |best, p| if ahead(p) > ahead(&best) { *p } else { best })
    }

    /// Returns a probe close to the plate, inside all meshes, m. The probe lies just below the first point of
    /// contact. If coarse meshes cut off a tip there, the probe lies between the tip and the middle.
    pub fn near(&self, side: Side, meshes: &Meshes) -> Point3 {
        let (tip, middle) = (self.first_touched(side), self.middle(meshes));
        let below = BELOW * self.smallest_extent();
        let mut straight = tip;
        straight[side.axis()] -= side.sign() * below;
        let on_the_way = (1..STRIDES).map(|k| tip + (middle - tip) * (f64::from(k) / f64::from(STRIDES)));
        let inside = std::iter::once(straight)
            .chain(on_the_way)
            .find(|p| self.depth(p) > 0.5 * below && meshes.all_have(p));
        inside.unwrap_or(middle)
    }

    /// Returns the centre of the bounding box, m. If that is not well inside (a bent body), returns the
    /// deepest grid point that is inside all meshes.
    pub fn middle(&self, meshes: &Meshes) -> Point3 {
        let middle = nalgebra::center(&self.bounds[0], &self.bounds[1]);
        if self.depth(&middle) > 2.0 * BELOW * self.smallest_extent() && meshes.all_have(&middle) {
            return middle;
        }
        let at =
            |k: usize, axis: usize| self.bounds[0][axis] + self.extent(axis) * (k as f64 + 0.5) / GRID as f64;
        let grid = (0..GRID.pow(3))
            .map(|k| Point3::new(at(k % GRID, 0), at(k / GRID % GRID, 1), at(k / GRID / GRID, 2)));
        let mut inside: Vec<(f64, Point3)> =
            grid.map(|p| (self.depth(&p), p)).filter(|(depth, _)| *depth > 0.0).collect();
        inside.sort_by(|a, b| b.0.total_cmp(&a.0));
        inside.into_iter().map(|(_, p)| p).find(|p| meshes.all_have(p)).unwrap_or(middle)
    }

    fn depth(&self, p: &Point3) -> f64 {
        -self.surface.signed_distance(p)
    }
}
