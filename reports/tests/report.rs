//! A rendered run: its page, tables and figures.

mod common;

use std::fs;
use std::path::Path;

use records::{RunSet, SceneHash, write_run};
use serde_json::Value;
use tissuebench_reports::commits::add;
use tissuebench_reports::{ReportError, Statements, render, render_with, write_with_report};

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

/// Data embedded in a page.
fn inside(page: &Path) -> Value {
    let text = text(page);
    let data = text.split_once("id=\"data\">").unwrap().1.split_once("</script>").unwrap().0;
    serde_json::from_str(data).unwrap()
}

/// Names of the items in a list of the page.
fn names<'a>(data: &'a Value, list: &str, key: impl serde_json::value::Index + Copy) -> Vec<&'a str> {
    data[list].as_array().unwrap().iter().map(|it| it[key].as_str().unwrap()).collect()
}

#[test]
fn a_second_page_leaves_no_table_or_figure_of_the_first() {
    let dir = tempfile::tempdir().unwrap();
    let figures = dir.path().join("figures");
    let mut set = common::study();
    write_run(dir.path(), &set).unwrap();
    // Without a page, no file in the folder is assumed to belong to a report.
    fs::create_dir(&figures).unwrap();
    fs::write(figures.join("mine.svg"), "").unwrap();
    render(dir.path(), dir.path()).unwrap();
    let failed = dir.path().join("tables/failed-runs.md");
    assert!(failed.is_file() && figures.join("mine.svg").is_file());
    set.failures.clear();
    write_run(dir.path(), &set).unwrap();
    let rendered = render(dir.path(), dir.path()).unwrap();
    assert!(!failed.exists());
    let mut kept: Vec<_> = ["tables", "figures"]
        .iter()
        .flat_map(|folder| fs::read_dir(dir.path().join(folder)).unwrap().map(|entry| entry.unwrap().path()))
        .chain([rendered.page])
        .chain(["credibility.md", "credibility.html"].map(|name| dir.path().join(name)))
        .collect();
    let mut written = rendered.files;
    kept.sort();
    written.sort();
    assert_eq!(kept, written);
}

#[test]
fn the_same_records_give_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let mut set = common::study();
    write_run(&dir.path().join("run"), &set).unwrap();
    let first = render(&dir.path().join("run"), &dir.path().join("one")).unwrap();
    // The order of the records must not affect the result.
    set.records.reverse();
    write_run(&dir.path().join("run2"), &set).unwrap();
    let second = render(&dir.path().join("run2"), &dir.path().join("two")).unwrap();
    assert_eq!(first.files.len(), second.files.len());
    for (a, b) in first.files.iter().zip(&second.files) {
        assert_eq!(a.file_name(), b.file_name());
        assert!(fs::read(a).unwrap() == fs::read(b).unwrap(), "{} differs", a.display());
    }
    for file in ["records.csv", "checks.csv", "provenance.json"] {
        let read = |run: &str| fs::read(dir.path().join(run).join(file)).unwrap();
        assert!(read("run") == read("run2"), "{file} differs");
    }
}

#[test]
fn forces_stand_beside_the_reference_and_its_band() {
    let dir = tempfile::tempdir().unwrap();
    write_run(dir.path(), &common::study()).unwrap();
    render(dir.path(), dir.path()).unwrap();
    let table = text(&dir.path().join("tables/force-closure.csv"));
    let rows: Vec<Vec<&str>> = table.lines().skip(1).map(|l| l.split(',').collect()).collect();
    // Two methods at forty steps, for hex8 only the finer run.
    assert_eq!(rows.len(), 80);
    for row in rows {
        let number = |k: usize| row[k].parse::<f64>().unwrap();
        let (method, nodes, stiffness) =
            if row[2] == "hex8" { ("hex8", 1377.0, 1.03) } else { ("efg", 225.0, 0.97) };
        assert_eq!((row[0], row[2], number(3)), ("grasp", method, nodes));
        let closure = 0.25e-3 * number(1);
        let force = 120.0 * closure + 9e3 * closure * closure;
        for (k, expected) in [
            (4, 1e3 * closure),
            (5, stiffness * force),
            (6, force),
            (7, 0.92 * force),
            (8, 1.08 * force),
            (9, 100.0 * (stiffness - 1.0)),
        ] {
            assert!((number(k) / expected - 1.0).abs() < 1e-9, "column {k}: {row:?}");
        }
        assert_eq!(row[10], "yes");
    }
    let energies = text(&dir.path().join("figures/energy-time.svg"));
    assert!(energies.contains("work of loads and tools") && energies.contains("contact springs"));
    assert!(!energies.contains("lost in damping"), "there is none");
}

