//! The page of a report: a single file that needs no network, with its data in columns, drawn by the script
//! of `reports/page`.

mod bodies;
mod commits;
mod methods;
mod question;
mod tabled;

use std::collections::BTreeMap;

use records::{Machine, Program, Purpose, RunSet, SceneHash, Status};
use serde::Serialize;

use crate::clouds::Clouds;
use crate::commits::Trend;
use crate::error::ReportError;
use crate::figures::{Data, Figure};
use crate::findings;
use crate::fronts::{DEADLINES, FLOOR, WANTED};
use crate::plot::{Plot, Scale};
use crate::questions::asks;
use crate::select::{Run, solved};
use crate::table::Table;

use commits::TrendView;
use methods::{LookView, Methods, RunColumns};
use question::AskView;
use tabled::{MapView, TableView};

/// Title that identifies a page of this program.
pub(crate) const TITLE: &str = "<title>tissuebench report</title>";

const SKELETON: &str = include_str!("../../page/page.html");
const STYLE: &str = include_str!("../../page/src/page.css");
/// Script built from the sources in `page/src` by `npm run build`.
const SCRIPT: &str = include_str!("../../page/built/page.js");

/// A drawn figure.
pub(crate) struct Drawn {
    pub(crate) figure: Figure,
    pub(crate) svg: String,
}

#[derive(Serialize)]
struct PageData<'a> {
    source: &'a str,
    program: &'a Program,
    machine: &'a Machine,
    scenes: &'a [SceneHash],
    /// Path of the stored records for the page; empty if they are elsewhere.
    records: &'a str,
    /// Whether the results are those of a study, whose runs can be reproduced.
    study: bool,
    counts: Counts,
    cases: Vec<CaseView>,
    looks: BTreeMap<String, LookView>,
    labels: Vec<String>,
    runs: RunColumns,
    deadlines: Vec<(&'static str, &'static str, f64)>,
    /// Error selected initially.
    wanted: f64,
    /// Smallest error drawn; smaller errors are drawn at this value.
    floor: f64,
    asks: Vec<AskView>,
    plots: Vec<PlotView>,
    pictures: Vec<PictureView<'a>>,
    figures: Vec<(&'a str, &'a str, bool)>,
    maps: Vec<MapView<'a>>,
    trends: Vec<TrendView>,
    tables: Vec<TableView<'a>>,
    findings: Vec<(&'static str, Vec<String>)>,
}

#[derive(Serialize)]
struct Counts {
    runs: usize,
    numbers: usize,
    failures: usize,
    partial: usize,
    warnings: usize,
    pass: usize,
    fail: usize,
    known: usize,
    not_run: usize,
}

#[derive(Serialize)]
struct CaseView {
    name: String,
    title: String,
    purpose: Purpose,
}

#[derive(Serialize)]
struct PlotView {
    figure: String,
    case: String,
    title: String,
    x: Scale,
    y: Scale,
    curves: Vec<CurveView>,
}

#[derive(Serialize)]
struct CurveView {
    label: usize,
    /// Alternating coordinates: x, y, x, y.
    xy: Vec<f32>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    band: Vec<(f32, f32, f32)>,
    /// Indices of the runs: one for each point, or one for all.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    runs: Vec<usize>,
}

#[derive(Serialize)]
struct PictureView<'a> {
    name: &'a str,
    case: &'a str,
    title: &'a str,
    caption: &'a str,
    svg: String,
}

