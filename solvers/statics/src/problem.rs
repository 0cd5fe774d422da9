//! A linear problem and its assembly.

use algebra::{BlockPattern, Connectivity, Incidence, Stiffness};
use shape::{FixedDof, Point3, Resultant, Vector3};

use crate::assembly::add_volume;
use crate::body::{LinearBody, check_len};
use crate::constraint::{self, ConstraintRow};
use crate::dilation::Projected;
use crate::error::SolveError;
use crate::grad_table::GradTable;
use crate::hourglass::springs;
use crate::load::{Load, nodal_forces};
use crate::nonlinear::SurfaceTable;
use crate::rigid;
use crate::support::prescribed;
use crate::weak::{Weak, WeakSupport, WeakTable};

/// A body with its loads and supports. The three kinds of support can be mixed, provided no rigid motion is
/// left free.
#[derive(Clone, Copy, Debug)]
pub struct LinearProblem<'a> {
    /// The body.
    pub body: LinearBody<'a>,
    /// Loads, which are summed.
    pub loads: &'a [Load<'a>],
    /// Prescribed nodal parameters, eliminated exactly.
    pub fixed: &'a [FixedDof],
    /// General linear constraints; the factorisation determines whether they are eliminated or enforced by
    /// Lagrange multipliers.
    pub constraints: &'a [ConstraintRow],
    /// Weakly constrained surfaces.
    pub weak: &'a [WeakSupport<'a>],
}

/// Stiffness, forces and checked supports of a problem, ready to be factored.
pub struct Assembled<'a> {
    pub(crate) body: LinearBody<'a>,
    pub(crate) stiffness: Stiffness,
    /// Nodal forces of the loads, N.
    pub(crate) load: Vec<Vector3>,
    /// Right-hand side of the weak supports, N.
    pub(crate) weak_load: Vec<Vector3>,
    /// Prescribed value by degree of freedom `3 node + axis`, m.
    pub(crate) prescribed: Vec<Option<f64>>,
    pub(crate) rows: Vec<constraint::Row>,
    /// Smallest Nitsche factor of all supports; `None` without Nitsche supports.
    pub(crate) gamma: Option<f64>,
    /// The forms point by point, kept if there are weak supports or constraint rows; see [`Pointwise`].
    pub(crate) pointwise: Option<Pointwise>,
}

/// The forms point by point, for a residual that does not use the assembled matrix.
///
/// For a wide smooth basis with stiff weak supports, the entries of the matrix are accurate to 1e-16 of the
/// largest entry. The residual of a solution is then known only to 1e-16 `|K| |u|`, and stresses of a patch
/// test are accurate to 1e-12 to 6e-12. The sum point by point, from differences of displacements, reduces
/// this error by the ratio of displacement to strain times support radius.
pub(crate) struct Pointwise {
    volume: Vec<GradTable>,
    springs: Option<SurfaceTable>,
    weak: Vec<(WeakTable, Incidence)>,
}

impl Pointwise {
    /// Returns the trace of the penalty of all weak supports at each node, N/m.
    pub(crate) fn penalties(&self, nodes: usize) -> Vec<f64> {
        let mut sums = vec![0.0; nodes];
        self.weak.iter().for_each(|(table, _)| table.add_penalties(&mut sums));
        sums
    }

    /// Subtracts the internal forces and those of the weak supports (at `factor` times their values) from
    /// `residual`, N.
    pub fn subtract(&self, u: &[Vector3], factor: f64, residual: &mut [Vector3]) {
        for table in &self.volume {
            table.subtract_force(u, residual);
        }
        if let Some(springs) = &self.springs {
            let (forces, _) = springs.spring_forces(u);
            residual.iter_mut().zip(&forces).for_each(|(residual, force)| *residual -= force);
        }
        for (table, of) in &self.weak {
            table.subtract_residual(of, u, factor, residual);
        }
    }

    /// Returns the resultant of the forces that each weak support exerts on the body, at nodal parameters
    /// `u` (m) and `factor` times the prescribed values.
    pub fn resultants(&self, nodes: &[Point3], u: &[Vector3], factor: f64) -> Vec<Resultant> {
        let each = self.weak.iter().map(|(table, of)| {
            let mut forces = vec![Vector3::zeros(); u.len()];
            table.subtract_residual(of, u, factor, &mut forces);
            let mut sum = Resultant::default();
            nodes.iter().zip(&forces).for_each(|(x, force)| sum.add(x, force));
            sum
        });
        each.collect()
    }

    /// Adds Nitsche's consistency terms, `integral of (t_a(u) v_a + u_a t_a(v))`, to the nodal forces.
    pub fn add_consistency(&self, u: &[Vector3], force: &mut [Vector3]) {
        for (table, of) in &self.weak {
            table.add_consistency(of, u, force);
        }
    }
}

