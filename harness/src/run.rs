//! One run: prepare, assemble, factor, solve (timed apart, repeated), then errors, probes and transfers.

use std::time::Instant;

use geometry::{Point3, Vector3};
use interp::Scheme;
use mechanics::{Body, Solution, assemble};
use reports::SurfaceField;

use crate::Failure;
use crate::discretise::Discretisation;
use crate::norms::{difference, exact_at, norms};
use crate::outcome::{Identity, Metric, Outcome, Probe, Size, Stage};
use crate::prepare::{Prepared, prepare};
use crate::setup::Setup;
use crate::timing::Timings;
use crate::transfer::transfers;
use crate::work::Work;

/// How often a run is repeated for its timings: at least once, until `seconds` are spent or `most` is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeats {
    /// Most repeats.
    pub most: usize,
    /// Time to spend, s.
    pub seconds: f64,
}

/// Displacement (m) of a finished run at any points (m).
pub type Evaluate = Box<dyn Fn(&[Point3]) -> Result<Vec<Vector3>, Failure> + Send + Sync>;

/// The displacement that errors are measured against where no exact solution is known.
pub struct Reference {
    /// Which method made it.
    pub method: String,
    /// Displacement at the scene's target points, m.
    pub targets: Vec<Vector3>,
    /// Evaluates the reference at any point, m.
    pub at: Evaluate,
}

/// What a scene wants of every run.
pub struct Asks<'a> {
    /// Probe positions, m.
    pub probes: &'a [Point3],
    /// Points where displacements are compared; the method's own nodes if empty.
    pub targets: &'a [Point3],
    /// Schemes that carry a cloud's displacement to the targets.
    pub schemes: &'a [(String, Scheme)],
    /// Whether the surface displacement is kept for pictures.
    pub picture: bool,
    /// Repeats of the timed part.
    pub repeats: Repeats,
    /// The reference, where one is known.
    pub reference: Option<&'a Reference>,
}

/// A finished run with its nodal parameters.
pub struct Solved {
    /// Identity, numbers, times.
    pub outcome: Outcome,
    /// Tables of the run.
    pub prepared: Prepared,
    /// Nodal parameters, m.
    pub u: Vec<Vector3>,
}

/// Runs one method.
pub fn run(
    identity: Identity,
    plan: Vec<Stage>,
    method: &Discretisation,
    setup: &Setup,
    asks: &Asks,
) -> Result<Solved, Failure> {
    crate::memory::reset_peak();
    let mut timings = Timings::default();
    let start = Instant::now();
    let (mut prepared, mut solution, mut work) = solve_once(method, setup, &mut timings)?;
    for _ in 1..asks.repeats.most {
        if start.elapsed().as_secs_f64() > asks.repeats.seconds {
            break;
        }
        (prepared, solution, work) = solve_once(method, setup, &mut timings)?;
    }
    let memory = crate::memory::peak();
    let field = displacement(method, &prepared, &solution.u, asks, &mut timings, &mut work)?;
    let mut phases = timings.summaries();
    phases.push(("total", timings.total()));

    let size = Size {
        nodes: method.nodes().len() as u64,
        elements: method.mesh().cell_count() as u64,
        points: prepared.volume.rows.weights().len() as u64,
        dofs: solution.info.dofs as u64,
        spacing: prepared.spacing,
    };
    let u = solution.u.clone();
    let mut metrics = Vec::new();
    measure(&mut metrics, method, setup, &prepared, &solution, field, asks)?;
    let probes = probes(method, setup, &prepared, &u, asks.probes)?;
    if let (Some(exact), Some(probe)) = (&setup.exact, probes.first()) {
        let e = exact.displacement(&probe.x);
        if e.norm() > 0.0 {
            push(&mut metrics, "tip", probe.u.dot(&e) / e.norm_squared(), "1");
        }
        let error = |p: &Probe| {
            let e = exact.displacement(&p.x);
            (e.norm() > 0.0).then(|| (p.u - e).norm() / e.norm())
        };
        if let Some(worst) = probes.iter().filter_map(error).reduce(f64::max) {
            push(&mut metrics, "probe-error", worst, "1");
        }
    }
    let transfers = match method {
        Discretisation::Efg(_) => transfers(method, &prepared, &u, asks, &mut work)?,
        Discretisation::Fem(_) => Vec::new(),
    };
    let field = if asks.picture { Some(picture(&identity, method, &prepared, &u)?) } else { None };
    let outcome = Outcome { identity, size, metrics, phases, memory, probes, plan, transfers, field, work };
    Ok(Solved { outcome, prepared, u })
}