/// Text of the page.
pub(crate) fn html(
    set: &RunSet,
    (runs, clouds): (&[Run], &[Clouds]),
    trends: &[Trend],
    tables: &[Table],
    figures: &[Drawn],
    (records, study): (&str, bool),
) -> Result<String, ReportError> {
    let solved = solved(runs);
    let mut methods = Methods::new(&solved);
    let asks: Vec<AskView> =
        asks(&solved).iter().map(|ask| AskView::new(ask, &set.references, &mut methods)).collect();
    let (plots, pictures) = views(figures, &mut methods);
    let trends = trends.iter().map(|trend| TrendView::new(trend, &mut methods)).collect();
    let maps: Vec<MapView> = set.axes.iter().map(MapView::new).collect();
    let runs_made = runs.len() + clouds.iter().map(|group| group.len() - 1).sum::<usize>();
    let mut drawn: Vec<Vec<usize>> = asks.iter().map(AskView::labels).collect();
    drawn.extend(plots.iter().map(|plot| plot.curves.iter().map(|c| c.label).collect()));
    let (looks, labels, runs_shown) = methods.into_parts(&drawn);
    let data = PageData {
        source: &set.provenance.source,
        program: &set.provenance.program,
        machine: &set.provenance.machine,
        scenes: &set.provenance.scenes,
        records,
        study,
        counts: counts(set, runs_made),
        cases: cases(set),
        looks,
        labels,
        runs: runs_shown,
        deadlines: DEADLINES.iter().map(|d| (d.name, d.what, d.seconds)).collect(),
        wanted: WANTED,
        floor: FLOOR,
        asks,
        plots,
        pictures,
        figures: figures
            .iter()
            .map(|d| (&*d.figure.name, &*d.figure.title, d.figure.data.csv().is_some()))
            .collect(),
        maps,
        trends,
        tables: tables.iter().map(TableView::new).collect(),
        findings: findings::all(set, runs, clouds).into_iter().map(|t| (t.title, t.sentences)).collect(),
    };
    let json = serde_json::to_string(&data).map_err(ReportError::Page)?;
    // The data must not contain the end tag of their element.
    let json = json.replace('<', "\\u003c");
    let (head, rest) = SKELETON.split_once("{style}").unwrap_or((SKELETON, ""));
    let (middle, rest) = rest.split_once("{data}").unwrap_or((rest, ""));
    let (after, rest) = rest.split_once("{bodies}").unwrap_or((rest, ""));
    let (between, foot) = rest.split_once("{script}").unwrap_or((rest, ""));
    let bodies = bodies::elements(&set.fields, runs)?;
    Ok([head, STYLE, middle, &json, after, &bodies, between, SCRIPT, foot].concat())
}

fn views<'a>(figures: &'a [Drawn], methods: &mut Methods) -> (Vec<PlotView>, Vec<PictureView<'a>>) {
    let (mut plots, mut pictures) = (Vec::new(), Vec::new());
    for Drawn { figure, svg } in figures {
        match &figure.data {
            Data::Plots(all) => plots.extend(all.iter().map(|plot| plotted(&figure.name, plot, methods))),
            Data::Fronts(_) | Data::Rows(_) => {}
            Data::Picture(case) => pictures.push(PictureView {
                name: &figure.name,
                case,
                title: &figure.title,
                caption: &figure.caption,
                svg: on_any_paper(svg),
            }),
        }
    }
    (plots, pictures)
}

fn plotted(figure: &str, plot: &Plot, methods: &mut Methods) -> PlotView {
    let curve = |c: &crate::plot::Curve| CurveView {
        label: methods.label(&c.label, c.family),
        xy: c.points.iter().flat_map(|p| [p.0 as f32, p.1 as f32]).collect(),
        band: c.band.iter().map(|b| (b.0 as f32, b.1 as f32, b.2 as f32)).collect(),
        runs: c.runs.iter().filter_map(|id| methods.run(id)).collect(),
    };
    PlotView {
        figure: figure.into(),
        case: plot.case.clone(),
        title: plot.title.clone(),
        x: plot.x.clone(),
        y: plot.y.clone(),
        curves: plot.curves.iter().map(curve).collect(),
    }
}

/// A picture without its white background and with the page's text colour as ink, which is legible on dark
/// pages too.
fn on_any_paper(svg: &str) -> String {
    svg.replacen("fill=\"#FFFFFF\"", "fill=\"none\"", 1).replace("#202020", "currentColor")
}

fn counts(set: &RunSet, runs: usize) -> Counts {
    let count = |status: Status| set.checks.iter().filter(|c| c.status == status).count();
    Counts {
        runs,
        numbers: set.records.len(),
        failures: set.failures.iter().filter(|f| f.carried.is_none()).count(),
        partial: set.failures.iter().filter(|f| f.carried.is_some()).count(),
        warnings: set.warnings.len(),
        pass: count(Status::Pass),
        fail: count(Status::Fail),
        known: count(Status::KnownFailure),
        not_run: count(Status::NotRun),
    }
}

fn cases(set: &RunSet) -> Vec<CaseView> {
    let mut cases: BTreeMap<&str, Purpose> = BTreeMap::new();
    for record in &set.records {
        cases.entry(&record.case).or_insert(record.purpose);
    }
    let title = |name: &str| {
        let scene = set.provenance.scenes.iter().find(|s| s.case == name);
        scene.map_or(String::new(), |s| s.title.clone())
    };
    let view = |(name, purpose): (&str, Purpose)| CaseView { name: name.into(), title: title(name), purpose };
    cases.into_iter().map(view).collect()
}
