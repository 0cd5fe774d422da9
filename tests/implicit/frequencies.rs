//! Implicit dynamics compared with closed forms: a single degree of freedom, and a bar.

use geometry::CellKind;
use integration::cuboid::{Cuboid, distance, moving, params};
use material::{Law, LinearElastic};
use nalgebra::{Matrix3 as State, Vector3 as OneState};
use shape::Vector3;
use statics::{Inertia, TimeParams, TimeProblem, solve_in_time};

const DENSITY: f64 = 1000.0;

fn linear(young: f64, poisson: f64) -> [Law; 1] {
    [Law::LinearElastic(LinearElastic::new(young, poisson).unwrap())]
}

/// A hex8 of side 1 cm on a rigid floor, moved along z only: `omega^2 = E A / L / (rho A L / 2)`. Returns the
/// displacements of its top at every step, from `u = 1 mm`, `v = 2 cm/s`, and its `omega`.
fn oscillator(
    rho_inf: f64,
    alpha: Option<f64>,
    damping: f64,
    omega_dt: f64,
    steps: usize,
) -> (Vec<f64>, f64) {
    let block = Cuboid::new(CellKind::Hex8, [0.01; 3], [1; 3]);
    let laws = linear(20e3, 0.0);
    let omega = (20e3 / 0.01 / (DENSITY * 0.01 / 2.0_f64)).sqrt();
    let fixed = block.constrained(|x, axis| (axis < 2 || x.z == 0.0).then_some(0.0));
    let body = block.body(&laws, &fixed);
    let mass = block.lumped(DENSITY);
    let up = |value: f64| block.field(|x| Vector3::new(0.0, 0.0, if x.z > 0.0 { value } else { 0.0 }));
    let displacement = up(1e-3);
    let velocity = up(0.02);
    let inertia = Inertia {
        mass: &mass,
        damping,
        stiffness_damping: 0.0,
        displacement: &displacement,
        velocity: &velocity,
    };
    let problem = TimeProblem { body: &body, inertia: Some(inertia), relaxation: &[] };
    let top = block.nodes().iter().position(|x| x.z > 0.0).unwrap();
    let mut path = Vec::new();
    let params = TimeParams { alpha, ..params(omega_dt / omega * steps as f64, steps, rho_inf) };
    let solved = solve_in_time(&problem, &params, |_, motion, _| path.push(motion.u[top].z)).unwrap();
    assert!(solved.failure.is_none(), "{:?}", solved.failure);
    (path, omega)
}

/// Schemes by their spectral radius, or by the alpha of Hilber, Hughes and Taylor.
const SCHEMES: [(f64, Option<f64>); 7] = [
    (1.0, None),
    (0.8, None),
    (0.3, None),
    (0.0, None),
    (0.8, Some(0.0)),
    (0.8, Some(-0.05)),
    (0.8, Some(-1.0 / 3.0)),
];

/// Returns the amplification matrix of (u, dt v, dt^2 a) from the three equations of Chung and Hulbert, with
/// `w = omega dt` and `c = damping dt`. The alpha method is theirs without a mean of the inertia.
fn amplification((rho, alpha): (f64, Option<f64>), w: f64, c: f64) -> State<f64> {
    let (am, af) = match alpha {
        Some(alpha) => (0.0, -alpha),
        None => ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)),
    };
    let gamma = 0.5 - am + af;
    let beta = 0.25 * (1.0 - am + af) * (1.0 - am + af);
    let new = State::new(1.0, 0.0, -beta, 0.0, 1.0, -gamma, (1.0 - af) * w * w, (1.0 - af) * c, 1.0 - am);
    let old = State::new(1.0, 1.0, 0.5 - beta, 0.0, 1.0, 1.0 - gamma, -af * w * w, -af * c, -am);
    new.try_inverse().unwrap() * old
}

#[test]
fn one_degree_of_freedom_is_amplified_as_published() {
    for (rho, alpha) in SCHEMES {
        for (w, ratio) in [(0.1, 0.0), (1.0, 0.4), (30.0, 0.0)] {
            let omega = 20e3f64.sqrt() * (2.0f64 / 0.01 / DENSITY / 0.01).sqrt();
            let (path, found) = oscillator(rho, alpha, ratio * omega, w, 50);
            assert!((omega / found - 1.0).abs() < 1e-14);
            let dt = w / omega;
            let c = ratio * omega;
            let start_a = -omega * omega * 1e-3 - c * 0.02;
            let mut state = OneState::new(1e-3, dt * 0.02, dt * dt * start_a);
            let size = (1e-3f64).hypot(0.02 / omega) * (1.0 + w);
            for u in path {
                state = amplification((rho, alpha), w, c * dt) * state;
                assert!((u - state[0]).abs() < 1e-11 * size, "{rho} {alpha:?} {w}: {u} {}", state[0]);
            }
        }
        // All three roots tend to -rho at infinite frequency; their product is better conditioned than the
        // roots.
        let product = amplification((rho, alpha), 1e5, 0.0).determinant();
        assert!(alpha.is_some() || (product + rho.powi(3)).abs() < 1e-8, "{rho}: {product}");
    }
}

#[test]
fn one_degree_of_freedom_converges_with_order_two() {
    for (rho, alpha) in SCHEMES {
        let error = |steps: usize| {
            let turns = 2.5;
            let (path, omega) = oscillator(rho, alpha, 0.0, turns / steps as f64, steps);
            (path[steps - 1] - (1e-3 * turns.cos() + 0.02 / omega * turns.sin())).abs() / 1e-3
        };
        let errors = [error(40), error(80), error(160)];
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((order - 2.0).abs() < 0.1, "{rho} {alpha:?}: {errors:?}");
        }
        assert!(errors[2] < 1e-3, "{rho} {alpha:?}: {errors:?}");
    }
}

/// A bar without lateral motion, fixed at x = 0. The mode `sin k x` of `n` hex8 with consistent mass has
/// `omega^2 = 6 c^2 / h^2 (1 - cos kh) / (2 + cos kh)`, and the trapezoidal rule advances its phase by
/// `2 atan(omega dt / 2)` per step.
#[test]
fn a_bar_vibrates_in_its_discrete_mode() {
    let (n, length) = (8, 0.1);
    let bar = Cuboid::new(CellKind::Hex8, [length, 0.01, 0.01], [n, 1, 1]);
    let laws = linear(20e3, 0.3);
    let Law::LinearElastic(law) = &laws[0] else { unreachable!() };
    let wave = (law.lambda() + 2.0 * law.mu()) / DENSITY;
    let h = length / n as f64;
    let k = 0.5 * std::f64::consts::PI / length;
    let omega = (6.0 * wave / (h * h) * (1.0 - (k * h).cos()) / (2.0 + (k * h).cos())).sqrt();
    let exact = k * wave.sqrt();
    assert!((omega / exact - 1.0 - (k * h).powi(2) / 24.0).abs() < 1e-4);

    let fixed = bar.constrained(|x, axis| (axis > 0 || x.x == 0.0).then_some(0.0));
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
        let error = distance(&motion.u, &exact);
        assert!(error < 1e-11 * 1e-3, "{step}: {error:e}");
    })
    .unwrap();
    assert_eq!((step, path.cut_back, path.failure), (40, 0, None));
}
