//! Numbers of points and surfaces in every state of a run: displacement and stress at probes, stretches,
//! enclosed volumes, and moments.

use std::collections::HashMap;

use cases::scene::{Enclosed, Output, Place};
use catalogue::metric;
use geometry::{Facet, Mesh, Point3, Vector3};
use shape::{FluxRows, GradRows, Matrix3, Resultant};

use super::probes::{Probes, check_points};
use super::solved::Solved;
use super::states::recorded;
use super::stress::Recovered;
use crate::discretise::node_set;
use crate::discretise::place::{self, Patch};
use crate::error::{Failure, Key};
use crate::outcome::{LoadStep, Metric, Outcome, Probe, ToolStep, push};
use crate::prepare::surfaces::flux;
use crate::scenario::setup::{Applied, Setup};

/// Refuses points outside the mesh, and surfaces that enclose no volume, before anything is solved.
pub(crate) fn check(mesh: &Mesh, Setup { output, loads, supports, .. }: &Setup) -> Result<(), Failure> {
    for load in loads {
        if let Applied::Points { at, .. } = &load.applied {
            check_points(mesh, at, |index| format!("{}.at[{index}]", load.key))?;
        }
    }
    for support in supports {
        if let Place::At(at) = &support.place {
            let at: Vec<Point3> = at.iter().map(|x| Point3::from(*x)).collect();
            check_points(mesh, &at, |index| format!("{}.at[{index}]", support.key))?;
        }
    }
    let points: Vec<Point3> = output.stretches.iter().map(|stretch| stretch.at.into()).collect();
    check_points(mesh, &points, |index| format!("output.stretches[{index}].at"))?;
    for (index, volume) in output.volumes.iter().enumerate() {
        let key = format!("output.volumes[{index}]");
        node_set::refuse(&key, &volume.surface, mesh)?;
        let patch = place::patch(&key, &volume.surface, mesh)?;
        if patch.whole.is_empty() && patch.cut.is_empty() {
            return Err(place::empty(&key, &volume.surface, mesh));
        }
        place::outer(&key, &volume.surface, mesh, &patch.whole)?;
        let problem = match open_edges(mesh, &patch.whole) {
            _ if volume.apex.is_some() => continue,
            0 if patch.cut.is_empty() => continue,
            0 => "cuts faces, so that it is open".into(),
            edges => format!("has a rim of {edges} edges, so that it encloses no volume"),
        };
        let help = "take a closed surface, or give apex = [\"0 mm\", \"0 mm\", \"0 mm\"], a point in the planes that close it";
        return Err(Failure::input(Key::Scene(key), problem, help));
    }
    Ok(())
}

