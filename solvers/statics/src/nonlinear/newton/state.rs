//! State of a body and its tools at the start or end of a load step.

use contact::ContactHistory as History;
use shape::Vector3;

use crate::nonlinear::problem::StaticProblem;

/// State at the start or end of a load step.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub time: f64,
    pub u: Vec<Vector3>,
    pub pressure: Vec<f64>,
    pub closures: Vec<f64>,
    pub history: Vec<History>,
}

impl State {
    pub fn start(problem: &StaticProblem) -> State {
        let points = problem.contact.map_or(0, |c| c.rows().weights().len());
        State {
            time: 0.0,
            u: vec![Vector3::zeros(); problem.nodes.len()],
            pressure: vec![0.0; problem.solid.pressure_count()],
            closures: vec![0.0; problem.tools.len()],
            history: (problem.tools.iter())
                .map(|t| {
                    let mut history = History::new(t.tool, points);
                    if let Some(surface) = problem.contact {
                        let still = vec![Vector3::zeros(); problem.nodes.len()];
                        history.commit_all(None, surface, t.tool, 0.0, &still);
                    }
                    history
                })
                .collect(),
        }
    }
}
