//! Relaxing bodies: relaxation, creep, and their role in dynamics.

use fem::VolumeRule;
use geometry::CellKind;
use integration::cuboid::{Cuboid, moving, params};
use material::{
    Law, LinearElastic, Material, MooneyRivlin, NeoHookean, NeoHookeanIsochoric, Prony, SaintVenantKirchhoff,
};
use shape::{Curve, FixedDof, Vector3};
use statics::{
    Curves, Load, Motion, SolidDilation, StaticProblem, TimeParams, TimeProblem, TimeStep, solve_in_time,
};

const YOUNG: f64 = 20e3;
const SIDE: f64 = 0.01;

fn series() -> Prony {
    Prony::new(&[(0.3, 0.05), (0.25, 1.0)]).unwrap()
}

fn cube(kind: CellKind) -> Cuboid {
    Cuboid::new(kind, [SIDE; 3], [2, 2, 2])
}

fn end(x: &shape::Point3) -> bool {
    x.x > SIDE - 1e-9
}

/// Returns time, force on the face x = 10 mm, and step, for a quasi-static motion.
fn pulls(
    block: &Cuboid,
    body: &StaticProblem,
    curve: Curve,
    relaxation: &[Option<Prony>],
    params: &TimeParams,
) -> Vec<(f64, f64, TimeStep)> {
    let body = &StaticProblem { curves: Curves::all(curve), ..body.clone() };
    let problem = TimeProblem { body, inertia: None, relaxation };
    let mut pulls = Vec::new();
    let path = solve_in_time(&problem, params, |done, motion: &Motion, _| {
        let faces = block.nodes().iter().zip(&motion.reaction).filter(|(x, _)| end(x));
        pulls.push((done.step.time, faces.map(|(_, r)| r.x).sum(), done.clone()));
    })
    .unwrap();
    assert_eq!((path.failure, path.cut_back), (None, 0));
    pulls
}

/// Prescribes these elongations on all faces.
fn stretched(block: &Cuboid, by: [f64; 3]) -> Vec<FixedDof> {
    block.constrained(|x, axis| {
        let face = x.iter().any(|c| *c < 1e-9 || *c > SIDE - 1e-9);
        face.then_some(x[axis] * by[axis])
    })
}

/// Constrains the three planes through the origin in their normal directions; `pulled` prescribes the
/// elongation along x.
fn symmetric(block: &Cuboid, pulled: Option<f64>) -> Vec<FixedDof> {
    block.constrained(|x, axis| match pulled {
        Some(by) if axis == 0 && end(x) => Some(by),
        _ => (x[axis] == 0.0).then_some(0.0),
    })
}

#[test]
fn a_stretched_and_held_bar_relaxes_by_the_series() {
    let prony = [Some(series())];
    // Both cases preserve the volume of their strain measure, so the stress is a deviator.
    let small = [0.02, -0.01, -0.01];
    let thin = 1.2f64.powf(-0.5) - 1.0;
    let cases = [
        (Law::LinearElastic(LinearElastic::new(YOUNG, 0.3).unwrap()), small),
        (Law::NeoHookeanIsochoric(NeoHookeanIsochoric::new(YOUNG, 0.45).unwrap()), [0.2, thin, thin]),
    ];
    for (law, by) in cases {
        let laws = [law];
        let stress = laws[0].stress(&shape::Matrix3::from_diagonal(&Vector3::from(by)))[(0, 0)];
        let whole = stress * SIDE * SIDE;
        for kind in [CellKind::Hex8, CellKind::Tet10] {
            let block = cube(kind);
            let groups = fem::element_dilation(&block.mesh, &VolumeRule::STANDARD).unwrap();
            let pressure = fem::pressure_rows(&block.mesh, &VolumeRule::STANDARD, &[]);
            let mut dilations = vec![SolidDilation::Standard, SolidDilation::Groups(&groups)];
            if let Ok(pressure) = &pressure {
                dilations.push(SolidDilation::Mixed(pressure));
            }
            let fixed = stretched(&block, by);
            for dilation in dilations {
                let mut body = block.body(&laws, &fixed);
                body.solid.dilation = dilation;
                let found = pulls(&block, &body, Curve::at_once(), &prony, &params(2.0, 16, 1.0));
                assert_eq!((found[0].0, found.len()), (0.0, 17));
                for (t, force, done) in &found {
                    let exact = whole * series().relaxation(*t);
                    let error = (force - exact).abs() / whole;
                    // Tolerance of Newton's method: 1e-11.
                    assert!(error < 1e-10, "{} {kind:?} {t}: {error:e}", laws[0].name());
                    // Constrained degrees of freedom do no work.
                    let work = done.energy.external / found[0].2.energy.external;
                    assert!((work - 1.0).abs() < 1e-10, "{t}: {work}");
                }
                if !laws[0].is_small_strain() {
                    continue;
                }
                // At a constant rate followed by a constant value, the integral of the series is also exact.
                for (t, force, _) in pulls(&block, &body, Curve::growth(0.5), &prony, &params(2.0, 16, 1.0)) {
                    let integral = |t: f64| -> f64 {
                        let term = |(g, tau): &(f64, f64)| g * tau * -(-t / tau).exp_m1();
                        series().relaxed() * t + series().terms().iter().map(term).sum::<f64>()
                    };
                    let exact = whole / 0.5 * (integral(t) - integral((t - 0.5).max(0.0)));
                    assert!((force - exact).abs() < 1e-10 * whole, "{kind:?} {t}: {force} {exact}");
                }
            }
        }
    }
}

