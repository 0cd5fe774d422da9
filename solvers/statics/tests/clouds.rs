//! Clouds solved by conjugate gradients with multigrid.

#[path = "../benches/common/cloud.rs"]
mod cloud;

use cloud::{Below, CloudCube, Settings};
use material::LinearElastic;
use shape::{Matrix3, Point3, Vector3};
use tissuebench_statics::{LinearProblem, Solution, SolveError, assemble};

fn law(poisson: f64) -> LinearElastic {
    LinearElastic::new(20e3, poisson).unwrap()
}

fn iterated(problem: &LinearProblem) -> Result<Solution, SolveError> {
    let assembled = assemble(problem)?;
    let levels = assembled.multigrid(None)?;
    assembled.iterated(levels, 1e-9)?.solve(1.0)
}

fn count(solution: &Solution) -> usize {
    solution.info.iterations.expect("iterated").count
}

/// Returns the largest difference of displacements at the nodes, relative to the largest displacement.
fn gap(cube: &CloudCube, a: &[Vector3], b: &[Vector3]) -> f64 {
    let [a, b] = [a, b].map(|u| cube.parameters.apply(u));
    let largest = b.iter().map(Vector3::norm).fold(0.0, f64::max);
    a.iter().zip(&b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest
}

#[test]
fn iterations_come_to_what_a_factor_gives() {
    let of = Settings::of(8);
    let all = [
        ("nitsche", of, 90),
        ("penalty of 100", Settings { below: Below::Penalty(100.0), ..of }, 95),
        ("penalty of 10,000", Settings { below: Below::Penalty(1e4), ..of }, 100),
        ("coupling", Settings { below: Below::Coupling, ..of }, 90),
        ("gauss", Settings { gauss: Some(4), ..of }, 70),
        ("layers", Settings { layers: true, ..of }, 105),
        ("random", Settings { random: Some(700), ..of }, 95),
        ("more nodes than vertices", Settings { random: Some(1500), ..of }, 125),
        ("narrow supports", Settings { support_scale: 1.2, ..of }, 60),
        ("shared dilations", Settings { support_scale: 1.2, near: true, ..of }, 70),
    ];
    for (name, settings, most) in all {
        let cube = CloudCube::new(settings);
        for poisson in [0.3, 0.45] {
            // The upper layer is ten times stiffer.
            let materials = [law(poisson), LinearElastic::new(200e3, poisson).unwrap()];
            cube.with(&materials, |problem| {
                let direct = assemble(problem).unwrap().factor().unwrap().solve(1.0).unwrap();
                let solution = iterated(problem).unwrap();
                let off = gap(&cube, &solution.u, &direct.u);
                println!("{name}, nu {poisson}: {} iterations, {off:.1e} off", count(&solution));
                assert!(off < 1e-7, "{name}, nu {poisson}: {off:e} off");
                assert!(
                    (10..=most).contains(&count(&solution)),
                    "{name}, nu {poisson}: {}",
                    count(&solution)
                );
                assert_eq!(solution.info.dofs, direct.info.dofs);
            });
        }
    }
}

#[test]
fn iterations_hardly_grow_with_the_size() {
    for (poisson, most) in [(0.3, 65), (0.45, 95)] {
        let counts = [7, 14, 21].map(|cells| {
            let cube = CloudCube::new(Settings::of(cells));
            cube.with(&[law(poisson)], |problem| count(&iterated(problem).unwrap()))
        });
        println!("nu {poisson}: {counts:?}");
        assert!(5 * counts[2] <= 6 * counts[0] && counts[2] <= most, "nu {poisson}: {counts:?}");
    }
}

/// Sweeps alone take 370 iterations with this penalty.
#[test]
fn a_stiff_penalty_takes_no_more_iterations() {
    let counts = [1e2, 1e4, 1e6].map(|penalty| {
        let cube = CloudCube::new(Settings { below: Below::Penalty(penalty), ..Settings::of(11) });
        cube.with(&[law(0.3)], |problem| count(&iterated(problem).unwrap()))
    });
    assert!(counts[2] <= counts[0] + 15, "{counts:?}");
}

/// The supports move, and an affine field is the exact solution.
#[test]
fn an_exact_solution_is_found() {
    let cube = CloudCube::new(Settings::of(13));
    let material = [law(0.3)];
    let slope = Matrix3::new(0.02, -0.01, 0.004, 0.007, -0.015, 0.011, -0.003, 0.006, 0.01);
    let exact = |x: &Point3| slope * x.coords + Vector3::new(1e-3, -2e-3, 3e-3);
    cube.stretched(&material, slope, exact, |problem| {
        let u = cube.parameters.apply(&iterated(problem).unwrap().u);
        let off = cube.nodes.iter().zip(&u).map(|(x, u)| (exact(x) - u).norm()).fold(0.0, f64::max);
        assert!(off < 1e-7 * slope.norm(), "{off:e} m off");
    });
}

#[test]
fn pressures_serve_coupled_clouds() {
    let of = Settings { support_scale: 1.2, near: true, below: Below::Coupling, ..Settings::of(9) };
    let cube = CloudCube::new(of);
    cube.with(&[law(0.499)], |problem| {
        let direct = assemble(problem).unwrap().factor().unwrap().solve(1.0).unwrap();
        let assembled = assemble(problem).unwrap();
        let levels = assembled.multigrid_with_pressures(None).unwrap();
        let solution = assembled.iterated(levels, 1e-10).unwrap().solve(1.0).unwrap();
        let off = gap(&cube, &solution.u, &direct.u);
        assert!(off < 1e-7 && count(&solution) <= 150, "{} iterations, {off:e} off", count(&solution));
    });
}

/// Iterations find the same smallest factor as a factor does, to a few digits.
#[test]
fn the_needed_factor_of_nitsche_is_found_by_iterations() {
    let cube = CloudCube::new(Settings { gauss: Some(4), ..Settings::of(8) });
    cube.with(&[law(0.3)], |problem| {
        let direct = assemble(problem).unwrap().factor().unwrap();
        let assembled = assemble(problem).unwrap();
        let levels = assembled.multigrid(None).unwrap();
        let iterated = assembled.iterated(levels, 1e-8).unwrap();
        let [exact, found] = [direct, iterated].map(|of| of.needed_nitsche_factor().unwrap().unwrap());
        assert!((found / exact - 1.0).abs() < 0.05, "{found} for {exact}");
    });
}

#[test]
fn the_same_bits_at_any_number_of_threads() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let cube = CloudCube::new(Settings { random: Some(3000), ..Settings::of(13) });
            cube.with(&[law(0.3)], |problem| iterated(problem).unwrap())
        })
    };
    let first = on(1);
    for threads in [2, 3] {
        assert!(first == on(threads), "at {threads} threads");
    }
}
