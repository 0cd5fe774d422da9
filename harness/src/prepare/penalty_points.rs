//! Points at which a cloud is constrained by a penalty without a surface.

use cases::scene::Place;
use geometry::Vector3;
use shape::{FluxRows, GradRows, Rows, Unity};

use super::Prepared;
use crate::discretise::place::tolerance;
use crate::discretise::{Discretisation, node_set, place};
use crate::error::Failure;
use crate::scenario::setup::Support;

impl Prepared {
    /// Returns the points of a place without faces as a table of penalty points. Each weight is the area of a
    /// square of one node spacing: a penalty factor then means the same stiffness per node as on a surface.
    pub(super) fn at_bare_points(
        &self,
        method: &Discretisation,
        support: &Support,
    ) -> Result<Option<FluxRows>, Failure> {
        let points = node_set::points(&support.key, &support.place, method.mesh())?;
        if points.is_empty() {
            return Ok(None);
        }
        let weights = vec![self.spacing.powi(2); points.len()];
        let normals = vec![Vector3::z(); points.len()];
        Ok(Some(FluxRows::new(self.source.gradients_at(&points)?, weights, normals)?))
    }

    /// Returns the volume points in the place as a table of penalty points. Their weights are divided by the
    /// spacing: a penalty factor then means the same stiffness per depth of one node spacing as on a surface.
    pub(super) fn clamped_volume(
        &self,
        method: &Discretisation,
        support: &Support,
    ) -> Result<Option<FluxRows>, Failure> {
        if !matches!(support.place, Place::Where(_)) {
            return Ok(None);
        }
        let tolerance = tolerance(method.mesh());
        let rows = &self.volume.rows;
        let inside: Vec<usize> = (0..rows.points().len())
            .filter(|&q| place::holds(&support.place, &rows.points()[q], tolerance))
            .collect();
        if inside.is_empty() {
            return Ok(None);
        }
        let (mut offsets, mut nodes, mut values, mut grads) = (vec![0], Vec::new(), Vec::new(), Vec::new());
        for &q in &inside {
            let (row_nodes, row_values) = rows.rows().row(q);
            nodes.extend_from_slice(row_nodes);
            values.extend_from_slice(row_values);
            grads.extend_from_slice(rows.row(q).1);
            offsets.push(nodes.len());
        }
        let points = inside.iter().map(|&q| rows.points()[q]).collect();
        let table = Rows::new(rows.rows().node_count(), offsets, nodes, values, Unity::NotPromised)?;
        let at = GradRows::new(points, table, grads)?;
        let weights = inside.iter().map(|&q| rows.weights()[q] / self.spacing).collect();
        Ok(Some(FluxRows::new(at, weights, vec![Vector3::z(); inside.len()])?))
    }
}
