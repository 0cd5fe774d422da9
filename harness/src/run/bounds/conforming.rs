//! Compatible displacement fields: elements of second order, fully integrated.

use geometry::Vector3;
use statics::{LinearBody, assemble};

use super::field::Field;
use super::on_faces::OnFaces;
use crate::discretise::Discretisation;
use crate::error::Failure;
use crate::outcome::Counters;
use crate::prepare::{Prepared, prepare};
use crate::procedure::{Wanted, plan};
use crate::scenario::setup::Setup;

/// Rounding of sums, relative to their largest terms.
const ROUNDING: f64 = 1e-13;
/// Rounding of the strains, relative to the products that they are sums of.
const OF_STRAINS: f64 = 1e-14;

/// Displacement fields of all causes.
pub(super) struct Compatible<'a> {
    method: &'a Discretisation,
    setup: &'a Setup,
    prepared: Prepared,
    causes: Causes,
}

/// Solutions of all causes.
struct Causes {
    /// Nodal forces of each, N.
    loads: Vec<Vec<Vector3>>,
    /// Displacement of each, m.
    fields: Vec<Vec<Vector3>>,
    /// Number of unknowns.
    dofs: usize,
}

impl<'a> Compatible<'a> {
    /// Solves for each cause.
    pub fn new(
        method: &'a Discretisation,
        setup: &'a Setup,
        on_faces: &OnFaces,
    ) -> Result<Compatible<'a>, Failure> {
        let plan = plan(method, setup, Wanted::default());
        let prepared = prepare(method, setup, &plan, &mut Counters::default())?;
        let causes = Causes::solved(method, setup, &prepared, on_faces)?;
        Ok(Compatible { method, setup, prepared, causes })
    }

    /// Number of unknowns.
    pub fn dofs(&self) -> usize {
        self.causes.dofs
    }

    /// The field of a sum of causes, each with its weight.
    pub fn field(&self, weights: &[f64]) -> Result<Field, Failure> {
        let sum = |of: &[Vec<Vector3>]| -> Vec<Vector3> {
            let at = |i: usize| of.iter().zip(weights).map(|(of, weight)| of[i] * *weight).sum();
            (0..self.method.nodes().len()).map(at).collect()
        };
        let (u, load) = (sum(&self.causes.fields), sum(&self.causes.loads));
        let prepared = &self.prepared;
        let body = prepared.problem(self.method.nodes(), self.setup, &[], &[]).body;
        let energy = statics::strain_energy(&body, &u)?;
        let work = load.iter().zip(&u).map(|(force, u)| force.dot(u)).sum();
        let terms: f64 = load.iter().zip(&u).map(|(force, u)| force.norm() * u.norm()).sum();
        let strains = (energy * of_terms(&body, &u)).sqrt();
        Ok(Field { energy, work, rounding: ROUNDING * (energy + terms) + OF_STRAINS * strains })
    }
}

impl Causes {
    /// Solves the system of the body for each cause.
    fn solved(
        method: &Discretisation,
        setup: &Setup,
        prepared: &Prepared,
        on_faces: &OnFaces,
    ) -> Result<Causes, Failure> {
        let (acting, weak) = (prepared.loads(), prepared.weak());
        let assembled = assemble(&prepared.problem(method.nodes(), setup, &acting, &weak))?;
        let none = vec![Vector3::zeros(); method.nodes().len()];
        let mut loads = vec![none.clone(), assembled.load().to_vec()];
        for row in prepared.means(&setup.output.means)? {
            for axis in 0..3 {
                let mut load = none.clone();
                row.iter().for_each(|&(node, weight)| load[node as usize][axis] = weight);
                loads.push(load);
            }
        }
        let dofs = assembled.dofs();
        let factored = assembled.factor()?;
        let mut fields = Vec::new();
        for (cause, load) in loads.iter().enumerate() {
            let moves = f64::from(u8::from(cause == 0));
            let acts = on_faces.acts(cause);
            fields.push(if acts { factored.solve_forces(load, moves)?.u } else { none.clone() });
        }
        Ok(Causes { loads, fields, dofs })
    }
}

/// Strain energy of the magnitudes of all products in the strains, J.
fn of_terms(body: &LinearBody, u: &[Vector3]) -> f64 {
    let rows = body.volume.rows();
    let energy = |q: usize| {
        let range = rows.offsets()[q]..rows.offsets()[q + 1];
        let grads = &body.volume.grads()[range];
        let strain: f64 =
            rows.row(q).0.iter().zip(grads).map(|(&n, g)| g.norm() * u[n as usize].norm()).sum();
        let law = &body.materials[body.region.get(q).map_or(0, |&region| usize::from(region))];
        body.volume.weights()[q] * (law.bulk() + law.mu()) * strain.powi(2)
    };
    (0..body.volume.weights().len()).map(energy).sum()
}
