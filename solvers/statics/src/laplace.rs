//! Laplace's equation for one scalar field over shape tables, such as the depth of a wall between two surfaces.

use algebra::{
    BlockPattern, Connectivity, DENSE_LIMIT, FactorError, Incidence, Stiffness, Symmetric, factor,
};
use shape::{FluxRows, Rows, Vector3, VolumeRows};

use crate::error::SolveError;

/// A scalar field `t` with `laplacian t = 0` in a body, prescribed on parts of its surface, without a flux through the
/// rest.
pub struct LaplaceProblem<'a> {
    /// Values, gradients and weights in the body.
    pub volume: &'a VolumeRows,
    /// Nodes with their prescribed value, for a basis whose parameters are values at the nodes.
    pub fixed: &'a [(u32, f64)],
    /// Surfaces with their prescribed value, for any basis: by Nitsche's method.
    pub surfaces: &'a [(FluxRows, f64)],
    /// Stabilisation of Nitsche's method, 1/m: some ten to a hundred over the spacing of the nodes. A pure penalty
    /// would have to be so large that shape functions that reach the surface from inside could not bend.
    pub stabilisation: f64,
}

/// Rows with ascending nodes.
struct Table {
    offsets: Vec<usize>,
    nodes: Vec<u32>,
    values: Vec<f64>,
    grads: Vec<Vector3>,
}

impl Table {
    /// Sorts the entries of each row.
    fn new(rows: &Rows, grads: &[Vector3]) -> Table {
        let of = rows.nodes();
        let mut order: Vec<usize> = (0..of.len()).collect();
        rows.offsets().windows(2).for_each(|row| order[row[0]..row[1]].sort_by_key(|&k| of[k]));
        Table {
            offsets: rows.offsets().to_vec(),
            nodes: order.iter().map(|&k| of[k]).collect(),
            values: order.iter().map(|&k| rows.values()[k]).collect(),
            grads: order.iter().map(|&k| grads[k]).collect(),
        }
    }

    fn connectivity(&self) -> Connectivity<'_> {
        Connectivity { offsets: &self.offsets, nodes: &self.nodes, seen_by: &[] }
    }

    fn incidence(&self, nodes: usize) -> Incidence {
        Incidence::new(nodes, self.connectivity(), 0..self.offsets.len() - 1)
    }

    /// Adds `form(q, k, j)`, for the entries `k` and `j` of row `q`, to the first component of each block.
    fn add(
        &self,
        matrix: &mut Stiffness,
        incidence: &Incidence,
        form: impl Fn(usize, usize, usize) -> f64 + Sync,
    ) {
        matrix.for_each_row(|i, slot, row| {
            for &(q, k) in incidence.of(i) {
                let (q, k) = (q as usize, k as usize);
                for j in self.offsets[q]..=k {
                    row[slot[self.nodes[j] as usize] as usize][(0, 0)] += form(q, k, j);
                }
            }
        });
    }
}

