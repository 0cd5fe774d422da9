//! Stress fields in equilibrium with the loads.

use fem::{EquilibriumTet, FaceNumbers, Response};
use geometry::{Mesh, Vector3};
use rayon::prelude::*;
use shape::FixedDof;
use statics::{Cells, factor_cells};

use super::field::Field;
use super::on_faces::OnFaces;
use crate::error::{Failure, Key};
use crate::scenario::setup::Setup;

/// Rounding of sums, relative to their largest terms.
const ROUNDING: f64 = 1e-13;
/// Rounding of the equilibrium inside a cell, relative to its forces.
const OF_FORCES: f64 = 1e-14;
/// Factor from the largest displacement of the faces to a safe bound of the solution's, which works on the
/// forces that rounding leaves out of balance.
const LARGEST: f64 = 10.0;
/// Force on supports without faces above which a load is out of balance, relative to all forces.
const OUT_OF_BALANCE: f64 = 1e-9;

/// Stress fields of all causes, by the displacements of the faces.
pub(super) struct Balanced<'a> {
    elements: Elements<'a>,
    on_faces: &'a OnFaces,
    /// Displacement of each cause, m.
    fields: Vec<Vec<Vector3>>,
    dofs: usize,
}

/// The elements of a mesh.
struct Elements<'a> {
    faces: &'a FaceNumbers,
    mesh: &'a Mesh,
    setup: &'a Setup,
    /// Nodes of each cell.
    nodes: Vec<[u32; 12]>,
}

/// Stress of all cells for displacements of their faces.
struct Stress {
    /// Complementary energy, J.
    energy: f64,
    /// Sum of the cells' moments of tractions at each node of the faces, N.
    forces: Vec<Vector3>,
    /// Rounding of the energy and of the work of the forces, J.
    rounding: f64,
}

impl<'a> Balanced<'a> {
    /// Solves for each cause.
    pub fn new(
        faces: &'a FaceNumbers,
        mesh: &'a Mesh,
        setup: &'a Setup,
        on_faces: &'a OnFaces,
    ) -> Result<Balanced<'a>, Failure> {
        let nodes = (0..faces.cell_count()).map(|cell| faces.nodes(cell)).collect();
        let elements = Elements { faces, mesh, setup, nodes };
        let stiffness = elements.each(|tet, _| tet.stiffness())?;
        let cells = Cells { nodes: &elements.nodes, stiffness: &stiffness };
        let fixed = [&on_faces.fixed[..], &on_faces.anchors].concat();
        let factored = factor_cells(3 * faces.faces().len(), &cells, &fixed)?;
        let solve = |(cause, load): (usize, &Vec<Vector3>)| -> Result<Vec<Vector3>, Failure> {
            let moves = f64::from(u8::from(cause == 0));
            let acts = on_faces.acts(cause);
            if acts { Ok(factored.solve(load, moves)?) } else { Ok(vec![Vector3::zeros(); load.len()]) }
        };
        let fields = on_faces.loads.iter().enumerate().map(solve).collect::<Result<_, _>>()?;
        Ok(Balanced { elements, on_faces, fields, dofs: factored.dofs() })
    }

    /// Number of unknowns.
    pub fn dofs(&self) -> usize {
        self.dofs
    }

    /// The field of a sum of causes, each with its weight.
    pub fn field(&self, weights: &[f64]) -> Result<Field, Failure> {
        let sum = |of: &[Vec<Vector3>]| -> Vec<Vector3> {
            let at = |i: usize| of.iter().zip(weights).map(|(of, weight)| of[i] * *weight).sum();
            (0..self.fields[0].len()).map(at).collect()
        };
        let (u, applied) = (sum(&self.fields), sum(&self.on_faces.loads));
        let stress = self.elements.stress(&u)?;
        self.check_anchors(&stress.forces, &applied)?;
        // A load on a supported face takes its part of the support's force.
        let works = self.on_faces.fixed.iter().map(|dof| {
            let node = dof.node as usize;
            (stress.forces[node] - applied[node])[usize::from(dof.axis)] * (weights[0] * dof.value)
        });
        let (work, size) = works.fold((0.0, 0.0), |(work, size), part| (work + part, size + part.abs()));
        let lost = self.lost(&stress.forces, &applied, &u);
        Ok(Field { energy: stress.energy, work, rounding: lost + stress.rounding + ROUNDING * size })
    }

    /// Refuses loads that supports at points or edges have to balance.
    fn check_anchors(&self, forces: &[Vector3], applied: &[Vector3]) -> Result<(), Failure> {
        let whole: f64 = forces.iter().map(|force| force.norm()).sum();
        let of = |dof: &FixedDof| {
            let node = dof.node as usize;
            (forces[node] - applied[node])[usize::from(dof.axis)].abs()
        };
        let largest = self.on_faces.anchors.iter().map(of).fold(0.0, f64::max);
        if largest <= OUT_OF_BALANCE * whole {
            return Ok(());
        }
        let problem = format!(
            "needs supports on faces: loads or means press on points or edges with {largest:.3e} N, where the exact energy is \
             infinite"
        );
        Err(Failure::input(Key::Scene("output.bounds".into()), problem, "support a surface"))
    }

    /// Work of the solution on the forces out of balance, at most, J.
    fn lost(&self, forces: &[Vector3], applied: &[Vector3], u: &[Vector3]) -> f64 {
        let mut gaps: Vec<Vector3> = forces.iter().zip(applied).map(|(f, a)| (a - f).abs()).collect();
        self.on_faces.fixed.iter().for_each(|dof| gaps[dof.node as usize][usize::from(dof.axis)] = 0.0);
        let largest = u.iter().map(|u| u.amax()).fold(0.0, f64::max);
        LARGEST * largest * gaps.iter().map(|gap| gap.sum()).sum::<f64>()
    }
}

impl Elements<'_> {
    /// Evaluates all elements in parallel, each with its number.
    fn each<T: Send>(&self, of: impl Fn(EquilibriumTet, usize) -> T + Sync) -> Result<Vec<T>, Failure> {
        let one = |cell: usize| {
            let corners = self.faces.corners(cell).map(|node| self.mesh.points()[node as usize]);
            let material = &self.setup.materials[usize::from(self.mesh.region(cell))];
            let tet = EquilibriumTet::new(cell, &corners, material.bulk(), material.mu())?;
            Ok(of(tet, cell))
        };
        (0..self.nodes.len()).into_par_iter().map(one).collect()
    }

    fn stress(&self, u: &[Vector3]) -> Result<Stress, Failure> {
        let own = |cell: usize| self.nodes[cell].map(|node| u[node as usize]);
        let of_cells: Vec<Response> = self.each(|tet, cell| tet.respond(&own(cell)))?;
        let mut stress = Stress { energy: 0.0, forces: vec![Vector3::zeros(); u.len()], rounding: 0.0 };
        for (of, nodes) in of_cells.iter().zip(&self.nodes) {
            stress.energy += of.energy;
            for (moment, &node) in of.moments.iter().zip(nodes) {
                stress.forces[node as usize] += moment;
                stress.rounding += OF_FORCES * moment.norm() * u[node as usize].norm();
            }
        }
        stress.rounding += ROUNDING * stress.energy;
        Ok(stress)
    }
}
