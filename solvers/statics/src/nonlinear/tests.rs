#![allow(non_snake_case)]
//! Derivatives of the internal energy against finite differences, for every law and projection.

use fem::VolumeRule;
use geometry::CellKind;
use geometry::generate::{Jitter, box_mesh};
use material::split::{Split, dilation, flat};
use material::{HolzapfelOgden, Law, Material, TransIsoMooneyRivlin, VolumetricForm};
use shape::{DilationGroups, Matrix3, Point3, Rows, Vector3, VolumeRows};

use super::lanes::GroupRow;
use super::shared::Shared;
use super::solid::{Active, Solid, SolidDilation};
use super::system::{SurfaceStiffness, System};

const YOUNG: f64 = 20e3;
const POISSON: f64 = 0.45;

/// Every law, with other volumetric energies and with fibres of both kinds of strain.
fn laws() -> Vec<Law> {
    let mut laws = Law::all(YOUNG, POISSON).unwrap();
    let mooney = laws.iter().find(|law| law.name() == "mooney-rivlin").unwrap().clone();
    for form in [VolumetricForm::Logarithmic, VolumetricForm::SimoTaylor] {
        laws.push(mooney.clone().with_volumetric(form).unwrap());
    }
    let bulk = mooney.bulk();
    laws.push(HolzapfelOgden::new([5e3, 0.5], [4e3, 0.7], [3e3, 0.4], [1e3, 0.6], bulk).unwrap().into());
    laws.push(TransIsoMooneyRivlin::new([2e3, 8e2], [2e3, 3.0, 9e3], 1.1, bulk).unwrap().into());
    laws
}

/// An asymmetric displacement gradient of about 0.3.
fn gradient() -> Matrix3 {
    Matrix3::new(0.21, -0.13, 0.08, 0.17, -0.19, 0.11, -0.05, 0.23, 0.14)
}

#[test]
fn split_derivatives_are_those_of_its_energy() {
    let h = 1e-6;
    for law in laws() {
        let small = law.is_small_strain();
        let at = |H: &Matrix3, theta_minus_1: f64| Split::new(&law, H, dilation(small, H), theta_minus_1);
        let H = gradient();
        let theta_minus_1 = 0.27;
        let (first, second) = at(&H, theta_minus_1).second(&law);
        let scale = YOUNG;
        let by_theta =
            (at(&H, theta_minus_1 + h).energy(&law) - at(&H, theta_minus_1 - h).energy(&law)) / (2.0 * h);
        assert!((by_theta - first.by_theta).abs() < 1e-7 * scale, "{}", law.name());
        let (up, down) = (at(&H, theta_minus_1 + h).first(&law), at(&H, theta_minus_1 - h).first(&law));
        let slope = (up.by_theta - down.by_theta) / (2.0 * h);
        assert!((slope - second.by_theta_theta).abs() < 1e-6 * scale, "{}", law.name());
        let slope = (up.by_F - down.by_F) / (2.0 * h);
        assert!((slope - second.by_F_theta).norm() < 1e-6 * scale, "{}", law.name());
        for k in 0..9 {
            let mut d = Matrix3::zeros();
            d[k] = h;
            let (up, down) = (at(&(H + d), theta_minus_1), at(&(H - d), theta_minus_1));
            let slope = (up.energy(&law) - down.energy(&law)) / (2.0 * h);
            assert!((slope - first.by_F[k]).abs() < 1e-7 * scale, "{} {k}", law.name());
            let slope = flat(&((up.first(&law).by_F - down.first(&law).by_F) / (2.0 * h)));
            let found = second.by_FF.column(k);
            assert!(
                (slope - found).norm() < 1e-6 * scale,
                "{} {k}: {:e}",
                law.name(),
                (slope - found).norm()
            );
        }
    }
}

#[test]
fn split_at_its_own_dilation_is_the_law() {
    for law in laws() {
        let H = gradient();
        let j_minus_1 = dilation(law.is_small_strain(), &H);
        let split = Split::new(&law, &H, j_minus_1, j_minus_1);
        assert!((split.energy(&law) - law.energy(&H)).abs() < 1e-14 * YOUNG);
        let first = split.first(&law);
        let whole = first.by_F + material::split::cofactor(law.is_small_strain(), &H) * first.by_theta;
        assert!((whole - law.stress(&H)).norm() < 1e-13 * YOUNG, "{}", law.name());
    }
}

