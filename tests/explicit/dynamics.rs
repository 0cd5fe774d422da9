//! Mass, critical step and central differences.

use explicit::{
    Balance, Dynamics, DynamicsParams, ExplicitBody, ExplicitError, InternalForce, LanczosParams, Lumping,
    Prescribed, Springs, critical_step, critical_step_touching, lumped_mass,
};
use geometry::CellKind;
use geometry::generate::box_mesh;
use integration::block::{Block, affine, gradient};
use lanes::LanePath;
use material::{Law, Material as _, NeoHookean};
use shape::{Point3, Vector3};

const RHO: f64 = 1060.0;
const LANCZOS: LanczosParams = LanczosParams { steps: 15, safety: 0.95 };

fn law() -> [Law; 1] {
    [Law::NeoHookean(NeoHookean::new(20e3, 0.45).unwrap())]
}

fn body<'a>(volume: &'a shape::VolumeRows, laws: &'a [Law]) -> ExplicitBody<'a> {
    ExplicitBody { volume, laws, region: &[], axes: &[], groups: None }
}

fn undamped(dt: f64) -> DynamicsParams {
    DynamicsParams { dt, damping: 0.0, critical: LANCZOS, recheck: 0, known: None }
}

fn no_load(_: f64, _: &[Vector3], _: &[Vector3], _: &mut [Vector3]) {}

#[test]
fn mass_is_positive_and_complete() {
    for kind in CellKind::ALL {
        let block = Block::new(kind, [2, 2, 2]);
        let lumping = Lumping::for_table(&block.volume);
        assert_eq!(lumping == Lumping::DiagonalScaling, kind.order() == 2);
        let mass = lumped_mass(&block.volume, &[RHO], &[], lumping).unwrap();
        let total: f64 = mass.iter().sum();
        assert!(mass.iter().all(|&m| m > 0.0));
        // 40 x 30 x 20 mm.
        assert!((total / (RHO * 24e-6) - 1.0).abs() < 1e-13, "{}: {total}", kind.name());
    }
    let quadratic = Block::new(CellKind::Tet10, [1, 1, 1]);
    let error = lumped_mass(&quadratic.volume, &[RHO], &[], Lumping::RowSum).unwrap_err();
    assert!(matches!(error, ExplicitError::NodalMass { mass, .. } if mass <= 0.0));
}

/// The dense matrix `M^-1/2 K M^-1/2` is built column by column from unit displacements; nalgebra's dense
/// solver gives its largest eigenvalue.
#[test]
fn critical_step_agrees_with_a_dense_eigenvalue() {
    let block = Block::new(CellKind::Tet4, [3, 2, 2]);
    let laws = law();
    let mass = lumped_mass(&block.volume, &[RHO], &[], Lumping::RowSum).unwrap();
    let mut force = InternalForce::new(body(&block.volume, &laws), LanePath::best()).unwrap();
    let n = 3 * mass.len();
    for stretch in [0.0, 6.0] {
        let u: Vec<Vector3> = block.mesh.points().iter().map(|x| gradient() * x.coords * stretch).collect();
        let mut dense = nalgebra::DMatrix::zeros(n, n);
        let mut f = [vec![Vector3::zeros(); mass.len()], vec![Vector3::zeros(); mass.len()]];
        let h = 1e-8;
        for k in 0..n {
            for (sign, f) in [1.0, -1.0].into_iter().zip(&mut f) {
                let mut moved = u.clone();
                moved[k / 3][k % 3] += sign * h;
                force.evaluate(&moved, f).unwrap();
            }
            for i in 0..n {
                let slope = (f[0][i / 3][i % 3] - f[1][i / 3][i % 3]) / (2.0 * h);
                dense[(i, k)] = slope / (mass[i / 3] * mass[k / 3]).sqrt();
            }
        }
        let symmetric = (&dense + dense.transpose()) * 0.5;
        let omega = symmetric.symmetric_eigenvalues().max().sqrt();
        let exact =
            critical_step(&mut force, &mass, &u, |_| true, LanczosParams { steps: 60, safety: 1.0 }).unwrap();
        assert!((exact.omega_max / omega - 1.0).abs() < 1e-6, "{} {omega}", exact.omega_max);
        let quick = critical_step(&mut force, &mass, &u, |_| true, LANCZOS).unwrap();
        // The estimate is below the eigenvalue, but with the safety factor the step is on the safe side of 2
        // / omega.
        assert!(
            quick.omega_max <= omega * (1.0 + 1e-6) && quick.dt < 2.0 / omega,
            "{} {omega}",
            quick.omega_max
        );
        assert!(quick.dt > 0.9 * 2.0 / omega);
    }
}

