//! Dead loads: tractions, pressure and body force, integrated into nodal forces (N).

use shape::{Curve, Rows, SurfaceRows, Vector3, VolumeRows};

use crate::body::check_len;
use crate::error::SolveError;
use crate::nonlinear::Timing;

/// A load with one value per quadrature point. The caller evaluates a field at the points.
#[derive(Clone, Debug)]
pub enum Load<'a> {
    /// Force per reference area, Pa.
    Traction {
        /// Loaded surface.
        surface: &'a SurfaceRows,
        /// One vector per surface point, Pa.
        values: Vec<Vector3>,
    },
    /// Pressure, Pa, acting against the outward normal: `t = -p n`.
    Pressure {
        /// Loaded surface.
        surface: &'a SurfaceRows,
        /// One value per surface point, Pa.
        values: Vec<f64>,
    },
    /// Force per reference volume, N/m^3, at the points of the body's own quadrature.
    Body {
        /// One vector per volume point, N/m^3.
        values: Vec<Vector3>,
    },
    /// Nodal forces that are already integrated, N.
    Nodal {
        /// One vector per node, N.
        forces: Vec<Vector3>,
    },
}

/// Returns the nodal forces `f_I = sum_q w N_I(x_q) t_q` of all loads, N.
pub fn nodal_forces<'a>(
    volume: &VolumeRows,
    loads: impl IntoIterator<Item = &'a Load<'a>>,
) -> Result<Vec<Vector3>, SolveError> {
    let nodes = volume.rows().node_count();
    let mut force = vec![Vector3::zeros(); nodes];
    for load in loads {
        match load {
            Load::Traction { surface, values } => {
                add(&mut force, surface.rows(), surface.weights(), values.len(), |q| values[q])?;
            }
            Load::Pressure { surface, values } => {
                let normals = surface.normals();
                add(&mut force, surface.rows(), surface.weights(), values.len(), |q| {
                    normals[q] * -values[q]
                })?;
            }
            Load::Body { values } => {
                add(&mut force, volume.rows(), volume.weights(), values.len(), |q| values[q])?;
            }
            Load::Nodal { forces } => {
                check_len("nodal forces", forces.len(), nodes)?;
                if let Some(index) = forces.iter().position(|f| !f.iter().all(|c| c.is_finite())) {
                    return Err(SolveError::NotFinite { what: "force at node", index });
                }
                force.iter_mut().zip(forces).for_each(|(sum, f)| *sum += f);
            }
        }
    }
    Ok(force)
}

/// Returns the nodal forces (N) of the loads of each curve. The first is the usual curve, even if no load
/// follows it.
pub fn nodal_forces_by_curve(
    volume: &VolumeRows,
    loads: &[Load],
    timing: &Timing,
) -> Result<Vec<(Curve, Vec<Vector3>)>, SolveError> {
    let mut curves = vec![&timing.usual];
    for curve in (0..loads.len()).map(|index| timing.of(index)) {
        if !curves.contains(&curve) {
            curves.push(curve);
        }
    }
    let each = curves.into_iter().map(|curve| {
        let of_curve = loads.iter().enumerate().filter(|(index, _)| timing.of(*index) == curve);
        Ok((curve.clone(), nodal_forces(volume, of_curve.map(|(_, load)| load))?))
    });
    each.collect()
}

fn add(
    force: &mut [Vector3],
    rows: &Rows,
    weights: &[f64],
    count: usize,
    value: impl Fn(usize) -> Vector3,
) -> Result<(), SolveError> {
    check_len("load values", count, rows.len())?;
    check_len("nodes of a loaded surface", rows.node_count(), force.len())?;
    for q in 0..count {
        let t = value(q);
        if !t.iter().all(|c| c.is_finite()) {
            return Err(SolveError::NotFinite { what: "load at point", index: q });
        }
        let (nodes, values) = rows.row(q);
        for (&node, n) in nodes.iter().zip(values) {
            force[node as usize] += t * (n * weights[q]);
        }
    }
    Ok(())
}
