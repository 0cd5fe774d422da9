//! Small free vibrations: mass, modes, and how they compare with exact ones.

use cases::exact::Vibrations;
use cases::scene;
use explicit::{Lumping, lumped_mass};
use geometry::{Point3, Vector3};
use statics::{Mass, Modes, modes};

use crate::Failure;
use crate::discretise::Discretisation;
use crate::measure::push;
use crate::outcome::Metric;
use crate::prepare::Prepared;
use crate::setup::Setup;
use crate::timing::Timings;
use crate::work::Work;

/// Part of the lowest exact frequency below which a mode is a spurious slow one.
const SLOW: f64 = 0.9;
/// Part of the frequency of a shear wave across the body below which a mode is rigid: rounding leaves 1e-6.
const RIGID: f64 = 1e-3;
/// Multiple of the exact frequency up to which its mode is looked for.
const FAST: f64 = 1.5;
/// Share of its displacement that a mode must have in the exact ones to be taken for one of them.
const ALIKE: f64 = 0.5;

/// Which vibrations are asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct ModesParams {
    /// What moves.
    pub mass: scene::Mass,
    /// How many modes are told.
    pub count: usize,
    /// Density by region, kg/m^3.
    pub density: Vec<f64>,
}

/// Modes with the mass that they have.
pub(crate) struct Found {
    modes: Modes,
    /// How many are told.
    count: usize,
    /// Mass of the body, kg.
    mass: f64,
}

/// What a run tells that loads nothing.
pub(crate) struct Told {
    pub metrics: Vec<Metric>,
    pub dofs: usize,
    pub modes: Vec<Vec<Metric>>,
}

/// Makes the mass and finds the modes.
pub(crate) fn solve(
    method: &Discretisation,
    setup: &Setup,
    params: &ModesParams,
    prepared: &Prepared,
    timings: &mut Timings,
    work: &mut Work,
) -> Result<Found, Failure> {
    let nodes = method.nodes();
    let mass = timings.time("assemble", || mass(method, params, prepared))?;
    work.mass_nodes += nodes.len() as u64;
    let weak = prepared.weak();
    let problem = prepared.problem(nodes, setup, &[], &weak);
    let modes = timings.time("solve", || modes(&problem, &mass))?;
    work.assemblies += 1;
    work.factorisations += 1;
    let total = mass.times(&vec![Vector3::x(); nodes.len()]).iter().map(|p| p.x).sum();
    Ok(Found { modes, count: params.count, mass: total })
}

fn mass(method: &Discretisation, params: &ModesParams, prepared: &Prepared) -> Result<Mass, Failure> {
    let volume = &prepared.volume;
    let lumped = || {
        let rows = &volume.rows;
        lumped_mass(rows, &params.density, &volume.region, Lumping::for_table(rows))
    };
    Ok(match (params.mass, method) {
        // The points of the forces need not give a regular mass: four of a tet10 have rank 4.
        (scene::Mass::Consistent, _) => {
            let (fine, region) = method.error_rows(volume)?;
            Mass::consistent(&fine, &params.density, &region)?
        }
        (scene::Mass::Transformed, Discretisation::Efg(_)) => {
            let (at_nodes, _) = method.at_points(volume, method.nodes())?;
            Mass::transformed(at_nodes.rows(), &lumped()?)?
        }
        // Parameters of elements are displacements: nothing is left to transform.
        (scene::Mass::Lumped | scene::Mass::Transformed, _) => Mass::lumped(&lumped()?)?,
    })
}

