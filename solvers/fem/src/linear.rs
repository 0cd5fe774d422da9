//! Linear mesh of a quadratic mesh.

use geometry::Mesh;
use shape::{Coarser, Rows, Unity};

use crate::error::FemError;

/// Returns the interpolation from the corners of a mesh with quadratic cells to all its nodes, or `None` for
/// a mesh of linear cells alone. The corners of all cells are the nodes of the coarser, linear mesh. The
/// linear function of a corner is 1 at the corner and 1/2 at the mid-edge nodes of its edges.
///
/// # Errors
///
/// [`FemError::Shape`] if the rows fail their checks.
pub fn linear_nodes(mesh: &Mesh) -> Result<Option<Coarser>, FemError> {
    const NONE: u32 = u32::MAX;
    let nodes = mesh.points().len();
    let cells = || 0..mesh.cell_count();
    if cells().all(|cell| mesh.kind(cell).order() == 1) {
        return Ok(None);
    }
    let mut ends = vec![[NONE; 2]; nodes];
    for cell in cells() {
        let (kind, of_cell) = (mesh.kind(cell), mesh.cell(cell));
        of_cell[..kind.corner_count()].iter().for_each(|&corner| ends[corner as usize] = [corner; 2]);
        if kind.order() == 2 {
            for (&middle, edge) in of_cell[kind.corner_count()..].iter().zip(kind.edges()) {
                let mut edge = edge.map(|end| of_cell[end]);
                edge.sort_unstable();
                ends[middle as usize] = edge;
            }
        }
    }
    let mut number = vec![NONE; nodes];
    let places: Vec<u32> = (0..nodes as u32).filter(|&i| ends[i as usize] == [i; 2]).collect();
    places.iter().zip(0..).for_each(|(&place, coarse)| number[place as usize] = coarse);
    let (mut offsets, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for (i, [first, second]) in ends.iter().enumerate() {
        if *first == i as u32 {
            columns.push(number[i]);
            values.push(1.0);
        } else if *first != NONE {
            columns.extend([number[*first as usize], number[*second as usize]]);
            values.extend([0.5, 0.5]);
        }
        offsets.push(columns.len());
    }
    // A node without a cell has an empty row.
    let rows = Rows::new(places.len(), offsets, columns, values, Unity::NotPromised)?;
    Ok(Some(Coarser { rows, places }))
}

#[cfg(test)]
mod tests {
    use geometry::{CellKind, generate::box_mesh};
    use shape::Point3;

    use super::*;

    #[test]
    fn a_linear_field_of_the_corners_is_that_at_all_nodes() {
        let max = Point3::new(3.0, 2.0, 1.0);
        for kind in [CellKind::Tet10, CellKind::Hex20] {
            let mesh = box_mesh(kind, Point3::origin(), max, [3, 2, 2], [1.0; 3], None).unwrap();
            let Coarser { rows, places } = linear_nodes(&mesh).unwrap().expect("quadratic");
            assert_eq!(places.len(), 4 * 3 * 3, "{kind:?}");
            let field = |x: &Point3| 1.0 + 2.0 * x.x - 3.0 * x.y + 5.0 * x.z;
            for (i, x) in mesh.points().iter().enumerate() {
                let (nodes, values) = rows.row(i);
                let of_corners: f64 = nodes
                    .iter()
                    .zip(values)
                    .map(|(&n, v)| v * field(&mesh.points()[places[n as usize] as usize]))
                    .sum();
                assert!((of_corners - field(x)).abs() < 1e-14, "{kind:?} node {i}: {of_corners}");
            }
        }
    }

    #[test]
    fn linear_cells_have_no_coarser_mesh() {
        let mesh =
            box_mesh(CellKind::Hex8, Point3::origin(), Point3::new(1.0, 1.0, 1.0), [2; 3], [1.0; 3], None);
        assert_eq!(linear_nodes(&mesh.unwrap()).unwrap(), None);
    }
}
