//! Patch tests: an affine displacement is reproduced to rounding, however it is prescribed.

use fem::VolumeRule;
use geometry::CellKind;
use integration::block::{Block, SIDES, affine, gradient, soft};
use material::LinearElastic;
use shape::DilationGroups;
use shape::{FixedDof, Vector3};
use statics::{
    LinearBody, LinearProblem, Load, Solution, Weak, WeakSupport, assemble, body_stress, multiplier_rows,
};

/// Rounding of a few hundred unknowns at condition numbers of some hundred.
const ROUNDING: f64 = 1e-12;

fn check(block: &Block, body: &LinearBody, solution: &Solution) {
    assert!(
        block.error(&solution.u, affine) < ROUNDING,
        "displacement {:e}",
        block.error(&solution.u, affine)
    );
    let exact = body.materials[0].stress(&gradient());
    for s in body_stress(body, &solution.u).unwrap() {
        assert!(
            (s - exact).norm() < 1e-11 * exact.norm(),
            "stress off by {:e}",
            (s - exact).norm() / exact.norm()
        );
    }
}

#[test]
fn by_displacement_in_every_cell_kind() {
    for kind in CellKind::ALL {
        let block = Block::new(kind, [3, 3, 2]);
        let material = [soft()];
        let fixed = block.fix(&SIDES, affine);
        let body = block.body(&material);
        let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &[], weak: &[] };
        let solution = assemble(&problem).unwrap().factor().unwrap().solve(1.0).unwrap();
        check(&block, &body, &solution);
    }
}

#[test]
fn by_traction() {
    let block = Block::new(CellKind::Tet4, [4, 3, 3]);
    let material = [soft()];
    let body = block.body(&material);
    let stress = material[0].stress(&gradient());
    let surface = block.surface(&SIDES);
    let values = surface.normals().iter().map(|n| stress * n).collect();
    let loads = [Load::Traction { surface: &surface, values }];
    // Six degrees of freedom at three corners suppress exactly the rigid motions.
    let corners = [(0, 0), (0, 1), (0, 2), (4, 1), (4, 2), (4 + 5 * 3, 2)];
    let fixed = corners.map(|(node, axis)| FixedDof {
        node,
        axis,
        value: affine(&block.mesh.points()[node as usize])[axis as usize],
    });
    let problem = LinearProblem { body, loads: &loads, fixed: &fixed, constraints: &[], weak: &[] };
    let factored = assemble(&problem).unwrap().factor().unwrap();
    let solution = factored.solve(1.0).unwrap();
    check(&block, &body, &solution);
    let force = stress.norm() * 1e-3;
    for r in factored.reactions(&solution, 1.0) {
        assert!(r.norm() < 1e-12 * force, "tractions are in balance, yet a support pushes with {r}");
    }
}

#[test]
fn by_nitsche_on_all_sides_and_axis_by_axis() {
    for kind in [CellKind::Tet4, CellKind::Hex8, CellKind::Tet10] {
        let block = Block::new(kind, [3, 3, 2]);
        let material = [soft()];
        let body = block.body(&material);
        let all = block.flux(&SIDES);
        let constrained = |axes| WeakSupport {
            flux: &all,
            axes,
            values: all.points().iter().map(affine).collect(),
            region: &[],
            method: Weak::Nitsche { gamma: 20.0 },
            h: 0.01,
            trace: None,
        };
        for weak in [
            vec![constrained([true; 3])],
            vec![constrained([true, false, false]), constrained([false, true, true])],
        ] {
            let problem = LinearProblem { body, loads: &[], fixed: &[], constraints: &[], weak: &weak };
            let solution = assemble(&problem).unwrap().factor().unwrap().solve(1.0).unwrap();
            check(&block, &body, &solution);
        }
    }
}

/// Three sides are constrained in the normal direction by Nitsche's method. The exact traction acts on the
/// other sides, and tangentially on these three.
#[test]
fn by_nitsche_rollers_and_tractions() {
    let block = Block::new(CellKind::Tet4, [3, 3, 2]);
    let material = [soft()];
    let body = block.body(&material);
    let stress = material[0].stress(&gradient());
    let rollers = [("x-min", 0), ("y-min", 1), ("z-min", 2)];
    let fluxes = rollers.map(|(side, axis)| (block.flux(&[side]), block.surface(&[side]), axis));
    let weak: Vec<_> = fluxes
        .iter()
        .map(|(flux, _, axis)| WeakSupport {
            flux,
            axes: [0, 1, 2].map(|a| a == *axis),
            // NaN along unconstrained axes is ignored.
            values: flux
                .points()
                .iter()
                .map(|x| Vector3::from_fn(|a, _| if a == *axis { affine(x)[a] } else { f64::NAN }))
                .collect(),
            region: &[],
            method: Weak::Nitsche { gamma: 20.0 },
            h: 0.01,
            trace: None,
        })
        .collect();
    let pulled = block.surface(&["x-max", "y-max", "z-max"]);
    let mut loads = vec![Load::Traction {
        surface: &pulled,
        values: pulled.normals().iter().map(|n| stress * n).collect(),
    }];
    for (_, surface, axis) in &fluxes {
        let mut tangential: Vec<Vector3> = surface.normals().iter().map(|n| stress * n).collect();
        tangential.iter_mut().for_each(|t| t[*axis] = 0.0);
        loads.push(Load::Traction { surface, values: tangential });
    }
    let problem = LinearProblem { body, loads: &loads, fixed: &[], constraints: &[], weak: &weak };
    let solution = assemble(&problem).unwrap().factor().unwrap().solve(1.0).unwrap();
    check(&block, &body, &solution);
}

