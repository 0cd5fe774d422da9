//! Bounds of all results of a scene on one mesh.

use fem::FaceNumbers;
use geometry::Mesh;

use super::body::{tetrahedra, vertex_count};
use super::conforming::Compatible;
use super::equilibrated::Balanced;
use super::field::{Field, enclosed, on_sphere};
use super::on_faces::OnFaces;
use super::result::{Bounded, Bounds, Bracket};
use crate::discretise::Discretisation;
use crate::error::{Failure, Key};
use crate::scenario::setup::Setup;

/// Most tetrahedra: each brings 18 unknowns to the factored system of the stress field.
pub(crate) const MOST_CELLS: usize = 30_000;

/// Computes the bounds on the tetrahedra of a method's mesh.
///
/// # Errors
/// A problem whose solution the fields of these tetrahedra do not enclose, located at its key of the scene.
pub(crate) fn bounds(method: &Discretisation, setup: &Setup) -> Result<Bounds, Failure> {
    let finer = tetrahedra(method)?;
    let mesh: &Mesh = finer.mesh();
    if mesh.cell_count() > MOST_CELLS {
        let problem = format!("takes {} tetrahedra; at most {MOST_CELLS} are supported", mesh.cell_count());
        return Err(Failure::input(Key::Scene("output.bounds".into()), problem, "take a coarser mesh"));
    }
    let faces = FaceNumbers::new(mesh);
    let on_faces = OnFaces::new(&faces, mesh, setup)?;
    let compatible = Compatible::new(&finer, setup, &on_faces)?;
    let balanced = Balanced::new(&faces, mesh, setup, &on_faces)?;
    let dofs = [compatible.dofs(), balanced.dofs()];
    let causes = 2 + 3 * setup.output.means.len();
    let fields = |weights: &[f64]| -> Result<[Field; 2], Failure> {
        Ok([compatible.field(weights)?, balanced.field(weights)?])
    };
    let unit = |cause: usize| -> Vec<f64> { (0..causes).map(|k| f64::from(u8::from(k == cause))).collect() };
    let acts = [on_faces.moves(), on_faces.is_loaded()].map(|acts| f64::from(u8::from(acts)));
    let given: Vec<f64> = (0..causes).map(|k| acts.get(k).copied().unwrap_or(0.0)).collect();

    // An energy is never negative. The potential of loads is the negative energy.
    let mut energy = Bracket::default();
    let whole = fields(&given)?;
    let (both, of_whole) = (on_faces.moves() && on_faces.is_loaded(), enclosed(&whole));
    // Of a single cause, the fields are those of the given ones.
    let alone =
        |cause: usize| if both { Ok(enclosed(&fields(&unit(cause))?)) } else { Ok::<_, Failure>(of_whole) };
    if on_faces.moves() {
        let moved = alone(0)?;
        energy = Bracket { lower: moved.lower.max(0.0), upper: moved.upper };
    }
    if on_faces.is_loaded() {
        let loaded = alone(1)?;
        energy.lower += (-loaded.upper).max(0.0);
        energy.upper -= loaded.lower;
    }
    if both {
        let other = on_sphere(&whole);
        energy = Bracket { lower: energy.lower.max(other.lower), upper: energy.upper.min(other.upper) };
    }
    let mut results = vec![(Bounded::Energy, energy)];
    results.extend(on_faces.conjugate().map(|(of, size)| (of, energy.scaled(2.0 / size))));
    for (k, cause) in (2..causes).enumerate() {
        let own = enclosed(&fields(&unit(cause))?);
        let scale = scale(&of_whole, &own);
        let pair = |sign: f64| {
            let mut weights: Vec<f64> = given.iter().map(|weight| scale * weight).collect();
            weights[cause] = sign / scale;
            Ok::<_, Failure>(enclosed(&fields(&weights)?))
        };
        // The potentials with and against the unit load differ by twice its work.
        let (with, against) = (pair(1.0)?, pair(-1.0)?);
        let bracket =
            Bracket { lower: (against.lower - with.upper) / 2.0, upper: (against.upper - with.lower) / 2.0 };
        results.push((Bounded::Mean { index: k / 3, axis: k % 3 }, bracket));
    }
    Ok(Bounds { results, vertices: vertex_count(mesh), cells: mesh.cell_count(), dofs })
}

/// Factor of the given causes, the inverse of that of a unit load, with which the bounds of the load's work
/// are narrowest: both then have gaps of the same size.
fn scale(given: &Bracket, unit: &Bracket) -> f64 {
    let ratio = (unit.upper - unit.lower) / (given.upper - given.lower);
    if ratio > 0.0 && ratio.is_finite() { ratio.powf(0.25) } else { 1.0 }
}
