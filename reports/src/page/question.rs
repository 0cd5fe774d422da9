//! View of a question put to a case, in columns.

use records::Reference;
use serde::Serialize;

use super::methods::Methods;
use crate::fronts::Clock;
use crate::plot::Scale;
use crate::questions::{Ask, Line, Timed};
use crate::seconds::Seconds;

#[derive(Serialize)]
pub(super) struct AskView {
    case: String,
    title: String,
    /// Name of the quantity, such as `tool force`.
    what: &'static str,
    /// Whether the time is that of one solve in a prepared loop.
    repeated: bool,
    /// Whether the times are those of all processors.
    cpu: bool,
    time: Scale,
    error: Scale,
    scalar: bool,
    /// Whether the errors are estimates, as there is no reference.
    estimated: bool,
    kernels: bool,
    /// Description of the reference of the runs and its own error.
    reference: Option<String>,
    band: Option<f64>,
    /// Sort key; the page begins with the question of the highest rank.
    rank: (bool, bool, bool, bool, usize),
    lines: Vec<LineView>,
}

#[derive(Serialize)]
struct LineView {
    label: usize,
    run: Vec<Option<usize>>,
    seconds: Vec<f32>,
    spread: Vec<Option<f32>>,
    estimate: Vec<Option<f32>>,
    error: Vec<f32>,
    counts: Vec<f32>,
}

/// Description of a reference with its warnings.
fn described(reference: &Reference) -> String {
    let warnings = reference.warnings.iter().map(|text| format!(". Its warning: {text}"));
    std::iter::once(reference.sentence()).chain(warnings).collect()
}

impl AskView {
    pub(super) fn new(ask: &Ask, references: &[Reference], methods: &mut Methods) -> AskView {
        let of_case = |r: &&Reference| r.case == ask.case && r.poisson == ask.poisson;
        let mut line = |line: &Line| {
            let each = |f: fn(&Timed) -> f64| line.runs.iter().map(|r| f(r) as f32).collect();
            LineView {
                label: methods.label(&line.label, line.family),
                run: line.runs.iter().map(|r| methods.run(&r.run)).collect(),
                seconds: each(|r| r.seconds),
                spread: line.runs.iter().map(|r| r.spread.map(|s| s as f32)).collect(),
                estimate: line.runs.iter().map(|r| r.estimate.map(|e| e as f32)).collect(),
                error: each(|r| r.error),
                counts: each(|r| r.counts),
            }
        };
        AskView {
            case: ask.case.clone(),
            title: ask.title.clone(),
            what: ask.question.name,
            repeated: ask.clock == Clock::Repeated,
            cpu: ask.clock == Clock::First && ask.by == Seconds::Cpu,
            time: ask.time(),
            error: Scale::errors(ask.error),
            scalar: ask.question.scalar,
            estimated: ask.question.estimate == Some(ask.error),
            kernels: ask.kernels,
            reference: references.iter().find(of_case).map(described).or_else(|| ask.reference.clone()),
            band: ask.band,
            rank: ask.rank.key(),
            lines: ask.lines.iter().map(&mut line).collect(),
        }
    }

    /// Indices of the labels of the lines.
    pub(super) fn labels(&self) -> Vec<usize> {
        self.lines.iter().map(|line| line.label).collect()
    }
}