/// Returns the nodal parameters of the field.
///
/// # Errors
/// [`SolveError::Conflict`] for a node with two values, [`SolveError::NotPositiveDefinite`] if a piece of the body has
/// no prescribed value, and errors of the factorisation.
pub fn solve_laplace(problem: &LaplaceProblem) -> Result<Vec<f64>, SolveError> {
    let nodes = problem.volume.rows().node_count();
    let body = Table::new(problem.volume.rows(), problem.volume.grads());
    let surfaces: Vec<Table> =
        problem.surfaces.iter().map(|(rows, _)| Table::new(rows.at().rows(), rows.at().grads())).collect();
    let tables: Vec<&Table> = std::iter::once(&body).chain(&surfaces).collect();
    let incidences: Vec<Incidence> = tables.iter().map(|table| table.incidence(nodes)).collect();
    let parts: Vec<_> = tables.iter().map(|table| table.connectivity()).zip(&incidences).collect();
    // One component of blocks of three: the other two stay zero and are not among the unknowns.
    let mut matrix = Stiffness::zeros(BlockPattern::new(nodes, &parts));
    let weights = problem.volume.weights();
    body.add(&mut matrix, &incidences[0], |q, k, j| weights[q] * body.grads[k].dot(&body.grads[j]));
    let mut known = vec![Vector3::zeros(); nodes];
    let mut right = vec![0.0; nodes];
    for (at, (surface, (rows, value))) in surfaces.iter().zip(problem.surfaces).enumerate() {
        let (weights, normals) = (rows.weights(), rows.normals());
        let (phi, beta) = (&surface.values, problem.stabilisation);
        let flux = |q: usize, k: usize| surface.grads[k].dot(&normals[q]);
        surface.add(&mut matrix, &incidences[at + 1], |q, k, j| {
            weights[q] * (beta * phi[k] * phi[j] - flux(q, k) * phi[j] - phi[k] * flux(q, j))
        });
        for q in 0..weights.len() {
            for k in surface.offsets[q]..surface.offsets[q + 1] {
                right[surface.nodes[k] as usize] += weights[q] * value * (beta * phi[k] - flux(q, k));
            }
        }
    }
    let mut place: Vec<usize> = vec![usize::MAX; 3 * nodes];
    let mut is_fixed = vec![false; nodes];
    for &(node, value) in problem.fixed {
        let (i, first) = (node as usize, known[node as usize].x);
        if std::mem::replace(&mut is_fixed[i], true) && first != value {
            return Err(SolveError::Conflict { node: i, axis: 0, first, second: value });
        }
        known[i].x = value;
    }
    let free: Vec<usize> = (0..nodes).filter(|&i| !is_fixed[i]).collect();
    free.iter().enumerate().for_each(|(unknown, &i)| place[3 * i] = unknown);
    let forces = matrix.multiply(&known);
    let mut x: Vec<f64> = free.iter().map(|&i| right[i] - forces[i].x).collect();
    let factored = factor(Symmetric::displacements(&matrix, &place, free.len()), DENSE_LIMIT);
    let factored = factored.map_err(|bad| match bad {
        FactorError::NotDefinite => SolveError::NotPositiveDefinite,
        FactorError::Other(bad) => bad.into(),
    })?;
    factored.solve_judged(&mut x)?;
    let mut field: Vec<f64> = known.iter().map(|t| t.x).collect();
    free.iter().zip(x).for_each(|(&i, x)| field[i] = x);
    Ok(field)
}

#[cfg(test)]
mod tests {
    use geometry::{CellKind, Point3, generate::box_mesh};

    use super::*;

    /// A linear field is exact in every element, with values at nodes and by Nitsche's method.
    #[test]
    fn a_field_between_two_faces_of_a_box_is_linear() {
        for kind in CellKind::ALL {
            let max = Point3::new(0.02, 0.01, 0.03);
            let mesh = box_mesh(kind, Point3::origin(), max, [3, 2, 2], [1.2, 1.0, 0.8], None).unwrap();
            let volume = fem::volume_rows(&mesh, &fem::VolumeRule::STANDARD).unwrap();
            let side = |name: &str| mesh.group(name).unwrap();
            let ends = [("x-min", 0.0), ("x-max", 1.0)];
            let nodes =
                |(name, value)| mesh.facet_group_nodes(side(name)).into_iter().map(move |n| (n, value));
            let fixed: Vec<(u32, f64)> = ends.into_iter().flat_map(nodes).collect();
            let stabilisation = 100.0 / 0.005;
            let problem = LaplaceProblem { volume: &volume, fixed: &fixed, surfaces: &[], stabilisation };
            let nodal = solve_laplace(&problem).unwrap();
            let rule = fem::SurfaceRule::STANDARD;
            let surfaces =
                ends.map(|(name, value)| (fem::flux_rows(&mesh, side(name), &rule).unwrap(), value));
            let weak = LaplaceProblem { volume: &volume, fixed: &[], surfaces: &surfaces, stabilisation };
            let weak = solve_laplace(&weak).unwrap();
            for ((p, nodal), weak) in mesh.points().iter().zip(nodal).zip(weak) {
                let t = p.x / max.x;
                assert!(
                    (nodal - t).abs() < 1e-13 && (weak - t).abs() < 1e-12,
                    "{kind:?}: {nodal} {weak} {t}"
                );
            }
        }
    }

    #[test]
    fn contradictions_and_loose_bodies_are_refused() {
        let mesh =
            box_mesh(CellKind::Hex8, Point3::origin(), Point3::new(1.0, 1.0, 1.0), [2; 3], [1.0; 3], None);
        let volume = fem::volume_rows(&mesh.unwrap(), &fem::VolumeRule::STANDARD).unwrap();
        let solve = |fixed| {
            solve_laplace(&LaplaceProblem { volume: &volume, fixed, surfaces: &[], stabilisation: 1.0 })
        };
        assert!(matches!(solve(&[(3, 0.0), (3, 1.0)]), Err(SolveError::Conflict { node: 3, .. })));
        assert!(solve(&[]).is_err());
        assert!(solve(&[(0, 0.5)]).unwrap().iter().all(|t| (t - 0.5).abs() < 1e-12));
    }
}