/// Number of edges that belong to one face only.
fn open_edges(mesh: &Mesh, facets: &[Facet]) -> usize {
    let mut faces: HashMap<[u32; 2], usize> = HashMap::new();
    for facet in facets {
        let corners: Vec<u32> = mesh.facet_corners(*facet).collect();
        for (k, &a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            *faces.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    faces.values().filter(|count| **count == 1).count()
}

/// Adds the numbers of points and surfaces to the outcome and to its steps. The probes at the end are known.
pub(crate) fn points(outcome: &mut Outcome, run: &Solved, probes: &[Point3]) -> Result<(), Failure> {
    let Output { stretches, volumes, moments_about, .. } = &run.setup.output;
    let about = moments_about.map(Point3::from);
    if probes.is_empty() && stretches.is_empty() && volumes.is_empty() && about.is_none() {
        return Ok(());
    }
    let probes = Probes::new(run, probes)?;
    let directions: Vec<Vector3> = stretches.iter().map(|stretch| stretch.along.into()).collect();
    let at: Vec<Point3> = stretches.iter().map(|stretch| stretch.at.into()).collect();
    let gradients = if at.is_empty() { None } else { Some(run.prepared.source.gradients_at(&at)?) };
    let volumes: Vec<Volume> = volumes
        .iter()
        .enumerate()
        .map(|(index, volume)| Volume::new(run, index, volume))
        .collect::<Result<_, _>>()?;
    let others = |u: &[Vector3]| {
        let mut metrics = Vec::new();
        for (index, stretch) in gradients.iter().flat_map(|at| lengths(at, &directions, u)).enumerate() {
            push(&mut metrics, metric::STRETCH.at(index), stretch);
        }
        for (index, volume) in volumes.iter().enumerate() {
            push(&mut metrics, metric::ENCLOSED_VOLUME.at(index), volume.at(u));
        }
        metrics
    };
    let mut metrics = of_probes(&outcome.probes);
    metrics.extend(others(&run.solution.u));
    if let Some(about) = about {
        let supports: Vec<Resultant> = outcome.supports.iter().map(|support| support.resultant).collect();
        let tools = outcome.last.as_ref().map_or(&[][..], |last| &last.tools);
        metrics.extend(moments(&about, tools, &supports));
    }
    outcome.metrics.extend(metrics);
    if run.solution.history.is_some() {
        for (step, state) in outcome.steps.iter_mut().zip(recorded(run, usize::MAX)) {
            let recovered = state.parameters.filter(|_| !probes.is_empty());
            let recovered =
                recovered.and_then(|parameters| Recovered::new(run, state.u, parameters, state.time));
            step.points.extend(of_probes(&probes.at(state.u, recovered.as_ref())));
            step.points.extend(others(state.u));
            if let Some(about) = about {
                step.points.extend(moments(&about, &step.tools, &step.supports));
            }
        }
    }
    if let Some(duration) = run.setup.procedure.duration() {
        let peaks = peaks(&outcome.steps, outcome.probes.len(), duration);
        outcome.metrics.extend(peaks);
    }
    Ok(())
}

/// Largest displacement of each probe in all recorded states, and the time of the first such state.
fn peaks(steps: &[LoadStep], probes: usize, duration: f64) -> Vec<Metric> {
    let mut metrics = Vec::new();
    for index in 0..probes {
        let distance = |step: &LoadStep| {
            step.points.iter().find(|of| of.of == metric::PROBE.at(index)).map_or(0.0, |of| of.value)
        };
        let (mut largest, mut time) = (0.0, 0.0);
        for step in steps {
            if distance(step) > largest {
                (largest, time) = (distance(step), step.load * duration);
            }
        }
        push(&mut metrics, metric::PROBE_PEAK.at(index), largest);
        push(&mut metrics, metric::PROBE_PEAK_TIME.at(index), time);
    }
    metrics
}

/// Moments on the tools and of the supports about a point.
fn moments(about: &Point3, tools: &[ToolStep], supports: &[Resultant]) -> Vec<Metric> {
    let mut metrics = Vec::new();
    let mut add = |of: &'static metric::Metric, index: usize, moment: Vector3| {
        for (axis, of) in of.components().into_iter().enumerate() {
            push(&mut metrics, of.at(index), moment[axis]);
        }
    };
    for (index, tool) in tools.iter().enumerate() {
        add(&metric::TOOL_MOMENT, index, tool.moment_about(about));
    }
    for (index, support) in supports.iter().enumerate() {
        add(&metric::REACTION_MOMENT, index, support.about(about));
    }
    metrics
}

/// Displacement, position and stress of each probe.
fn of_probes(probes: &[Probe]) -> Vec<Metric> {
    let mut metrics = Vec::new();
    for (index, probe) in probes.iter().enumerate() {
        for (axis, of) in metric::PROBE.components().into_iter().enumerate() {
            push(&mut metrics, of.at(index), probe.u[axis]);
        }
        push(&mut metrics, metric::PROBE.at(index), probe.u.norm());
        for (axis, of) in metric::POSITION.components().into_iter().enumerate() {
            push(&mut metrics, of.at(index), probe.x[axis] + probe.u[axis]);
        }
        let Some(stress) = probe.stress else { continue };
        for (of, value) in metric::PROBE_STRESS.tensor().into_iter().zip(Probe::components(&stress)) {
            push(&mut metrics, of.at(index), value);
        }
    }
    metrics
}

/// Ratios of deformed to undeformed lengths along unit directions, `|F d|`.
fn lengths(at: &GradRows, directions: &[Vector3], u: &[Vector3]) -> Vec<f64> {
    let gradients = at.displacement_gradients(u);
    gradients.iter().zip(directions).map(|(h, d)| ((Matrix3::identity() + h) * d).norm()).collect()
}

/// Volume between a surface and a fixed point.
struct Volume {
    surfaces: Vec<FluxRows>,
    apex: Point3,
    /// Sign that makes the undeformed volume positive: the normals of a cavity point into it.
    sign: f64,
}

impl Volume {
    fn new(run: &Solved, index: usize, volume: &Enclosed) -> Result<Volume, Failure> {
        let key = format!("output.volumes[{index}]");
        let patch: Patch = place::patch(&key, &volume.surface, run.method.mesh())?;
        let surfaces = flux(&*run.prepared.source, &patch)?;
        // The apex of a closed surface does not matter, but a near one keeps the sum accurate.
        let apex = volume.apex.map(Point3::from).or_else(|| surfaces.first()?.points().first().copied());
        let nodes = run.prepared.volume.rows.rows().node_count();
        let mut volume = Volume { surfaces, apex: apex.unwrap_or_default(), sign: 1.0 };
        volume.sign = volume.at(&vec![Vector3::zeros(); nodes]).signum();
        Ok(volume)
    }

    /// Volume (m^3) at the nodal parameters `u` (m): `1/3 sum_q w (x - apex) . cof(F) n` by the divergence
    /// theorem.
    fn at(&self, u: &[Vector3]) -> f64 {
        let of_surface = |surface: &FluxRows| -> f64 {
            let moved = surface.at().rows().apply(u);
            let x = surface.points().iter().zip(&moved).map(|(x, u)| x + u - self.apex);
            x.zip(surface.directed_areas(u)).map(|(x, area)| x.dot(&area)).sum()
        };
        self.sign * self.surfaces.iter().map(of_surface).sum::<f64>() / 3.0
    }
}
