//! Lumped mass.

use geometry::CellKind;
use shape::VolumeRows;

use crate::error::ExplicitError;

/// Method of lumping the consistent mass matrix `M_IJ = sum_q rho w N_I N_J` onto its diagonal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lumping {
    /// Row sums, `m_I = sum_q rho w N_I`, for linear elements and moving least squares. The corners of
    /// quadratic elements would get zero or negative mass.
    RowSum,
    /// Diagonal scaling (Hinton, Rock & Zienkiewicz 1976), element by element: the diagonal
    /// `sum_q rho w N_I^2` scaled to the mass of the element. Always positive.
    DiagonalScaling,
}

impl Lumping {
    /// Chooses the method of lumping for a table: [`Lumping::DiagonalScaling`] for quadratic elements (every
    /// row has as many nodes as a quadratic cell), [`Lumping::RowSum`] for all others.
    pub fn for_table(volume: &VolumeRows) -> Lumping {
        let rows = volume.rows();
        let is_quadratic = |nodes: usize| {
            CellKind::ALL.into_iter().any(|kind| kind.order() == 2 && kind.node_count() == nodes)
        };
        match (0..rows.len()).all(|q| is_quadratic(rows.row(q).0.len())) {
            true => Lumping::DiagonalScaling,
            false => Lumping::RowSum,
        }
    }
}

/// Returns the mass (kg) of every integration point. `density` (kg/m^3) is given by region index, `region`
/// for every point; `region` is empty if all points are in region 0.
///
/// # Errors
///
/// [`ExplicitError::Length`], [`ExplicitError::BadParameter`] or [`ExplicitError::NoLaw`] for invalid
/// lengths, densities or regions.
pub fn point_masses(volume: &VolumeRows, density: &[f64], region: &[u16]) -> Result<Vec<f64>, ExplicitError> {
    let (found, expected) = (region.len(), volume.weights().len());
    if found != expected && found > 0 {
        return Err(ExplicitError::Length { what: "region indices", found, expected });
    }
    if let Some(&value) = density.iter().find(|&&rho| !(rho > 0.0 && rho.is_finite())) {
        return Err(ExplicitError::BadParameter { what: "density", value, allowed: "positive and finite" });
    }
    let mass = |(point, w): (usize, &f64)| {
        let region = region.get(point).map_or(0, |&region| usize::from(region));
        let laws = density.len();
        density.get(region).map(|rho| rho * w).ok_or(ExplicitError::NoLaw { point, region, laws })
    };
    volume.weights().iter().enumerate().map(mass).collect()
}

/// Computes nodal masses (kg), all positive; their sum is that of the [`point_masses`].
///
/// # Errors
///
/// [`ExplicitError::NodalMass`] if a mass is not positive; also as [`point_masses`].
pub fn lumped_mass(
    volume: &VolumeRows,
    density: &[f64],
    region: &[u16],
    lumping: Lumping,
) -> Result<Vec<f64>, ExplicitError> {
    let rows = volume.rows();
    let point_mass = point_masses(volume, density, region)?;
    let mut mass = vec![0.0; rows.node_count()];
    match lumping {
        Lumping::RowSum => {
            for (q, m) in point_mass.iter().enumerate() {
                let (nodes, values) = rows.row(q);
                nodes.iter().zip(values).for_each(|(&node, n)| mass[node as usize] += m * n);
            }
        }
        Lumping::DiagonalScaling => {
            let mut first = 0;
            while first < rows.len() {
                let nodes = rows.row(first).0;
                let end = (first..rows.len()).find(|&q| rows.row(q).0 != nodes).unwrap_or(rows.len());
                let mut diagonal = vec![0.0; nodes.len()];
                for q in first..end {
                    let values = rows.row(q).1;
                    diagonal.iter_mut().zip(values).for_each(|(d, n)| *d += point_mass[q] * n * n);
                }
                let total: f64 = point_mass[first..end].iter().sum();
                let scale = total / diagonal.iter().sum::<f64>();
                nodes.iter().zip(&diagonal).for_each(|(&node, d)| mass[node as usize] += scale * d);
                first = end;
            }
        }
    }
    // A NaN must not pass, hence `!(m > 0)`.
    match mass.iter().position(|&m| !(m > 0.0)) {
        Some(node) => Err(ExplicitError::NodalMass { node, mass: mass[node] }),
        None => Ok(mass),
    }
}
