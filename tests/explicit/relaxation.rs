//! Dynamic relaxation compared with closed forms, and zero residual.

use explicit::{
    ExplicitBody, ExplicitError, InternalForce, LanczosParams, Lumping, RelaxationParams, lumped_mass, relax,
};
use geometry::CellKind;
use geometry::generate::{Jitter, box_mesh};
use integration::block::Block;
use integration::model::{Model, Projection, solve, steps};
use lanes::LanePath;
use material::{Law, Material as _, NeoHookean};
use shape::{FixedDof, HourglassModulus, Matrix3, Point3, Vector3};

fn params(tolerance: f64) -> RelaxationParams {
    RelaxationParams {
        tolerance,
        steps: 20_000,
        critical: LanczosParams { steps: 15, safety: 0.95 },
        recheck: 50,
    }
}

/// With rollers on three sides and a dead load on x-max, the stretches solve `P_11 = t`, `P_22 = P_33 = 0`.
#[test]
fn uniaxial_tension_ends_at_its_closed_form() {
    let block = Block::new(CellKind::Hex8, [3, 2, 2]);
    let laws = [Law::NeoHookean(NeoHookean::new(20e3, 0.45).unwrap())];
    let mass = lumped_mass(&block.volume, &[1060.0], &[], Lumping::RowSum).unwrap();
    let body = ExplicitBody { volume: &block.volume, laws: &laws, region: &[], axes: &[], groups: None };
    let traction = 6e3;
    let surface = block.surface(&["x-max"]);
    let mut load = |_: &[Vector3], f: &mut [Vector3]| {
        for (q, w) in surface.weights().iter().enumerate() {
            let (nodes, values) = surface.rows().row(q);
            nodes.iter().zip(values).for_each(|(&node, n)| f[node as usize].x += traction * w * n);
        }
    };
    let fixed: Vec<FixedDof> = [("x-min", 0), ("y-min", 1), ("z-min", 2)]
        .into_iter()
        .flat_map(|(side, axis)| {
            block.nodes_of(&[side]).into_iter().map(move |node| FixedDof { node, axis, value: 0.0 })
        })
        .collect();
    // Nested bisection: the outer one for the axial stretch, the inner one for the lateral stretch. P_11
    // increases with the first, P_22 with the second.
    let stress = |a: f64, b: f64| laws[0].stress(&Matrix3::from_diagonal(&Vector3::new(a, b, b)));
    let root = |low: f64, high: f64, below: &dyn Fn(f64) -> bool| {
        (0..60).fold((low, high), |(a, b), _| {
            let m = 0.5 * (a + b);
            if below(m) { (m, b) } else { (a, m) }
        })
    };
    let across = |a: f64| root(-0.5, 0.5, &|b| stress(a, b)[(1, 1)] < 0.0).0;
    let along = root(0.0, 1.0, &|a| stress(a, across(a))[(0, 0)] < traction).0;
    assert!(along > 0.2, "{along}");

    let zero = vec![Vector3::zeros(); mass.len()];
    for (tolerance, within) in [(1e-4, 1e-3), (1e-8, 1e-7)] {
        let mut force = InternalForce::new(body, LanePath::best()).unwrap();
        let (u, info) = relax(&mut force, &mass, &fixed, &mut load, zero.clone(), params(tolerance)).unwrap();
        let exact = |x: &Point3| Vector3::new(along * x.x, across(along) * x.y, across(along) * x.z);
        let error = block.error(&u, exact);
        // The stopping rule estimates the error; ten times this estimate is allowed.
        assert!(error < within, "{error:e} {info:?}");
        assert!(info.residual < 20.0 * tolerance && info.error < tolerance, "{info:?}");
        assert!(info.slow_mode > 0.1 && info.slow_mode < 10.0, "{info:?}");
    }
}

