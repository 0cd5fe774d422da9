//! GitHub workflow commands: an error at the line of the failed method or check.

use records::Status;

use crate::cli::text;
use crate::study::RunSummary;

/// Returns the lines to print.
pub(crate) fn annotate(runs: &[RunSummary]) -> String {
    let mut out = String::new();
    for run in runs {
        let title = property(&format!("{} {}", run.case, run.label));
        let failed = run.checks.iter().filter(|check| check.status == Status::Fail);
        let failed = failed.map(|check| (check.at.as_str(), text::verdict(check)));
        let broken = run.failure.iter().map(|reason| (run.at.as_str(), reason.clone()));
        for (at, message) in broken.chain(failed) {
            out += &format!("::error {},title={title}::{}\n", place(at, run), data(&message));
        }
    }
    out
}

/// Returns `file=...,line=...`; only the scene's file if no line is known.
fn place(at: &str, run: &RunSummary) -> String {
    match at.rsplit_once(':') {
        Some((file, line)) => format!("file={},line={line}", property(file)),
        None => format!("file={}", property(&run.file.display().to_string())),
    }
}

fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use records::Check;

    use super::*;

    #[test]
    fn a_failure_is_one_line_at_its_place() {
        let run = RunSummary {
            case: "block".into(),
            file: "cases/a,b.toml".into(),
            at: "cases/a,b.toml:12".into(),
            label: "tet4 nu=0.3".into(),
            seconds: 0.0,
            failure: Some("50 % carried:\nno support".into()),
            checks: Vec::new(),
        };
        let expected =
            "::error file=cases/a%2Cb.toml,line=12,title=block tet4 nu=0.3::50 %25 carried:%0Ano support\n";
        assert_eq!(annotate(std::slice::from_ref(&run)), expected);
        let check = Check {
            case: "block".into(),
            method: "tet4".into(),
            metric: "l2".into(),
            value: Some(0.5),
            bound: "at most 1e-1".into(),
            capped: true,
            status: Status::Fail,
            reason: "too much".into(),
            runs: Vec::new(),
            at: "study.toml:3".into(),
        };
        let found = annotate(&[RunSummary { failure: None, checks: vec![check], ..run.clone() }]);
        assert!(found.starts_with("::error file=study.toml,line=3,title=block tet4 nu=0.3::"), "{found}");
        assert_eq!(annotate(&[RunSummary { failure: None, ..run }]), "");
    }
}
