//! Gauss points in the cells of a background mesh.

use geometry::quadrature::{self, Rule};
use geometry::{CellKind, Mesh};
use shape::VolumeRows;

use crate::approximation::Approximation;
use crate::cells::{hex_points, tet_points};
use crate::error::EfgError;
use crate::info::MlsInfo;

/// Rules of the two cell kinds for a number of points.
enum CellRule {
    Tet(Rule<3>),
    Hex(Rule<3>),
}

/// Computes shape values and gradients at `points_per_cell` points in every cell, in cell order, with weights
/// `w = w_ref det J` (m^3).
///
/// Tet4 cells take the symmetric rules of [`quadrature::tet`]; hex8 cells take `n^3` Gauss points. The nodes
/// of the cloud may differ from those of the mesh. Shape functions are rational and their supports overlap
/// cells arbitrarily, so no number of points integrates them exactly. A linear patch test is passed to 1e-3
/// with 4 points per tet4, not to rounding.
pub fn gauss_rows(
    approximation: &Approximation,
    background: &Mesh,
    points_per_cell: usize,
) -> Result<(VolumeRows, MlsInfo), EfgError> {
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    let mut known: Option<(CellKind, CellRule)> = None;
    for cell in 0..background.cell_count() {
        let kind = background.kind(cell);
        let rule = match known.take() {
            Some((of, rule)) if of == kind => rule,
            _ => rule(cell, kind, points_per_cell)?,
        };
        match &rule {
            CellRule::Tet(rule) => tet_points(background, cell, rule, &mut points, &mut weights)?,
            CellRule::Hex(rule) => hex_points(background, cell, rule, &mut points, &mut weights)?,
        }
        known = Some((kind, rule));
    }
    let cells =
        || (0..points_per_cell * background.cell_count()).map(|q| (q / points_per_cell) as u32).collect();
    let (at, info) = approximation.grad_rows_in(points, Some(&cells))?;
    Ok((VolumeRows::new(at, weights)?, info))
}

/// Returns the region of the background at every point of [`gauss_rows`].
pub fn gauss_regions(background: &Mesh, points_per_cell: usize) -> Vec<u16> {
    (0..background.cell_count())
        .flat_map(|cell| std::iter::repeat_n(background.region(cell), points_per_cell))
        .collect()
}

fn rule(cell: usize, kind: CellKind, points: usize) -> Result<CellRule, EfgError> {
    match kind {
        CellKind::Tet4 => quadrature::tet(points).map(CellRule::Tet).ok_or(EfgError::NoRule {
            what: "tetrahedron",
            points,
            offered: "see geometry::quadrature::TET_RULES",
        }),
        CellKind::Hex8 => {
            let n = (1..=10).find(|n| n * n * n == points);
            let offered = "1, 8, 27, .. 1000";
            n.map(|n| CellRule::Hex(quadrature::hex(n))).ok_or(EfgError::NoRule {
                what: "hexahedron",
                points,
                offered,
            })
        }
        _ => Err(EfgError::CellKind { cell, kind, what: "Gauss integration", allowed: "tet4 and hex8" }),
    }
}
