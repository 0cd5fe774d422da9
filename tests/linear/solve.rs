//! Loads, supports of each kind compared with one another, and the methods of the linear solver.

use algebra::SolverPath;
use geometry::CellKind;
use integration::block::{Block, SIDES, affine, soft};
use material::LinearElastic;
use proptest::prelude::*;
use shape::{FixedDof, Vector3};
use statics::{ConstraintRow, LinearProblem, Load, SolveError, assemble, multiplier_rows, nodal_forces};

fn gap(a: &[Vector3], b: &[Vector3]) -> f64 {
    let largest = b.iter().map(Vector3::norm).fold(0.0, f64::max);
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest
}

#[test]
fn reactions_balance_the_integral_of_the_loads() {
    let block = Block::new(CellKind::Tet10, [3, 2, 2]);
    let material = [soft()];
    let body = block.body(&material);
    let surface = block.surface(&["x-max"]);
    // Integral of (1 + y / 0.03) over 30 x 20 mm: 1.5 x 6e-4 m^2.
    let values = surface.points().iter().map(|x| Vector3::new(2.0, 0.0, -1.0) * (1.0 + x.y / 0.03)).collect();
    let pressure = surface.points().iter().map(|_| 5.0).collect();
    let weight = vec![Vector3::new(0.0, 0.0, -9810.0); block.volume.weights().len()];
    let loads = [
        Load::Traction { surface: &surface, values },
        Load::Pressure { surface: &surface, values: pressure },
        Load::Body { values: weight },
    ];
    let fixed = block.fix(&["x-min"], |_| Vector3::zeros());
    let problem = LinearProblem { body, loads: &loads, fixed: &fixed, constraints: &[], weak: &[] };
    let assembled = assemble(&problem).unwrap();
    let resultant =
        Vector3::new(2.0, 0.0, -1.0) * 9e-4 - Vector3::x() * 5.0 * 6e-4 - Vector3::z() * 9810.0 * 2.4e-5;
    let force: Vector3 = assembled.load().iter().sum();
    assert!((force - resultant).norm() < 1e-14 * resultant.norm().max(1.0), "{force}");
    let factored = assembled.factor().unwrap();
    for factor in [1.0, -0.25] {
        let solution = factored.solve(factor).unwrap();
        let reaction: Vector3 = factored.reactions(&solution, factor).iter().sum();
        assert!((reaction + resultant * factor).norm() < 1e-11 * resultant.norm(), "{reaction}");
    }
}

#[test]
fn constraint_rows_equal_elimination() {
    let block = Block::new(CellKind::Tet4, [4, 3, 3]);
    let material = [LinearElastic::new(20e3, 0.495).unwrap()];
    let body = block.body(&material);
    let surface = block.surface(&["x-max"]);
    let values = vec![Vector3::new(0.0, 30.0, 40.0); surface.weights().len()];
    let loads = [Load::Traction { surface: &surface, values }];
    let fixed = block.fix(&["x-min"], |x| Vector3::new(0.0, 1e-3, x.y * 0.1));
    let constraints: Vec<_> = fixed
        .iter()
        .map(|f| ConstraintRow {
            terms: vec![(f.node, f.axis, -3.0), (f.node, f.axis, 0.5)],
            value: -2.5 * f.value,
        })
        .collect();
    let solve = |fixed: &[FixedDof], constraints: &[ConstraintRow], dense_limit| {
        let problem = LinearProblem { body, loads: &loads, fixed, constraints, weak: &[] };
        let factored = assemble(&problem).unwrap().factor_with(dense_limit).unwrap();
        let solution = factored.solve(1.0).unwrap();
        let reactions = factored.reactions(&solution, 1.0);
        (solution, reactions)
    };
    let (eliminated, reactions) = solve(&fixed, &[], 0);
    assert_eq!(eliminated.info.path.name(), "sparse-llt");
    // Every second support is a row and the others are eliminated; or each row occurs twice, dependent but
    // consistent.
    let (some_fixed, some_rows): (Vec<_>, Vec<_>) =
        fixed.iter().zip(&constraints).enumerate().partition(|(k, _)| k % 2 == 0);
    let some_fixed: Vec<_> = some_fixed.into_iter().map(|(_, (f, _))| *f).collect();
    let some_rows: Vec<_> = some_rows.into_iter().map(|(_, (_, c))| c.clone()).collect();
    let twice: Vec<_> = constraints.iter().chain(&constraints).cloned().collect();
    for (dense_limit, path) in [(0, "sparse-ldlt"), (usize::MAX, "dense-ldlt")] {
        for (fixed, rows) in [(&[][..], &constraints[..]), (&some_fixed, &some_rows), (&[], &twice)] {
            let (solution, _) = solve(fixed, rows, dense_limit);
            assert_eq!(solution.info.path.name(), path);
            let gap = gap(&solution.u, &eliminated.u);
            assert!(gap < 1e-11, "{path}, {} rows: {gap:e}", rows.len());
            assert!(solution.info.residual < 1e-12, "{:e}", solution.info.residual);
        }
    }
    // The multiplier acts against the body: lambda c = -reaction.
    let (solution, none) = solve(&[], &constraints, 0);
    let scale = reactions.iter().map(Vector3::norm).fold(0.0, f64::max);
    for (f, lambda) in fixed.iter().zip(&solution.multipliers) {
        let reaction = reactions[f.node as usize][f.axis as usize];
        assert!((lambda * -2.5 + reaction).abs() < 1e-9 * scale);
    }
    assert!(none.iter().all(|r| r.norm() == 0.0));
}

