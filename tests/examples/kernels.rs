//! Runs one kernel a number of times on one thread, for `cargo xtask instructions`: `kernels NAME TIMES`.
//! Without arguments it prints the processor's instruction set that the kernels use, then their names.

use std::hint::black_box;
use std::process::ExitCode;

use contact::{ContactCounts, ContactHistory, ContactLaw, ContactSurface, RoundedBox, Tool, ToolShape};
use efg::{Approximation, Basis, CubicSpline, Kernel};
use explicit::{ExplicitBody, InternalForce, Precision};
use fem::{SurfaceRule, VolumeRule};
use geometry::generate::{box_mesh, kidney_mesh};
use geometry::{CellKind, Cloud, Kidney, Mesh, cloud};
use integration::model::{Model, Projection, solve, steps};
use interp::Scheme;
use lanes::LanePath;
use material::{HolzapfelOgden, Law, LinearElastic, NeoHookean};
use shape::{DilationGroups, FixedDof, HourglassModulus, Matrix3, Point3, RowBlocks, Vector3, VolumeRows};
use statics::{
    Assembled, FollowingLoad, LinearBody, LinearProblem, LinearSystems, Load, PenaltySurface, StaticProblem,
    assemble, solve_static,
};

type Kernels = Vec<(&'static str, fn(usize))>;

fn main() -> ExitCode {
    let kernels: Kernels = vec![
        ("rows-tet10", |times| rows(CellKind::Tet10, times)),
        ("rows-moving-least-squares", least_squares),
        ("rows-maximum-entropy", maximum_entropy),
        ("assemble-tet4", |times| assembled(CellKind::Tet4, false, times)),
        ("assemble-tet4-nodal", |times| assembled(CellKind::Tet4, true, times)),
        ("assemble-hex8", |times| assembled(CellKind::Hex8, false, times)),
        ("assemble-cloud", assembled_cloud),
        ("factor-and-solve", factor),
        ("multigrid-and-solve", multigrid),
        ("explicit-tet4", |times| force(CellKind::Tet4, false, times)),
        ("explicit-tet4-nodal", |times| force(CellKind::Tet4, true, times)),
        ("explicit-hex8", |times| force(CellKind::Hex8, false, times)),
        ("explicit-hex8-mean", |times| force(CellKind::Hex8, true, times)),
        ("explicit-hex8-reduced", |times| force_by(Held::one_point(10), false, Precision::Double, times)),
        ("explicit-tet4-single", |times| force_of(CellKind::Tet4, false, Precision::Single, times)),
        ("explicit-hex8-single", |times| force_of(CellKind::Hex8, false, Precision::Single, times)),
        ("explicit-hex20", |times| force(CellKind::Hex20, false, times)),
        ("explicit-tet10", |times| force(CellKind::Tet10, false, times)),
        ("contact-jaw", jaw),
        ("transfer-apply", transfer),
        ("newton-dead-pressure", |times| newton(Condition::DeadPressure, times)),
        ("newton-following-pressure", |times| newton(Condition::FollowingPressure, times)),
        ("newton-fibers", |times| newton(Condition::Fibers, times)),
        ("newton-springs", |times| newton(Condition::Springs, times)),
        ("newton-modes", modes),
    ];
    let args: Vec<String> = std::env::args().skip(1).collect();
    match &args[..] {
        [] => {
            println!("{}", best_path().name());
            kernels.iter().for_each(|(name, _)| println!("{name}"));
            ExitCode::SUCCESS
        }
        [name, times] => match (kernels.iter().find(|(known, _)| known == name), times.parse()) {
            (Some((_, kernel)), Ok(times)) => {
                kernel(times);
                ExitCode::SUCCESS
            }
            _ => usage(),
        },
        _ => usage(),
    }
}

fn usage() -> ExitCode {
    eprintln!("kernels NAME TIMES");
    ExitCode::from(2)
}

fn best_path() -> LanePath {
    *LanePath::available().last().expect("the plain path is always there")
}

fn cube(kind: CellKind, n: usize) -> Mesh {
    let max = Point3::new(0.04, 0.04, 0.04);
    box_mesh(kind, Point3::origin(), max, [n; 3], [1.0; 3], None).unwrap()
}

fn rows(kind: CellKind, times: usize) {
    let mesh = cube(kind, 6);
    for _ in 0..times {
        black_box(fem::volume_rows(black_box(&mesh), &VolumeRule::STANDARD).unwrap());
    }
}

/// Builds moving least squares on a cloud of the kidney, with a support scale of 1.6.
fn moving_least_squares(nodes: usize) -> Approximation {
    let Cloud { points, spacing, .. } = cloud(&Kidney, nodes, 1, &[]).unwrap();
    let radii = spacing.iter().map(|h| 1.6 * h).collect();
    Approximation::new(points, radii, Kernel::CubicSpline(CubicSpline), Basis::Linear).unwrap()
}

fn least_squares(times: usize) {
    let mls = moving_least_squares(332);
    let background = kidney_mesh(CellKind::Tet4, 4).unwrap();
    for _ in 0..times {
        black_box(efg::gauss_rows(black_box(&mls), &background, 1).unwrap());
    }
}

fn maximum_entropy(times: usize) {
    let Cloud { points, spacing, .. } = cloud(&Kidney, 332, 1, &[]).unwrap();
    let functions = Approximation::maximum_entropy(points, &spacing, 1.8).unwrap();
    let at: Vec<Point3> = kidney_mesh(CellKind::Tet4, 2).unwrap().points().iter().map(|x| x * 0.9).collect();
    for _ in 0..times {
        black_box(functions.grad_rows(black_box(&at)).unwrap());
    }
}

/// A cube constrained at the bottom and pulled at the top.
struct Held {
    mesh: Mesh,
    volume: VolumeRows,
    nodal: DilationGroups,
    fixed: Vec<FixedDof>,
    material: [LinearElastic; 1],
}

impl Held {
    fn new(kind: CellKind, n: usize) -> Held {
        let mesh = cube(kind, n);
        let volume = fem::volume_rows(&mesh, &VolumeRule::STANDARD).unwrap();
        let nodal = DilationGroups::nodal(&volume).unwrap();
        let on = |group: &str, value: f64| -> Vec<FixedDof> {
            let nodes = mesh.facet_group_nodes(mesh.group(group).unwrap());
            nodes.iter().flat_map(|&node| (0..3).map(move |axis| FixedDof { node, axis, value })).collect()
        };
        let fixed = [on("z-min", 0.0), on("z-max", 1e-3)].concat();
        Held { volume, nodal, fixed, material: [LinearElastic::new(20e3, 0.3).unwrap()], mesh }
    }

    fn one_point(n: usize) -> Held {
        let held = Held::new(CellKind::Hex8, n);
        Held { volume: fem::uniform_rows(&held.mesh, 0.05, HourglassModulus::PWave).unwrap(), ..held }
    }

    fn assembled(&self, projected: bool) -> Assembled<'_> {
        let body = LinearBody {
            nodes: self.mesh.points(),
            volume: &self.volume,
            materials: &self.material,
            region: &[],
            dilation: projected.then_some(&self.nodal),
        };
        assemble(&LinearProblem { body, loads: &[], fixed: &self.fixed, constraints: &[], weak: &[] })
            .unwrap()
    }
}

