//! Displacement and stress at the probes.

use cases::exact::Exact;
use catalogue::metric;
use geometry::{Mesh, Point3, Vector3};
use shape::{PointRows, length, position};

use super::solved::Solved;
use super::stress::Recovered;
use crate::discretise::place;
use crate::error::{Failure, Key};
use crate::outcome::{Metric, Probe, push};

/// Refuses probes (m) outside the mesh, as [`check_points`] does.
pub(crate) fn check_probes(mesh: &Mesh, points: &[Point3]) -> Result<(), Failure> {
    check_points(mesh, points, |index| format!("output.probes[{index}]"))
}

/// Refuses points (m) that are farther from the mesh than the longest edge of the nearest cell. Closer points
/// may lie on a curved surface, which the cells approximate. They get the values and the distance of the
/// nearest point of the mesh.
pub(super) fn check_points(
    mesh: &Mesh,
    points: &[Point3],
    key: impl Fn(usize) -> String,
) -> Result<(), Failure> {
    if points.is_empty() {
        return Ok(());
    }
    for (index, ((cell, outside), x)) in fem::nearest_cells(mesh, points)?.into_iter().zip(points).enumerate()
    {
        if outside > width(mesh, cell) {
            let key = Key::Scene(key(index));
            let problem =
                format!("{} is {} outside the body", position(x, place::size(mesh)), length(outside));
            return Err(Failure::input(key, problem, "give a point of the undeformed body"));
        }
    }
    Ok(())
}

/// Probes of a run, evaluated in any of its states.
pub(super) struct Probes<'a> {
    mesh: &'a Mesh,
    points: &'a [Point3],
    /// Cell of each point and distance from it, m.
    cells: Vec<(usize, f64)>,
    /// Shape function values at the points; `None` without points.
    rows: Option<PointRows>,
}

impl<'a> Probes<'a> {
    /// Locates `points` (m) that [`check_probes`] accepts.
    pub fn new(run: &Solved<'a>, points: &'a [Point3]) -> Result<Probes<'a>, Failure> {
        let source = &run.prepared.source;
        let mesh = source.mesh();
        if points.is_empty() {
            return Ok(Probes { mesh, points, cells: Vec::new(), rows: None });
        }
        let cells = fem::nearest_cells(mesh, points)?;
        Ok(Probes { mesh, points, cells, rows: Some(source.at_points(points)?.0) })
    }

    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Displacement and stress at the nodal parameters `u` (m).
    pub fn at(&self, u: &[Vector3], recovered: Option<&Recovered>) -> Vec<Probe> {
        let Some(rows) = &self.rows else { return Vec::new() };
        let stress = self.cells.iter().zip(self.points).enumerate().map(|(k, (&(cell, _), x))| {
            recovered.map(|recovered| recovered.at(x, self.mesh.region(cell), rows.rows().row(k)))
        });
        let field = rows.rows().apply(u);
        let each = self.points.iter().zip(field).zip(stress).zip(&self.cells);
        each.map(|(((&x, u), stress), &(_, outside))| Probe { x, u, stress, outside }).collect()
    }
}

/// Displacement and stress at `points` (m) at the end.
pub(crate) fn probes(
    run: &Solved,
    recovered: Option<&Recovered>,
    points: &[Point3],
) -> Result<Vec<Probe>, Failure> {
    Ok(Probes::new(run, points)?.at(&run.solution.u, recovered))
}

/// Fraction of the largest displacement below which an exact displacement is rounding.
const ROUNDING: f64 = 1e-12;

/// Adds the errors of probes against an exact solution; `u` is the displacement of all nodes, m.
pub(crate) fn probe_errors(metrics: &mut Vec<Metric>, probes: &[Probe], exact: &dyn Exact, u: &[Vector3]) {
    let least = ROUNDING * u.iter().map(Vector3::norm).fold(0.0, f64::max);
    let Some(first) = probes.first() else { return };
    let e = exact.displacement(&first.x);
    if e.norm() > least {
        push(metrics, &metric::TIP, first.u.dot(&e) / e.norm_squared());
    }
    let error = |p: &Probe| {
        let e = exact.displacement(&p.x);
        (e.norm() > least).then(|| (p.u - e).norm() / e.norm())
    };
    if let Some(worst) = probes.iter().filter_map(error).reduce(f64::max) {
        push(metrics, &metric::PROBE_ERROR, worst);
    }
}

/// Longest edge of a cell, m.
fn width(mesh: &Mesh, cell: usize) -> f64 {
    let points: Vec<&Point3> = mesh.cell_points(cell).collect();
    let lengths = mesh.kind(cell).edges().iter().map(|&[a, b]| (points[a] - points[b]).norm());
    lengths.fold(0.0, f64::max)
}
