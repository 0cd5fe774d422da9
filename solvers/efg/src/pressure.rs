//! Pressure fields of clouds, on fewer nodes than the displacements.
//!
//! A pressure per node is too many: the field has motions of its own that no displacement excites, and its
//! values scatter. The pressure is interpolated from a third of the nodes, spread out by farthest-point
//! sampling, by linear moving least squares. The ratio is that of Taylor-Hood elements, roughly: a cube of
//! tet10 has an eighth.

use geometry::{Cloud, Mesh};
use shape::{Point3, Rows, Unity};

use crate::approximation::Approximation;
use crate::basis::Basis;
use crate::error::EfgError;
use crate::kernel::{CubicSpline, Kernel};
use crate::support::Support;

/// Nodes per node of the pressure.
const THINNING: usize = 3;
/// Support of a pressure node: a multiple of the distance to the fifth neighbour.
const SUPPORT: Support = Support::Neighbours { count: 5, factor: 2.4 };
/// Number of pressure nodes of a point. Only the largest values are kept, and scaled to a sum of one.
const NEAREST: usize = 8;
/// Deviation of a row's sum from one.
const UNITY: Unity = Unity::Within(1e-12);

/// Returns the shape values of the pressure at points (m) of a body. `regions` are those of the points, and
/// `alike` gives the material of each region; a pressure node has one value per material.
pub(crate) fn pressure_rows(
    nodes: Vec<Point3>,
    background: &Mesh,
    (regions, alike): (&[u16], &[u16]),
    points: &[Point3],
) -> Result<Rows, EfgError> {
    let count = nodes.len() / THINNING;
    let coarse = Cloud::from_points(nodes)?.thinned(count)?.points;
    let radii = SUPPORT.radii(&coarse, &[])?;
    let approximation = Approximation::new(coarse, radii, Kernel::CubicSpline(CubicSpline), Basis::Linear)?;
    let (rows, _) = approximation.within(background)?.point_rows(points)?;
    let materials = alike.iter().max().map_or(1, |&material| usize::from(material) + 1);
    let mut number = vec![None; count * materials];
    let (mut offsets, mut of_points, mut values, mut used) = (vec![0], Vec::new(), Vec::new(), 0);
    for q in 0..points.len() {
        let (near, shape) = rows.rows().row(q);
        let mut order: Vec<usize> = (0..near.len()).collect();
        // Equal values in the order of their nodes.
        order.sort_by(|&a, &b| shape[b].total_cmp(&shape[a]));
        order.truncate(NEAREST);
        order.sort_unstable();
        let sum: f64 = order.iter().map(|&k| shape[k]).sum();
        let region = regions.get(q).map_or(0, |&region| usize::from(region));
        let material = alike.get(region).map_or(0, |&material| usize::from(material));
        for k in order {
            let index = number[near[k] as usize * materials + material].get_or_insert_with(|| {
                used += 1;
                used - 1
            });
            of_points.push(*index);
            values.push(shape[k] / sum);
        }
        offsets.push(of_points.len());
    }
    Ok(Rows::new(used as usize, offsets, of_points, values, UNITY)?)
}

#[cfg(test)]
mod tests {
    use geometry::CellKind;
    use geometry::generate::box_mesh;

    use super::*;

    #[test]
    fn each_material_has_pressure_nodes_of_its_own() {
        let corners = (Point3::origin(), Point3::new(1.0, 1.0, 1.0));
        let mesh = box_mesh(CellKind::Tet4, corners.0, corners.1, [6; 3], [1.0; 3], None).unwrap();
        let points = [Point3::new(0.3, 0.4, 0.49), Point3::new(0.3, 0.4, 0.51), Point3::new(0.9, 0.1, 0.2)];
        let rows = |regions: &[u16], alike: &[u16]| {
            pressure_rows(mesh.points().to_vec(), &mesh, (regions, alike), &points).unwrap()
        };
        let one = rows(&[], &[]);
        let sums = (0..3).map(|q| one.row(q).1.iter().sum::<f64>());
        assert!(sums.into_iter().all(|sum| (sum - 1.0).abs() < 1e-12));
        assert!((0..3).all(|q| one.row(q).0.len() <= NEAREST));
        let share = |rows: &Rows| rows.row(0).0.iter().any(|node| rows.row(1).0.contains(node));
        assert!(share(&one));
        // Regions 0 and 2 have the same material.
        let two = rows(&[0, 1, 2], &[0, 1, 0]);
        assert!(!share(&two) && two.node_count() > one.node_count());
    }
}
