//! Displacement and stress at the probes, both as the method itself has them.

use cases::exact::Exact;
use catalogue::metric;
use geometry::{Mesh, Point3, Vector3};
use shape::Matrix3;

use super::Solved;
use super::own_stress::OwnStress;
use crate::Failure;
use crate::discretise::gradients;
use crate::error::Key;
use crate::outcome::{Metric, Probe, push};
use crate::prepare::Prepared;

/// Refuses points (m) that are farther from the mesh than the nearest cell is wide. Nearer ones may be on a curved surface,
/// whose cells cut corners: they have the values of the nearest point of the mesh, and say how far that is.
pub(crate) fn check_probes(mesh: &Mesh, points: &[Point3]) -> Result<(), Failure> {
    if points.is_empty() {
        return Ok(());
    }
    for (index, ((cell, outside), x)) in fem::nearest_cells(mesh, points)?.into_iter().zip(points).enumerate()
    {
        if outside > width(mesh, cell) {
            let key = Key::Scene(format!("output.probes[{index}]"));
            let [x, y, z] = [x.x, x.y, x.z].map(|x| 1e3 * x);
            let problem = format!("({x:.4}, {y:.4}, {z:.4}) mm is {:.4} mm outside the body", 1e3 * outside);
            return Err(Failure::input(key, problem, "give a point of the undeformed body"));
        }
    }
    Ok(())
}

/// Values at `points` (m) that [`check_probes`] takes.
pub(crate) fn probes(run: &Solved, points: &[Point3]) -> Result<Vec<Probe>, Failure> {
    let Solved { method, setup, prepared, solution } = *run;
    if points.is_empty() {
        return Ok(Vec::new());
    }
    let cells = fem::nearest_cells(prepared.source.mesh(), points)?;
    let rows = prepared.source.gradients_at(points)?;
    let near: Vec<usize> =
        cells.iter().zip(points).map(|(&(cell, _), x)| quadrature_point(prepared, cell, x)).collect();
    let of_points = prepared.volume.rows.at().displacement_gradients(&solution.u);
    // Gradients smoothed over cells are the method's; those of its shape functions are not.
    let smoothed = prepared.source.trace(&[])?.is_some();
    let gradients = match smoothed {
        true => near.iter().map(|&q| of_points[q]).collect(),
        false => {
            if !method.interpolates {
                gradients::check(Key::Scene("output.probes".into()), method.nodes(), &rows)?;
            }
            rows.displacement_gradients(&solution.u)
        }
    };
    // What relaxes has the stress of its past, which is followed at quadrature points only.
    let stress: Vec<Option<Matrix3>> = match setup.relaxes() {
        true => vec![None; points.len()],
        false => {
            let own = OwnStress::new(&setup.laws, prepared, &of_points, &solution.pressure);
            near.iter().zip(&gradients).map(|(&q, h)| Some(own.at(q, h))).collect()
        }
    };
    let field = rows.rows().apply(&solution.u);
    let each = points.iter().zip(field).zip(stress).zip(&cells);
    Ok(each.map(|(((&x, u), stress), &(_, outside))| Probe { x, u, stress, outside }).collect())
}

/// Part of the largest displacement up to which an exact one is rounding.
const ROUNDING: f64 = 1e-12;

/// Errors of probes against an exact solution; `u` is the displacement of all nodes, m.
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

/// The longest edge of a cell, m.
fn width(mesh: &Mesh, cell: usize) -> f64 {
    let points: Vec<&Point3> = mesh.cell_points(cell).collect();
    let lengths = mesh.kind(cell).edges().iter().map(|&[a, b]| (points[a] - points[b]).norm());
    lengths.fold(0.0, f64::max)
}

/// The quadrature point nearest to `x` of those that share its law and, where they go by cells, its cell.
fn quadrature_point(prepared: &Prepared, cell: usize, x: &Point3) -> usize {
    let volume = &prepared.volume;
    let points = volume.rows.at().points();
    let region = prepared.source.mesh().region(cell);
    let shares = |q: &usize| volume.region.get(*q).is_none_or(|&r| r == region);
    let candidates = match prepared.source.points_per_cell() {
        Some(each) => each * cell..each * (cell + 1),
        None => 0..points.len(),
    };
    let far = |q: &usize| (points[*q] - x).norm_squared();
    candidates.filter(shares).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0)
}
