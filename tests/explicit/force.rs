//! Internal forces: every lane path against the plain loop, the plain loop against its energy, and
//! independence of the number of threads.

use explicit::{ExplicitBody, ExplicitError, InternalForce, Precision};
use geometry::CellKind;
use geometry::generate::box_mesh;
use integration::block::{Block, gradient};
use lanes::LanePath;
use material::{Guccione, Law, Material as _, NeoHookean, VolumetricForm};
use shape::{DilationGroups, HourglassModulus, Matrix3, Point3, Vector3};

/// Laws of two regions of different stiffness, mixed point by point.
fn laws() -> [Law; 2] {
    [(20e3, 0.495), (35e3, 0.3)]
        .map(|(young, poisson)| Law::NeoHookean(NeoHookean::new(young, poisson).unwrap()))
}

/// Returns all other laws, in pairs as in [`laws`], and one with other volumetric energies.
fn other_laws() -> Vec<[Law; 2]> {
    let [soft, stiff] =
        [(20e3, 0.495), (35e3, 0.3)].map(|(young, poisson)| Law::all(young, poisson).unwrap());
    let pairs = soft.into_iter().zip(stiff).map(|(soft, stiff)| [soft, stiff]);
    let mut pairs: Vec<[Law; 2]> = pairs.filter(|[law, _]| !matches!(law, Law::NeoHookean(_))).collect();
    let mooney = pairs.iter().find(|[law, _]| law.name() == "mooney-rivlin").unwrap().clone();
    for form in [VolumetricForm::Logarithmic, VolumetricForm::SimoTaylor] {
        pairs.push(mooney.clone().map(|law| law.with_volumetric(form).unwrap()));
    }
    pairs
}

/// Whether no kernel shares dilations between points of this law.
fn is_whole(law: &Law) -> bool {
    law.split().is_none_or(|(_, volume)| volume.form == VolumetricForm::SimoTaylor)
}

fn regions(block: &Block) -> Vec<u16> {
    (0..block.volume.weights().len()).map(|q| u16::from(q % 5 > 2)).collect()
}

/// Returns a bent, twisted and stretched state with strains of about 0.2, times `amount`.
fn deformed(block: &Block, amount: f64) -> Vec<Vector3> {
    let field = |x: &Point3| {
        let wave = Vector3::new((150.0 * x.y).sin(), (120.0 * x.z).cos(), (180.0 * x.x).sin()) * 1e-3;
        (gradient() * 5.0 * x.coords + wave) * amount
    };
    block.mesh.points().iter().map(field).collect()
}

fn largest(f: &[Vector3]) -> f64 {
    f.iter().map(|f| f.amax()).fold(0.0, f64::max)
}

fn difference(a: &[Vector3], b: &[Vector3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max) / largest(b)
}

fn forces(force: &mut InternalForce, u: &[Vector3]) -> Vec<Vector3> {
    let mut f = vec![Vector3::repeat(f64::NAN); u.len()];
    force.evaluate(u, &mut f).unwrap();
    f
}

fn paths_agree(block: &Block, groups: Option<&DilationGroups>, kernel: &str) {
    paths_agree_by(block, groups, kernel, &|q| u16::from(q % 5 > 2));
}

fn paths_agree_by(
    block: &Block,
    groups: Option<&DilationGroups>,
    kernel: &str,
    region: &dyn Fn(usize) -> u16,
) {
    paths_agree_of(&laws(), block, groups, kernel, region);
    for laws in other_laws() {
        let whole = is_whole(&laws[0]);
        let kernel = if groups.is_some() && whole { "plain" } else { kernel };
        paths_agree_of(&laws, block, groups, kernel, region);
        if kernel != "plain" {
            // Paired with a neo-Hookean region, at whose border groups contain points of both laws.
            let [first, _] = laws;
            let [_, second] = self::laws();
            paths_agree_of(&[first, second], block, groups, kernel, region);
        }
    }
}

