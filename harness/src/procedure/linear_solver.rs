//! Choice of the solver of a linear procedure: factorisation, or iterations with multigrid.

use cases::scene::{Dilation, LinearSolver, Static};
use contact::Drive;
use geometry::Point3;
use statics::{Assembled, Factored, SolveError};

use super::problem::Problem;
use crate::discretise::{Discretisation, Essential};
use crate::error::{Failure, Key};
use crate::outcome::timing::Meters;
use crate::prepare::Prepared;
use crate::scenario::PlacedTool;
use crate::scenario::setup::Setup;

/// Relative residual at which the iterations stop.
const TOLERANCE: f64 = 1e-8;

/// Number of unknowns from which iterations are used if the volumetric stiffness is at most [`COMPRESSIBLE`]
/// times the shear stiffness. On a cube of tet4 with 105,000 unknowns, multigrid setup and iterations take
/// 0.4 s, factorisation and solution 5 s. At 5,000 unknowns the times are equal. A factor is exact to
/// rounding, so small problems are factored.
const UNKNOWNS: f64 = 20_000.0;

/// The same for a method whose parameters are not displacements, such as a cloud: its matrix has more
/// entries, and its factor still more. On a cube of 1,331 nodes (support scale 1.6), iterations take 0.08 s
/// and a factor 0.27 s; on a cube of 10,648 nodes, 1.2 s and 13 s.
const OF_CLOUD: f64 = 6_000.0;

/// Largest `lambda / mu` at which the iterations are as few as for a compressible body (nu = 0.45): 20 to 35.
/// Beyond this ratio their number grows with the square root of the ratio (94 at nu = 0.495, at which the
/// ratio is 11 times as large), and so does the size from which iterations pay off.
const COMPRESSIBLE: f64 = 9.0;

/// Smallest `lambda / mu` at which elements whose points share dilations are iterated with pressures. At nu =
/// 0.495 this takes 45 iterations instead of 77 with displacements alone, each a third more expensive.
const PRESSURES: f64 = 60.0;

/// Exponents of `lambda / mu` in the size from which iterations with pressures pay off, for elements of
/// second and of first order. On cubes of 107,811 unknowns at nu = 0.4999, tet10 takes 3.2 s (factorisation
/// 7.3 s); hex8, whose pressures are less well determined, takes 9.5 s (factorisation 7.1 s).
const QUADRATIC: f64 = 0.25;
const LINEAR: f64 = 0.34;

/// Number of unknowns from which the tangents of nonlinear statics are iterated. On cubes at nu = 0.49, whole
/// load paths take the same time at 6,000 unknowns, and 1.1 (hex8), 1.2 (tet10) and 2.0 (tet4-nodal) times as
/// long with factors at 10,000.
const TANGENTS: f64 = 10_000.0;

/// Ratio of the unknowns of a cube that is as expensive to factor to the unknowns of the body. The cost
/// depends on the nodes across the longest side, `n^(2/3) s`, with `s` the edge of a cube of the same
/// bounding volume divided by the longest side. A beam is also flexible, and its iterations lose digits.
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

/// Solver of the linear equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Serves {
    Factor,
    /// Conjugate gradients with multigrid.
    Multigrid,
    /// Conjugate gradients with multigrid, for displacements and pressures together.
    Pressures,
}

impl Serves {
    /// Description of the factorisation stage in the plan.
    pub fn meaning(self) -> &'static str {
        match self {
            Serves::Factor => "one, for all load levels",
            Serves::Multigrid => "multigrid levels for conjugate gradients",
            Serves::Pressures => "multigrid levels for displacements and pressures",
        }
    }
}

/// Chooses the solver, and gives the reason.
pub(super) fn serves(method: &Discretisation, setup: &Setup, asked: LinearSolver) -> (Serves, String) {
    let direct = match method.essential {
        Essential::Multipliers => Some("multipliers"),
        Essential::Elimination(_) => Some("elimination couples distant nodes"),
        _ if method.wide => Some("the supports of the cloud are too wide for iterations"),
        _ => None,
    };
    let stiffest = setup.materials.iter().map(|m| m.lambda() / m.mu()).fold(0.0, f64::max);
    // Nitsche's method needs the whole bulk modulus, so its terms leave nothing to the pressures of a cloud.
    let pressures = method.interpolates || matches!(method.essential, Essential::Coupling(_));
    let shared = pressures
        && match method.dilation {
            Dilation::ElementMean | Dilation::NodalMean | Dilation::NodalNear => true,
            Dilation::Standard | Dilation::Mixed => false,
        };
    let quadratic = method.order == 2;
    let (iterated, power) = match shared && stiffest >= PRESSURES {
        true => (Serves::Pressures, if quadratic { QUADRATIC } else { LINEAR }),
        false => (Serves::Multigrid, 0.5),
    };
    let from = if method.interpolates { UNKNOWNS } else { OF_CLOUD };
    let needed = from * (stiffest / COMPRESSIBLE).powf(power).max(1.0);
    let unknowns = 3 * method.nodes().len();
    let compact = compactness(method.nodes());
    let of_cube = unknowns as f64 * compact;
    match (asked, direct) {
        (LinearSolver::Direct, _) => (Serves::Factor, "requested".into()),
        (LinearSolver::Amg, _) => (iterated, "requested".into()),
        (LinearSolver::Auto, Some(why)) => (Serves::Factor, why.into()),
        (LinearSolver::Auto, None) => {
            let iterates = of_cube >= needed;
            let like = if compact < 0.995 {
                format!(", as costly to factor as {of_cube:.0} unknowns of a cube")
            } else {
                String::new()
            };
            (
                if iterates { iterated } else { Serves::Factor },
                format!(
                    "{unknowns} unknowns{like}; iterative solution from {needed:.0} at lambda / mu = {stiffest:.3}"
                ),
            )
        }
    }
}

/// Whether the tangents of nonlinear statics are iterated, and the description of the factorisation stage in
/// the plan.
pub(super) fn tangents(method: &Discretisation, setup: &Setup, asked: &Static) -> (bool, String) {
    let forced = |tool: &PlacedTool| matches!(tool.drive, Drive::Force(_));
    let direct = !method.interpolates
        || method.dilation == Dilation::Mixed
        || !matches!(method.essential, Essential::Nodal)
        || asked.limit_within.is_some()
        || setup.tools.iter().any(forced);
    let unknowns = 3 * method.nodes().len();
    let of_cube = unknowns as f64 * compactness(method.nodes());
    match !direct && of_cube >= TANGENTS {
        true => (
            true,
            format!(
                "multigrid levels, each for several iterations, and a factor where they do not converge \
                 ({unknowns} unknowns, as costly to factor as {of_cube:.0} unknowns of a cube; iterative \
                 solution from {TANGENTS:.0})"
            ),
        ),
        false => (false, "one for each iteration, analysed once".into()),
    }
}

/// Solution of the linear problem, with the solver that found it.
pub(super) struct Solved<'a> {
    pub factored: Factored<'a>,
    pub solution: statics::Solution,
    /// Whether iterations were intended, but a factor was needed.
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
        let key = Key::Scene("procedure.linear_solver".into());
        let problem = "iterates over nodal parameters, but this method also has constraint rows";
        let help = "give \"auto\" or \"direct\", or take essential = \"nitsche\" or \"penalty\"";
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

/// Solves by iterations. If they do not converge, the matrix is factored, unless the scene requests
/// iterations.
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

/// Whether factorisation might succeed after this error of the iterations.
fn is_of_iteration(error: &SolveError) -> bool {
    matches!(error, SolveError::Algebra(_) | SolveError::NotPositiveDefinite)
}
