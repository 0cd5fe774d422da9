//! Faces under a dead pressure that rotate or stretch: the pressure keeps the direction and the area of the
//! undeformed faces.

use catalogue::warning;
use fem::SurfaceRule;
use geometry::{Facet, Point3, Vector3};

use super::solved::Solved;
use crate::discretise::place::{self, Patch};
use crate::error::Failure;
use crate::outcome::Warning;
use crate::scenario::setup::{Applied, Load, ScalarField, SurfaceLoad};

/// Rotation of a face (degrees) and relative change of its area above which a pressure on the deformed
/// surface is a different load.
const TURN: f64 = 10.0;
const STRETCH: f64 = 0.1;

/// Rotation and stretch of the faces of a load.
#[derive(Default)]
struct Dead {
    /// Largest angle between a face and its undeformed state, degrees.
    turn: f64,
    /// Largest relative change of the area of a face, signed.
    stretch: f64,
    /// Largest change of a directed area relative to the area.
    change: f64,
}

/// Warns of pressures whose faces rotate or stretch beyond the limits in any recorded state, unless an exact
/// solution has the same load.
pub(super) fn warnings(run: &Solved) -> Result<Vec<Warning>, Failure> {
    let mut found = Vec::new();
    for load in &run.setup.loads {
        let Applied::Surface(SurfaceLoad::Pressure(pressure)) = &load.applied else { continue };
        if load.follows || is_exact(run, load, pressure)? {
            continue;
        }
        let Dead { turn, stretch, change } = dead(run, load, pressure)?;
        if turn > TURN || stretch.abs() > STRETCH {
            let message = format!(
                "acts along the normals and on the areas of the undeformed faces, which turn by up to {turn:.1} \
                 degrees and change their area by up to {:+.1} %: a pressure on the deformed surface is a different \
                 load, which a law of large strain has without dead = true. If a force of fixed direction is \
                 intended, give a traction",
                100.0 * stretch
            );
            let key = format!("{}.pressure", load.key);
            found.push(Warning::new(&warning::DEAD_PRESSURE, change, key, message));
        }
    }
    Ok(found)
}

/// Whether an exact solution has this pressure on the undeformed faces, up to [`STRETCH`]: one of small strain has
/// no others.
fn is_exact(run: &Solved, load: &Load, pressure: &ScalarField) -> Result<bool, Failure> {
    let Some(exact) = run.setup.exact.as_deref() else { return Ok(false) };
    if !exact.is_large_strain() {
        return Ok(true);
    }
    let mesh = run.method.mesh();
    let Patch { whole, .. } = place::patch(&load.key, &load.place, mesh)?;
    let surface = fem::surface_rows(mesh, &whole, &SurfaceRule::STANDARD)?;
    let (mut all, mut off) = (0.0, 0.0);
    for ((x, n), w) in surface.points().iter().zip(surface.normals()).zip(surface.weights()) {
        let given = -n * pressure(x).map_err(Failure::Run)?;
        all += w * given.norm_squared();
        off += w * (exact.traction(x, n) - given).norm_squared();
    }
    // A place that only cuts faces has none to compare.
    Ok(all > 0.0 && off <= STRETCH * STRETCH * all)
}

fn dead(run: &Solved, load: &Load, pressure: &ScalarField) -> Result<Dead, Failure> {
    let Solved { method, prepared, solution, .. } = *run;
    let Patch { whole, cut } = place::patch(&load.key, &load.place, method.mesh())?;
    let mesh = method.mesh();
    let acts = |face: &[Point3]| face.iter().any(|x| pressure(x).is_ok_and(|p| p != 0.0));
    // The corners of whole faces are nodes of a method that interpolates: no point has to be located.
    let (nodal, other): (Vec<Facet>, Vec<Facet>) = whole.into_iter().partition(|_| method.interpolates);
    let nodal: Vec<Vec<u32>> = (nodal.into_iter())
        .filter(|facet| acts(&place::corners(mesh, *facet)))
        .map(|facet| mesh.facet_corners(facet).collect())
        .collect();
    let other = other.into_iter().map(|facet| place::corners(mesh, facet));
    let faces = other.chain(cut.into_iter().map(|triangle| triangle.corners.to_vec()));
    let faces: Vec<Vec<Point3>> = faces.filter(|face| acts(face)).collect();
    let points: Vec<Point3> = faces.iter().flatten().copied().collect();
    let (rows, _) = prepared.source.at_points(&points)?;
    let recorded = solution.history.iter().flat_map(|history| &history.fields);
    let mut dead = Dead::default();
    for field in recorded.chain([&solution.u]) {
        for face in &nodal {
            let before: Vec<Point3> = face.iter().map(|&node| mesh.points()[node as usize]).collect();
            let now: Vec<Point3> =
                before.iter().zip(face).map(|(x, &node)| x + field[node as usize]).collect();
            dead.add(directed_area(&before), directed_area(&now));
        }
        let moved = rows.rows().apply(field);
        let mut moved = points.iter().zip(&moved).map(|(x, u)| x + u);
        for face in &faces {
            let now: Vec<Point3> = moved.by_ref().take(face.len()).collect();
            dead.add(directed_area(face), directed_area(&now));
        }
    }
    Ok(dead)
}

impl Dead {
    fn add(&mut self, before: Vector3, now: Vector3) {
        let stretch = now.norm() / before.norm() - 1.0;
        if stretch.abs() > self.stretch.abs() {
            self.stretch = stretch;
        }
        self.turn = self.turn.max(before.angle(&now).to_degrees());
        self.change = self.change.max((now - before).norm() / before.norm());
    }
}

/// Area (m^2) times normal of a face, summed over triangles from its first corner.
fn directed_area(corners: &[Point3]) -> Vector3 {
    corners[1..].windows(2).map(|pair| (pair[0] - corners[0]).cross(&(pair[1] - corners[0])) / 2.0).sum()
}
