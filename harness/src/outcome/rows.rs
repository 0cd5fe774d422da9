//! Conversion of a finished run to rows of the long table, and of its plan and warnings to rows of the
//! report.

use catalogue::{Dimension, metric};
use records::{Family, PlanEntry, Record};

use super::load_step::LoadStep;
use super::metrics::{Metric, push};
use super::timing::{Summary, Timed};
use super::{Outcome, SchemeSettings, Transfer};

impl Outcome {
    /// Rows of the run in the long table.
    pub fn records(&self) -> Vec<Record> {
        let own = self.row();
        let mut rows: Vec<Record> = self.metrics.iter().map(|m| number(&own, m)).collect();
        rows.extend(self.metrics.iter().filter_map(|m| self.band(&own, m)));
        self.phases.iter().for_each(|timed| rows.extend(times(&own, timed)));
        rows.extend(self.first_use.map(|seconds| Record {
            phase: "first-use".into(),
            ..number(&own, &Metric::new(&metric::TIME, seconds))
        }));
        for latency in &self.latencies {
            let phase = Record { phase: latency.phase.to_string(), ..own.clone() }.with(&metric::TIME);
            rows.extend(latency.statistics().into_iter().map(|(statistic, unit, value)| Record {
                unit: unit.into(),
                statistic: statistic.into(),
                value,
                ..phase.clone()
            }));
        }
        rows.push(number(&own, &Metric::new(&metric::MEMORY, self.memory as f64)));
        rows.extend(self.process_memory.map(|bytes| Record {
            phase: "process".into(),
            ..number(&own, &Metric::new(&metric::MEMORY, bytes as f64))
        }));
        self.transfers.iter().for_each(|transfer| rows.extend(self.transfer_records(&own, transfer)));
        rows.extend(self.step_records(&own));
        for (index, metrics) in self.modes.iter().enumerate() {
            let mode = Record { mode: Some(index as u64 + 1), ..own.clone() };
            rows.extend(metrics.iter().map(|m| number(&mode, m)));
        }
        rows
    }

    /// Row of the reference's own error in a metric of the run, if it is known.
    fn band(&self, own: &Record, error: &Metric) -> Option<Record> {
        let value = *self.reference.as_ref()?.band.get(&error.name())?;
        Some(Record { statistic: "band".into(), value, ..number(own, error) })
    }

    /// Columns that all rows of the run have in common.
    fn row(&self) -> Record {
        let size = &self.size;
        let own = Record {
            nodes: size.nodes,
            elements: size.elements,
            points: size.points,
            dofs: size.dofs,
            spacing: size.spacing,
            ..self.identity.clone()
        };
        Record { run: run_id(&own), ..own }
    }

    /// Rows of the load steps, from step 0, the start. The first tool's metrics are `closure` and
    /// `tool-force`, the second tool's `closure-2` and `tool-force-2`.
    fn step_records(&self, own: &Record) -> Vec<Record> {
        let at = |step: usize| Record { step: Some(step as u64), ..own.clone() };
        let mut rows = Vec::new();
        let start = at(0);
        if !self.steps.is_empty() {
            for index in 0..self.tools.len() {
                rows.push(number(&start, &Metric::new(metric::CLOSURE.at(index), 0.0)));
                rows.push(number(&start, &Metric::new(metric::TOOL_FORCE.at(index), 0.0)));
            }
        }
        // Dynamics starts at rest and undeformed: time and energies are zero.
        if let Some(first) = self.steps.first().filter(|step| !step.more.is_empty()) {
            if first.strain_energy.is_some() {
                rows.push(number(&start, &Metric::new(&metric::STRAIN_ENERGY, 0.0)));
            }
            let is_zero = |m: &&Metric| matches!(m.of.metric.dimension, Dimension::Time | Dimension::Energy);
            for known in first.more.iter().filter(is_zero) {
                rows.push(number(&start, &Metric::new(known.of, 0.0)));
            }
        }
        for (index, step) in self.steps.iter().enumerate() {
            let here = at(index + 1);
            rows.extend(self.of_step(step).iter().map(|m| number(&here, m)));
        }
        rows
    }

