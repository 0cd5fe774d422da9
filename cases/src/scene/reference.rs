//! The reference of a scene: an exact solution, a method or a stored record.

use std::path::PathBuf;

use catalogue::{Problem, Values, suggest};
use schemars::JsonSchema;
use serde::Deserialize;

use super::method::{Size, SizeKeys};
use super::procedure::ProcedureKind;
use super::report::Report;
use super::units::{Part, Q};
use super::vocabulary::{Given, Solutions, Word, settings};
use crate::exact::SolutionEntry;

/// Reference that results are compared with; further keys are parameters of the exact solution
#[derive(Deserialize, JsonSchema)]
// The known parameters depend on the solution. Its reader names them if a key is mistyped.
#[schemars(extend("additionalProperties" = {}))]
pub(crate) struct ReferenceKeys {
    /// An exact solution by name
    exact: Option<Word<Solutions>>,
    /// A stored record
    record: Option<String>,
    /// A method of this scene, run at another size if `size` is given
    method: Option<String>,
    size: Option<SizeKeys>,
    /// Largest own error of the method's displacement and tool forces, such as "0.5 %": its spacing is halved
    /// until it is reached
    accuracy: Option<Q<Part>>,
    #[serde(flatten)]
    settings: Given<Solutions>,
}

/// Reference that results are compared with.
#[derive(Clone, Debug, PartialEq)]
pub enum Reference {
    /// An exact solution.
    Exact {
        /// Entry of the solution.
        entry: &'static SolutionEntry,
        /// Parameters of the solution.
        values: Values,
    },
    /// A method of this scene.
    Method {
        /// Id of the method.
        id: String,
        /// Size of the reference run, if it differs from the method's own size.
        size: Option<Size>,
        /// Largest own error, to which the spacing is reduced.
        accuracy: Option<f64>,
    },
    /// A stored record.
    Record(PathBuf),
}

impl ReferenceKeys {
    pub fn read(self, report: &Report) -> Option<Reference> {
        let given = self.size.is_some();
        let size = self.size.and_then(|size| size.read(&report.at("size")));
        report.require(!given || self.method.is_some(), "size", "applies to method only", "leave it out");
        let accuracy = self.accuracy.map(|part| part.0);
        let sensible = accuracy.is_none_or(|part| part > 0.0 && part < 1.0);
        report.require(sensible, "accuracy", "is not between 0 and 100 %", "such as \"0.5 %\"");
        let of_method = accuracy.is_none() || self.method.is_some();
        report.require(of_method, "accuracy", "applies to method only", "leave it out");
        for name in self.settings.names().filter(|_| self.exact.is_none()) {
            let help = suggest(name, &["exact", "method", "record", "size", "accuracy"]);
            report.add(name, Problem::new("is not a known key").help(help));
        }
        match (self.exact, self.method, self.record) {
            (Some(word), None, None) => {
                let values = settings(&word, self.settings, report)?;
                Some(Reference::Exact { entry: word.0, values })
            }
            (None, Some(id), None) => {
                (size.is_some() || !given).then_some(Reference::Method { id, size, accuracy })
            }
            (None, None, Some(record)) => Some(Reference::Record(report.path(&record, "record"))),
            _ => {
                let help = "give one of exact = \"...\", method = \"...\" and record = \"...\"";
                report.add("", Problem::new("is not one reference").help(help));
                None
            }
        }
    }
}

impl Reference {
    /// Whether the reference is a numerical solution, run or stored.
    pub(crate) fn is_solved(&self) -> bool {
        matches!(self, Reference::Method { .. } | Reference::Record(_))
    }

    /// Reports contradictions with the procedure.
    pub(crate) fn demands(&self, kind: ProcedureKind, report: &Report) {
        if let Some((problem, help)) = kind.lacks_displacements() {
            let sound = kind == ProcedureKind::Modes && !self.is_solved();
            report.require(sound, "", problem, help);
        }
    }
}
