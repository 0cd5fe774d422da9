//! Refused input of each scheme, and counted special cases.

use efg::{EfgError, Support};
use geometry::generate::box_mesh;
use geometry::{CellKind, CloudError, LocateError, Mesh};
use nalgebra::Vector3;
use shape::Point3;
use tissuebench_interp::{
    Barycentric, InterpError, InverseDistance, MlsLinear, MlsModified, MlsQuadratic, NaturalNeighbour,
    Radial, Scheme, Shepard, shepard,
};

fn mesh(kind: CellKind) -> Mesh {
    box_mesh(kind, Point3::origin(), Point3::new(0.02, 0.02, 0.02), [4, 4, 4], [1.0; 3], None).unwrap()
}

/// Returns all radial bases of the catalogue.
fn radial() -> impl Iterator<Item = Scheme> {
    Scheme::all().filter(|scheme| matches!(scheme, Scheme::Radial(_)))
}

#[test]
fn too_few_nodes() {
    let one = [Point3::new(0.01, 0.0, 0.0)];
    let needed = |scheme: Scheme| match scheme.rows(&one, None, &one) {
        Ok((rows, _)) => {
            assert_eq!(rows.rows().apply(&[Vector3::x()]), [Vector3::x()], "{scheme:?}");
            1
        }
        Err(InterpError::TooFewNodes { scheme: name, found, needed }) => {
            assert_eq!((name, found), (scheme.name(), 1));
            needed
        }
        Err(InterpError::NeedsMesh { .. }) => 0,
        Err(error) => panic!("{scheme:?}: {error}"),
    };
    assert_eq!(Scheme::all().map(needed).collect::<Vec<_>>(), [1, 4, 2, 4, 10, 10, 4, 4, 4, 4, 4, 4, 0]);
    for scheme in Scheme::all() {
        assert!(scheme.rows(&[], None, &one).is_err(), "{scheme:?}");
    }
}

#[test]
fn numbers_that_are_not_finite() {
    let mesh = mesh(CellKind::Tet4);
    let mut nodes = mesh.points().to_vec();
    let target = [Point3::new(0.011, 0.012, 0.013)];
    let bad = [target[0], Point3::new(0.0, f64::NAN, 0.0)];
    for scheme in Scheme::all() {
        let error = scheme.rows(&nodes, Some(&mesh), &bad).unwrap_err();
        assert_eq!(error, InterpError::NotFinite { what: "target", index: 1 }, "{scheme:?}");
    }
    nodes[17].z = f64::INFINITY;
    for scheme in Scheme::all().filter(|s| *s != Scheme::Barycentric(Barycentric)) {
        let error = scheme.rows(&nodes, None, &target).unwrap_err();
        assert_eq!(error, InterpError::NotFinite { what: "node", index: 17 }, "{scheme:?}");
    }
}

#[test]
fn parameters_out_of_range() {
    let nodes = mesh(CellKind::Tet4).points().to_vec();
    for scheme in [
        Scheme::InverseDistance(InverseDistance { neighbours: 0, power: 2.0 }),
        Scheme::InverseDistance(InverseDistance { neighbours: 4, power: 0.0 }),
        Scheme::InverseDistance(InverseDistance { neighbours: 4, power: f64::NAN }),
        Scheme::InverseDistance(InverseDistance { neighbours: 4, power: f64::INFINITY }),
    ] {
        let error = scheme.rows(&nodes, None, &nodes).unwrap_err();
        assert!(matches!(error, InterpError::BadParameter { .. }), "{scheme:?}: {error}");
    }
    for dilatation in [0.0, -1.6, f64::NAN, f64::INFINITY] {
        for scheme in [
            Scheme::Shepard(Shepard { support_scale: dilatation }),
            Scheme::MlsLinear(MlsLinear { support_scale: dilatation }),
            Scheme::MlsQuadratic(MlsQuadratic { support_scale: dilatation }),
            Scheme::MlsModified(MlsModified { support_scale: dilatation }),
        ] {
            let error = scheme.rows(&nodes, None, &nodes).unwrap_err();
            assert!(matches!(error, InterpError::Mls(EfgError::BadParameter { .. })), "{scheme:?}: {error}");
        }
    }
    for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for radial in [
            Radial::Multiquadric { shape: width },
            Radial::Gaussian { shape: width, polynomial: true },
            Radial::WendlandC2 { support: width, polynomial: false },
        ] {
            let error = Scheme::Radial(radial).rows(&nodes, None, &nodes).unwrap_err();
            assert!(matches!(error, InterpError::BadParameter { .. }), "{radial:?}: {error}");
        }
    }
    let many = Scheme::InverseDistance(InverseDistance { neighbours: 126, power: 2.0 });
    let error = many.rows(&nodes, None, &nodes).unwrap_err();
    assert_eq!(error, InterpError::TooFewNodes { scheme: "inverse-distance", found: 125, needed: 126 });
}

