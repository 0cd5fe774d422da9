//! Verdict of results on a claim: its relations between two sides of methods, case by case.

use catalogue::metric::Metric;
use records::RunSet;
use records::text::{list, percent, significant};

use super::claim::{Claim, ClaimVerdict, tested};
use super::relation::{Kind, Relation, Side};
use crate::busy::decide;
use crate::fronts::{Clock, is_unanswerable, judged};
use crate::select::{Run, chosen, runs, solved};

/// A claim with its verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// Verdict of the results.
    pub verdict: ClaimVerdict,
    /// A line for each scene and relation.
    pub lines: Vec<String>,
}

impl Claim {
    /// Judges the claim by the runs of its scenes.
    pub fn judge(&self, set: &RunSet) -> Judged {
        let mut all = runs(&set.records);
        decide(&mut all, &set.provenance.machine);
        let all = solved(&all);
        let (mut lines, mut held) = (Vec::new(), Vec::new());
        for scene in &self.scenes {
            let of_scene: Vec<Run> = all.iter().filter(|run| run.is.case == *scene).cloned().collect();
            for relation in &self.relation {
                let (found, line) = relation.holds(&of_scene, self);
                lines.push(format!("{scene}: {line}"));
                held.push(found);
            }
        }
        // A single relation without runs prevents the claim from being validated or refuted as a whole.
        let all = |wanted: Option<Held>| held.iter().all(|found| *found == wanted);
        let verdict = if all(None) {
            ClaimVerdict::Untested
        } else if all(Some(Held::Always)) {
            ClaimVerdict::Validated
        } else if all(Some(Held::Never)) {
            ClaimVerdict::Refuted
        } else {
            ClaimVerdict::Qualified
        };
        Judged { verdict, lines }
    }

    /// Name, time and error of the runs of one side in a case; none if the case prescribes the result.
    fn points<'a>(&self, side: &Side, runs: &[Run<'a>], error: &'static Metric) -> Vec<(&'a str, Point)> {
        let like = |run: &&Run| side.takes(run.is) && self.needs.iter().all(|quantity| run.has(quantity.0));
        let point = |run: &Run<'a>| Some((run.name(), judged(run, error, Clock::First)?));
        let answered = if is_unanswerable(error, runs) { &[] } else { runs };
        answered.iter().filter(like).filter_map(point).collect()
    }

    /// The comparison of the runs of one case, `None` if they have no times and errors to compare.
    fn finding(&self, runs: &[Run]) -> Option<String> {
        let [left, right] = [&self.left, &self.right].map(|side| {
            let of = |relation: &Relation| self.points(side, runs, relation.error.0.metric);
            let mut names: Vec<String> =
                self.relation.iter().flat_map(of).map(|(name, _)| name.to_string()).collect();
            names.sort();
            names.dedup();
            names
        });
        let verdict = if left.is_empty() || right.is_empty() {
            let missing = if left.is_empty() { &self.left } else { &self.right };
            (left.len() + right.len() > 0).then(|| {
                format!("can't be judged here: no {} run has both a time and an error", missing.name())
            })?
        } else {
            let found = self.relation.iter().map(|relation| relation.holds(runs, self));
            let lines: Vec<String> = found.filter(|(held, _)| held.is_some()).map(|(_, line)| line).collect();
            format!(
                "is tested by {} ({}) against {} ({}): {}",
                self.left.name(),
                list(&left),
                self.right.name(),
                list(&right),
                lines.join("; ")
            )
        };
        Some(format!("the claim \"{}\" ({}) {verdict}.", self.says, self.source))
    }
}

/// One sentence for each case that tests a claim of the program and has known errors.
pub(crate) fn findings(runs: &[Run]) -> Vec<String> {
    let of =
        |(case, group): (String, &[Run])| Some(format!("{case}: {}", tested(group[0].is)?.finding(group)?));
    chosen(runs).into_iter().filter_map(of).collect()
}

/// Extent to which a relation holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Held {
    Always,
    /// Holds at some errors only.
    Partly,
    Never,
}

