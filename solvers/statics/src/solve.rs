//! Factorisation and solution of an assembled problem.

use algebra::{DENSE_LIMIT, FactorError, Factorization, Multigrid, Solved, SolverPath, Stiffness, Symmetric};
use shape::{Coarser, Point3, Resultant, Vector3};

use crate::body::check_len;
use crate::error::SolveError;
use crate::load::Load;
use crate::pressure::not_definite;
use crate::problem::Assembled;
use crate::reduction::Reduction;

/// Counters of a solve by conjugate gradients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iterated {
    /// Number of conjugate-gradient iterations.
    pub count: usize,
    /// Matrix entries of all levels divided by those of the finest level.
    pub complexity: f64,
}

/// Counters and accuracy of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveInfo {
    /// Number of unknowns of the system: free degrees of freedom and multipliers.
    pub dofs: usize,
    /// Number of Lagrange multipliers among the unknowns.
    pub multipliers: usize,
    /// Number of constraint rows that were eliminated.
    pub eliminated: usize,
    /// Number of constraint rows dropped from elimination because they follow from the others.
    pub dropped: usize,
    /// Numbers stored in the factor, or in the matrices of all levels.
    pub factor_nonzeros: usize,
    /// Counters of conjugate gradients; `None` for a direct solution.
    pub iterations: Option<Iterated>,
    /// Relative residual `|b - A x| / |b|` of the reduced system.
    pub residual: f64,
    /// Accuracy measures of a direct solution.
    pub solved: Option<Solved>,
    /// Solver that was used.
    pub path: SolverPath,
}

/// Nodal parameters with counters and accuracy of the solve.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Nodal parameters, m; displacements only for a basis with the Kronecker property.
    pub u: Vec<Vector3>,
    /// Lagrange multipliers `lambda_k` of `K u + sum_k lambda_k c_k = f`, one per constraint row, N per unit
    /// of coefficient. Row `k` exerts the force `-lambda_k c_k` on the body. The multiplier is zero for
    /// dropped rows and for rows without a free term.
    pub multipliers: Vec<f64>,
    /// Counters and accuracy of the solve.
    pub info: SolveInfo,
}

/// Solver of the reduced system.
enum Solver {
    Direct(Factorization),
    /// Conjugate gradients to a relative residual of `tolerance`.
    Multigrid {
        multigrid: Box<Multigrid>,
        tolerance: f64,
    },
}

/// A factored problem, which is solved for any load level or set of loads without another factorisation.
pub struct Factored<'a> {
    problem: Assembled<'a>,
    solver: Solver,
    reduction: Reduction,
    /// Constraint rows with a free term: index, and the scale applied to the row.
    active: Vec<(usize, f64)>,
}

