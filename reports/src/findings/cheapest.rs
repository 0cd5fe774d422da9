//! Which method reaches an error in the least time.

use crate::figures::chosen;
use crate::fronts::{Clock, QUESTIONS, point};
use crate::select::{Run, labels};
use crate::text::{duration, list, percent, significant};

/// Relative errors that a user may be content with.
const TOLERANCES: [f64; 4] = [0.1, 0.03, 0.01, 0.003];

/// The displacement is reported next to a single number where it is off by more than this many tolerances: it may be right by chance.
const CHANCE: f64 = 3.0;

/// A timed run with its error.
struct Timed<'a, 'r> {
    run: &'a Run<'r>,
    label: &'a str,
    seconds: f64,
    error: f64,
}

impl Timed<'_, '_> {
    fn is_fem(&self) -> bool {
        self.run.is.family.is_elements()
    }
}

/// One sentence for each case, question and kind of time that at least two methods answer.
pub(super) fn cheapest(runs: &[Run]) -> Vec<String> {
    let mut out = Vec::new();
    for (case, group) in chosen(runs) {
        let labels = labels(group.iter().map(|r| r.is));
        let displacement = QUESTIONS[0].error(group);
        for (clock, after) in Clock::ALL.into_iter().zip(["", ", repeated solves"]) {
            for question in &QUESTIONS {
                let Some(error) = question.error(group) else { continue };
                let timed = |(run, label)| {
                    let (seconds, error) = point(run, error, clock)?;
                    Some(Timed { run, label, seconds, error })
                };
                let names = labels.iter().map(String::as_str);
                let timed: Vec<Timed> = group.iter().zip(names).filter_map(timed).collect();
                if timed.iter().any(|t| t.label != timed[0].label) {
                    let beside = displacement.filter(|_| question.scalar);
                    out.push(format!("{case}, {}{after}: {}", question.name, answers(&timed, beside)));
                }
            }
        }
    }
    out
}

/// What every tolerance takes, and which of them no run reaches. `beside` is an error reported where it is far larger.
fn answers(timed: &[Timed], beside: Option<&str>) -> String {
    let mut answers: Vec<(Vec<String>, String)> = Vec::new();
    let mut missed = Vec::new();
    for tolerance in TOLERANCES {
        match answer(timed, tolerance, beside) {
            None => missed.push(percent_of(tolerance)),
            Some(text) => match answers.last_mut().filter(|last| last.1 == text) {
                Some(same) => same.0.push(percent_of(tolerance)),
                None => answers.push((vec![percent_of(tolerance)], text)),
            },
        }
    }
    let mut parts: Vec<String> = answers
        .into_iter()
        .map(|(reached, text)| format!("Within {} error, {text}.", list(&reached)))
        .collect();
    let closest = timed.iter().min_by(|a, b| a.error.total_cmp(&b.error));
    if let (Some(closest), false) = (closest, missed.is_empty()) {
        parts.push(format!(
            "No run reaches {}; the most accurate is {}, with {}.",
            missed[0],
            phrase(closest, closest.error, beside, ""),
            percent(closest.error)
        ));
    }
    parts.join(" ")
}

/// The cheapest within a tolerance, and where elements and clouds compete the best of the others.
fn answer(timed: &[Timed], tolerance: f64, beside: Option<&str>) -> Option<String> {
    let cheapest = |fits: &dyn Fn(&Timed) -> bool| {
        let good = timed.iter().filter(|t| t.error <= tolerance && fits(t));
        good.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    };
    let best = cheapest(&|_| true)?;
    let mut text = format!("the fastest is {}", phrase(best, tolerance, beside, ""));
    let other = |t: &Timed| t.is_fem() != best.is_fem();
    if timed.iter().any(other) {
        let family = if best.is_fem() { "EFG" } else { "FEM" };
        text += &match cheapest(&other) {
            None => format!("; no {family} run is that accurate"),
            Some(next) => {
                let longer = format!(", {} times as long", significant(next.seconds / best.seconds, 2));
                format!("; the fastest {family} run is {}", phrase(next, tolerance, beside, &longer))
            }
        };
    }
    Some(text)
}

/// `hex20 (2.00 ms, 100 nodes)`, with more between the brackets.
fn phrase(timed: &Timed, tolerance: f64, beside: Option<&str>, more: &str) -> String {
    let off = beside.and_then(|error| timed.run.value(error)).filter(|e| *e > CHANCE * tolerance);
    let off = off.map_or(String::new(), |e| format!(", but {} displacement error", percent(e)));
    format!("{} ({}{more}, {} nodes{off})", timed.label, duration(timed.seconds), timed.run.is.nodes)
}

