//! Volume quadrature rows of a mesh, in cell order: the points of cell 0, then of cell 1, and so on.

use std::ops::Range;

use geometry::element::{Element, Points, with_element};
use geometry::quadrature::Rule;
use geometry::{CellKind, Mesh, Point3, Vector3};
use rayon::prelude::*;
use shape::{DilationGroups, GradRows, Layout, Rows, Unity, VolumeRows};

use crate::error::FemError;
use crate::map::{Nodes, cofactors, inverse, physical};
use crate::rule::VolumeRule;

/// Tolerance of the sum of shape values, which is one within a few last bits (20 terms of size 1: some
/// 1e-15).
pub(crate) const UNITY: Unity = Unity::Within(1e-12);

/// Cells per task: fixed, so that the work is divided in the same way at any thread count.
const CHUNK: usize = 512;

/// Cells per block of rows that are used once: some 50 MB for hex20, with work for 16 threads.
const BLOCK: usize = 16 * CHUNK;

/// Returns shape values, gradients (1/m) and weights `w det J` (m^3) at the quadrature points of every cell.
///
/// Rows have the cell's nodes in the cell's order. The cells are processed in parallel and each writes its
/// own rows, so the bits do not depend on the number of threads.
///
/// # Errors
///
/// [`FemError::InvertedElement`] with the first cell that has `det J <= 0` at one of its points. A quadratic
/// cell can also fold at a corner, between these points: [`geometry::quality::check`] examines the corners
/// too.
pub fn volume_rows(mesh: &Mesh, rule: &VolumeRule) -> Result<VolumeRows, FemError> {
    let rows = rows_of(mesh, &tabulate(mesh, rule)?, 0..mesh.cell_count())?;
    Ok(rows.laid_out(layout(mesh, rule))?)
}

/// Calls `visit` with the rows of [`volume_rows`] in blocks of [`BLOCK`] cells, which take little memory.
pub(crate) fn volume_blocks(
    mesh: &Mesh,
    rule: &VolumeRule,
    visit: &mut dyn FnMut(&VolumeRows),
) -> Result<(), FemError> {
    let tables = tabulate(mesh, rule)?;
    for first in (0..mesh.cell_count()).step_by(BLOCK) {
        visit(&rows_of(mesh, &tables, first..(first + BLOCK).min(mesh.cell_count()))?);
    }
    Ok(())
}

/// Returns the rows of a range of cells, without a known structure.
fn rows_of(
    mesh: &Mesh,
    tables: &[Table; CellKind::ALL.len()],
    cells: Range<usize>,
) -> Result<VolumeRows, FemError> {
    let entries_of = |cell: usize| mesh.kind(cell).node_count();
    let points_of = |cell: usize| tables[mesh.kind(cell) as usize].weights.len();

    let mut offsets = vec![0];
    for cell in cells.clone() {
        let (n, mut at) = (entries_of(cell), *offsets.last().unwrap_or(&0));
        for _ in 0..points_of(cell) {
            at += n;
            offsets.push(at);
        }
    }
    let rows = offsets.len() - 1;
    let entries = *offsets.last().unwrap_or(&0);
    let mut points = vec![Point3::origin(); rows];
    let mut weights = vec![0.0; rows];
    let mut nodes = vec![0; entries];
    let mut values = vec![0.0; entries];
    let mut grads = vec![Vector3::zeros(); entries];

    let mut rest = Slots {
        cells: 0..0,
        points: &mut points,
        weights: &mut weights,
        nodes: &mut nodes,
        values: &mut values,
        grads: &mut grads,
    };
    let mut chunks = Vec::with_capacity(cells.len().div_ceil(CHUNK));
    for first in cells.clone().step_by(CHUNK) {
        let cells = first..(first + CHUNK).min(cells.end);
        let rows = cells.clone().map(points_of).sum();
        let entries = cells.clone().map(|cell| points_of(cell) * entries_of(cell)).sum();
        chunks.push(rest.split_off(cells, rows, entries));
    }
    let results: Vec<Result<(), FemError>> =
        chunks.into_par_iter().map(|chunk| chunk.fill(mesh, tables)).collect();
    // Errors are taken in chunk order, so that the reported cell does not depend on which thread was first.
    results.into_iter().collect::<Result<(), FemError>>()?;

    let rows = Rows::new(mesh.points().len(), offsets, nodes, values, UNITY)?;
    Ok(VolumeRows::new(GradRows::new(points, rows, grads)?, weights)?)
}

/// Returns the known structure of the rows of a mesh.
fn layout(mesh: &Mesh, rule: &VolumeRule) -> Layout {
    match mesh.uniform_kind() {
        Some(CellKind::Tet4) => Layout::LinearTetrahedra,
        Some(kind) => Layout::Cells { nodes: kind.node_count(), points: rule.points(kind) },
        None => Layout::General,
    }
}

