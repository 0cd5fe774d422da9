//! The document with the evidence of credibility: every factor has evidence or a named blank.

use std::fs;

use records::{
    Check, Family, Input, Output, PlanEntry, Program, Provenance, Purpose, Record, Reference, RunSet, Sample,
    SampleResults, Samples, SceneHash, Status, Warning, write_run,
};
use tissuebench_reports::{Statements, read_statements, render_with};
use uncertainty::Distribution;

/// A run with its plain numbers.
fn run(of: &Record, numbers: &[(&str, &str, f64)]) -> Vec<Record> {
    let row = |(name, unit, value): &(&str, &str, f64)| {
        Record { unit: unit.to_string(), value: *value, ..of.clone() }.named(name)
    };
    numbers.iter().map(row).collect()
}

fn base(case: &str, id: &str, nodes: u64) -> Record {
    Record {
        run: id.into(),
        case: case.into(),
        method: "tet10".into(),
        series: "tet10".into(),
        family: Family::Fem,
        variant: "tet10".into(),
        dilation: Some("standard".into()),
        linear_solver: Some("sparse-llt".into()),
        poisson: 0.45,
        nodes,
        spacing: 0.1 / nodes as f64,
        statistic: "value".into(),
        ..Record::default()
    }
}

fn check(case: &str, metric: &str, value: f64, status: Status, runs: &[&str]) -> Check {
    Check {
        case: case.into(),
        method: "tet10".into(),
        metric: metric.into(),
        value: Some(value),
        bound: "at most 1e-2".into(),
        capped: true,
        status,
        reason: if status == Status::Fail { "too large".into() } else { String::new() },
        runs: runs.iter().map(|id| id.to_string()).collect(),
        at: String::new(),
    }
}

/// A scene with an exact solution on two meshes, and a scene of a user with a tool, an estimate, a warning
/// and an uncertain input.
fn set() -> RunSet {
    let ball = |id, nodes| Record { purpose: Purpose::Smooth, ..base("ball", id, nodes) };
    let organ =
        Record { law: Some("neo-hookean".into()), purpose: Purpose::Rough, ..base("organ", "c3", 400) };
    let mut records =
        run(&ball("a1", 100), &[("l2", "1", 8e-3), ("max", "m", 1e-3), ("residual", "1", 1e-13)]);
    records.extend(run(&ball("b2", 200), &[("l2", "1", 1e-3), ("max", "m", 1.01e-3)]));
    records.extend(run(
        &organ,
        &[
            ("max", "m", 4e-3),
            ("tool-force", "N", 2.5),
            ("tool-force-error-estimate", "1", 0.03),
            ("tool-force-error-saturation", "1", 0.98),
            ("newton-iterations", "1", 12.0),
        ],
    ));
    let plan = |case: &str, stage: &str| PlanEntry {
        case: case.into(),
        method: "tet10".into(),
        stage: stage.into(),
        ran: true,
        why: String::new(),
    };
    let values = [9.0, 10.0, 11.0, 12.0];
    let sample = |(number, value): (usize, &f64)| Sample {
        sample: number as u32 + 1,
        values: vec![*value],
        results: SampleResults { results: vec![Some(0.25 * value)], curves: vec![Vec::new()] },
        warnings: Vec::new(),
        failure: String::new(),
    };
    RunSet {
        provenance: Provenance {
            source: "organ.toml".into(),
            program: Program { version: "0.2.0".into(), commit: "abc".into(), ..Program::default() },
            scenes: vec![SceneHash { case: "organ".into(), blake3: "0f".into(), title: "An <organ>".into() }],
            ..Provenance::default()
        },
        records,
        checks: vec![
            check("ball", "l2", 8e-3, Status::Pass, &["a1"]),
            check("ball", "l2", 1e-3, Status::Pass, &["b2"]),
            check("organ", "tool-force", 2.5, Status::Fail, &["c3"]),
        ],
        plans: vec![plan("ball", "stiffness"), plan("organ", "stiffness"), plan("organ", "contact search")],
        references: vec![Reference {
            case: "ball".into(),
            method: "thick-sphere".into(),
            ..Reference::default()
        }],
        warnings: vec![Warning {
            case: "organ".into(),
            method: "tet10".into(),
            run: "c3".into(),
            code: "deep-penetration".into(),
            message: "the tool is 1 mm deep".into(),
            value: 1e-3,
            unit: "m".into(),
            place: "tool[0]".into(),
        }],
        samples: vec![Samples {
            case: "organ".into(),
            method: "tet10".into(),
            run: "c3".into(),
            family: Family::Fem,
            inputs: vec![Input {
                key: "material.young".into(),
                unit: "kPa".into(),
                distribution: Distribution::Uniform { low: 8.0, high: 13.0 },
            }],
            seed: 1,
            outputs: vec![Output { name: "tool-force".into(), nominal: Some(2.5), numerical: Some(0.075) }],
            along: "closure".into(),
            samples: values.iter().enumerate().map(sample).collect(),
        }],
        ..RunSet::default()
    }
}

/// The document as Markdown and HTML.
fn document(set: &RunSet, statements: &Statements) -> [String; 2] {
    let dir = tempfile::tempdir().unwrap();
    write_run(dir.path(), set).unwrap();
    render_with(dir.path(), dir.path(), None, statements).unwrap();
    ["md", "html"].map(|end| fs::read_to_string(dir.path().join(format!("credibility.{end}"))).unwrap())
}

#[test]
fn the_document_keeps_its_numbers_and_words() {
    let [markdown, html] = document(&set(), &Statements::default());
    insta::assert_snapshot!(markdown);
    assert!(html.contains("An &lt;organ&gt;") && html.contains("<svg") && !html.contains("{body}"));
    assert!(html.contains("<tr class=\"bad\"><td>fail</td>"), "a failed check stands out");
}

#[test]
fn an_exact_solution_with_a_failed_check_covers_nothing() {
    let mut set = set();
    set.checks[1].status = Status::Fail;
    let [markdown, _] = document(&set, &Statements::default());
    assert!(
        markdown
            .contains("| fail | ball | thick-sphere | linear elasticity | tet10 | 1 | 1 | 0 | 0 | a1 b2 |")
    );
    // The finer run failed; the coarser one still covers its parts.
    assert!(!markdown.contains("| stage | stiffness |"));
    set.checks[0].status = Status::NotRun;
    let [markdown, _] = document(&set, &Statements::default());
    assert!(markdown.contains("| stage | stiffness | ball organ | a1 c3 |"), "{markdown}");
}

#[test]
fn a_statement_replaces_its_blank_only() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("statements.toml");
    fs::write(&file, "context_of_use = \"A <plate> on a kidney.\"\n").unwrap();
    let [markdown, html] = document(&set(), &read_statements(&file).unwrap());
    assert!(html.contains("<p>A &lt;plate&gt; on a kidney.</p>"));
    assert!(markdown.contains("| 1.2 Context of use | none | stated |"));
    assert!(!markdown.contains("Blank: context_of_use") && markdown.contains("Blank: model_risk"));
    // With or without statements, no factor lacks both evidence and a blank.
    assert_eq!(markdown.matches("**Blank: ").count(), 18);
}
