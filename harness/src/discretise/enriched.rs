//! The same body with more shape functions, for the estimate of a method's error.

use std::sync::Arc;

use cases::scene::Dilation;
use geometry::generate::{divide, raise_order};
use geometry::{CellKind, Mesh};

use super::Discretisation;

/// Poisson's ratio from which a volumetric projection is worth its cost (kappa > 10 mu).
pub(crate) const NEARLY_INCOMPRESSIBLE: f64 = 0.45;

impl Discretisation {
    /// Quadratic elements on the cells of linear elements or of a cloud's background mesh, or on eighths of
    /// quadratic cells, with the dilation `free` if they would lock at this Poisson's ratio. For a
    /// displacement carried over from other elements it has to be a pressure field: the pressure of its
    /// dilation is nowhere near the right one.
    pub(crate) fn enriched(&self, poisson: f64, free: Dilation) -> Discretisation {
        let mesh = &self.mesh;
        let linear = (0..mesh.cell_count()).all(|cell| mesh.kind(cell).order() == 1);
        let finer: Mesh = if linear { raise_order(mesh) } else { divide(mesh) };
        let locks = poisson >= NEARLY_INCOMPRESSIBLE;
        let dilation = if locks { free } else { Dilation::Standard };
        let reduced = !locks && finer.uniform_kind() == Some(CellKind::Hex20);
        Discretisation::of_elements(Arc::new(finer), 2, reduced, dilation)
    }
}
