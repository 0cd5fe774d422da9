//! Outcomes of models of a suite, and their table.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use super::call::Run;

/// Outcome of a model.
pub(super) enum Verdict {
    /// The numbers agree, with the relative difference and what it was compared with.
    Agrees { difference: f64, within: String },
    /// The numbers differ, with the relative difference and the reason.
    Differs { difference: f64, reason: String },
    /// The model ran, and the suite stores no number of it.
    Runs,
    /// A part of the model can't be expressed.
    Refused { reason: String },
    /// The scene of the model does not run.
    Fails { reason: String },
}

/// The JSON object of a finished run, or the verdict on a run that refused its model or failed.
pub(super) fn unfinished(model: &Path, run: &Run) -> Result<serde_json::Value, Verdict> {
    let prefix = format!("{}:", model.display());
    let own = run.stderr.lines().filter_map(|line| line.strip_prefix(&prefix));
    let mut refused = own.filter(|line| !line.ends_with("(left out)"));
    if run.code == Some(2)
        && let Some(first) = refused.next()
    {
        let reason = first.split_once(": ").map_or(first, |(_, what)| what);
        let reason = reason.split(';').next().unwrap_or_default().trim();
        return Err(Verdict::Refused { reason: reason.into() });
    }
    let object: serde_json::Value = serde_json::from_str(run.stdout.trim()).unwrap_or_default();
    let status = object["status"].as_str().unwrap_or_default();
    if status == "ok" {
        return Ok(object);
    }
    let message = object["message"].as_str().unwrap_or_default();
    let last = run.stderr.lines().last().unwrap_or_default();
    let reason = match run.code {
        None => "took too long".to_string(),
        Some(code) if message.is_empty() => format!("exit code {code}: {last}"),
        Some(_) => format!("{status}: {message}"),
    };
    Err(Verdict::Fails { reason })
}

/// A model, or a step of one, with its verdict.
pub(super) struct Outcome {
    pub model: String,
    /// Step of a model of several.
    pub step: Option<usize>,
    pub verdict: Verdict,
}

impl Outcome {
    pub fn failed(&self) -> bool {
        matches!(self.verdict, Verdict::Fails { .. })
    }

    fn row(&self) -> [String; 3] {
        let (word, detail) = match &self.verdict {
            Verdict::Agrees { difference, within } => {
                ("agrees", format!("{difference:.1e}, within {within}"))
            }
            Verdict::Differs { difference, reason } => ("differs", format!("{difference:.1e}: {reason}")),
            Verdict::Runs => ("runs", "no number is stored".into()),
            Verdict::Refused { reason } => ("refused", reason.clone()),
            Verdict::Fails { reason } => ("fails", reason.clone()),
        };
        let name = self.step.map_or(self.model.clone(), |step| format!("{}, step {step}", self.model));
        [name, word.into(), detail.replace('|', "/")]
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.row().join("  "))
    }
}

/// Table of all outcomes, with the counts of each verdict and of the reasons of refusals. A model of several
/// steps counts by the step that is furthest from agreement.
pub(super) fn table(all: &[Outcome]) -> String {
    let (mut models, mut counts, mut reasons) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
    let mut out = String::from("| model | outcome | difference or reason |\n| --- | --- | --- |\n");
    for outcome in all {
        let [name, word, detail] = outcome.row();
        out += &format!("| {name} | {word} | {detail} |\n");
        let rank = ["runs", "agrees", "differs", "refused", "fails"].iter().position(|known| *known == word);
        let worst = models.entry(&outcome.model).or_insert((rank, word.clone()));
        *worst = worst.clone().max((rank, word));
        if let Verdict::Refused { reason } = &outcome.verdict {
            *reasons.entry(reason.clone()).or_insert(0) += 1;
        }
    }
    let number = models.len();
    models.into_values().for_each(|(_, word)| *counts.entry(word).or_insert(0) += 1);
    let counts: Vec<String> = counts.into_iter().map(|(word, count)| format!("{count} {word}")).collect();
    out += &format!("\n{} models: {}\n", number, counts.join(", "));
    let mut reasons: Vec<(String, i32)> = reasons.into_iter().collect();
    reasons.sort_by_key(|(_, count)| -count);
    if !reasons.is_empty() {
        out += "\n| refused | models |\n| --- | --- |\n";
        reasons.iter().for_each(|(reason, count)| out += &format!("| {reason} | {count} |\n"));
    }
    out
}
