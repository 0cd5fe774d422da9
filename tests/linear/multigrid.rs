//! Iterative solution with multigrid: agreement with a direct solution, number of iterations as in theory,
//! and reproducible bits.

use algebra::SolverPath;
use fem::VolumeRule;
use geometry::CellKind;
use geometry::generate::box_mesh;
use integration::block::{Block, soft};
use material::LinearElastic;
use shape::{DilationGroups, FixedDof, Point3, Vector3};
use statics::{ConstraintRow, Factored, LinearBody, LinearProblem, Load, SolveError, assemble};

const KINDS: [CellKind; 4] = [CellKind::Tet4, CellKind::Tet10, CellKind::Hex8, CellKind::Hex20];

/// Solves a block constrained on one side, moved along one axis on the opposite side, under its weight.
fn solved<T>(block: &Block, poisson: f64, solve: impl FnOnce(&LinearProblem) -> T) -> T {
    let material = [LinearElastic::new(20e3, poisson).unwrap()];
    let weight = vec![Vector3::new(2000.0, 0.0, -9810.0); block.volume.weights().len()];
    let mut fixed = block.fix(&["x-min"], |x| Vector3::new(0.0, 1e-3, x.y * 0.1));
    let moved = block.nodes_of(&["x-max"]).into_iter();
    fixed.extend(moved.map(|node| FixedDof { node, axis: 2, value: -2e-3 }));
    solve(&LinearProblem {
        body: block.body(&material),
        loads: &[Load::Body { values: weight }],
        fixed: &fixed,
        constraints: &[],
        weak: &[],
    })
}

fn iterated<'a>(problem: &LinearProblem<'a>, block: &Block) -> Result<Factored<'a>, SolveError> {
    let coarser = fem::linear_nodes(&block.mesh).unwrap();
    let assembled = assemble(problem)?;
    let levels = assembled.multigrid(coarser.as_ref())?;
    assembled.iterated(levels, 1e-8)
}

/// Returns the largest difference, relative to the largest displacement.
fn gap(a: &[Vector3], b: &[Vector3]) -> f64 {
    let largest = b.iter().map(Vector3::norm).fold(0.0, f64::max);
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest
}

#[test]
fn iterations_come_to_what_a_factor_gives_for_every_element() {
    for kind in KINDS {
        let block = Block::new(kind, if kind.order() == 1 { [12, 10, 8] } else { [6, 5, 4] });
        for (poisson, most) in [(0.3, 25), (0.45, 35)] {
            solved(&block, poisson, |problem| {
                let direct = assemble(problem).unwrap().factor().unwrap().solve(1.0).unwrap();
                let factored = iterated(problem, &block).unwrap();
                let solution = factored.solve(1.0).unwrap();
                let count = solution.info.iterations.unwrap().count;
                let off = gap(&solution.u, &direct.u);
                assert!(off < 1e-7, "{kind:?} nu {poisson}: {off:e} off");
                assert!((2..=most).contains(&count), "{kind:?} nu {poisson}: {count} iterations");
                assert_eq!(solution.info.path, SolverPath::Multigrid);
                assert_eq!(solution.info.dofs, direct.info.dofs);
                // Half of the load gives half of the solution, with the same hierarchy.
                let half = factored.solve(0.5).unwrap();
                let doubled: Vec<Vector3> = half.u.iter().map(|u| u * 2.0).collect();
                assert!(gap(&doubled, &solution.u) < 1e-12, "{kind:?}");
            });
        }
    }
}

#[test]
fn iterations_hardly_grow_with_the_size() {
    let count = |cells| {
        let block = Block::new(CellKind::Tet4, cells);
        solved(&block, 0.3, |problem| {
            let solution = iterated(problem, &block).unwrap().solve(1.0).unwrap();
            let iterations = solution.info.iterations.unwrap();
            assert!(iterations.complexity < 1.7, "{iterations:?}");
            iterations.count
        })
    };
    // 2,000, 13,000 and 94,000 unknowns.
    let counts = [[10, 8, 6], [20, 15, 12], [40, 30, 23]].map(count);
    assert!(counts[2] <= counts[0] + 8 && counts[2] <= 25, "{counts:?}");
}

#[test]
fn the_same_bits_at_any_number_of_threads() {
    // The mesh has more nodes than two chunks of the sweeps.
    let block = Block::new(CellKind::Hex8, [30, 25, 24]);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solved(&block, 0.3, |problem| iterated(problem, &block).unwrap().solve(1.0).unwrap()))
    };
    let first = on(1);
    for threads in [2, 3] {
        assert!(first == on(threads), "at {threads} threads");
    }
}

/// Returns the groups of a block's points that share dilations: per cell, or per node of tet4.
fn shared(block: &Block) -> DilationGroups {
    match block.mesh.uniform_kind() {
        Some(CellKind::Tet4) => DilationGroups::nodal(&block.volume).unwrap(),
        _ => fem::element_dilation(&block.mesh, &VolumeRule::STANDARD).unwrap(),
    }
}

/// Solves as [`solved`] does, with shared dilations.
fn nearly_incompressible<T>(block: &Block, poisson: f64, solve: impl FnOnce(&LinearProblem) -> T) -> T {
    let groups = shared(block);
    solved(block, poisson, |problem| {
        solve(&LinearProblem { body: LinearBody { dilation: Some(&groups), ..problem.body }, ..*problem })
    })
}

