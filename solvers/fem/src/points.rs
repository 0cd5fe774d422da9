//! Rows at given points: probes, transfer targets, points of stress output.

use geometry::element::{Element, with_element};
use geometry::{Mesh, Point3, Vector3};
use rayon::prelude::*;
use shape::{GradRows, PointRows, Rows};

use crate::closest::Surface;
use crate::error::FemError;
use crate::locate::{Locator, Place};
use crate::map::{Nodes, inverse, physical};
use crate::volume::UNITY;

/// Points outside the mesh, which were replaced by the nearest point of its surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Outside {
    /// Pairs (index into the requested points, distance to the mesh in metres), by ascending index.
    pub points: Vec<(usize, f64)>,
}

impl Outside {
    /// Returns the index and the distance (m) of the farthest point, or `None` if no point is outside.
    pub fn farthest(&self) -> Option<(usize, f64)> {
        self.points.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Returns shape values at points of the mesh (m), by the inverse of the isoparametric map. A point on
/// several cells belongs to the cell of lowest index.
///
/// # Errors
///
/// [`FemError::Outside`] with the distance, if a point is outside by more than rounding, and
/// [`FemError::NotFinite`] if a point has a coordinate that is not finite.
pub fn point_rows(mesh: &Mesh, points: &[Point3]) -> Result<PointRows, FemError> {
    values(mesh, points, &inside(mesh, points)?)
}

/// Returns shape values and gradients (1/m) at points of the mesh, as [`point_rows`]. On a face, the
/// gradients are those of the cell of lowest index.
///
/// # Errors
///
/// As [`point_rows`], and [`FemError::InvertedElement`] if a cell is inverted at a point.
pub fn grad_rows(mesh: &Mesh, points: &[Point3]) -> Result<GradRows, FemError> {
    gradients(mesh, points, &inside(mesh, points)?)
}

/// Returns rows as [`point_rows`], but points outside take the values at the nearest point of the mesh
/// surface and are listed.
///
/// # Errors
///
/// [`FemError::NotFinite`] if a point has a coordinate that is not finite.
pub fn nearest_point_rows(mesh: &Mesh, points: &[Point3]) -> Result<(PointRows, Outside), FemError> {
    let (places, outside) = nearest(mesh, points)?;
    Ok((values(mesh, points, &places)?, outside))
}

/// Returns rows as [`grad_rows`], but points outside take values and gradients at the nearest point of the
/// mesh surface and are listed.
///
/// # Errors
///
/// As [`nearest_point_rows`], and [`FemError::InvertedElement`] if a cell is inverted at a point.
pub fn nearest_grad_rows(mesh: &Mesh, points: &[Point3]) -> Result<(GradRows, Outside), FemError> {
    let (places, outside) = nearest(mesh, points)?;
    Ok((gradients(mesh, points, &places)?, outside))
}

/// Returns the cell that contains each point, or the cell at the nearest point of the surface, with the
/// distance to the mesh (m, 0 inside).
///
/// # Errors
///
/// [`FemError::NotFinite`] if a point has a coordinate that is not finite.
pub fn nearest_cells(mesh: &Mesh, points: &[Point3]) -> Result<Vec<(usize, f64)>, FemError> {
    let (places, outside) = nearest(mesh, points)?;
    let mut found: Vec<(usize, f64)> = places.iter().map(|place| (place.cell, 0.0)).collect();
    outside.points.iter().for_each(|&(point, distance)| found[point].1 = distance);
    Ok(found)
}

fn inside(mesh: &Mesh, points: &[Point3]) -> Result<Vec<Place>, FemError> {
    let found = find(mesh, points)?;
    if let Some(point) = found.iter().position(Option::is_none) {
        let (_, distance) = Surface::new(mesh).closest(&points[point]);
        return Err(FemError::Outside { point, position: points[point].coords.into(), distance });
    }
    Ok(found.into_iter().flatten().collect())
}

fn nearest(mesh: &Mesh, points: &[Point3]) -> Result<(Vec<Place>, Outside), FemError> {
    let found = find(mesh, points)?;
    let missing: Vec<usize> = (0..points.len()).filter(|&i| found[i].is_none()).collect();
    let surface = (!missing.is_empty()).then(|| Surface::new(mesh));
    let closest: Vec<(Place, f64)> = match &surface {
        Some(surface) => missing.par_iter().map(|&i| surface.closest(&points[i])).collect(),
        None => Vec::new(),
    };
    let mut places = closest.iter().map(|c| c.0);
    let places = found.into_iter().filter_map(|place| place.or_else(|| places.next())).collect();
    let outside = missing.into_iter().zip(closest.iter().map(|c| c.1)).collect();
    Ok((places, Outside { points: outside }))
}

/// Finds one place per point, in parallel; the order of the result is that of the points.
fn find(mesh: &Mesh, points: &[Point3]) -> Result<Vec<Option<Place>>, FemError> {
    if let Some(point) = points.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
        return Err(FemError::NotFinite { point });
    }
    if points.is_empty() {
        return Ok(Vec::new());
    }
    let locator = Locator::new(mesh);
    Ok(points.par_iter().with_min_len(64).map(|p| locator.find(p)).collect())
}

fn values(mesh: &Mesh, points: &[Point3], places: &[Place]) -> Result<PointRows, FemError> {
    let (offsets, nodes) = pattern(mesh, places);
    let mut values = Vec::with_capacity(nodes.len());
    for place in places {
        with_element!(mesh.kind(place.cell), E, N => values.extend(<E as Element<N>>::shape(place.xi)));
    }
    let rows = Rows::new(mesh.points().len(), offsets, nodes, values, UNITY)?;
    Ok(PointRows::new(points.to_vec(), rows)?)
}

fn gradients(mesh: &Mesh, points: &[Point3], places: &[Place]) -> Result<GradRows, FemError> {
    let (offsets, nodes) = pattern(mesh, places);
    let mut values = Vec::with_capacity(nodes.len());
    let mut grads: Vec<Vector3> = Vec::with_capacity(nodes.len());
    for &Place { cell: element, xi } in places {
        with_element!(mesh.kind(element), E, N => {
            values.extend(<E as Element<N>>::shape(xi));
            let dn = <E as Element<N>>::shape_grad(xi);
            let x = Nodes::gather(mesh, &mesh.cell(element).as_chunks::<N>().0[0]);
            let (_, grad_xi) = inverse(&x.tangents(&dn))
                .map_err(|det_j| FemError::InvertedElement { element, det_j })?;
            grads.extend(dn.iter().map(|dn| physical(dn, &grad_xi)));
        });
    }
    let rows = Rows::new(mesh.points().len(), offsets, nodes, values, UNITY)?;
    Ok(GradRows::new(points.to_vec(), rows, grads)?)
}

/// Returns row starts and nodes: each row has the nodes of its cell, in the cell's order.
fn pattern(mesh: &Mesh, places: &[Place]) -> (Vec<usize>, Vec<u32>) {
    let mut offsets = vec![0];
    let mut nodes = Vec::new();
    for place in places {
        nodes.extend_from_slice(mesh.cell(place.cell));
        offsets.push(nodes.len());
    }
    (offsets, nodes)
}
