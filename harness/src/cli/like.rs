//! Results by the numbers that a model gives its nodes and elements, for `fields --like`.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use geometry::Mesh;

use crate::outcome::States;
use crate::scenario::Scenario;

/// Adds a line of a table.
fn line<'a>(table: &mut String, number: u64, values: impl Iterator<Item = &'a f64>) {
    // Writing to a string cannot fail.
    let _ = write!(table, "{number}");
    for value in values {
        let _ = write!(table, ",{value:e}");
    }
    table.push('\n');
}

/// A mesh file with its numbers.
pub(super) struct Like {
    file: PathBuf,
    mesh: Mesh,
    /// Of the nodes and of the cells.
    numbers: [Vec<u64>; 2],
}

impl Like {
    /// Reads the file. Its unit does not matter, because only its cells are compared.
    pub(super) fn read(file: &Path) -> Result<Like, String> {
        let (mesh, rows) = mesh_files::read_numbered(file, 1.0).map_err(|bad| bad.to_string())?;
        let numbers = [rows.nodes, rows.cells].map(|rows| rows.iter().map(|row| row.tag).collect());
        Ok(Like { file: file.into(), mesh, numbers })
    }

    /// Gives the states the numbers of the file, and returns tables of their end: node with position (m),
    /// displacement (m) and reaction (N), and element with mean stress (Pa) and volume ratio.
    pub(super) fn number(&self, states: &mut States) -> Vec<(&'static str, String)> {
        states.numbers.clone_from(&self.numbers);
        let [nodes, elements] = &self.numbers;
        let (Some(end), points) = (states.states.last(), states.mesh().points()) else {
            return Vec::new();
        };
        let mut table = String::from("node,x,y,z,u_x,u_y,u_z");
        table += if states.reaction.is_empty() { "\n" } else { ",r_x,r_y,r_z\n" };
        for (i, number) in nodes.iter().enumerate() {
            let vectors = [Some(&points[i].coords), Some(&end.displacement[i]), states.reaction.get(i)];
            line(&mut table, *number, vectors.into_iter().flatten().flatten());
        }
        let mut tables = vec![("nodes", table)];
        if let Some(tensors) = &end.tensors {
            let mut table = String::from("element,s_xx,s_yy,s_zz,s_xy,s_yz,s_zx,det_f\n");
            for ((number, stress), det_f) in elements.iter().zip(tensors.components()).zip(&tensors.det_f) {
                line(&mut table, *number, stress.iter().chain([det_f]));
            }
            tables.push(("elements", table));
        }
        tables
    }

    /// Refuses a method whose mesh has other cells, before it runs.
    pub(super) fn fits(&self, scenario: &Scenario) -> Result<(), String> {
        let method = scenario.discretise().map_err(|bad| bad.to_string())?;
        let own = method.mesh();
        let (file, theirs) = (self.file.display(), &self.mesh);
        let counts = [own, theirs].map(|mesh| [mesh.points().len(), mesh.cell_count()]);
        let same = |cell: usize| own.kind(cell) == theirs.kind(cell) && own.cell(cell) == theirs.cell(cell);
        if counts[0] == counts[1] && (0..own.cell_count()).all(same) {
            return Ok(());
        }
        let [[nodes, cells], [of_file, cells_of_file]] = counts;
        Err(format!(
            "--like {file}: its {cells_of_file} cells on {of_file} nodes are not the {cells} cells on {nodes} nodes of \
             the method; give the method size = {{ file = \"{file}\", unit = \"mm\" }} with the file's unit"
        ))
    }
}
