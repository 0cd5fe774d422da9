#![allow(non_snake_case)] // F, H, J, S as in the formulas
//! Prony relaxation of a body: the deviatoric part of the stress relaxes, the volumetric part stays elastic.
//!
//! With `psi(F, theta)` of [`Split`] every projection of the volume change has the deviatoric stress
//! `d psi / dF`, which is `F S_dev`. The sum over the dilation groups of a point is linear in this stress, so
//! one history per point suffices. Source: Simo and Hughes, Computational Inelasticity, section 10.3.

use material::split::{Split, cofactor, flat};
use material::{AtPoint, Material as _, Prony, PronyStep, Tangent};
use rayon::prelude::*;
use shape::{Matrix3, Vector3};

use super::energy::{Hessian, Internal};
use super::error::StaticError;
use super::groups::Pairs;
use super::lanes::PointTangent;
use super::solid::{Solid, SolidDilation};

/// Stress history of all points of a body.
#[derive(Clone, Debug)]
pub(crate) struct Memory<'a> {
    solid: Solid<'a>,
    series: &'a [Option<Prony>],
    /// Offset of each point's `h_i` in `history`.
    offsets: Vec<usize>,
    /// `h_i` of all points, Pa.
    history: Vec<Matrix3>,
    /// Instantaneous deviators `S0` at the end of the last step, Pa.
    deviator: Vec<Matrix3>,
}

/// Relaxation over one step: `S_dev = modulus S0 + carried`.
#[derive(Clone, Debug)]
pub(crate) struct Relaxing {
    /// Factor of the instantaneous deviator, by point.
    modulus: Vec<f64>,
    /// Relaxed stress from earlier steps, by point, Pa.
    carried: Vec<Matrix3>,
}

impl<'a> Memory<'a> {
    /// Starts with an unstressed body at rest; one series per law.
    pub fn new(solid: Solid<'a>, series: &'a [Option<Prony>]) -> Memory<'a> {
        let points = solid.volume.weights().len();
        let mut memory = Memory {
            solid,
            series,
            offsets: vec![0],
            history: Vec::new(),
            deviator: vec![Matrix3::zeros(); points],
        };
        let mut terms = 0;
        for q in 0..points {
            terms += memory.series(q).map_or(0, |s| s.terms().len());
            memory.offsets.push(terms);
        }
        memory.history = vec![Matrix3::zeros(); terms];
        memory
    }

    fn series(&self, q: usize) -> Option<&'a Prony> {
        self.series[self.solid.region.get(q).copied().unwrap_or(0) as usize].as_ref()
    }

    fn history(&self, q: usize) -> &[Matrix3] {
        &self.history[self.offsets[q]..self.offsets[q + 1]]
    }

    /// Returns the relaxation over a step of `dt` seconds, by law.
    fn steps(&self, dt: f64) -> Vec<Option<PronyStep>> {
        let step = |s: &Option<Prony>| s.as_ref().map(|s| s.step(dt).expect("a step is not negative"));
        self.series.iter().map(step).collect()
    }

    fn region(&self, q: usize) -> usize {
        self.solid.region.get(q).copied().unwrap_or(0) as usize
    }

    /// Returns the factor and the carried stress of every point for a step of `dt` seconds from the present
    /// history; 1 and zero at points without a Prony series.
    pub fn relaxing(&self, dt: f64) -> Relaxing {
        let steps = self.steps(dt);
        let (modulus, carried) = (0..self.deviator.len())
            .map(|q| match &steps[self.region(q)] {
                Some(step) => (step.modulus(), step.carried(&self.deviator[q], self.history(q))),
                None => (1.0, Matrix3::zeros()),
            })
            .unzip();
        Relaxing { modulus, carried }
    }

    /// Updates the history after a step of `dt` seconds, at the end of which the points have the
    /// instantaneous deviators `new` (Pa).
    pub fn advance(&mut self, dt: f64, new: Vec<Matrix3>) {
        let steps = self.steps(dt);
        for (q, new) in new.iter().enumerate() {
            if let Some(step) = &steps[self.region(q)] {
                let range = self.offsets[q]..self.offsets[q + 1];
                step.advance(&self.deviator[q], new, &mut self.history[range]);
            }
        }
        self.deviator = new;
    }
}

/// A point with its projected volume change: `H`, `J - 1` and pairs (share, `theta - 1`) of the dilations.
struct Point<'a> {
    law: AtPoint<'a>,
    H: Matrix3,
    splits: Vec<(f64, Split)>,
}