/// A tolerance has no digits to spare.
fn percent_of(tolerance: f64) -> String {
    format!("{} %", significant(100.0 * tolerance, 1))
}

#[cfg(test)]
mod tests {
    use super::cheapest;
    use crate::fronts::tests::{record, run};
    use crate::record::{Family, Record};
    use crate::select::runs;

    fn jaws(errors: &[(&str, Family, u64, f64, f64)], name: &str) -> Vec<Record> {
        errors
            .iter()
            .flat_map(|&(id, family, nodes, t, e)| run((id, family), nodes, t, &[(name, e)]))
            .collect()
    }

    #[test]
    fn every_tolerance_has_the_best_of_both_families_or_no_run() {
        let records = jaws(
            &[
                ("hex20", Family::Fem, 100, 0.002, 0.05),
                ("hex20", Family::Fem, 900, 0.04, 0.02),
                ("tet4", Family::Fem, 500, 0.01, 0.09),
                ("efg", Family::Efg, 83, 0.001, 0.3),
                ("efg", Family::Efg, 332, 0.02, 0.04),
                ("efg", Family::Efg, 1331, 0.5, 0.006),
            ],
            "relative-rms",
        );
        assert_eq!(
            cheapest(&runs(&records)),
            [
                "jaws, displacement: Within 10 % error, the fastest is hex20 (2.00 ms, 100 nodes); the fastest EFG run is efg (20.0 ms, 10 times \
              as long, 332 nodes). Within 3 % error, the fastest is hex20 (40.0 ms, 900 nodes); the fastest EFG run is efg (500 ms, 12 times as \
              long, 1331 nodes). Within 1 % error, the fastest is efg (500 ms, 1331 nodes); no FEM run is that accurate. No run reaches \
              0.3 %; the most accurate is efg (500 ms, 1331 nodes), with 0.600 %."
            ]
        );
    }

    #[test]
    fn tolerances_of_one_answer_share_it_and_an_absent_family_is_not_missed() {
        let elements = [("hex20", Family::Fem, 100, 0.002, 0.001), ("tet4", Family::Fem, 100, 0.001, 0.2)];
        assert_eq!(
            cheapest(&runs(&jaws(&elements, "pressure"))),
            [
                "jaws, pressure: Within 10 %, 3 %, 1 % and 0.3 % error, the fastest is hex20 (2.00 ms, 100 nodes)."
            ]
        );
        // One method has nothing to be cheaper than, and the reference itself is none.
        assert!(cheapest(&runs(&jaws(&elements[..1], "pressure"))).is_empty());
        let itself = [elements[0], ("tet10", Family::Fem, 100, 0.001, 0.0)];
        assert!(cheapest(&runs(&jaws(&itself, "pressure"))).is_empty());
    }

    #[test]
    fn a_number_right_by_chance_comes_with_the_error_of_its_field() {
        let both = |force, rms| [("tool-force-error", force), ("relative-rms", rms)];
        let records = [
            run(("efg", Family::Efg), 83, 1.0, &both(0.02, 0.4)),
            run(("tet4", Family::Fem), 100, 2.0, &both(0.05, 0.2)),
        ]
        .concat();
        let found = cheapest(&runs(&records));
        assert_eq!(found.len(), 2);
        assert_eq!(
            found[1],
            "jaws, tool force: Within 10 % error, the fastest is efg (1.00 s, 83 nodes, but 40.0 % displacement error); the fastest FEM run is \
             tet4 (2.00 s, 2.0 times as long, 100 nodes). Within 3 % error, the fastest is efg (1.00 s, 83 nodes, but 40.0 % displacement \
             error); no FEM run is that accurate. No run reaches 1 %; the most accurate is efg (1.00 s, 83 nodes, \
             but 40.0 % displacement error), with 2.00 %."
        );
    }

    #[test]
    fn repeated_solves_have_their_own_times() {
        let methods = [("hex20", Family::Fem, 100, 0.002, 0.001), ("tet4", Family::Fem, 100, 0.001, 0.002)];
        let mut records = jaws(&methods, "l2");
        for (method, t) in [("hex20", 1e-4), ("tet4", 2e-4)] {
            records.push(record(("jaws", method, Family::Fem), 100, ("time", "repeated:p99"), t));
            records.push(record(("jaws", method, Family::Fem), 100, ("time", "repeated:median"), 0.5 * t));
        }
        assert_eq!(
            cheapest(&runs(&records)),
            [
                "jaws, displacement: Within 10 %, 3 %, 1 % and 0.3 % error, the fastest is tet4 (1.00 ms, 100 nodes).",
                "jaws, displacement, repeated solves: Within 10 %, 3 %, 1 % and 0.3 % error, the fastest is hex20 (100 µs, 100 nodes)."
            ]
        );
    }
}