#[test]
fn a_bent_box_comes_to_rest_and_too_few_steps_are_an_error() {
    let block = Block::new(CellKind::Tet4, [5, 3, 3]);
    let laws = [Law::NeoHookean(NeoHookean::new(20e3, 0.45).unwrap())];
    let mass = lumped_mass(&block.volume, &[1060.0], &[], Lumping::RowSum).unwrap();
    let body = ExplicitBody { volume: &block.volume, laws: &laws, region: &[], axes: &[], groups: None };
    let mut fixed = block.fix(&["x-min"], |_| Vector3::zeros());
    // One side is moved down by 6 mm.
    fixed.extend(block.nodes_of(&["x-max"]).into_iter().map(|node| FixedDof { node, axis: 2, value: -6e-3 }));
    let ramp: Vec<Vector3> =
        block.mesh.points().iter().map(|x| Vector3::new(0.0, 0.0, -6e-3 * x.x / 0.04)).collect();
    let mut none = |_: &[Vector3], _: &mut [Vector3]| ();
    let mut force = InternalForce::new(body, LanePath::best()).unwrap();
    let (u, info) = relax(&mut force, &mass, &fixed, &mut none, ramp.clone(), params(1e-9)).unwrap();
    let mut f = u.clone();
    force.evaluate(&u, &mut f).unwrap();
    let constrained: Vec<_> = fixed.iter().map(|d| (d.node as usize, d.axis as usize)).collect();
    let largest = f.iter().map(|f| f.amax()).fold(0.0, f64::max);
    for (i, f) in f.iter().enumerate() {
        for axis in 0..3 {
            if !constrained.contains(&(i, axis)) {
                assert!(f[axis].abs() < 1e-7 * largest, "{i} {axis}: {} of {largest} {info:?}", f[axis]);
            }
        }
    }
    for d in &fixed {
        assert_eq!(u[d.node as usize][d.axis as usize], d.value);
    }
    let few = RelaxationParams { steps: 20, ..params(1e-9) };
    let error = relax(&mut force, &mass, &fixed, &mut none, ramp, few).unwrap_err();
    assert!(matches!(error, ExplicitError::NotRelaxed { steps: 20, error, .. } if error > 1e-9), "{error}");
}

/// Hexahedra with one point: relaxation with the lane kernel ends at the equilibrium of Newton's method, whose
/// stiffness of hourglass control is assembled. A bent beam of one cell across has all its bending energy in
/// the patterns.
#[test]
fn hexahedra_with_one_point_rest_where_newton_finds_them() {
    let max = Point3::new(0.04, 0.01, 0.01);
    let jitter = Some(Jitter { fraction: 0.2, seed: 7 });
    for cells in [[4, 1, 1], [6, 2, 2]] {
        let mesh = box_mesh(CellKind::Hex8, Point3::origin(), max, cells, [1.0; 3], jitter).unwrap();
        let volume = fem::uniform_rows(&mesh, 0.05, HourglassModulus::PWave).unwrap();
        let model = Model::new(mesh, Projection::OnePoint);
        assert_eq!(model.volume, volume);
        let law = Law::NeoHookean(NeoHookean::new(20e3, 0.45).unwrap());
        let mut fixed = model.hold(&["x-min"], &[0, 1, 2], |_| Vector3::zeros());
        fixed.extend(model.hold(&["x-max"], &[2], |_| Vector3::new(0.0, 0.0, -8e-3)));
        let problem = statics::StaticProblem { fixed: &fixed, ..model.problem(&law) };
        let path = solve("one point", &problem, &steps(2));

        let mass = lumped_mass(&volume, &[1060.0], &[], Lumping::RowSum).unwrap();
        let laws = [law];
        let body = ExplicitBody { volume: &volume, laws: &laws, region: &[], axes: &[], groups: None };
        let mut force = InternalForce::new(body, LanePath::best()).unwrap();
        assert_eq!(force.info().kernel.name(), "hex8 one point");
        let ramp = model.mesh.points().iter().map(|x| Vector3::new(0.0, 0.0, -0.2 * x.x)).collect();
        let mut none = |_: &[Vector3], _: &mut [Vector3]| ();
        let (u, info) = relax(&mut force, &mass, &fixed, &mut none, ramp, params(1e-9)).unwrap();
        let gap = u.iter().zip(&path.u).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(gap < 1e-7 * 8e-3, "{gap:e} {info:?}");
        let energy = force.energy(&u).unwrap();
        assert!((energy / path.steps[path.steps.len() - 1].energy - 1.0).abs() < 1e-7);
        let part = volume.hourglass_energy(|_| [laws[0].lambda(), laws[0].mu()], &u) / energy;
        let [least, most] = if cells[1] == 1 { [0.5, 1.0] } else { [0.05, 0.5] };
        assert!(part > least && part < most, "{cells:?}: {part}");
    }
}