/// Rows that share parameters are eliminated by pivots. The equilibrium and its forces equal those with
/// multipliers, without a saddle point; repeated rows are dropped and reported.
#[test]
fn eliminated_rows_equal_multipliers() {
    let block = Block::new(CellKind::Tet4, [4, 3, 3]);
    let material = [LinearElastic::new(20e3, 0.45).unwrap()];
    let body = block.body(&material);
    let surface = block.surface(&["x-max"]);
    let values = vec![Vector3::new(0.0, 30.0, 40.0); surface.weights().len()];
    let loads = [Load::Traction { surface: &surface, values }];
    let constrained = block.surface(&["x-min"]);
    let values: Vec<Vector3> =
        constrained.points().iter().map(|x| Vector3::new(0.0, 1e-3, x.y * 0.1)).collect();
    let rows = multiplier_rows(&constrained, constrained.rows(), [true; 3], &values).unwrap();
    // One of the parameters in the rows is also prescribed.
    let fixed = [FixedDof { node: rows[0].terms[0].0, axis: 1, value: 1e-3 }];
    let problem = |constraints| LinearProblem { body, loads: &loads, fixed: &fixed, constraints, weak: &[] };
    let with_multipliers = assemble(&problem(&rows)).unwrap().factor().unwrap();
    let eliminated = assemble(&problem(&rows)).unwrap().factor_eliminated().unwrap();
    for factor in [1.0, -0.3] {
        let (a, b) = (eliminated.solve(factor).unwrap(), with_multipliers.solve(factor).unwrap());
        assert_eq!((a.info.multipliers, a.info.eliminated), (0, rows.len() - a.info.dropped));
        assert!(a.info.path.name().ends_with("llt"), "{}", a.info.path.name());
        assert!(gap(&a.u, &b.u) < 1e-11, "{:e}", gap(&a.u, &b.u));
        for row in &rows {
            let sum: f64 = row.terms.iter().map(|&(n, a_, c)| c * a.u[n as usize][a_ as usize]).sum();
            let size: f64 = row.terms.iter().map(|t| t.2.abs()).sum();
            assert!((sum - factor * row.value).abs() < 1e-15 * size, "{sum:e} {:e}", row.value);
        }
        let forces = |multipliers: &[f64]| -> Vec<Vector3> {
            let mut forces = vec![Vector3::zeros(); block.mesh.points().len()];
            for (row, lambda) in rows.iter().zip(multipliers) {
                row.terms.iter().for_each(|&(n, axis, c)| forces[n as usize][axis as usize] += lambda * c);
            }
            // The force on the prescribed parameter can be divided between its support and the rows in many
            // ways.
            forces[fixed[0].node as usize][fixed[0].axis as usize] = 0.0;
            forces
        };
        assert!(gap(&forces(&a.multipliers), &forces(&b.multipliers)) < 1e-9);
    }
    let twice: Vec<_> = rows.iter().chain(&rows).cloned().collect();
    let solution = assemble(&problem(&twice)).unwrap().factor_eliminated().unwrap().solve(1.0).unwrap();
    let once = eliminated.solve(1.0).unwrap();
    assert_eq!(solution.info.dropped, once.info.dropped + rows.len());
    assert!(gap(&solution.u, &once.u) < 1e-12);
    // The effect of a missing row is visible.
    let lost = assemble(&problem(&rows[1..])).unwrap().factor_eliminated().unwrap().solve(1.0).unwrap();
    assert!(gap(&lost.u, &once.u) > 1e-3, "{:e}", gap(&lost.u, &once.u));
    // Two equal rows with different values: no displacement satisfies both.
    let mut torn = twice.clone();
    torn.last_mut().unwrap().value += 1e-9;
    let refused = assemble(&problem(&torn)).unwrap().factor_eliminated().err();
    assert!(matches!(refused, Some(SolveError::Dependent { .. })), "{refused:?}");
}