fn assembled(kind: CellKind, projected: bool, times: usize) {
    let held = Held::new(kind, 8);
    for _ in 0..times {
        black_box(held.assembled(projected));
    }
}

fn factor(times: usize) {
    let held = Held::new(CellKind::Tet4, 8);
    for _ in 0..times {
        black_box(held.assembled(false).factor().unwrap().solve(1.0).unwrap());
    }
}

fn multigrid(times: usize) {
    let held = Held::new(CellKind::Tet4, 10);
    for _ in 0..times {
        let assembled = held.assembled(false);
        let levels = assembled.multigrid(None).unwrap();
        black_box(assembled.iterated(levels, 1e-8).unwrap().solve(1.0).unwrap());
    }
}

fn assembled_cloud(times: usize) {
    let mls = moving_least_squares(83);
    let background = kidney_mesh(CellKind::Tet4, 4).unwrap();
    let volume = efg::gauss_rows(&mls, &background, 1).unwrap().0;
    let material = [LinearElastic::new(20e3, 0.495).unwrap()];
    // All parameters are constrained, because only assembly counts.
    let fixed: Vec<_> =
        (0..3 * 83).map(|k| FixedDof { node: k / 3, axis: (k % 3) as u8, value: 0.0 }).collect();
    let body =
        LinearBody { nodes: mls.nodes(), volume: &volume, materials: &material, region: &[], dilation: None };
    let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &[], weak: &[] };
    for _ in 0..times {
        black_box(assemble(black_box(&problem)).unwrap());
    }
}

