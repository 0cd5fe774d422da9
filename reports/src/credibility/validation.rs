//! Evidence that belongs to validation: uncertain inputs, the laws of the scenes, and the lack of
//! experiments.

use std::collections::BTreeMap;

use records::text::{percent, plural};
use records::{RunSet, SceneHash};

use super::document::{Block, Evidence};
use super::factors;
use crate::select::Run;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};
use crate::uncertain::{Uncertain, words};

/// Evidence about the form of the model: the scenes with their laws and hashes.
pub(super) fn form(set: &RunSet, runs: &[Run]) -> Evidence {
    let mut table = Table::new(
        "scenes",
        "Scenes",
        "The models of this folder: title, laws at large strain, and hash (BLAKE3) of the scene file, by which it is \
         found again",
        &[("scene", Words), ("title", Words), ("law", Words), ("hash", Words)],
    );
    let mut laws: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for run in runs {
        let named = laws.entry(&run.is.case).or_default();
        named.extend(run.is.law.as_deref().filter(|law| !named.contains(law)));
    }
    let run = |scene: &&SceneHash| laws.contains_key(scene.case.as_str());
    for scene in set.provenance.scenes.iter().filter(run) {
        let law = laws.get(scene.case.as_str()).map(|laws| laws.join(", ")).filter(|laws| !laws.is_empty());
        table.row(&[
            Cell::Text(&scene.case),
            Cell::Text(&scene.title),
            Cell::Text(law.as_deref().unwrap_or("small strain")),
            Cell::Text(&scene.blake3),
        ]);
    }
    let blocks = if table.is_empty() { Vec::new() } else { vec![Block::Table(table)] };
    let count = laws.len();
    let summary = format!("laws of {count} scene{}", plural(count));
    Evidence { factor: &factors::FORM, summary, blocks }
}

/// Evidence about the inputs: what their uncertainty does to the results.
pub(super) fn inputs(all: &[Uncertain], figures: Vec<String>) -> Evidence {
    if all.is_empty() {
        let text = "No scene of this folder has uncertain inputs ([vary]), so no sensitivity and no u_input is known.";
        let blocks = vec![Block::Text(text.into())];
        return Evidence { factor: &factors::INPUTS, summary: String::new(), blocks };
    }
    let ranks = ranks(all);
    let ranks = match ranks.is_empty() {
        true => Block::Text("No shares of the inputs are known: see the report.".into()),
        false => Block::Table(ranks),
    };
    let mut blocks = vec![Block::Table(results(all)), ranks];
    blocks.extend(figures.into_iter().map(Block::Figure));
    let summary = format!("{} result{} with uncertain inputs", all.len(), plural(all.len()));
    Evidence { factor: &factors::INPUTS, summary, blocks }
}

/// Table of the uncertainty of each result.
fn results(all: &[Uncertain]) -> Table {
    let mut table = Table::new(
        "result-uncertainty",
        "Uncertainty of results",
        "ASME V&V 20: u_num is the estimated numerical error of the scene as written, u_input the standard deviation by \
         the uncertain inputs, and u_val = sqrt(u_num^2 + u_input^2), to which a comparison with an experiment adds \
         u_D. SI units",
        &[
            ("scene", Words),
            ("method", Words),
            ("result", Words),
            ("samples", Number),
            ("missing", Number),
            ("mean", Number),
            ("u_input", Number),
            ("u_num", Number),
            ("u_val", Number),
            ("run", Words),
        ],
    );
    for of in all {
        let number = |value| Cell::Digits(value, 4);
        let found = of.statistics.as_ref();
        table.row(&[
            Cell::Text(&of.of.case),
            Cell::Text(&of.of.method),
            Cell::Text(&of.label()),
            Cell::Count((of.results + of.missing) as u64),
            Cell::Count(of.missing as u64),
            number(found.map(|s| s.mean.value)),
            number(found.map(|s| s.sd.value)),
            number(of.output.numerical),
            number(of.combined()),
            Cell::Text(&of.of.run.clone()),
        ]);
    }
    table
}

/// Table of the inputs of each result, the most important first.
fn ranks(all: &[Uncertain]) -> Table {
    let mut table = Table::new(
        "input-ranks",
        "Ranks of the inputs",
        "Shares of the uncertain inputs in the variance of each result (total Sobol indices), the largest first",
        &[
            ("scene", Words),
            ("result", Words),
            ("rank", Number),
            ("input", Words),
            ("distribution", Words),
            ("share", Number),
            ("run", Words),
        ],
    );
    for of in all {
        let shares = of.statistics.as_ref().map_or(&[][..], |s| &s.indices);
        let mut ranked: Vec<_> =
            of.of.inputs.iter().zip(shares.iter().map(|share| share.total.value)).collect();
        ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
        for (rank, (input, share)) in (1..).zip(ranked) {
            table.row(&[
                Cell::Text(&of.of.case),
                Cell::Text(&of.label()),
                Cell::Count(rank),
                Cell::Text(&input.key),
                Cell::Text(&words(input)),
                Cell::Text(&percent(share)),
                Cell::Text(&of.of.run.clone()),
            ]);
        }
    }
    table
}

/// Evidence of the comparison with an experiment: none, because no reference of a scene is a measurement.
pub(super) fn comparison(runs: &[Run]) -> Evidence {
    let mut text = String::from(
        "No reference of a scene is a measurement: references are exact solutions, finer solutions and stored \
         solutions. They verify the calculation and validate nothing.",
    );
    if runs.iter().any(|run| !run.is.published.is_empty()) {
        text += " The report compares some runs with published computations, which is no validation either.";
    }
    Evidence { factor: &factors::OUTPUT, summary: String::new(), blocks: vec![Block::Text(text)] }
}
