//! Printed text: plans, the table of runs, verdicts.

use std::fmt::Write as _;

use catalogue::metric::{self, Address, Metric};
use records::{Check, Reference, Status};
use reports::Seconds;
use shape::position_alone;

use crate::cli::colour;
use crate::outcome::timing::PHASES;
use crate::outcome::{Outcome, Plan};
use crate::run::stored_reference::Stored;

/// Formats the plan of a method with `nodes` nodes. Unknowns include those at supports.
pub fn stages(method: &str, nodes: u64, plan: &Plan) -> String {
    let mut text = format!("{method}: {nodes} nodes, {} displacement unknowns before supports\n", 3 * nodes);
    for stage in plan.stages() {
        let word = if stage.ran { "run " } else { "skip" };
        writeln!(text, "  {word}  {:28}  {}", stage.stage.label(), stage.why).expect("a string");
    }
    text
}

/// Formats the forces of a stored reference and the spread of its solutions.
pub fn reference(stored: &Stored) -> String {
    let mut text = String::new();
    for step in &stored.steps {
        for tool in &step.tools {
            // A tool that has not touched yet has no force to compare with.
            let spread = if tool.force > 0.0 {
                let [low, high] = [tool.low, tool.high].map(|f| 100.0 * (f / tool.force - 1.0));
                format!("{low:+.2} % {high:+.2} %")
            } else {
                format!("up to {:.5} N", tool.high)
            };
            let (closure, probes) = (1e3 * tool.closure, 1e3 * step.probe_band);
            writeln!(text, "{closure:7.3} mm  {:9.5} N  {spread}  probes within {probes:.4} mm", tool.force)
                .expect("a string");
        }
    }
    text
}

/// Formats the reference of the runs, its own error and its warnings, one per line.
pub fn compared_with(reference: &Reference) -> String {
    let warnings = reference.warnings.iter();
    let warnings = warnings.map(|text| format!("warning: reference {}: {text}\n", reference.method));
    std::iter::once(format!("compared with {}\n", reference.sentence())).chain(warnings).collect()
}

/// Formats a verdict in one line.
pub fn verdict(check: &Check) -> String {
    format!("{}: {}", word(check.status), judged(check))
}

/// Formats a verdict for stderr, with its first word in colour if supported.
pub fn painted_verdict(check: &Check) -> String {
    let style = match check.status {
        Status::Fail => colour::BAD,
        Status::Pass => colour::GOOD,
        Status::NotRun | Status::KnownFailure => colour::DOUBTFUL,
    };
    format!("{}: {}", colour::err(style, word(check.status)), judged(check))
}

/// Whether a verdict is printed: for checks that did not pass, and for passed checks that prove nothing.
pub fn is_told(check: &Check) -> bool {
    match check.status {
        Status::Fail | Status::NotRun => true,
        Status::Pass => !check.reason.is_empty(),
        Status::KnownFailure => false,
    }
}

fn word(status: Status) -> &'static str {
    match status {
        Status::Fail => "FAILED",
        Status::NotRun => "NOT RUN",
        Status::Pass => "passed",
        Status::KnownFailure => "known not to pass",
    }
}

fn judged(check: &Check) -> String {
    format!("{} {} {}: {} ({})", check.case, check.method, check.metric, check.bound, check.reason)
}

/// Errors against the reference method that mean nothing for this method itself.
const OWN_ERRORS: [&Metric; 3] =
    [&metric::RELATIVE_RMS, &metric::STRAIN_ENERGY_ERROR, &metric::TOOL_FORCE_ERROR];

