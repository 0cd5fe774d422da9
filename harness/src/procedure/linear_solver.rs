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

/// Smallest number of unknowns from which iterations are used: smaller systems take some milliseconds, and a
/// factor is exact to rounding.
const SMALLEST: f64 = 2_000.0;

/// Number of unknowns at which both solvers take the same time if lambda is at most [`COMPRESSIBLE`] mu, and
/// its power of `lambda / mu` beyond. All are fitted to measured times of both (`benches/break-even.csv`).
struct BreakEven(f64, f64);

const ELEMENTS: BreakEven = BreakEven(800.0, 0.65);
/// Rough motions between the points of reduced quadrature have little energy, and take more iterations.
const REDUCED: BreakEven = BreakEven(3_000.0, 0.65);
/// The levels of a cloud have more entries, and its iterations are more.
const CLOUD: BreakEven = BreakEven(8_000.0, 0.65);
/// With pressures.
const WITH_PRESSURES: BreakEven = BreakEven(800.0, 0.4);
/// With a pressure per element of first order, which allows too few motions.
const PER_LINEAR_ELEMENT: BreakEven = BreakEven(560.0, 0.95);
/// Not among the measured times: the power is that of smaller trials.
const CLOUD_WITH_PRESSURES: BreakEven = BreakEven(8_000.0, 0.34);

/// Largest `lambda / mu` at which the iterations are as few as for a compressible body (nu = 0.45): 20 to 35.
/// Beyond this ratio their number grows with the square root of the ratio (94 at nu = 0.495, at which the
/// ratio is 11 times as large).
const COMPRESSIBLE: f64 = 9.0;

/// Number of iterations with pressures that take 1.5 times as long as a factor, over the unknowns to the
/// power of 0.4 (fitted to the same times). Groups of nodes fill a factor more.
const ITERATIONS: f64 = 3.75;
const ITERATIONS_NODAL: f64 = 7.5;

/// Smallest `lambda / mu` at which elements whose points share dilations are iterated with pressures. At nu =
/// 0.495 this takes 45 iterations instead of 77 with displacements alone, each a third more expensive.
const PRESSURES: f64 = 60.0;

/// Number of unknowns from which the tangents of nonlinear statics are iterated. On cubes at nu = 0.49, whole
/// load paths take the same time at 6,000 unknowns, and 1.1 (hex8), 1.2 (tet10) and 2.0 (tet4-nodal) times as
/// long with factors at 10,000.
const TANGENTS: f64 = 10_000.0;

/// Edge of a cube of the same bounding volume over the longest side, below which a body is factored: beams of
/// more than 30 times their height. They are so flexible that iterations lose digits. Only a factorisation
/// estimates how many remain.
const SLENDER: f64 = 0.1;

/// Edge of a cube of the same bounding volume over the longest side: 1 for a cube. A body counts as a cube
/// with fewer unknowns, by the square root of this ratio. Its factor is cheaper, by the power 1.5 (nodes
/// across the longest side), but so are its iterations; the root fits the times of beams and plates.
fn compactness(nodes: &[Point3]) -> f64 {
    let along = |axis: usize| {
        let ends = nodes
            .iter()
            .map(|x| x[axis])
            .fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
        ends.1 - ends.0
    };
    let sides = [0, 1, 2].map(along);
    sides.iter().product::<f64>().cbrt() / sides.iter().fold(0.0, |longest: f64, side| longest.max(*side))
}

/// Number of unknowns of a body, and the number that it counts as.
fn unknowns(method: &Discretisation) -> (usize, f64) {
    let count = 3 * method.nodes().len();
    (count, count as f64 * compactness(method.nodes()).sqrt())
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
        _ if compactness(method.nodes()) < SLENDER => {
            Some("the body is so slender that iterations lose digits")
        }
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
    let (iterated, BreakEven(from, power)) = match (method.interpolates, shared && stiffest >= PRESSURES) {
        (true, true) if method.order == 1 && method.dilation == Dilation::ElementMean => {
            (Serves::Pressures, PER_LINEAR_ELEMENT)
        }
        (true, true) => (Serves::Pressures, WITH_PRESSURES),
        (true, false) if method.reduced => (Serves::Multigrid, REDUCED),
        (true, false) => (Serves::Multigrid, ELEMENTS),
        (false, true) => (Serves::Pressures, CLOUD_WITH_PRESSURES),
        (false, false) => (Serves::Multigrid, CLOUD),
    };
    let (unknowns, of_cube) = unknowns(method);
    let break_even = from * (stiffest / COMPRESSIBLE).powf(power).max(1.0);
    let least = SMALLEST.max(break_even * unknowns as f64 / of_cube);
    match (asked, direct) {
        (LinearSolver::Direct, _) => (Serves::Factor, "requested".into()),
        (LinearSolver::Amg, _) => (iterated, "requested".into()),
        (LinearSolver::Auto, Some(why)) => (Serves::Factor, why.into()),
        (LinearSolver::Auto, None) => {
            let serves = if unknowns as f64 >= least { iterated } else { Serves::Factor };
            let why = format!(
                "{unknowns} unknowns; iterative solution from {least:.0} for this shape at lambda / mu = {stiffest:.3}"
            );
            (serves, why)
        }
    }
}

/// Whether the tangents of Newton's method are iterated, and the description of the factorisation stage in
/// the plan.
pub(super) fn tangents(method: &Discretisation, setup: &Setup, asked: Option<&Static>) -> (bool, String) {
    let forced = |tool: &PlacedTool| matches!(tool.drive, Drive::Force(_));
    let direct = !method.interpolates
        || method.dilation == Dilation::Mixed
        || !matches!(method.essential, Essential::Nodal)
        || asked.is_some_and(|asked| asked.limit_within.is_some())
        || setup.tools.iter().any(forced);
    let (unknowns, of_cube) = unknowns(method);
    let least = TANGENTS * unknowns as f64 / of_cube;
    match !direct && of_cube >= TANGENTS {
        true => (
            true,
            format!(
                "multigrid levels, each for several iterations, and a factor where they do not converge \
                 ({unknowns} unknowns; iterative solution from {least:.0} for this shape)"
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
    let most = (asked == LinearSolver::Auto).then(|| iterations_for_a_factor(method));
    by_iterations(prepared, assembled, (serves, most), meters)
}

/// Number of iterations with pressures that take 1.5 times as long as a factor.
fn iterations_for_a_factor(method: &Discretisation) -> usize {
    let each = if method.dilation == Dilation::ElementMean { ITERATIONS } else { ITERATIONS_NODAL };
    (each * unknowns(method).1.powf(0.4)) as usize
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

/// Solves by iterations. If they do not converge, or would take more than `most`, the matrix is factored;
/// `None` if the scene requests iterations.
fn by_iterations<'a>(
    prepared: &Prepared,
    assembled: Assembled<'a>,
    (serves, most): (Serves, Option<usize>),
    meters: &mut Meters,
) -> Result<Solved<'a>, Failure> {
    let Meters { timings, counters, .. } = meters;
    let levels = timings.time("factor", || -> Result<_, Failure> {
        let linear = prepared.source.coarser()?;
        Ok(match serves {
            Serves::Pressures => {
                let levels = assembled.multigrid_with_pressures(linear.as_ref());
                levels.map(|levels| match most {
                    Some(most) => levels.at_most(most),
                    None => levels,
                })
            }
            _ => assembled.multigrid(linear.as_ref()),
        })
    })?;
    counters.factorisations += 1;
    let may_factor = |error: &SolveError| most.is_some() && is_of_iteration(error);
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