#[test]
fn every_table_and_figure_appears_and_is_linked() {
    let dir = tempfile::tempdir().unwrap();
    write_run(dir.path(), &common::study()).unwrap();
    let rendered = render(dir.path(), dir.path()).unwrap();
    let page = inside(&rendered.page);
    for table in [
        "errors",
        "rms",
        "maxima",
        "orders",
        "grid-convergence",
        "timing",
        "repeated",
        "transfer",
        "conditioning",
        "published",
        "force-closure",
        "checks",
        "failed-runs",
        "plan",
    ] {
        assert!(names(&page, "tables", "name").contains(&table), "{table}");
        for ending in ["csv", "md", "tex"] {
            let name = format!("tables/{table}.{ending}");
            assert!(rendered.files.contains(&dir.path().join(&name)), "{name}");
        }
    }
    for figure in [
        "efficiency",
        "efficiency-pressure",
        "efficiency-force",
        "efficiency-peak",
        "efficiency-repeated",
        "efficiency-repeated-force",
        "convergence-l2",
        "convergence-energy",
        "convergence-pressure",
        "locking",
        "tool-force",
        "energy-time",
        "surface-kidney-grasped",
        "surface-kidney-paper",
        "pressure-kidney-grasped",
        "rms-kidney-paper",
        "transfer-kidney-paper",
        "conditioning",
        "neighbours",
    ] {
        assert!(names(&page, "figures", 0).contains(&figure), "{figure}");
        // The data of a picture of a body are in the folder `fields` of the results.
        let picture = figure.starts_with("surface-") || figure.starts_with("pressure-");
        for ending in ["svg", "png", "csv"].into_iter().take(if picture { 2 } else { 3 }) {
            let name = format!("figures/{figure}.{ending}");
            assert!(rendered.files.contains(&dir.path().join(&name)), "{name}");
        }
        let svg = text(&dir.path().join(format!("figures/{figure}.svg")));
        // The width of two columns of a journal, or of one.
        let whole = ["504pt", "241pt"].iter().any(|w| svg.starts_with(&format!("<svg width=\"{w}\"")));
        assert!(whole && svg.contains("<title>"), "{figure}");
    }
    assert!(!page.to_string().contains("NaN"));
    // The page is excluded, because its script may contain NaN.
    for file in rendered
        .files
        .iter()
        .filter(|f| f.extension().is_some_and(|e| e != "png" && e != "pdf" && e != "html"))
    {
        assert!(!text(file).contains("NaN") && !text(file).contains("inf,"), "{}", file.display());
    }
}

#[test]
fn the_page_stands_alone_and_escapes_what_it_shows() {
    let dir = tempfile::tempdir().unwrap();
    let mut set = common::study();
    set.failures[0].reason = "<script>alert(1)</script> & \"quotes\"".into();
    write_run(dir.path(), &set).unwrap();
    let path = render(dir.path(), dir.path()).unwrap().page;
    let page = text(&path);
    // Data and script are one element each, which no content terminates; there is no third element.
    assert_eq!((page.matches("<script").count(), page.matches("</script>").count()), (2, 2));
    for request in ["src=\"", "@import", "url(http", "<link", "fetch(", "XMLHttpRequest"] {
        assert!(!page.contains(request), "{request}");
    }
    let data = inside(&path);
    assert_eq!(data["machine"]["cpu"], "Example CPU <model> & co");
    let failed = data["tables"].as_array().unwrap().iter().find(|t| t["name"] == "failed-runs").unwrap();
    assert!(failed["columns"].to_string().contains("<script>alert(1)</script> & "), "{failed}");
}

