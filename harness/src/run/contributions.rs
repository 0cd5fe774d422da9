//! The error of a number, traced to the cells that cause it.
//!
//! The unbalanced forces r of a run's solution in a richer method change the number by `z . r`. The run's own
//! shape functions see no unbalanced force, so that `r . (z - I z)` is the same sum, with the influence `I z`
//! interpolated by them. Its terms are the errors at the nodes of the richer method (Becker and Rannacher,
//! Acta Numerica 10 (2001) 1-102; by nodes: Richter and Wick, J. Comput. Appl. Math. 279 (2015) 192-208).

use cases::scene::{Dilation, Goal};
use catalogue::{metric, warning};
use geometry::{Mesh, Point3, quality};

use super::richer::Richer;
use crate::error::Failure;
use crate::measure::{Solved, number};
use crate::outcome::timing::Meters;
use crate::outcome::{Counters, Outcome, Warning, push};
use crate::procedure::{traced, unbalanced};

/// The error of a number of a run.
pub(super) struct Contributions {
    /// The number in the run, m or N.
    pub(super) number: f64,
    /// The number that the richer method predicts.
    pub(super) predicted: f64,
    /// By cell of the run's mesh, in the number's unit; negative where cells make the number too large.
    pub(super) of_cell: Vec<f64>,
}

impl Contributions {
    /// # Errors
    /// Errors of the richer method, and of a number that the run does not have.
    pub(super) fn new(
        run: &Solved,
        goal: &Goal,
        probes: &[Point3],
        counters: &mut Counters,
    ) -> Result<Contributions, Failure> {
        if run.solution.forces.is_some() {
            return Err(Failure::Run("the run ended by relaxation".into()));
        }
        let mut own = Meters::default();
        let by_newton = run.setup.solves_by_newton();
        let free = if by_newton { Dilation::Mixed } else { Dilation::ElementMean };
        let richer = Richer::new(run, free, &mut own.counters)?;
        richer.affordable()?;
        let (problem, carried) = (richer.problem(probes), richer.carried());
        let traced = traced(&problem, &carried, goal)?;
        counters.traced_dofs += 3 * traced.influence.len() as u64;
        // A mean dilation gives the influence of linear problems at a fraction of the cost of a pressure
        // field, and the number, but no pressure that is near that of the run.
        let unbalanced = match richer.method.dilation {
            Dilation::ElementMean => {
                let mixed = Richer::new(run, Dilation::Mixed, &mut own.counters)?;
                unbalanced(&mixed.problem(probes), &mixed.carried())?
            }
            _ => traced.unbalanced,
        };
        let mesh = run.method.mesh();
        let at_nodes = richer.tables.source.at_points(run.method.nodes())?.0.rows().apply(&traced.influence);
        let coarse = run.prepared.source.at_points(richer.method.nodes())?.0.rows().apply(&at_nodes);
        let each = unbalanced.iter().zip(traced.influence.iter().zip(&coarse));
        let of_node: Vec<f64> = each.map(|(r, (z, coarse))| r.dot(&(z - coarse))).collect();
        Ok(Contributions {
            number: number(run, goal, probes)?,
            predicted: traced.predicted,
            of_cell: of_cells(&of_node, richer.method.mesh(), mesh),
        })
    }

    /// Part of the error that each cell causes per volume, over the mean of the body.
    fn density(&self, mesh: &Mesh) -> Vec<f64> {
        let volumes = quality::volumes(mesh);
        let total: f64 = self.of_cell.iter().map(|c| c.abs()).sum();
        let mean = total / volumes.iter().sum::<f64>();
        let of_cell = self.of_cell.iter().zip(&volumes);
        of_cell.map(|(c, volume)| if mean > 0.0 { c.abs() / volume / mean } else { 0.0 }).collect()
    }

    /// Part of the body's volume that causes half of the error, in the fewest cells.
    fn volume(&self, mesh: &Mesh) -> f64 {
        let (volumes, density) = (quality::volumes(mesh), self.density(mesh));
        let mut cells: Vec<usize> = (0..volumes.len()).collect();
        cells.sort_by(|&a, &b| density[b].total_cmp(&density[a]).then(a.cmp(&b)));
        let half = 0.5 * self.of_cell.iter().map(|c| c.abs()).sum::<f64>();
        let (mut sum, mut volume) = (0.0, 0.0);
        for cell in cells {
            if sum >= half {
                break;
            }
            sum += self.of_cell[cell].abs();
            volume += volumes[cell];
        }
        volume / volumes.iter().sum::<f64>()
    }
}

/// Distributes numbers of nodes equally over the parts of cells around each, and adds them up by cell.
fn of_cells(of_node: &[f64], parts: &Mesh, mesh: &Mesh) -> Vec<f64> {
    let per_cell = parts.cell_count() / mesh.cell_count();
    let mut around = vec![0.0; of_node.len()];
    for part in 0..parts.cell_count() {
        parts.cell(part).iter().for_each(|&node| around[node as usize] += 1.0);
    }
    let share = |&node: &u32| of_node[node as usize] / around[node as usize];
    let of_cell = |cell: usize| {
        (per_cell * cell..per_cell * (cell + 1)).flat_map(|part| parts.cell(part)).map(share).sum()
    };
    (0..mesh.cell_count()).map(of_cell).collect()
}

/// Traces the error of a number of a run, or warns that this is not possible.
pub(super) fn add_trace(
    outcome: &mut Outcome,
    run: &Solved,
    goal: &Goal,
    probes: &[Point3],
    counters: &mut Counters,
) {
    match Contributions::new(run, goal, probes, counters) {
        Ok(found) => {
            push(&mut outcome.metrics, &metric::ERROR_VOLUME, found.volume(run.method.mesh()));
            outcome.error_source = found.density(run.method.mesh());
        }
        Err(failure) => {
            let message = format!("the error of {goal} can't be traced: {failure}");
            outcome.warnings.push(Warning::new(&warning::UNTRACED, 0.0, "output.error_of", message));
        }
    }
}
