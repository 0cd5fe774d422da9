//! Reads and checks the answer of an external solver: `result.json` and `displacement.npy`.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;

use disk::Kind;
use geometry::Vector3;
use serde::{Deserialize, Serialize};

use super::npy;
use crate::error::{Foreign, ForeignStatus};

/// File with the solver's status and counts.
pub(crate) const RESULT: &str = "result.json";
/// File with the computed displacement.
pub(super) const DISPLACEMENT: &str = "displacement.npy";

/// Contents of `result.json`. Unknown keys are ignored.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Answer {
    /// Status: `ok`, `refused`, `stalled` or `failed`.
    pub(crate) status: String,
    /// Reason if the status is not `ok`.
    #[serde(default)]
    pub(crate) message: String,
    /// Name and version of the solver.
    #[serde(default)]
    pub(crate) version: String,
    /// Id of the problem that was solved.
    #[serde(default)]
    pub(crate) problem: Option<String>,
    /// Load fraction reached by a path that stalled.
    #[serde(default)]
    pub(crate) load: Option<f64>,
    /// The solver's own timings by phase, s.
    #[serde(default)]
    pub(crate) phases: BTreeMap<String, f64>,
    /// The solver's own counters.
    #[serde(default)]
    pub(crate) counts: BTreeMap<String, f64>,
}

impl Answer {
    /// Reads the answer in `folder`; `None` if there is no file.
    pub(super) fn read(folder: &Path) -> Option<Result<Answer, String>> {
        let text = match disk::read_text(&folder.join(RESULT), Kind::MESSAGE) {
            Err(bad) if bad.kind() == ErrorKind::NotFound => return None,
            text => text,
        };
        let parsed = text.map_err(|bad| bad.to_string());
        let parsed = parsed.and_then(|text| serde_json::from_str(&text).map_err(|bad| bad.to_string()));
        Some(parsed.map_err(|bad| format!("{RESULT}: {bad}")))
    }

    /// Returns the reason why the answer counts as failed: its status is not `ok`, or its problem id is not
    /// `id`.
    pub(super) fn objection(&self, id: &str) -> Result<Option<Foreign>, String> {
        if let Some(other) = self.problem.as_ref().filter(|other| *other != id) {
            let reason = format!("the answer belongs to another problem ({other}, not {id})");
            return Ok(Some(Foreign::new(ForeignStatus::Stale, reason)));
        }
        let status = match self.status.as_str() {
            "ok" => return Ok(None),
            "refused" => ForeignStatus::Refused,
            "stalled" => ForeignStatus::Stalled,
            "failed" => ForeignStatus::Failed,
            other => return Err(format!("{RESULT}: status '{other}'; give ok, refused, stalled or failed")),
        };
        let reason = if self.message.is_empty() { "gave no reason".into() } else { self.message.clone() };
        Ok(Some(Foreign::new(status, reason)))
    }
}

/// Reads the nodal displacement, m, of `nodes` nodes: one field at the end, or one at the end of each of
/// `steps` load steps.
pub(super) fn displacement(folder: &Path, nodes: usize, steps: usize) -> Result<Vec<Vec<Vector3>>, String> {
    let named = |bad: String| format!("{DISPLACEMENT}: {bad}");
    // Files larger than the expected array are refused.
    let most = (24 * nodes * steps.max(1)) as u64 + (1 << 16);
    let array = npy::read(&folder.join(DISPLACEMENT), Kind::ARRAY.at_most(most)).map_err(named)?;
    let count = match array.shape[..] {
        [n, 3] if n == nodes => 1,
        [k, n, 3] if n == nodes && k == steps => k,
        _ => {
            let several = if steps > 1 { format!(" or ({steps}, {nodes}, 3)") } else { String::new() };
            return Err(named(format!("has the shape {:?}, not ({nodes}, 3){several}", array.shape)));
        }
    };
    if let Some(at) = array.values.iter().position(|value| !value.is_finite()) {
        let bad = array.values.iter().filter(|value| !value.is_finite()).count();
        return Err(named(format!("{bad} numbers are not finite, the first at node {}", at / 3 % nodes)));
    }
    let fields = array.values.chunks_exact(3 * nodes).take(count);
    let field = |values: &[f64]| values.chunks_exact(3).map(|u| Vector3::new(u[0], u[1], u[2])).collect();
    Ok(fields.map(field).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_says_what_it_is() {
        let dir = tempfile::tempdir().unwrap();
        assert!(Answer::read(dir.path()).is_none());
        let read = |text: &str| {
            std::fs::write(dir.path().join(RESULT), text).unwrap();
            Answer::read(dir.path()).unwrap()
        };
        let objection = |text: &str| read(text).unwrap().objection("42");
        assert_eq!(objection(r#"{"status": "ok", "problem": "42", "more": [1]}"#), Ok(None));
        for (text, status, says) in [
            (r#"{"status": "ok", "problem": "41"}"#, ForeignStatus::Stale, "another problem"),
            (r#"{"status": "refused", "message": "no law"}"#, ForeignStatus::Refused, "no law"),
            (r#"{"status": "failed"}"#, ForeignStatus::Failed, "gave no reason"),
            (r#"{"status": "stalled", "load": 0.5}"#, ForeignStatus::Stalled, ""),
        ] {
            let found = objection(text).unwrap().unwrap();
            assert!(found.status == status && found.reason.contains(says), "{found:?}");
        }
        assert!(objection(r#"{"status": "fine"}"#).unwrap_err().contains("'fine'"));
        assert!(read("{").is_err() && read("[]").is_err());
        assert!(read(&" ".repeat(2 << 20)).unwrap_err().contains("bytes"));
    }

    #[test]
    fn a_displacement_has_the_nodes_and_steps_of_the_question() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join(DISPLACEMENT);
        assert!(displacement(dir.path(), 2, 1).unwrap_err().contains("No such file"));
        npy::write_floats(&path, 3, (0..6).map(f64::from)).unwrap();
        assert_eq!(
            displacement(dir.path(), 2, 4).unwrap(),
            [[Vector3::new(0.0, 1.0, 2.0), Vector3::new(3.0, 4.0, 5.0)]]
        );
        assert!(displacement(dir.path(), 3, 1).unwrap_err().contains("not (3, 3)"));
        npy::write_floats(&path, 3, [0.0, 1.0, 2.0, f64::NAN, 4.0, f64::INFINITY].into_iter()).unwrap();
        let bad = displacement(dir.path(), 2, 1).unwrap_err();
        assert!(bad.contains("2 numbers are not finite, the first at node 1"), "{bad}");
        std::fs::write(&path, vec![0; 1 << 20]).unwrap();
        assert!(displacement(dir.path(), 2, 1).unwrap_err().contains("has more than 65584 bytes"));
    }
}
