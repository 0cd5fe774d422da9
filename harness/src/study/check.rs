//! Checks of bounds on metrics of one run, or of a family of runs at several levels.

use cases::scene::{Bound, Check};
use catalogue::metric::{self, Address, Kind, Needs};
use records::{Check as Verdict, Family, Record, Status};

/// Value of a number among the records of one run, SI units; `None` if there is no such record.
pub fn value(of: Address, records: &[Record]) -> Option<f64> {
    let own = |r: &&Record| r.family != Family::Interp;
    if let Kind::Phase(phase) = of.metric.kind {
        let median = |r: &&Record| r.is(&metric::TIME) && r.phase == phase && r.statistic == "median";
        return records.iter().filter(own).find(median).map(|r| r.value);
    }
    if *of.metric == metric::TRANSFER_RMS {
        // The largest error of all requested schemes.
        return records.iter().filter(|r| r.is(of)).map(|r| r.value).reduce(f64::max);
    }
    let plain = |r: &&Record| {
        let whole = r.phase.is_empty() && r.step.is_none() && r.mode.is_none();
        whole && r.is(of) && r.statistic == "value"
    };
    records.iter().filter(own).find(plain).map(|r| r.value)
}

/// Own error of the reference in a number, among the records of one run; `None` if it is unknown.
pub fn band(of: Address, records: &[Record]) -> Option<f64> {
    records.iter().find(|r| r.is(of) && r.statistic == "band").map(|r| r.value)
}

/// Observed order of an error between the two finest levels of a family of runs, each given by its records.
fn order(error: Address, family: &[&[Record]]) -> Option<f64> {
    let mut points: Vec<(f64, f64)> =
        family.iter().filter_map(|run| Some((run.first()?.spacing, value(error, run)?))).collect();
    points.sort_by(|a, b| b.0.total_cmp(&a.0));
    reports::observed_order(&points)?.pairs.last().copied()
}

/// Value of a metric of several runs, each given by its records: an order of levels, or the fraction of
/// clouds that reached the load.
pub fn of_many(of: Address, runs: &[&[Record]]) -> Option<f64> {
    if *of.metric == metric::CARRIED_SHARE {
        let carried = runs.iter().filter(|records| carried(records)).count();
        return (!runs.is_empty()).then(|| carried as f64 / runs.len() as f64);
    }
    let Kind::Order(error) = of.metric.kind else { return None };
    order(error.whole(), runs)
}

/// Whether a run has results and reached the whole load. A procedure without load steps always reaches it.
pub fn carried(records: &[Record]) -> bool {
    !records.is_empty() && value(metric::LOAD_CARRIED.whole(), records).is_none_or(|load| load > 0.999_999)
}

/// Whether the check concerns several runs together: a family of levels, or clouds of many seeds.
pub fn is_of_many(check: &Check) -> bool {
    matches!(check.address.metric.needs, Needs::Levels | Needs::Seeds)
}

/// Whether one of the checks foresees an early end, and the records of the run keep its bound.
pub fn foreseen_end<'a>(checks: impl IntoIterator<Item = &'a Check>, records: &[Record]) -> bool {
    let kept =
        |check: &Check| judge(check, "", "", value(check.address, records), None).status != Status::Fail;
    checks.into_iter().any(|check| check.foresees_early_end() && kept(check))
}