fn solve_once(
    method: &Discretisation,
    setup: &Setup,
    timings: &mut Timings,
) -> Result<(Prepared, Solution, Work), Failure> {
    let mut work = Work::default();
    let prepared = timings.time("prepare", || prepare(method, setup, &mut work))?;
    let solution = {
        let (loads, weak) = (prepared.loads(), prepared.weak());
        let problem = prepared.problem(method.nodes(), setup, &loads, &weak);
        let assembled = timings.time("assemble", || assemble(&problem))?;
        work.assemblies += 1;
        let factored = timings.time("factor", || assembled.factor())?;
        work.factorisations += 1;
        let solution = timings.time("solve", || factored.solve(1.0))?;
        work.solves += 1;
        solution
    };
    Ok((prepared, solution, work))
}

/// Displacement (m) at the targets, and how many of these lie outside; at the method's own nodes without targets. There
/// the parameters of elements are displacements already, and nothing is evaluated.
fn displacement(
    method: &Discretisation,
    prepared: &Prepared,
    u: &[Vector3],
    asks: &Asks,
    timings: &mut Timings,
    work: &mut Work,
) -> Result<(Vec<Vector3>, usize), Failure> {
    let points = match (method, asks.targets.is_empty()) {
        (Discretisation::Fem(_), true) => return Ok((u.to_vec(), 0)),
        (Discretisation::Efg(_), true) => method.nodes(),
        (_, false) => asks.targets,
    };
    let once = || -> Result<_, Failure> {
        let (rows, outside) = method.at_points(&prepared.volume, points)?;
        Ok((rows.rows().apply(u), outside))
    };
    work.transfer_rows += points.len() as u64;
    let timed = matches!(method, Discretisation::Efg(_)) && !asks.targets.is_empty();
    if !timed {
        return once();
    }
    let mut field = timings.time("transfer", once)?;
    for _ in 1..asks.repeats.most {
        field = timings.time("transfer", once)?;
    }
    Ok(field)
}

pub(crate) fn push(metrics: &mut Vec<Metric>, name: &str, value: f64, unit: &'static str) {
    metrics.push(Metric { name: name.into(), value, unit });
}

/// Errors, maxima, energies, counts.
fn measure(
    metrics: &mut Vec<Metric>,
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    solution: &Solution,
    (field, outside): (Vec<Vector3>, usize),
    asks: &Asks,
) -> Result<(), Failure> {
    let body = Body {
        nodes: method.nodes(),
        volume: &prepared.volume.rows,
        materials: &setup.materials,
        region: &prepared.volume.region,
        dilation: prepared.volume.groups.as_ref(),
    };
    if let Some(exact) = &setup.exact {
        let (fine, region) = method.error_rows(&prepared.volume)?;
        let n = norms(&body, &fine, &region, &solution.u, exact.as_ref())?;
        for (name, value) in
            [("l2", n.l2), ("energy", n.energy), ("pressure", n.pressure), ("stress", n.stress)]
        {
            if let Some(value) = value {
                push(metrics, name, value, "1");
            }
        }
    }
    let points = if asks.targets.is_empty() { method.nodes() } else { asks.targets };
    let against = match (&setup.exact, asks.reference) {
        (Some(exact), _) => Some(exact_at(exact.as_ref(), points)),
        (None, Some(reference)) => Some(reference.targets.clone()),
        (None, None) => None,
    };
    if let Some(against) = against {
        push_difference(metrics, &field, &against);
        let largest = against.iter().fold(0.0, |m: f64, u| m.max(u.norm()));
        if largest > 0.0 {
            push(metrics, "relative-max", difference(&field, &against).max / largest, "1");
        }
    }
    for (axis, name) in ["max-x", "max-y", "max-z"].into_iter().enumerate() {
        push(metrics, name, field.iter().fold(0.0, |m: f64, u| m.max(u[axis].abs())), "m");
    }
    push(metrics, "max", field.iter().fold(0.0, |m: f64, u| m.max(u.norm())), "m");
    push(metrics, "targets-outside", outside as f64, "1");
    push(metrics, "strain-energy", mechanics::strain_energy(&body, &solution.u)?, "J");
    push(metrics, "volume", prepared.volume.rows.weights().iter().sum(), "m^3");
    push(metrics, "residual", solution.info.residual, "1");
    push(metrics, "factor-nonzeros", solution.info.factor_nonzeros as f64, "1");
    let resultant = prepared.resultant();
    for (axis, name) in ["load-x", "load-y", "load-z"].into_iter().enumerate() {
        push(metrics, name, resultant[axis], "N");
    }
    if let Some(mls) = &prepared.volume.mls {
        push(metrics, "neighbours-min", mls.neighbours_min as f64, "1");
        push(metrics, "neighbours-mean", mls.neighbours_mean, "1");
        push(metrics, "neighbours-max", mls.neighbours_max as f64, "1");
        push(metrics, "condition-median", mls.condition_median, "1");
        push(metrics, "condition-max", mls.condition_max, "1");
        push(metrics, "fallbacks", mls.fallbacks() as f64, "1");
        push(metrics, "fallbacks-enlarged", mls.enlarged as f64, "1");
        push(metrics, "fallbacks-regularised", mls.regularised as f64, "1");
        push(metrics, "fallbacks-reduced", mls.reduced as f64, "1");
    }
    if let Some(error) = prepared.volume.volume_error {
        push(metrics, "volume-error", error, "1");
    }
    Ok(())
}

