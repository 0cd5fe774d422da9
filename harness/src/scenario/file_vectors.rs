//! Directions of a material from vectors of the body's mesh file.

use cases::scene::MeshFile;
use geometry::{Mesh, Point3, Vector3};
use mesh_files::Vectors;
use shape::position_alone;

/// The mesh of a file with a vector for each of its cells or nodes.
pub struct FileVectors {
    mesh: Mesh,
    vectors: Vectors,
}

/// Size of an interpolated direction, relative to its unit vectors, below which they cancel.
const CANCELS: f64 = 1e-6;

impl FileVectors {
    /// Reads the mesh of the body's file and its array of this name.
    ///
    /// # Errors
    /// Returns a message if the file cannot be read, or if it has no array of vectors with this name.
    pub fn read(file: &MeshFile, name: &str) -> Result<FileVectors, String> {
        let found = mesh_files::read_vectors(&file.path, file.unit, name);
        let (mesh, vectors) = found.map_err(|bad| format!("can't be read: {bad}"))?;
        Ok(FileVectors { mesh, vectors })
    }

    /// Returns the unit direction at each point (m). A point outside the file's mesh takes that of the nearest point
    /// of its surface.
    ///
    /// Vectors of cells are constant in each cell. Vectors of nodes are made unit vectors and interpolated by the
    /// shape functions of the cell. A direction has no sign, so each vector that points away from that of the node
    /// with the largest shape value is turned first.
    ///
    /// # Errors
    /// Returns a message that names the cell or node, with its position, if a vector needed here is missing, zero or
    /// not finite, or if the vectors of a cell's nodes cancel.
    pub fn at(&self, points: &[Point3]) -> Result<Vec<Vector3>, String> {
        if self.vectors.of_cells {
            let cells = fem::nearest_cells(&self.mesh, points).map_err(|bad| bad.to_string())?;
            return cells.iter().map(|&(cell, _)| self.unit(cell)).collect();
        }
        let (rows, _) = fem::nearest_point_rows(&self.mesh, points).map_err(|bad| bad.to_string())?;
        (0..points.len())
            .map(|q| {
                let (nodes, values) = rows.rows().row(q);
                self.interpolated(nodes, values, &points[q])
            })
            .collect()
    }

    /// Unit vector of a cell or node.
    fn unit(&self, index: usize) -> Result<Vector3, String> {
        let what = if self.vectors.of_cells { "cell" } else { "node" };
        let centre = || match self.vectors.of_cells {
            true => {
                let points: Vec<Point3> = self.mesh.cell_points(index).copied().collect();
                Point3::from(points.iter().map(|p| p.coords).sum::<Vector3>() / points.len() as f64)
            }
            false => self.mesh.points()[index],
        };
        let refuse = |problem: &str| {
            let number = self.vectors.numbers[index];
            Err(format!("{problem} {what} {number} of the file, {}", position_alone(&centre())))
        };
        let Some(vector) = self.vectors.vectors[index] else { return refuse("has no vector for") };
        if !vector.iter().all(|c| c.is_finite()) {
            return refuse("is not finite at");
        }
        match vector.amax() {
            0.0 => refuse("is zero at"),
            // The scale avoids an overflow or underflow of the squares.
            largest => Ok((vector / largest).normalize()),
        }
    }

    fn interpolated(&self, nodes: &[u32], values: &[f64], at: &Point3) -> Result<Vector3, String> {
        let largest = (0..nodes.len()).max_by(|&i, &j| values[i].total_cmp(&values[j])).unwrap_or(0);
        let first = self.unit(nodes[largest] as usize)?;
        let mut sum = Vector3::zeros();
        for (&node, value) in nodes.iter().zip(values).filter(|(_, value)| **value != 0.0) {
            let vector = self.unit(node as usize)?;
            sum += vector * (value * if vector.dot(&first) < 0.0 { -1.0 } else { 1.0 });
        }
        sum.try_normalize(CANCELS)
            .ok_or_else(|| format!("has vectors at the nodes of a cell that cancel, {}", position_alone(at)))
    }
}

#[cfg(test)]
mod tests {
    use geometry::CellKind;
    use geometry::generate::box_mesh;

    use super::*;