/// Verdict on one value. A missing value fails, because the guarded quantity no longer exists. `band` is the
/// own error of the reference that the value is compared with: a bound below it proves nothing.
pub fn judge(check: &Check, case: &str, method: &str, value: Option<f64>, band: Option<f64>) -> Verdict {
    let (bound, status, reason) = match (&check.bound, value) {
        (bound, None) => (text(bound), Status::Fail, "this run gives no such number".to_string()),
        (Bound::Within { at_least, at_most }, Some(v)) => {
            // The comparisons are written so that NaN fails.
            let holds = at_least.is_none_or(|low| v >= low) && at_most.is_none_or(|high| v <= high);
            let off = (!holds).then(|| format!("{v:.6e} is not {}", text(&check.bound)));
            let unproven = band.filter(|band| at_most.is_some_and(|high| high < *band)).map(|band| {
                format!("the bound is below the reference's own error of about {band:.2e} and proves nothing")
            });
            let reason = [off, unproven].into_iter().flatten().collect::<Vec<_>>().join("; ");
            (text(&check.bound), if holds { Status::Pass } else { Status::Fail }, reason)
        }
        (Bound::KnownBand { low, high, reason }, Some(v)) => {
            // The comparisons are written so that NaN fails.
            if v >= *low && v <= *high {
                (text(&check.bound), Status::KnownFailure, reason.clone())
            } else {
                let away = format!("{v:.6e} is outside its known band ({}): {reason}", text(&check.bound));
                (text(&check.bound), Status::Fail, away)
            }
        }
    };
    Verdict {
        case: case.into(),
        method: method.into(),
        metric: check.address.to_string(),
        value: value.filter(|v| v.is_finite()),
        bound,
        capped: !matches!(check.bound, Bound::Within { at_most: None, .. }),
        status,
        reason,
        runs: Vec::new(),
        at: check.at.clone(),
    }
}

/// Ids of the runs that some records belong to, without those of transfer schemes and references.
pub fn run_ids<'r>(records: impl IntoIterator<Item = &'r Record>) -> Vec<String> {
    let solved = |r: &&Record| !matches!(r.family, Family::Interp | Family::Reference);
    let mut ids: Vec<String> = Vec::new();
    for record in records.into_iter().filter(solved) {
        if ids.last() != Some(&record.run) {
            ids.push(record.run.clone());
        }
    }
    ids
}

/// Verdict on a check of a failed run. The failure itself is counted separately.
pub fn not_run(check: &Check, case: &str, method: &str, failure: &str) -> Verdict {
    Verdict { status: Status::NotRun, reason: failure.into(), ..judge(check, case, method, None, None) }
}

