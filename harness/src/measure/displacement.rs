//! The displacement field at the points where runs are compared.

use std::time::Instant;

use super::request::Request;
use super::solved::{Field, Solved};
use crate::error::Failure;
use crate::outcome::timing::Timings;
use crate::outcome::{Counters, Plan, StageName};

/// Displacement (m) at the targets; without targets, at the method's own nodes. If the plan has no transfer,
/// nodal parameters are displacements and nothing is evaluated.
pub(crate) fn displacement(
    run: &Solved,
    plan: &Plan,
    request: &Request,
    timings: &mut Timings,
    counters: &mut Counters,
) -> Result<Field, Failure> {
    let Solved { method, prepared, solution, .. } = *run;
    if !plan.runs(StageName::Transfer) {
        return Ok(Field { values: solution.u.clone(), outside: 0 });
    }
    let points = if request.targets.is_empty() { method.nodes() } else { request.targets };
    let once = || -> Result<Field, Failure> {
        let (rows, outside) = prepared.source.at_points(points)?;
        Ok(Field { values: rows.rows().apply(&solution.u), outside })
    };
    counters.transfer_rows += points.len() as u64;
    let timed = !method.interpolates && !request.targets.is_empty();
    if !timed {
        return once();
    }
    let start = Instant::now();
    let mut field = timings.time("transfer", once)?;
    for _ in 1..request.repeats.most {
        if start.elapsed().as_secs_f64() > request.repeats.seconds {
            break;
        }
        field = timings.time("transfer", once)?;
    }
    Ok(field)
}

/// 2-norm of the nodal displacements at the end over the unknowns that no support prescribes, m.
pub(crate) fn free_norm(run: &Solved) -> f64 {
    let mut free = run.solution.u.clone();
    for fixed in run.prepared.fixed() {
        free[fixed.node as usize][fixed.axis as usize] = 0.0;
    }
    free.iter().map(|u| u.norm_squared()).sum::<f64>().sqrt()
}
