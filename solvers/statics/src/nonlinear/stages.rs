//! Supports that act during a part of the loading: its stages, between which they begin or end.
//!
//! A support that begins late holds the points where they are then, and its motion counts from there. One that
//! ends without inertia lets go gradually: its force stays as a load that fades.

use std::sync::Arc;

use shape::{Curve, FixedDof, Vector3};

use super::penalty::PenaltySurface;
use super::problem::StaticProblem;
use super::system::SurfaceTable;
use crate::load::Load;

/// The course through the stages of a problem.
pub(crate) struct Stages<'a> {
    whole: &'a StaticProblem<'a>,
    /// Starts of all stages, and the end of the last.
    bounds: Vec<f64>,
    /// Number of the current stage.
    now: usize,
    /// Displacement at the points of each surface when its support began, less the prescribed one, m; empty for a
    /// support that acts from the start.
    caught: Vec<Vec<Vector3>>,
    /// Nodal forces of supports that have ended, N, with the curves by which they fade.
    fading: Vec<(Vec<Vector3>, Arc<Curve>)>,
}

/// Conditions of one stage.
pub(crate) struct Stage<'a> {
    fixed: Vec<FixedDof>,
    fixed_by: Vec<Option<Arc<Curve>>>,
    penalties: Vec<PenaltySurface<'a>>,
    loads: Vec<Load<'a>>,
    loads_by: Vec<Option<Arc<Curve>>>,
}

impl<'a> Stages<'a> {
    /// Starts with the first stage of a loading that lasts until `end`.
    pub fn new(whole: &'a StaticProblem<'a>, end: f64) -> Stages<'a> {
        let within = whole.curves.changes().into_iter().filter(|&time| time > 0.0 && time < end);
        let bounds = [0.0].into_iter().chain(within).chain([end]).collect();
        let caught = vec![Vec::new(); whole.penalties.len()];
        Stages { whole, bounds, now: 0, caught, fading: Vec::new() }
    }

    /// End of the current stage.
    pub fn until(&self) -> f64 {
        self.bounds[self.now + 1]
    }

    /// Whether the current stage is the first.
    pub fn is_first(&self) -> bool {
        self.now == 0
    }

    fn acts(&self, during: &[Option<[f64; 2]>], index: usize, stage: usize) -> bool {
        let Some(Some([from, until])) = during.get(index) else { return true };
        *from <= self.bounds[stage] && self.bounds[stage + 1] <= *until
    }

    fn began_late(during: &[Option<[f64; 2]>], index: usize) -> bool {
        matches!(during.get(index), Some(Some([from, _])) if *from > 0.0)
    }

    /// Returns the conditions of the current stage, which starts at the displacements `u` (m); `None` if all
    /// supports of the problem act throughout.
    pub fn stage(&self, u: &[Vector3]) -> Option<Stage<'a>> {
        let StaticProblem { curves, loads, fixed, penalties, .. } = self.whole;
        if curves.fixed.during.is_empty() && curves.penalties.during.is_empty() {
            return None;
        }
        let start = self.bounds[self.now];
        let mut stage = Stage {
            fixed: Vec::new(),
            fixed_by: Vec::new(),
            penalties: penalties.to_vec(),
            loads: loads.to_vec(),
            loads_by: (0..loads.len()).map(|index| curves.loads.own.get(index).cloned().flatten()).collect(),
        };
        let during = curves.fixed.during;
        for (index, dof) in fixed.iter().enumerate().filter(|(i, _)| self.acts(during, *i, self.now)) {
            let own = curves.fixed.own.get(index).cloned().flatten();
            if Self::began_late(during, index) {
                let curve = curves.fixed.of(index);
                let at = u[dof.node as usize][dof.axis as usize];
                let (value, curve) = match dof.value {
                    0.0 => (at, Curve::at_once()),
                    full => (full, curve.plus(at / full - curve.value(start))),
                };
                stage.fixed.push(FixedDof { value, ..*dof });
                stage.fixed_by.push(Some(Arc::new(curve)));
            } else {
                stage.fixed.push(*dof);
                stage.fixed_by.push(own);
            }
        }
        for (index, (penalty, caught)) in stage.penalties.iter_mut().zip(&self.caught).enumerate() {
            if !self.acts(curves.penalties.during, index, self.now) {
                (penalty.beta, penalty.damping) = (0.0, 0.0);
            }
            penalty.from.clone_from(caught);
        }
        for (forces, curve) in &self.fading {
            stage.loads.push(Load::Nodal { forces: forces.clone() });
            stage.loads_by.push(Some(curve.clone()));
        }
        Some(stage)
    }

    /// Goes on to the next stage at the displacements `u` (m), with the force `reaction` (N) of the supports on each
    /// node. The force of those that end fades until `gone`, if it does not vanish at once. Returns whether there is
    /// a next stage.
    pub fn advance(&mut self, u: &[Vector3], reaction: &[Vector3], gone: Option<f64>) -> bool {
        if self.now + 2 == self.bounds.len() {
            return false;
        }
        let time = self.until();
        if let Some(gone) = gone {
            let forces = self.let_go(u, reaction);
            let curve = Curve::new(vec![[time, 1.0], [gone, 0.0]], false).expect("the next output is later");
            self.fading.push((forces, Arc::new(curve)));
        }
        let timing = &self.whole.curves.penalties;
        for (index, penalty) in self.whole.penalties.iter().enumerate() {
            if matches!(timing.during.get(index), Some(Some([from, _])) if *from == time) {
                let part = timing.of(index).value(time);
                let at = penalty.surface.rows().apply(u);
                self.caught[index] = at.iter().zip(&penalty.values).map(|(at, g)| at - g * part).collect();
            }
        }
        self.now += 1;
        true
    }

    /// Returns the nodal forces (N) of the supports that end with the current stage.
    fn let_go(&self, u: &[Vector3], reaction: &[Vector3]) -> Vec<Vector3> {
        let StaticProblem { curves, fixed, penalties, .. } = self.whole;
        let acting = |stage: usize| {
            let mut held = vec![[false; 3]; u.len()];
            let acts = |(index, _): &(usize, &FixedDof)| self.acts(curves.fixed.during, *index, stage);
            for (_, dof) in fixed.iter().enumerate().filter(acts) {
                held[dof.node as usize][dof.axis as usize] = true;
            }
            held
        };
        let (before, after) = (acting(self.now), acting(self.now + 1));
        let mut forces: Vec<Vector3> = (0..u.len())
            .map(|i| Vector3::from_fn(|a, _| if before[i][a] && !after[i][a] { reaction[i][a] } else { 0.0 }))
            .collect();
        let during = curves.penalties.during;
        for (index, penalty) in penalties.iter().enumerate() {
            if self.acts(during, index, self.now) && !self.acts(during, index, self.now + 1) {
                let penalty = PenaltySurface { from: self.caught[index].clone(), ..penalty.clone() };
                let table = SurfaceTable::new(penalty.surface);
                let part = curves.penalties.of(index).value(self.until());
                table.add_force(&penalty.tractions(&table.displacement(u), &[], part), &mut forces);
            }
        }
        forces
    }
}

impl<'a> Stage<'a> {
    /// Returns the problem `whole` with the conditions of the stage.
    pub fn problem<'b>(&'b self, whole: &StaticProblem<'b>) -> StaticProblem<'b> {
        let mut problem = StaticProblem {
            fixed: &self.fixed,
            penalties: &self.penalties,
            loads: &self.loads,
            ..whole.clone()
        };
        problem.curves.fixed.own = &self.fixed_by;
        problem.curves.loads.own = &self.loads_by;
        problem
    }
}
