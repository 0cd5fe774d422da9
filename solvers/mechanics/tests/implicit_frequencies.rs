//! Implicit dynamics against closed forms: one degree of freedom, a bar, a cantilever.

mod implicit_common;

use geometry::CellKind;
use implicit_common::{Cuboid, moving, params};
use mechanics::{Inertia, Law, LinearElastic, Ramp, Ramps, TimeProblem, Vector3, solve_in_time};
use nalgebra::{Matrix3 as State, Vector3 as OneState};

const DENSITY: f64 = 1000.0;

fn linear(young: f64, poisson: f64) -> [Law; 1] {
    [Law::Linear(LinearElastic::new(young, poisson).unwrap())]
}

/// One hex8 of side 1 cm on a rigid floor, moved along z only: `omega^2 = E A / L / (rho A L / 2)`. Displacements of
/// its top at every step, from `u = 1 mm`, `v = 2 cm/s`, and its `omega`.
fn oscillator(rho_inf: f64, damping: f64, omega_dt: f64, steps: usize) -> (Vec<f64>, f64) {
    let block = Cuboid::new(CellKind::Hex8, [0.01; 3], [1; 3]);
    let laws = linear(20e3, 0.0);
    let omega = (20e3 / 0.01 / (DENSITY * 0.01 / 2.0_f64)).sqrt();
    let fixed = block.held(|x, axis| (axis < 2 || x.z == 0.0).then_some(0.0));
    let body = block.body(&laws, &fixed);
    let mass = block.lumped(DENSITY);
    let up = |value: f64| block.field(|x| Vector3::new(0.0, 0.0, if x.z > 0.0 { value } else { 0.0 }));
    let (displacement, velocity) = (up(1e-3), up(0.02));
    let inertia = Inertia { mass: &mass, damping, displacement: &displacement, velocity: &velocity };
    let problem =
        TimeProblem { body: &body, ramps: Ramps::all(Ramp::AtOnce), inertia: Some(inertia), relaxation: &[] };
    let top = block.nodes().iter().position(|x| x.z > 0.0).unwrap();
    let mut path = Vec::new();
    let params = params(omega_dt / omega * steps as f64, steps, rho_inf);
    let solved = solve_in_time(&problem, &params, |_, motion, _| path.push(motion.u[top].z)).unwrap();
    assert!(solved.failure.is_none(), "{:?}", solved.failure);
    (path, omega)
}

/// Amplification of (u, dt v, dt^2 a), from the three equations of Chung and Hulbert as they stand, with
/// `w = omega dt` and `c = damping dt`.
fn amplification(rho: f64, w: f64, c: f64) -> State<f64> {
    let (am, af) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
    let gamma = 0.5 - am + af;
    let beta = 0.25 * (1.0 - am + af) * (1.0 - am + af);
    let new = State::new(1.0, 0.0, -beta, 0.0, 1.0, -gamma, (1.0 - af) * w * w, (1.0 - af) * c, 1.0 - am);
    let old = State::new(1.0, 1.0, 0.5 - beta, 0.0, 1.0, 1.0 - gamma, -af * w * w, -af * c, -am);
    new.try_inverse().unwrap() * old
}

#[test]
fn one_degree_of_freedom_is_amplified_as_published() {
    for rho in [1.0, 0.8, 0.3, 0.0] {
        for (w, ratio) in [(0.1, 0.0), (1.0, 0.4), (30.0, 0.0)] {
            let omega = 20e3f64.sqrt() * (2.0f64 / 0.01 / DENSITY / 0.01).sqrt();
            let (path, found) = oscillator(rho, ratio * omega, w, 50);
            assert!((omega / found - 1.0).abs() < 1e-14);
            let dt = w / omega;
            let c = ratio * omega;
            let start_a = -omega * omega * 1e-3 - c * 0.02;
            let mut state = OneState::new(1e-3, dt * 0.02, dt * dt * start_a);
            let size = (1e-3f64).hypot(0.02 / omega) * (1.0 + w);
            for u in path {
                state = amplification(rho, w, c * dt) * state;
                assert!((u - state[0]).abs() < 1e-11 * size, "{rho} {w}: {u} {}", state[0]);
            }
        }
        // All three roots go to -rho at infinite frequency; their product is better conditioned than they are.
        let product = amplification(rho, 1e5, 0.0).determinant();
        assert!((product + rho.powi(3)).abs() < 1e-8, "{rho}: {product}");
    }
}

#[test]
fn one_degree_of_freedom_converges_with_order_two() {
    for rho in [1.0, 0.8, 0.3, 0.0] {
        let error = |steps: usize| {
            let turns = 2.5;
            let (path, omega) = oscillator(rho, 0.0, turns / steps as f64, steps);
            (path[steps - 1] - (1e-3 * turns.cos() + 0.02 / omega * turns.sin())).abs() / 1e-3
        };
        let errors = [error(40), error(80), error(160)];
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((order - 2.0).abs() < 0.1, "{rho}: {errors:?}");
        }
        assert!(errors[2] < 1e-3, "{rho}: {errors:?}");
    }
}