/// Compares all paths on a table with the plain loop, at large strain and at 1e-6 of it.
fn paths_agree_of(
    laws: &[Law],
    block: &Block,
    groups: Option<&DilationGroups>,
    kernel: &str,
    region: &dyn Fn(usize) -> u16,
) {
    let region: Vec<u16> = (0..block.volume.weights().len()).map(region).collect();
    let body = ExplicitBody { volume: &block.volume, laws, region: &region, axes: &[], groups };
    for amount in [1.0, 0.3, 1e-6] {
        let u = deformed(block, amount);
        let expected = forces(&mut InternalForce::plain(body).unwrap(), &u);
        assert!(largest(&expected) > 1e-9);
        for path in LanePath::available() {
            let mut force = InternalForce::new(body, path).unwrap();
            assert_eq!(force.info().kernel.name(), kernel);
            // Sums of about 20 terms of mixed sign; the volumetric part is 50 times the rest at nu = 0.495.
            let tolerance = 1e-13;
            let error = difference(&forces(&mut force, &u), &expected);
            let law = laws[0].name();
            assert!(error < tolerance, "{law}, {kernel}, {}, {amount}: {error:e}", path.name());
        }
    }
}

#[test]
fn tet4_lanes_agree_with_the_plain_loop() {
    paths_agree(&Block::new(CellKind::Tet4, [5, 4, 3]), None, "tet4");
}

#[test]
fn hexahedra_agree_with_the_plain_loop() {
    let block = Block::new(CellKind::Hex8, [5, 4, 3]);
    // One law per element.
    let element = |q: usize| q / 8;
    paths_agree_by(&block, None, "hex8", &|q| u16::from(element(q) % 5 > 2));
    let groups = fem::element_dilation(&block.mesh, &fem::VolumeRule::STANDARD).unwrap();
    paths_agree_by(&block, Some(&groups), "hex8 mean dilation", &|q| u16::from(element(q) % 5 > 2));
    // Laws that change within an element are evaluated point by point.
    paths_agree(&block, None, "rows");
}

#[test]
fn rows_of_other_lengths_agree_with_the_plain_loop() {
    paths_agree(&ragged(), None, "rows");
    paths_agree(&Block::new(CellKind::Wedge15, [3, 3, 2]), None, "rows");
}

#[test]
fn quadratic_cells_agree_with_the_plain_loop() {
    let reduced = fem::VolumeRule::reduced();
    for (kind, rule, name) in [
        (CellKind::Tet10, fem::VolumeRule::STANDARD, "tet10"),
        (CellKind::Hex20, fem::VolumeRule::STANDARD, "hex20"),
        (CellKind::Hex20, reduced, "hex20"),
    ] {
        let mut block = Block::new(kind, [3, 3, 2]);
        block.volume = fem::volume_rows(&block.mesh, &rule).unwrap();
        let points = rule.points(kind);
        let region = |q: usize| u16::from(q / points % 5 > 2);
        paths_agree_by(&block, None, name, &region);
        let groups = fem::element_dilation(&block.mesh, &rule).unwrap();
        paths_agree_by(&block, Some(&groups), &format!("{name} mean dilation"), &region);
        // Laws that change within an element are evaluated point by point.
        paths_agree(&block, None, "rows");
    }
}

/// Returns hexahedra with one point and hourglass control.
fn one_point(cells: [usize; 3]) -> Block {
    let mut block = Block::new(CellKind::Hex8, cells);
    block.volume = fem::uniform_rows(&block.mesh, 0.05, HourglassModulus::PWave).unwrap();
    block
}

#[test]
fn hexahedra_with_one_point_agree_with_the_plain_loop() {
    paths_agree(&one_point([5, 4, 3]), None, "hex8 one point");
    // A law that depends on directions has no lane kernel: the plain loop has the patterns too.
    let block = one_point([3, 2, 2]);
    let axes = vec![Matrix3::identity(); block.volume.weights().len()];
    let guccione = Guccione::new(2e3, [8.0, 2.0, 4.0], 100e3).unwrap();
    let laws = [Law::Guccione(guccione)];
    let body = ExplicitBody { volume: &block.volume, laws: &laws, region: &[], axes: &axes, groups: None };
    let mut force = InternalForce::new(body, LanePath::best()).unwrap();
    assert_eq!(force.info().kernel.name(), "plain");
    assert!(gradient_error(&mut force, &deformed(&block, 0.3)) < 1e-6);
}