/// Next to sides constrained by Nitsche's method, the reaction of an eliminated side is the traction of the
/// exact stress, also in cells at both sides.
#[test]
fn by_nitsche_beside_an_eliminated_side() {
    let block = Block::new(CellKind::Tet4, [3, 3, 2]);
    let material = [soft()];
    let body = block.body(&material);
    let flux = block.flux(&SIDES[1..]);
    let weak = [WeakSupport {
        flux: &flux,
        axes: [true; 3],
        values: flux.points().iter().map(affine).collect(),
        region: &[],
        method: Weak::Nitsche { gamma: 20.0 },
        h: 0.01,
        trace: None,
    }];
    let fixed = block.fix(&["x-min"], affine);
    let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &[], weak: &weak };
    let factored = assemble(&problem).unwrap().factor().unwrap();
    let solution = factored.solve(1.0).unwrap();
    check(&block, &body, &solution);
    let side = block.surface(&["x-min"]);
    let stress = material[0].stress(&gradient());
    let mut exact = vec![Vector3::zeros(); body.nodes.len()];
    for (q, n) in side.normals().iter().enumerate() {
        let (nodes, values) = side.rows().row(q);
        for (&i, value) in nodes.iter().zip(values) {
            exact[i as usize] += stress * n * (value * side.weights()[q]);
        }
    }
    let largest = exact.iter().fold(0.0f64, |l, f| l.max(f.norm()));
    for (reaction, exact) in factored.reactions(&solution, 1.0).iter().zip(&exact) {
        assert!((reaction - exact).norm() < 1e-9 * largest, "{reaction} {exact}");
    }
}

#[test]
fn penalty_error_falls_with_the_factor() {
    let block = Block::new(CellKind::Tet4, [3, 3, 2]);
    let material = [soft()];
    let body = block.body(&material);
    let flux = block.flux(&SIDES);
    let error = |factor| {
        let weak = [WeakSupport {
            flux: &flux,
            axes: [true; 3],
            values: flux.points().iter().map(affine).collect(),
            region: &[],
            method: Weak::Penalty { factor },
            h: 0.01,
            trace: None,
        }];
        let problem = LinearProblem { body, loads: &[], fixed: &[], constraints: &[], weak: &weak };
        let solution = assemble(&problem).unwrap().factor().unwrap().solve(1.0).unwrap();
        block.error(&solution.u, affine)
    };
    let (rough, fine) = (error(1e3), error(1e5));
    // The error is of first order in 1 / factor and vanishes only in the limit.
    assert!((60.0..150.0).contains(&(rough / fine)), "{rough:e} -> {fine:e}");
    assert!((1e-7..1e-4).contains(&fine), "{fine:e}");
}

#[test]
fn by_multipliers_on_all_sides() {
    let block = Block::new(CellKind::Tet4, [3, 3, 2]);
    let material = [soft()];
    let body = block.body(&material);
    let surface = block.surface(&SIDES);
    let values: Vec<Vector3> = surface.points().iter().map(affine).collect();
    // The trace of the displacement basis serves as its own multiplier basis.
    let rows = multiplier_rows(&surface, surface.rows(), [true; 3], &values).unwrap();
    assert_eq!(rows.len(), 3 * block.nodes_of(&SIDES).len());
    let problem = LinearProblem { body, loads: &[], fixed: &[], constraints: &rows, weak: &[] };
    for dense_limit in [0, usize::MAX] {
        let solution = assemble(&problem).unwrap().factor_with(dense_limit).unwrap().solve(1.0).unwrap();
        check(&block, &body, &solution);
    }
}

#[test]
fn with_every_dilation_projection() {
    for kind in CellKind::ALL {
        let block = Block::new(kind, [3, 3, 2]);
        let material = [LinearElastic::new(20e3, 0.495).unwrap()];
        let element = fem::element_dilation(&block.mesh, &VolumeRule::STANDARD).unwrap();
        let nodal = (kind == CellKind::Tet4).then(|| DilationGroups::nodal(&block.volume).unwrap());
        for groups in std::iter::once(&element).chain(&nodal) {
            let body = LinearBody { dilation: Some(groups), ..block.body(&material) };
            let fixed = block.fix(&SIDES, affine);
            let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &[], weak: &[] };
            let solution = assemble(&problem).unwrap().factor().unwrap().solve(1.0).unwrap();
            check(&block, &body, &solution);
        }
    }
}
