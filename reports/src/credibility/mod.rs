//! Evidence of credibility for a reviewer, laid out by the factors of ASME V&V 40-2018 and the FDA's guidance
//! of 2023, from the records of a folder of results. Blanks name what no record has.

mod calculation;
mod code;
mod document;
mod factors;
mod statements;
mod validation;

use records::{Family, RunSet};

use crate::figures;
use crate::page::Drawn;
use crate::select::Run;
use crate::uncertain::Uncertain;
use code::Verified;
use document::Document;

pub use statements::{Statements, read_statements};

/// Returns the document as Markdown and as HTML. `drawn` are the figures of the report.
pub(crate) fn document(
    set: &RunSet,
    runs: &[Run],
    uncertain: &[Uncertain],
    drawn: &[Drawn],
    statements: &Statements,
) -> [String; 2] {
    let is_solver = |run: &&Run| !matches!(run.is.family, Family::Interp | Family::Reference);
    let runs: Vec<Run> = runs.iter().filter(is_solver).cloned().collect();
    let verified = Verified::new(set, &runs);
    let document = Document {
        title: format!("Evidence of credibility: {}", set.provenance.source),
        lead: vec![
            "This document orders the records of a folder of results by the credibility factors of ASME V&V 40-2018 \
             (Assessing Credibility of Computational Modeling through Verification and Validation: Application to \
             Medical Devices) and by the FDA's guidance Assessing the Credibility of Computational Modeling and \
             Simulation in Medical Device Submissions (November 17, 2023). It is evidence for an assessment, not the \
             assessment."
                .into(),
            "Numbers come from the records and name their runs: the id is in the column run of records.csv. A blank \
             names what no record has."
                .into(),
        ],
        evidence: vec![
            verified.quality(),
            verified.code(figures::of_convergence(&runs)),
            calculation::discretisation(set, &runs),
            calculation::solver(&runs),
            calculation::usage(set),
            validation::form(set, &runs),
            validation::inputs(uncertain, figures::of_uncertainty(uncertain)),
            validation::comparison(&runs),
        ],
        statements,
        drawn,
    };
    [document.markdown(), document.html()]
}