fn force(kind: CellKind, projected: bool, times: usize) {
    force_of(kind, projected, Precision::Double, times);
}

fn force_of(kind: CellKind, projected: bool, precision: Precision, times: usize) {
    // About a thousand elements to six thousand; the points of a quadratic element are many.
    let mut held = Held::new(kind, if kind.order() == 1 { 10 } else { 5 });
    if kind == CellKind::Hex8 {
        held.nodal = fem::element_dilation(&held.mesh, &VolumeRule::STANDARD).unwrap();
    }
    force_by(held, projected, precision, times);
}

fn force_by(held: Held, projected: bool, precision: Precision, times: usize) {
    let laws = [Law::NeoHookean(NeoHookean::new(20e3, 0.495).unwrap())];
    let groups = projected.then_some(&held.nodal);
    let body = ExplicitBody { volume: &held.volume, laws: &laws, region: &[], axes: &[], groups };
    let mut force = InternalForce::of_precision(body, best_path(), precision).unwrap();
    let field = |x: &Point3| Vector3::new(0.05 * x.y, -0.04 * x.z, 0.1 * x.x);
    let u: Vec<Vector3> = held.mesh.points().iter().map(field).collect();
    let mut f = vec![Vector3::zeros(); u.len()];
    for _ in 0..10 * times {
        force.evaluate(black_box(&u), &mut f).unwrap();
    }
}

