//! A run's folder turned into tables, figures and one page.

use std::path::{Path, PathBuf};

use minijinja::Environment;
use minijinja::value::{Serde, Value};
use serde::Serialize;

use crate::clouds::{self, Clouds};
use crate::error::ReportError;
use crate::figures;
use crate::findings;
use crate::provenance::{Machine, Program, SceneHash};
use crate::record::Record;
use crate::run_set::{RunSet, Status};
use crate::select;
use crate::store::{make_dir, read_run, remove_files, write_text};
use crate::table::{Column, Table};
use crate::tables;

/// Tenths of a rem on a screen for a point on paper.
const SCREEN: f64 = 1.032;

/// Tells a page of ours from another one of its name.
const TITLE: &str = "<title>tissuebench report</title>";

const PAGE: &str = include_str!("../assets/report.html");

/// What rendering wrote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rendered {
    /// The page to open first.
    pub page: PathBuf,
    /// Every file, in the order written, the page last.
    pub files: Vec<PathBuf>,
}

/// Reads a run's folder and writes `tables/*.{csv,md,tex}`, `figures/*.{svg,png}` and `report.html` to another (or the same).
///
/// The same records give the same bytes. Nothing is solved or timed again.
pub fn render(results: &Path, out: &Path) -> Result<Rendered, ReportError> {
    let set = read_run(results)?;
    // Along an axis a scene is another one from value to value: it has maps of its own.
    let as_they_are: Vec<Record> = set.records.iter().filter(|r| r.at.is_none()).cloned().collect();
    let (runs, clouds) = clouds::part(&select::runs(&as_they_are));
    let (table_dir, figure_dir) = (out.join("tables"), out.join("figures"));
    make_dir(&table_dir)?;
    make_dir(&figure_dir)?;
    let mut files = Vec::new();
    let mut write = |path: PathBuf, bytes: &[u8]| -> Result<(), ReportError> {
        write_text(&path, bytes)?;
        files.push(path);
        Ok(())
    };
    let tables = tables::all(&set, &runs, &clouds);
    for table in &tables {
        for (ending, text) in [("csv", table.csv()), ("md", table.markdown()), ("tex", table.latex())] {
            write(table_dir.join(format!("{}.{ending}", table.name)), text.as_bytes())?;
        }
    }
    let mut shown = Vec::new();
    for figure in figures::all(&set, &runs) {
        let svg = figure.canvas.svg(&figure.name, &figure.title)?;
        write(figure_dir.join(format!("{}.svg", figure.name)), svg.as_bytes())?;
        write(figure_dir.join(format!("{}.png", figure.name)), &figures::png(&figure.name, &svg)?)?;
        let mm = (figure.canvas.width() * 25.4 / 72.0).round();
        let rem = (SCREEN * figure.canvas.width()).round() / 10.0;
        shown.push(FigureView {
            name: figure.name,
            title: figure.title,
            caption: figure.caption,
            svg,
            rem,
            mm,
        });
    }
    let page = out.join("report.html");
    // Beside a page of ours what has our endings in the two folders is ours, and what is not written again is old.
    let ours = std::fs::read_to_string(&page).is_ok_and(|old| old.contains(TITLE));
    write(page.clone(), page_text(&set, (&runs, &clouds), &tables, &shown)?.as_bytes())?;
    if ours {
        remove_files(&table_dir, &["csv", "md", "tex"], &files)?;
        remove_files(&figure_dir, &["svg", "png"], &files)?;
    }
    Ok(Rendered { page, files })
}

#[derive(Serialize)]
struct FigureView {
    name: String,
    title: String,
    caption: String,
    svg: String,
    /// Width on a screen: text is as large in one figure as in another.
    rem: f64,
    /// Width on paper, for which its text is meant.
    mm: f64,
}

#[derive(Serialize)]
struct TableView<'a> {
    name: &'a str,
    title: &'a str,
    caption: &'a str,
    header: Vec<(&'a str, bool)>,
    rows: Vec<Vec<&'a str>>,
    note: &'a str,
}

#[derive(Serialize)]
struct TopicView {
    title: &'static str,
    sentences: Vec<String>,
}

#[derive(Serialize)]
struct Counts {
    cases: usize,
    runs: usize,
    numbers: usize,
    failures: usize,
    partial: usize,
    pass: usize,
    fail: usize,
    known: usize,
    not_run: usize,
}

#[derive(Serialize)]
struct PageView<'a> {
    heading: &'static str,
    program: &'a Program,
    machine: &'a Machine,
    scenes: &'a [SceneHash],
    findings: Vec<TopicView>,
    tables: Vec<TableView<'a>>,
    figures: &'a [FigureView],
    counts: Counts,
}

fn page_text(
    set: &RunSet,
    (runs, clouds): (&[select::Run], &[Clouds]),
    tables: &[Table],
    figures: &[FigureView],
) -> Result<String, ReportError> {
    let findings: Vec<TopicView> = findings::all(set, runs, clouds)
        .into_iter()
        .map(|t| TopicView { title: t.title, sentences: t.sentences })
        .collect();
    let tables: Vec<TableView> = tables
        .iter()
        .map(|t| TableView {
            name: t.name,
            title: &t.title,
            caption: &t.caption,
            header: t
                .header()
                .iter()
                .map(|(head, column)| (head.as_str(), *column != Column::Words))
                .collect(),
            rows: t.shown(),
            note: t.note(),
        })
        .collect();
    let count = |status: Status| set.checks.iter().filter(|c| c.status == status).count();
    let mut cases: Vec<&str> = set.records.iter().map(|r| r.case.as_str()).collect();
    cases.sort();
    cases.dedup();
    let mut environment = Environment::new();
    environment.add_template("report.html", PAGE)?;
    let fronts = figures.iter().any(|f| f.name.starts_with("efficiency"));
    let view = PageView {
        heading: if fronts { "Run time against error" } else { "Results" },
        program: &set.provenance.program,
        machine: &set.provenance.machine,
        scenes: &set.provenance.scenes,
        findings,
        tables,
        figures,
        counts: Counts {
            cases: cases.len(),
            runs: runs.len() + clouds.iter().map(|group| group.len() - 1).sum::<usize>(),
            numbers: set.records.len(),
            failures: set.failures.iter().filter(|f| f.carried.is_none()).count(),
            partial: set.failures.iter().filter(|f| f.carried.is_some()).count(),
            pass: count(Status::Pass),
            fail: count(Status::Fail),
            known: count(Status::KnownFailure),
            not_run: count(Status::NotRun),
        },
    };
    let page = environment.get_template("report.html")?.render(Value::from(Serde(&view)))?;
    Ok(page)
}
