//! Number of accurate digits of a solution: estimated and true.

use algebra::{AlgebraError, DENSE_LIMIT, Factorization, Symmetric, factor};
use fem::VolumeRule;
use geometry::CellKind;
use integration::cuboid::Cuboid;
use material::LinearElastic;
use shape::{DilationGroups, FixedDof, Point3, Vector3};
use statics::{LinearBody, LinearProblem, Load, SolveError, assemble};

/// A factored stiffness over the unconstrained degrees of freedom, and a load.
struct System {
    factored: Factorization,
    load: Vec<f64>,
}

fn system(
    block: &Cuboid,
    poisson: f64,
    mean: bool,
    fixed: &[FixedDof],
    force: impl Fn(&Point3) -> Vector3,
) -> System {
    let groups: Option<DilationGroups> =
        mean.then(|| fem::element_dilation(&block.mesh, &VolumeRule::STANDARD).unwrap());
    let material = [LinearElastic::new(20e3, poisson).unwrap()];
    let body = LinearBody {
        nodes: block.nodes(),
        volume: &block.volume,
        materials: &material,
        region: &[],
        dilation: groups.as_ref(),
    };
    let loads = [Load::Body { values: block.volume.points().iter().map(force).collect() }];
    let problem = LinearProblem { body, loads: &loads, fixed, constraints: &[], weak: &[] };
    let assembled = assemble(&problem).unwrap();
    let nodal = assembled.load().to_vec();
    let solved = assembled.factor().unwrap();
    let mut place = vec![0; 3 * block.nodes().len()];
    fixed.iter().for_each(|f| place[3 * f.node as usize + f.axis as usize] = usize::MAX);
    let mut free = 0;
    for at in place.iter_mut().filter(|at| **at != usize::MAX) {
        *at = free;
        free += 1;
    }
    let matrix = Symmetric::displacements(solved.stiffness(), &place, free);
    let load = (0..place.len()).filter(|&k| place[k] != usize::MAX).map(|k| nodal[k / 3][k % 3]).collect();
    System { factored: factor(matrix, DENSE_LIMIT).unwrap(), load }
}

/// A sum stored in two numbers (exact sum and product of Knuth and Dekker).
#[derive(Clone, Copy, Default)]
struct Twice(f64, f64);

impl Twice {
    fn add(&mut self, a: f64) {
        let sum = self.0 + a;
        let part = sum - self.0;
        self.1 += (self.0 - (sum - part)) + (a - part);
        self.0 = sum;
    }

    fn add_product(&mut self, a: f64, b: f64) {
        let product = a * b;
        self.add(product);
        self.1 += a.mul_add(b, -product);
    }
}

impl System {
    /// Returns the solution to all digits, refined with residuals of twice the precision.
    fn exact(&self) -> Vec<f64> {
        let matrix = &self.factored.matrix;
        let mut x: Vec<Twice> = vec![Twice::default(); matrix.dim()];
        for _ in 0..12 {
            let mut rest: Vec<Twice> = self.load.iter().map(|&b| Twice(b, 0.0)).collect();
            for j in 0..matrix.dim() {
                for k in matrix.offsets[j]..matrix.offsets[j + 1] {
                    let (i, a) = (matrix.rows[k], matrix.values[k]);
                    for part in [x[i].0, x[i].1] {
                        rest[j].add_product(-a, part);
                    }
                    if i != j {
                        for part in [x[j].0, x[j].1] {
                            rest[i].add_product(-a, part);
                        }
                    }
                }
            }
            let mut step: Vec<f64> = rest.iter().map(|r| r.0 + r.1).collect();
            self.factored.solve_judged(&mut step).unwrap();
            x.iter_mut().zip(&step).for_each(|(x, d)| x.add(*d));
        }
        x.iter().map(|x| x.0 + x.1).collect()
    }

    /// Returns the residual, the estimated digits and the true digits of a solution.
    fn digits(&self) -> (f64, f64, f64) {
        let mut x = self.load.clone();
        let solved = self.factored.solve_judged(&mut x).unwrap();
        let exact = self.exact();
        let size = exact.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let error = x.iter().zip(&exact).fold(0.0f64, |m, (x, e)| m.max((x - e).abs())) / size;
        assert!(self.factored.backward_error(&solved) < 1e-15, "{solved:?}");
        (solved.residual, self.factored.digits(&solved).unwrap(), -error.log10())
    }
}

/// For a beam 100 times as long as high, rounding leaves a residual of 1e-7 of the load, and an error of at
/// least 1e-8 of the displacement.
#[test]
fn slender_beams_are_solved_with_the_digits_that_are_expected() {
    for (kind, mean) in [(CellKind::Tet10, false), (CellKind::Hex20, false), (CellKind::Hex8, true)] {
        for slender in [60, 80, 100] {
            let block = Cuboid::new(kind, [0.01 * slender as f64, 0.01, 0.01], [2 * slender, 2, 2]);
            let fixed = block.constrained(|x, _| (x.x == 0.0).then_some(0.0));
            let system = system(&block, 0.3, mean, &fixed, |_| Vector3::new(0.0, 0.0, -1.0));
            let (residual, expected, digits) = system.digits();
            println!("{kind:?} {slender}: {residual:e} {expected} {digits}");
            assert!(residual > 1e-9, "{kind:?} {slender}: {residual:e} would pass for the load");
            // The estimate is a bound that holds for any matrix and any rounding of this size.
            assert!(
                (expected..expected + 4.0).contains(&digits),
                "{kind:?} {slender}: {digits} for {expected}"
            );
            assert!(expected > 4.0, "{kind:?} {slender}: {expected}");
        }
    }
}