/// RMS per direction and of the magnitude, and the largest difference.
pub(crate) fn push_difference(metrics: &mut Vec<Metric>, field: &[Vector3], against: &[Vector3]) {
    let d = difference(field, against);
    for (axis, name) in ["rms-x", "rms-y", "rms-z"].into_iter().enumerate() {
        push(metrics, name, d.rms[axis], "m");
    }
    push(metrics, "rms", d.rms_magnitude, "m");
    push(metrics, "max-error", d.max, "m");
}

fn probes(
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    u: &[Vector3],
    points: &[Point3],
) -> Result<Vec<Probe>, Failure> {
    if points.is_empty() {
        return Ok(Vec::new());
    }
    let rows = method.gradients_at(&prepared.volume, points)?;
    // Stresses at probes are pointwise, of the first region's law unless the body has one only.
    let stress = mechanics::stress(&rows, u, &setup.materials, &[])?;
    let field = rows.rows().apply(u);
    Ok(points.iter().zip(field).zip(stress).map(|((&x, u), stress)| Probe { x, u, stress }).collect())
}

/// Displacement of the boundary's corner nodes.
fn picture(
    identity: &Identity,
    method: &Discretisation,
    prepared: &Prepared,
    u: &[Vector3],
) -> Result<SurfaceField, Failure> {
    let mesh = method.mesh();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for facet in mesh.boundary() {
        let count = mesh.kind(facet.cell as usize).face_kind().corner_count();
        let corners: Vec<u32> = mesh.facet_nodes(facet).take(count).collect();
        triangles.extend((1..count - 1).map(|k| [corners[0], corners[k], corners[k + 1]]));
    }
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    for corner in triangles.iter_mut().flatten() {
        *corner = used.binary_search(corner).expect("listed above") as u32;
    }
    let points: Vec<Point3> = used.iter().map(|&n| mesh.points()[n as usize]).collect();
    let displacement = method.at_points(&prepared.volume, &points)?.0.rows().apply(u);
    Ok(SurfaceField {
        case: identity.case.clone(),
        method: identity.method.clone(),
        title: format!("{} ({} nodes)", identity.method, method.nodes().len()),
        points: points.iter().map(|p| p.coords.into()).collect(),
        triangles,
        displacement: displacement.iter().map(|&d| d.into()).collect(),
    })
}

/// A reference that stays alive after its run: evaluates the displacement of `solved` anywhere.
pub fn reference(method: Discretisation, solved: Solved, targets: &[Point3]) -> Result<Reference, Failure> {
    let Solved { outcome, prepared, u } = solved;
    let at = move |points: &[Point3]| -> Result<Vec<Vector3>, Failure> {
        Ok(method.at_points(&prepared.volume, points)?.0.rows().apply(&u))
    };
    let points = if targets.is_empty() { Vec::new() } else { at(targets)? };
    Ok(Reference { method: outcome.identity.method, targets: points, at: Box::new(at) })
}
