//! Steps that take a tool through the surface, and tools that overlap the body between its points.

use contact::{ContactError, ContactLaw, ContactSurface, Cylinder, Outline, Sphere, Stand, Tool, ToolShape};
use geometry::CellKind;
use integration::block::{Block, SIDES};
use integration::tools::SHAPES;
use shape::{Matrix3, Point3, Vector3};

/// A tool whose foremost point is `above` the middle of the block's top (z = 20 mm), shifted by `aside` along
/// x, which moves downwards.
fn over(shape: &ToolShape, above: f64, aside: f64) -> Tool {
    let law = ContactLaw::frictionless(5e8).unwrap();
    let at = Point3::new(0.02 + aside, 0.015, 0.02 + shape.bounds().1.z + above);
    Tool::new(shape.clone(), at, Matrix3::identity(), -Vector3::z(), law).unwrap()
}

fn jumps(surface: &ContactSurface, tool: &Tool, closures: [f64; 2], u: &[Vector3]) -> bool {
    let [from, to] = closures.map(|closure| Stand { closure, u });
    match surface.check_passage(tool, from, to, false) {
        Ok(()) => false,
        Err(ContactError::JumpedOver { depth, travel, .. }) => {
            let length = (closures[1] - closures[0]).abs();
            assert!(depth <= tool.shape().inradius() * (1.0 + 1e-12) && (travel - length).abs() < 1e-12);
            true
        }
        Err(other) => panic!("{other}"),
    }
}

/// Every shape except the plate, for any travel in a step.
#[test]
fn no_tool_gets_through_a_surface_unseen() {
    let block = Block::new(CellKind::Hex8, [16, 12, 8]);
    let rows = block.surface(&SIDES);
    let surface = ContactSurface::new(&rows);
    let u = vec![Vector3::zeros(); block.mesh.points().len()];
    for shape in SHAPES.iter().filter(|shape| !shape.is_endless()) {
        let tool = over(shape, 1e-3, 0.0);
        let height = 2.0 * shape.bounds().1.z;
        // Away from the body, at rest, and back again: no surface is crossed.
        for (from, to) in [(-5e-3, 0.9e-3), (0.0, 0.0), (0.9e-3, -0.1)] {
            assert!(!jumps(&surface, &tool, [from, to], &u), "{shape:?}: {from} to {to}");
        }
        // Through the surface: to a place within the block, out of the block, and a kilometre beyond.
        for beyond in [1.1e-3, 0.03, 1e3] {
            assert!(jumps(&surface, &tool, [0.0, height + beyond], &u), "{shape:?}: {beyond}");
            assert!(jumps(&surface, &tool, [height + beyond, 0.0], &u), "{shape:?}: back from {beyond}");
        }
        // Past the side of the block.
        let aside = over(shape, 1e-3, 0.02 + shape.bounds().1.coords.max() + 1e-3);
        assert!(!jumps(&surface, &aside, [0.0, 1.0], &u), "{shape:?} beside");
        // The block may move as well: it jumps up by the tool's height and 2 mm.
        let up = vec![Vector3::z() * (height + 2e-3); u.len()];
        let [from, to] = [Stand { closure: 0.0, u: &u }, Stand { closure: 0.0, u: &up }];
        assert!(matches!(
            surface.check_passage(&tool, from, to, false),
            Err(ContactError::JumpedOver { .. })
        ));
        // A tool that moves with the block crosses nothing.
        let down = vec![-Vector3::z() * 0.05; u.len()];
        let to = Stand { closure: 0.05, u: &down };
        assert_eq!(surface.check_passage(&tool, from, to, false), Ok(()), "{shape:?}");
    }
}

/// A surface that slides along a tool may cut the tool's corners, and a surface in contact may be as deep as
/// contact allows.
#[test]
fn sliding_and_penetrating_is_no_jump() {
    let block = Block::new(CellKind::Hex8, [16, 12, 8]);
    let rows = block.surface(&["z-max"]);
    let surface = ContactSurface::new(&rows);
    let u = vec![Vector3::zeros(); block.mesh.points().len()];
    let radius = 5e-3;
    let ball = over(&ToolShape::Sphere(Sphere { radius }), 0.0, 0.0);
    // Sideways by 0.8 of the radius at a depth of a tenth of the radius.
    let moved: Vec<Vector3> = u.iter().map(|u| u + Vector3::x() * 0.8 * radius).collect();
    let [from, to] = [&u, &moved].map(|u| Stand { closure: 0.1 * radius, u });
    assert_eq!(surface.check_passage(&ball, from, to, true), Ok(()));
    // From a penetration of four tenths of the radius back out.
    let [from, to] = [0.4 * radius, -1e-3].map(|closure| Stand { closure, u: &u });
    assert_eq!(surface.check_passage(&ball, from, to, false), Ok(()));
    // The rim of a wheel goes 0.3 of its inradius through the block's edge, which is detected if nothing
    // touches afterwards.
    let wheel = ToolShape::Cylinder(Cylinder { radius: 8e-3, half_length: 5e-3 });
    let law = ContactLaw::frictionless(5e8).unwrap();
    let at = Point3::new(0.02, 0.03 + 8e-3 - 2.2e-3, 0.05);
    let wheel = Tool::new(wheel, at, Matrix3::identity(), -Vector3::z(), law).unwrap();
    let [from, to] = [0.0, 0.1].map(|closure| Stand { closure, u: &u });
    assert!(matches!(surface.check_passage(&wheel, from, to, false), Err(ContactError::JumpedOver { .. })));
    assert_eq!(surface.check_passage(&wheel, from, to, true), Ok(()));
}