/// A bar without lateral motion, fixed at x = 0: the mode `sin k x` of `n` hex8 with consistent mass has
/// `omega^2 = 6 c^2 / h^2 (1 - cos kh) / (2 + cos kh)`, and the trapezoidal rule turns it by `2 atan(omega dt / 2)` a step.
#[test]
fn a_bar_vibrates_in_its_discrete_mode() {
    let (n, length) = (8, 0.1);
    let bar = Cuboid::new(CellKind::Hex8, [length, 0.01, 0.01], [n, 1, 1]);
    let laws = linear(20e3, 0.3);
    let Law::Linear(law) = &laws[0] else { unreachable!() };
    let wave = (law.lambda() + 2.0 * law.mu()) / DENSITY;
    let h = length / n as f64;
    let k = 0.5 * std::f64::consts::PI / length;
    let omega = (6.0 * wave / (h * h) * (1.0 - (k * h).cos()) / (2.0 + (k * h).cos())).sqrt();
    let exact = k * wave.sqrt();
    assert!((omega / exact - 1.0 - (k * h).powi(2) / 24.0).abs() < 1e-4);

    let fixed = bar.held(|x, axis| (axis > 0 || x.x == 0.0).then_some(0.0));
    let body = bar.body(&laws, &fixed);
    let mass = bar.consistent(DENSITY);
    let mode = bar.field(|x| Vector3::new(1e-3 * (k * x.x).sin(), 0.0, 0.0));
    let problem = moving(&body, &mass, &mode, &[]);
    let dt = 0.1 / omega;
    let turn = 2.0 * (0.5 * omega * dt).atan();
    let mut step = 0;
    let path = solve_in_time(&problem, &params(40.0 * dt, 40, 1.0), |_, motion, _| {
        step += 1;
        let cos = (step as f64 * turn).cos();
        let exact: Vec<_> = mode.iter().map(|u| u * cos).collect();
        let error = implicit_common::distance(&motion.u, &exact);
        assert!(error < 1e-11 * 1e-3, "{step}: {error:e}");
    })
    .unwrap();
    assert_eq!((step, path.cut_back, path.failure), (40, 0, None));
}

/// First bending frequency of a cantilever, from the zeros of its end's motion; the trapezoidal rule's own error is
/// taken out by `omega = 2 / dt tan(omega_h dt / 2)`.
fn cantilever(kind: CellKind, cells: usize) -> f64 {
    let (length, side) = (0.2, 0.01);
    let beam = Cuboid::new(kind, [length, side, side], [cells, 1, 1]);
    let laws = linear(20e3, 0.0);
    let fixed = beam.held(|x, _| (x.x == 0.0).then_some(0.0));
    let body = beam.body(&laws, &fixed);
    let mass = beam.consistent(DENSITY);
    // Euler and Bernoulli's mode as velocity at the start.
    let b = ROOT / length;
    let s = (ROOT.cosh() + ROOT.cos()) / (ROOT.sinh() + ROOT.sin());
    let mode = beam.field(|x| {
        let z = b * x.x;
        Vector3::new(0.0, 1e-3 * (z.cosh() - z.cos() - s * (z.sinh() - z.sin())), 0.0)
    });
    let problem = moving(&body, &mass, &[], &mode);
    let dt = 2.0 * std::f64::consts::PI / bernoulli() / 60.0;
    let end = beam.nodes().iter().position(|x| x.x == length && x.y == 0.0 && x.z == 0.0).unwrap();
    let mut heights = vec![0.0];
    solve_in_time(&problem, &params(100.0 * dt, 100, 1.0), |_, motion, _| heights.push(motion.u[end].y))
        .unwrap();
    let zeros: Vec<f64> = (1..heights.len() - 1)
        .filter(|&n| heights[n] * heights[n + 1] < 0.0)
        .map(|n| n as f64 + heights[n] / (heights[n] - heights[n + 1]))
        .collect();
    assert_eq!(zeros.len(), 3, "{zeros:?}");
    2.0 / dt * (0.5 * std::f64::consts::PI / (zeros[2] / 3.0)).tan()
}

/// First root of `cos x cosh x = -1`.
const ROOT: f64 = 1.875_104_068_711_961;

/// Of a square section: `ROOT^2 / L^2 sqrt(E I / (rho A))`.
fn bernoulli() -> f64 {
    (ROOT / 0.2f64).powi(2) * (20e3 * 0.01f64.powi(2) / 12.0 / DENSITY).sqrt()
}

/// Timoshenko's beam, shear factor 5/6: the root of the determinant of the boundary conditions (Huang, J. Appl. Mech.
/// 28 (1961) 579-584) near Euler and Bernoulli's.
fn timoshenko() -> f64 {
    let slender = 0.01f64.powi(2) / 12.0 / 0.2f64.powi(2);
    let shear = slender * 2.0 / (5.0 / 6.0);
    let equation = |b: f64| {
        let root = ((slender - shear).powi(2) + 4.0 / (b * b)).sqrt();
        let (alpha, beta) =
            ((0.5 * (root - slender - shear)).sqrt(), (0.5 * (root + slender + shear)).sqrt());
        let sum = b * b * (slender - shear).powi(2) + 2.0;
        let both = b * (slender + shear) / (1.0 - b * b * slender * shear).sqrt();
        2.0 + sum * (b * alpha).cosh() * (b * beta).cos() - both * (b * alpha).sinh() * (b * beta).sin()
    };
    let (mut low, mut high) = (0.9 * ROOT * ROOT, 1.1 * ROOT * ROOT);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if equation(low) * equation(middle) <= 0.0 { high = middle } else { low = middle }
    }
    bernoulli() * 0.5 * (low + high) / (ROOT * ROOT)
}

#[test]
fn a_slender_cantilever_has_timoshenkos_frequency() {
    let exact = timoshenko();
    assert!(exact < bernoulli() && exact > 0.99 * bernoulli());
    for (kind, coarse, fine) in [(CellKind::Hex20, 3, 6), (CellKind::Tet10, 5, 10)] {
        let errors = [cantilever(kind, coarse), cantilever(kind, fine)].map(|w| w / exact - 1.0);
        assert!(errors[1].abs() < 0.01 && errors[1].abs() < 0.6 * errors[0].abs(), "{kind:?}: {errors:?}");
    }
}