/// Formats a table of finished runs: sizes, errors, displacement, and milliseconds per phase by the clock
/// that is compared.
pub fn outcomes(outcomes: &[Outcome], by: Seconds) -> String {
    // In dynamics the largest displacement at the end is not the largest of all times.
    let moves = outcomes.iter().any(|o| o.value(&metric::MAX_OVER_TIME).is_some());
    let [end_x, end_y, end_z] = match moves {
        true => ["end x [mm]", "end y [mm]", "end z [mm]"],
        false => ["max x [mm]", "max y [mm]", "max z [mm]"],
    };
    let [x, y, z] = metric::MAX.components();
    let columns: [(Address, &str, f64); 20] = [
        (metric::L2.whole(), "L2 [%]", 100.0),
        (metric::ENERGY.whole(), "energy [%]", 100.0),
        (metric::PRESSURE.whole(), "pressure [%]", 100.0),
        (metric::RMS.whole(), "RMS [mm]", 1e3),
        (metric::RELATIVE_RMS.whole(), "RMS [%]", 100.0),
        (x, end_x, 1e3),
        (y, end_y, 1e3),
        (z, end_z, 1e3),
        (metric::MAX_OVER_TIME.whole(), "largest over time [mm]", 1e3),
        (metric::TIME_OF_MAX.whole(), "at [s]", 1.0),
        (metric::TIP.whole(), "probe/exact", 1.0),
        (metric::HISTORY_ERROR.whole(), "history [%]", 100.0),
        (metric::PERIOD.whole(), "period [s]", 1.0),
        (metric::STRAIN_ENERGY_ERROR.whole(), "work error [%]", 100.0),
        (metric::HOURGLASS_ENERGY.whole(), "hourglass [%]", 100.0),
        (metric::LOAD_CARRIED.whole(), "load [%]", 100.0),
        (metric::TOOL_FORCE.whole(), "force [N]", 1.0),
        (metric::TOOL_FORCE_ERROR.whole(), "force error [%]", 100.0),
        (metric::SMALLEST_J.whole(), "smallest J", 1.0),
        (metric::NEWTON_ITERATIONS.whole(), "iterations", 1.0),
    ];
    let shown: Vec<_> = columns.iter().filter(|c| outcomes.iter().any(|o| o.value(c.0).is_some())).collect();
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut head: Vec<String> = ["method", "nodes", "dofs"].map(String::from).to_vec();
    head.extend(shown.iter().map(|c| c.1.to_string()));
    let phases =
        PHASES.iter().chain(&["total"]).filter(|p| outcomes.iter().any(|o| phase(o, p, by).is_some()));
    let phases: Vec<_> = phases.copied().collect();
    let unit = if by == Seconds::Wall { String::new() } else { format!("{} ", by.word()) };
    head.extend(phases.iter().map(|p| format!("{p} [{unit}ms]")));
    rows.push(head);
    for outcome in outcomes {
        let mut row = vec![
            outcome.identity.method.clone(),
            outcome.size.nodes.to_string(),
            outcome.size.dofs.to_string(),
        ];
        let own = outcome.is_reference();
        row.extend(shown.iter().map(|&&(of, _, scale)| match outcome.value(of) {
            _ if own && *of.metric == metric::RMS => "reference".into(),
            Some(value) if !own || !OWN_ERRORS.contains(&of.metric) => digits(value * scale),
            _ => "-".into(),
        }));
        row.extend(phases.iter().map(|p| phase(outcome, p, by).map_or("-".into(), |s| digits(s * 1e3))));
        rows.push(row);
    }
    aligned(&rows)
}