/// Cook's membrane in plane strain, one cell thick, nearly incompressible.
#[test]
fn a_membrane_of_1024_cells_is_solved_nearly_incompressible() {
    let mut block = Cuboid::new(CellKind::Hex8, [0.048, 1.0, 0.048 / 32.0], [32, 32, 1]);
    block.mesh = block
        .mesh
        .moved(|x| {
            let along = x.x / 0.048;
            let (low, high) = (0.044 * along, 0.044 + 0.016 * along);
            Point3::new(x.x, low + (high - low) * x.y, x.z)
        })
        .unwrap();
    block.volume = fem::volume_rows(&block.mesh, &VolumeRule::STANDARD).unwrap();
    let fixed = block.constrained(|x, axis| (x.x == 0.0 || axis == 2).then_some(0.0));
    let system = system(&block, 0.4999, true, &fixed, |_| Vector3::new(0.0, 1e3, 0.0));
    let (residual, expected, digits) = system.digits();
    println!("Cook: {residual:e} {expected} {digits}");
    assert!((expected..expected + 4.0).contains(&digits), "{digits} for {expected}, {residual:e}");
    assert!(expected > 6.0, "{expected}");
}

/// A force that no support carries, a thousandth of a rounding error away from equilibrium: the motion has no
/// accurate digit.
#[test]
fn a_free_body_is_refused_however_small_what_moves_it() {
    let block = Cuboid::new(CellKind::Hex8, [0.04, 0.03, 0.02], [6, 5, 5]);
    let material = [LinearElastic::new(20e3, 0.3).unwrap()];
    let body = LinearBody {
        nodes: block.nodes(),
        volume: &block.volume,
        materials: &material,
        region: &[],
        dilation: None,
    };
    let stretch = |x: &Point3| Vector3::new(x.x - 0.02, 0.0, 0.0);
    let loads = [Load::Body { values: block.volume.points().iter().map(stretch).collect() }];
    let problem = LinearProblem { body, loads: &loads, fixed: &[], constraints: &[], weak: &[] };
    let refused = assemble(&problem).and_then(|assembled| assembled.factor()?.solve(1.0)).unwrap_err();
    assert!(matches!(refused, SolveError::RigidMotion { .. }), "{refused:?}");
    // The matrix alone.
    let held = [FixedDof { node: 0, axis: 0, value: 0.0 }];
    let sound = LinearProblem { fixed: &block.constrained(|x, _| (x.x == 0.0).then_some(0.0)), ..problem };
    let stiffness = assemble(&sound).unwrap().factor().unwrap().stiffness().clone();
    let n = 3 * block.nodes().len();
    let place: Vec<usize> = (0..n).map(|k| if k == 0 { usize::MAX } else { k - 1 }).collect();
    let matrix = Symmetric::displacements(&stiffness, &place, n - held.len());
    for dense_limit in [0, usize::MAX] {
        let end = factor(matrix.clone(), dense_limit)
            .map_err(|_| AlgebraError::ZeroPivot)
            .and_then(|factored| factored.solve_judged(&mut vec![1.0; n - 1]));
        assert!(end.is_err(), "{end:?}");
    }
}

/// `A^-1 = diag(2, 1, 1, 1, 1) + c v v^T` with `v` orthogonal to the vector of ones and to the first axis.
/// The rounds of the estimate search along these two vectors only, and find 2. The norm of the inverse is
/// that of a later column, `1 + 4 c`.
#[test]
fn what_the_rounds_of_the_estimate_do_not_see_its_last_vector_does() {
    let (c, v) = (1e6, [0.0, 1.0, -1.0, 1.0, -1.0]);
    let diagonal = [0.5, 1.0, 1.0, 1.0, 1.0];
    let entry =
        |i: usize, j: usize| if i == j { diagonal[i] } else { 0.0 } - c / (1.0 + 4.0 * c) * v[i] * v[j];
    let matrix = Symmetric {
        offsets: (0..=5).map(|j| j * (j + 1) / 2).collect(),
        rows: (0..5).flat_map(|j| 0..=j).collect(),
        values: (0..5).flat_map(|j| (0..=j).map(move |i| entry(i, j)).collect::<Vec<_>>()).collect(),
        multipliers: 5,
        vertices: (0..=5).collect(),
    };
    let exact = matrix.norm() * (1.0 + 4.0 * c);
    let found = factor(matrix, DENSE_LIMIT).unwrap().condition().unwrap();
    assert!(found > exact / 3.0 && found < exact * (1.0 + 1e-6), "{found} for {exact}");
}
