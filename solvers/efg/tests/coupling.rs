//! Clouds coupled to finite elements: joint reproduction of linear fields, and vanishing of the cloud's
//! functions on the coupled faces.

mod common;

use common::{field, jittered_box, on_cloud, on_mesh};
use geometry::generate::box_mesh;
use geometry::shapes::Cuboid;
use geometry::{CellKind, Facet, Mesh, cloud};
use shape::{GradRows, Point3, Vector3};
use tissuebench_efg::{
    Approximation, Basis, CubicSpline, EfgError, Kernel, QuarticSpline, Support, WendlandC2, border_vertices,
    coupled_nodes, surface_rows,
};

const FACES: [&str; 6] = ["x-min", "x-max", "y-min", "y-max", "z-min", "z-max"];

/// Clouds to couple: two on the mesh's own nodes, with balls or ellipsoids, and one independent of the mesh.
const CLOUDS: [&str; 3] = ["of the mesh", "ellipsoids", "of its own"];

fn uncoupled(name: &str, mesh: &Mesh, kernel: Kernel) -> Approximation {
    let factor = 2.0;
    match name {
        "of the mesh" => on_mesh(mesh, factor, kernel, Basis::Linear),
        "ellipsoids" => {
            let ellipsoids = Support::Dilatation { factor }.ellipsoids(mesh).unwrap();
            Approximation::stretched(mesh.points().to_vec(), ellipsoids, kernel, Basis::Linear).unwrap()
        }
        _ => {
            let cuboid = Cuboid { min: Point3::origin(), max: Point3::new(0.04, 0.03, 0.03) };
            on_cloud(&cloud(&cuboid, 150, 3, &[]).unwrap(), factor, kernel, Basis::Linear)
        }
    }
}

/// Facets and vertices of one face, of three faces that meet in a corner, and of all six.
fn constrained(mesh: &Mesh) -> [(Vec<Facet>, Vec<u32>); 3] {
    [&FACES[..1], &["x-min", "y-min", "z-max"], &FACES].map(|faces| {
        let facets: Vec<Facet> = faces.iter().flat_map(|face| mesh.group(face).unwrap().to_vec()).collect();
        let vertices = mesh.facet_group_nodes(&facets);
        (facets, vertices)
    })
}

/// Returns every cloud coupled at every set of vertices.
fn coupled(mesh: &Mesh, kernel: Kernel) -> impl Iterator<Item = (String, Approximation, Vec<Facet>)> {
    CLOUDS.into_iter().flat_map(move |cloud| {
        constrained(mesh).map(|(facets, vertices)| {
            let name = format!("{cloud}, {}, {} vertices", kernel.name(), vertices.len());
            let approximation = uncoupled(cloud, mesh, kernel).coupled(mesh, &vertices).unwrap();
            (name, approximation, facets)
        })
    })
}

/// Three points in every cell, at irrational barycentric coordinates of at least 0.02.
fn inner(mesh: &Mesh) -> Vec<Point3> {
    let at = |q: usize| {
        let steps: [f64; 4] = [0.754877, 0.569840, 0.430160, 0.324718];
        let share = steps.map(|a| 0.1 + (a * (q + 1) as f64).fract());
        let sum: f64 = share.iter().sum();
        let corners = mesh.cell_points(q % mesh.cell_count()).zip(share);
        Point3::from(corners.map(|(p, s)| p.coords * (s / sum)).sum::<Vector3>())
    };
    (0..3 * mesh.cell_count()).map(at).collect()
}

/// Evaluates a field of nodal parameters and its gradient at a point.
fn apply(rows: &GradRows, q: usize, of: &[f64]) -> (f64, Vector3) {
    let (nodes, values) = rows.rows().row(q);
    let value = nodes.iter().zip(values).map(|(&n, v)| v * of[n as usize]).sum();
    (value, nodes.iter().zip(rows.row(q).1).map(|(&n, g)| g * of[n as usize]).sum())
}

#[test]
fn linear_fields_and_their_gradients_are_reproduced_in_the_layer_and_beyond() {
    let mesh = jittered_box(CellKind::Tet4, 4);
    let points = inner(&mesh);
    for kernel in Kernel::all() {
        for (name, coupled, _) in coupled(&mesh, kernel) {
            let (rows, _) = coupled.grad_rows(&points).unwrap();
            let of: Vec<f64> = coupled.nodes().iter().map(|p| field(Basis::Linear, p).0).collect();
            let ones = vec![1.0; of.len()];
            for (q, x) in points.iter().enumerate() {
                let (unity, none) = apply(&rows, q, &ones);
                // Rounding is multiplied by a condition number of up to 1e5; gradients are of order 1e2 /m.
                assert!((unity - 1.0).abs() < 1e-11 && none.norm() < 1e-9, "{name}: {unity} {none}");
                let (value, grad) = apply(&rows, q, &of);
                let (exact, slope) = field(Basis::Linear, x);
                assert!((value - exact).abs() < 1e-12, "{name}: {:e}", value - exact);
                assert!((grad - slope).norm() < 1e-10, "{name}: {:e}", (grad - slope).norm());
            }
        }
    }
}