#[test]
fn findings_state_what_the_records_hold() {
    let dir = tempfile::tempdir().unwrap();
    write_run(dir.path(), &common::study()).unwrap();
    let page = inside(&render(dir.path(), dir.path()).unwrap().page);
    let found = page["findings"].to_string();
    for sentence in [
        "pure-bending: from ν = 0 to 0.495, at the middle size, the relative L2 error more than doubles with tet4",
        "pure-bending: tet4, 0.622 % to 15.6 %",
        // 3.20 ms against 23 s.
        "preparing EFG 23 s, 3.20 ms, 7200;",
        "from linear: thin-plate has the smallest error (rounding only), nearest the largest (0.90 mm RMS); inverse distance, the published scheme, has 0.50 mm RMS.",
        "patch-displacement: 3 of 4 methods reproduce the displacement within 10⁻¹². efg-gauss does not: its relative error is 0.0014.",
    ] {
        assert!(found.contains(sentence), "{sentence}\n{found}");
    }
    // A linear scene without contact has no time comparable with the published contact.
    for unlike in ["kidney-paper: the claim", "the whole FE run (about 2 h)", "solving EFG"] {
        assert!(!found.contains(unlike), "{unlike}\n{found}");
    }
    let counts = &page["counts"];
    assert_eq!(
        (&counts["pass"], &counts["fail"], &counts["known"]),
        (&1.into(), &1.into(), &1.into()),
        "{counts}"
    );
}

#[test]
fn what_was_not_recorded_is_not_claimed() {
    let dir = tempfile::tempdir().unwrap();
    let mut set = common::study();
    set.records.retain(|r| r.quantity != "time" && r.case != "kidney-paper");
    set.fields.clear();
    write_run(dir.path(), &set).unwrap();
    let rendered = render(dir.path(), dir.path()).unwrap();
    let page = inside(&rendered.page);
    assert_eq!(page["asks"], Value::Array(Vec::new()), "without times there is no front");
    let page = page.to_string();
    for claim in ["times as long", "Repeated solves", "Transfer schemes", "Run time by phase", "surface-"] {
        assert!(!page.contains(claim), "{claim}");
    }
    assert!(page.contains("Locking"));
    // An empty run set still gives a page.
    let nothing = RunSet { provenance: set.provenance, ..RunSet::default() };
    // A run without numbers has a page that states this, but a requested report is refused.
    let empty = write_with_report(dir.path(), &nothing, None).unwrap();
    let refused = render(dir.path(), &dir.path().join("empty")).unwrap_err().to_string();
    assert!(refused.ends_with("holds no records: there is nothing to report"), "{refused}");
    assert_eq!(empty.files.len(), 3);
    assert_eq!(inside(&empty.page)["counts"]["runs"], 0);
}

