//! Energy, forces and rows of the hourglass control of a quadrature.

use crate::Vector3;
use crate::hourglass::HOURGLASS_MODES;
use crate::rows::{Rows, Unity};
use crate::tables::VolumeRows;

impl VolumeRows {
    /// Returns the rows `gamma_m` of all cells (dimensionless), four for each cell; `None` without hourglass
    /// control.
    pub fn hourglass_rows(&self) -> Option<Rows> {
        let control = self.hourglass()?;
        let (mut nodes, mut values) = (Vec::new(), Vec::new());
        for cell in 0..control.len() {
            let (of_cell, grads) = self.row(cell);
            for vector in control.vectors(cell, grads) {
                nodes.extend_from_slice(of_cell);
                values.extend_from_slice(&vector);
            }
        }
        let offsets = (0..=HOURGLASS_MODES * control.len()).map(|row| 8 * row).collect();
        let rows = Rows::new(self.rows().node_count(), offsets, nodes, values, Unity::NotPromised);
        Some(rows.expect("rows of checked cells are sound"))
    }

    /// Returns the hourglass energy (J) at nodal displacements `u` (m), which is zero without hourglass control.
    /// `moduli` gives the Lame moduli `lambda` and `mu` (Pa) of a point.
    pub fn hourglass_energy(&self, moduli: impl Fn(usize) -> [f64; 2], u: &[Vector3]) -> f64 {
        self.hourglass_energies(moduli, u).sum()
    }

    /// Iterates over the hourglass energies (J) of the cells, as [`VolumeRows::hourglass_energy`] sums them;
    /// nothing without hourglass control.
    pub fn hourglass_energies(
        &self,
        moduli: impl Fn(usize) -> [f64; 2],
        u: &[Vector3],
    ) -> impl Iterator<Item = f64> {
        let cells =
            self.hourglass().into_iter().flat_map(|control| (0..control.len()).map(move |c| (control, c)));
        cells.map(move |(control, cell)| {
            let q = control.amplitudes(cell, self.row(cell), u);
            0.5 * control.stiffness(cell, moduli(cell)) * q.iter().map(Vector3::norm_squared).sum::<f64>()
        })
    }

    /// Adds the derivative of [`VolumeRows::hourglass_energy`] to the nodal forces `f`, N.
    pub fn add_hourglass_forces(&self, moduli: impl Fn(usize) -> [f64; 2], u: &[Vector3], f: &mut [Vector3]) {
        let Some(control) = self.hourglass() else { return };
        for cell in 0..control.len() {
            let (nodes, grads) = self.row(cell);
            let q = control.amplitudes(cell, (nodes, grads), u);
            let stiffness = control.stiffness(cell, moduli(cell));
            let vectors = control.vectors(cell, grads);
            for (a, &node) in nodes.iter().enumerate() {
                let sum: Vector3 = q.iter().zip(&vectors).map(|(q, vector)| q * vector[a]).sum();
                f[node as usize] += sum * stiffness;
            }
        }
    }
}