impl Relaxing {
    /// Turns the elastic stresses of `internal` into relaxed stresses and returns the instantaneous
    /// deviators, Pa.
    pub fn relax(
        &self,
        solid: &Solid,
        pairs: Option<&Pairs>,
        u: &[Vector3],
        p: &[f64],
        internal: &mut Internal,
    ) -> Result<Vec<Matrix3>, StaticError> {
        let change = points(solid, pairs, u, p, |q, point| {
            let small = point.law.is_small_strain();
            let elastic: Matrix3 =
                point.splits.iter().map(|(share, split)| split.first(&point.law).by_F * *share).sum();
            let (S, carried) = if small {
                (elastic, self.carried[q])
            } else {
                let F = Matrix3::identity() + point.H;
                // F^-1 = cof^T / J; J > 0 is already checked.
                let inverse = cofactor(false, &point.H).transpose() / F.determinant();
                (inverse * elastic, F * self.carried[q])
            };
            (elastic * (self.modulus[q] - 1.0) + carried, S)
        })?;
        let (change, deviator): (Vec<Matrix3>, Vec<Matrix3>) = change.into_iter().unzip();
        for ((stress, change), w) in internal.stress.iter_mut().zip(change).zip(solid.volume.weights()) {
            *stress += change * *w;
        }
        Ok(deviator)
    }

    /// Turns the elastic tangent into the relaxed tangent.
    ///
    /// For some laws the deviatoric stress also depends on the volume (neo-Hookean with `ln J`, St.
    /// Venant-Kirchhoff), and the exact tangent is not symmetric. With one dilation per point its symmetric
    /// part is taken. With shared dilations or a pressure field the small coupling of the two parts stays
    /// elastic.
    pub fn relax_tangent(
        &self,
        solid: &Solid,
        pairs: Option<&Pairs>,
        u: &[Vector3],
        p: &[f64],
        hessian: &mut Hessian,
    ) -> Result<(), StaticError> {
        let change = points(solid, pairs, u, p, |q, point| {
            let less = self.modulus[q] - 1.0;
            let small = point.law.is_small_strain();
            let mut D = Tangent::zeros();
            for (share, split) in &point.splits {
                let (_, second) = split.second(&point.law);
                D += second.by_FF * (share * less);
                if matches!(solid.dilation, SolidDilation::Standard) {
                    let mixed = flat(&second.by_F_theta);
                    let cof = flat(&cofactor(small, &point.H));
                    D += (mixed * cof.transpose() + cof * mixed.transpose()) * (0.5 * less);
                }
            }
            if !small {
                // d(F S)_ij / dF_kl = I_ik S_lj.
                for i in 0..3 {
                    for j in 0..3 {
                        for l in 0..3 {
                            D[(i + 3 * j, i + 3 * l)] += self.carried[q][(l, j)];
                        }
                    }
                }
            }
            D
        })?;
        for ((point, change), w) in hessian.point.iter_mut().zip(change).zip(solid.volume.weights()) {
            *point = PointTangent::new(&(point.matrix() + change * *w));
        }
        Ok(())
    }
}

/// Returns `value` at every point.
fn points<T: Send>(
    solid: &Solid,
    pairs: Option<&Pairs>,
    u: &[Vector3],
    p: &[f64],
    value: impl Fn(usize, &Point) -> T + Sync,
) -> Result<Vec<T>, StaticError> {
    let kinematics = solid.kinematics(u)?;
    let (H, j_minus_1) = (&kinematics.H, &kinematics.j_minus_1);
    let of_groups = match solid.dilation {
        SolidDilation::Groups(groups) => solid.group_dilations(groups, j_minus_1)?,
        _ => Vec::new(),
    };
    let pressures = match solid.dilation {
        SolidDilation::Mixed(rows) => solid.pressures(rows, p),
        _ => Vec::new(),
    };
    (0..H.len())
        .into_par_iter()
        .with_min_len(64)
        .map(|q| {
            let law = solid.law(q);
            let split = |theta_minus_1: f64| Split::new(&law, &H[q], j_minus_1[q], theta_minus_1);
            let splits = match solid.dilation {
                SolidDilation::Standard => vec![(1.0, split(j_minus_1[q]))],
                SolidDilation::Groups(_) => (pairs.expect("groups have pairs").of(q).iter())
                    .map(|&(a, share)| (share, split(of_groups[a as usize])))
                    .collect(),
                SolidDilation::Mixed(_) => {
                    vec![(1.0, split(solid.mixed_dilation(q, &H[q], j_minus_1[q], pressures[q])?))]
                }
            };
            Ok(value(q, &Point { law, H: H[q], splits }))
        })
        .collect()
}
