//! Tables: rows with further data of each point (position, gradients, weight, normal).

use rayon::prelude::*;

use crate::hourglass::Hourglass;
use crate::rows::{Rows, ShapeError};
use crate::{Matrix3, Point3, Vector3};

fn check_len(what: &'static str, found: usize, expected: usize) -> Result<(), ShapeError> {
    if found == expected { Ok(()) } else { Err(ShapeError::Length { what, found, expected }) }
}

fn check_points(points: &[Point3]) -> Result<(), ShapeError> {
    match points.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
        Some(row) => Err(ShapeError::NotFinite { what: "position", row }),
        None => Ok(()),
    }
}

fn check_weights(weights: &[f64]) -> Result<(), ShapeError> {
    // `!(w > 0)` instead of `w <= 0` also rejects NaN.
    match weights.iter().position(|&w| !(w > 0.0 && w.is_finite())) {
        Some(row) => Err(ShapeError::BadWeight { row, weight: weights[row] }),
        None => Ok(()),
    }
}

fn check_normals(normals: &[Vector3]) -> Result<(), ShapeError> {
    match normals
        .iter()
        .position(|n| (n.norm() - 1.0).abs().partial_cmp(&1e-9) != Some(std::cmp::Ordering::Less))
    {
        Some(row) => Err(ShapeError::NotFinite { what: "unit normal", row }),
        None => Ok(()),
    }
}

/// Shape values at points: probes, targets of a transfer, constraint points.
#[derive(Clone, Debug, PartialEq)]
pub struct PointRows {
    points: Vec<Point3>,
    rows: Rows,
}

impl PointRows {
    /// Builds the table from positions (m) and one row per point.
    ///
    /// # Errors
    /// A number of rows that is not that of the points, or a position that is not finite.
    pub fn new(points: Vec<Point3>, rows: Rows) -> Result<PointRows, ShapeError> {
        check_len("points", points.len(), rows.len())?;
        check_points(&points)?;
        Ok(PointRows { points, rows })
    }

    /// Positions, m.
    pub fn points(&self) -> &[Point3] {
        &self.points
    }

    /// Rows of shape values.
    pub fn rows(&self) -> &Rows {
        &self.rows
    }
}

/// Shape values and gradients at points, for strain and stress.
#[derive(Clone, Debug, PartialEq)]
pub struct GradRows {
    points: Vec<Point3>,
    rows: Rows,
    grads: Vec<Vector3>,
}

impl GradRows {
    /// Builds the table from positions (m), one row per point, and one gradient (1/m) per row entry.
    ///
    /// # Errors
    /// Lists of unequal length, or a position or gradient that is not finite.
    pub fn new(points: Vec<Point3>, rows: Rows, grads: Vec<Vector3>) -> Result<GradRows, ShapeError> {
        check_len("points", points.len(), rows.len())?;
        check_len("gradients", grads.len(), rows.nodes().len())?;
        check_points(&points)?;
        let finite = |g: &Vector3| g.iter().all(|c| c.is_finite());
        let fault = |row| {
            // The sum is tested first, as for values.
            let grads = &grads[rows.range(row)];
            (!finite(&grads.iter().sum()) && !grads.iter().all(finite))
                .then_some(ShapeError::NotFinite { what: "gradient", row })
        };
        if let Some(fault) = rows.first_fault(fault) {
            return Err(fault);
        }
        Ok(GradRows { points, rows, grads })
    }

    /// Positions, m.
    pub fn points(&self) -> &[Point3] {
        &self.points
    }

    /// Rows of shape values.
    pub fn rows(&self) -> &Rows {
        &self.rows
    }

    /// Gradients of all rows (1/m), one row after another.
    pub fn grads(&self) -> &[Vector3] {
        &self.grads
    }

    /// Returns the nodes and gradients of a row.
    pub fn row(&self, row: usize) -> (&[u32], &[Vector3]) {
        let range = self.rows.range(row);
        (&self.rows.nodes()[range.clone()], &self.grads[range])
    }