    /// Metrics of a load step.
    fn of_step(&self, step: &LoadStep) -> Vec<Metric> {
        let mut all = vec![Metric::new(&metric::LOAD_CARRIED, step.load)];
        all.extend(step.strain_energy.map(|energy| Metric::new(&metric::STRAIN_ENERGY, energy)));
        push(&mut all, &metric::SMALLEST_J, step.smallest_j);
        if step.iterations > 0 {
            push(&mut all, &metric::NEWTON_ITERATIONS, step.iterations as f64);
        }
        for (index, tool) in step.tools.iter().enumerate() {
            push(&mut all, metric::CLOSURE.at(index), tool.closure);
            push(&mut all, metric::TOOL_FORCE.at(index), tool.pushed);
            push(&mut all, metric::CONTACT_POINTS.at(index), tool.active as f64);
        }
        for (index, (support, sum)) in self.supports.iter().zip(&step.supports).enumerate() {
            for axis in (0..3).filter(|&axis| support.axes[axis]) {
                push(&mut all, metric::REACTION.components()[axis].at(index), sum.force[axis]);
            }
        }
        for (index, u) in step.means.iter().enumerate() {
            for (axis, of) in metric::MEAN.components().into_iter().enumerate() {
                push(&mut all, of.at(index), u[axis]);
            }
        }
        all.extend(step.points.iter().chain(&step.more).chain(&step.against));
        all
    }

    /// Rows of the warnings for the report.
    pub fn warning_rows(&self) -> Vec<records::Warning> {
        let run = self.row().run;
        let each = self.warnings.iter().map(|warning| records::Warning {
            case: self.identity.case.clone(),
            method: self.identity.method.clone(),
            run: run.clone(),
            code: warning.kind.code.into(),
            message: warning.message.clone(),
            value: warning.value,
            unit: warning.unit.into(),
            place: warning.place.clone(),
        });
        each.collect()
    }

    /// Rows of the plan for the report.
    pub fn plan_entries(&self) -> Vec<PlanEntry> {
        self.plan
            .stages()
            .iter()
            .map(|stage| PlanEntry {
                case: self.identity.case.clone(),
                method: self.identity.method.clone(),
                stage: stage.stage.name().into(),
                ran: stage.ran,
                why: stage.why.clone(),
            })
            .collect()
    }

    /// Rows of a transfer, which is a run of its own: from this method, by the scheme.
    fn transfer_records(&self, own: &Record, transfer: &Transfer) -> Vec<Record> {
        let SchemeSettings { neighbours, power, support_scale, shape, polynomial } = transfer.settings;
        let row = Record {
            case: own.case.clone(),
            purpose: own.purpose,
            published: own.published.clone(),
            method: transfer.scheme.clone(),
            series: transfer.scheme.clone(),
            family: Family::Interp,
            variant: transfer.scheme.clone(),
            from: Some(own.method.clone()),
            // A method id may occur with several kernels.
            kernel: Some(own.variant.clone()),
            neighbours,
            power,
            support_scale,
            shape,
            polynomial,
            points: transfer.targets as u64,
            poisson: own.poisson,
            level: own.level,
            nodes: own.nodes,
            elements: own.elements,
            dofs: own.dofs,
            spacing: own.spacing,
            seed: own.seed,
            ..Record::default()
        };
        // The id also distinguishes settings of the method for which a scheme's row has no column.
        let row = Record { run: digest(&format!("{} {}", own.run, run_id(&row))), ..row };
        let mut rows: Vec<Record> = transfer.metrics.iter().map(|m| number(&row, m)).collect();
        transfer.times.iter().for_each(|timed| rows.extend(times(&row, timed)));
        rows
    }
}

/// Id of the run of a row: a hash of its case, method, settings and size. It is the same in every study.
pub(crate) fn run_id(row: &Record) -> String {
    let Record { case, method, family, variant, poisson, level, nodes, elements, seed, .. } = row;
    let size = (poisson, level, nodes, elements, seed);
    let what = (case, method, family, variant, row.settings(), size);
    digest(&serde_json::to_string(&what).expect("texts and numbers"))
}

fn digest(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_hex()[..16].to_string()
}

/// Row of a metric's value.
fn number(row: &Record, metric: &Metric) -> Record {
    Record { statistic: "value".into(), value: metric.value, ..row.clone() }.with(metric.of)
}

/// Rows of a phase's times: wall-clock and CPU time of every repeat, and their statistics.
fn times(row: &Record, timed: &Timed) -> Vec<Record> {
    let of = |kind: &'static metric::Metric, statistic: &str, repeat: Option<usize>, value: f64| {
        let row = Record {
            phase: timed.phase.into(),
            statistic: statistic.into(),
            repeat: repeat.map(|r| r as u64 + 1),
            value,
            ..row.clone()
        };
        row.with(kind)
    };
    let Summary { median, spread, min } = timed.summary();
    let mut rows: Vec<Record> = [("median", median), ("spread", spread), ("min", min)]
        .map(|(statistic, value)| of(&metric::TIME, statistic, None, value))
        .into();
    rows.extend(timed.cpu_median().map(|median| of(&metric::CPU_TIME, "median", None, median)));
    for (kind, all) in [(&metric::TIME, &timed.wall), (&metric::CPU_TIME, &timed.cpu)] {
        rows.extend(all.iter().enumerate().map(|(r, &value)| of(kind, "repeat", Some(r), value)));
    }
    rows
}
