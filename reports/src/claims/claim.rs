//! Claims and the files that list them.

use std::path::Path;
use std::sync::LazyLock;

use catalogue::metric::Address;
use records::{Purpose, Record, RecordError};
use serde::Deserialize;

use super::named::Named;
use super::published::{Ours, Published};
use super::relation::{Relation, Side};

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
    /// Short name, by which a scene names the claim as `published`.
    pub id: String,
    /// Source of the claim.
    pub source: String,
    /// The claim in one sentence.
    pub says: String,
    /// Limits of the reproduction of the published case.
    pub(crate) caveat: Option<String>,
    /// Scenes that test the claim, by file name without suffix.
    pub scenes: Vec<String>,
    /// Verdict expected from the results of this project; another verdict is an error.
    #[serde(default)]
    pub expect: Option<ClaimVerdict>,
    pub(super) left: Side,
    pub(super) right: Side,
    /// Quantities that every compared run has recorded.
    #[serde(default)]
    pub(super) needs: Vec<Named>,
    pub(super) relation: Vec<Relation>,
    /// Published runs with their numbers.
    #[serde(default)]
    pub(super) run: Vec<Published>,
}

impl Claim {
    /// Published value of a quantity of a transferred displacement, SI.
    pub(crate) fn transferred(&self, of: Address) -> Option<f64> {
        let numbers = self.run.iter().flat_map(|run| &run.number);
        let is = |ours: &Ours| matches!(ours, Ours::Transferred(own) if own.0 == of);
        numbers.into_iter().find(|number| is(&number.ours)).map(|number| number.published.value)
    }
}

/// Claims of the program itself.
static OWN: LazyLock<Vec<Claim>> = LazyLock::new(|| {
    parse(include_str!("../../claims.toml")).expect("a test reads the claims of the program")
});

/// Claims of the program itself.
pub fn own_claims() -> &'static [Claim] {
    &OWN
}

/// Claim that a case tests.
pub(super) fn tested(record: &Record) -> Option<&'static Claim> {
    OWN.iter().find(|claim| claim.id == record.published)
}

/// Claim whose published case a case reproduces, so that its numbers may be compared.
pub(crate) fn reproduced(record: &Record) -> Option<&'static Claim> {
    tested(record).filter(|_| record.purpose == Purpose::Published)
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
    let text = disk::read_text(path, disk::Kind::SCENE).map_err(|bad| bad.to_string());
    text.and_then(|text| parse(&text)).map_err(|reason| RecordError::Content { path: path.into(), reason })
}

pub(super) fn parse(text: &str) -> Result<Vec<Claim>, String> {
    let file: File = toml::from_str(text).map_err(|bad| bad.to_string().trim_end().to_string())?;
    for claim in &file.claim {
        if claim.scenes.is_empty() || claim.relation.is_empty() || !claim.relation.iter().all(Relation::sound)
        {
            return Err(format!(
                "claim '{}' needs scenes, and relations with at_most above 0 and an error without a component",
                claim.id
            ));
        }
    }
    Ok(file.claim)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_claims_of_the_program_are_read() {
        assert!(own_claims().iter().all(|claim| !claim.run.is_empty()));
    }

    #[test]
    fn a_quantity_that_is_never_recorded_is_refused_with_its_line() {
        let text = include_str!("../../claims.toml");
        let bad = parse(&text.replacen("\"relative-rms\"", "\"relative-rsm\"", 1)).unwrap_err();
        assert!(bad.contains("line ") && bad.contains("did you mean 'relative-rms'?"), "{bad}");
    }
}
