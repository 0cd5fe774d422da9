//! The error of a number, traced to the nodes of a richer method.

use cases::scene::Goal;
use shape::Vector3;
use statics::{Traced, trace};

use super::problem::Problem;
use super::solution::Carried;
use super::statics::near;
use crate::error::Failure;

/// Relative residual of Newton's method, which takes no step here.
const TOLERANCE: f64 = 1e-3;

/// Unbalanced forces of another method's solution on the nodes of a richer method, N.
pub(crate) fn unbalanced(problem: &Problem, carried: &Carried) -> Result<Vec<Vector3>, Failure> {
    Ok(near(problem, carried, TOLERANCE, statics::unbalanced)??)
}

/// Traces the error of a number of another method's solution to the unbalanced forces on the nodes of a
/// richer method.
pub(crate) fn traced(problem: &Problem, carried: &Carried, goal: &Goal) -> Result<Traced, Failure> {
    let Problem { method, prepared, .. } = *problem;
    let mut weights = vec![Vector3::zeros(); method.nodes().len()];
    let goal = match *goal {
        Goal::ToolForce(tool) => statics::Goal::Tool(tool),
        Goal::Reaction(support, axis) => {
            let held = prepared.nodes_of_support(support, axis).ok_or_else(|| {
                Failure::Run(format!("the force of support {} is not that of its nodes", support + 1))
            })?;
            held.for_each(|node| weights[node as usize][axis] = 1.0);
            statics::Goal::Supports(&weights)
        }
        Goal::Mean(face, axis) => {
            let places = std::slice::from_ref(&problem.setup.output.means[face]);
            for (node, weight) in prepared.means(places)?.swap_remove(0) {
                weights[node as usize][axis] = weight;
            }
            statics::Goal::Displacement(&weights)
        }
        Goal::Probe(probe, axis) => {
            let at = &problem.probes[probe..=probe];
            let rows = prepared.source.at_points(at)?.0;
            let along = match axis {
                Some(axis) => Vector3::ith(axis, 1.0),
                None => rows.rows().apply(carried.u)[0].try_normalize(0.0).ok_or_else(|| {
                    Failure::Run(format!(
                        "point {} does not move, so its displacement has no direction",
                        probe + 1
                    ))
                })?,
            };
            let (nodes, values) = rows.rows().row(0);
            nodes.iter().zip(values).for_each(|(&node, value)| weights[node as usize] = along * *value);
            statics::Goal::Displacement(&weights)
        }
    };
    Ok(near(problem, carried, TOLERANCE, |problem, params, near| trace(problem, params, near, goal))??)
}