/// Springs so stiff that the body hardly matters: the largest eigenvalue of `M^-1 sum_q w k N N^T`, from a
/// dense matrix.
#[test]
fn springs_on_a_surface_shorten_the_critical_step() {
    let block = Block::new(CellKind::Tet4, [3, 2, 2]);
    let laws = law();
    let surface = block.surface(&["z-max", "x-min"]);
    let mass = lumped_mass(&block.volume, &[RHO], &[], Lumping::RowSum).unwrap();
    let mut force = InternalForce::new(body(&block.volume, &laws), LanePath::best()).unwrap();
    let n = mass.len();
    let modulus = 1e14;
    let mut dense = nalgebra::DMatrix::<f64>::zeros(n, n);
    for (q, w) in surface.weights().iter().enumerate() {
        let (nodes, values) = surface.rows().row(q);
        for (&i, a) in nodes.iter().zip(values) {
            for (&j, b) in nodes.iter().zip(values) {
                let m = (mass[i as usize] * mass[j as usize]).sqrt();
                dense[(i as usize, j as usize)] += w * modulus * a * b / m;
            }
        }
    }
    let omega = dense.symmetric_eigenvalues().max().sqrt();
    let springs = [Springs { surface: &surface, modulus, damping: 0.0 }];
    let params = LanczosParams { steps: 60, safety: 1.0 };
    let zero = vec![Vector3::zeros(); n];
    let found = critical_step_touching(&mut force, &mass, &zero, |_| true, &springs, params).unwrap();
    assert!((found.omega_max / omega - 1.0).abs() < 1e-6, "{} {omega}", found.omega_max);
}

struct Free {
    block: Block,
    mass: Vec<f64>,
}

impl Free {
    fn new(cells: [usize; 3]) -> Free {
        let block = Block::new(CellKind::Tet4, cells);
        let mass = lumped_mass(&block.volume, &[RHO], &[], Lumping::RowSum).unwrap();
        Free { block, mass }
    }

    /// Returns a state stretched by about 10 %, rotating and flying.
    fn start(&self) -> (Vec<Vector3>, Vec<Vector3>) {
        let x = self.block.mesh.points();
        let u = x.iter().map(|x| affine(x) * 4.0).collect();
        let v =
            x.iter().map(|x| Vector3::new(3.0, -5.0, 8.0).cross(&x.coords) + Vector3::new(0.2, -0.1, 0.15));
        (u, v.collect())
    }

    fn momenta(&self, u: &[Vector3], v: &[Vector3]) -> (Vector3, Vector3) {
        let mut sums = (Vector3::zeros(), Vector3::zeros());
        for (i, x) in self.block.mesh.points().iter().enumerate() {
            let p = v[i] * self.mass[i];
            sums.0 += p;
            sums.1 += (x.coords + u[i]).cross(&p);
        }
        sums
    }
}

#[test]
fn a_free_body_keeps_momentum_and_energy() {
    let free = Free::new([4, 3, 2]);
    let laws = law();
    let mut force = InternalForce::new(body(&free.block.volume, &laws), LanePath::best()).unwrap();
    let (u, v) = free.start();
    let critical = critical_step(&mut force, &free.mass, &u, |_| true, LANCZOS).unwrap().dt;
    let mut drift = |part: f64| {
        let steps = (500.0 / part) as usize;
        let params = undamped(part * critical);
        let mut motion = Dynamics::new(&mut force, &free.mass, &[], params, u.clone(), v.clone()).unwrap();
        let mut worst = 0.0f64;
        let mut swing = (f64::INFINITY, 0.0f64);
        let mut record = |b: &Balance, _: &[Vector3]| {
            worst = worst.max(b.drift.abs());
            swing = (swing.0.min(b.strain), swing.1.max(b.strain));
        };
        motion.run(1, 10, &mut no_load, &mut record).unwrap();
        // Angular momentum of x_(n+1) and v_(n+1/2) equals that with x_n, because x_(n+1) - x_n is parallel
        // to v.
        let (p0, l0) = free.momenta(motion.displacements(), motion.velocities());
        motion.run(steps, 5, &mut no_load, &mut record).unwrap();
        let (p, l) = free.momenta(motion.displacements(), motion.velocities());
        assert!((p - p0).norm() < 1e-12 * p0.norm(), "{:e}", (p - p0).norm() / p0.norm());
        assert!((l - l0).norm() < 1e-12 * l0.norm(), "{:e}", (l - l0).norm() / l0.norm());
        assert!(swing.0 < 0.5 * swing.1, "the body vibrates: {swing:?}");
        worst
    };
    // The energy conserved by central differences differs from the true energy by the square of the step.
    let (whole, half) = (drift(0.25), drift(0.125));
    assert!(whole < 2.5e-3 && half < 0.3 * whole, "{whole:e} {half:e}");
}

