//! Free vibrations compared with closed forms: an element, a bar, a free block.

use fem::VolumeRule;
use geometry::CellKind;
use integration::cuboid::{Cuboid, distance};
use material::LinearElastic;
use shape::{FixedDof, Vector3};
use shape::{Rows, Unity};
use statics::{LinearBody, LinearProblem, Mass, Modes, SolveError, TimeError, modes};

const DENSITY: f64 = 1000.0;

fn law(young: f64, poisson: f64) -> [LinearElastic; 1] {
    [LinearElastic::new(young, poisson).unwrap()]
}

fn problem<'a>(block: &'a Cuboid, laws: &'a [LinearElastic], fixed: &'a [FixedDof]) -> LinearProblem<'a> {
    let body = LinearBody {
        nodes: block.nodes(),
        volume: &block.volume,
        materials: laws,
        region: &[],
        dilation: None,
    };
    LinearProblem { body, loads: &[], fixed, constraints: &[], weak: &[] }
}

/// Returns the relative difference between a squared frequency and the nearest computed squared frequency.
fn missed(modes: &Modes, squared: f64) -> f64 {
    modes.squared.iter().map(|s| (s / squared - 1.0).abs()).fold(f64::INFINITY, f64::min)
}

#[test]
fn one_element_on_the_floor() {
    // The top moves along z: `omega^2 = E A / L / (rho A L / 2)` with lumped mass; a linear field has a third
    // of the mass.
    let block = Cuboid::new(CellKind::Hex8, [0.01; 3], [1; 3]);
    let laws = law(20e3, 0.0);
    let fixed = block.constrained(|x, axis| (axis < 2 || x.z == 0.0).then_some(0.0));
    let problem = problem(&block, &laws, &fixed);
    let square = 20e3 / DENSITY / 0.01f64.powi(2);
    for (mass, share) in [(block.lumped(DENSITY), 2.0), (block.consistent(DENSITY), 3.0)] {
        let found = modes(&problem, &mass).unwrap();
        assert_eq!((found.squared.len(), found.shapes.len(), found.massless), (4, 4, 0));
        assert!(missed(&found, share * square) < 1e-13, "{found:?}");
        assert!(found.residual < 1e-12, "{}", found.residual);
    }
}

/// A bar of `n` hex8 without lateral motion, fixed at x = 0. The modes `sin k x` have
/// `omega^2 = 6 c^2 / h^2 (1 - cos kh) / (2 + cos kh)` with consistent mass and `2 c^2 / h^2 (1 - cos kh)`
/// with lumped mass, above and below `c k`.
#[test]
fn a_bar_vibrates_in_its_discrete_modes() {
    let (n, length) = (8, 0.1);
    let bar = Cuboid::new(CellKind::Hex8, [length, 0.01, 0.01], [n, 1, 1]);
    let laws = law(20e3, 0.3);
    let wave = (laws[0].lambda() + 2.0 * laws[0].mu()) / DENSITY;
    // Prescribed values of supports do not affect vibrations.
    let fixed = bar.constrained(|x, axis| (axis > 0 || x.x == 0.0).then_some(1e-3));
    let problem = problem(&bar, &laws, &fixed);
    let consistent = modes(&problem, &bar.consistent(DENSITY)).unwrap();
    let lumped = modes(&problem, &bar.lumped(DENSITY)).unwrap();
    assert_eq!(consistent.squared.len(), 4 * n);
    let h = length / n as f64;
    for number in 1..=n {
        let k = (number as f64 - 0.5) * std::f64::consts::PI / length;
        let cos = (k * h).cos();
        let above = 6.0 * wave / (h * h) * (1.0 - cos) / (2.0 + cos);
        let below = 2.0 * wave / (h * h) * (1.0 - cos);
        assert!(below < wave * k * k && wave * k * k < above);
        assert!(missed(&consistent, above) < 1e-11 && missed(&lumped, below) < 1e-11, "{number}");
    }
    // The first mode is `sin k x` itself, with unit mass and zero at constrained degrees of freedom.
    let k = 0.5 * std::f64::consts::PI / length;
    let sine = bar.field(|x| Vector3::new((k * x.x).sin(), 0.0, 0.0));
    let mass = bar.consistent(DENSITY);
    let inner =
        |a: &[Vector3], b: &[Vector3]| mass.times(a).iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>();
    let first = &consistent.shapes[0];
    assert!((inner(first, first) - 1.0).abs() < 1e-12);
    assert!((inner(first, &sine).powi(2) / inner(&sine, &sine) - 1.0).abs() < 1e-12);
}

