//! Influence of forces on numbers of a solution, against the differences of solutions.

use contact::{ContactHistory, ContactLaw, ContactSurface, Drive, DrivenTool, Sphere, Tool};
use fem::{SurfaceRule, VolumeRule};
use geometry::CellKind;
use geometry::generate::box_mesh;
use material::{Law, NeoHookean};
use shape::{FixedDof, Matrix3, Point3, Vector3, VolumeRows};
use tissuebench_statics::{
    Active, Curves, Goal, LinearSystems, Load, Nearby, NewtonParams, Solid, SolidDilation, StaticParams,
    StaticProblem, solve_static, trace,
};

fn solid<'a>(volume: &'a VolumeRows, laws: &'a [Law]) -> Solid<'a> {
    let (active, dilation) = (Active::default(), SolidDilation::Standard);
    Solid { volume, laws, region: &[], axes: &[], active, dilation }
}

/// A ball that touches the block, with its direction of travel.
fn ball() -> (Tool, Vector3) {
    let law = ContactLaw::coulomb(2e7, 0.3, 1e7).unwrap();
    let along = Vector3::new(0.8, 0.0, -0.6);
    let at = Point3::new(0.008, 0.011, 0.018);
    (Tool::new(Sphere { radius: 8e-3 }.into(), at, Matrix3::identity(), along, law).unwrap(), along)
}

/// A ball presses into a soft block and drags over it with friction. The influence of a nodal force on the
/// force of the ball, on the displacement of a node and on the force of the support is the difference between
/// the equilibria with a little of this force forth and back. The tangent is unsymmetric: without its
/// transposition an influence on the ball is six times too large.
#[test]
fn an_influence_is_the_difference_of_solutions() {
    let top = Point3::new(0.02, 0.02, 0.01);
    let mesh = box_mesh(CellKind::Hex8, Point3::origin(), top, [4, 4, 2], [1.0; 3], None).unwrap();
    let volume = fem::volume_rows(&mesh, &VolumeRule::STANDARD).unwrap();
    let surface = fem::surface_rows(&mesh, mesh.group("z-max").unwrap(), &SurfaceRule::STANDARD).unwrap();
    let surface = ContactSurface::new(&surface);
    let bottom = mesh.facet_group_nodes(mesh.group("z-min").unwrap());
    let fixed: Vec<FixedDof> =
        bottom.iter().flat_map(|&node| (0..3).map(move |axis| FixedDof { node, axis, value: 0.0 })).collect();
    let (tool, along) = ball();
    let closure = 1e-3;
    let laws = [Law::NeoHookean(NeoHookean::new(20e3, 0.3).unwrap())];
    let nodes = mesh.points().len();
    let newton =
        NewtonParams { tolerance: 1e-11, iterations: 40, chords: false, keeps: f64::INFINITY, loosest: None };
    let params = StaticParams { steps: 1, smallest: 1.0, newton, augmentations: 0, limit_within: None };
    let node = mesh.points().iter().position(|p| *p == Point3::new(0.01, 0.01, 0.01)).unwrap();
    let mut weights = vec![Vector3::zeros(); nodes];
    weights[node] = Vector3::new(0.6, 0.8, 0.0);
    let mut held = vec![Vector3::zeros(); nodes];
    bottom.iter().for_each(|&node| held[node as usize].x = 1.0);
    // The numbers at the equilibrium under a nodal force, and the influences if there is none.
    let solved = |force: Vector3, traces: bool| {
        let mut forces = vec![Vector3::zeros(); nodes];
        forces[node] = force;
        let problem = StaticProblem {
            nodes: mesh.points(),
            solid: solid(&volume, &laws),
            loads: &[Load::Nodal { forces }],
            following: &[],
            fixed: &fixed,
            curves: Curves::proportional(),
            penalties: &[],
            contact: Some(&surface),
            tools: &[DrivenTool { tool: &tool, drive: Drive::Closure(closure) }],
            systems: LinearSystems::Factored,
        };
        let mut reaction = 0.0;
        let path = solve_static(&problem, &params, |_, rest| {
            reaction = rest.reaction.iter().zip(&held).map(|(force, held)| force.dot(held)).sum();
        })
        .unwrap();
        assert!(path.failure.is_none(), "{:?}", path.failure);
        assert_eq!(path.steps.len(), 1);
        let pushed = -path.steps.last().unwrap().tools[0].force.dot(&along);
        let moved: f64 = path.u.iter().zip(&weights).map(|(u, w)| u.dot(w)).sum();
        // The direction at the start: the path has one step.
        let mut history = ContactHistory::new(&tool, surface.rows().weights().len());
        history.commit_all(None, &surface, &tool, 0.0, &vec![Vector3::zeros(); nodes]);
        let history = [history];
        let near = Nearby { time: 1.0, u: &path.u, pressure: &[], closures: &[closure], history: &history };
        let goals = [Goal::Tool(0), Goal::Displacement(&weights), Goal::Supports(&held)];
        let traced =
            goals.iter().filter(|_| traces).map(|goal| trace(&problem, &newton, near, *goal).unwrap());
        ([pushed, moved, reaction], traced.collect::<Vec<_>>())
    };
    let (now, traced) = solved(Vector3::zeros(), true);
    assert!(now[0] > 1e-2 && now[2].abs() > 1e-3, "{now:?}");
    for (number, traced) in now.iter().zip(&traced) {
        assert!((traced.predicted / number - 1.0).abs() < 1e-6, "{} {number}", traced.predicted);
    }
    for axis in 0..3 {
        let step = Vector3::ith(axis, 1e-6);
        let [forth, back] = [step, -step].map(|force| solved(force, false).0);
        for (k, traced) in traced.iter().enumerate() {
            let difference = (forth[k] - back[k]) / 2e-6;
            let largest = traced.influence.iter().map(|z| z.norm()).fold(0.0, f64::max);
            let influence = traced.influence[node][axis];
            assert!((influence - difference).abs() < 1e-4 * largest, "{k} {axis}: {influence} {difference}");
        }
    }
}