/// The first cell is the reference of all others: a flat cell in a turned body costs no digits.
#[test]
fn a_flat_first_cell_serves_as_reference() {
    for (kind, kernel) in [(CellKind::Tet10, "tet10"), (CellKind::Hex20, "hex20")] {
        let max = Point3::new(0.05, 0.04, 0.02);
        let cells = box_mesh(kind, Point3::origin(), max, [3, 3, 2], [1.0, 1.0, 10.0], None);
        let turn = Matrix3::new(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
        let mut block = Block::new(kind, [1; 3]);
        block.mesh = cells.unwrap().moved(|x| turn * x).unwrap();
        block.volume = fem::volume_rows(&block.mesh, &fem::VolumeRule::STANDARD).unwrap();
        paths_agree_of(&laws(), &block, None, kernel, &|_| 0);
    }
}

/// Rows of various lengths, as in a meshless cloud: the points of a tet4 mesh have averaged rows of up to
/// seven points, so linear fields stay exact.
fn ragged() -> Block {
    let mut block = Block::new(CellKind::Tet4, [5, 4, 3]);
    let (volume, n) = (&block.volume, block.volume.weights().len());
    let (mut offsets, mut nodes, mut values, mut grads) = (vec![0], Vec::new(), Vec::new(), Vec::new());
    for q in 0..n {
        let seen = 1 + q % 7;
        for k in 0..seen {
            let other = (q + k) % n;
            nodes.extend(volume.row(other).0);
            values.extend(volume.rows().row(other).1.iter().map(|v| v / seen as f64));
            grads.extend(volume.row(other).1.iter().map(|g| g / seen as f64));
        }
        // Every second row has an odd length: its last node occurs twice.
        if q % 2 == 0 {
            let (value, grad) = (values.pop().unwrap(), grads.pop().unwrap());
            nodes.push(*nodes.last().unwrap());
            values.extend([0.3 * value, 0.7 * value]);
            grads.extend([grad * 0.3, grad * 0.7]);
        }
        offsets.push(nodes.len());
    }
    let count = block.mesh.points().len();
    let rows = shape::Rows::new(count, offsets, nodes, values, shape::Unity::Within(1e-12)).unwrap();
    assert_eq!(rows.uniform_len(), None);
    let at = shape::GradRows::new(volume.points().to_vec(), rows, grads).unwrap();
    block.volume = shape::VolumeRows::new(at, volume.weights().to_vec()).unwrap();
    block
}

#[test]
fn nodal_dilation_lanes_agree_with_the_plain_loop() {
    let block = Block::new(CellKind::Tet4, [5, 4, 3]);
    let groups = DilationGroups::nodal(&block.volume).unwrap();
    paths_agree(&block, Some(&groups), "tet4 nodal dilation");
    // Groups that end at the border of two parts, and chunks of points with a single part.
    let cut = groups.by_part(&regions(&block), block.volume.weights()).unwrap();
    assert!(cut.len() > groups.len());
    paths_agree(&block, Some(&cut), "tet4 nodal dilation");
}

/// Single precision at large strain and at 1e-6 of it, far from the origin and on the way to an inversion.
#[test]
fn single_precision_is_known_to_six_digits() {
    let mut all = vec![laws()];
    all.extend(other_laws());
    let reduced = fem::VolumeRule::reduced();
    let standard = fem::VolumeRule::STANDARD;
    for (kind, rule, cells) in [
        (CellKind::Tet4, standard, [6, 5, 4]),
        (CellKind::Hex8, standard, [6, 5, 4]),
        (CellKind::Hex8, reduced, [6, 5, 4]),
        (CellKind::Tet10, standard, [3, 3, 2]),
        (CellKind::Hex20, standard, [3, 3, 2]),
        (CellKind::Hex20, reduced, [3, 3, 2]),
    ] {
        let mut block = Block::new(kind, cells);
        let controlled = kind == CellKind::Hex8 && rule == reduced;
        block.volume = match controlled {
            true => fem::uniform_rows(&block.mesh, 0.05, HourglassModulus::PWave).unwrap(),
            false => fem::volume_rows(&block.mesh, &rule).unwrap(),
        };
        let groups = match kind {
            CellKind::Tet4 => DilationGroups::nodal(&block.volume).unwrap(),
            _ => fem::element_dilation(&block.mesh, &rule).unwrap(),
        };
        for (laws, groups) in all.iter().flat_map(|laws| [(laws, None), (laws, Some(&groups))]) {
            let whole = is_whole(&laws[0]) && !matches!(laws[0], Law::NeoHookean(_));
            if groups.is_some() && (whole || controlled) {
                continue;
            }
            let body = ExplicitBody { volume: &block.volume, laws, region: &[], axes: &[], groups };
            for amount in [1.0, 0.3, 1e-6] {
                let mut u = deformed(&block, amount);
                u.iter_mut().for_each(|u| *u += Vector3::new(100.0, -30.0, 7.0) * 1e-2);
                let expected = forces(&mut InternalForce::plain(body).unwrap(), &u);
                for path in LanePath::available() {
                    let mut force = InternalForce::of_precision(body, path, Precision::Single).unwrap();
                    let (law, path) = (laws[0].name(), path.name());
                    let error = difference(&forces(&mut force, &u), &expected);
                    assert!(error < 1e-4, "{law}, {kind:?}, {path}, {amount}: {error:e}");
                    assert!(error > 1e-9, "in double precision: {law}, {kind:?}, {path}: {error:e}");
                    assert_eq!(force.rounding(&u).unwrap(), error);
                }
            }
        }
    }
}

#[test]
fn single_precision_has_the_same_bits_on_all_threads_and_no_kernel_for_rows() {
    let block = Block::new(CellKind::Tet4, [12, 9, 9]);
    let laws = laws();
    let body = ExplicitBody { volume: &block.volume, laws: &laws, region: &[], axes: &[], groups: None };
    let u = deformed(&block, 0.5);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut force = InternalForce::of_precision(body, LanePath::best(), Precision::Single).unwrap();
        pool.install(|| forces(&mut force, &u))
    };
    assert_eq!(run(1), run(3));
    let ragged = ragged();
    let body = ExplicitBody { volume: &ragged.volume, ..body };
    let refused = InternalForce::of_precision(body, LanePath::best(), Precision::Single).err();
    assert_eq!(refused, Some(ExplicitError::NoSinglePrecision));
}

