//! Test of the publication's claim that EFG is about as accurate as finite elements at a small fraction of
//! their cost.
//!
//! The claim concerns contact with jaws, so cases without contact do not test it.

use records::Family;
use records::text::{list, percent, significant};

use crate::figures::chosen;
use crate::fronts::{Clock, QUESTIONS, judged};
use crate::published::{Publication, tested};
use crate::select::Run;

/// A run's `(seconds, relative error)`.
type Point = (f64, f64);

/// One sentence for each case that tests a publication and has known errors.
pub(super) fn claim(runs: &[Run]) -> Vec<String> {
    let claim = |(case, group): (String, &[Run])| {
        let publication = tested(group[0].is).filter(|_| group.iter().any(Run::has_contact))?;
        let share = seconds(publication, Family::Efg) / seconds(publication, Family::Fem);
        Some(format!("{case}: {}", verdict(group, share)?))
    };
    chosen(runs).into_iter().filter_map(claim).collect()
}

/// Total time of the published run, s.
fn seconds(publication: &Publication, family: Family) -> f64 {
    let phases = ["total", "prepare", "assemble+factor+solve", "transfer"];
    phases.iter().filter_map(|phase| publication.number(family, phase)).sum()
}

fn verdict(group: &[Run], share: f64) -> Option<String> {
    let less = percent(1.0 - share);
    let (mut phrases, mut sides, mut missing) = (Vec::new(), [Vec::new(), Vec::new(), Vec::new()], None);
    let mut elements: Vec<String> = Vec::new();
    for question in &QUESTIONS {
        let Some(error) = question.error(group) else { continue };
        let of = |family: Family| -> Vec<Point> {
            let own = group.iter().filter(|r| r.is.family == family);
            own.filter_map(|run| judged(run, error, Clock::First)).collect()
        };
        let (fem, efg) = (of(Family::Fem), of(Family::Efg));
        let Some(matched) = Matched::of(&fem, &efg) else {
            missing = missing.or(match (fem.is_empty(), efg.is_empty()) {
                (false, true) => Some("EFG"),
                (true, false) => Some("FEM"),
                _ => None,
            });
            continue;
        };
        let timed = |r: &&Run| r.is.family == Family::Fem && judged(r, error, Clock::First).is_some();
        elements.extend(group.iter().filter(timed).map(|r| r.name().to_string()));
        phrases.push(matched.phrase(question.name));
        sides[matched.side(share)].push(question.name.to_string());
    }
    if phrases.is_empty() {
        return missing.map(|family| {
            format!(
                "the publication claims that EFG is about as accurate as FEM at {less} less cost. This claim can't be \
                 judged here: no {family} run has both a time and an error."
            )
        });
    }
    elements.sort();
    elements.dedup();
    let words = ["holds for", "holds at some errors only for", "does not hold for"];
    let verdicts = words.iter().zip(&sides).filter(|(_, names)| !names.is_empty());
    let verdicts: Vec<String> = verdicts.map(|(words, names)| format!("{words} {}", list(names))).collect();
    Some(format!(
        "the fastest EFG run is compared with the fastest FEM run ({}) at equal error. {} The publication claims \
         {less} less cost at about the same accuracy. This claim {}.",
        list(&elements),
        phrases.join(" "),
        verdicts.join(", ")
    ))
}

/// Ratios of times of clouds to times of elements at equal errors, over the range that both reach.
#[derive(Debug, PartialEq)]
pub(crate) struct Matched {
    /// Smallest and largest ratio.
    pub(crate) ratio: (f64, f64),
    /// Smallest error of elements and of clouds.
    pub(crate) least: (f64, f64),
}

impl Matched {
    /// Compares two sets of runs. The smallest time within an error changes only at errors of the runs, so
    /// all ratios occur there.
    pub(crate) fn of(fem: &[Point], efg: &[Point]) -> Option<Matched> {
        let within =
            |runs: &[Point], error: f64| runs.iter().filter(|p| p.1 <= error).map(|p| p.0).reduce(f64::min);
        let errors = || fem.iter().chain(efg).map(|p| p.1);
        let ratios = || errors().filter_map(|e| Some(within(efg, e)? / within(fem, e)?));
        let least = |runs: &[Point]| runs.iter().map(|p| p.1).reduce(f64::min);
        Some(Matched {
            ratio: (ratios().reduce(f64::min)?, ratios().reduce(f64::max)?),
            least: (least(fem)?, least(efg)?),
        })
    }

