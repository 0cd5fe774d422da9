//! Isosurface stuffing: angles, volumes and distances of meshes inside closed-form surfaces.

mod common;

use common::{bumpy, jagged, joined, moved, sphere_like, surface, torus};
use tissuebench_geometry::stuffing::{
    Stuffing, StuffingError, expected_nodes, fit, stuff, stuff_quadratic_with_nodes, stuff_with_nodes,
};
use tissuebench_geometry::{Facet, Mesh, Surface, quality};

/// Bounds proven for the angles of the lattice, in degrees.
const ANGLES: [f64; 2] = [10.7, 164.8];

fn filled(surface: &Surface, spacing: f64, doublings: u32) -> Mesh {
    let stuffed = stuff(surface, Stuffing { spacing, doublings }).unwrap_or_else(|bad| panic!("{bad}"));
    assert_eq!(stuffed.left_out, 0);
    stuffed.mesh
}

/// Checks the angles against the bounds and returns their range.
fn angles(mesh: &Mesh) -> [f64; 2] {
    let quality = quality::check(mesh).unwrap();
    let found = [quality.min_dihedral.value, quality.max_dihedral.value];
    assert!(found[0] >= ANGLES[0] && found[1] <= ANGLES[1], "{found:?}");
    found
}

#[test]
fn meshes_are_close_to_their_surfaces_at_the_proven_angles() {
    let pair = joined(sphere_like(4, |n| n), moved(sphere_like(4, |n| 0.5 * n), [1.8, 0.0, 0.0]));
    // Features of the bumpy surface, a tenth of its size, lie between cells.
    let surfaces: [(&str, Surface, f64); 5] = [
        ("sphere", surface(sphere_like(5, |n| n)), 0.05),
        ("ellipsoid", surface(sphere_like(5, |n| [2.0 * n.x, n.y, 0.5 * n.z].into())), 0.3),
        ("bumpy", surface(bumpy(5)), 0.4),
        ("torus", surface(torus(0.4, 96, 48)), 0.15),
        ("two bodies", surface(pair), 0.1),
    ];
    for (name, surface, off) in &surfaces {
        for spacing in [0.13, 0.0977] {
            let uniform = filled(surface, spacing, 0);
            let graded = filled(surface, spacing, 2);
            // The ring is nowhere six cells thick.
            let coarser = graded.points().len() < uniform.points().len();
            assert!(coarser || *name == "torus", "{name} {spacing}");
            for mesh in [uniform, graded] {
                angles(&mesh);
                let fit = fit(surface, &mesh);
                assert!((fit.volume / fit.of_surface - 1.0).abs() < 0.011, "{name} {spacing}: {fit:?}");
                // A gap between cells would appear as a boundary face deep inside.
                assert!(fit.hausdorff() < off * spacing, "{name} {spacing}: {fit:?}");
                assert_eq!(mesh.group("surface"), Some(&mesh.boundary()[..]));
            }
        }
    }
}

#[test]
fn a_surface_rougher_than_the_cells_keeps_the_angles() {
    let mut range = [f64::MAX, 0.0f64];
    for seed in 1..=6 {
        let surface = surface(jagged(4, 0.3, seed));
        for doublings in [0, 1] {
            let stuffed = stuff(&surface, Stuffing { spacing: 0.11, doublings }).unwrap();
            let [low, high] = angles(&stuffed.mesh);
            range = [range[0].min(low), range[1].max(high)];
        }
    }
    // The extreme angles are close to the bounds, so the test would detect a violation.
    assert!(range[0] < 14.0 && range[1] > 158.0, "{range:?}");
}

#[test]
fn the_same_bits_at_any_number_of_threads() {
    let surface = surface(bumpy(4));
    let [one, four] = [1, 4].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| filled(&surface, 0.11, 1))
    });
    assert!(one == four);
}

#[test]
fn a_number_of_nodes_is_met() {
    let surface = surface(sphere_like(5, |n| n));
    for (nodes, doublings) in [(60, 0), (1000, 0), (5000, 2)] {
        let (stuffed, spacing) = stuff_with_nodes(&surface, nodes, doublings).unwrap();
        let found = stuffed.mesh.points().len() as f64;
        assert!((found / nodes as f64 - 1.0).abs() < 0.2, "{found} of {nodes}");
        // In a coarse mesh, most cells are cut by the surface.
        if doublings == 0 && nodes > 100 {
            let expected = expected_nodes(surface.volume(), surface.area(), spacing);
            assert!((expected / found - 1.0).abs() < 0.4, "{expected} of {found}");
        }
    }
}

/// Inside a thin plate the number of nodes jumps, and does not always grow as the spacing shrinks.
#[test]
fn more_nodes_wanted_are_never_fewer_made() {
    let bodies = [
        ("plate", surface(common::block([100.0, 100.0, 2.0]))),
        ("strip", surface(common::block([80.0, 10.0, 1.0]))),
        ("bumpy", surface(bumpy(4))),
    ];
    let wanted = [20, 100, 400, 401, 800, 810, 3000];
    for (name, surface) in &bodies {
        let [mut last, mut quadratic] = [0; 2];
        for nodes in wanted {
            let (stuffed, _) =
                stuff_with_nodes(surface, nodes, 0).unwrap_or_else(|bad| panic!("{name}: {bad}"));
            let found = stuffed.mesh.points().len();
            assert!(found >= last, "{name}: {found} for {nodes}, {last} for fewer");
            // The mesh fills the whole body, which cells that are too large would not.
            let volume = quality::check(&stuffed.mesh).unwrap().volume;
            assert!(volume > 0.75 * surface.volume(), "{name}: {volume} of {}", surface.volume());
            last = found;
            let stuffed = stuff_quadratic_with_nodes(surface, nodes).unwrap();
            let found = stuffed.mesh.points().len();
            assert!(found >= quadratic, "{name}: {found} for {nodes} quadratic, {quadratic} for fewer");
            quadratic = found;
        }
    }
}