/// Checks `A`, `U` and their slopes by central differences, and the energy of the separated parts against
/// that of the law.
#[test]
fn laws_part_into_shape_and_volume() {
    let h = 1e-6;
    let H = gradient();
    for law in laws() {
        let j_minus_1 = dilation(law.is_small_strain(), &H);
        let shape = Split::new(&law, &H, j_minus_1, 0.0);
        for theta_minus_1 in [-0.4, 1e-9, 0.27] {
            let at = |theta_minus_1: f64| law.separated(theta_minus_1);
            let Some(parts) = at(theta_minus_1) else {
                let whole = ["saint-venant-kirchhoff", "corotational", "holzapfel-ogden"];
                assert!(whole.contains(&law.name()), "{}", law.name());
                continue;
            };
            let whole = Split::new(&law, &H, j_minus_1, theta_minus_1);
            let sum = parts.A[0] * shape.energy(&law) + parts.U[0];
            assert!((sum - whole.energy(&law)).abs() < 1e-13 * YOUNG, "{} {theta_minus_1}", law.name());
            let stress = shape.first(&law).by_F * parts.A[0];
            assert!(
                (stress - whole.first(&law).by_F).norm() < 1e-13 * YOUNG,
                "{} {theta_minus_1}",
                law.name()
            );
            let (up, down) = (at(theta_minus_1 + h).unwrap(), at(theta_minus_1 - h).unwrap());
            for d in 0..2 {
                let slope = (up.A[d] - down.A[d]) / (2.0 * h);
                assert!((slope - parts.A[d + 1]).abs() < 1e-8, "{} A {d} {theta_minus_1}", law.name());
                let slope = (up.U[d] - down.U[d]) / (2.0 * h);
                assert!(
                    (slope - parts.U[d + 1]).abs() < 1e-7 * YOUNG,
                    "{} U {d} {theta_minus_1}",
                    law.name()
                );
            }
        }
    }
}

struct Case {
    volume: VolumeRows,
    element: DilationGroups,
    nodal: DilationGroups,
    pressure: Rows,
}

fn case() -> Case {
    let jitter = Some(Jitter { fraction: 0.2, seed: 7 });
    let kind = CellKind::Tet10;
    let max = Point3::new(2.0, 1.0, 1.0);
    let mesh = box_mesh(kind, Point3::origin(), max, [2, 1, 1], [1.0; 3], jitter).unwrap();
    let volume = fem::volume_rows(&mesh, &VolumeRule::STANDARD).unwrap();
    let element = fem::element_dilation(&mesh, &VolumeRule::STANDARD).unwrap();
    let pressure = fem::pressure_rows(&mesh, &VolumeRule::STANDARD, &[]).unwrap();
    // Positive, overlapping shares: the corner values of the pressure.
    let mut lists = vec![Vec::new(); pressure.node_count()];
    for q in 0..pressure.len() {
        let (nodes, values) = pressure.row(q);
        nodes.iter().zip(values).for_each(|(&m, &v)| lists[m as usize].push((q as u32, v)));
    }
    let mut offsets = vec![0];
    lists.iter().for_each(|l: &Vec<(u32, f64)>| offsets.push(offsets.last().unwrap() + l.len()));
    let (points, shares) = lists.into_iter().flatten().unzip();
    let nodal = DilationGroups::new(pressure.len(), offsets, points, shares).unwrap();
    Case { volume, element, nodal, pressure }
}

/// A smooth oscillating field of the given size, in place of random numbers.
fn field(count: usize, size: f64) -> Vec<Vector3> {
    (0..count).map(|i| Vector3::from_fn(|a, _| size * (1.7 * (3 * i + a) as f64).sin())).collect()
}

