//! Input without a trustworthy solution is refused, with the reason.

use algebra::AlgebraError;
use geometry::CellKind;
use integration::block::{Block, SIDES, soft};
use material::LinearElastic;
use proptest::prelude::*;
use shape::{DilationGroups, GradRows, Rows, Unity, VolumeRows};
use shape::{FixedDof, Point3, Vector3};
use statics::{
    ConstraintRow, LinearBody, LinearProblem, Load, RigidMode, Solution, SolveError, Weak, WeakSupport,
    assemble,
};

fn block() -> Block {
    Block::new(CellKind::Tet4, [2, 2, 2])
}

fn attempt(
    body: LinearBody,
    loads: &[Load],
    fixed: &[FixedDof],
    constraints: &[ConstraintRow],
    weak: &[WeakSupport],
) -> Result<Solution, SolveError> {
    assemble(&LinearProblem { body, loads, fixed, constraints, weak })?.factor()?.solve(1.0)
}

fn free_modes(result: Result<Solution, SolveError>) -> Vec<String> {
    match result {
        Err(SolveError::RigidMotion { modes, .. }) => modes.iter().map(RigidMode::to_string).collect(),
        other => panic!("expected free rigid motions, got {other:?}"),
    }
}

/// Constrains one axis of all nodes on a side.
fn roller(block: &Block, side: &str, axis: u8) -> Vec<FixedDof> {
    block.nodes_of(&[side]).into_iter().map(|node| FixedDof { node, axis, value: 0.0 }).collect()
}

#[test]
fn each_rigid_motion_is_named() {
    let block = block();
    let material = [soft()];
    let body = block.body(&material);
    let all = ["translation along x", "translation along y", "translation along z"];
    let turns = ["rotation about x", "rotation about y", "rotation about z"];
    assert_eq!(free_modes(attempt(body, &[], &[], &[], &[])), [&all[..], &turns].concat());
    // Rollers at the bottom and at the back leave only the motion along x free.
    let two = [roller(&block, "z-min", 2), roller(&block, "y-min", 1)].concat();
    assert_eq!(free_modes(attempt(body, &[], &two, &[], &[])), ["translation along x"]);
    // A plate on rollers can slide and rotate.
    let one = roller(&block, "z-min", 2);
    let expected = ["translation along x", "translation along y", "rotation about z"];
    assert_eq!(free_modes(attempt(body, &[], &one, &[], &[])), expected);
    // A hinge along the edge x = z = 0, parallel to y.
    let hinge: Vec<_> =
        (0..3u32).flat_map(|k| (0..3).map(move |axis| FixedDof { node: 3 * k, axis, value: 0.0 })).collect();
    assert_eq!(free_modes(attempt(body, &[], &hinge, &[], &[])), ["rotation about y"]);
    // A hinge along an oblique line through two corners.
    let oblique: Vec<_> = [0u32, 8]
        .iter()
        .flat_map(|&node| (0..3).map(move |axis| FixedDof { node, axis, value: 0.0 }))
        .collect();
    assert_eq!(free_modes(attempt(body, &[], &oblique, &[], &[])), ["rotation about (0.800, 0.600, 0.000)"]);
}

#[test]
fn weak_supports_and_rows_count_as_holds() {
    let block = block();
    let material = [soft()];
    let body = block.body(&material);
    let flux = block.flux(&["z-min"]);
    let weak = |axes| {
        let values = vec![Vector3::zeros(); flux.weights().len()];
        [WeakSupport {
            flux: &flux,
            axes,
            values,
            region: &[],
            method: Weak::Penalty { factor: 1e4 },
            h: 0.01,
            trace: None,
        }]
    };
    attempt(body, &[], &[], &[], &weak([true; 3])).unwrap();
    let sliding = attempt(body, &[], &[], &[], &weak([false, true, true]));
    assert_eq!(free_modes(sliding), ["translation along x"]);
    // A single row for the mean x displacement of a side suppresses the remaining motion.
    let nodes = block.nodes_of(&["x-max"]);
    let mean = [ConstraintRow {
        terms: nodes.iter().map(|&n| (n, 0, 1.0 / nodes.len() as f64)).collect(),
        value: 0.0,
    }];
    attempt(body, &[], &[], &mean, &weak([false, true, true])).unwrap();
}

/// Two tetrahedra a metre apart, which constraint rows may join.
fn two_pieces() -> (Vec<Point3>, VolumeRows) {
    let corner = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let nodes: Vec<Point3> =
        [0.0, 2.0].iter().flat_map(|dx| corner.map(|c| Point3::new(c[0] + dx, c[1], c[2]))).collect();
    let grads = [Vector3::new(-1.0, -1.0, -1.0), Vector3::x(), Vector3::y(), Vector3::z()];
    let rows = Rows::new(8, vec![0, 4, 8], (0..8).collect(), vec![0.25; 8], Unity::Within(0.0)).unwrap();
    let points = vec![Point3::new(0.25, 0.25, 0.25), Point3::new(2.25, 0.25, 0.25)];
    let at = GradRows::new(points, rows, [grads, grads].concat()).unwrap();
    (nodes, VolumeRows::new(at, vec![1.0 / 6.0; 2]).unwrap())
}