/// A tie between two free nodes, and a tie between a free and a constrained node.
#[test]
fn a_row_between_two_nodes_holds() {
    let block = Block::new(CellKind::Tet4, [3, 3, 2]);
    let material = [soft()];
    let body = block.body(&material);
    let surface = block.surface(&["x-max"]);
    let values = surface.points().iter().map(|x| Vector3::new(x.y * 1e4, 0.0, 0.0)).collect();
    let loads = [Load::Traction { surface: &surface, values }];
    let fixed = block.fix(&["x-min"], |_| Vector3::new(2e-3, 0.0, 0.0));
    let (a, b, constrained) = (3, 15, 0);
    let tie = |a, b, value| ConstraintRow { terms: vec![(a, 0, 1.0), (b, 0, -1.0)], value };
    let ties = [tie(a, b, 1e-3), tie(b, constrained, 5e-4)];
    let problem = LinearProblem { body, loads: &loads, fixed: &fixed, constraints: &ties, weak: &[] };
    let by_multipliers = assemble(&problem).unwrap().factor().unwrap();
    let by_elimination = assemble(&problem).unwrap().factor_eliminated().unwrap();
    for factored in [by_multipliers, by_elimination] {
        let solution = factored.solve(1.0).unwrap();
        let (ua, ub) = (solution.u[a as usize].x, solution.u[b as usize].x);
        assert!((ub - 2.5e-3).abs() < 1e-14, "{ub}");
        assert!((ua - ub - 1e-3).abs() < 1e-14, "{ua} {ub}");
        assert!(solution.multipliers[0].abs() > 1e-6);
    }
}

#[test]
fn all_held_needs_no_system() {
    let block = Block::new(CellKind::Hex8, [1, 1, 1]);
    let material = [soft()];
    let fixed = block.fix(&SIDES, affine);
    // A row with constrained parameters only is checked and dropped.
    let first = fixed[0];
    let rows = [ConstraintRow { terms: vec![(first.node, first.axis, 2.0)], value: 2.0 * first.value }];
    let body = block.body(&material);
    let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &rows, weak: &[] };
    let by_multipliers = assemble(&problem).unwrap().factor().unwrap();
    let by_elimination = assemble(&problem).unwrap().factor_eliminated().unwrap();
    for factored in [by_multipliers, by_elimination] {
        let solution = factored.solve(0.5).unwrap();
        assert!(block.error(&solution.u, |x| affine(x) * 0.5) < 1e-15);
        assert_eq!((solution.info.dofs, solution.info.path.name()), (0, "none"));
    }
}

#[test]
fn a_second_load_needs_no_second_factor() {
    let block = Block::new(CellKind::Hex20, [2, 2, 2]);
    let material = [soft()];
    let body = block.body(&material);
    let surface = block.surface(&["z-max"]);
    let fixed = block.fix(&["z-min"], |x| Vector3::new(0.0, 0.0, 0.02 * x.x));
    let push = |p: f64| [Load::Pressure { surface: &surface, values: vec![p; surface.weights().len()] }];
    let one = push(100.0);
    let two = push(-300.0);
    let problem = |loads| LinearProblem { body, loads, fixed: &fixed, constraints: &[], weak: &[] };
    let factored = assemble(&problem(&one)).unwrap().factor().unwrap();
    let reused = factored.solve_loads(&two).unwrap();
    let fresh = assemble(&problem(&two)).unwrap().factor().unwrap().solve(1.0).unwrap();
    assert!(reused == fresh);
    assert!(gap(&factored.solve(1.0).unwrap().u, &fresh.u) > 1e-3);
}