#[test]
fn histories_become_figures_and_nothing_else() {
    let dir = tempfile::tempdir().unwrap();
    let study = common::study();
    let mut set = RunSet { provenance: study.provenance, records: study.records, ..RunSet::default() };
    set.records.retain(|r| r.case == "grasp");
    write_run(dir.path(), &set).unwrap();
    let rendered = render(dir.path(), dir.path()).unwrap();
    let names: Vec<String> =
        rendered.files.iter().map(|f| f.file_name().unwrap().to_string_lossy().into_owned()).collect();
    assert_eq!(
        names,
        [
            "force-closure.csv",
            "force-closure.md",
            "force-closure.tex",
            "tool-force.svg",
            "tool-force.png",
            "tool-force.pdf",
            "tool-force.csv",
            "energy-time.svg",
            "energy-time.png",
            "energy-time.pdf",
            "energy-time.csv",
            "credibility.md",
            "credibility.html",
            "report.html"
        ]
    );
    let force = text(&dir.path().join("figures/tool-force.svg"));
    for words in [
        "closure [mm]",
        "tool force [N]",
        "hex8",
        "efg",
        "measured",
        "Filled: elements",
        "Grey band",
        "#D6D6D6",
    ] {
        assert!(force.contains(words), "{words}");
    }
    let energy = text(&dir.path().join("figures/energy-time.svg"));
    for words in ["time [s]", "energy [mJ]", "grasp, hex8", "grasp, efg", "kinetic", "work of loads"] {
        assert!(energy.contains(words), "{words}");
    }
    assert!(!energy.contains("measured"), "a reference without energies has no panel");
    // A single step is not a history.
    set.records.retain(|r| r.step == Some(3));
    write_run(dir.path(), &set).unwrap();
    assert_eq!(render(dir.path(), &dir.path().join("one")).unwrap().files.len(), 3);
}

/// A report as text: its files with their contents, and for figures the words and the number of shapes.
/// `name` is replaced in both.
fn contents(set: &RunSet, name: &str) -> Vec<(String, String)> {
    let dir = tempfile::tempdir().unwrap();
    write_run(dir.path(), set).unwrap();
    let rendered = render(dir.path(), dir.path()).unwrap();
    let mut all = Vec::new();
    for file in rendered.files.iter().filter(|f| f.extension().is_some_and(|e| e == "md" || e == "svg")) {
        let mut content = text(file);
        if file.extension().is_some_and(|e| e == "svg") {
            // Positions on paper depend on the width of a name; the content does not.
            let words: Vec<&str> =
                content.split('<').filter_map(|tag| tag.split_once('>')).map(|t| t.1.trim()).collect();
            content = format!("{} {}", words.join(" "), content.matches(" d=\"").count());
        }
        let path = file.strip_prefix(dir.path()).unwrap().to_string_lossy().into_owned();
        all.push((path.replace(name, "NAME"), content.replace(name, "NAME")));
    }
    let page = inside(&rendered.page);
    // The look of a label depends on the label, which may be the name of a case. Positions in a picture
    // depend on the width of a name. The id of a run contains the name of its case.
    let left_out = ["looks", "pictures", "scenes", "cases", "runs"];
    for (part, value) in
        page.as_object().unwrap().iter().filter(|(part, _)| !left_out.contains(&part.as_str()))
    {
        all.push((format!("page: {part}"), value.to_string().replace(name, "NAME")));
    }
    all
}

#[test]
fn no_name_of_a_case_means_anything() {
    let study = common::study();
    let mut cases: Vec<String> = study.records.iter().map(|r| r.case.clone()).collect();
    cases.dedup();
    for case in cases {
        let mut set = study.clone();
        set.records.retain(|r| r.case == case);
        set.fields.retain(|f| f.case == case);
        set.checks.retain(|c| c.case == case);
        set.plans.retain(|p| p.case == case);
        set.failures.retain(|f| f.case == case);
        let before = contents(&set, &case);
        assert!(before.len() > 1, "{case}");
        for other in ["beam-1", "rigid-kidney-paper-patch", "bonded-bar-wave"] {
            let mut renamed = set.clone();
            // The id of a run contains the name of its case.
            renamed.records.iter_mut().for_each(|r| r.run = r.run.replace(&case, other));
            renamed.records.iter_mut().for_each(|r| r.case = other.into());
            renamed.fields.iter_mut().for_each(|f| f.case = other.into());
            renamed.checks.iter_mut().for_each(|c| c.case = other.into());
            renamed.plans.iter_mut().for_each(|p| p.case = other.into());
            renamed.failures.iter_mut().for_each(|f| f.case = other.into());
            let own = |scene: &&mut SceneHash| scene.case == case;
            renamed.provenance.scenes.iter_mut().filter(own).for_each(|scene| scene.case = other.into());
            let after = contents(&renamed, other);
            for (a, b) in before.iter().zip(&after) {
                assert_eq!(a, b, "{case} as {other}");
            }
            assert_eq!(before.len(), after.len(), "{case} as {other}");
        }
    }
}