#[test]
fn each_piece_is_checked() {
    let (nodes, volume) = two_pieces();
    let material = [soft()];
    let body =
        LinearBody { nodes: &nodes, volume: &volume, materials: &material, region: &[], dilation: None };
    let hold = |nodes: std::ops::Range<u32>| -> Vec<FixedDof> {
        nodes.flat_map(|node| (0..3).map(move |axis| FixedDof { node, axis, value: 0.0 })).collect()
    };
    match attempt(body, &[], &hold(0..4), &[], &[]) {
        Err(e @ SolveError::RigidMotion { node: 4, piece_nodes: 4, nodes: 8, .. }) => {
            assert!(e.to_string().ends_with("(of the piece of 4 nodes that contains node 4)"), "{e}");
        }
        other => panic!("{other:?}"),
    }
    attempt(body, &[], &hold(0..7), &[], &[]).unwrap();
    // Tied at three nodes, the second piece is constrained; tied at two nodes, it can rotate about their
    // line.
    let tie = |pairs: &[(u32, u32)]| -> Vec<ConstraintRow> {
        let row = |a, b, axis| ConstraintRow { terms: vec![(a, axis, 1.0), (b, axis, -1.0)], value: 0.0 };
        pairs.iter().flat_map(|&(a, b)| (0..3).map(move |axis| row(a, b, axis))).collect()
    };
    let constrained = hold(0..3);
    attempt(body, &[], &constrained, &tie(&[(1, 4), (2, 6), (3, 7)]), &[]).unwrap();
    assert_eq!(
        free_modes(attempt(body, &[], &constrained, &tie(&[(1, 4), (3, 7)]), &[])),
        ["rotation about z"]
    );
}

#[test]
fn nodes_at_one_place_are_refused_and_not_divided_by() {
    let (nodes, volume) = two_pieces();
    let material = [soft()];
    let same = vec![nodes[0]; 8];
    let body =
        LinearBody { nodes: &same, volume: &volume, materials: &material, region: &[], dilation: None };
    let fixed: Vec<_> = (0..24).map(|k| FixedDof { node: k / 3, axis: (k % 3) as u8, value: 0.0 }).collect();
    let turns = ["rotation about x", "rotation about y", "rotation about z"];
    assert_eq!(free_modes(attempt(body, &[], &fixed, &[], &[])), turns);
}

#[test]
fn zero_energy_modes_are_not_solved_through() {
    // One point per hexahedron leaves hourglass modes, although no rigid motion is free.
    let mesh = Block::new(CellKind::Hex8, [2, 2, 2]).mesh;
    let rule = fem::VolumeRule::STANDARD.with(CellKind::Hex8, 1).unwrap();
    let poor = Block { volume: fem::volume_rows(&mesh, &rule).unwrap(), mesh };
    let material = [soft()];
    // Three corners of the bottom, as in a three-point support.
    let fixed: Vec<_> = [(0, 0), (0, 1), (0, 2), (2, 1), (2, 2), (6, 2)]
        .map(|(node, axis)| FixedDof { node, axis, value: 0.0 })
        .to_vec();
    let surface = poor.surface(&["z-max"]);
    let loads =
        [Load::Pressure { surface: &surface, values: surface.points().iter().map(|x| x.x * x.y).collect() }];
    for dense_limit in [0, usize::MAX] {
        let body = poor.body(&material);
        let problem = LinearProblem { body, loads: &loads, fixed: &fixed, constraints: &[], weak: &[] };
        let error = assemble(&problem).unwrap().factor_with(dense_limit).err().unwrap();
        assert!(
            matches!(
                error,
                SolveError::NotPositiveDefinite | SolveError::Algebra(AlgebraError::NearlySingular { .. })
            ),
            "limit {dense_limit}: {error:?}"
        );
    }
}

#[test]
fn too_small_a_nitsche_factor_is_an_error() {
    let block = block();
    let material = [LinearElastic::new(20e3, 0.499).unwrap()];
    let flux = block.flux(&SIDES);
    for dense_limit in [0, usize::MAX] {
        let weak = [WeakSupport {
            flux: &flux,
            axes: [true; 3],
            values: vec![Vector3::zeros(); flux.weights().len()],
            region: &[],
            method: Weak::Nitsche { gamma: 0.05 },
            h: 0.01,
            trace: None,
        }];
        let body = block.body(&material);
        let problem = LinearProblem { body, loads: &[], fixed: &[], constraints: &[], weak: &weak };
        let error = assemble(&problem).unwrap().factor_with(dense_limit).err().unwrap();
        assert_eq!(error, SolveError::NotCoercive { gamma: 0.05 });
    }
}