/// A ball of 10 mm that enters a face of 10 mm between its points: at its middle, over a vertex and over an
/// edge.
#[test]
fn a_tool_between_the_points_is_found() {
    for kind in [CellKind::Tet4, CellKind::Hex8, CellKind::Tet10] {
        let block = Block::new(kind, [4, 3, 2]);
        let facets = block.mesh.boundary();
        let rows = block.surface(&SIDES);
        let outline = fem::outline_rows(&block.mesh, &facets).unwrap();
        let nodes = block.mesh.facet_group_nodes(&facets);
        let mut triangles = Vec::new();
        for (k, &facet) in facets.iter().enumerate() {
            let row = |node: u32| nodes.binary_search(&node).unwrap() as u32;
            let around: Vec<u32> = block.mesh.facet_nodes(facet).map(row).collect();
            let corners = block.mesh.facet_kind(facet).corner_count();
            let middle = (nodes.len() + k) as u32;
            triangles.extend((0..corners).map(|i| [around[i], around[(i + 1) % corners], middle]));
        }
        let surface = ContactSurface::new(&rows).with_outline(Outline::new(&outline, &triangles).unwrap());
        let u = vec![Vector3::zeros(); block.mesh.points().len()];
        let ball = ToolShape::Sphere(Sphere { radius: 0.01 });
        for aside in [0.0, 5e-3, 2e-3] {
            let tool = over(&ball, 0.0, aside);
            let closure = surface.gap(&tool, 0.0, &u).min(4e-4) * 0.9;
            assert!(closure > 1e-5, "{kind:?} {aside}: a point stands right there");
            let end = |closure| surface.check_end(&tool, Stand { closure, u: &u });
            assert_eq!(end(-1e-6), Ok(()), "{kind:?} {aside}");
            match end(closure) {
                Err(ContactError::Overlap { depth, at, apart }) => {
                    assert!((depth / closure - 1.0).abs() < 0.05, "{kind:?} {aside}: {depth} of {closure}");
                    assert!((at.x - 0.02 - aside).abs() < 5e-4 && (at.z - 0.02).abs() < 1e-12, "{at}");
                    assert!(apart > closure && apart < 6e-3, "{apart}");
                }
                other => panic!("{kind:?} {aside}: {other:?}"),
            }
            // Before the end of the loading the points may still be about to touch.
            assert_eq!(surface.check_overlap(&tool, Stand { closure, u: &u }), Ok(()), "{kind:?} {aside}");
        }
        // A needle at a vertex, much deeper than the points can detect.
        let needle = over(&ToolShape::Sphere(Sphere { radius: 1e-3 }), 0.0, 0.0);
        let vertex = block.nodes_of(&["z-max"]).into_iter().map(|node| block.mesh.points()[node as usize]);
        let off = |x: &Point3| (x - Point3::new(0.02, 0.015, 0.02)).norm();
        let vertex = vertex.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
        let moved = vec![Point3::new(0.02, 0.015, 0.02) - vertex; u.len()];
        let stand = Stand { closure: 1e-3, u: &moved };
        assert!(
            matches!(surface.check_overlap(&needle, stand), Err(ContactError::Overlap { .. })),
            "{kind:?}"
        );
    }
    let rows = Block::new(CellKind::Tet4, [1, 1, 1]);
    let outline = fem::outline_rows(&rows.mesh, &rows.mesh.boundary()).unwrap();
    let beyond = outline.points().len() as u32;
    assert!(matches!(Outline::new(&outline, &[[0, 1, beyond]]), Err(ContactError::Length { .. })));
}

#[test]
fn a_breadth_is_that_across_the_way() {
    let law = ContactLaw::frictionless(5e8).unwrap();
    let breadth = |shape: &ToolShape, along: Vector3| {
        Tool::new(shape.clone(), Point3::origin(), Matrix3::identity(), along, law).unwrap().half_breadth()
    };
    // Plate, rounded box, sharp box, ball, cylinder, capsule: downwards, then along x.
    for (shape, down, sideways) in [
        (&SHAPES[0], f64::INFINITY, f64::INFINITY),
        (&SHAPES[1], 5e-3, 4e-3),
        (&SHAPES[2], 2e-3, 2e-3),
        (&SHAPES[3], 5e-3, 5e-3),
        (&SHAPES[4], 4e-3, 4e-3),
        (&SHAPES[5], 3e-3, 3e-3),
    ] {
        for (along, exact) in [(-Vector3::z(), down), (Vector3::x(), sideways)] {
            let found = breadth(shape, along);
            assert!(found == exact || (found / exact - 1.0).abs() < 0.01, "{shape:?}: {found} {exact}");
        }
    }
}
