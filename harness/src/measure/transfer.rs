//! Transfer of a method's nodal displacement to other points by common schemes, compared with the method's
//! own shape functions.

use std::time::Instant;

use catalogue::{metric, warning};
use efg::across_gaps;
use geometry::generate::tets_on_nodes;
use geometry::{Point3, Vector3};
use shape::{RowBlocks, Rows};

use super::comparison::push_difference;
use super::norms::difference;
use super::request::Request;
use super::solved::Solved;
use crate::error::Failure;
use crate::outcome::timing::Timings;
use crate::outcome::{Counters, Metric, SchemeSettings, Transfer, Warning, push};

/// Name of the method's own shape functions among the schemes; they need no transfer.
pub const OWN_ROWS: &str = "own-rows";

/// Difference from the method's own displacement above which a target with nodes across a gap counts,
/// relative to the largest displacement of the targets.
const JUMP: f64 = 0.01;
/// Distance, in node spacings, within which nodes across a gap are searched.
const REACH: f64 = 2.0;
/// Sum of the weights of nodes across a gap above which a target has such nodes.
const BRIDGE: f64 = 0.01;

/// Number of applications of a table that are timed together. A single application (10 us) is at the
/// resolution of the clock.
const APPLIES: usize = 20;

/// Transfers from the method's nodes to the targets by every requested scheme, then by the method's own shape
/// functions. The schemes interpolate the displacement at the nodes, not the nodal parameters, which are not
/// displacements.
///
/// The schemes do not know the body. A warning is given if one of them takes values from across a gap.
pub fn transfers(
    run: &Solved,
    request: &Request,
    counters: &mut Counters,
) -> Result<(Vec<Transfer>, Option<Warning>), Failure> {
    if request.schemes.is_empty() || request.targets.is_empty() {
        return Ok((Vec::new(), None));
    }
    let Solved { method, prepared, solution, .. } = *run;
    let u = &solution.u;
    let nodes = method.nodes();
    let at_nodes = match method.interpolates {
        true => u.clone(),
        false => prepared.source.at_points(nodes)?.0.rows().apply(u),
    };
    let own = prepared.source.at_points(request.targets)?.0.rows().apply(u);
    let linear = |points: &[Point3]| -> Vec<Vector3> { points.iter().map(linear_field).collect() };
    let cells = tets_on_nodes(method.mesh());
    let across = across_gaps(nodes, &cells, REACH * prepared.spacing, request.targets)
        .map_err(shape::SourceError::from)?;
    let mut bridged: Vec<Bridged> = Vec::new();
    let transfers: Result<Vec<Transfer>, Failure> = request
        .schemes
        .iter()
        .map(|(settings, scheme)| {
            let name = scheme.name();
            // Barycentric interpolation needs tetrahedra on the nodes.
            let mesh = Some(&cells).filter(|cells| cells.points() == nodes);
            let build = || scheme.rows(nodes, mesh, request.targets);
            let ((rows, info), timing) = timed(request, build, |(rows, _)| rows.rows(), &at_nodes)?;
            counters.transfer_tables += 1;
            let field = rows.rows().apply(&at_nodes);
            bridged.extend(Bridged::new(name, rows.rows(), &across, &field, &own));
            let mut metrics = Vec::new();
            if let Some(reference) = request.reference {
                push_difference(&mut metrics, &metric::RMS, &field, &reference.targets);
                push(&mut metrics, &metric::MAX_ERROR, difference(&field, &reference.targets).max);
                if let Some(at) = &reference.at {
                    let moved = rows.rows().apply(&at(nodes)?);
                    push_difference(&mut metrics, &metric::TRANSFER_ONLY_RMS, &moved, &reference.targets);
                }
            }
            if let Some(beside) = request.beside {
                push_difference(&mut metrics, &metric::BESIDE_RMS, &field, &beside.targets);
                // The other method's field, evaluated at this method's nodes and interpolated back, isolates
                // the error of the transfer.
                if let Some(at) = &beside.at {
                    let moved = rows.rows().apply(&at(nodes)?);
                    push_difference(&mut metrics, &metric::BESIDE_TRANSFER_RMS, &moved, &beside.targets);
                }
            }
            let change = difference(&field, &own);
            push(&mut metrics, &metric::TRANSFER_RMS, change.rms_magnitude);
            let error = difference(&rows.rows().apply(&linear(nodes)), &linear(request.targets));
            push(&mut metrics, &metric::LINEAR_RMS, error.rms_magnitude);
            push(&mut metrics, &metric::OUTSIDE, info.outside as f64);
            push(&mut metrics, &metric::FALLBACKS, info.fallbacks as f64);
            Ok(transfer(name, *settings, metrics, timing, request))
        })
        .chain(std::iter::once_with(|| {
            let build = || prepared.source.at_points(request.targets);
            let (_, timing) = timed(request, build, |(rows, _)| rows.rows(), u)?;
            let mut metrics = Vec::new();
            if let Some(reference) = request.reference {
                push_difference(&mut metrics, &metric::RMS, &own, &reference.targets);
                push(&mut metrics, &metric::MAX_ERROR, difference(&own, &reference.targets).max);
            }
            if let Some(beside) = request.beside {
                push_difference(&mut metrics, &metric::BESIDE_RMS, &own, &beside.targets);
            }
            Ok(transfer(OWN_ROWS, SchemeSettings::default(), metrics, timing, request))
        }))
        .collect();
    Ok((transfers?, bridging(&bridged, &own)))
}