#[test]
fn plain_forces_are_the_gradient_of_the_energy() {
    let block = Block::new(CellKind::Tet4, [2, 2, 1]);
    let laws = laws();
    let region = regions(&block);
    let nodal = DilationGroups::nodal(&block.volume).unwrap();
    for groups in [None, Some(&nodal)] {
        let body = ExplicitBody { volume: &block.volume, laws: &laws, region: &region, axes: &[], groups };
        let mut force = InternalForce::plain(body).unwrap();
        assert!(gradient_error(&mut force, &deformed(&block, 1.0)) < 1e-6);
    }
    let block = one_point([2, 2, 1]);
    let region = regions(&block);
    let body = ExplicitBody { volume: &block.volume, laws: &laws, region: &region, axes: &[], groups: None };
    assert!(gradient_error(&mut InternalForce::plain(body).unwrap(), &deformed(&block, 1.0)) < 1e-6);
}

/// Returns the largest difference of the forces from central differences of the energy, relative to the
/// largest force. The errors step^2 times curvature and 1e-16 E / step from rounding are both about 1e-8.
fn gradient_error(force: &mut InternalForce, u: &[Vector3]) -> f64 {
    let f = forces(force, u);
    let step = 1e-7;
    let mut error = 0.0f64;
    for node in 0..u.len() {
        for axis in 0..3 {
            let at = |sign: f64| {
                let mut moved = u.to_vec();
                moved[node][axis] += sign * step;
                force.energy(&moved).unwrap()
            };
            let slope = (at(1.0) - at(-1.0)) / (2.0 * step);
            error = error.max((slope - f[node][axis]).abs());
        }
    }
    error / largest(&f)
}