#[test]
fn gradients_are_those_of_the_values() {
    let mesh = jittered_box(CellKind::Tet4, 4);
    let points = inner(&mesh);
    let h = 2e-7;
    for (name, coupled, _) in coupled(&mesh, Kernel::QuarticSpline(QuarticSpline)) {
        let (rows, _) = coupled.grad_rows(&points).unwrap();
        for axis in 0..3 {
            let moved =
                |step: f64| -> Vec<Point3> { points.iter().map(|x| x + Vector3::ith(axis, step)).collect() };
            let [ahead, behind] = [h, -h].map(|step| coupled.point_rows(&moved(step)).unwrap().0);
            let mut worst = 0.0f64;
            for q in 0..points.len() {
                let mut off = vec![0.0; coupled.nodes().len()];
                let add = |off: &mut [f64], (nodes, values): (&[u32], &[f64]), by: f64| {
                    nodes.iter().zip(values).for_each(|(&n, v)| off[n as usize] += by * v);
                };
                add(&mut off, ahead.rows().row(q), 0.5 / h);
                add(&mut off, behind.rows().row(q), -0.5 / h);
                let (nodes, grads) = rows.row(q);
                nodes.iter().zip(grads).for_each(|(&n, g)| off[n as usize] -= g[axis]);
                worst = off.into_iter().fold(worst, |worst, d| worst.max(d.abs()));
            }
            // Gradients are of order 1e2 /m. The error is the kernel's third derivative, 1e8 /m^3, times h^2,
            // plus rounding over h.
            assert!(worst < 1e-4, "{name}, axis {axis}: {worst:e}");
        }
    }
}

#[test]
fn the_cloud_vanishes_on_what_is_held_and_the_hats_are_those_of_its_vertices() {
    let mesh = jittered_box(CellKind::Tet4, 4);
    for (name, coupled, facets) in coupled(&mesh, Kernel::CubicSpline(CubicSpline)) {
        let vertices = mesh.facet_group_nodes(&facets);
        let first = coupled.nodes().len() - vertices.len();
        let (rows, _) = surface_rows(&coupled, &mesh, &facets, 6).unwrap();
        for q in 0..rows.weights().len() {
            let (nodes, values) = rows.rows().row(q);
            for (&n, v) in nodes.iter().zip(values).filter(|(n, _)| (**n as usize) < first) {
                assert!(v.abs() < 1e-15, "{name}: node {n}, {v:e}");
            }
        }
        let at: Vec<Point3> = vertices.iter().map(|&v| mesh.points()[v as usize]).collect();
        let (rows, _) = coupled.point_rows(&at).unwrap();
        for q in 0..at.len() {
            let (nodes, values) = rows.rows().row(q);
            for (&n, v) in nodes.iter().zip(values) {
                let kronecker = if n as usize == first + q { 1.0 } else { 0.0 };
                assert!((v - kronecker).abs() < 1e-14, "{name}: node {n} at vertex {q}, {v:e}");
            }
        }
    }
}

#[test]
fn cells_without_a_listed_vertex_have_the_cloud_s_own_functions_to_the_last_bit() {
    let mesh = jittered_box(CellKind::Tet4, 4);
    let (_, vertices) = constrained(&mesh)[0].clone();
    let coupled =
        uncoupled("of the mesh", &mesh, Kernel::WendlandC2(WendlandC2)).coupled(&mesh, &vertices).unwrap();
    let left = coupled.nodes().len() - vertices.len();
    assert_eq!(left, mesh.points().len() - vertices.len());
    let whole = uncoupled("of the mesh", &mesh, Kernel::WendlandC2(WendlandC2));
    let of_left = |n: usize| !vertices.contains(&(n as u32));
    let radii: Vec<f64> = (0..mesh.points().len()).filter(|&n| of_left(n)).map(|n| whole.radius(n)).collect();
    let nodes = coupled.nodes()[..left].to_vec();
    let alone = Approximation::new(nodes, radii, Kernel::WendlandC2(WendlandC2), Basis::Linear).unwrap();
    let points = inner(&mesh);
    let beside = |q: usize| mesh.cell(q % mesh.cell_count()).iter().any(|v| vertices.contains(v));
    let far: Vec<Point3> = (0..points.len()).filter(|&q| !beside(q)).map(|q| points[q]).collect();
    let (rows, plain) = (coupled.grad_rows(&far).unwrap().0, alone.grad_rows(&far).unwrap().0);
    assert!(far.len() > 300 && far.len() < points.len());
    for q in 0..far.len() {
        assert_eq!((rows.rows().row(q), rows.row(q)), (plain.rows().row(q), plain.row(q)));
    }
}