/// Formats the tables below that of the runs: support forces, numbers of faces, points and volumes, and
/// frequencies; empty without any.
pub fn places(outcomes: &[Outcome]) -> String {
    let mut text = String::new();
    let row = |method: &str, rest: Vec<String>| [vec![method.to_string()], rest].concat();
    let forces: Vec<Vec<String>> = (outcomes.iter())
        .flat_map(|outcome| {
            let each = outcome.supports.iter().map(|support| {
                let along = |axis: usize| match support.axes[axis] {
                    true => digits(support.resultant.force[axis]),
                    false => "free".into(),
                };
                row(&outcome.identity.method, vec![support.name.clone(), along(0), along(1), along(2)])
            });
            each.collect::<Vec<_>>()
        })
        .collect();
    section(&mut text, &["force of a support on the body [N]", "support", "x", "y", "z"], forces);
    let means = outcomes.iter().flat_map(|outcome| {
        outcome.means.iter().map(|face| {
            let [x, y, z] = [face.u.x, face.u.y, face.u.z].map(|u| digits(1e3 * u));
            row(&outcome.identity.method, vec![face.name.clone(), x, y, z])
        })
    });
    section(&mut text, &["mean displacement of a face [mm]", "face", "x", "y", "z"], means.collect());
    let probes = outcomes.iter().flat_map(|outcome| {
        (1..).zip(&outcome.probes).map(|(number, probe): (usize, _)| {
            let [x, y, z] = [probe.u.x, probe.u.y, probe.u.z].map(|u| digits(1e3 * u));
            row(&outcome.identity.method, vec![number.to_string(), position_alone(&probe.x), x, y, z])
        })
    });
    section(&mut text, &["displacement of a point [mm]", "point", "at", "x", "y", "z"], probes.collect());
    for (numbers, head, scale) in numbered() {
        let rows = outcomes.iter().flat_map(|outcome| {
            let at = |place: usize| {
                numbers.iter().map(|of| outcome.value(of.at(place))).collect::<Option<Vec<f64>>>()
            };
            (1..).zip((0..).map_while(at)).map(|(place, values): (usize, _)| {
                let values = values.iter().map(|value| digits(scale * value));
                row(&outcome.identity.method, std::iter::once(place.to_string()).chain(values).collect())
            })
        });
        section(&mut text, head, rows.collect());
    }
    let head = ["estimated error", "of", "value", "unit", "error [%]", "saturation", "predicted"];
    section(&mut text, &head, outcomes.iter().flat_map(estimates).collect());
    let head = ["mesh", "solved", "remaining error [%]", "half of the error in [%]"];
    section(&mut text, &head, outcomes.iter().filter_map(refined).collect());
    let head = ["strict bounds", "of", "lower", "upper", "unit", "half-width [%]"];
    section(&mut text, &head, outcomes.iter().flat_map(bounds).collect());
    let modes = outcomes.iter().flat_map(|outcome| {
        (1..).zip(&outcome.modes).map(|(number, mode): (usize, _)| {
            let of = |metric: &Metric| {
                mode.iter().find(|m| m.of.metric == metric).map_or("-".into(), |m| digits(m.value))
            };
            let [hertz, omega, ratio] = [&metric::FREQUENCY, &metric::OMEGA, &metric::OMEGA_RATIO].map(of);
            row(&outcome.identity.method, vec![number.to_string(), hertz, omega, ratio])
        })
    });
    section(&mut text, &["modes of vibration", "mode", "[Hz]", "[rad/s]", "/ exact"], modes.collect());
    text
}

/// Numbers of places: the metrics of a row, the head of the table, and the factor from SI to its units.
fn numbered() -> Vec<(Vec<Address>, &'static [&'static str], f64)> {
    vec![
        (
            metric::POSITION.components().to_vec(),
            &["position of a point [mm]", "point", "x", "y", "z"][..],
            1e3,
        ),
        (
            metric::PROBE_STRESS.tensor().to_vec(),
            &["stress of a point [kPa]", "point", "xx", "yy", "zz", "xy", "yz", "zx"],
            1e-3,
        ),
        (
            metric::REACTION_MOMENT.components().to_vec(),
            &["moment of a support [N mm]", "support", "x", "y", "z"],
            1e3,
        ),
        (
            metric::FOUNDATION_FORCE.components().to_vec(),
            &["force of springs and dampers on the body [N]", "foundation", "x", "y", "z"],
            1.0,
        ),
        (metric::TOOL_MOMENT.components().to_vec(), &["moment on a tool [N mm]", "tool", "x", "y", "z"], 1e3),
        (
            vec![metric::PROBE_PEAK.whole(), metric::PROBE_PEAK_TIME.whole()],
            &["largest displacement of a point", "point", "[mm]", "at [ms]"],
            1e3,
        ),
        (vec![metric::STRETCH.whole()], &["stretch", "point", "[1]"], 1.0),
        (vec![metric::REGION_ENERGY.whole()], &["strain energy of a region", "region", "[mJ]"], 1e3),
        (vec![metric::ENCLOSED_VOLUME.whole()], &["enclosed volume", "surface", "[mL]"], 1e6),
    ]
}