/// Returns the cell of every quadrature point of [`volume_rows`] with the same rule.
pub fn cell_of_point(mesh: &Mesh, rule: &VolumeRule) -> Vec<u32> {
    (0..mesh.cell_count())
        .flat_map(|cell| std::iter::repeat_n(cell as u32, rule.points(mesh.kind(cell))))
        .collect()
}

/// Returns the region index of every quadrature point of [`volume_rows`] with the same rule.
pub fn regions(mesh: &Mesh, rule: &VolumeRule) -> Vec<u16> {
    (0..mesh.cell_count())
        .flat_map(|cell| std::iter::repeat_n(mesh.region(cell), rule.points(mesh.kind(cell))))
        .collect()
}

/// Returns one dilation group per cell, for [`volume_rows`] with the same rule: mean dilation (B-bar with one
/// constant volume change per element; Nagtegaal, Parks & Rice 1974, Hughes 1980).
///
/// # Errors
///
/// [`FemError::Shape`] if the groups fail their checks.
pub fn element_dilation(mesh: &Mesh, rule: &VolumeRule) -> Result<DilationGroups, FemError> {
    let points = (0..mesh.cell_count()).map(|cell| rule.points(mesh.kind(cell)));
    Ok(DilationGroups::of_cells(points)?)
}

/// Returns the rows of the continuous pressure of Taylor-Hood elements (tet10/P1; Taylor & Hood 1973).
///
/// These are the linear shape values of each cell's corners at the points of [`volume_rows`]
/// with the same rule. Their nodes are the corner nodes only, numbered in the order of the mesh. A corner
/// between several materials counts as one node per material. `alike` holds the material of each region, or
/// is empty if all regions have the same material.
///
/// # Errors
///
/// [`FemError::Shape`] if the rows fail their checks.
pub fn pressure_rows(mesh: &Mesh, rule: &VolumeRule, alike: &[u16]) -> Result<Rows, FemError> {
    let materials = alike.iter().max().map_or(1, |&material| usize::from(material) + 1);
    let place = |cell: usize, node: u32| {
        let material = alike.get(usize::from(mesh.region(cell))).map_or(0, |&material| usize::from(material));
        node as usize * materials + material
    };
    let mut number = vec![u32::MAX; mesh.points().len() * materials];
    for cell in 0..mesh.cell_count() {
        for &node in &mesh.cell(cell)[..mesh.kind(cell).corner_count()] {
            number[place(cell, node)] = 0;
        }
    }
    let mut count = 0;
    for n in number.iter_mut().filter(|n| **n == 0) {
        *n = count;
        count += 1;
    }
    let (mut offsets, mut nodes, mut values) = (vec![0], Vec::new(), Vec::new());
    for cell in 0..mesh.cell_count() {
        let kind = mesh.kind(cell);
        let corners = &mesh.cell(cell)[..kind.corner_count()];
        let linear = kind.of_order(1).expect("every shape has a linear kind");
        for &xi in &rule.rule(kind)?.points {
            nodes.extend(corners.iter().map(|&n| number[place(cell, n)]));
            with_element!(linear, E, N => values.extend(<E as Element<N>>::shape(xi)));
            offsets.push(nodes.len());
        }
    }
    Ok(Rows::new(count as usize, offsets, nodes, values, UNITY)?)
}

/// Shape values and reference gradients at the points of a rule for one kind, one point after another.
#[derive(Default)]
struct Table {
    weights: Vec<f64>,
    values: Vec<f64>,
    grads: Vec<[f64; 3]>,
    /// Rule that integrates the gradients of curved cells, if this one does in straight cells only.
    exact: Option<Box<Table>>,
}

impl Table {
    fn new(kind: CellKind, rule: Rule<3>) -> Table {
        let mut table = Table { weights: rule.weights, ..Table::default() };
        with_element!(kind, E, N => {
            for &xi in &rule.points {
                table.values.extend(<E as Element<N>>::shape(xi));
                table.grads.extend(<E as Element<N>>::shape_grad(xi));
            }
        });
        table
    }
}

impl<const N: usize> Nodes<N> {
    /// Changes weights and gradients of a curved cell, so that their sums `sum w` and `sum w grad N` become
    /// the integrals of 1 and `grad N`.
    ///
    /// All gradients of a node get the same shift; those of a linear field remain exact. Without it a
    /// constant stress loads inner nodes of curved tet10 cells, where `det J grad N` is cubic and 4 points
    /// integrate squares: the patch test of a filled ellipsoid has an error of 1.1e-5. Eight points pass it
    /// too, but lock: a thick sphere at nu = 0.4999 gets 2 to 4 times the error. This is variationally
    /// consistent integration (Chen, Hillman & Rueter, IJNME 95, 2013) of degree 1.
    #[cold]
    #[inline(never)]
    fn keep_integrals(&self, exact: &Table, weights: &mut [f64], grads: &mut [[Vector3; N]]) {
        let mut volume = 0.0;
        let mut shift = [Vector3::zeros(); N];
        for (w, dn) in exact.weights.iter().zip(exact.grads.as_chunks::<N>().0) {
            let (det_j, c) = cofactors(&self.tangents(dn));
            volume += w * det_j;
            for a in 0..N {
                shift[a] += *w * physical(&dn[a], &c);
            }
        }
        let scale = volume / weights.iter().sum::<f64>();
        for (w, g) in weights.iter_mut().zip(grads.iter()) {
            *w *= scale;
            for a in 0..N {
                shift[a] -= *w * g[a];
            }
        }
        for (g, shift) in grads.iter_mut().flat_map(|g| g.iter_mut().zip(&shift)) {
            *g += shift / volume;
        }
    }
}