/// Checks the problem, builds the sparsity pattern and assembles stiffness and forces.
///
/// # Errors
/// Invalid input, and rigid motions that are left free; both are found before any factorisation.
pub fn assemble<'a>(problem: &LinearProblem<'a>) -> Result<Assembled<'a>, SolveError> {
    assemble_if(problem, rigid::check)
}

/// Assembles as [`assemble`] does, for a body that need not be constrained.
pub(crate) fn assemble_free<'a>(problem: &LinearProblem<'a>) -> Result<Assembled<'a>, SolveError> {
    assemble_if(problem, |_, _, _, _, _| Ok(()))
}

/// Check of the supports before assembly.
type SupportCheck = fn(
    &LinearBody,
    Connectivity,
    &[Option<f64>],
    &[constraint::Row],
    &[WeakSupport],
) -> Result<(), SolveError>;

fn assemble_if<'a>(problem: &LinearProblem<'a>, holds: SupportCheck) -> Result<Assembled<'a>, SolveError> {
    let body = problem.body;
    body.check()?;
    let nodes = body.nodes.len();
    for (index, support) in problem.weak.iter().enumerate() {
        support.check(index, &body)?;
    }
    let prescribed = prescribed(nodes, problem.fixed)?;
    let rows = constraint::sorted(problem.constraints, nodes)?;
    let load = nodal_forces(body.volume, problem.loads)?;

    let points = GradTable::points(&body);
    let points_of = points.incidence(nodes);
    let groups = GradTable::groups(&body)?;
    let groups_of = groups.as_ref().map(|table| table.incidence(nodes));
    let traced = problem.weak.iter().filter_map(|s| s.trace).flat_map(|t| t.points().iter().copied());
    let projected = Projected::new(&body, traced);
    let weak: Vec<_> = problem
        .weak
        .iter()
        .map(|support| {
            let table = WeakTable::new(support, &body, projected.as_ref());
            let incidence = table.incidence(nodes);
            (table, incidence)
        })
        .collect();

    let mut tables = vec![(points.connectivity(), &points_of)];
    tables.extend(groups.iter().zip(&groups_of).map(|(table, of)| (table.connectivity(), of)));
    tables.extend(weak.iter().map(|(table, of)| (table.connectivity(), of)));
    let pattern = BlockPattern::new(nodes, &tables);
    if let Some(node) = (0..nodes)
        .find(|&i| points_of.of(i).is_empty() && prescribed[3 * i..3 * i + 3].iter().any(Option::is_none))
    {
        return Err(SolveError::OrphanNode { node });
    }
    holds(&body, points.connectivity(), &prescribed, &rows, problem.weak)?;

    let mut stiffness = Stiffness::zeros(pattern);
    add_volume(&mut stiffness, &points, &points_of);
    if let (Some(table), Some(of)) = (&groups, &groups_of) {
        add_volume(&mut stiffness, table, of);
    }
    let springs = springs(body.volume, |q| [body.material(q).lambda(), body.material(q).mu()]);
    if let Some(springs) = &springs {
        stiffness.for_each_row(|i, slot, row| springs.add_springs(i, slot, row));
    }
    let mut weak_load = vec![Vector3::zeros(); nodes];
    for (table, of) in &weak {
        table.add_stiffness(&mut stiffness, of);
        table.add_force(of, &mut weak_load);
    }
    let gammas = problem.weak.iter().filter_map(|s| match s.method {
        Weak::Nitsche { gamma } => Some(gamma),
        Weak::Penalty { .. } | Weak::Spring { .. } => None,
    });
    let gamma = gammas.reduce(f64::min);
    let pointwise = (!weak.is_empty() || !rows.is_empty()).then(|| {
        let volume = std::iter::once(points).chain(groups).collect();
        Pointwise { volume, springs, weak }
    });
    Ok(Assembled { body, stiffness, load, weak_load, prescribed, rows, gamma, pointwise })
}

impl<'a> Assembled<'a> {
    /// Returns the stiffness with the terms of weak supports, before any degree of freedom is eliminated.
    pub fn stiffness(&self) -> &Stiffness {
        &self.stiffness
    }

    /// Nodal forces of the loads, N.
    pub fn load(&self) -> &[Vector3] {
        &self.load
    }

    /// Number of free degrees of freedom and constraint rows.
    pub fn dofs(&self) -> usize {
        self.prescribed.iter().filter(|p| p.is_none()).count() + self.rows.len()
    }

    /// Returns the nodal forces of other loads on the same body, N.
    pub(crate) fn other_load(&self, loads: &[Load]) -> Result<Vec<Vector3>, SolveError> {
        let force = nodal_forces(self.body.volume, loads)?;
        check_len("nodal forces", force.len(), self.load.len())?;
        Ok(force)
    }
}
