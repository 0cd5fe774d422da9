//! Degrees of freedom of faces that stop rigid motions.

use fem::FaceNumbers;
use geometry::{Mesh, Vector3};
use nalgebra::Vector6;
use shape::FixedDof;

use crate::discretise::place;

/// Part of a unit rigid motion below which a degree of freedom does not stop the motion.
const STOPS: f64 = 1e-6;

/// Returns degrees of freedom that stop the rigid motions of the body which `fixed` leaves free; none if
/// there is no such motion. The stress of a load in equilibrium exerts no force on them.
pub(super) fn anchors(fixed: &[FixedDof], faces: &FaceNumbers, mesh: &Mesh) -> Vec<FixedDof> {
    let (low, high) = place::bounds(mesh);
    let (centre, size) = (nalgebra::center(&low, &high), place::size(mesh));
    // Displacement of a degree of freedom for unit motions along and turns about the axes.
    let motions = |dof: &FixedDof| -> Vector6<f64> {
        let (face, k) = (dof.node as usize / 3, dof.node as usize % 3);
        let arm = (mesh.points()[faces.faces()[face][k] as usize] - centre) / size;
        let axis = usize::from(dof.axis);
        Vector6::from_fn(|motion, _| match motion {
            0..3 => f64::from(u8::from(motion == axis)),
            _ => Vector3::ith(motion - 3, 1.0).cross(&arm)[axis],
        })
    };
    let all = (0..3 * faces.faces().len() as u32)
        .flat_map(|node| (0..3).map(move |axis| FixedDof { node, axis, value: 0.0 }));
    let all: Vec<FixedDof> = all.collect();
    let mut stopped: Vec<Vector6<f64>> = Vec::new();
    let mut added = Vec::new();
    for (candidates, adds) in [(fixed, false), (&all[..], true)] {
        while stopped.len() < 6 {
            let left =
                |dof: &FixedDof| stopped.iter().fold(motions(dof), |left, of| left - of * of.dot(&left));
            let best = candidates
                .iter()
                .map(|dof| (left(dof), dof))
                .max_by(|a, b| a.0.norm().total_cmp(&b.0.norm()));
            let Some((motion, dof)) = best.filter(|(motion, _)| motion.norm() > STOPS) else { break };
            stopped.push(motion.normalize());
            if adds {
                added.push(*dof);
            }
        }
    }
    added
}