#[test]
fn a_free_block_has_six_rigid_modes() {
    for kind in [CellKind::Tet4, CellKind::Tet10, CellKind::Hex8, CellKind::Hex20] {
        let block = Cuboid::new(kind, [0.04, 0.036, 0.03], [2; 3]);
        let laws = law(20e3, 0.45);
        let found = modes(&problem(&block, &laws, &[]), &block.consistent(DENSITY)).unwrap();
        let elastic = found.squared[6];
        let rigid = found.squared.iter().take_while(|s| s.abs() < 1e-9 * elastic).count();
        assert_eq!(rigid, 6, "{kind:?} {:?}", &found.squared[..8]);
        assert!(elastic > 1.0 && found.residual < 1e-9, "{kind:?} {}", found.residual);
    }
}

#[test]
fn units_scale() {
    let squared = |size: f64, young: f64, density: f64| {
        let block = Cuboid::new(CellKind::Tet4, [4.0 * size, 3.6 * size, 3.0 * size], [3; 3]);
        let fixed = block.constrained(|x, _| (x.z == 0.0).then_some(0.0));
        let laws = law(young, 0.3);
        modes(&problem(&block, &laws, &fixed), &block.consistent(density)).unwrap().squared
    };
    let metres = squared(0.01, 20e3, DENSITY);
    // N, mm, t: Pa are 1e-6 MPa, kg/m^3 are 1e-12 t/mm^3, and the second does not change.
    let millimetres = squared(10.0, 20e-3, DENSITY * 1e-12);
    for (a, b) in metres.iter().zip(&millimetres) {
        assert!((a / b - 1.0).abs() < 1e-11, "{a} {b}");
    }
}

/// For masses at points between the nodes, `M = Lambda^T diag(m) Lambda`; `Lambda = 1` gives the lumped mass,
/// bit for bit.
#[test]
fn a_transformed_mass_moves_with_displacements() {
    let rows = |values: [f64; 4]| {
        Rows::new(2, vec![0, 2, 4], vec![0, 1, 0, 1], values.to_vec(), Unity::Within(1e-12))
    };
    let own = rows([1.0, 0.0, 0.0, 1.0]).unwrap();
    let v = [Vector3::new(1.0, 2.0, -3.0), Vector3::new(0.5, -1.0, 4.0)];
    let (plain, kronecker) =
        (Mass::lumped(&[2.0, 3.0]).unwrap(), Mass::transformed(&own, &[2.0, 3.0]).unwrap());
    assert_eq!(plain.times(&v), kronecker.times(&v));
    let mixed = Mass::transformed(&rows([0.75, 0.25, 0.4, 0.6]).unwrap(), &[2.0, 3.0]).unwrap();
    let (d, e) = (v[0] * 0.75 + v[1] * 0.25, v[0] * 0.4 + v[1] * 0.6);
    let expected = [d * 1.5 + e * 1.2, d * 0.5 + e * 1.8];
    assert!(distance(&mixed.times(&v), &expected) < 1e-14);

    let wrong = Mass::transformed(&own, &[2.0, -3.0]).unwrap_err();
    assert_eq!(wrong, TimeError::NodalMass { node: 1, mass: -3.0 });
    let wrong = Mass::transformed(&own, &[2.0]).unwrap_err();
    assert!(wrong.to_string().contains("rows at the nodes: 2 given, 1 needed"), "{wrong}");
}

/// One integration point per element gives hourglass motions neither mass nor stiffness.
#[test]
fn motions_without_mass_are_counted_and_without_frequency_refused() {
    let block = Cuboid::new(CellKind::Hex8, [0.04; 3], [2; 3]);
    let laws = law(20e3, 0.3);
    let coarse = VolumeRule::STANDARD.with(CellKind::Hex8, 1).unwrap();
    let points = fem::volume_rows(&block.mesh, &coarse).unwrap();
    let mass = Mass::consistent(&points, &[DENSITY], &[]).unwrap();
    let found = modes(&problem(&block, &laws, &[]), &mass).unwrap();
    // Eight points with three axes have a rank of 24.
    assert_eq!((found.squared.len(), found.massless), (24, 81 - 24));

    let mut poor = problem(&block, &laws, &[]);
    poor.body.volume = &points;
    let refused = modes(&poor, &mass).unwrap_err();
    assert_eq!(refused, SolveError::NoFrequency);

    let small = Cuboid::new(CellKind::Hex8, [0.04; 3], [1; 3]);
    let refused = modes(&problem(&block, &laws, &[]), &small.lumped(DENSITY)).unwrap_err();
    let expected = SolveError::Length { what: "nodes of the mass", found: 8, expected: 27 };
    assert_eq!(refused, expected);
}
