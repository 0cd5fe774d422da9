//! Questions put to every case, for each kind of time: the runs that answer, with their time and error.

use catalogue::metric::{self, Metric};
use records::{Family, Purpose};

use crate::fronts::{Clock, QUESTIONS, Question, WANTED, band, counts, point};
use crate::plot::Scale;
use crate::seconds::Seconds;
use crate::select::{Run, Series, chosen, kernels, labels, series};

/// A run that answers a question.
#[derive(Clone, Debug)]
pub(crate) struct Timed {
    pub(crate) run: String,
    pub(crate) seconds: f64,
    /// Half the interquartile range of the repeats, s.
    pub(crate) spread: Option<f64>,
    /// Estimated error, if the error is measured.
    pub(crate) estimate: Option<f64>,
    /// Relative error.
    pub(crate) error: f64,
    /// Effective error of the answer: [`counts`].
    pub(crate) counts: f64,
}

/// An approximation at all its sizes.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) label: String,
    pub(crate) family: Family,
    pub(crate) runs: Vec<Timed>,
}

/// One question put to one case.
pub(crate) struct Ask {
    pub(crate) case: String,
    pub(crate) poisson: f64,
    pub(crate) title: String,
    pub(crate) question: &'static Question,
    pub(crate) clock: Clock,
    /// The quantity of the times of a first solve.
    pub(crate) by: Seconds,
    /// Error that answers the question.
    pub(crate) error: &'static Metric,
    pub(crate) lines: Vec<Line>,
    /// Method that the others are compared with. It has no error and so no place on the axes.
    pub(crate) reference: Option<String>,
    /// Relative error of the reference itself, if known.
    pub(crate) band: Option<f64>,
    /// Whether only kernels are compared.
    pub(crate) kernels: bool,
    pub(crate) rank: Rank,
}

impl Ask {
    /// Scale of the times.
    pub(crate) fn time(&self) -> Scale {
        Scale::times(match self.clock {
            Clock::First => self.by.name(),
            Clock::Repeated => "repeated solve, 99 % within",
        })
    }
}

/// Sort key of the questions of a page and its figures: the highest comes first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Rank {
    /// The time is that of a first solve.
    first: bool,
    /// The case does not reproduce a publication, with whose numbers it would be compared rather than judged.
    judged: bool,
    /// The case tests a published claim by the force of a tool in a first solve.
    claimed: bool,
    /// Some run answers within [`WANTED`].
    answered: bool,
    /// Number of competing runs.
    runs: usize,
}

impl Rank {
    /// The fields in the order of comparison.
    pub(crate) fn key(self) -> (bool, bool, bool, bool, usize) {
        (self.first, self.judged, self.claimed, self.answered, self.runs)
    }
}

/// All questions that at least two runs answer. If many kernels are compared, they have an additional
/// question for the displacement of a first solve.
pub(crate) fn asks(runs: &[Run]) -> Vec<Ask> {
    let mut out = Vec::new();
    for clock in Clock::ALL {
        for question in &QUESTIONS {
            let (mut asked, mut compared) = (Vec::new(), Vec::new());
            for (title, group) in chosen(runs) {
                let Some(error) = question.error(group) else { continue };
                let (usual, every) = kernels(&series(group));
                let ask = |title: String, lines: Vec<Line>, kernels: bool| Ask {
                    case: group[0].is.case.clone(),
                    poisson: group[0].is.poisson,
                    title,
                    question,
                    clock,
                    by: group[0].by,
                    error,
                    reference: reference_of(group).filter(|_| !kernels),
                    band: group.iter().filter_map(|run| band(run, error)).reduce(f64::max),
                    kernels,
                    rank: rank(&group[0], question, clock, &lines),
                    lines,
                };
                let displacement = QUESTIONS[0].error(group);
                let lines = |all: &[Series], names: Vec<String>| -> Vec<Line> {
                    let each = names.into_iter().zip(all);
                    let line = each.map(|(label, s)| line(label, s, (question, error), displacement, clock));
                    line.filter(|l| !l.runs.is_empty()).collect()
                };
                if clock == Clock::First && question.ending.is_empty() {
                    let names = every.iter().map(|s| s.is().variant.clone()).collect();
                    compared.push(ask(format!("{title}: kernels"), lines(&every, names), true));
                }
                let names = labels(usual.iter().map(|s| s.is()));
                asked.push(ask(title, lines(&usual, names), false));
            }
            asked.sort_by_key(|a| std::cmp::Reverse(a.rank));
            out.extend(asked.into_iter().chain(compared));
        }
    }
    // A single run has nothing to be compared with.
    out.retain(|a| runs_of(&a.lines) > 1);
    out
}

fn runs_of(lines: &[Line]) -> usize {
    lines.iter().map(|l| l.runs.len()).sum()
}

fn rank(run: &Run, question: &Question, clock: Clock, lines: &[Line]) -> Rank {
    let first = clock == Clock::First;
    let claimed = question.errors_are(&metric::TOOL_FORCE_ERROR) && !run.is.published.is_empty();
    let answered = lines.iter().flat_map(|line| &line.runs).any(|run| run.counts <= WANTED);
    let judged = run.is.purpose != Purpose::Published;
    Rank { first, judged, claimed: first && claimed, answered, runs: runs_of(lines) }
}

fn line(
    label: String,
    series: &Series,
    (question, error): (&Question, &'static Metric),
    displacement: Option<&'static Metric>,
    clock: Clock,
) -> Line {
    let timed = |run: &Run| {
        let (seconds, off) = point(run, error, clock)?;
        let spread =
            run.time("total", "spread").filter(|s| clock == Clock::First && *s > 0.0).map(|s| 0.5 * s);
        let counts = counts(run, question, displacement, (error, off));
        let estimate = question.estimated(run, error);
        Some(Timed { run: run.is.run.clone(), seconds, spread, estimate, error: off, counts })
    };
    Line { label, family: series.is().family, runs: series.runs.iter().filter_map(timed).collect() }
}

fn reference_of(group: &[Run]) -> Option<String> {
    let reference = group.iter().find(|r| r.is_reference())?;
    Some(format!("{} with {} nodes", reference.name(), reference.is.nodes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fronts::tests::record;
    use crate::select::runs;
    use records::Record;

    #[test]
    fn a_page_begins_with_the_claimed_force_that_is_answered_within_what_is_wanted() {
        let case = |case: &'static str, errors: &[f64], rms: f64| -> Vec<Record> {
            let run = |(k, &error): (usize, &f64)| {
                let of = (case, ["tet4", "hex8", "hex20", "tet10"][k], Family::Fem);
                let each = [
                    (("time", "total:median"), 1.0),
                    (("tool-force-error", ""), error),
                    (("relative-rms", ""), rms),
                ];
                each.map(|(what, value)| record(of, 100 + k as u64, what, value))
            };
            errors.iter().enumerate().flat_map(run).collect()
        };
        // More runs answer the other case, but none within the wanted error; a chance hit does not count.
        let begins = |records: &[Record]| {
            let runs = runs(records);
            let first = asks(&runs).into_iter().max_by_key(|ask| ask.rank).unwrap();
            (first.case.clone(), first.question.name)
        };
        let many = case("clouds", &[0.2, 0.1, 0.08, 0.07], 0.02);
        let lucky = case("lucky", &[0.2, 0.1, 0.001, 0.001], 0.6);
        let fair = case("fair", &[0.2, 0.004], 0.02);
        assert_eq!(begins(&[many.clone(), lucky.clone(), fair].concat()), ("fair".into(), "tool force"));
        assert_eq!(begins(&[many, lucky].concat()).1, "tool force");
    }
}
