//! Selection of a study's runs by case, method and tag.

use cases::scene::{self, Scene};
use clap::Args;
use serde::{Deserialize, Serialize};

use super::tasks::Task;

/// Filters of runs by their names; a run has to pass all filters.
#[derive(Args, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Filters {
    /// Execute only these cases; `*` matches any text (repeatable)
    #[arg(long = "case", value_name = "NAME")]
    pub cases: Vec<String>,
    /// Execute only these methods; `*` matches any text (repeatable)
    #[arg(long = "method", value_name = "ID")]
    pub methods: Vec<String>,
    /// Execute only runs with one of these tags: a tag of the study, the purpose of the scene (patch, smooth,
    /// ...), its procedure, the method's family, or quick (repeatable)
    #[arg(long = "tag", value_name = "TAG")]
    pub tags: Vec<String>,
    /// Leave out runs whose case or method contains this text, and runs with this tag (repeatable)
    #[arg(long = "not", value_name = "TEXT")]
    pub not: Vec<String>,
}

impl Filters {
    /// Whether a run is selected.
    pub fn fits(&self, case: &str, method: &str, tags: &[&str]) -> bool {
        let any = |wanted: &[String], name: &str| wanted.is_empty() || wanted.iter().any(|w| like(w, name));
        let tagged = |wanted: &String| tags.contains(&wanted.as_str());
        let refused = |text: &String| case.contains(text.as_str()) || method.contains(text.as_str());
        any(&self.cases, case)
            && any(&self.methods, method)
            && (self.tags.is_empty() || self.tags.iter().any(tagged))
            && !self.not.iter().any(|text| refused(text) || tagged(text))
    }

    /// Whether no filter is set.
    pub fn is_empty(&self) -> bool {
        [&self.cases, &self.methods, &self.tags, &self.not].into_iter().all(Vec::is_empty)
    }
}

/// Tags by which a run can be selected, in addition to its case and method.
pub(super) fn tags<'a>(task: &Task, runs: &'a [scene::Run], scene: &'a Scene) -> Vec<&'a str> {
    let own = task.runs.iter().map(|&run| &runs[run]);
    let named = own.clone().flat_map(|run| run.tags.iter().map(String::as_str));
    let quick = own.clone().any(|run| run.quick).then_some("quick");
    let of_scene = [scene.purpose.name(), scene.procedure.kind().name(), task.method.family_name()];
    named.chain(quick).chain(of_scene).collect()
}

/// Whether a name matches the pattern, in which `*` stands for any text.
pub(crate) fn like(pattern: &str, name: &str) -> bool {
    let Some((first, rest)) = pattern.split_once('*') else { return pattern == name };
    let Some(mut left) = name.strip_prefix(first) else { return false };
    let mut parts: Vec<&str> = rest.split('*').collect();
    let last = parts.pop().unwrap_or_default();
    for part in parts {
        let Some(at) = left.find(part) else { return false };
        left = &left[at + part.len()..];
    }
    left.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_stands_for_any_text() {
        for (pattern, name) in [
            ("a", "a"),
            ("*", ""),
            ("kidney*", "kidney-paper"),
            ("*-mean", "hex8-mean"),
            ("k*p*r", "kidney-paper"),
        ] {
            assert!(like(pattern, name), "{pattern} {name}");
        }
        for (pattern, name) in
            [("a", "ab"), ("kidney*", "a-kidney"), ("*-mean", "mean"), ("ab*ba", "aba"), ("a*b*c", "acb")]
        {
            assert!(!like(pattern, name), "{pattern} {name}");
        }
    }

    #[test]
    fn a_run_fits_all_choices() {
        let list = |all: &[&str]| all.iter().map(ToString::to_string).collect::<Vec<_>>();
        let filters = Filters {
            cases: list(&["sphere", "kidney*"]),
            methods: list(&["tet*"]),
            tags: list(&["fem", "smooth"]),
            not: list(&["nodal", "slow"]),
        };
        assert!(!filters.is_empty() && Filters::default().is_empty());
        assert!(filters.fits("kidney-paper", "tet4", &["fem"]));
        assert!(!filters.fits("beam", "tet4", &["fem"]));
        assert!(!filters.fits("sphere", "hex8", &["fem"]));
        assert!(!filters.fits("sphere", "tet4", &["rough"]));
        assert!(!filters.fits("sphere", "tet4-nodal", &["fem"]));
        assert!(!filters.fits("sphere", "tet4", &["fem", "slow"]));
        assert!(Filters::default().fits("any", "any", &[]));
    }
}
