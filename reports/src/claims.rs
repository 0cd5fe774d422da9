//! Published claims that one kind of method is better than another, each as scenes, methods, relations and tolerances, held against
//! results.

use std::path::Path;

use serde::Deserialize;

use crate::error::ReportError;
use crate::findings::Matched;
use crate::fronts::{Clock, judged};
use crate::record::{Family, Record};
use crate::run_set::RunSet;
use crate::seconds::decide;
use crate::select::{Run, runs, solved};
use crate::text::significant;

/// What results say of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClaimVerdict {
    /// Every relation holds in every scene.
    Validated,
    /// Some hold, or hold at some errors only, or some have no runs.
    Qualified,
    /// None holds at any error.
    Refuted,
    /// The results have no runs to judge it by.
    Untested,
}

impl ClaimVerdict {
    /// The word in files and on a terminal.
    pub fn name(self) -> &'static str {
        match self {
            ClaimVerdict::Validated => "validated",
            ClaimVerdict::Qualified => "qualified",
            ClaimVerdict::Refuted => "refuted",
            ClaimVerdict::Untested => "untested",
        }
    }
}

/// A published claim: the methods of `left` against those of `right`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// Short name.
    pub id: String,
    /// Who claims it, and where.
    pub source: String,
    /// What is claimed, in a sentence.
    pub says: String,
    /// Scenes that test it, by the names of their files without their ending.
    pub scenes: Vec<String>,
    /// What the results of this project are expected to say; another verdict is an error.
    #[serde(default)]
    pub expect: Option<ClaimVerdict>,
    left: Side,
    right: Side,
    relation: Vec<Relation>,
}

/// Which methods: of a family, or by their ids; of a family those with these ids.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Side {
    family: Option<Family>,
    #[serde(default)]
    methods: Vec<String>,
}

impl Side {
    fn takes(&self, record: &Record) -> bool {
        self.family.is_none_or(|family| family == record.family)
            && (self.methods.is_empty() || self.methods.contains(&record.method))
    }
}

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    /// The least error of the left over that of the right.
    ErrorRatio,
    /// The least time of the left over that of the right at equal errors, at every error that both reach.
    TimeRatio,
}

/// One comparison.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Relation {
    kind: Kind,
    /// Relative error, by its name in records.
    error: String,
    at_most: f64,
    /// Part by which the bound may be passed.
    #[serde(default)]
    tolerance: f64,
}

/// A claim with what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// What the results say.
    pub verdict: ClaimVerdict,
    /// A line for each scene and relation.
    pub lines: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    claim: Vec<Claim>,
}

/// Reads a file of claims.
///
/// # Errors
/// A file that can't be read, or is none of claims, with the line.
pub fn read_claims(path: &Path) -> Result<Vec<Claim>, ReportError> {
    let content = |reason: String| ReportError::Content { path: path.into(), reason };
    let text = disk::read_text(path, disk::Kind::SCENE).map_err(|bad| content(bad.to_string()))?;
    let file: File = toml::from_str(&text).map_err(|bad| content(bad.to_string().trim_end().into()))?;
    for claim in &file.claim {
        let sound = |r: &Relation| r.at_most > 0.0 && r.at_most.is_finite() && r.tolerance >= 0.0;
        if claim.scenes.is_empty() || claim.relation.is_empty() || !claim.relation.iter().all(sound) {
            let reason = format!("claim '{}' needs scenes, and relations with at_most above 0", claim.id);
            return Err(content(reason));
        }
    }
    Ok(file.claim)
}

impl Claim {
    /// Judges it by the runs of its scenes.
    pub fn judge(&self, set: &RunSet) -> Judged {
        let mut all = runs(&set.records);
        decide(&mut all, &set.provenance.machine);
        let all = solved(&all);
        let (mut lines, mut held) = (Vec::new(), Vec::new());
        for scene in &self.scenes {
            let of_scene: Vec<&Run> = all.iter().filter(|run| run.is.case == *scene).collect();
            for relation in &self.relation {
                let (found, line) = relation.holds(&of_scene, &self.left, &self.right);
                lines.push(format!("{scene}: {line}"));
                held.push(found);
            }
        }
        // One relation without runs keeps a claim from being validated or refuted as a whole.
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
}

/// Where a relation holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Held {
    Always,
    /// At some errors.
    Partly,
    Never,
}