/// For a single term, `eps(t) = sigma (J(t) / 3 + 1 / (9 kappa))` with
/// `J(t) = (1 / g_inf - (1 / g_inf - 1) exp(-g_inf t / tau)) / mu` (Tschoegl, The Phenomenological Theory of
/// Linear Viscoelastic Behavior, 1989, standard solid).
#[test]
fn a_loaded_bar_creeps_with_order_two() {
    let prony = [Some(Prony::new(&[(0.6, 0.4)]).unwrap())];
    let laws = [Law::LinearElastic(LinearElastic::new(YOUNG, 0.4).unwrap())];
    let block = cube(CellKind::Hex8);
    let fixed = symmetric(&block, None);
    let face = block.mesh.group("x-max").unwrap();
    let surface = fem::surface_rows(&block.mesh, face, &fem::SurfaceRule::STANDARD).unwrap();
    let sigma = 200.0;
    let values = vec![Vector3::new(sigma, 0.0, 0.0); surface.weights().len()];
    let loads = [Load::Traction { surface: &surface, values }];
    let body = StaticProblem { loads: &loads, ..block.body(&laws, &fixed) };
    let exact = |t: f64| {
        let shear = (1.0 / 0.4 - (1.0 / 0.4 - 1.0) * (-0.4 * t / 0.4).exp()) / laws[0].mu();
        sigma * (shear / 3.0 + 1.0 / (9.0 * laws[0].bulk()))
    };
    let tip = block.nodes().iter().position(end).unwrap();
    let worst = |steps: usize| {
        let mut worst = 0.0f64;
        let problem = TimeProblem { body: &body, inertia: None, relaxation: &prony };
        let path = solve_in_time(&problem, &params(2.0, steps, 1.0), |done, motion, _| {
            let error = (motion.u[tip].x / SIDE / exact(done.step.time) - 1.0).abs();
            assert!(done.step.time > 0.0 || error < 1e-11, "at once it is elastic: {error:e}");
            worst = worst.max(error);
        })
        .unwrap();
        assert_eq!(path.failure, None);
        worst
    };
    let errors = [worst(20), worst(40), worst(80)];
    for pair in errors.windows(2) {
        assert!(((pair[0] / pair[1]).log2() - 2.0).abs() < 0.1, "{errors:?}");
    }
    assert!(errors[2] < 1e-4, "{errors:?}");
}

/// After a long time, a bar stretched by 30 % behaves like a bar with the shear modulus `g_inf mu` and the
/// same bulk modulus.
#[test]
fn at_the_end_a_bar_is_a_softer_one() {
    let prony = [Some(series())];
    let stiff = NeoHookeanIsochoric::new(YOUNG, 0.45).unwrap();
    let mu = stiff.mu() * series().relaxed();
    let bulk = stiff.bulk();
    let soft = [Law::MooneyRivlin(MooneyRivlin::new(0.5 * mu, 0.0, bulk).unwrap())];
    let laws = [Law::NeoHookeanIsochoric(stiff)];
    let block = cube(CellKind::Tet10);
    let groups = fem::element_dilation(&block.mesh, &VolumeRule::STANDARD).unwrap();
    let pressure = fem::pressure_rows(&block.mesh, &VolumeRule::STANDARD, &[]).unwrap();
    let fixed = symmetric(&block, Some(0.3 * SIDE));
    for dilation in [SolidDilation::Standard, SolidDilation::Groups(&groups), SolidDilation::Mixed(&pressure)]
    {
        let last = |laws: &[Law], relaxation: &[Option<Prony>]| {
            let mut body = block.body(laws, &fixed);
            body.solid.dilation = dilation;
            let found = pulls(&block, &body, Curve::growth(10.0), relaxation, &params(100.0, 100, 1.0));
            // Convergence is quadratic because the tangent is the derivative of the relaxed stress.
            let most = found.iter().map(|f| f.2.step.iterations.len()).max().unwrap();
            assert!(most <= 8, "{most} iterations");
            found.last().unwrap().1
        };
        let found = last(&laws, &prony);
        let exact = last(&soft, &[]);
        assert!((found / exact - 1.0).abs() < 1e-9, "{found} {exact}");
    }
}