/// Central differences are exact for a constant acceleration, `u = g t^2 / 2`. Velocities are advanced by the
/// mean of the steps before and after, so this remains true for changing steps.
#[test]
fn a_fall_is_exact_whatever_the_steps() {
    let free = Free::new([2, 2, 2]);
    let laws = law();
    let mut force = InternalForce::new(body(&free.block.volume, &laws), LanePath::best()).unwrap();
    let zero = vec![Vector3::zeros(); free.mass.len()];
    let dt = 0.5 * critical_step(&mut force, &free.mass, &zero, |_| true, LANCZOS).unwrap().dt;
    let g = Vector3::new(1.0, -2.0, 9.81);
    let mut weight = |_: f64, _: &[Vector3], _: &[Vector3], f: &mut [Vector3]| {
        f.iter_mut().zip(&free.mass).for_each(|(f, m)| *f += g * *m);
    };
    let mut motion =
        Dynamics::new(&mut force, &free.mass, &[], undamped(dt), zero.clone(), zero.clone()).unwrap();
    for (part, steps) in [(1.0, 3), (0.25, 5), (0.7, 4), (1.0, 2)] {
        motion.set_step(part * dt).unwrap();
        motion.run(steps, 0, &mut weight, &mut |_, _| ()).unwrap();
        let fallen = g * (0.5 * motion.time().powi(2));
        let worst = motion.displacements().iter().map(|u| (u - fallen).norm()).fold(0.0, f64::max);
        assert!(worst < 1e-12 * fallen.norm(), "{part}: {worst:e} of {:e}", fallen.norm());
    }
}

#[test]
fn energy_balance_with_loads_supports_and_damping() {
    let free = Free::new([4, 3, 2]);
    let laws = law();
    let mut force = InternalForce::new(body(&free.block.volume, &laws), LanePath::best()).unwrap();
    let zero = vec![Vector3::zeros(); free.mass.len()];
    let dt = 0.5 * critical_step(&mut force, &free.mass, &zero, |_| true, LANCZOS).unwrap().dt;
    let hold = |_: f64| 0.0;
    let lead = |t: f64| 0.6e-3 * (1.0 - (200.0 * t).cos());
    let mut prescribed = Vec::new();
    for node in free.block.nodes_of(&["x-min"]) {
        for axis in 0..3 {
            let motion: &(dyn Fn(f64) -> f64 + Sync) = if axis == 2 { &lead } else { &hold };
            prescribed.push(Prescribed { node, axis, motion });
        }
    }
    let top = free.block.nodes_of(&["x-max"]);
    let mut load = |t: f64, _: &[Vector3], _: &[Vector3], f: &mut [Vector3]| {
        top.iter().for_each(|&i| f[i as usize].y += 0.02 * (300.0 * t).sin());
    };
    for damping in [0.0, 60.0] {
        let params = DynamicsParams { damping, ..undamped(dt) };
        let mut motion =
            Dynamics::new(&mut force, &free.mass, &prescribed, params, zero.clone(), zero.clone()).unwrap();
        let mut all = Vec::new();
        motion.run(600, 20, &mut load, &mut |b, _| all.push(*b)).unwrap();
        let last = all.last().unwrap();
        assert!(last.external.abs() > 1e-6 && last.support.abs() > 1e-6, "{last:?}");
        assert!((damping > 0.0) == (last.damping > 1e-6), "{last:?}");
        let worst = all.iter().map(|b| b.drift.abs()).fold(0.0, f64::max);
        // Observed: 1.7e-3, and 1.4e-5 with damping, which damps the highest modes first.
        let bound = if damping > 0.0 { 1e-4 } else { 3e-3 };
        assert!(worst < bound, "damping {damping}: {worst:e} {last:?}");
    }
}