#[test]
fn a_study_at_other_sizes_keeps_one_name() {
    let dir = tempfile::tempdir().unwrap();
    let mut set = common::study();
    // A study of sizes runs `efg-wendland-c2-83` again at 332 nodes, and its label must not claim 83 nodes
    // there.
    for record in &mut set.records {
        if record.series == "efg-wendland-c2" && record.case == "kidney-paper" {
            record.method = "efg-wendland-c2-83".into();
        }
    }
    write_run(dir.path(), &set).unwrap();
    render(dir.path(), dir.path()).unwrap();
    let table = text(&dir.path().join("tables/rms.md"));
    assert!(!table.contains("efg-wendland-c2-83"), "{table}");
    assert_eq!(table.matches("| efg-wendland-c2 |").count(), 5, "{table}");
}

#[test]
fn a_history_is_drawn_over_commits_with_what_moved() {
    let dir = tempfile::tempdir().unwrap();
    let (results, history) = (dir.path().join("results"), dir.path().join("history"));
    let mut study = common::study();
    write_run(&results, &study).unwrap();
    let page = |history: Option<&Path>| {
        let rendered = render_with(&results, &results.join("report"), history, &Statements::default())?;
        Ok::<_, ReportError>((inside(&rendered.page), rendered.files))
    };
    let error = page(Some(&history)).unwrap_err().to_string();
    assert!(error.contains("holds no history"), "{error}");
    for (commit, times) in [("a1b2c3d4e5f6a7", 1.0), ("fedcba98765432", 2.0)] {
        study.provenance.program.commit = commit.into();
        study.records.iter_mut().filter(|r| r.quantity == "l2").for_each(|r| r.value *= times);
        add(&history, &study, "").unwrap();
    }
    let (shown, files) = page(Some(&history)).unwrap();
    let commits = shown["trends"][0]["commits"].as_array().unwrap();
    assert_eq!(commits.len(), 2);
    assert_eq!(commits[0]["moved"], "");
    assert!(commits[1]["moved"].as_str().unwrap().ends_with("errors worse"), "{}", commits[1]);
    assert_eq!((&commits[1]["errors_moved"], &commits[1]["times_moved"]), (&true.into(), &false.into()));
    assert!(commits[1]["changes"][0].as_str().unwrap().contains("l2"), "{}", commits[1]);
    for file in ["figures/over-commits.pdf", "figures/over-commits.csv", "tables/over-commits.md"] {
        assert!(files.iter().any(|f| f.ends_with(file)), "{file}");
    }
    let (without, _) = page(None).unwrap();
    assert_eq!(without["trends"], Value::Array(Vec::new()));
    assert!(!results.join("report/figures/over-commits.svg").exists());
}

#[test]
fn every_figure_is_written_for_print() {
    let dir = tempfile::tempdir().unwrap();
    write_run(dir.path(), &common::study()).unwrap();
    let files = render(dir.path(), dir.path()).unwrap().files;
    let drawn: Vec<_> = files.iter().filter(|f| f.extension().is_some_and(|e| e == "svg")).collect();
    assert!(drawn.len() > 10);
    for svg in drawn {
        for (ending, begins) in [("png", &b"\x89PNG"[..]), ("pdf", b"%PDF-")] {
            assert!(fs::read(svg.with_extension(ending)).unwrap().starts_with(begins), "{svg:?} as {ending}");
        }
    }
}