/// Rows of the estimated errors of a run.
fn estimates(outcome: &Outcome) -> Vec<Vec<String>> {
    let known = |of: Address, scale: f64| outcome.value(of).map(|value| digits(scale * value));
    let row =
        |of: &str, value: Option<String>, unit: &str, metrics: [Address; 2], predicted: Option<String>| {
            let [error, saturation] = metrics;
            let texts = [Some(outcome.identity.method.clone()), Some(of.into()), value, Some(unit.into())];
            let texts =
                texts.into_iter().chain([Some(known(error, 100.0)?), known(saturation, 1.0), predicted]);
            Some(texts.map(|text| text.unwrap_or_else(|| "-".into())).collect())
        };
    let tools = outcome.tools.iter().enumerate().map(|(k, name)| {
        let predicted = known(metric::TOOL_FORCE_PREDICTED.at(k), 1.0);
        let of = [metric::TOOL_FORCE_ESTIMATE.at(k), metric::TOOL_FORCE_SATURATION.at(k)];
        row(name, known(metric::TOOL_FORCE.at(k), 1.0), "N", of, predicted)
    });
    let supports = outcome.supports.iter().enumerate().map(|(k, support)| {
        let force = digits(support.resultant.force.norm());
        let of = [metric::REACTION_ESTIMATE.at(k), metric::REACTION_SATURATION.at(k)];
        row(&support.name, Some(force), "N", of, None)
    });
    let probes = (0..outcome.probes.len()).map(|k| {
        let name = format!("point {}", k + 1);
        let of = [metric::PROBE_ESTIMATE.at(k), metric::PROBE_SATURATION.at(k)];
        row(&name, known(metric::PROBE.at(k), 1e3), "mm", of, None)
    });
    let modes = outcome.modes.iter().enumerate().map(|(k, mode)| {
        let hertz = mode.iter().find(|m| *m.of.metric == metric::FREQUENCY).map(|m| digits(m.value));
        let of = [metric::FREQUENCY_ESTIMATE.at(k), metric::FREQUENCY_SATURATION.at(k)];
        row(&format!("mode {}", k + 1), hertz, "Hz", of, known(metric::FREQUENCY_PREDICTED.at(k), 1.0))
    });
    let [largest, energy] = [metric::MAX.whole(), metric::STRAIN_ENERGY.whole()].map(|of| known(of, 1e3));
    let predicted = known(metric::STRAIN_ENERGY_PREDICTED.whole(), 1e3);
    let displacement = [metric::DISPLACEMENT_ESTIMATE.whole(), metric::DISPLACEMENT_SATURATION.whole()];
    let of_energy = [metric::STRAIN_ENERGY_ESTIMATE.whole(), metric::STRAIN_ENERGY_SATURATION.whole()];
    let whole = [
        row("displacement", largest, "mm", displacement, None),
        row("strain energy", energy, "mJ", of_energy, predicted),
    ];
    tools.chain(supports).chain(probes).chain(modes).chain(whole).flatten().collect()
}

/// Row of a run whose error is traced or whose mesh is refined.
fn refined(outcome: &Outcome) -> Option<Vec<String>> {
    let all = [(&metric::MESHES, 1.0), (&metric::REMAINING_ERROR, 100.0), (&metric::ERROR_VOLUME, 100.0)];
    let values = all.map(|(of, scale)| outcome.value(of).map(|value| digits(scale * value)));
    let known = values.iter().any(Option::is_some);
    let texts = values.map(|value| value.unwrap_or_else(|| "-".into()));
    known.then(|| [outcome.identity.method.clone()].into_iter().chain(texts).collect())
}

