//! Conforming cell smoothing: over each tet4 the gradients are constant or linear polynomials, whose moments
//! follow from Gauss's theorem. One table of face points serves both sides of every face.

use geometry::{Facet, Mesh};
use shape::{GradRows, Rows, TraceRows, Unity, VolumeRows};

use crate::approximation::Approximation;
use crate::cell_rows::{CellRows, face_basis, local_corners, volume_basis};
use crate::cells::tet_measure;
use crate::error::EfgError;
use crate::facets::{triangle_rule, vector_area};
use crate::info::MlsInfo;
use crate::row_list::RowList;

/// The field of smoothed gradients inside a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Smoothing {
    /// Constant gradients with one integration point, exact for linear displacements; suits the linear basis.
    Constant,
    /// Linear gradients with the four points of degree 2, exact for quadratic displacements; suits the
    /// quadratic basis and face rules of degree 3 or more (6 points).
    Linear,
}

impl Smoothing {
    /// Returns the number of integration points per tet4.
    pub fn points_per_cell(self) -> usize {
        match self {
            Smoothing::Constant => 1,
            Smoothing::Linear => 4,
        }
    }

    /// Returns the sharp constant `c` of the trace inequality `integral_F p^2 <= c (A / V) integral_T p^2`
    /// for polynomials of this degree on a tetrahedron with face area `A` and volume `V`:
    /// `(k + 1) (k + 3) / 3`. Source: Warburton and Hesthaven (2003), doi:10.1016/S0045-7825(03)00294-9.
    fn trace_constant(self) -> f64 {
        match self {
            Smoothing::Constant => 1.0,
            Smoothing::Linear => 8.0 / 3.0,
        }
    }
}

/// Computes rows over a tet4 background, in cell order, with smoothed gradients `grad~_I` (1/m) and the
/// values of the shape functions themselves. `face_points` is the number of points `x_q` per triangular face.
///
/// The points are the centroid ([`Smoothing::Constant`], weight `V`, the cell's volume) or four points
/// ([`Smoothing::Linear`], weights `V / 4`). `grad~_I` is the polynomial for which, for every `p` of its
/// degree,
///
/// ```text
/// integral_cell grad~_I p = sum_faces sum_q w_q phi_I(x_q) n p(x_q) - sum_q w_q phi_I(x_q) grad p
/// ```
///
/// with the last sum over the cell's own points. The points of an interior face are evaluated once and serve
/// both sides with opposite normals. With [`crate::surface_rows`] at the same `face_points`, and body forces
/// at the same points, stresses of this degree therefore balance their loads to rounding: linear patch tests
/// pass with `Constant`, quadratic patch tests with `Linear`. A constant gradient per cell locks near
/// incompressibility unless the dilation is projected. Sources: Chen, Wu, Yoon and You (2001), smoothing on
/// the background's cells; Duan, Li, Zhang and Belytschko (2012), doi:10.1002/nme.4325, to second order.
///
/// `Linear` is the symmetric form of variationally consistent integration. The four points integrate the
/// product of two linear fields exactly. The four moments are therefore the conditions
/// `sum_g w_g (phi_I,a q + phi_I q,a) = integral_faces phi_I q n_a` for q in {1, x, y, z}, solved for the
/// four corrected derivatives. The form of Chen, Hillman and Rueter (2013), doi:10.1002/nme.4512, corrects
/// only the test functions. Its stiffness is not symmetric, and every point needs two tables. It has no
/// strain energy, which dilation, Nitsche's supports and large strain require.
pub fn smoothed_rows(
    approximation: &Approximation,
    background: &Mesh,
    smoothing: Smoothing,
    face_points: usize,
) -> Result<(VolumeRows, MlsInfo), EfgError> {
    let (rows, info) = match smoothing {
        Smoothing::Constant => CellRows::new::<1>(approximation, background, face_points)?,
        Smoothing::Linear => CellRows::new::<4>(approximation, background, face_points)?,
    };
    let CellRows { rows: RowList { offsets, nodes, values, grads }, weights, points } = rows;
    let rows = Rows::new(approximation.nodes().len(), offsets, nodes, values, UNITY)?;
    Ok((VolumeRows::new(GradRows::new(points, rows, grads)?, weights)?, info))
}

/// Expresses the smoothed gradients of [`smoothed_rows`] at the points of [`crate::flux_rows`] on the same
/// facets. Each row combines the integration points of the cell behind the facet. The lengths are
/// `h = V / (c A)` with `V` (m^3) the volume of the cell, `A` (m^2) the area of all its listed facets, and
/// `c` = 1 for constant, 8/3 for linear gradients.
///
/// Nitsche's method with the penalty `beta = gamma (lambda + 2 mu) / h` is then definite for every
/// `gamma > 1`, for any overlap of supports and any Poisson's ratio. If the boundary stress used the
/// gradients of the shape functions themselves, no sufficient `gamma` would be known, because smoothing
/// averages a part of these gradients out of the energy.
pub fn smoothed_trace(
    background: &Mesh,
    facets: &[Facet],
    smoothing: Smoothing,
    face_points: usize,
) -> Result<TraceRows, EfgError> {
    let rule = triangle_rule(face_points)?;
    let mut areas = vec![0.0; background.cell_count()];
    for facet in facets {
        let (cell, face) = (facet.cell as usize, facet.face as usize);
        tet_measure(background, cell)?;
        let corners = local_corners(background, cell, face).map(|c| background.cell(cell)[c]);
        areas[cell] += vector_area(background, corners).norm();
    }
    let (mut offsets, mut points, mut coefficients) = (vec![0], Vec::new(), Vec::new());
    let mut lengths = Vec::with_capacity(facets.len() * rule.len());
    let count = smoothing.points_per_cell();
    for facet in facets {
        let cell = facet.cell as usize;
        let corners = local_corners(background, cell, facet.face as usize);
        let h = tet_measure(background, cell)?.0 / (smoothing.trace_constant() * areas[cell]);
        for xi in &rule.points {
            points.extend((count * cell..count * (cell + 1)).map(|q| q as u32));
            match smoothing {
                Smoothing::Constant => coefficients.push(1.0),
                Smoothing::Linear => coefficients.extend(from_four_points(face_basis(corners, xi))),
            }
            offsets.push(points.len());
            lengths.push(h);
        }
    }
    Ok(TraceRows::new(count * background.cell_count(), offsets, points, coefficients, lengths)?)
}

/// Returns the coefficients that interpolate linear fields from the four points of degree 2 to a point of
/// given barycentric coordinates. The points have the coordinate `a` once and `b` three times, so
/// `f(x) = sum_q (l_q - b) / (a - b) f(x_q)`.
fn from_four_points(barycentric: [f64; 4]) -> [f64; 4] {
    let basis = volume_basis::<4>();
    std::array::from_fn(|q| {
        let own = (0..4).max_by(|&i, &j| basis[q][i].total_cmp(&basis[q][j])).expect("four coordinates");
        let (a, b) = (basis[q][own], basis[q][(own + 1) % 4]);
        (barycentric[own] - b) / (a - b)
    })
}

/// Returns the region of the background at every point of [`smoothed_rows`].
pub fn smoothed_regions(background: &Mesh, smoothing: Smoothing) -> Vec<u16> {
    (0..background.cell_count())
        .flat_map(|cell| std::iter::repeat_n(background.region(cell), smoothing.points_per_cell()))
        .collect()
}

/// Tolerance of the row sums, which must be one. With sound supports the error is below 1e-14.
const UNITY: Unity = Unity::Within(1e-8);