/// For laws whose deviator depends on the volume, the tangent is symmetrised and not exact; iterations still
/// converge fast.
#[test]
fn laws_without_a_split_converge() {
    let prony = [Some(series())];
    let block = cube(CellKind::Hex8);
    let groups = fem::element_dilation(&block.mesh, &VolumeRule::STANDARD).unwrap();
    let fixed = symmetric(&block, Some(0.2 * SIDE));
    for law in [
        Law::NeoHookean(NeoHookean::new(YOUNG, 0.3).unwrap()),
        Law::SaintVenantKirchhoff(SaintVenantKirchhoff::new(YOUNG, 0.3).unwrap()),
    ] {
        let laws = [law];
        let last = |dilation| {
            let mut body = block.body(&laws, &fixed);
            body.solid.dilation = dilation;
            let found = pulls(&block, &body, Curve::growth(1.0), &prony, &params(2.0, 10, 1.0));
            let most = found.iter().map(|f| f.2.step.iterations.len()).max().unwrap();
            assert!(most <= 14, "{} iterations", most);
            found.last().unwrap().1
        };
        // The strain is homogeneous, so every projection gives the same result.
        let standard = last(SolidDilation::Standard);
        let groups = last(SolidDilation::Groups(&groups));
        assert!((standard / groups - 1.0).abs() < 1e-9 && standard > 0.0, "{standard} {groups}");
    }
}

/// An element vibrating along z is compared with `u'' = -omega^2 ((1 - s) u + s (g_inf u + h))`,
/// `h' = g u' - h / tau`, where `s` is the share of `4 mu / 3` in the modulus. The reference is integrated by
/// the fourth-order Runge-Kutta method.
#[test]
fn a_relaxing_oscillator_is_damped_with_order_two() {
    let (g, tau) = (0.5, 0.01);
    let prony = [Some(Prony::new(&[(g, tau)]).unwrap())];
    let laws = [Law::LinearElastic(LinearElastic::new(YOUNG, 0.2).unwrap())];
    let block = Cuboid::new(CellKind::Hex8, [SIDE; 3], [1; 3]);
    let fixed = block.constrained(|x, axis| (axis < 2 || x.z == 0.0).then_some(0.0));
    let body = block.body(&laws, &fixed);
    let mass = block.lumped(1000.0);
    let modulus = laws[0].lambda() + 2.0 * laws[0].mu();
    let share = 4.0 / 3.0 * laws[0].mu() / modulus;
    let omega2 = modulus / SIDE / (1000.0 * SIDE / 2.0);
    let velocity = block.field(|x| Vector3::new(0.0, 0.0, if x.z > 0.0 { 0.1 } else { 0.0 }));
    let problem = TimeProblem { relaxation: &prony, ..moving(&body, &mass, &[], &velocity) };
    let top = block.nodes().iter().position(|x| x.z > 0.0).unwrap();
    let duration = 0.03;

    let rate = |y: [f64; 3]| {
        let [u, v, h] = y;
        let stress = (1.0 - share) * u + share * ((1.0 - g) * u + h);
        [v, -omega2 * stress, g * v - h / tau]
    };
    let (mut y, n) = ([0.0, 0.1, 0.0], 20_000);
    let dt = duration / n as f64;
    for _ in 0..n {
        let add = |k: [f64; 3], f: f64| std::array::from_fn(|i| y[i] + f * dt * k[i]);
        let k1 = rate(y);
        let k2 = rate(add(k1, 0.5));
        let k3 = rate(add(k2, 0.5));
        let k4 = rate(add(k3, 1.0));
        y = std::array::from_fn(|i| y[i] + dt / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
    }
    let error = |steps: usize| {
        let path = solve_in_time(&problem, &params(duration, steps, 1.0), |_, _, _| ()).unwrap();
        assert_eq!(path.failure, None);
        let energy = path.steps.last().unwrap().energy;
        assert!(energy.lost().abs() < 1e-10 * energy.start, "{energy:?}");
        assert!(energy.kinetic < 0.9 * energy.start);
        (path.motion.u[top].z - y[0]).abs() / (0.1 / omega2.sqrt())
    };
    let errors = [error(100), error(200), error(400)];
    for pair in errors.windows(2) {
        assert!(((pair[0] / pair[1]).log2() - 2.0).abs() < 0.15, "{errors:?}");
    }
    assert!(errors[2] < 2e-3, "{errors:?}");
}