impl<'a> Assembled<'a> {
    /// Eliminates the prescribed degrees of freedom, appends the constraint rows and factors: Cholesky
    /// without constraint rows, `L D L^T` with them; dense if small.
    pub fn factor(self) -> Result<Factored<'a>, SolveError> {
        self.factor_with(DENSE_LIMIT)
    }

    /// Factors as [`Assembled::factor`] does, with a given size (unknowns) up to which the dense
    /// factorisation is used. It serves to compare the two factorisations.
    pub fn factor_with(self, dense_limit: usize) -> Result<Factored<'a>, SolveError> {
        let reduction = Reduction::new(&self.prescribed, &[])?;
        let mut matrix = reduction.matrix(&self.stiffness);
        let active = self.append_rows(&mut matrix, &reduction.place)?;
        self.factored(reduction, matrix, active, dense_limit)
    }

    /// Factors after elimination of the constraint rows, so the matrix stays positive definite.
    ///
    /// Each independent row expresses one of its parameters by the others; dependent rows are dropped and
    /// counted. All parameters in connected rows become coupled, so the factor grows with the square of their
    /// number.
    pub fn factor_eliminated(self) -> Result<Factored<'a>, SolveError> {
        let reduction = Reduction::new(&self.prescribed, &self.rows)?;
        let matrix = reduction.matrix(&self.stiffness);
        self.factored(reduction, matrix, Vec::new(), DENSE_LIMIT)
    }

    fn factored(
        self,
        reduction: Reduction,
        matrix: Symmetric,
        active: Vec<(usize, f64)>,
        dense_limit: usize,
    ) -> Result<Factored<'a>, SolveError> {
        let factorization = algebra::factor(matrix, dense_limit).map_err(|error| match error {
            FactorError::Other(error) => error.into(),
            FactorError::NotDefinite => match self.gamma {
                Some(gamma) => SolveError::NotCoercive { gamma },
                None => SolveError::NotPositiveDefinite,
            },
        })?;
        Ok(Factored { problem: self, solver: Solver::Direct(factorization), reduction, active })
    }

    /// Builds the multigrid hierarchy of the stiffness. `linear`, the linear mesh of a quadratic mesh,
    /// becomes the first coarse level if it is given.
    pub fn multigrid(&self, linear: Option<&Coarser>) -> Result<Multigrid, SolveError> {
        let patch = self.on_weak_supports();
        Multigrid::new(&self.stiffness, self.body.nodes, self.held(), linear, &patch).map_err(not_definite)
    }

    /// Returns a flag for each degree of freedom `3 node + axis`: true if it is prescribed.
    pub(crate) fn held(&self) -> Vec<bool> {
        self.prescribed.iter().map(Option::is_some).collect()
    }

    /// Returns the nodes whose stiffness comes in a relevant part from weak supports, ascending.
    pub(crate) fn on_weak_supports(&self) -> Vec<u32> {
        /// Smallest relevant part: nodes with less need no solution of their own. From 0.001 to 0.2 the
        /// number of iterations is the same.
        const PART: f64 = 0.1;
        let Some(forms) = &self.pointwise else { return Vec::new() };
        let penalties = forms.penalties(self.body.nodes.len());
        let whole = |node| self.stiffness.row(node).1.last().expect("every row has its diagonal").trace();
        let relevant = |&node: &usize| penalties[node] > PART * whole(node);
        (0..penalties.len()).filter(relevant).map(|node| node as u32).collect()
    }

    /// Prepares conjugate gradients with this preconditioner, to a relative residual of `tolerance`.
    ///
    /// # Errors
    /// [`SolveError::RowsNeedFactor`] if there are constraint rows.
    pub fn iterated(self, multigrid: Multigrid, tolerance: f64) -> Result<Factored<'a>, SolveError> {
        if !self.rows.is_empty() {
            return Err(SolveError::RowsNeedFactor { rows: self.rows.len() });
        }
        let reduction = Reduction::new(&self.prescribed, &[])?;
        let solver = Solver::Multigrid { multigrid: Box::new(multigrid), tolerance };
        Ok(Factored { problem: self, solver, reduction, active: Vec::new() })
    }

    /// Appends the constraint rows with a free term to the matrix and returns their indices and scales.
    fn append_rows(&self, m: &mut Symmetric, place: &[usize]) -> Result<Vec<(usize, f64)>, SolveError> {
        const CONSTRAINED: usize = usize::MAX;
        let largest = (0..m.dim()).fold(0.0f64, |l, j| l.max(m.diagonal(j).abs()));
        let mut active = Vec::new();
        for (index, row) in self.rows.iter().enumerate() {
            let terms = || row.terms.iter().filter(|t| place[t.0] != CONSTRAINED);
            let size = terms().fold(0.0f64, |s, t| s.max(t.1.abs()));
            if size == 0.0 {
                let gap = row.value - row.held_part(&self.prescribed);
                let scale = row.terms.iter().fold(row.value.abs(), |s, t| s.max(t.1.abs()));
                if gap.abs() > 1e-12 * scale {
                    return Err(SolveError::Inconsistent { row: index, gap });
                }
                continue;
            }
            // Rows are scaled to the size of the stiffness, so one regularisation fits both.
            let scale = if largest > 0.0 { largest / size } else { 1.0 / size };
            for t in terms() {
                m.rows.push(place[t.0]);
                m.values.push(scale * t.1);
            }
            m.rows.push(m.offsets.len() - 1);
            m.values.push(0.0);
            m.offsets.push(m.rows.len());
            m.vertices.push(m.offsets.len() - 1);
            active.push((index, scale));
        }
        Ok(active)
    }
}

impl<'a> Factored<'a> {
    /// Solves at `factor` times all given data, i.e. loads and prescribed displacements.
    pub fn solve(&self, factor: f64) -> Result<Solution, SolveError> {
        self.solve_for(&self.problem.load, factor, factor)
    }

    /// Solves for other loads with the same supports.
    pub fn solve_loads(&self, loads: &[Load]) -> Result<Solution, SolveError> {
        let force = self.problem.other_load(loads)?;
        self.solve_for(&force, 1.0, 1.0)
    }

    /// Solves for nodal forces (N), with supports at `factor` times their prescribed values.
    pub fn solve_forces(&self, forces: &[Vector3], factor: f64) -> Result<Solution, SolveError> {
        check_len("nodal forces", forces.len(), self.node_count())?;
        self.solve_for(forces, 1.0, factor)
    }