#[test]
fn contradictory_constraints_are_not_solved_through() {
    let block = block();
    let material = [soft()];
    let fixed = block.fix(&["x-min"], |_| Vector3::zeros());
    let hold = |node, value| ConstraintRow { terms: vec![(node, 0, 1.0)], value };
    let rows = [hold(26, 1e-3), hold(26, 2e-3)];
    for dense_limit in [0, usize::MAX] {
        let body = block.body(&material);
        let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &rows, weak: &[] };
        let result = assemble(&problem).unwrap().factor_with(dense_limit).and_then(|f| f.solve(1.0));
        assert!(matches!(result, Err(SolveError::Algebra(AlgebraError::BackwardError { .. }))), "{result:?}");
    }
    let constrained = [hold(0, 1e-3)];
    let result = attempt(block.body(&material), &[], &fixed, &constrained, &[]);
    assert_eq!(result.err(), Some(SolveError::Inconsistent { row: 0, gap: 1e-3 }));
}

#[test]
fn bad_input_is_named() {
    let block = block();
    let material = [soft()];
    let body = block.body(&material);
    let fixed = block.fix(&["x-min"], |_| Vector3::zeros());
    let surface = block.surface(&["x-max"]);
    let flux = block.flux(&["x-min"]);
    let points = surface.weights().len();
    let traction = |values| [Load::Traction { surface: &surface, values }];
    let load = |values| attempt(body, &traction(values), &fixed, &[], &[]).err();
    let mut spoiled = vec![Vector3::zeros(); points];
    spoiled[3].y = f64::NAN;
    assert_eq!(load(spoiled), Some(SolveError::NotFinite { what: "load at point", index: 3 }));
    let length = SolveError::Length { what: "load values", found: 1, expected: points };
    assert_eq!(load(vec![Vector3::zeros()]), Some(length));

    let fix = |node, axis, value| {
        let more = [fixed.clone(), vec![FixedDof { node, axis, value }]].concat();
        attempt(body, &[], &more, &[], &[]).err()
    };
    assert_eq!(fix(27, 0, 0.0), Some(SolveError::NodeOutOfRange { what: "a support", node: 27, nodes: 27 }));
    assert_eq!(fix(1, 3, 0.0), Some(SolveError::BadAxis { what: "a support", axis: 3 }));
    assert!(matches!(fix(1, 0, f64::INFINITY), Some(SolveError::NotFinite { .. })));
    assert_eq!(fix(0, 2, 0.5), Some(SolveError::Conflict { node: 0, axis: 2, first: 0.0, second: 0.5 }));
    assert_eq!(fix(0, 2, 0.0), None);

    let row = |node, axis, c, value| {
        let rows = [ConstraintRow { terms: vec![(node, axis, c)], value }];
        attempt(body, &[], &fixed, &rows, &[]).err()
    };
    assert_eq!(
        row(99, 0, 1.0, 0.0),
        Some(SolveError::NodeOutOfRange { what: "a constraint row", node: 99, nodes: 27 })
    );
    assert_eq!(row(1, 7, 1.0, 0.0), Some(SolveError::BadAxis { what: "a constraint row", axis: 7 }));
    assert!(matches!(row(1, 0, f64::NAN, 0.0), Some(SolveError::NotFinite { .. })));
    assert!(matches!(row(1, 0, 1.0, f64::NAN), Some(SolveError::NotFinite { .. })));
    assert!(matches!(row(1, 0, 0.0, 1.0), Some(SolveError::Inconsistent { row: 0, .. })));

    let weak = |method, h| {
        let values = vec![Vector3::zeros(); flux.weights().len()];
        let support =
            WeakSupport { flux: &flux, axes: [true; 3], values, region: &[], method, h, trace: None };
        attempt(body, &[], &[], &[], &[support]).err()
    };
    for (method, h) in [
        (Weak::Nitsche { gamma: 0.0 }, 1.0),
        (Weak::Nitsche { gamma: f64::NAN }, 1.0),
        (Weak::Penalty { factor: -1.0 }, 1.0),
        (Weak::Penalty { factor: 1.0 }, 0.0),
    ] {
        assert!(matches!(weak(method, h), Some(SolveError::BadWeak { support: 0, .. })), "{method:?}");
    }

    let region = vec![1; block.volume.weights().len()];
    let wrong = |body| attempt(body, &[], &fixed, &[], &[]).err();
    let no_material = SolveError::NoMaterial { point: 0, region: 1, materials: 1 };
    assert_eq!(wrong(LinearBody { region: &region, ..body }), Some(no_material));
    assert!(matches!(wrong(LinearBody { region: &region[1..], ..body }), Some(SolveError::Length { .. })));
    assert!(matches!(
        wrong(LinearBody { materials: &[], ..body }),
        Some(SolveError::NoMaterial { materials: 0, .. })
    ));
    assert!(matches!(wrong(LinearBody { nodes: &body.nodes[1..], ..body }), Some(SolveError::Length { .. })));
    let mut nodes = body.nodes.to_vec();
    nodes[5].z = f64::NAN;
    assert_eq!(
        wrong(LinearBody { nodes: &nodes, ..body }),
        Some(SolveError::NotFinite { what: "position of node", index: 5 })
    );
    let other = DilationGroups::new(1, vec![0, 1], vec![0], vec![1.0]).unwrap();
    assert!(matches!(wrong(LinearBody { dilation: Some(&other), ..body }), Some(SolveError::Length { .. })));
    let factored = assemble(&LinearProblem { body, loads: &[], fixed: &fixed, constraints: &[], weak: &[] });
    assert!(matches!(factored.unwrap().factor().unwrap().solve(f64::NAN), Err(SolveError::NotFinite { .. })));
}