/// Refinement and a tight residual keep nearly incompressible solutions at rounding.
#[test]
fn residuals_stay_small_near_incompressibility() {
    for poisson in [0.3, 0.495, 0.49999] {
        let block = Block::new(CellKind::Tet10, [3, 3, 2]);
        let material = [LinearElastic::new(20e3, poisson).unwrap()];
        let fixed = block.fix(&["z-min"], |_| Vector3::zeros());
        let values = vec![Vector3::new(0.0, 0.0, -1e4); block.volume.weights().len()];
        let loads = [Load::Body { values }];
        let body = block.body(&material);
        let problem = LinearProblem { body, loads: &loads, fixed: &fixed, constraints: &[], weak: &[] };
        let solution = assemble(&problem).unwrap().factor().unwrap().solve(1.0).unwrap();
        assert!(solution.info.residual < 1e-10, "{poisson}: {:e}", solution.info.residual);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn dense_and_sparse_agree(
        cells in prop::array::uniform3(1..5usize),
        kind in prop::sample::select(CellKind::ALL.to_vec()),
        side in 0..6usize,
        force in prop::array::uniform3(-1.0..1.0f64),
    ) {
        prop_assume!(kind.order() == 1 || cells.iter().product::<usize>() <= 8);
        let block = Block::new(kind, cells);
        let material = [soft()];
        let fixed = block.fix(&[SIDES[side]], |_| Vector3::zeros());
        let loads = [Load::Body { values: vec![Vector3::from(force) * 1e4; block.volume.weights().len()] }];
        let body = block.body(&material);
        let problem = LinearProblem { body, loads: &loads, fixed: &fixed, constraints: &[], weak: &[] };
        let sparse = assemble(&problem).unwrap().factor_with(0).unwrap().solve(1.0).unwrap();
        let dense = assemble(&problem).unwrap().factor_with(usize::MAX).unwrap().solve(1.0).unwrap();
        prop_assert_eq!(sparse.info.path, SolverPath::SparseLlt);
        prop_assert_eq!(dense.info.path, SolverPath::DenseLlt);
        prop_assert!(gap(&sparse.u, &dense.u) < 1e-11);
    }
}

#[test]
fn a_condensed_operator_gives_what_a_solve_gives() {
    let block = Block::new(CellKind::Tet10, [3, 2, 2]);
    let material = [soft()];
    let body = block.body(&material);
    let surface = block.surface(&["x-max"]);
    let loaded = block.nodes_of(&["x-max"]);
    let fixed = block.fix(&["x-min"], |x| Vector3::new(1e-3, 0.0, x.y * 0.02));
    let all = block.mesh.points().len();
    // The mean of the loaded face, and one node inside.
    let part = 1.0 / loaded.len() as f64;
    let outputs = shape::Rows::new(
        all,
        vec![0, loaded.len(), loaded.len() + 1],
        loaded.iter().copied().chain([7]).collect(),
        vec![part; loaded.len()].into_iter().chain([1.0]).collect(),
        shape::Unity::NotPromised,
    )
    .unwrap();
    // Supports by elimination, and by rows with multipliers.
    let rows: Vec<_> = (fixed.iter())
        .map(|f| ConstraintRow { terms: vec![(f.node, f.axis, 2.0)], value: 2.0 * f.value })
        .collect();
    for (fixed, constraints) in [(fixed.as_slice(), [].as_slice()), (&[], rows.as_slice())] {
        let problem = LinearProblem { body, loads: &[], fixed, constraints, weak: &[] };
        let factored = assemble(&problem).unwrap().factor().unwrap();
        let condensed = factored.condense(&outputs, &loaded).unwrap();
        assert_eq!(condensed.len(), 9 * 2 * loaded.len());
        let mut out = vec![Vector3::zeros(); 2];
        for (frame, supports) in [1.0, 0.0, -0.7].into_iter().enumerate() {
            let values = (surface.points().iter())
                .map(|x| Vector3::new(3.0 - frame as f64, 40.0 * x.y, -2.0 * frame as f64))
                .collect();
            let forces = nodal_forces(body.volume, &[Load::Traction { surface: &surface, values }]).unwrap();
            let direct = outputs.apply(&factored.solve_forces(&forces, supports).unwrap().u);
            let on_face: Vec<Vector3> = loaded.iter().map(|&node| forces[node as usize]).collect();
            condensed.apply(&on_face, supports, &mut out);
            assert!(gap(&out, &direct) < 1e-11, "frame {frame}: {}", gap(&out, &direct));
        }
    }
}
