//! Renders the folder of a run as tables, figures and a page.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use records::RunSet;
use records::store::{end, make_dir, read_marked, read_numbers, remove_files, write_marked, write_text};

use crate::busy;
use crate::clouds;
use crate::commits;
use crate::credibility::{self, Statements};
use crate::error::ReportError;
use crate::figures::{self, Figure};
use crate::page::{self, Drawn};
use crate::select;
use crate::tables;
use crate::uncertain;

/// Files written by a rendering.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rendered {
    /// Path of the page.
    pub page: PathBuf,
    /// All files in the order of writing, the page last.
    pub files: Vec<PathBuf>,
}

/// Reads the folder of a run and writes `tables/*.{csv,md,tex}`, `figures/*.{svg,png,pdf,csv}`,
/// `credibility.{md,html}` and `report.html` to another folder (or the same).
///
/// The same records give the same bytes. Nothing is solved or timed again.
///
/// # Errors
/// A folder without complete results or without records, or a file that cannot be written.
pub fn render(results: &Path, out: &Path) -> Result<Rendered, ReportError> {
    render_with(results, out, None, &Statements::default())
}

/// Renders a run as [`render`] does, with a history of studies ([`commits`](crate::commits)) drawn over
/// commits if one is given, and with statements about credibility factors.
///
/// # Errors
/// As for [`render`], and a history that cannot be read.
pub fn render_with(
    results: &Path,
    out: &Path,
    history: Option<&Path>,
    statements: &Statements,
) -> Result<Rendered, ReportError> {
    render_set(&read_numbers(results, "report")?, (results, out), history, statements)
}

/// Writes a run to a folder, and its report to `report` in this folder. The folder is marked as incomplete
/// until both are written, so that results never appear complete with an older page.
///
/// # Errors
/// Invalid records, or a file that cannot be written.
pub fn write_with_report(dir: &Path, run: &RunSet, history: Option<&Path>) -> Result<Rendered, ReportError> {
    write_marked(dir, run)?;
    let out = dir.join("report");
    let rendered = render_set(&read_marked(dir)?, (dir, &out), history, &Statements::default())?;
    end(dir)?;
    Ok(rendered)
}

fn render_set(
    set: &RunSet,
    (results, out): (&Path, &Path),
    history: Option<&Path>,
    statements: &Statements,
) -> Result<Rendered, ReportError> {
    let trends = match history {
        Some(history) => commits::shown(history, &set.provenance.source)?,
        None => Vec::new(),
    };
    // Each value on an axis is a different scene; stability maps show these runs.
    let as_they_are = set.records.iter().filter(|r| r.at.is_none());
    let mut all = select::runs(as_they_are);
    busy::decide(&mut all, &set.provenance.machine);
    let (runs, clouds) = clouds::part(&all);
    let uncertain = uncertain::uncertain(set);
    let (table_dir, figure_dir) = (out.join("tables"), out.join("figures"));
    make_dir(&table_dir)?;
    make_dir(&figure_dir)?;
    let mut files = Vec::new();
    let mut write = |path: PathBuf, bytes: &[u8]| -> Result<(), ReportError> {
        write_text(&path, bytes)?;
        files.push(path);
        Ok(())
    };
    let tables = tables::all(set, (&runs, &clouds), &uncertain, &trends);
    for table in &tables {
        for (ending, text) in [("csv", table.csv()), ("md", table.markdown()), ("tex", table.latex())] {
            write(table_dir.join(format!("{}.{ending}", table.name)), text.as_bytes())?;
        }
    }
    let drawn: Vec<_> = figures::all(set, &runs, &uncertain, &trends).into_par_iter().map(draw).collect();
    let drawn: Vec<Painted> = drawn.into_iter().collect::<Result<_, ReportError>>()?;
    for Painted { drawn: Drawn { figure, svg }, png, pdf } in &drawn {
        let path = |ending: &str| figure_dir.join(format!("{}.{ending}", figure.name));
        write(path("svg"), svg.as_bytes())?;
        write(path("png"), png)?;
        write(path("pdf"), pdf)?;
        if let Some(csv) = figure.data.csv() {
            write(path("csv"), csv.as_bytes())?;
        }
    }
    let drawn: Vec<Drawn> = drawn.into_iter().map(|painted| painted.drawn).collect();
    let [markdown, html] = credibility::document(set, &runs, &uncertain, &drawn, statements);
    write(out.join("credibility.md"), markdown.as_bytes())?;
    write(out.join("credibility.html"), html.as_bytes())?;
    let page = out.join("report.html");
    // The folders of an existing report contain only report files with these suffixes; those not written
    // again are outdated.
    let ours = disk::read_text(&page, disk::Kind::RESULTS).is_ok_and(|old| old.contains(page::TITLE));
    let stored = (records_from(results, out), results.join(STUDY).is_file());
    let html = page::html(set, (&runs, &clouds), &trends, &tables, &drawn, stored)?;
    write(page.clone(), html.as_bytes())?;
    if ours {
        remove_files(&table_dir, &["csv", "md", "tex"], &files)?;
        remove_files(&figure_dir, &["svg", "png", "pdf", "csv"], &files)?;
    }
    Ok(Rendered { page, files })
}

/// A figure in all its formats.
struct Painted {
    drawn: Drawn,
    png: Vec<u8>,
    pdf: Vec<u8>,
}

fn draw(figure: Figure) -> Result<Painted, ReportError> {
    let svg = figure.drawing.svg(&figure.name, &figure.title)?;
    let (png, pdf) = figures::png_and_pdf(&figure.name, &figure.title, &svg)?;
    Ok(Painted { drawn: Drawn { figure, svg }, png, pdf })
}

/// File in the results of a study that names its runs.
const STUDY: &str = "study.json";

/// Path of the records for the page; empty unless the folders move together.
fn records_from(results: &Path, out: &Path) -> &'static str {
    if out == results {
        "records.csv"
    } else if out.parent() == Some(results) {
        "../records.csv"
    } else {
        ""
    }
}