    /// Returns the row whose gradients have the largest error of linear reproduction, and this error
    /// (dimensionless). The error is `|sum_I grad N_I (x_I - x)^T - 1|`, or `|sum_I grad N_I|` times the
    /// distance of the farthest node if that is larger. `nodes` (m) holds the position of each node.
    pub fn worst_reproduction(&self, nodes: &[Point3]) -> Option<(usize, f64)> {
        assert_eq!(nodes.len(), self.rows.node_count(), "one position per node");
        let off = |q: usize| {
            let (near, grads) = self.row(q);
            let mut sum = Vector3::zeros();
            let mut slope = -Matrix3::identity();
            let mut reach = 0.0_f64;
            for (&node, grad) in near.iter().zip(grads) {
                let r = nodes[node as usize] - self.points[q];
                sum += grad;
                slope += grad * r.transpose();
                reach = reach.max(r.norm_squared());
            }
            (q, slope.norm().max(sum.norm() * reach.sqrt()))
        };
        (0..self.rows.len()).into_par_iter().map(off).max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))
    }

    /// Returns the displacement gradient at each point: `H_ij = sum_I u_Ii N_I,j`.
    pub fn displacement_gradients(&self, u: &[Vector3]) -> Vec<Matrix3> {
        assert_eq!(u.len(), self.rows.node_count(), "one vector per node");
        (0..self.rows.len()).map(|q| self.displacement_gradient(q, u)).collect()
    }

    /// Returns the displacement gradient at one point, as [`GradRows::displacement_gradients`] does at all.
    pub fn displacement_gradient(&self, q: usize, u: &[Vector3]) -> Matrix3 {
        let (nodes, grads) = self.row(q);
        let mut h = Matrix3::zeros();
        for (&node, g) in nodes.iter().zip(grads) {
            h += u[node as usize] * g.transpose();
        }
        h
    }

    /// Returns the smallest volume ratio `det(1 + H)` of all points; infinite without points.
    pub fn smallest_volume_ratio(&self, u: &[Vector3]) -> f64 {
        let ratio = |q| (Matrix3::identity() + self.displacement_gradient(q, u)).determinant();
        (0..self.rows.len()).map(ratio).fold(f64::INFINITY, f64::min)
    }
}

/// Known structure of the rows of a volume quadrature, which selects the kernels for internal forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layout {
    /// No known structure.
    #[default]
    General,
    /// Each row is at a point of a linear tetrahedron: four nodes, with gradients that are constant in the
    /// cell and sum to zero.
    LinearTetrahedra,
    /// Each group of `points` rows belongs to one of the cells of a mesh of a single kind, with `nodes`
    /// nodes.
    #[allow(missing_docs)]
    Cells { nodes: usize, points: usize },
}

/// A volume quadrature: shape values and gradients at points with weights (m^3).
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeRows {
    at: GradRows,
    weights: Vec<f64>,
    layout: Layout,
    hourglass: Option<Hourglass>,
}

impl VolumeRows {
    /// Builds the quadrature from rows with one positive weight (m^3) each.
    ///
    /// # Errors
    /// A number of weights that is not that of the rows, or a weight that is not positive.
    pub fn new(at: GradRows, weights: Vec<f64>) -> Result<VolumeRows, ShapeError> {
        check_len("weights", weights.len(), at.rows.len())?;
        check_weights(&weights)?;
        Ok(VolumeRows { at, weights, layout: Layout::General, hourglass: None })
    }

    /// Declares the known structure of the rows. Only their lengths and number are checked.
    ///
    /// # Errors
    /// Rows whose length or number does not suit the layout.
    pub fn laid_out(self, layout: Layout) -> Result<VolumeRows, ShapeError> {
        let (points, nodes) = match layout {
            Layout::General => (1, None),
            Layout::LinearTetrahedra => (1, Some(4)),
            Layout::Cells { nodes, points } => (points, Some(nodes)),
        };
        let found = self.at.rows.uniform_len();
        if let Some(expected) = nodes.filter(|&expected| found != Some(expected)) {
            return Err(ShapeError::Length { what: "nodes of a row", found: found.unwrap_or(0), expected });
        }
        let count = self.weights.len();
        check_len("points of whole cells", count, count.next_multiple_of(points))?;
        Ok(VolumeRows { layout, ..self })
    }

