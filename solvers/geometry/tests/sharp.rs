//! Sharp edges of stuffed meshes: boxes along the axes and turned.

mod common;

use common::{block, sphere_like, surface};
use tissuebench_geometry::stuffing::{fit, stuff_quadratic_with_nodes, stuff_with_nodes};
use tissuebench_geometry::{Surface, Vector3, quality};

fn turned_block(size: [f64; 3], turn: f64) -> Surface {
    let mut soup = block(size);
    let rotation = nalgebra::Rotation3::new(Vector3::new(turn, 0.7 * turn, -turn));
    soup.points.iter_mut().for_each(|p| *p = rotation * *p);
    surface(soup)
}

/// Without nodes on their edges, the meshes lack 2 to 5 %.
#[test]
fn boxes_keep_their_volume_at_the_proven_angles() {
    for size in [[10.0; 3], [80.0, 40.0, 40.0], [50.0, 40.0, 15.0]] {
        for turn in [0.0, 0.4] {
            let surface = turned_block(size, turn);
            for nodes in [250, 400, 1000, 4000] {
                let mesh = stuff_with_nodes(&surface, nodes, 0).unwrap().0.mesh;
                let found = quality::check(&mesh).unwrap();
                let off = found.volume / surface.volume() - 1.0;
                assert!(off.abs() < 3e-3, "{size:?} {turn} {nodes}: {off}");
                let angles = [found.min_dihedral.value, found.max_dihedral.value];
                assert!(angles[0] >= 10.7 && angles[1] <= 164.8, "{size:?} {turn} {nodes}: {angles:?}");
                let out = mesh.points().iter().map(|p| surface.signed_distance(p)).fold(0.0, f64::max);
                assert!(out < 1e-9 * size[0], "{size:?} {turn} {nodes}: {out}");
            }
            for nodes in [1000, 4000] {
                let mesh = stuff_quadratic_with_nodes(&surface, nodes).unwrap().mesh;
                let found = quality::check(&mesh).unwrap();
                let off = found.volume / surface.volume() - 1.0;
                assert!(
                    off.abs() < 5e-3 && found.min_det_ratio.value > 0.149,
                    "{size:?} {turn} {nodes}: {off}"
                );
            }
        }
    }
}

/// A box along the axes is filled exactly: eight nodes lie in its corners.
#[test]
fn corners_of_a_box_are_nodes() {
    let surface = turned_block([10.0; 3], 0.0);
    let mesh = stuff_with_nodes(&surface, 1000, 0).unwrap().0.mesh;
    let fit = fit(&surface, &mesh);
    assert!(fit.hausdorff() < 1e-9, "{fit:?}");
}

/// A cone frustum of 60 sides: its rims are sharp, its side is not.
#[test]
fn curved_edges_are_kept() {
    let barrel = sphere_like(5, |n| [n.x, n.y, n.z.clamp(-0.5, 0.5)].into());
    let surface = surface(barrel);
    for nodes in [400, 1000, 4000] {
        let mesh = stuff_with_nodes(&surface, nodes, 0).unwrap().0.mesh;
        let off = quality::check(&mesh).unwrap().volume / surface.volume() - 1.0;
        assert!(off.abs() < 5e-3, "{nodes}: {off}");
    }
}
