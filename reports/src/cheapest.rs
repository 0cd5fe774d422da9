//! Cheapest method within an error, case by case: data of the table and of the performance profile.

use catalogue::metric;
use records::Family;

use crate::fronts::{Clock, WANTED};
use crate::questions::{Ask, Line, asks};
use crate::seconds::Seconds;
use crate::select::Run;

/// The quantity judged in a case: the tool force if its error is known, otherwise the displacement.
pub(crate) struct Problem {
    /// Title: the case, with a note if the force is judged.
    pub(crate) title: String,
    /// The clock by which the runs are compared.
    pub(crate) by: Seconds,
    /// Each method that was run, with its smallest time within the error.
    pub(crate) methods: Vec<Cheapest>,
}

/// Result of a method on a problem.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cheapest {
    pub(crate) label: String,
    pub(crate) family: Family,
    /// Smallest time (s), or `None` if no run of the method is within the error.
    pub(crate) seconds: Option<f64>,
}

/// Problems of all cases, in the order of the questions.
pub(crate) fn problems(runs: &[Run]) -> Vec<Problem> {
    let mut chosen: Vec<Ask> = Vec::new();
    for ask in asks(runs).into_iter().filter(|ask| ask.clock == Clock::First && !ask.kernels) {
        let force = ask.question.errors_are(&metric::TOOL_FORCE_ERROR);
        if !force && !ask.question.ending.is_empty() {
            continue;
        }
        match chosen.iter_mut().find(|known| known.title == ask.title) {
            Some(known) if force => *known = ask,
            Some(_) => {}
            None => chosen.push(ask),
        }
    }
    chosen.sort_by_key(|ask| std::cmp::Reverse(ask.rank));
    let problem = |ask: Ask| Problem {
        methods: ask.lines.iter().map(cheapest).collect(),
        by: ask.by,
        title: ask.title + if ask.question.scalar { ", force" } else { "" },
    };
    chosen.into_iter().map(problem).collect()
}

fn cheapest(line: &Line) -> Cheapest {
    let within = line.runs.iter().filter(|run| run.counts <= WANTED).map(|run| run.seconds);
    Cheapest { label: line.label.clone(), family: line.family, seconds: within.reduce(f64::min) }
}

/// Methods in the order of their first problem.
pub(crate) fn methods(problems: &[Problem]) -> Vec<(String, Family)> {
    let mut out: Vec<(String, Family)> = Vec::new();
    for method in problems.iter().flat_map(|p| &p.methods) {
        if out.iter().all(|known| known.0 != method.label) {
            out.push((method.label.clone(), method.family));
        }
    }
    out
}

/// Ratios of a method's times to the smallest of any method, ascending, for the problems that it solves
/// within the error. Also returns the number of problems that the method was run on and that any method
/// solves (Dolan and More 2002).
pub(crate) fn ratios(problems: &[Problem], label: &str) -> (Vec<f64>, usize) {
    let (mut out, mut of) = (Vec::new(), 0);
    for problem in problems {
        let least = problem.methods.iter().filter_map(|m| m.seconds).reduce(f64::min);
        let own = problem.methods.iter().find(|m| m.label == label);
        let (Some(least), Some(own)) = (least, own) else { continue };
        of += 1;
        out.extend(own.seconds.map(|seconds| seconds / least));
    }
    out.sort_by(f64::total_cmp);
    (out, of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fronts::tests::run;
    use crate::select::runs;
    use records::Record;

    #[test]
    fn the_cheapest_run_within_the_error_counts_and_chance_does_not() {
        let fem = |method, nodes, seconds, force, rms| {
            run((method, Family::Fem), nodes, seconds, &[("tool-force-error", force), ("relative-rms", rms)])
        };
        let records: Vec<Record> = [
            fem("tet4", 100, 1.0, 0.3, 0.4),
            // Right in force, but 60 % off in displacement.
            fem("hex8", 100, 1.0, 0.01, 0.6),
            fem("hex20", 100, 2.0, 0.04, 0.1),
            fem("hex20", 200, 8.0, 0.01, 0.02),
            fem("tet10", 300, 4.0, 0.02, 0.02),
        ]
        .concat();
        let runs = runs(&records);
        let problems = problems(&runs);
        assert_eq!(problems.len(), 1);
        assert_eq!(problems[0].title, "jaws, force");
        let seconds: Vec<_> = problems[0].methods.iter().map(|m| (m.label.as_str(), m.seconds)).collect();
        assert_eq!(seconds, [("tet4", None), ("tet10", Some(4.0)), ("hex8", None), ("hex20", Some(2.0))]);
        assert_eq!(ratios(&problems, "tet10"), (vec![2.0], 1));
        assert_eq!(ratios(&problems, "tet4"), (vec![], 1));
    }
}
