//! What solves the equations of a linear procedure, and why: a factor, or iterations with multigrid.

use cases::scene::LinearSolver;
use geometry::Point3;
use statics::{Assembled, Factored, SolveError};

use super::Problem;
use crate::Failure;
use crate::discretise::{Dilation, Discretisation, Essential};
use crate::error::Key;
use crate::outcome::Meters;
use crate::prepare::Prepared;
use crate::scenario::setup::Setup;

/// Relative residual to which the equations are iterated.
const TOLERANCE: f64 = 1e-8;

/// From so many unknowns on iterations serve where the volumetric stiffness is at most [`COMPRESSIBLE`] times that of shear. On a
/// cube of tet4 of 105,000 unknowns hierarchy and iterations take 0.4 s, a factor and its solution 5 s; at 5,000 they are equal. A
/// factor is exact to rounding, so that it keeps the small problems.
const UNKNOWNS: f64 = 20_000.0;

/// Largest `lambda / mu` at which the iterations are those of a compressible body (nu = 0.45): 20 to 35. Beyond they grow with its
/// square root (94 at nu = 0.495, 11 times as much), and the size from which they pay in proportion.
const COMPRESSIBLE: f64 = 9.0;

/// From this `lambda / mu` on elements whose points share dilations are iterated with pressures: 45 iterations at nu = 0.495 where
/// displacements alone take 77, each a third dearer.
const PRESSURES: f64 = 60.0;

/// Powers of `lambda / mu` with which the size grows from which iterations with pressures pay. On cubes of 107,811 unknowns at nu = 0.4999
/// tet10 takes 3.2 s, a factor 7.3; hex8, whose pressures are less certain, 9.5 s, a factor 7.1.
const QUADRATIC: f64 = 0.25;
const LINEAR: f64 = 0.34;

/// Unknowns of a cube that take as long to factor as one of the body: what counts are the nodes across its longest side, `n^(2/3) s`
/// with `s` the edge of a cube of its volume over that side. A beam is soft besides, and its iterations lose digits.
fn compactness(nodes: &[Point3]) -> f64 {
    let along = |axis: usize| {
        let ends = nodes
            .iter()
            .map(|x| x[axis])
            .fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
        ends.1 - ends.0
    };
    let sides = [0, 1, 2].map(along);
    let cube = sides.iter().product::<f64>().cbrt();
    (cube / sides.iter().fold(0.0, |longest: f64, side| longest.max(*side))).powf(1.5)
}

/// What solves the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Serves {
    Factor,
    /// Conjugate gradients with multigrid.
    Multigrid,
    /// The same for displacements and pressures together.
    Pressures,
}

impl Serves {
    /// What the plan says of the stage that makes it.
    pub fn meaning(self) -> &'static str {
        match self {
            Serves::Factor => "one, for all load levels",
            Serves::Multigrid => "multigrid levels for conjugate gradients",
            Serves::Pressures => "multigrid levels for displacements and pressures",
        }
    }
}

/// What solves the equations, and why.
pub(super) fn serves(method: &Discretisation, setup: &Setup, asked: LinearSolver) -> (Serves, String) {
    let direct = match method.essential {
        Essential::Multipliers => Some("multipliers"),
        Essential::Elimination(_) => Some("elimination couples nodes far apart"),
        // 162 iterations on 486 nodes at dilatation 1.6, where elements take 16 to 19.
        _ if !method.interpolates => Some("a cloud's functions overlap too widely for iterations"),
        _ => None,
    };
    let stiffest = setup.materials.iter().map(|m| m.lambda() / m.mu()).fold(0.0, f64::max);
    let shared = matches!(method.dilation, Dilation::Element | Dilation::Nodal) && method.interpolates;
    let quadratic = method.mesh().uniform_kind().is_some_and(|kind| kind.order() == 2);
    let (iterated, power) = match shared && stiffest >= PRESSURES {
        true => (Serves::Pressures, if quadratic { QUADRATIC } else { LINEAR }),
        false => (Serves::Multigrid, 0.5),
    };
    let needed = UNKNOWNS * (stiffest / COMPRESSIBLE).powf(power).max(1.0);
    let (unknowns, compact) = (3 * method.nodes().len(), compactness(method.nodes()));
    let of_cube = unknowns as f64 * compact;
    match (asked, direct) {
        (LinearSolver::Direct, _) => (Serves::Factor, "asked for".into()),
        (LinearSolver::Amg, _) => (iterated, "asked for".into()),
        (LinearSolver::Auto, Some(why)) => (Serves::Factor, why.into()),
        (LinearSolver::Auto, None) => {
            let iterates = of_cube >= needed;
            let than = if iterates { "from" } else { "below" };
            let like = if compact < 0.995 {
                format!(" that factor like {of_cube:.0} of a cube")
            } else {
                String::new()
            };
            (
                if iterates { iterated } else { Serves::Factor },
                format!("{unknowns} unknowns{like}, {than} {needed:.0} at lambda / mu = {stiffest:.3}"),
            )
        }
    }
}