#[test]
fn coincident_nodes() {
    let mut nodes = mesh(CellKind::Tet4).points().to_vec();
    nodes.push(nodes[60]);
    let targets = [Point3::new(0.011, 0.012, 0.013), nodes[60], nodes[0]];
    let u: Vec<_> = nodes.iter().map(|x| x.coords).collect();
    for scheme in Scheme::all().filter(|s| *s != Scheme::Barycentric(Barycentric)) {
        match scheme.rows(&nodes, None, &targets) {
            Ok((rows, _)) => {
                let at_node = (rows.rows().apply(&u)[1] - nodes[60].coords).norm();
                assert!(!scheme.interpolates() || at_node == 0.0, "{scheme:?}: {at_node:e}");
            }
            Err(InterpError::CoincidentNodes { first, second, distance, .. }) => {
                assert!(matches!(scheme, Scheme::Radial(_) | Scheme::NaturalNeighbour(NaturalNeighbour)));
                assert_eq!((first, second, distance), (60, 125, 0.0));
            }
            Err(InterpError::Cloud(error)) => {
                assert_eq!(error, CloudError::Coincident { first: 60, second: 125 })
            }
            Err(error) => panic!("{scheme:?}: {error}"),
        }
    }
    // Both nodes have the same weight, which is the limit of the formula from all sides.
    let (rows, _) = Scheme::from_name("inverse-distance").unwrap().rows(&nodes, None, &targets).unwrap();
    assert_eq!(rows.rows().row(1).0[..2], [60, 125]);
    assert_eq!(rows.rows().row(1).1, [0.5, 0.5, 0.0, 0.0]);
}

#[test]
fn almost_coincident_nodes_are_told_apart_or_refused() {
    let mut nodes = mesh(CellKind::Tet4).points().to_vec();
    let u = |nodes: &[Point3]| nodes.iter().map(|x| x.coords).collect::<Vec<_>>();
    for scheme in radial() {
        nodes.truncate(125);
        nodes.push(nodes[60] + Vector3::new(1e-5, 0.0, 0.0));
        let (rows, _) = scheme.rows(&nodes, None, &nodes).unwrap();
        let back = rows.rows().apply(&u(&nodes));
        let error = back.iter().zip(&nodes).map(|(a, b)| (a - b.coords).norm()).fold(0.0, f64::max);
        assert!(error < 1e-12, "{scheme:?}: {error:e}");
        nodes[125] = nodes[60] + Vector3::new(1e-9, 0.0, 0.0);
        match scheme.rows(&nodes, None, &nodes) {
            Err(InterpError::CoincidentNodes { first: 60, second: 125, distance, .. }) => {
                assert!((distance / 1e-9 - 1.0).abs() < 1e-6, "{distance:e}");
            }
            other => panic!("{scheme:?}: {:?}", other.map(|_| "no error")),
        }
    }
}