impl Relation {
    /// Compares the runs of the two sides in one case, and returns the extent to which the relation holds
    /// (`None` if there is nothing to compare) and a line that reports the result.
    fn holds(&self, runs: &[Run], claim: &Claim) -> (Option<Held>, String) {
        let error = self.error.0.metric;
        let label = error.label;
        let [left, right] = [&claim.left, &claim.right].map(|side| -> Vec<Point> {
            claim.points(side, runs, error).into_iter().map(|(_, point)| point).collect()
        });
        let (ours, theirs) = (claim.left.name(), claim.right.name());
        let Some(matched) = Matched::of(&right, &left) else {
            let missing = match (left.is_empty(), right.is_empty()) {
                (true, false) => format!("{ours} "),
                (false, true) => format!("{theirs} "),
                _ => String::new(),
            };
            return (None, format!("{label}: no {missing}run has both a time and this error"));
        };
        let (right, left) = matched.least;
        let (least, most) = match self.kind {
            Kind::ErrorRatio => (left / right, left / right),
            Kind::TimeRatio => matched.ratio,
        };
        let [low, high] = [least, most].map(|ratio| significant(ratio, 2));
        let span = if low == high { low } else { format!("{low} to {high}") };
        let what = match self.kind {
            Kind::ErrorRatio => format!(
                "the best {ours} run has {}, {span} times as much as the best {theirs} run ({})",
                percent(left),
                percent(right)
            ),
            Kind::TimeRatio => {
                let (limit, worse, better, beyond) =
                    if right > left { (right, &theirs, &ours, left) } else { (left, &ours, &theirs, right) };
                format!(
                    "{ours} takes {span} times as long as {theirs} at equal error, down to {} (no {worse} run is more \
                     accurate; the best {better} run has {})",
                    percent(limit),
                    percent(beyond)
                )
            }
        };
        let bound = self.at_most * (1.0 + self.tolerance);
        let (held, word) = match (most <= bound, least <= bound) {
            (true, _) => (Held::Always, "holds"),
            (_, true) => (Held::Partly, "holds at some errors only"),
            _ => (Held::Never, "does not hold"),
        };
        (Some(held), format!("{label}: {what}, claimed at most {}: {word}", significant(self.at_most, 2)))
    }
}

/// A run's `(seconds, relative error)`.
type Point = (f64, f64);

/// Ratios of the times of the left side to those of the right side at equal errors, over the range that both
/// reach.
#[derive(Debug, PartialEq)]
struct Matched {
    /// Smallest and largest ratio.
    ratio: (f64, f64),
    /// Smallest error of the right side and of the left side.
    least: (f64, f64),
}

impl Matched {
    /// Compares two sets of runs. The smallest time within an error changes only at errors of the runs, so
    /// all ratios occur there.
    fn of(right: &[Point], left: &[Point]) -> Option<Matched> {
        let within =
            |runs: &[Point], error: f64| runs.iter().filter(|p| p.1 <= error).map(|p| p.0).reduce(f64::min);
        let errors = || right.iter().chain(left).map(|p| p.1);
        let ratios = || errors().filter_map(|e| Some(within(left, e)? / within(right, e)?));
        let least = |runs: &[Point]| runs.iter().map(|p| p.1).reduce(f64::min);
        Some(Matched {
            ratio: (ratios().reduce(f64::min)?, ratios().reduce(f64::max)?),
            least: (least(right)?, least(left)?),
        })
    }
}

#[cfg(test)]
mod tests {
    use records::{Family, Record};

    use super::super::claim::parse;
    use super::*;
    use crate::fronts::tests::run;

    const CLAIM: &str = r#"[[claim]]
id = "cheap"
source = "somebody"
says = "clouds are as accurate and cheaper"
scenes = ["jaws"]
left = { family = "efg" }
right = { family = "fem", methods = ["tet4", "hex20"] }
needs = ["tool-force"]
[[claim.relation]]
kind = "error-ratio"
error = "relative-rms"
at_most = 1.0
tolerance = 0.1
[[claim.relation]]
kind = "time-ratio"
error = "relative-rms"
at_most = 0.01
"#;

    fn set(efg: f64, error: f64) -> RunSet {
        let fem = [
            run(("tet4", Family::Fem), 100, 10.0, &[("relative-rms", 0.2)]),
            run(("hex20", Family::Fem), 200, 1000.0, &[("relative-rms", 0.1)]),
            // A method outside of the claim.
            run(("hex8", Family::Fem), 200, 1e-3, &[("relative-rms", 0.01)]),
        ];
        let cloud = run(("efg", Family::Efg), 83, efg, &[("relative-rms", error)]);
        RunSet { records: fem.into_iter().flatten().chain(cloud).collect(), ..RunSet::default() }
    }