#[test]
fn a_group_without_volume_is_refused() {
    let (nodes, volume) = two_pieces();
    let material = [soft()];
    // The shares of each point sum to one, but the volume of the second group is negative.
    let groups = DilationGroups::new(2, vec![0, 2, 4], vec![0, 1, 0, 1], vec![1.5, 1.5, -0.5, -0.5]).unwrap();
    let body = LinearBody {
        nodes: &nodes,
        volume: &volume,
        materials: &material,
        region: &[],
        dilation: Some(&groups),
    };
    let result = attempt(body, &[], &[], &[], &[]);
    assert!(
        matches!(result, Err(SolveError::GroupVolume { group: 1, volume }) if volume < 0.0),
        "{result:?}"
    );
}

#[test]
fn a_node_that_no_point_sees_is_named() {
    let block = block();
    let mut nodes = block.mesh.points().to_vec();
    nodes.push(Point3::new(1.0, 1.0, 1.0));
    let rows = block.volume.rows();
    let wider = Rows::new(
        28,
        rows.offsets().to_vec(),
        rows.nodes().to_vec(),
        rows.values().to_vec(),
        Unity::NotPromised,
    );
    let at =
        GradRows::new(block.volume.points().to_vec(), wider.unwrap(), block.volume.grads().to_vec()).unwrap();
    let volume = VolumeRows::new(at, block.volume.weights().to_vec()).unwrap();
    let material = [soft()];
    let body =
        LinearBody { nodes: &nodes, volume: &volume, materials: &material, region: &[], dilation: None };
    let mut fixed = block.fix(&["x-min"], |_| Vector3::zeros());
    assert_eq!(attempt(body, &[], &fixed, &[], &[]).err(), Some(SolveError::OrphanNode { node: 27 }));
    fixed.extend((0..3).map(|axis| FixedDof { node: 27, axis, value: 0.1 }));
    attempt(body, &[], &fixed, &[], &[]).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// For any few constrained parameters, the problem is either solved with a small residual or refused
    /// because of a free motion, without panic or NaN.
    #[test]
    fn any_few_holds_are_solved_or_refused(
        holds in prop::collection::vec((0..27u32, 0..3u8), 0..9),
    ) {
        let block = block();
        let material = [soft()];
        let fixed: Vec<_> = holds.iter().map(|&(node, axis)| FixedDof { node, axis, value: 0.0 }).collect();
        let loads = [Load::Body { values: vec![Vector3::new(1.0, 2.0, 3.0); block.volume.weights().len()] }];
        match attempt(block.body(&material), &loads, &fixed, &[], &[]) {
            Ok(s) => {
                prop_assert!(s.u.iter().all(|u| u.iter().all(|c| c.is_finite())));
                // A factor solves to rounding of |K| |u| (Higham 2002, theorem 10.3). Supports with long
                // levers allow displacements 10^6 times those of a sound support, and this rounding then
                // exceeds that of the load.
                let largest = s.u.iter().map(Vector3::norm).fold(0.0, f64::max);
                let force = Vector3::new(1.0, 2.0, 3.0).norm() * block.volume.weights().iter().sum::<f64>();
                let reactions = material[0].young() * 0.04 * largest / force;
                prop_assert!(s.info.residual < 1e-9 + 1e-14 * reactions, "{:e}, {reactions:e}", s.info.residual);
            }
            Err(SolveError::RigidMotion { modes, .. }) => prop_assert!((1..=6).contains(&modes.len())),
            Err(other) => prop_assert!(false, "{}", other),
        }
    }
}