fn with_pressures<'a>(problem: &LinearProblem<'a>, block: &Block) -> Result<Factored<'a>, SolveError> {
    let coarser = fem::linear_nodes(&block.mesh).unwrap();
    let assembled = assemble(problem)?;
    let levels = assembled.multigrid_with_pressures(coarser.as_ref())?;
    assembled.iterated(levels, 1e-8)
}

#[test]
fn pressures_come_to_what_a_factor_gives_in_iterations_that_hardly_grow() {
    for (kind, most) in [
        (CellKind::Tet4, [60, 300]),
        (CellKind::Tet10, [50, 80]),
        (CellKind::Hex8, [60, 300]),
        (CellKind::Hex20, [60, 80]),
    ] {
        let block = Block::new(kind, if kind.order() == 1 { [12, 10, 8] } else { [6, 5, 4] });
        for (poisson, most) in [0.495, 0.4999].into_iter().zip(most) {
            nearly_incompressible(&block, poisson, |problem| {
                let direct = assemble(problem).unwrap().factor().unwrap().solve(1.0).unwrap();
                let solution = with_pressures(problem, &block).unwrap().solve(1.0).unwrap();
                let count = solution.info.iterations.unwrap().count;
                let off = gap(&solution.u, &direct.u);
                assert!(off < 1e-7, "{kind:?} nu {poisson}: {off:e} off");
                assert!((10..=most).contains(&count), "{kind:?} nu {poisson}: {count} iterations");
                assert!(solution.info.residual <= 1e-8);
                assert_eq!(solution.info.path, SolverPath::MultigridPressures);
            });
        }
    }
}

/// Without pressures, tet10 takes more than twice the iterations at nu = 0.495, and does not converge at
/// 0.4999.
#[test]
fn pressures_take_fewer_iterations_than_displacements_alone() {
    let block = Block::new(CellKind::Tet10, [6, 5, 4]);
    let count =
        |solution: Result<statics::Solution, SolveError>| solution.map(|s| s.info.iterations.unwrap().count);
    nearly_incompressible(&block, 0.495, |problem| {
        let alone = count(iterated(problem, &block).unwrap().solve(1.0)).unwrap();
        let together = count(with_pressures(problem, &block).unwrap().solve(1.0)).unwrap();
        assert!(3 * together < 2 * alone, "{together} for {alone}");
    });
    nearly_incompressible(&block, 0.4999, |problem| {
        let alone = count(iterated(problem, &block).unwrap().solve(1.0));
        assert!(alone.as_ref().is_err() || alone.as_ref().is_ok_and(|count| *count > 200), "{alone:?}");
    });
}

#[test]
fn compressible_bodies_have_no_pressures() {
    let block = Block::new(CellKind::Hex8, [6, 5, 4]);
    nearly_incompressible(&block, 0.3, |problem| {
        let solution = with_pressures(problem, &block).unwrap().solve(1.0).unwrap();
        assert_eq!(solution.info.path, SolverPath::Multigrid);
    });
}

#[test]
fn pressures_have_the_same_bits_at_any_number_of_threads() {
    // The mesh has more nodes than two chunks of the sweeps.
    let block = Block::new(CellKind::Tet10, [14, 13, 12]);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            nearly_incompressible(&block, 0.495, |problem| {
                with_pressures(problem, &block).unwrap().solve(1.0).unwrap()
            })
        })
    };
    let first = on(1);
    for threads in [2, 3] {
        assert!(first == on(threads), "at {threads} threads");
    }
}

/// The matrix has a condition number of 1e9: residuals of 1e-8 |b| are below rounding and indicate no error
/// of the solution.
#[test]
fn a_slender_beam_is_solved_to_rounding() {
    let max = Point3::new(0.1, 0.002, 0.002);
    for kind in [CellKind::Hex8, CellKind::Tet10] {
        let mesh = box_mesh(kind, Point3::origin(), max, [100, 2, 2], [1.0; 3], None).unwrap();
        let volume = fem::volume_rows(&mesh, &fem::VolumeRule::STANDARD).unwrap();
        let block = Block { mesh, volume };
        let material = [soft()];
        let weight = vec![Vector3::new(0.0, 0.0, -9.81); block.volume.weights().len()];
        let fixed = block.fix(&["x-min"], |_| Vector3::zeros());
        let problem = LinearProblem {
            body: block.body(&material),
            loads: &[Load::Body { values: weight }],
            fixed: &fixed,
            constraints: &[],
            weak: &[],
        };
        let direct = assemble(&problem).unwrap().factor().unwrap().solve(1.0).unwrap();
        let solution = iterated(&problem, &block).unwrap().solve(1.0).unwrap();
        let off = gap(&solution.u, &direct.u);
        assert!(off < 1e-6, "{kind:?}: {off:e} off in {:?}", solution.info);
    }
}

#[test]
fn constraint_rows_are_refused() {
    let block = Block::new(CellKind::Tet4, [4, 3, 3]);
    let material = [soft()];
    let fixed = block.fix(&["x-min"], |_| Vector3::zeros());
    let last = block.mesh.points().len() as u32 - 1;
    let rows = [ConstraintRow { terms: vec![(last, 0, 1.0), (last, 1, -1.0)], value: 1e-3 }];
    let body = block.body(&material);
    let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &rows, weak: &[] };
    assert!(matches!(iterated(&problem, &block).err(), Some(SolveError::RowsNeedFactor { rows: 1 })));
}