/// A bar without lateral motion (P wave, `c^2 = (lambda + 2 mu) / rho`) in its first longitudinal mode.
/// Linear elements with lumped mass have `omega = 2 c / h sin(pi h / (2 L))`, central differences have
/// `sin(omega' dt / 2) = omega dt / 2`.
#[test]
fn a_bar_vibrates_at_the_frequency_of_its_dispersion() {
    let (cells, length) = (20, 0.1);
    let max = Point3::new(length, 0.005, 0.005);
    let mesh = box_mesh(CellKind::Hex8, Point3::origin(), max, [cells, 1, 1], [1.0; 3], None).unwrap();
    let volume = fem::volume_rows(&mesh, &fem::VolumeRule::STANDARD).unwrap();
    let laws = law();
    let mass = lumped_mass(&volume, &[RHO], &[], Lumping::RowSum).unwrap();
    let mut force = InternalForce::new(body(&volume, &laws), LanePath::best()).unwrap();
    let hold = |_: f64| 0.0;
    let mut prescribed = Vec::new();
    let n = mesh.points().len();
    for (i, x) in mesh.points().iter().enumerate() {
        for axis in 0..3u8 {
            if axis > 0 || x.x == 0.0 || x.x == length {
                prescribed.push(Prescribed { node: i as u32, axis, motion: &hold });
            }
        }
    }
    let k = std::f64::consts::PI / length;
    let shape = |x: &Point3| (k * x.x).sin();
    // The amplitude is 1e-7 of the length, hence linear.
    let u: Vec<Vector3> = mesh.points().iter().map(|x| Vector3::new(1e-8 * shape(x), 0.0, 0.0)).collect();
    let c = ((laws[0].lambda() + 2.0 * laws[0].mu()) / RHO).sqrt();
    let h = length / cells as f64;
    let dt = 0.6 * h / c;
    let discrete = 2.0 * c / h * (k * h / 2.0).sin();
    let omega = 2.0 / dt * (discrete * dt / 2.0).asin();
    let mut motion =
        Dynamics::new(&mut force, &mass, &prescribed, undamped(dt), u, vec![Vector3::zeros(); n]).unwrap();
    // The time is no multiple of the period, at which the cosine would hide a wrong frequency.
    let steps = 207;
    motion.run(steps, 0, &mut no_load, &mut |_, _| ()).unwrap();
    let expected = (omega * dt * steps as f64).cos();
    for (x, u) in mesh.points().iter().zip(motion.displacements()) {
        assert!((u.x / 1e-8 - expected * shape(x)).abs() < 1e-5, "{} {}", u.x / 1e-8, expected * shape(x));
    }
    // The frequency of the continuum differs enough for the test to notice it.
    assert!(((c * k * dt * steps as f64).cos() - expected).abs() > 1e-3);
}

#[test]
fn bits_of_a_motion_do_not_depend_on_threads() {
    let free = Free::new([9, 8, 7]);
    let laws = law();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut force = InternalForce::new(body(&free.block.volume, &laws), LanePath::best()).unwrap();
            let (u, v) = free.start();
            let dt = 0.8 * critical_step(&mut force, &free.mass, &u, |_| true, LANCZOS).unwrap().dt;
            let mut motion = Dynamics::new(&mut force, &free.mass, &[], undamped(dt), u, v).unwrap();
            motion.run(50, 0, &mut no_load, &mut |_, _| ()).unwrap();
            motion.displacements().to_vec()
        })
    };
    assert_eq!(run(1), run(2));
}