/// A problem with what solved it.
pub(super) struct Solved<'a> {
    pub factored: Factored<'a>,
    pub solution: statics::Solution,
    /// Whether it was to be iterated, and needed a factor.
    pub not_iterated: bool,
}

/// Factors or iterates, and solves.
pub(super) fn solved<'a>(
    problem: &Problem,
    assembled: Assembled<'a>,
    asked: LinearSolver,
    meters: &mut Meters,
) -> Result<Solved<'a>, Failure> {
    let Problem { method, setup, prepared, .. } = *problem;
    let serves = serves(method, setup, asked).0;
    if serves == Serves::Factor {
        return by_factor(prepared, assembled, meters);
    }
    if prepared.has_rows() {
        let key = Key::Scene("procedure.linear-solver".into());
        let problem = "iterates over nodal parameters, and this method has constraint rows besides";
        let help =
            "give \"auto\" or \"direct\", or hold the method by essential = \"nitsche\" or \"penalty\"";
        return Err(Failure::input(key, problem, help));
    }
    by_iterations(prepared, assembled, (serves, asked), meters)
}

fn by_factor<'a>(
    prepared: &Prepared,
    assembled: Assembled<'a>,
    meters: &mut Meters,
) -> Result<Solved<'a>, Failure> {
    let factored = meters.timings.time("factor", || prepared.factor(assembled))?;
    meters.counters.factorisations += 1;
    let solution = meters.timings.time("solve", || factored.solve(1.0))?;
    meters.counters.solves += 1;
    Ok(Solved { factored, solution, not_iterated: false })
}

/// Iterates; what does not converge is factored unless iterations were asked for.
fn by_iterations<'a>(
    prepared: &Prepared,
    assembled: Assembled<'a>,
    (serves, asked): (Serves, LinearSolver),
    meters: &mut Meters,
) -> Result<Solved<'a>, Failure> {
    let Meters { timings, counters, .. } = meters;
    let levels = timings.time("factor", || -> Result<_, Failure> {
        let linear = prepared.source.coarser()?;
        Ok(match serves {
            Serves::Pressures => assembled.multigrid_with_pressures(linear.as_ref()),
            _ => assembled.multigrid(linear.as_ref()),
        })
    })?;
    counters.factorisations += 1;
    let may_factor = |error: &SolveError| asked == LinearSolver::Auto && is_of_iteration(error);
    let mut phases = vec!["factor"];
    let assembled = match levels {
        Err(error) if may_factor(&error) => assembled,
        levels => {
            let factored = assembled.iterated(levels?, TOLERANCE)?;
            phases.push("solve");
            match timings.time("solve", || factored.solve(1.0)) {
                Err(error) if may_factor(&error) => factored.into_assembled(),
                solution => {
                    counters.solves += 1;
                    return Ok(Solved { factored, solution: solution?, not_iterated: false });
                }
            }
        }
    };
    let solved = by_factor(prepared, assembled, meters)?;
    phases.into_iter().for_each(|phase| meters.timings.join(phase));
    Ok(Solved { not_iterated: true, ..solved })
}

/// Whether a factor might do better.
fn is_of_iteration(error: &SolveError) -> bool {
    matches!(error, SolveError::Algebra(_) | SolveError::NotPositiveDefinite)
}