fn text(bound: &Bound) -> String {
    match bound {
        Bound::Within { at_least: Some(low), at_most: Some(high) } => format!("from {low:e} to {high:e}"),
        Bound::Within { at_least: Some(low), at_most: None } => format!("at least {low:e}"),
        Bound::Within { at_least: None, at_most: Some(high) } => format!("at most {high:e}"),
        Bound::Within { at_least: None, at_most: None } => "any number".into(),
        Bound::KnownBand { low, high, .. } => format!("known to lie from {low:e} to {high:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn status(bound: Bound, value: Option<f64>) -> Status {
        let check = Check { address: metric::L2.whole(), methods: vec![], bound, at: String::new() };
        let verdict = judge(&check, "block", "tet4", value, None);
        assert_eq!(verdict.reason.is_empty(), verdict.status == Status::Pass, "{}", verdict.reason);
        assert!(verdict.value.is_none_or(f64::is_finite));
        verdict.status
    }

    #[test]
    fn a_bound_holds_on_its_side_and_at_its_end_and_never_of_no_number() {
        let within = |at_least, at_most| move |v| status(Bound::Within { at_least, at_most }, v);
        let (least, most, both) =
            (within(Some(1.0), None), within(None, Some(2.0)), within(Some(1.0), Some(2.0)));
        for (value, expected) in [
            (Some(0.9), [false, true, false]),
            (Some(1.0), [true, true, true]),
            (Some(2.0), [true, true, true]),
            (Some(2.1), [true, false, false]),
            (Some(f64::NAN), [false; 3]),
            (None, [false; 3]),
        ] {
            let found = [least(value), most(value), both(value)].map(|status| status == Status::Pass);
            assert_eq!(found, expected, "{value:?}");
        }
    }

    #[test]
    fn a_bound_below_the_own_error_of_the_reference_is_said_to_prove_nothing() {
        let bound = Bound::Within { at_least: None, at_most: Some(0.02) };
        let check =
            Check { address: metric::RELATIVE_RMS.whole(), methods: vec![], bound, at: String::new() };
        for (value, own, status) in [
            (0.01, None, Status::Pass),
            (0.01, Some(0.02), Status::Pass),
            (0.01, Some(0.05), Status::Pass),
            (0.03, Some(0.05), Status::Fail),
        ] {
            let verdict = judge(&check, "block", "tet4", Some(value), own);
            let unproven = verdict.reason.contains("the reference's own error of about 5.00e-2");
            assert_eq!((verdict.status, unproven), (status, own == Some(0.05)), "{}", verdict.reason);
        }
        let record = |statistic: &str, value| {
            Record { statistic: statistic.into(), value, ..Record::default() }.with(&metric::RELATIVE_RMS)
        };
        let records = [record("value", 0.01), record("band", 0.05)];
        let of = metric::RELATIVE_RMS.whole();
        let found = (value(of, &records), band(of, &records), band(metric::PEAK_ERROR.whole(), &records));
        assert_eq!(found, (Some(0.01), Some(0.05), None));
    }

    #[test]
    fn a_bound_below_the_whole_load_foresees_an_early_end() {
        let of = |address, at_most| {
            let bound = Bound::Within { at_least: Some(0.7), at_most: Some(at_most) };
            Check { address, methods: vec![], bound, at: String::new() }
        };
        let record =
            Record { statistic: "value".into(), value: 0.75, ..Record::default() }.with(&metric::LIMIT_LOAD);
        let ends = |check: Check| foreseen_end([&check], std::slice::from_ref(&record));
        assert!(ends(of(metric::LIMIT_LOAD.whole(), 0.76)));
        // A limit beyond its bound, a bound that the whole load keeps, and another metric foresee nothing.
        assert!(!ends(of(metric::LIMIT_LOAD.whole(), 0.74)));
        assert!(!ends(of(metric::LIMIT_LOAD.whole(), 1.0)));
        assert!(!ends(of(metric::LOAD_CARRIED.whole(), 0.76)));
    }

    #[test]
    fn a_known_failure_stays_between_both_ends_of_its_band() {
        let band = |v| status(Bound::KnownBand { low: 1.0, high: 2.0, reason: "locks".into() }, v);
        for value in [1.0, 1.5, 2.0] {
            assert_eq!(band(Some(value)), Status::KnownFailure, "{value}");
        }
        for value in [Some(0.99), Some(2.01), Some(-1.5), Some(f64::NAN), Some(f64::INFINITY), None] {
            assert_eq!(band(value), Status::Fail, "{value:?}");
        }
    }

    #[test]
    fn the_share_counts_clouds_without_numbers_and_those_that_stalled() {
        let cloud = |load: f64| {
            let record =
                Record { family: Family::Efg, statistic: "value".into(), value: load, ..Record::default() };
            vec![record.with(&metric::LOAD_CARRIED)]
        };
        let clouds = [cloud(1.0), cloud(0.99), vec![], cloud(1.0)];
        let clouds = clouds.each_ref().map(Vec::as_slice);
        assert_eq!(of_many(metric::CARRIED_SHARE.whole(), &clouds), Some(0.5));
        assert_eq!(of_many(metric::CARRIED_SHARE.whole(), &[]), None);
        // A linear problem has no steps.
        let linear = [Record { statistic: "value".into(), ..Record::default() }.with(&metric::RMS)];
        assert_eq!(of_many(metric::CARRIED_SHARE.whole(), &[&linear]), Some(1.0));
    }

    #[test]
    fn a_check_of_a_run_that_failed_was_not_run() {
        let bound = Bound::Within { at_least: None, at_most: Some(1.0) };
        let check = Check { address: metric::L2.whole(), methods: vec![], bound, at: String::new() };
        let verdict = not_run(&check, "block", "tet4", "no support");
        assert_eq!(
            (verdict.status, verdict.reason.as_str(), verdict.value),
            (Status::NotRun, "no support", None)
        );
    }
}