/// A motion that could update its estimate at every state keeps the last estimate until a point has changed
/// its shape by 2 %.
#[test]
fn the_critical_step_follows_the_shape() {
    let free = Free::new([3, 2, 2]);
    let laws = law();
    let zero = vec![Vector3::zeros(); free.mass.len()];
    let mut force = InternalForce::new(body(&free.block.volume, &laws), LanePath::best()).unwrap();
    let mut stepped = |stretch: f64| {
        let u: Vec<Vector3> =
            free.block.mesh.points().iter().map(|x| Vector3::new(stretch * x.x, 0.0, 0.0)).collect();
        let at = critical_step(&mut force, &free.mass, &u, |_| true, LANCZOS).unwrap();
        let start = critical_step(&mut force, &free.mass, &zero, |_| true, LANCZOS).unwrap();
        // The estimate at rest is passed in as known.
        let params = DynamicsParams { known: Some(start), ..undamped(0.5 * start.dt) };
        let velocity: Vec<Vector3> = u.iter().map(|u| u / (0.5 * start.dt)).collect();
        let mut motion = Dynamics::new(&mut force, &free.mass, &[], params, zero.clone(), velocity).unwrap();
        motion.run(1, 0, &mut no_load, &mut |_, _| ()).unwrap();
        let moved = motion.displacements().iter().zip(&u).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(moved < 1e-12, "{moved}");
        (motion.critical_step().unwrap().dt, start.dt, at.dt)
    };
    for stretch in [0.019, -0.019] {
        let (found, start, _) = stepped(stretch);
        assert_eq!(found, start, "{stretch}");
    }
    for stretch in [0.021, -0.3] {
        let (found, start, at) = stepped(stretch);
        assert!((found / at - 1.0).abs() < 1e-6 && found != start, "{stretch}: {found} {at} {start}");
    }
}

#[test]
fn what_cannot_go_on_is_named() {
    let free = Free::new([3, 2, 2]);
    let laws = law();
    let zero = vec![Vector3::zeros(); free.mass.len()];
    let mut force = InternalForce::new(body(&free.block.volume, &laws), LanePath::best()).unwrap();
    let limit = critical_step(&mut force, &free.mass, &zero, |_| true, LANCZOS).unwrap().dt;
    let error =
        Dynamics::new(&mut force, &free.mass, &[], undamped(1.1 * limit), zero.clone(), zero.clone()).err();
    assert!(
        matches!(error, Some(ExplicitError::StepTooLarge { step: 0, critical, .. }) if critical == limit)
    );

    // Compressed until a point is inverted; compressed elements shorten the critical step before that.
    let mut squeeze = |_: f64, _: &[Vector3], _: &[Vector3], f: &mut [Vector3]| {
        for (x, f) in free.block.mesh.points().iter().zip(f) {
            f.x += 1.0 * (0.02 - x.x).signum();
        }
    };
    for recheck in [0, 1] {
        let params = DynamicsParams { recheck, ..undamped(0.9 * limit) };
        let mut motion =
            Dynamics::new(&mut force, &free.mass, &[], params, zero.clone(), zero.clone()).unwrap();
        let error = motion.run(1000, 0, &mut squeeze, &mut |_, _| ()).unwrap_err();
        match (recheck, error) {
            (0, ExplicitError::InvertedAt { step, time, at }) => {
                assert!(step > 0 && time == step as f64 * (0.9 * limit) && at.det_f <= 0.0)
            }
            (1, ExplicitError::StepTooLarge { step, dt, critical, .. }) => assert!(step > 0 && dt > critical),
            (_, other) => panic!("recheck {recheck}: {other}"),
        }
    }

    let mut poisoned = |t: f64, _: &[Vector3], _: &[Vector3], f: &mut [Vector3]| {
        if t > 3.5 * 0.9 * limit {
            f[5].y = f64::NAN;
        }
    };
    let mut motion =
        Dynamics::new(&mut force, &free.mass, &[], undamped(0.9 * limit), zero.clone(), zero.clone())
            .unwrap();
    let error = motion.run(10, 0, &mut poisoned, &mut |_, _| ()).unwrap_err();
    assert!(
        matches!(error, ExplicitError::NotFinite { step: 4, what: "external force", node: 5, .. }),
        "{error}"
    );

    let hold = |_: f64| 0.0;
    let twice = [0, 0].map(|axis| Prescribed { node: 1, axis, motion: &hold });
    let error = Dynamics::new(&mut force, &free.mass, &twice, undamped(limit), zero.clone(), zero).err();
    assert!(matches!(error, Some(ExplicitError::BadDof { node: 1, axis: 0, .. })));
}