#[test]
fn the_length_of_edges_is_the_spacing() {
    let mesh = filled(&surface(sphere_like(5, |n| n)), 0.08, 0);
    let length = |(a, b): &(u32, u32)| (mesh.points()[*a as usize] - mesh.points()[*b as usize]).norm();
    let edges = tissuebench_geometry::edges(&mesh);
    let mean = edges.iter().map(length).sum::<f64>() / edges.len() as f64;
    assert!((mean / 0.08 - 1.0).abs() < 0.05, "{mean}");
}

/// Two balls connected by a thread of a tenth of a cell: the thread is cut off, and both balls remain.
#[test]
fn thin_parts_are_left_out_and_counted() {
    let dumbbell = common::turned(65, 24, |z: f64| {
        let ball = |at: f64| (1.0 - (z - at).powi(2)).max(0.0).sqrt();
        ball(-1.5).max(ball(1.5)).max(if z.abs() < 2.4 { 0.012 } else { 0.0 })
    });
    let surface = surface(dumbbell);
    let stuffed = stuff(&surface, Stuffing { spacing: 0.12, doublings: 0 }).unwrap();
    angles(&stuffed.mesh);
    let volume = quality::check(&stuffed.mesh).unwrap().volume;
    assert!((volume / surface.volume() - 1.0).abs() < 0.02, "{volume} of {}", surface.volume());
}

#[test]
fn spacings_that_make_no_mesh_are_refused() {
    let surface = surface(sphere_like(2, |n| n));
    let refused = |spacing| stuff(&surface, Stuffing { spacing, doublings: 0 }).unwrap_err();
    for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(refused(spacing), StuffingError::Spacing { .. }), "{spacing}");
    }
    assert!(matches!(refused(1e-5), StuffingError::TooFine { .. }));
    assert!(matches!(refused(7.0), StuffingError::TooCoarse { .. }));
}

/// Each inner face is shared by two cells: the boundary is closed also at changes of the cell size.
#[test]
fn cells_of_several_sizes_fit_together() {
    let mesh = filled(&surface(sphere_like(4, |n| n)), 0.06, 3);
    let on = |facet: &Facet| mesh.facet_nodes(*facet).map(|n| mesh.points()[n as usize].coords.norm());
    assert!(mesh.boundary().iter().flat_map(on).all(|r| r > 0.98));
    let volumes = quality::volumes(&mesh);
    let [least, most] = [f64::min, f64::max].map(|of| volumes.iter().copied().reduce(of).unwrap());
    assert!(most > 60.0 * least, "{least} to {most}");
}

/// The volume of the surface, from meshes of which each cell is cut by it to those that resolve it.
#[test]
fn meshes_enclose_the_volume_of_their_surfaces() {
    let surfaces = [
        ("sphere", surface(sphere_like(5, |n| n))),
        ("ellipsoid", surface(sphere_like(5, |n| [2.0 * n.x, n.y, 0.5 * n.z].into()))),
        ("bumpy", surface(bumpy(5))),
        ("torus", surface(torus(0.4, 96, 48))),
    ];
    for (name, surface) in &surfaces {
        for nodes in [400, 1000, 6000] {
            let (linear, _) = stuff_with_nodes(surface, nodes, 0).unwrap();
            let volume = angles_and_volume(&linear.mesh) / surface.volume() - 1.0;
            let allowed = if nodes == 400 { 5e-3 } else { 2e-3 };
            assert!(volume.abs() < allowed, "{name} {nodes}: {volume}");
            let quadratic = stuff_quadratic_with_nodes(surface, nodes).unwrap().mesh;
            let quality = quality::check(&quadratic).unwrap();
            let volume = quality.volume / surface.volume() - 1.0;
            assert!(quality.min_det_ratio.value > 0.149, "{name} {nodes}: {:?}", quality.min_det_ratio);
            // The bumps are narrower than the cells of the coarsest mesh.
            let allowed = if *name == "bumpy" && nodes == 400 { 0.07 } else { allowed };
            assert!(volume.abs() < allowed, "{name} {nodes}: {volume}");
        }
    }
}

/// Nodes on the faces of a block stay there: a plate that stands at a face touches no node before it moves.
#[test]
fn no_node_leaves_a_block() {
    let surface = surface(common::block([80.0, 40.0, 40.0]));
    for nodes in [250, 1000, 6000] {
        let linear = stuff_with_nodes(&surface, nodes, 0).unwrap().0.mesh;
        let quadratic = stuff_quadratic_with_nodes(&surface, nodes).unwrap().mesh;
        for mesh in [linear, quadratic] {
            let out = mesh.points().iter().map(|p| surface.signed_distance(p)).fold(0.0, f64::max);
            assert!(out < 1e-9 * 80.0, "{nodes}: {out}");
        }
    }
}

fn angles_and_volume(mesh: &Mesh) -> f64 {
    angles(mesh);
    quality::check(mesh).unwrap().volume
}