/// Tabulates one table per kind, indexed by `CellKind as usize`; tables of kinds that the mesh does not use
/// stay empty.
fn tabulate(mesh: &Mesh, rule: &VolumeRule) -> Result<[Table; CellKind::ALL.len()], FemError> {
    let mut tables: [Table; CellKind::ALL.len()] = Default::default();
    for kind in CellKind::ALL {
        if (0..mesh.cell_count()).any(|cell| mesh.kind(cell) == kind) {
            let (Points { full, volume, .. }, at) = (kind.entry().points, rule.points(kind));
            let mut table = Table::new(kind, rule.rule(kind)?);
            if at == full && full < volume {
                let exact = rule.with(kind, volume)?.rule(kind)?;
                table.exact = Some(Box::new(Table::new(kind, exact)));
            }
            tables[kind as usize] = table;
        }
    }
    Ok(tables)
}

/// Part of the arrays that belongs to one run of cells.
struct Slots<'a> {
    cells: Range<usize>,
    points: &'a mut [Point3],
    weights: &'a mut [f64],
    nodes: &'a mut [u32],
    values: &'a mut [f64],
    grads: &'a mut [Vector3],
}

impl<'a> Slots<'a> {
    fn split_off(&mut self, cells: Range<usize>, rows: usize, entries: usize) -> Slots<'a> {
        fn take<'a, T>(slice: &mut &'a mut [T], n: usize) -> &'a mut [T] {
            let (head, tail) = std::mem::take(slice).split_at_mut(n);
            *slice = tail;
            head
        }
        Slots {
            cells,
            points: take(&mut self.points, rows),
            weights: take(&mut self.weights, rows),
            nodes: take(&mut self.nodes, entries),
            values: take(&mut self.values, entries),
            grads: take(&mut self.grads, entries),
        }
    }

    fn fill(mut self, mesh: &Mesh, tables: &[Table; CellKind::ALL.len()]) -> Result<(), FemError> {
        for cell in self.cells.clone() {
            let kind = mesh.kind(cell);
            let table = &tables[kind as usize];
            let q = table.weights.len();
            let mut own = self.split_off(cell..cell + 1, q, q * kind.node_count());
            with_element!(kind, _E, N => own.fill_cell::<N>(mesh, table)?);
        }
        Ok(())
    }

    /// Fills the rows of one cell: the trip count `N` is fixed, and nothing is allocated.
    fn fill_cell<const N: usize>(&mut self, mesh: &Mesh, table: &Table) -> Result<(), FemError> {
        let element = self.cells.start;
        let list = &mesh.cell(element).as_chunks::<N>().0[0];
        let x = Nodes::gather(mesh, list);
        let (n, dn) = (table.values.as_chunks::<N>().0, table.grads.as_chunks::<N>().0);
        let (nodes, values) = (self.nodes.as_chunks_mut::<N>().0, self.values.as_chunks_mut::<N>().0);
        let grads = self.grads.as_chunks_mut::<N>().0;
        // J at the first point (m), and the sum of the squared differences from it at the others.
        let (mut first, mut differs) = ([Vector3::zeros(); 3], 0.0);
        for q in 0..table.weights.len() {
            let t = x.tangents(&dn[q]);
            if table.exact.is_some() {
                match q {
                    0 => first = t,
                    _ => differs += (0..3).map(|k| (t[k] - first[k]).norm_squared()).sum::<f64>(),
                }
            }
            let (det_j, grad_xi) =
                inverse(&t).map_err(|det_j| FemError::InvertedElement { element, det_j })?;
            for a in 0..N {
                grads[q][a] = physical(&dn[q][a], &grad_xi);
            }
            values[q] = n[q];
            nodes[q] = *list;
            self.points[q] = x.position(&n[q]);
            self.weights[q] = table.weights[q] * det_j;
        }
        // J of tet10 is linear in xi: four points show whether the cell is curved, beyond rounding.
        if let Some(exact) = &table.exact
            && differs > 1e-20 * first.iter().map(|t| t.norm_squared()).sum::<f64>()
        {
            x.keep_integrals(exact, self.weights, grads);
        }
        Ok(())
    }
}