/// A scheme that takes values from across a gap.
struct Bridged {
    scheme: &'static str,
    /// Number of targets that have such values and differ from the method's own by more than [`JUMP`].
    targets: usize,
    /// Largest of these differences, relative to the largest displacement of the targets.
    largest: f64,
}

impl Bridged {
    /// Compares the displacement of a scheme with the method's own at the targets that have nodes across a
    /// gap in their rows; `None` if they agree.
    fn new(
        scheme: &'static str,
        rows: &Rows,
        across: &[Vec<u32>],
        field: &[Vector3],
        own: &[Vector3],
    ) -> Option<Bridged> {
        let whole = own.iter().map(|u| u.norm()).fold(0.0, f64::max);
        let bridges = |target: usize| {
            let (nodes, weights) = rows.row(target);
            let beyond =
                nodes.iter().zip(weights).filter(|(node, _)| across[target].binary_search(node).is_ok());
            beyond.map(|(_, weight)| weight.abs()).sum::<f64>() > BRIDGE
        };
        let off = (0..across.len()).map(|target| ((field[target] - own[target]).norm() / whole, target));
        let off = off.filter(|&(off, target)| off > JUMP && bridges(target));
        let (targets, largest) = off.fold((0, 0.0f64), |(count, most), (off, _)| (count + 1, most.max(off)));
        (targets > 0).then_some(Bridged { scheme, targets, largest })
    }
}

/// Warning of schemes that take values from across a gap.
fn bridging(bridged: &[Bridged], own: &[Vector3]) -> Option<Warning> {
    let worst = bridged.iter().max_by(|a, b| a.largest.total_cmp(&b.largest))?;
    let whole = own.iter().map(|u| u.norm()).fold(0.0, f64::max);
    let message = format!(
        "transfer schemes ({}) use nodes across a gap of the body: with {:?} the displacement at {} of {} targets differs by up to {:.4} mm \
         ({:.1} % of the largest) from that of the method. Use \"barycentric\", or the method's own shape functions ({OWN_ROWS})",
        bridged.iter().map(|each| each.scheme).collect::<Vec<_>>().join(", "),
        worst.scheme,
        worst.targets,
        own.len(),
        1e3 * worst.largest * whole,
        100.0 * worst.largest
    );
    Some(Warning::new(&warning::GAP_BRIDGED, worst.largest, "output.transfer", message))
}

fn transfer(
    scheme: &str,
    settings: SchemeSettings,
    metrics: Vec<Metric>,
    timings: Timings,
    request: &Request,
) -> Transfer {
    Transfer {
        scheme: scheme.into(),
        settings,
        metrics,
        times: timings.phases().to_vec(),
        targets: request.targets.len(),
    }
}

/// Builds, packs (both count as the time to build) and applies a table, repeated until the time for repeats
/// is spent: a radial basis on 1331 nodes takes seconds.
fn timed<T, E: Into<Failure>>(
    request: &Request,
    mut build: impl FnMut() -> Result<T, E>,
    rows: impl Fn(&T) -> &shape::Rows,
    field: &[Vector3],
) -> Result<(T, Timings), Failure> {
    let mut timings = Timings::default();
    let begin = Instant::now();
    let mut make = || -> Result<(T, RowBlocks), E> {
        let table = build()?;
        let blocks = RowBlocks::new(rows(&table));
        Ok((table, blocks))
    };
    let (mut table, mut blocks) = timings.time("prepare", &mut make).map_err(E::into)?;
    let mut out = vec![Vector3::zeros(); blocks.len()];
    for repeat in 1..=request.repeats.most {
        let start = Instant::now();
        for _ in 0..APPLIES {
            blocks.apply_into(std::hint::black_box(field), &mut out);
        }
        timings.book("transfer", start.elapsed().as_secs_f64() / APPLIES as f64);
        std::hint::black_box(&out);
        if repeat < request.repeats.most && begin.elapsed().as_secs_f64() < request.repeats.seconds {
            (table, blocks) = timings.time("prepare", &mut make).map_err(E::into)?;
        }
    }
    Ok((table, timings))
}

/// Linear field of 10 % strain and rotation, which schemes of first order reproduce exactly.
fn linear_field(x: &Point3) -> Vector3 {
    Vector3::new(0.1 * x.x + 0.05 * x.y, -0.05 * x.x - 0.04 * x.y + 0.02 * x.z, 0.03 * x.x - 0.04 * x.z)
}