#[test]
fn forces_and_tangent_are_derivatives_of_the_energy() {
    let case = case();
    let projections = [
        ("standard", SolidDilation::Standard),
        ("element", SolidDilation::Groups(&case.element)),
        ("nodal", SolidDilation::Groups(&case.nodal)),
        ("mixed", SolidDilation::Mixed(&case.pressure)),
    ];
    for law in laws() {
        for (name, dilation) in projections {
            let name = format!("{} {name}", law.name());
            let laws = [law.clone()];
            let solid = Solid {
                volume: &case.volume,
                laws: &laws,
                region: &[],
                axes: &[],
                active: Active::default(),
                dilation,
            };
            let nodes = solid.node_count();
            let u = field(nodes, 0.03);
            let p: Vec<f64> = field(solid.pressure_count(), 2e3).iter().map(|v| v.x).collect();
            let mut system = System::new(solid, &vec![false; 3 * nodes], Vec::new(), &[]);
            let pairs = solid.pairs();
            let gradient = |u: &[Vector3], p: &[f64]| {
                let internal = solid.internal(pairs.as_ref(), u, p).unwrap();
                (internal.energy, internal)
            };
            let (_, internal) = gradient(&u, &p);
            let force = system.internal_force(&internal);
            let volume = system.pressure_gradient(&internal);
            let total = system.gather(&force, &volume);
            let hessian = solid.hessian(pairs.as_ref(), &u, &p).unwrap();
            system.assemble(&hessian, &SurfaceStiffness::default());
            let matrix = system.reduced(&hessian);
            let n = total.len();
            // Displacements of size 1e-2 and pressures of size 1e3 form one direction of differentiation.
            let direction: Vec<f64> =
                (0..n).map(|k| (0.9 * k as f64).cos() * if k < 3 * nodes { 1e-2 } else { 1e3 }).collect();
            let h = 1e-5;
            let shifted = |s: f64| {
                let (mut u, mut p) = (u.clone(), p.clone());
                system.scatter_add(&direction, s, &mut u, &mut p);
                let (energy, internal) = gradient(&u, &p);
                let force =
                    system.gather(&system.internal_force(&internal), &system.pressure_gradient(&internal));
                (energy, force)
            };
            let (up, down) = (shifted(h), shifted(-h));
            let slope = (up.0 - down.0) / (2.0 * h);
            let work: f64 = total.iter().zip(&direction).map(|(f, d)| f * d).sum();
            let size: f64 = total.iter().zip(&direction).map(|(f, d)| (f * d).abs()).sum();
            assert!((slope - work).abs() < 1e-7 * size, "{name}: {slope} {work}");
            let mut product = vec![0.0; n];
            // The matrix refers to scaled pressures.
            let unscaled =
                |x: &mut [f64]| x[3 * nodes..].iter_mut().for_each(|p| *p /= system.pressure_scale);
            let mut scaled = direction.clone();
            unscaled(&mut scaled);
            matrix.subtract_product(&scaled, &mut product);
            unscaled(&mut product);
            for part in [0..3 * nodes, 3 * nodes..n] {
                let norm = |x: &dyn Fn(usize) -> f64| part.clone().map(|k| x(k).powi(2)).sum::<f64>().sqrt();
                let error = norm(&|k| (up.1[k] - down.1[k]) / (2.0 * h) + product[k]);
                let size = norm(&|k| product[k]);
                assert!(error <= 1e-7 * size, "{name}: {error:e} of {size:e}");
            }
        }
    }
}

/// Hourglass control adds the forces and the energy of the table itself, and a constant tangent.
#[test]
fn hourglass_control_is_the_derivative_of_its_energy() {
    let jitter = Some(Jitter { fraction: 0.2, seed: 7 });
    let max = Point3::new(2.0, 1.0, 1.0);
    let mesh = box_mesh(CellKind::Hex8, Point3::origin(), max, [2, 1, 1], [1.0; 3], jitter).unwrap();
    let volume = fem::uniform_rows(&mesh, 0.05, shape::HourglassModulus::PWave).unwrap();
    let modulus = |q: usize| [2e3 + 1e3 * q as f64, 500.0];
    let springs = crate::hourglass::springs(&volume, modulus).unwrap();
    let u = field(mesh.points().len(), 0.03);
    let (forces, energy) = springs.spring_forces(&u);
    let mut plain = vec![Vector3::zeros(); u.len()];
    volume.add_hourglass_forces(modulus, &u, &mut plain);
    let size = |f: &[Vector3]| f.iter().map(Vector3::norm).fold(0.0, f64::max);
    let gap: Vec<Vector3> = forces.iter().zip(&plain).map(|(a, b)| a - b).collect();
    assert!(energy > 0.1 && (energy / volume.hourglass_energy(modulus, &u) - 1.0).abs() < 1e-13);
    assert!(size(&gap) < 1e-13 * size(&plain));
    // A quadratic energy is half the work of its forces.
    let work: f64 = forces.iter().zip(&u).map(|(f, u)| f.dot(u)).sum();
    assert!((0.5 * work / energy - 1.0).abs() < 1e-13);

    let law = [laws().swap_remove(0)];
    let solid = Solid {
        volume: &volume,
        laws: &law,
        region: &[],
        axes: &[],
        active: Active::default(),
        dilation: SolidDilation::Standard,
    };
    let mut system = System::new(solid, &vec![false; 3 * u.len()], Vec::new(), &[]);
    let hessian = solid.hessian(None, &u, &[]).unwrap();
    system.assemble(&hessian, &SurfaceStiffness::default());
    let without = system.stiffness.multiply(&u);
    system.springs = Some(springs);
    system.assemble(&hessian, &SurfaceStiffness::default());
    let with = system.stiffness.multiply(&u);
    let gap: Vec<Vector3> = with.iter().zip(&without).zip(&forces).map(|((w, o), f)| w - o - f).collect();
    assert!(size(&gap) < 1e-13 * size(&with), "{:e}", size(&gap) / size(&with));
}