impl Relation {
    /// Whether it holds among runs, `None` where there is nothing to compare, and a line that says so.
    fn holds(&self, runs: &[&Run], left: &Side, right: &Side) -> (Option<Held>, String) {
        let points = |side: &Side| -> Vec<(f64, f64)> {
            let own = runs.iter().filter(|run| side.takes(run.is));
            own.filter_map(|run| judged(run, &self.error, Clock::First)).collect()
        };
        let (left, right) = (points(left), points(right));
        let bound = self.at_most * (1.0 + self.tolerance);
        let limit = format!("claimed at most {}", significant(self.at_most, 2));
        let Some(matched) = Matched::of(&right, &left) else {
            let none = format!(
                "no run has a time and {} on both sides, or they reach no error in common",
                self.error
            );
            return (None, none);
        };
        let (least, most, what) = match self.kind {
            Kind::ErrorRatio => {
                let (right, left) = matched.least;
                (left / right, left / right, "least error")
            }
            Kind::TimeRatio => (matched.ratio.0, matched.ratio.1, "time at equal error"),
        };
        let held = match (most <= bound, least <= bound) {
            (true, _) => Held::Always,
            (_, true) => Held::Partly,
            _ => Held::Never,
        };
        let word = match held {
            Held::Always => "holds",
            Held::Partly => "holds at some errors only",
            Held::Never => "does not hold",
        };
        let [low, high] = [least, most].map(|ratio| significant(ratio, 2));
        let span = if low == high { low } else { format!("{low} to {high}") };
        (Some(held), format!("{what} ({}) {span} times as large, {limit}: {word}", self.error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fronts::tests::run;

    const CLAIM: &str = r#"[[claim]]
id = "cheap"
source = "somebody"
says = "clouds are as accurate and cheaper"
scenes = ["jaws"]
left = { family = "efg" }
right = { family = "fem", methods = ["tet4", "hex20"] }
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

    fn claims(text: &str) -> Result<Vec<Claim>, ReportError> {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("claims.toml");
        std::fs::write(&path, text).unwrap();
        read_claims(&path)
    }

    fn judged(efg: f64, error: f64) -> Judged {
        judged_of(CLAIM, efg, error)
    }

    fn judged_of(claim: &str, efg: f64, error: f64) -> Judged {
        let fem = [
            run(("tet4", Family::Fem), 100, 10.0, &[("relative-rms", 0.2)]),
            run(("hex20", Family::Fem), 200, 1000.0, &[("relative-rms", 0.1)]),
            // Not among the methods that the claim is about.
            run(("hex8", Family::Fem), 200, 1e-3, &[("relative-rms", 0.01)]),
        ];
        let cloud = run(("efg", Family::Efg), 83, efg, &[("relative-rms", error)]);
        let set = RunSet { records: fem.into_iter().flatten().chain(cloud).collect(), ..RunSet::default() };
        claims(claim).unwrap()[0].judge(&set)
    }

    #[test]
    fn a_claim_is_validated_qualified_refuted_or_untested() {
        assert_eq!(judged(0.05, 0.105).verdict, ClaimVerdict::Validated);
        // Cheap enough beside hex20, not beside tet4; or cheap and not as accurate.
        assert_eq!(judged(5.0, 0.1).verdict, ClaimVerdict::Qualified);
        assert_eq!(judged(0.05, 0.15).verdict, ClaimVerdict::Qualified);
        let refuted = judged(500.0, 0.15);
        assert_eq!(refuted.verdict, ClaimVerdict::Refuted);
        assert_eq!(
            refuted.lines,
            [
                "jaws: least error (relative-rms) 1.5 times as large, claimed at most 1.0: does not hold",
                "jaws: time at equal error (relative-rms) 0.50 to 50 times as large, claimed at most 0.010: does not hold",
            ]
        );
        // What holds in one scene is not validated by another that nobody has run.
        let twice = CLAIM.replace("[\"jaws\"]", "[\"jaws\", \"liver\"]");
        assert_eq!(judged_of(&twice, 0.05, 0.105).verdict, ClaimVerdict::Qualified);
        let untested = claims(CLAIM).unwrap()[0].judge(&RunSet::default());
        assert_eq!((untested.verdict, untested.lines.len()), (ClaimVerdict::Untested, 2));
    }

    #[test]
    fn a_file_that_is_none_of_claims_is_refused_with_its_line() {
        for (from, to, says) in [
            ("at_most = 0.01", "at_most = -1", "at_most above 0"),
            ("time-ratio", "time-ratios", "line 14"),
            ("scenes = [\"jaws\"]", "scenes = []", "needs scenes"),
            ("source", "sauce", "line 3"),
        ] {
            let bad = claims(&CLAIM.replace(from, to)).unwrap_err().to_string();
            assert!(bad.contains(says), "{says}: {bad}");
        }
    }
}