/// Rows of a system that is singular to working precision would be noise: the interpolant would miss its
/// nodes.
#[test]
fn functions_too_wide_for_the_nodes_are_refused() {
    let nodes = mesh(CellKind::Tet4).points().to_vec();
    let u: Vec<_> = nodes.iter().map(|x| Vector3::new((300.0 * x.x).sin(), 200.0 * x.y * x.z, 1.0)).collect();
    let mut refused = Vec::new();
    for width in [1.0, 2.0, 4.0, 8.0, 16.0, 64.0, 1e6, 1e200] {
        for radial in [
            Radial::Multiquadric { shape: width },
            Radial::Gaussian { shape: width, polynomial: true },
            Radial::Gaussian { shape: width, polynomial: false },
            Radial::WendlandC2 { support: width, polynomial: true },
            Radial::WendlandC2 { support: width, polynomial: false },
        ] {
            match Scheme::Radial(radial).rows(&nodes, None, &nodes) {
                Ok((rows, _)) => {
                    let back = rows.rows().apply(&u);
                    let miss = back.iter().zip(&u).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
                    // An error of 1e-6 is accepted for a single field.
                    assert!(miss < 1e-5, "{radial:?}: {miss:e}");
                }
                Err(InterpError::TooWide { width: reported, miss, .. }) => {
                    assert!(reported == width && !(miss < 1e-6), "{radial:?}: {miss:e}");
                    refused.push((radial.name(), radial.polynomial(), width));
                }
                Err(error) => panic!("{radial:?}: {error}"),
            }
        }
    }
    for first in [("multiquadric", true, 64.0), ("gaussian", true, 8.0), ("gaussian", false, 8.0)] {
        assert!(refused.contains(&first), "{first:?} not in {refused:?}");
    }
    assert!(refused.iter().all(|&(_, _, width)| width > 1.0), "{refused:?}");
}

#[test]
fn a_flat_cloud_carries_no_linear_field() {
    let nodes: Vec<_> = (0..30).map(|i| Point3::new((i % 6) as f64, (i / 6) as f64, 0.5) * 1e-3).collect();
    let target = [Point3::new(2.2e-3, 1.3e-3, 0.5e-3)];
    for scheme in radial().chain([Scheme::NaturalNeighbour(NaturalNeighbour)]) {
        let error = scheme.rows(&nodes, None, &target).unwrap_err();
        assert!(
            matches!(error, InterpError::FlatCloud { thickness, .. } if thickness < 1e-15),
            "{scheme:?}: {error}"
        );
    }
    let mut almost = nodes.clone();
    almost.iter_mut().step_by(2).for_each(|x| x.z += 1e-11);
    let error = Scheme::Radial(Radial::Cubic).rows(&almost, None, &target).unwrap_err();
    assert!(matches!(error, InterpError::FlatCloud { .. }), "{error}");
    let linear = Scheme::MlsLinear(MlsLinear { support_scale: 1.6 });
    assert!(matches!(
        linear.rows(&nodes, None, &target),
        Err(InterpError::Mls(EfgError::SingularMoment { .. }))
    ));
    let same = [nodes[0]; 5];
    let error = Scheme::Radial(Radial::Cubic).rows(&same, None, &target).unwrap_err();
    assert!(matches!(error, InterpError::CoincidentNodes { distance: 0.0, .. }), "{error}");
}

#[test]
fn a_dense_table_beyond_memory_is_refused_before_it_is_built() {
    let nodes: Vec<_> =
        (0..12_000).map(|i| Point3::new(i as f64, (i * i % 97) as f64, (i % 31) as f64)).collect();
    let error = Scheme::Radial(Radial::Cubic).rows(&nodes, None, &nodes[..1]).unwrap_err();
    assert!(matches!(error, InterpError::TooLarge { nodes: 12_000, targets: 1, .. }), "{error}");
}