#[test]
fn tangent_is_the_weak_form() {
    let case = case();
    for law in laws() {
        let laws = [law];
        let solid = Solid {
            volume: &case.volume,
            laws: &laws,
            region: &[],
            axes: &[],
            active: Active::default(),
            dilation: SolidDilation::Standard,
        };
        let nodes = solid.node_count();
        let u = field(nodes, 0.03);
        let mut system = System::new(solid, &vec![false; 3 * nodes], Vec::new(), &[]);
        let hessian = solid.hessian(None, &u, &[]).unwrap();
        system.assemble(&hessian, &SurfaceStiffness::default());
        let matrix = system.reduced(&hessian);
        let plain = crate::plain::tangent(&solid, &u);
        // The matrix stores the upper triangle.
        let mut difference = plain.upper_triangle();
        for j in 0..matrix.dim() {
            for k in matrix.offsets[j]..matrix.offsets[j + 1] {
                difference[(matrix.rows[k], j)] -= matrix.values[k];
            }
        }
        let error = difference.amax() / plain.amax();
        assert!(error < 1e-13, "{}: {error:e}", laws[0].name());
    }
}

/// For separable laws, points are summed before groups. Results are equal except for rounding, because the
/// order of sums differs.
#[test]
fn laws_that_part_give_what_pairs_give() {
    let case = case();
    let u = field(case.volume.rows().node_count(), 0.1);
    for law in laws() {
        let laws = [law];
        for groups in [&case.element, &case.nodal] {
            let dilation = SolidDilation::Groups(groups);
            let solid = Solid {
                volume: &case.volume,
                laws: &laws,
                region: &[],
                axes: &[],
                active: Active::default(),
                dilation,
            };
            let pairs = solid.pairs().unwrap();
            let kinematics = solid.kinematics(&u).unwrap();
            let shared = || Shared::new(&solid, groups, &pairs, &kinematics).unwrap();
            let close = |a: f64, b: f64, what: &str| {
                assert!((a - b).abs() < 1e-12 * YOUNG, "{} {what}: {a} {b}", laws[0].name());
            };
            let (P, energy) = shared().stress();
            let (P_plain, energy_plain) = shared().plain().stress();
            for q in 0..P.len() {
                close(energy[q], energy_plain[q], "energy");
                close((P[q] - P_plain[q]).norm(), 0.0, "stress");
            }
            let (D, by_group) = shared().hessian();
            let (D_plain, plain_by_group) = shared().plain().hessian();
            for q in 0..D.len() {
                close((D[q].matrix() - D_plain[q].matrix()).norm(), 0.0, "tangent");
            }
            for (a, b) in by_group.iter().zip(&plain_by_group) {
                assert_eq!(a.rows.len(), b.rows.len());
                for ((b, n), (b_plain, n_plain)) in
                    (a.rows.iter().map(GroupRow::both)).zip(b.rows.iter().map(GroupRow::both))
                {
                    close((b - b_plain).norm() * YOUNG, 0.0, "b");
                    close((n - n_plain).norm(), 0.0, "n");
                }
            }
        }
    }
}

/// Negative shares can make the mean of positive J's negative: `J_a = 1 + 2 (-0.8) - 0` for points of equal
/// weight.
#[test]
fn a_group_turned_inside_out_is_refused_with_its_volume_change() {
    let case = case();
    let law = [Law::all(YOUNG, POISSON).unwrap().into_iter().find(|law| !law.is_small_strain()).unwrap()];
    let count = case.volume.weights().len();
    let mut points = vec![0, 1];
    points.extend(0..count as u32);
    let mut shares = vec![2.0, -1.0, -1.0, 2.0];
    shares.resize(count + 2, 1.0);
    let groups = DilationGroups::new(count, vec![0, 2, count + 2], points, shares).unwrap();
    let solid = Solid {
        volume: &case.volume,
        laws: &law,
        region: &[],
        axes: &[],
        active: Active::default(),
        dilation: SolidDilation::Groups(&groups),
    };
    let mut j_minus_1 = vec![0.0; count];
    j_minus_1[0] = -0.8;
    let weights = case.volume.weights();
    let mean = -0.8 * 2.0 * weights[0] / (2.0 * weights[0] - weights[1]);
    let refused = solid.group_dilations(&groups, &j_minus_1).unwrap_err();
    assert_eq!(refused.point, 0);
    assert!(refused.det < -0.5 && (refused.det - 1.0 - mean).abs() < 1e-12, "{}", refused.det);
}