#[test]
fn what_cannot_be_coupled_is_refused() {
    let mesh = jittered_box(CellKind::Tet4, 4);
    let (_, vertices) = constrained(&mesh)[0].clone();
    let quadratic = on_mesh(&mesh, 2.2, Kernel::CubicSpline(CubicSpline), Basis::Quadratic);
    assert_eq!(quadratic.coupled(&mesh, &vertices).err(), Some(EfgError::NotCoupled));
    let spacing = vec![0.008; mesh.points().len()];
    let entropy = Approximation::maximum_entropy(mesh.points().to_vec(), &spacing, 1.8).unwrap();
    assert_eq!(entropy.coupled(&mesh, &vertices).err(), Some(EfgError::NotCoupled));
    let linear = || on_mesh(&mesh, 2.0, Kernel::CubicSpline(CubicSpline), Basis::Linear);
    let count = mesh.points().len();
    for (list, vertex) in [(vec![3, 1], 1), (vec![3, 3], 3), (vec![count as u32], count as u32)] {
        let refused = linear().coupled(&mesh, &list).err();
        assert_eq!(refused, Some(EfgError::BadVertex { vertex, count }), "{list:?}");
    }
    let corner = Point3::new(0.04, 0.03, 0.03);
    let hexes = box_mesh(CellKind::Hex8, Point3::origin(), corner, [2; 3], [1.0; 3], None).unwrap();
    let kind = CellKind::Hex8;
    assert_eq!(
        linear().coupled(&hexes, &[0]).err(),
        Some(EfgError::CellKind { cell: 0, kind, what: "coupling", allowed: "tet4" })
    );
    let all: Vec<u32> = (0..count as u32).collect();
    assert_eq!(linear().coupled(&mesh, &all).err(), Some(EfgError::TooFewNodes { found: 0, needed: 4 }));
    let nodes = vec![Point3::new(f64::NAN, 0.0, 0.0)];
    assert!(matches!(coupled_nodes(&nodes, &mesh, &vertices), Err(EfgError::Locate(_))));
}

/// Assigns the lower and the upper half of the box to separate regions.
fn halved(mesh: Mesh) -> Mesh {
    let above = |cell: usize| mesh.cell_points(cell).map(|p| p.z).sum::<f64>() / 4.0 > 0.015;
    let regions = (0..mesh.cell_count()).map(|cell| u16::from(above(cell))).collect();
    mesh.with_regions(regions, vec!["lower".into(), "upper".into()])
}

/// Each half has its own nodes, both share the nodes of the border, and a field with a kink there is
/// reproduced.
#[test]
fn separate_regions_share_the_vertices_of_their_border_alone() {
    let max = Point3::new(0.04, 0.03, 0.03);
    for cells in [[5, 4, 4], [8, 6, 6]] {
        let mesh = halved(box_mesh(CellKind::Tet4, Point3::origin(), max, cells, [1.0; 3], None).unwrap());
        let border = border_vertices(&mesh);
        assert_eq!(border.len(), (cells[0] + 1) * (cells[1] + 1));
        assert!(border.iter().all(|&v| (mesh.points()[v as usize].z - 0.015).abs() < 1e-12));
        for cloud in CLOUDS {
            let cloud = uncoupled(cloud, &mesh, Kernel::CubicSpline(CubicSpline));
            let separate = cloud.coupled_by_region(&mesh, &[]).unwrap();
            let first = separate.nodes().len() - border.len();
            let kinked = |p: &Point3| field(Basis::Linear, p).0 + 3.0 * (p.z - 0.015).max(0.0);
            let of: Vec<f64> = separate.nodes().iter().map(kinked).collect();
            let points = inner(&mesh);
            let (rows, _) = separate.grad_rows(&points).unwrap();
            for (q, x) in points.iter().enumerate() {
                for &node in rows.rows().row(q).0.iter().filter(|n| (**n as usize) < first) {
                    assert_eq!(separate.nodes()[node as usize].z > 0.015, x.z > 0.015, "{x}");
                }
                let (value, slope) = apply(&rows, q, &of);
                let exact = field(Basis::Linear, x).1 + Vector3::z() * if x.z > 0.015 { 3.0 } else { 0.0 };
                assert!((value - kinked(x)).abs() < 1e-8, "{x}: {value}");
                assert!((slope - exact).norm() < 1e-5, "{x}: {slope}");
            }
            // The functions of the nodes of both halves vanish on the border, so the field is single-valued
            // there.
            let on: Vec<Point3> =
                (0..9).map(|k| Point3::new(0.0044 * k as f64, 0.0033 * k as f64, 0.015)).collect();
            let (rows, _) = separate.point_rows(&on).unwrap();
            for q in 0..on.len() {
                let (nodes, values) = rows.rows().row(q);
                let of_cloud = nodes.iter().zip(values).filter(|(n, _)| (**n as usize) < first);
                assert!(of_cloud.map(|(_, v)| v.abs()).sum::<f64>() < 1e-9, "{}", on[q]);
            }
        }
    }
}
