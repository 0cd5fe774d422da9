//! Workflow commands of GitHub: an error at the scene's file for each run or check that failed.

use reports::Status;

use crate::cli::text;
use crate::study::RunSummary;

/// The lines to print.
pub(in crate::cli) fn annotate(runs: &[RunSummary]) -> String {
    let mut out = String::new();
    for run in runs {
        let file = property(&run.file.display().to_string());
        let title = property(&format!("{} {}", run.case, run.label));
        let failed = run.checks.iter().filter(|check| check.status == Status::Fail).map(text::verdict);
        for message in run.failure.iter().cloned().chain(failed) {
            out += &format!("::error file={file},title={title}::{}\n", data(&message));
        }
    }
    out
}

fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_is_one_line_at_its_file() {
        let run = RunSummary {
            case: "block".into(),
            file: "cases/a,b.toml".into(),
            label: "tet4 nu=0.3".into(),
            seconds: 0.0,
            failure: Some("50 % carried:\nno support".into()),
            checks: Vec::new(),
        };
        let expected =
            "::error file=cases/a%2Cb.toml,title=block tet4 nu=0.3::50 %25 carried:%0Ano support\n";
        assert_eq!(annotate(std::slice::from_ref(&run)), expected);
        assert_eq!(annotate(&[RunSummary { failure: None, ..run }]), "");
    }
}