/// Tables of several chunks, whose border nodes are summed from copies.
#[test]
fn bits_do_not_depend_on_threads() {
    let block = |kind, cells| Block::new(kind, cells);
    let tet4 = block(CellKind::Tet4, [12, 9, 9]);
    let hex8 = block(CellKind::Hex8, [12, 11, 9]);
    let one_point = one_point([12, 11, 9]);
    let tet10 = block(CellKind::Tet10, [9, 9, 6]);
    let ragged = ragged();
    let nodal = DilationGroups::nodal(&tet4.volume).unwrap();
    let mean = fem::element_dilation(&hex8.mesh, &fem::VolumeRule::STANDARD).unwrap();
    let mut all = vec![laws()];
    all.extend(other_laws());
    let tables = [
        (&tet4, None, "tet4"),
        (&tet4, Some(&nodal), "tet4 nodal dilation"),
        (&hex8, None, "hex8"),
        (&hex8, Some(&mean), "hex8 mean dilation"),
        (&one_point, None, "hex8 one point"),
        (&tet10, None, "tet10"),
        (&ragged, None, "rows"),
    ];
    for ((block, groups, kernel), laws) in tables.into_iter().flat_map(|t| all.iter().map(move |l| (t, l))) {
        let law = laws[0].name();
        if groups.is_some() && is_whole(&laws[0]) && !matches!(laws[0], Law::NeoHookean(_)) {
            continue;
        }
        let body = ExplicitBody { volume: &block.volume, laws, region: &[], axes: &[], groups };
        let u = deformed(block, 0.5);
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut force = InternalForce::new(body, LanePath::best()).unwrap();
                assert_eq!(force.info().kernel.name(), kernel);
                forces(&mut force, &u)
            })
        };
        let one = run(1);
        for threads in [2, 3] {
            assert_eq!(run(threads), one, "{law}, {kernel}, {threads} threads");
        }
        let error = difference(&one, &forces(&mut InternalForce::plain(body).unwrap(), &u));
        assert!(error < 1e-13, "{law}, {kernel}: {error:e}");
    }
}

#[test]
fn a_point_inside_out_is_named() {
    for kind in [CellKind::Tet4, CellKind::Hex8, CellKind::Tet10] {
        let block = Block::new(kind, [5, 4, 3]);
        let mean = fem::element_dilation(&block.mesh, &fem::VolumeRule::STANDARD).unwrap();
        for groups in [None, Some(&mean)] {
            inside_out(&block, groups);
        }
    }
}

fn inside_out(block: &Block, groups: Option<&DilationGroups>) {
    let laws = laws();
    let body = ExplicitBody { volume: &block.volume, laws: &laws, region: &[], axes: &[], groups };
    let mut u = deformed(block, 0.1);
    let node = block.volume.row(57).0[2] as usize;
    u[node] += Vector3::new(0.05, 0.02, 0.01);
    let mut f = vec![Vector3::zeros(); u.len()];
    let expected = InternalForce::plain(body).unwrap().evaluate(&u, &mut f).unwrap_err();
    assert!(expected.det_f <= 0.0 && block.volume.row(expected.point).0.contains(&(node as u32)));
    for path in LanePath::available() {
        let mut force = InternalForce::new(body, path).unwrap();
        assert_eq!(force.evaluate(&u, &mut f), Err(expected), "{}", path.name());
    }
    u[node].x = f64::NAN;
    let error = InternalForce::new(body, LanePath::best()).unwrap().evaluate(&u, &mut f).unwrap_err();
    assert!(error.det_f.is_nan());
}
