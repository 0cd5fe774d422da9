//! Published claims that one kind of method is better than another, tested against results. A claim consists
//! of scenes, methods, relations and tolerances.

use std::path::Path;

use records::text::significant;
use records::{Family, Record, RecordError, RunSet};
use serde::Deserialize;

use crate::busy::decide;
use crate::findings::Matched;
use crate::fronts::{Clock, judged};
use crate::select::{Run, runs, solved};

/// Verdict of the results on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClaimVerdict {
    /// Every relation holds in every scene.
    Validated,
    /// Some relations hold, hold only at some errors, or have no runs.
    Qualified,
    /// No relation holds at any error.
    Refuted,
    /// The results contain no runs that test the claim.
    Untested,
}

impl ClaimVerdict {
    /// Name in files and on a terminal.
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
    /// Source of the claim.
    pub source: String,
    /// The claim in one sentence.
    pub says: String,
    /// Scenes that test the claim, by file name without suffix.
    pub scenes: Vec<String>,
    /// Verdict expected from the results of this project; another verdict is an error.
    #[serde(default)]
    pub expect: Option<ClaimVerdict>,
    left: Side,
    right: Side,
    relation: Vec<Relation>,
}

/// Methods on one side of a claim, selected by family, by id, or by both.
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

/// Kind of comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    /// Smallest error of the left side over that of the right side.
    ErrorRatio,
    /// Smallest time of the left side over that of the right side at equal errors, for every error that both
    /// reach.
    TimeRatio,
}

/// A comparison between the two sides of a claim.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Relation {
    kind: Kind,
    /// Name of the relative error in records.
    error: String,
    at_most: f64,
    /// Relative tolerance of the bound.
    #[serde(default)]
    tolerance: f64,
}

/// A claim with its verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// Verdict of the results.
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
/// A file that cannot be read or is not a file of claims, with the line.
pub fn read_claims(path: &Path) -> Result<Vec<Claim>, RecordError> {
    let content = |reason: String| RecordError::Content { path: path.into(), reason };
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
    /// Judges the claim by the runs of its scenes.
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
    /// Compares the runs of the two sides, and returns the extent to which the relation holds (`None` if
    /// there is nothing to compare) and a line that reports the result.
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
                "one side has no run with a time and {}, or the two sides reach no common error",
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

    fn claims(text: &str) -> Result<Vec<Claim>, RecordError> {
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
            // A method outside of the claim.
            run(("hex8", Family::Fem), 200, 1e-3, &[("relative-rms", 0.01)]),
        ];
        let cloud = run(("efg", Family::Efg), 83, efg, &[("relative-rms", error)]);
        let set = RunSet { records: fem.into_iter().flatten().chain(cloud).collect(), ..RunSet::default() };
        claims(claim).unwrap()[0].judge(&set)
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
                "jaws: least error (relative-rms) 1.5 times as large, claimed at most 1.0: does not hold",
                "jaws: time at equal error (relative-rms) 0.50 to 50 times as large, claimed at most 0.010: does not hold",
            ]
        );
        // A claim that holds in one scene is not validated if another scene has no runs.
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