    /// Adds hourglass control to hexahedra with one point each.
    ///
    /// # Errors
    /// Rows of another number of nodes than eight, or a number of cells that is not that of the rows.
    pub fn controlled(self, hourglass: Hourglass) -> Result<VolumeRows, ShapeError> {
        let rows = self.laid_out(Layout::Cells { nodes: 8, points: 1 })?;
        check_len("cells with hourglass control", hourglass.len(), rows.weights.len())?;
        Ok(VolumeRows { hourglass: Some(hourglass), ..rows })
    }

    /// Hourglass control, whose energy is part of the strain energy; `None` for all but hexahedra with one
    /// point.
    pub fn hourglass(&self) -> Option<&Hourglass> {
        self.hourglass.as_ref()
    }

    /// Known structure of the rows.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Rows without their weights.
    pub fn at(&self) -> &GradRows {
        &self.at
    }

    /// Positions, m.
    pub fn points(&self) -> &[Point3] {
        &self.at.points
    }

    /// Rows of shape values.
    pub fn rows(&self) -> &Rows {
        &self.at.rows
    }

    /// Gradients of all rows (1/m).
    pub fn grads(&self) -> &[Vector3] {
        &self.at.grads
    }

    /// Weights, m^3.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Returns the nodes and gradients of a row.
    pub fn row(&self, row: usize) -> (&[u32], &[Vector3]) {
        self.at.row(row)
    }
}

/// A surface quadrature: shape values at points with weights (m^2) and outward unit normals, through which
/// tractions act.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceRows {
    at: PointRows,
    weights: Vec<f64>,
    normals: Vec<Vector3>,
}

impl SurfaceRows {
    /// Builds the quadrature from rows with one positive weight (m^2) and one unit normal each.
    ///
    /// # Errors
    /// Lists of unequal length, a weight that is not positive, or a normal that is not of unit length.
    pub fn new(at: PointRows, weights: Vec<f64>, normals: Vec<Vector3>) -> Result<SurfaceRows, ShapeError> {
        check_len("weights", weights.len(), at.rows.len())?;
        check_len("normals", normals.len(), at.rows.len())?;
        check_weights(&weights)?;
        check_normals(&normals)?;
        Ok(SurfaceRows { at, weights, normals })
    }

    /// Positions, m.
    pub fn points(&self) -> &[Point3] {
        &self.at.points
    }

    /// Rows of shape values.
    pub fn rows(&self) -> &Rows {
        &self.at.rows
    }

    /// Weights, m^2.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Outward unit normals.
    pub fn normals(&self) -> &[Vector3] {
        &self.normals
    }
}

/// A surface quadrature with gradients, as needed for the boundary stress of Nitsche's method.
#[derive(Clone, Debug, PartialEq)]
pub struct FluxRows {
    at: GradRows,
    weights: Vec<f64>,
    normals: Vec<Vector3>,
}

impl FluxRows {
    /// Builds the quadrature from rows with one positive weight (m^2) and one unit normal each.
    ///
    /// # Errors
    /// Lists of unequal length, a weight that is not positive, or a normal that is not of unit length.
    pub fn new(at: GradRows, weights: Vec<f64>, normals: Vec<Vector3>) -> Result<FluxRows, ShapeError> {
        check_len("weights", weights.len(), at.rows.len())?;
        check_len("normals", normals.len(), at.rows.len())?;
        check_weights(&weights)?;
        check_normals(&normals)?;
        Ok(FluxRows { at, weights, normals })
    }

    /// Rows without weights and normals.
    pub fn at(&self) -> &GradRows {
        &self.at
    }

    /// Positions, m.
    pub fn points(&self) -> &[Point3] {
        &self.at.points
    }

    /// Weights, m^2.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Outward unit normals.
    pub fn normals(&self) -> &[Vector3] {
        &self.normals
    }

    /// Returns the directed areas `w cof(F) n` (m^2) of the surface deformed by the nodal parameters `u` (m).
    pub fn directed_areas(&self, u: &[Vector3]) -> Vec<Vector3> {
        let area = |q: usize| {
            let f = Matrix3::identity() + self.at.displacement_gradient(q, u);
            let [a, b, c] = [0, 1, 2].map(|k| Vector3::from(f.column(k)));
            let n = self.normals[q] * self.weights[q];
            b.cross(&c) * n.x + c.cross(&a) * n.y + a.cross(&b) * n.z
        };
        (0..self.weights.len()).map(area).collect()
    }
}