    /// Returns the problem, for another solver.
    pub fn into_assembled(self) -> Assembled<'a> {
        self.problem
    }

    /// Returns `K^-1 M v` with supports at rest, without refinement, for a step of a power iteration that
    /// corrects its own errors. `kv` is `K v`, `mv` is `M v`, and `alpha` approximates their ratio.
    /// Iterations start from `v / alpha` and reduce its residual to a tenth.
    pub(crate) fn inverse_step(
        &self,
        v: Vec<Vector3>,
        kv: &[Vector3],
        mv: &[Vector3],
        alpha: f64,
    ) -> Result<Vec<Vector3>, SolveError> {
        let factorization = match &self.solver {
            Solver::Direct(factorization) => factorization,
            Solver::Multigrid { multigrid, .. } => {
                let mut step: Vec<Vector3> = mv.iter().zip(kv).map(|(m, k)| m - k / alpha).collect();
                multigrid.solve(&self.problem.stiffness, &mut step, 0.1)?;
                return Ok(step.iter().zip(&v).map(|(step, v)| step + v / alpha).collect());
            }
        };
        let mut b = vec![0.0; factorization.dim()];
        self.reduction.fold(mv, &mut b);
        factorization.solve_once(&mut b)?;
        let mut u = self.reduction.constrained(0.0);
        self.reduction.expand(&b, &mut u);
        Ok(u)
    }

    /// Returns a lower bound of the accurate decimal digits of the largest displacement, from the condition
    /// of the matrix. This costs about five more solves. The result is `None` for an iterative solution.
    pub fn digits(&self, info: &SolveInfo) -> Result<Option<f64>, SolveError> {
        match (&self.solver, &info.solved) {
            (Solver::Direct(factorization), Some(solved)) => Ok(Some(factorization.digits(solved)?)),
            _ => Ok(None),
        }
    }

    /// Smallest factor of Nitsche's method, if any support uses this method.
    pub(crate) fn gamma(&self) -> Option<f64> {
        self.problem.gamma
    }

    /// The forms point by point, kept for weak supports and constraint rows.
    pub(crate) fn forms(&self) -> Option<&crate::problem::Pointwise> {
        self.problem.pointwise.as_ref()
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.problem.load.len()
    }

    /// Solves at `part` times the load and `factor` times the prescribed values.
    fn solve_for(&self, load: &[Vector3], part: f64, factor: f64) -> Result<Solution, SolveError> {
        if !(part.is_finite() && factor.is_finite()) {
            return Err(SolveError::NotFinite { what: "load factor", index: 0 });
        }
        let p = &self.problem;
        let mut u = self.reduction.constrained(factor);
        let constrained = p.stiffness.multiply(&u);
        let forces: Vec<Vector3> =
            (0..load.len()).map(|i| load[i] * part + p.weak_load[i] * factor - constrained[i]).collect();
        let (factorization, forces) = match &self.solver {
            Solver::Direct(factorization) => (factorization, forces),
            Solver::Multigrid { multigrid, tolerance } => {
                return self.iterate(multigrid, *tolerance, forces, u);
            }
        };
        let mut b = vec![0.0; factorization.dim()];
        self.reduction.fold(&forces, &mut b);
        let free = self.reduction.free;
        for (k, &(index, scale)) in self.active.iter().enumerate() {
            let row = &p.rows[index];
            b[free + k] = factor * scale * (row.value - row.held_part(&p.prescribed));
        }
        let solved = factorization.solve_judged(&mut b)?;
        self.reduction.expand(&b, &mut u);
        if let (Some(forms), true) = (&p.pointwise, self.active.is_empty()) {
            self.refine(factorization, forms, load, (part, factor), &mut u)?;
        }
        let mut multipliers = vec![0.0; p.rows.len()];
        for (k, &(index, scale)) in self.active.iter().enumerate() {
            multipliers[index] = scale * b[free + k];
        }
        self.add_forces_of_eliminated(&u, load, (part, factor), &mut multipliers);
        let info = SolveInfo {
            dofs: b.len(),
            multipliers: self.active.len(),
            eliminated: self.reduction.eliminated(),
            dropped: self.reduction.dropped,
            factor_nonzeros: factorization.nonzeros(),
            iterations: None,
            residual: solved.residual,
            solved: Some(solved),
            path: factorization.path(),
        };
        Ok(Solution { u, multipliers, info })
    }

    /// Solves for `forces` by conjugate gradients and adds the result to the prescribed part.
    fn iterate(
        &self,
        multigrid: &Multigrid,
        tolerance: f64,
        mut forces: Vec<Vector3>,
        mut u: Vec<Vector3>,
    ) -> Result<Solution, SolveError> {
        /// Ratio of the forces in a body to those by which a penalty of 1e4 E/h moves it.
        const OF_BODY: f64 = 1e-4;
        let moved = self.problem.weak_load.iter().any(|force| *force != Vector3::zeros());
        let tolerance = if moved && !multigrid.has_patch() { OF_BODY * tolerance } else { tolerance };
        let done = multigrid.solve(&self.problem.stiffness, &mut forces, tolerance)?;
        u.iter_mut().zip(&forces).for_each(|(u, step)| *u += step);
        let info = SolveInfo {
            dofs: multigrid.dim(),
            multipliers: 0,
            eliminated: 0,
            dropped: 0,
            factor_nonzeros: multigrid.levels().iter().map(|level| level.1).sum(),
            iterations: Some(Iterated { count: done.count, complexity: multigrid.complexity() }),
            residual: done.residual,
            solved: None,
            path: multigrid.path(),
        };
        Ok(Solution { u, multipliers: Vec::new(), info })
    }

    /// Refines the solution in at most two steps, with the residual of the forms themselves at `part` of the
    /// load and `factor` of the prescribed values.
    ///
    /// A step reduces the error by about the relative error of the factorisation, which the first step
    /// reveals (Higham 2002, section 12.1). After a first step below 1e-9 the second is omitted.
    fn refine(
        &self,
        factorization: &Factorization,
        forms: &crate::problem::Pointwise,
        load: &[Vector3],
        (part, factor): (f64, f64),
        u: &mut [Vector3],
    ) -> Result<(), SolveError> {
        for _ in 0..2 {
            let mut residual: Vec<Vector3> = load.iter().map(|f| f * part).collect();
            forms.subtract(u, factor, &mut residual);
            let mut b = vec![0.0; factorization.dim()];
            self.reduction.fold(&residual, &mut b);
            factorization.solve_judged(&mut b)?;
            self.reduction.expand(&b, u);
            let largest = u.iter().fold(0.0f64, |l, u| l.max(u.amax()));
            if b.iter().all(|step| step.abs() <= 1e-9 * largest) {
                break;
            }
        }
        Ok(())
    }

    /// Computes the multipliers of eliminated rows: `E^T (f - K u)` at the parameters they eliminate.
    fn add_forces_of_eliminated(
        &self,
        u: &[Vector3],
        load: &[Vector3],
        (part, factor): (f64, f64),
        multipliers: &mut [f64],
    ) {
        if self.reduction.blocks.is_empty() {
            return;
        }
        let p = &self.problem;
        let inner = p.stiffness.multiply(u);
        for block in &self.reduction.blocks {
            for (&dof, inverse) in block.pivots.iter().zip(block.inverse.chunks_exact(block.rows.len())) {
                let (i, a) = (dof / 3, dof % 3);
                let force = part * load[i][a] + factor * p.weak_load[i][a] - inner[i][a];
                block.rows.iter().zip(inverse).for_each(|(&row, e)| multipliers[row] += e * force);
            }
        }
    }

    /// Returns the forces (N) that the eliminated supports exert on the nodes, for a solution under `factor`
    /// times the problem's own loads. The force is `K u - f` at prescribed degrees of freedom, minus the part
    /// taken by constraint rows, and zero elsewhere.
    pub fn reactions(&self, solution: &Solution, factor: f64) -> Vec<Vector3> {
        let p = &self.problem;
        let mut out = p.stiffness.multiply(&solution.u);
        for i in 0..out.len() {
            out[i] -= (p.load[i] + p.weak_load[i]) * factor;
        }
        for (row, lambda) in p.rows.iter().zip(&solution.multipliers) {
            for &(dof, c) in &row.terms {
                out[dof / 3][dof % 3] += lambda * c;
            }
        }
        for (dof, _) in p.prescribed.iter().enumerate().filter(|(_, constrained)| constrained.is_none()) {
            out[dof / 3][dof % 3] = 0.0;
        }
        out
    }

    /// Returns the resultant of the forces that each constraint row exerts on the body with these `nodes` (m):
    /// `-lambda_k c_k` along each axis.
    pub fn forces_of_rows(&self, nodes: &[Point3], solution: &Solution) -> Vec<Resultant> {
        let each = self.problem.rows.iter().zip(&solution.multipliers);
        each.map(|(row, lambda)| {
            let mut sum = Resultant::default();
            for &(dof, c) in &row.terms {
                sum.add(&nodes[dof / 3], &Vector3::ith(dof % 3, -lambda * c));
            }
            sum
        })
        .collect()
    }

    /// Returns the resultant of the forces that each weak support exerts on the body with these `nodes` (m).
    pub fn forces_of_weak(&self, nodes: &[Point3], solution: &Solution, factor: f64) -> Vec<Resultant> {
        let forms = self.problem.pointwise.as_ref();
        forms.map_or_else(Vec::new, |forms| forms.resultants(nodes, &solution.u, factor))
    }

    /// Stiffness before elimination.
    pub fn stiffness(&self) -> &Stiffness {
        &self.problem.stiffness
    }
}
