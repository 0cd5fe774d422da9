//! Modal analysis of small free vibrations: the mass matrix and the modes.

use cases::scene;
use explicit::{Lumping, lumped_mass};
use geometry::Vector3;
use statics::{ALL_MODES_LIMIT, Mass, lowest_modes};

use super::problem::Problem;
use super::solution::{Solution, Vibration};
use super::stages::Stages;
use crate::error::{Failure, Key};
use crate::outcome::timing::Meters;
use crate::scenario::setup::Setup;

pub(super) fn stages(setup: &Setup) -> Stages {
    Stages {
        mass: (true, setup.mass.map_or("none given", scene::Mass::name).into()),
        stiffness: (true, format!("small vibrations{}", setup.springs())),
        factorisation: (
            true,
            format!(
                "one: dense for all modes up to {ALL_MODES_LIMIT} unknowns, sparse with block Lanczos for the lowest modes beyond"
            ),
        ),
        no_transfer: Some("modes are compared at the integration points"),
        ..Stages::linear()
    }
}

/// Computes the modes, of which `count` are reported.
pub(super) fn solve(problem: &Problem, count: usize, meters: &mut Meters) -> Result<Solution, Failure> {
    let Some(kind) = problem.setup.mass else {
        let help = "give mass = \"consistent\", \"at-points\", \"lumped\" or \"transformed\"";
        return Err(Failure::input(Key::Method("mass"), "is missing, but vibrations need a mass", help));
    };
    solve_with(problem, count, kind, meters)
}

/// Predicts the modes of other elements by more shape functions. Lumped masses of quadratic elements give
/// frequencies that are no better than those of linear ones.
pub(super) fn predicted(problem: &Problem, count: usize, meters: &mut Meters) -> Result<Solution, Failure> {
    solve_with(problem, count, scene::Mass::Consistent, meters)
}

fn solve_with(
    problem: &Problem,
    count: usize,
    kind: scene::Mass,
    meters: &mut Meters,
) -> Result<Solution, Failure> {
    let Problem { method, setup, prepared, .. } = *problem;
    let Meters { timings, counters, .. } = meters;
    let nodes = method.nodes();
    let mass = timings.time("assemble", || mass(problem, kind))?;
    counters.mass_nodes += nodes.len() as u64;
    let weak = prepared.weak();
    let system = prepared.problem(nodes, setup, &[], &weak);
    let modes = timings.time("solve", || lowest_modes(&system, &mass, count))?;
    counters.assemblies += 1;
    counters.factorisations += 1;
    let total = mass.times(&vec![Vector3::x(); nodes.len()]).iter().map(|p| p.x).sum();
    Ok(Solution { vibration: Some(Vibration { modes, count, mass: total }), ..Solution::default() })
}

fn mass(problem: &Problem, kind: scene::Mass) -> Result<Mass, Failure> {
    let Problem { method, setup, prepared, .. } = *problem;
    let volume = &prepared.volume;
    let density = setup.density()?;
    let lumped = || {
        let rows = &volume.rows;
        lumped_mass(rows, &density, &volume.region, Lumping::for_table(rows))
    };
    Ok(match (kind, method.interpolates) {
        // The quadrature of the forces may give a singular mass matrix: four points of a tet10 have rank 4.
        (scene::Mass::Consistent, _) => {
            let (fine, region) = prepared.fine_volume()?;
            Mass::consistent(&fine, &density, &region)?
        }
        (scene::Mass::AtPoints, _) => Mass::consistent(&volume.rows, &density, &volume.region)?,
        (scene::Mass::Transformed, false) => {
            let (at_nodes, _) = prepared.source.at_points(method.nodes())?;
            Mass::transformed(at_nodes.rows(), &lumped()?)?
        }
        // Nodal parameters of elements are displacements, which need no transformation.
        (scene::Mass::Lumped | scene::Mass::Transformed, _) => Mass::lumped(&lumped()?)?,
    })
}
