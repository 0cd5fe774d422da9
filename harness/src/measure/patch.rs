//! Patch test of a cloud's integration.
//!
//! In a constant stress the residual force on a node is `b_I = sum_q w_q grad phi_I - integral of phi_I n`
//! over the whole surface, for each axis of the stress. The residual is zero to rounding for elements and
//! smoothed cells. For Gauss points in background cells it is not, because shape functions vary nonlinearly
//! in a cell, and more so if many supports extend across a thin body.
//!
//! The displacement driven by `b` is the error of a linear field. With the Laplacian `K_IJ = sum_q w_q grad
//! phi_I . grad phi_J` as stiffness its energy is `b K^-1 b`. Conjugate gradients approach the energy from
//! below. The smooth parts, which contribute most, converge first.

use geometry::{Facet, Vector3};
use shape::VolumeRows;

use super::solved::Solved;

/// Steps of conjugate gradients. On blocks of 216 nodes, cubes and plates, ten steps give 0.8 to 1 of the
/// error.
const STEPS: usize = 10;

/// Squared forces at rounding level, relative to the volume.
const ROUNDING: f64 = 1e-20;

/// Gradient of a linear field's error relative to the field's own gradient: the root mean square for the
/// worst axis. `None` for elements.
pub(super) fn patch_error(run: &Solved) -> Option<f64> {
    if run.method.interpolates {
        return None;
    }
    let volume = &run.prepared.volume.rows;
    let facets: Vec<Facet> = run.prepared.source.mesh().boundary();
    let surface = run.prepared.source.surface(&facets).ok()?;
    let mut force = vec![Vector3::zeros(); run.method.nodes().len()];
    let mut diagonal = vec![0.0; force.len()];
    for (q, w) in volume.weights().iter().enumerate() {
        let (near, grads) = volume.row(q);
        for (&node, grad) in near.iter().zip(grads) {
            force[node as usize] += grad * *w;
            diagonal[node as usize] += w * grad.norm_squared();
        }
    }
    for ((q, w), normal) in surface.weights().iter().enumerate().zip(surface.normals()) {
        let (near, values) = surface.rows().row(q);
        for (&node, phi) in near.iter().zip(values) {
            force[node as usize] -= normal * (phi * w);
        }
    }
    let whole: f64 = volume.weights().iter().sum();
    Some((energy(volume, force, &diagonal, whole) / whole).max().max(0.0).sqrt())
}

/// Energy `b K^-1 b` for each axis; `whole` is the volume.
fn energy(volume: &VolumeRows, mut left: Vec<Vector3>, diagonal: &[f64], whole: f64) -> Vector3 {
    let scaled = |left: &[Vector3]| -> Vec<Vector3> {
        left.iter().zip(diagonal).map(|(r, k)| if *k > 0.0 { r / *k } else { Vector3::zeros() }).collect()
    };
    // The axes are independent, each with its own scalars.
    let dot =
        |a: &[Vector3], b: &[Vector3]| a.iter().zip(b).map(|(a, b)| a.component_mul(b)).sum::<Vector3>();
    let over = |a: Vector3, b: Vector3| a.zip_map(&b, |a, b| if b > 0.0 { a / b } else { 0.0 });
    let mut ahead = scaled(&left);
    let mut direction = ahead.clone();
    let mut square = dot(&left, &ahead);
    let mut energy = Vector3::zeros();
    for _ in 0..STEPS {
        if square.max() < ROUNDING * whole {
            break;
        }
        let image = laplacian(volume, &direction);
        let part = over(square, dot(&direction, &image));
        energy += part.component_mul(&square);
        left.iter_mut().zip(&image).for_each(|(r, image)| *r -= part.component_mul(image));
        ahead = scaled(&left);
        let next = dot(&left, &ahead);
        let share = over(next, square);
        direction.iter_mut().zip(&ahead).for_each(|(d, z)| *d = z + share.component_mul(d));
        square = next;
    }
    energy
}

/// Product `K u` for each axis.
fn laplacian(volume: &VolumeRows, u: &[Vector3]) -> Vec<Vector3> {
    let mut sum = vec![Vector3::zeros(); u.len()];
    for (q, (h, w)) in volume.at().displacement_gradients(u).iter().zip(volume.weights()).enumerate() {
        let (near, grads) = volume.row(q);
        for (&node, grad) in near.iter().zip(grads) {
            sum[node as usize] += h * grad * *w;
        }
    }
    sum
}