/// Rows of the strict bounds of a run.
fn bounds(outcome: &Outcome) -> Vec<Vec<String>> {
    let known = |of: &'static Metric| outcome.value(of);
    let all = [
        ("strain energy", "mJ", 1e3, [&metric::STRAIN_ENERGY_LOWER, &metric::STRAIN_ENERGY_UPPER]),
        ("force of the support", "N", 1.0, [&metric::SUPPORT_FORCE_LOWER, &metric::SUPPORT_FORCE_UPPER]),
        ("loaded faces", "mm", 1e3, [&metric::LOAD_DISPLACEMENT_LOWER, &metric::LOAD_DISPLACEMENT_UPPER]),
    ];
    let row = |(of, unit, scale, [lower, upper]): (&str, &str, f64, [&'static Metric; 2])| {
        let (values, half) = (known(lower).zip(known(upper))?, known(&metric::BOUNDS_HALF_WIDTH)?);
        let [lower, upper] = [values.0, values.1].map(|value| digits(scale * value));
        let texts = [outcome.identity.method.as_str(), of, &lower, &upper, unit, &digits(100.0 * half)];
        Some(texts.map(String::from).to_vec())
    };
    let means = (0..outcome.means.len()).flat_map(|index| (0..3).map(move |axis| (index, axis)));
    let means = means.filter_map(|(index, axis)| {
        let at = |metric: &'static Metric| outcome.value(metric.components()[axis].at(index));
        let (lower, upper) = at(&metric::MEAN_LOWER).zip(at(&metric::MEAN_UPPER))?;
        let of = format!("face {}, {}", index + 1, ["x", "y", "z"][axis]);
        let [lower, upper] = [lower, upper].map(|value| digits(1e3 * value));
        let texts = [outcome.identity.method.as_str(), &of, &lower, &upper, "mm", "-"];
        Some(texts.map(String::from).to_vec())
    });
    all.into_iter().filter_map(row).chain(means).collect()
}

/// Appends a small table after an empty line, if it has rows.
fn section(text: &mut String, head: &[&str], rows: Vec<Vec<String>>) {
    if rows.is_empty() {
        return;
    }
    let head = head.iter().map(ToString::to_string).collect();
    let rows: Vec<Vec<String>> = std::iter::once(head).chain(rows).collect();
    writeln!(text, "\n{}", aligned(&rows)).expect("a string");
}

/// Aligns rows in columns, the first to the left, the others to the right.
pub(super) fn aligned(rows: &[Vec<String>]) -> String {
    let width = |c: usize| rows.iter().map(|r| r[c].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..rows[0].len()).map(width).collect();
    let lines = rows.iter().map(|row| {
        let cells = row
            .iter()
            .zip(&widths)
            .enumerate()
            .map(|(c, (cell, &w))| if c == 0 { format!("{cell:<w$}") } else { format!("{cell:>w$}") });
        cells.collect::<Vec<_>>().join("  ")
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Formats warnings about the results, one line each with the methods concerned.
pub fn warnings(rows: &[records::Warning]) -> String {
    let mut found: Vec<(String, Vec<&str>)> = Vec::new();
    for warning in rows {
        let text = line(warning);
        let method = warning.method.as_str();
        match found.iter_mut().find(|(known, _)| *known == text) {
            Some((_, methods)) if methods.contains(&method) => {}
            Some((_, methods)) => methods.push(method),
            None => found.push((text, vec![method])),
        }
    }
    let line = |(text, methods): &(String, Vec<&str>)| match methods.join(", ").as_str() {
        "" => format!("warning: {text}\n"),
        methods => format!("warning: {methods}: {text}\n"),
    };
    found.iter().map(line).collect()
}

fn line(warning: &records::Warning) -> String {
    let place = if warning.place.is_empty() { String::new() } else { format!("key '{}': ", warning.place) };
    format!("{place}{} ({})", warning.message, warning.code)
}

fn phase(outcome: &Outcome, name: &str, by: Seconds) -> Option<f64> {
    outcome.phases.iter().find(|timed| timed.phase == name).map(|timed| timed.by(by))
}

/// Formats a number with four significant digits, with an exponent if plain digits would hide them.
pub fn digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        v if !(1e-3..1e5).contains(&v) => format!("{value:.3e}"),
        v if v < 1.0 => format!("{value:.5}"),
        v if v < 100.0 => format!("{value:.3}"),
        _ => format!("{value:.1}"),
    }
}

/// Prints a named value.
pub(super) fn row(name: &str, value: &str) {
    println!("  {name:<10}  {value}");
}