/// Counts, and comparisons with the exact vibrations if the scene names some.
pub(crate) fn told(
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    found: &Found,
) -> Result<Told, Failure> {
    let Found { modes, count, mass } = found;
    let omega: Vec<f64> = modes.squared.iter().map(|s| s.max(0.0).sqrt()).collect();
    let count = omega.len().min(*count);
    let mut metrics = Vec::new();
    push(&mut metrics, "mass", *mass, "kg");
    push(&mut metrics, "residual", modes.residual, "1");
    let rigid = RIGID * modes.scale.sqrt();
    push(&mut metrics, "rigid-modes", omega.iter().filter(|&&w| w < rigid).count() as f64, "1");
    push(&mut metrics, "massless", modes.massless as f64, "1");
    if let (Some(fastest), 0) = (omega.last(), modes.massless) {
        push(&mut metrics, "critical-step", 2.0 / fastest, "s");
    }
    let exact = setup.exact.as_ref().and_then(|exact| exact.vibrations());
    let lowest = exact.and_then(|exact| exact.lowest(count)).unwrap_or_default();
    if let Some(first) = lowest.first() {
        push(&mut metrics, "slow-modes", omega.iter().filter(|&&w| w < SLOW * first).count() as f64, "1");
        let errors = omega.iter().zip(&lowest).map(|(w, e)| (w / e - 1.0).abs());
        push(&mut metrics, "spectrum-error", errors.fold(0.0, f64::max), "1");
    }
    if let Some(exact) = exact {
        // Slow ones may be many, and come first.
        let near = omega.iter().take_while(|&&w| w < FAST * exact.omega()).count();
        let (shares, dimension) = shares(method, prepared, &modes.shapes[..near], exact)?;
        let mut nearest: Vec<usize> = (0..near).collect();
        nearest.sort_by(|&a, &b| shares[b].total_cmp(&shares[a]));
        nearest.truncate(dimension);
        // What is one frequency of several modes may part into several: told is the worst of them.
        let least = nearest.iter().map(|&n| shares[n]).fold(f64::INFINITY, f64::min);
        let ratios = nearest.iter().map(|&n| omega[n] / exact.omega());
        if let Some(worst) = ratios.max_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs())) {
            push(&mut metrics, "mode-overlap", least, "1");
            if nearest.len() == dimension && least > ALIKE {
                push(&mut metrics, "frequency-ratio", worst, "1");
                push(&mut metrics, "frequency-error", (worst - 1.0).abs(), "1");
            }
        }
    }
    let told = (0..count).map(|n| {
        let mut metrics = Vec::new();
        push(&mut metrics, "mode", (n + 1) as f64, "1");
        push(&mut metrics, "omega", omega[n], "rad/s");
        if let Some(exact) = lowest.get(n) {
            push(&mut metrics, "omega-ratio", omega[n] / exact, "1");
        }
        metrics
    });
    Ok(Told { modes: told.collect(), metrics, dofs: omega.len() + modes.massless })
}

/// Of each mode the share in the span of the exact ones of one frequency, the squared cosine in L2 over the body; and how many
/// these are.
fn shares(
    method: &Discretisation,
    prepared: &Prepared,
    shapes: &[Vec<Vector3>],
    exact: &dyn Vibrations,
) -> Result<(Vec<f64>, usize), Failure> {
    let (fine, _) = method.error_rows(&prepared.volume)?;
    let weights = fine.weights();
    let inner = |a: &[Vector3], b: &[Vector3]| -> f64 {
        weights.iter().zip(a.iter().zip(b)).map(|(w, (a, b))| w * a.dot(b)).sum()
    };
    let at: Vec<Vec<Vector3>> = fine.points().iter().map(|x: &Point3| exact.shapes(x)).collect();
    let mut span: Vec<Vec<Vector3>> = Vec::new();
    for k in 0..at.first().map_or(0, Vec::len) {
        let mut field: Vec<Vector3> = at.iter().map(|shapes| shapes[k]).collect();
        for other in &span {
            let part = inner(other, &field);
            field.iter_mut().zip(other).for_each(|(f, o)| *f -= o * part);
        }
        let size = inner(&field, &field).sqrt();
        field.iter_mut().for_each(|f| *f /= size);
        span.push(field);
    }
    let share = |shape: &Vec<Vector3>| {
        let field = fine.rows().apply(shape);
        let within: f64 = span.iter().map(|other| inner(other, &field).powi(2)).sum();
        within / inner(&field, &field)
    };
    Ok((shapes.iter().map(share).collect(), span.len()))
}
