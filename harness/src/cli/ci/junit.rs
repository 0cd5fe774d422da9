//! JUnit XML with a suite for each case and a test for each run; failed checks are its failures.

use std::fmt::Write as _;

use records::{Check, Status};

use crate::cli::text;
use crate::study::RunSummary;

/// Returns the runs of a study as a JUnit file for continuous integration systems.
pub(crate) fn junit(study: &str, runs: &[RunSummary]) -> String {
    let mut cases: Vec<&str> = Vec::new();
    for run in runs.iter().filter(|run| !cases.contains(&run.case.as_str())).collect::<Vec<_>>() {
        if !cases.contains(&run.case.as_str()) {
            cases.push(&run.case);
        }
    }
    let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let all: Vec<&RunSummary> = runs.iter().collect();
    let _ = writeln!(out, "<testsuites name=\"{}\" {}>", escaped(study), counts(&all));
    for case in cases {
        let own: Vec<&RunSummary> = runs.iter().filter(|run| run.case == case).collect();
        let _ = writeln!(out, "  <testsuite name=\"{}\" {}>", escaped(case), counts(&own));
        own.iter().for_each(|run| test(&mut out, run));
        out.push_str("  </testsuite>\n");
    }
    out.push_str("</testsuites>\n");
    out
}

fn test(out: &mut String, run: &RunSummary) {
    let (case, label) = (escaped(&run.case), escaped(&run.label));
    let file = escaped(&run.file.display().to_string());
    let _ = write!(
        out,
        "    <testcase classname=\"{case}\" name=\"{label}\" file=\"{file}\" time=\"{:.6}\"",
        run.seconds
    );
    let mut inside = String::new();
    if let Some(reason) = &run.failure {
        let _ = writeln!(inside, "      <error message=\"{}\"/>", escaped(reason));
    }
    for check in failed(run) {
        let message = escaped(&text::verdict(check));
        let _ =
            writeln!(inside, "      <failure type=\"{}\" message=\"{message}\"/>", escaped(&check.metric));
    }
    let known: Vec<String> = of(run, Status::KnownFailure).map(text::verdict).collect();
    let not_run = of(run, Status::NotRun).count();
    if inside.is_empty() && not_run > 0 {
        let _ = writeln!(inside, "      <skipped message=\"{not_run} checks not run\"/>");
    }
    if !known.is_empty() {
        let _ = writeln!(inside, "      <system-out>{}</system-out>", escaped(&known.join("\n")));
    }
    if inside.is_empty() {
        out.push_str("/>\n");
    } else {
        let _ = write!(out, ">\n{inside}    </testcase>\n");
    }
}

fn of(run: &RunSummary, status: Status) -> impl Iterator<Item = &Check> {
    run.checks.iter().filter(move |check| check.status == status)
}

fn failed(run: &RunSummary) -> impl Iterator<Item = &Check> {
    of(run, Status::Fail)
}

/// Returns `tests="3" failures="1" errors="0" skipped="0" time="0.2"`. Each test counts once.
fn counts(runs: &[&RunSummary]) -> String {
    let errors = runs.iter().filter(|run| run.failure.is_some()).count();
    let wrong = |run: &&&RunSummary| run.failure.is_none() && failed(run).next().is_some();
    let failures = runs.iter().filter(wrong).count();
    let left = |run: &&&RunSummary| {
        run.failure.is_none() && failed(run).next().is_none() && of(run, Status::NotRun).next().is_some()
    };
    let skipped = runs.iter().filter(left).count();
    let seconds: f64 = runs.iter().map(|run| run.seconds).sum();
    format!(
        "tests=\"{}\" failures=\"{failures}\" errors=\"{errors}\" skipped=\"{skipped}\" time=\"{seconds:.6}\"",
        runs.len()
    )
}

/// Escapes text for XML. Characters not allowed in XML become blanks.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' => out.push_str("&#10;"),
            '\t' => out.push(c),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(status: Status, reason: &str) -> Check {
        Check {
            case: "block".into(),
            method: "tet4".into(),
            metric: "l2".into(),
            value: Some(0.5),
            bound: "at most 1e-1".into(),
            capped: true,
            status,
            reason: reason.into(),
            runs: Vec::new(),
            at: "cases/block.toml:5".into(),
        }
    }

    fn run(label: &str, failure: Option<&str>, checks: Vec<Check>) -> RunSummary {
        RunSummary {
            case: "block".into(),
            file: "cases/block.toml".into(),
            at: "cases/block.toml:3".into(),
            label: label.into(),
            seconds: 0.25,
            failure: failure.map(Into::into),
            checks,
        }
    }

    #[test]
    fn each_run_is_one_test() {
        let runs = [
            run("tet4", None, vec![check(Status::Pass, "")]),
            run("tet10", None, vec![check(Status::Fail, "5e-1 is not < 1 & \"so\"")]),
            run("hex8", Some("no support"), vec![check(Status::NotRun, "no support")]),
            run("efg", None, vec![check(Status::KnownFailure, "locks")]),
        ];
        let text = junit("verify.toml", &runs);
        assert!(
            text.contains("<testsuite name=\"block\" tests=\"4\" failures=\"1\" errors=\"1\" skipped=\"0\" time=\"1.000000\">"),
            "{text}"
        );
        assert!(text.contains("name=\"tet4\" file=\"cases/block.toml\" time=\"0.250000\"/>"), "{text}");
        assert!(text.contains("is not &lt; 1 &amp; &quot;so&quot;"), "{text}");
        assert!(
            text.contains("<error message=\"no support\"/>") && text.contains("<system-out>known"),
            "{text}"
        );
        assert_eq!(text.matches("<testcase ").count(), 4);
    }

    /// A run that ended with an error counts only as an error. A run whose checks could not run is skipped.
    #[test]
    fn what_is_wrong_counts_once() {
        let runs = [
            run("tet4", None, vec![check(Status::Fail, "high"), check(Status::Fail, "low")]),
            run("tet10", None, vec![check(Status::Fail, "high")]),
            run("hex8", Some("no support"), vec![check(Status::Fail, "no number")]),
            run("efg", None, vec![check(Status::NotRun, "no number")]),
        ];
        let text = junit("verify.toml", &runs);
        let counts = "tests=\"4\" failures=\"2\" errors=\"1\" skipped=\"1\"";
        assert_eq!(text.matches(counts).count(), 2, "{text}");
        assert_eq!((text.matches("<failure ").count(), text.matches("<skipped ").count()), (4, 1), "{text}");
    }

    #[test]
    fn what_xml_does_not_have_is_left_out() {
        assert_eq!(escaped("a\u{0}\u{1b}[1m\nb"), "a  [1m&#10;b");
    }
}