    fn judged_of(claim: &str, efg: f64, error: f64) -> Judged {
        parse(claim).unwrap()[0].judge(&set(efg, error))
    }

    fn judged(efg: f64, error: f64) -> Judged {
        judged_of(CLAIM, efg, error)
    }

    #[test]
    fn a_claim_is_validated_qualified_refuted_or_untested() {
        assert_eq!(judged(0.05, 0.105).verdict, ClaimVerdict::Validated);
        // Either cheap enough compared with hex20 but not with tet4, or cheap but less accurate.
        assert_eq!(judged(5.0, 0.1).verdict, ClaimVerdict::Qualified);
        assert_eq!(judged(0.05, 0.15).verdict, ClaimVerdict::Qualified);
        let refuted = judged(500.0, 0.15);
        assert_eq!(refuted.verdict, ClaimVerdict::Refuted);
        assert_eq!(
            refuted.lines,
            [
                "jaws: relative RMS error: the best EFG run has 15.0 %, 1.5 times as much as the best tet4 and hex20 \
                 run (10.0 %), claimed at most 1.0: does not hold",
                "jaws: relative RMS error: EFG takes 0.50 to 50 times as long as tet4 and hex20 at equal error, down \
                 to 15.0 % (no EFG run is more accurate; the best tet4 and hex20 run has 10.0 %), claimed at most \
                 0.010: does not hold",
            ]
        );
        // A claim that holds in one scene is not validated if another scene has no runs.
        let twice = CLAIM.replace("[\"jaws\"]", "[\"jaws\", \"liver\"]");
        assert_eq!(judged_of(&twice, 0.05, 0.105).verdict, ClaimVerdict::Qualified);
        let untested = parse(CLAIM).unwrap()[0].judge(&RunSet::default());
        assert_eq!((untested.verdict, untested.lines.len()), (ClaimVerdict::Untested, 2));
    }

    #[test]
    fn a_file_that_is_none_of_claims_is_refused_with_its_line() {
        for (from, to, says) in [
            ("at_most = 0.01", "at_most = -1", "at_most above 0"),
            ("time-ratio", "time-ratios", "line 15"),
            ("scenes = [\"jaws\"]", "scenes = []", "needs scenes"),
            ("source", "sauce", "line 3"),
        ] {
            let bad = parse(&CLAIM.replace(from, to)).unwrap_err();
            assert!(bad.contains(says), "{says}: {bad}");
        }
    }

    #[test]
    fn ratios_are_those_of_the_least_times_at_equal_errors() {
        let fem = [(1.0, 0.2), (4.0, 0.1), (3.0, 0.15), (9.0, 0.15)];
        let efg = [(2.0, 0.3), (30.0, 0.12), (5.0, 0.16), (90.0, 0.05)];
        // At 0.3: 2 / 1. At 0.2 and 0.16: 5 / 1, 5 / 3. At 0.15: 30 / 3. At 0.12 and 0.1: 30 / 4, 90 / 4.
        // Smaller errors have no match.
        let matched = Matched::of(&fem, &efg).unwrap();
        assert_eq!(matched, Matched { ratio: (5.0 / 3.0, 22.5), least: (0.1, 0.05) });
        assert_eq!(Matched::of(&fem, &[]), None);
    }

    #[test]
    fn a_case_is_compared_by_the_runs_that_the_claim_is_about() {
        let found = |records: &[Record]| parse(CLAIM).unwrap()[0].finding(&runs(records));
        let mut records = set(500.0, 0.15).records;
        let all = found(&records).unwrap();
        assert!(
            all.starts_with(
                "the claim \"clouds are as accurate and cheaper\" (somebody) is tested by EFG (efg) against tet4 and \
                 hex20 (hex20 and tet4): relative RMS error: the best EFG run"
            ) && all.ends_with("claimed at most 0.010: does not hold."),
            "{all}"
        );
        assert_eq!(findings(&runs(&records)).len(), 1);
        records.retain(|r| r.family == Family::Fem);
        assert!(found(&records).unwrap().ends_with("judged here: no EFG run has both a time and an error."));
        // Without contact there is nothing to compare with contact.
        records.retain(|r| r.quantity != "tool-force");
        assert_eq!(found(&records), None);
        records.iter_mut().for_each(|r| r.published.clear());
        assert!(findings(&runs(&records)).is_empty());
    }
}
