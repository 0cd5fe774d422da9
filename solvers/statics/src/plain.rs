#![allow(non_snake_case)] // A, H, I and K as in the formulas
//! Reference stiffness and tangent, written as the weak form, against which all faster implementations are
//! tested.
//!
//! The matrices are dense, (3n, 3n), N/m, and are filled point by point in one thread. They serve for reading
//! and testing, not for solving.

use material::Material as _;
use nalgebra::DMatrix;
use shape::{Matrix3, Vector3};

use crate::body::LinearBody;
use crate::dilation::group_bulk;
use crate::nonlinear::Solid;

/// Returns the stiffness `K_ij = sum_q (lambda g_i g_j^T + mu g_j g_i^T + mu (g_i . g_j) I) dv`,
/// `g_i = grad N_i`.
///
/// With a projection the points keep `lambda = -2 mu / 3`, and group a of volume `V` and mean gradients `b_i`
/// adds `kappa V b_i b_j^T`.
pub fn stiffness(body: &LinearBody) -> DMatrix<f64> {
    let (I, mut K) = (Matrix3::identity(), zeros(body.nodes.len()));
    for (q, &dv) in body.volume.weights().iter().enumerate() {
        let mu = body.material(q).mu();
        let lambda = if body.dilation.is_some() { -2.0 / 3.0 * mu } else { body.material(q).lambda() };
        let (nodes, grads) = body.volume.row(q);
        for (&i, gi) in nodes.iter().zip(grads) {
            for (&j, gj) in nodes.iter().zip(grads) {
                let block = lambda * gi * gj.transpose() + mu * gj * gi.transpose() + I * mu * gi.dot(gj);
                add(&mut K, i, j, block * dv);
            }
        }
    }
    let mut scratch = vec![Vector3::zeros(); body.nodes.len()];
    for (groups, a) in
        body.dilation.into_iter().flat_map(|groups| (0..groups.len()).map(move |a| (groups, a)))
    {
        let (volume, b) = groups.averaged_gradient(a, body.volume, &mut scratch);
        for &(i, bi) in &b {
            for &(j, bj) in &b {
                add(&mut K, i, j, group_bulk(body, a) * volume * bi * bj.transpose());
            }
        }
    }
    K
}

/// Returns the tangent `K_ij = sum_q g_i . A(H) . g_j dv` at nodal parameters `u` (m), with
/// `H = sum_i u_i g_i^T` and `A = dP/dF`. The projection of the volume change (`solid.dilation`) is ignored.
pub fn tangent(solid: &Solid, u: &[Vector3]) -> DMatrix<f64> {
    let mut K = zeros(u.len());
    for (q, &dv) in solid.volume.weights().iter().enumerate() {
        let (nodes, grads) = solid.volume.row(q);
        let H: Matrix3 = nodes.iter().zip(grads).map(|(&i, g)| u[i as usize] * g.transpose()).sum();
        let A = solid.law(q).tangent(&H);
        for (&i, gi) in nodes.iter().zip(grads) {
            for (&j, gj) in nodes.iter().zip(grads) {
                for (k, l) in (0..9).map(|kl| (kl / 3, kl % 3)) {
                    // Entry (a, b) of this block of A is dP_ak / dF_bl.
                    add(&mut K, i, j, A.fixed_view::<3, 3>(3 * k, 3 * l) * (gi[k] * gj[l] * dv));
                }
            }
        }
    }
    K
}

fn zeros(nodes: usize) -> DMatrix<f64> {
    DMatrix::zeros(3 * nodes, 3 * nodes)
}

fn add(K: &mut DMatrix<f64>, i: u32, j: u32, block: Matrix3) {
    let mut place = K.fixed_view_mut::<3, 3>(3 * i as usize, 3 * j as usize);
    place += block;
}