    fn phrase(&self, name: &str) -> String {
        let times = |ratio: f64| significant(ratio, 2);
        let (low, high) = (times(self.ratio.0), times(self.ratio.1));
        let span = if low == high { low } else { format!("{low} to {high}") };
        let (fem, efg) = self.least;
        let (limit, family, other, beyond) =
            if fem > efg { (fem, "FEM", "EFG", efg) } else { (efg, "EFG", "FEM", fem) };
        format!(
            "For the {name}, EFG takes {span} times as long, down to an error of {} (no {family} run is more \
             accurate; the best {other} run has {}).",
            percent(limit),
            percent(beyond)
        )
    }

    /// 0 if the published fraction holds at every error, 1 if at some, 2 if at none.
    fn side(&self, share: f64) -> usize {
        usize::from(self.ratio.1 > share) + usize::from(self.ratio.0 > share)
    }
}

#[cfg(test)]
mod tests {
    use super::{Matched, claim, seconds};
    use crate::fronts::tests::{record, run};
    use crate::published::tested;
    use crate::select::runs;
    use records::{Family, Record};

    #[test]
    fn the_published_costs_are_half_a_percent() {
        let publication = tested(&run(("tet4", Family::Fem), 1, 1.0, &[])[0]).unwrap();
        assert!(
            (seconds(publication, Family::Efg) / seconds(publication, Family::Fem) - 33.07 / 7200.0).abs()
                < 1e-15
        );
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

    fn verdict(efg: f64, error: f64) -> String {
        let fem = [
            run(("tet4", Family::Fem), 100, 10.0, &[("relative-rms", 0.2)]),
            run(("hex20", Family::Fem), 200, 1000.0, &[("relative-rms", 0.1)]),
        ];
        let cloud = run(("efg", Family::Efg), 83, efg, &[("relative-rms", error)]);
        let records: Vec<Record> = fem.into_iter().flatten().chain(cloud).collect();
        let found = claim(&runs(&records));
        assert_eq!(found.len(), 1);
        found[0].clone()
    }

    #[test]
    fn the_claim_is_held_against_the_runs() {
        assert_eq!(
            verdict(500.0, 0.1),
            "jaws: the fastest EFG run is compared with the fastest FEM run (hex20 and tet4) at equal error. For the \
             displacement, EFG takes 0.50 to 50 times as long, down to an error of 10.0 % (no EFG run is more \
             accurate; the best FEM run has 10.0 %). The publication claims 99.5 % less cost at about the same \
             accuracy. This claim does not hold for displacement."
        );
        assert!(verdict(0.04, 0.1).ends_with("accuracy. This claim holds for displacement."));
        assert!(
            verdict(4.0, 0.1).ends_with("accuracy. This claim holds at some errors only for displacement.")
        );
        let coarse = verdict(0.04, 0.15);
        assert!(
            coarse.contains(
                "down to an error of 15.0 % (no EFG run is more accurate; the best FEM run has 10.0 %)."
            ),
            "{coarse}"
        );
    }

    #[test]
    fn a_scene_without_contact_is_not_set_against_two_hours_of_it() {
        let mut records = run(("tet4", Family::Fem), 1331, 0.02, &[("relative-rms", 0.2)]);
        records.extend(run(("efg", Family::Efg), 83, 0.01, &[("relative-rms", 0.2)]));
        let times = |records: &[Record]| {
            let runs = runs(records);
            let paper = tested(&records[0]).unwrap();
            let of = |quantity| paper.numbers.iter().find(move |p| p.quantity == quantity).unwrap();
            (
                claim(&runs).len(),
                ["total", "prepare", "max-x"].map(|q| runs.iter().any(|run| of(q).is_of(run))),
            )
        };
        // A quasi-static case with contact: the published two hours were for explicit dynamics.
        assert_eq!(times(&records), (1, [false, true, true]));
        let is = ("jaws", "tet4", Family::Fem);
        let explicit = [&records[..], &[record(is, 1331, ("time-steps", ""), 37000.0)]].concat();
        assert_eq!(times(&explicit), (1, [true, true, true]));
        records.retain(|r| r.quantity != "tool-force");
        assert_eq!(times(&records), (0, [false, true, true]));
    }

    #[test]
    fn what_is_not_known_is_said_and_other_cases_are_left_out() {
        let mut records = run(("tet4", Family::Fem), 100, 10.0, &[("relative-rms", 0.2)]);
        assert_eq!(
            claim(&runs(&records)),
            [
                "jaws: the publication claims that EFG is about as accurate as FEM at 99.5 % less cost. This claim \
                 can't be judged here: no EFG run has both a time and an error."
            ]
        );
        records.iter_mut().for_each(|r| r.published.clear());
        assert!(claim(&runs(&records)).is_empty());
    }
}