    fn on_a_box(of_cells: bool, vector: impl Fn(usize, &Point3) -> Option<Vector3>) -> FileVectors {
        let mesh = box_mesh(
            CellKind::Hex20,
            Point3::origin(),
            Point3::new(2.0, 1.0, 1.0),
            [2, 1, 1],
            [1.0; 3],
            None,
        );
        let mesh = mesh.unwrap();
        let at: Vec<Point3> = if of_cells {
            let centre =
                |cell| Point3::from(mesh.cell_points(cell).map(|p| p.coords).sum::<Vector3>() / 20.0);
            (0..mesh.cell_count()).map(centre).collect()
        } else {
            mesh.points().to_vec()
        };
        let vectors = at.iter().enumerate().map(|(index, p)| vector(index, p)).collect();
        let numbers = (0..at.len() as u64).map(|index| index + 100).collect();
        FileVectors { mesh, vectors: Vectors { of_cells, numbers, vectors } }
    }

    /// A fibre and its opposite are the same: signs that change from node to node change nothing.
    #[test]
    fn signs_of_nodes_do_not_matter() {
        let direction = |p: &Point3| Vector3::new((0.3 * p.x).cos(), (0.3 * p.x).sin(), 0.0);
        let points = [Point3::new(0.3, 0.4, 0.2), Point3::new(1.7, 0.9, 0.5)];
        let plain = on_a_box(false, |_, p| Some(2.0 * direction(p))).at(&points).unwrap();
        let sign = |node: usize| if node.is_multiple_of(3) { -1.0 } else { 1.0 };
        let mixed = on_a_box(false, |node, p| Some(sign(node) * direction(p))).at(&points).unwrap();
        for ((a, b), p) in plain.iter().zip(&mixed).zip(&points) {
            assert!((a.dot(b).abs() - 1.0).abs() < 1e-14, "{a} {b}");
            assert!((a.norm() - 1.0).abs() < 1e-14);
            // Quadratic functions follow the turn of 0.3 rad per cell to 0.3^3 / 125.
            assert!((a - direction(p)).norm() < 3e-4, "{a}");
        }
    }

    #[test]
    fn a_point_takes_the_vector_of_its_cell_or_of_the_nearest() {
        let vectors = on_a_box(true, |cell, _| Some(Vector3::new(1.0, cell as f64, 0.0)));
        let found = vectors.at(&[Point3::new(0.9, 0.5, 0.5), Point3::new(3.0, 0.5, 0.5)]).unwrap();
        assert_eq!(found[0], Vector3::x());
        assert!((found[1] - Vector3::new(1.0, 1.0, 0.0).normalize()).norm() < 1e-15);
    }

    #[test]
    fn vectors_that_are_no_direction_are_refused_where_they_are_needed() {
        let bad = |of_cells, value: Option<Vector3>| {
            let vectors = on_a_box(of_cells, |k, _| if k == 1 { value } else { Some(Vector3::x()) });
            let near = vectors.at(&[Point3::new(0.5, 0.5, 0.5)]);
            (near, vectors.at(&[Point3::new(1.5, 0.5, 0.5)]).unwrap_err())
        };
        let (near, far) = bad(true, Some(Vector3::zeros()));
        assert!(near.is_ok());
        assert!(far.starts_with("is zero at cell 101 of the file, "), "{far}");
        let far = bad(true, None).1;
        assert!(far.starts_with("has no vector for cell 101 of the file, "), "{far}");
        let far = bad(true, Some(Vector3::new(f64::NAN, 0.0, 1.0))).1;
        assert!(far.starts_with("is not finite at cell 101 of the file, "), "{far}");
        let vectors = on_a_box(false, |k, _| Some(if k == 2 { Vector3::zeros() } else { Vector3::x() }));
        let message = vectors.at(&[Point3::new(0.5, 0.5, 0.5), Point3::new(1.5, 0.5, 0.5)]).unwrap_err();
        assert!(message.starts_with("is zero at node 102 of the file, "), "{message}");
        // Vectors across each other at equal weights do not cancel; opposite ones are the same direction.
        let tiny =
            on_a_box(false, |k, _| Some(Vector3::new(1e-300, 0.0, 0.0) * if k > 4 { -1.0 } else { 1.0 }));
        assert!((tiny.at(&[Point3::new(0.5, 0.5, 0.5)]).unwrap()[0].x.abs() - 1.0).abs() < 1e-14);
    }
}