#[test]
fn a_mesh_is_needed_and_must_be_of_tetrahedra_over_the_nodes() {
    let scheme = Scheme::Barycentric(Barycentric);
    let tets = mesh(CellKind::Tet4);
    let hexes = mesh(CellKind::Hex8);
    let error = |nodes, mesh| scheme.rows(nodes, mesh, &[]).unwrap_err();
    assert_eq!(error(tets.points(), None), InterpError::NeedsMesh { scheme: "barycentric" });
    assert_eq!(
        error(&tets.points()[1..], Some(&tets)),
        InterpError::MeshMismatch { mesh: 125, nodes: 124, first: 0 }
    );
    let kind = LocateError::NotTetrahedron { cell: 0, kind: CellKind::Hex8 }.into();
    assert_eq!(error(hexes.points(), Some(&hexes)), kind);
}

#[test]
fn targets_outside_the_mesh_are_extrapolated_and_counted() {
    let mesh = mesh(CellKind::Tet4);
    let targets = [
        Point3::new(0.011, 0.012, 0.013),
        Point3::new(0.022, 0.012, 0.013),
        Point3::new(-0.01, -0.02, 0.01),
        Point3::new(0.02, 0.02, 0.02),
    ];
    let (rows, info) = Scheme::Barycentric(Barycentric).rows(mesh.points(), Some(&mesh), &targets).unwrap();
    assert_eq!((info.outside, info.fallbacks), (2, 0));
    let field = |x: &Point3| Vector3::new(0.3 * x.y, 0.1 - 0.2 * x.z, x.x + x.y);
    let nodal: Vec<_> = mesh.points().iter().map(field).collect();
    for (u, x) in rows.rows().apply(&nodal).iter().zip(&targets) {
        assert!((u - field(x)).norm() < 1e-15, "{u} {x}");
    }
}

#[test]
fn targets_no_support_covers_are_counted() {
    let nodes = mesh(CellKind::Tet4).points().to_vec();
    let far = [Point3::new(0.011, 0.012, 0.013), Point3::new(0.05, 0.01, 0.01)];
    let (rows, info) = Scheme::Shepard(Shepard { support_scale: 1.2 }).rows(&nodes, None, &far).unwrap();
    assert_eq!(info.fallbacks, 1);
    // The contributing nodes are those of the near face, x = 20 mm.
    assert!(rows.rows().row(1).0.iter().all(|&n| nodes[n as usize].x > 0.019), "{:?}", rows.rows().row(1));
    let near = [Point3::new(0.023, 0.01, 0.01)];
    let (_, info) = Scheme::MlsLinear(MlsLinear { support_scale: 1.2 }).rows(&nodes, None, &near).unwrap();
    assert_eq!(info.fallbacks, 1);
    // Farther out moving least squares would extrapolate too far and return an error.
    let error = Scheme::MlsLinear(MlsLinear { support_scale: 1.2 }).rows(&nodes, None, &far).unwrap_err();
    assert!(matches!(error, InterpError::Mls(EfgError::TooFewNeighbours { .. })), "{error}");
}

#[test]
fn supports_by_neighbour_reach_every_neighbour() {
    let nodes = mesh(CellKind::Tet4).points().to_vec();
    let target = [Point3::new(0.0125, 0.0125, 0.0125)];
    let (rows, info) = shepard(&nodes, Support::Neighbours { count: 6, factor: 1.1 }, &target).unwrap();
    // The target is the centre of a cell of 5 mm. Its 8 corners are 4.33 mm away, within 1.1 x 5 mm. The next
    // nodes are 8.29 mm away; supports on the surface have a radius of 1.1 x 7.07 mm.
    assert_eq!(info.fallbacks, 0);
    assert_eq!(rows.rows().row(0).0.len(), 8);
    assert!(rows.rows().row(0).1.iter().all(|v| (v - 0.125).abs() < 1e-15));
}