/// A jaw a tenth of a millimetre deep in the top of a block, with tangents.
fn jaw(times: usize) {
    let max = Point3::new(0.04, 0.03, 0.02);
    let mesh = box_mesh(CellKind::Tet4, Point3::origin(), max, [20, 16, 10], [1.0; 3], None).unwrap();
    let rows = fem::surface_rows(&mesh, &mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
    let surface = ContactSurface::new(&rows);
    let law = ContactLaw::coulomb(5e8, 0.15, 1e8).unwrap();
    let shape = ToolShape::RoundedBox(RoundedBox { half: [5e-3, 10e-3, 4e-3], radius: 1.5e-3 });
    let at = Point3::new(0.02, 0.015, 0.024);
    let tool = Tool::new(shape, at, Matrix3::identity(), -Vector3::z(), law).unwrap();
    let u = vec![Vector3::new(1e-5, 2e-5, 0.0); mesh.points().len()];
    let history = ContactHistory::new(&tool, rows.points().len());
    let mut counts = ContactCounts::default();
    for _ in 0..10 * times {
        black_box(surface.evaluate(&tool, 1e-4, black_box(&u), &history, &mut counts).unwrap());
    }
}

/// Displacements of 83 nodes at 332 points.
fn transfer(times: usize) {
    let nodes = cloud(&Kidney, 83, 1, &[]).unwrap().points;
    let targets = cloud(&Kidney, 332, 2, &[]).unwrap().points;
    let scheme = Scheme::all().into_iter().find(|s| s.name() == "mls-linear").expect("a scheme of that name");
    let rows = scheme.rows(&nodes, None, &targets).unwrap().0;
    let blocks = RowBlocks::new(rows.rows());
    let field: Vec<Vector3> = nodes.iter().map(|x| 0.1 * x.coords).collect();
    let mut out = vec![Vector3::zeros(); targets.len()];
    for _ in 0..100 * times {
        blocks.apply_into(black_box(&field), &mut out);
    }
}

/// Differences between steps at large strain.
#[derive(Clone, Copy, PartialEq)]
enum Condition {
    DeadPressure,
    FollowingPressure,
    /// A law with fibres in place of the neo-Hookean law.
    Fibers,
    /// Springs under the bottom in place of constrained nodes.
    Springs,
}

/// Solves one step of a block of hex8 that is pressed from above, in eight tangents or fewer.
fn newton(condition: Condition, times: usize) {
    let model = Model::block((CellKind::Hex8, Projection::Standard), [6, 6, 6]);
    let law = match condition {
        Condition::Fibers => {
            let law = HolzapfelOgden::new([2e3, 5.0], [4e3, 5.0], [1e3, 5.0], [5e2, 5.0], 2e5);
            Law::HolzapfelOgden(law.unwrap())
        }
        _ => Law::NeoHookean(NeoHookean::new(20e3, 0.45).unwrap()),
    };
    let axes = vec![Matrix3::identity(); model.volume.weights().len()];
    let (top, bottom) = (model.facets(&["z-max"]), model.facets(&["z-min"]));
    let rows = fem::surface_rows(&model.mesh, &top, &SurfaceRule::STANDARD).unwrap();
    let flux = fem::flux_rows(&model.mesh, &top, &SurfaceRule::STANDARD).unwrap();
    let ground = fem::surface_rows(&model.mesh, &bottom, &SurfaceRule::STANDARD).unwrap();
    let values = vec![1e3; rows.weights().len()];
    let following = [FollowingLoad::pressure(&flux, &values).unwrap()];
    let loads = [Load::Pressure { surface: &rows, values }];
    let fixed = model.hold(&["z-min"], &[0, 1, 2], |_| Vector3::zeros());
    let springs = [PenaltySurface {
        axes: [true; 3],
        along_normal: false,
        values: vec![Vector3::zeros(); ground.weights().len()],
        from: Vec::new(),
        beta: 1e6,
        damping: 0.0,
        surface: &ground,
    }];
    let mut problem = StaticProblem { loads: &loads, fixed: &fixed, ..model.problem(&law) };
    match condition {
        Condition::DeadPressure => {}
        Condition::FollowingPressure => (problem.loads, problem.following) = (&[], &following),
        Condition::Fibers => problem.solid.axes = &axes,
        Condition::Springs => (problem.fixed, problem.penalties) = (&[], &springs),
    }
    for _ in 0..times {
        black_box(solve("kernel", black_box(&problem), &steps(1)));
    }
}

/// Solves eight steps of the same block for the coefficients of the eight modes that they pass through.
fn modes(times: usize) {
    let model = Model::block((CellKind::Hex8, Projection::Element), [6, 6, 6]);
    let law = Law::NeoHookean(NeoHookean::new(20e3, 0.45).unwrap());
    let top = fem::surface_rows(&model.mesh, &model.facets(&["z-max"]), &SurfaceRule::STANDARD).unwrap();
    let fixed = model.hold(&["z-min"], &[0, 1, 2], |_| Vector3::zeros());
    let loads = [Load::Pressure { surface: &top, values: vec![1e3; top.weights().len()] }];
    let problem = StaticProblem { loads: &loads, fixed: &fixed, ..model.problem(&law) };
    let (params, mut states) = (steps(8), Vec::new());
    solve_static(&problem, &params, |_, rest| states.push(rest.u.to_vec())).unwrap();
    let basis = statics::Basis::of_states(&model.volume, &states, 8);
    let problem = StaticProblem { systems: LinearSystems::Modal(&basis), ..problem };
    for _ in 0..times {
        black_box(solve("modes", black_box(&problem), &params));
    }
}
