//! The history of a study over commits: stored, shown and drawn.

mod common;

use std::path::Path;

use common::{BLOCK, assert_fails, inside, tissuebench, write};

/// Writes the results of another commit: a summary with its commit, and errors multiplied by `times`.
fn another_commit(file: &Path, times: f64) {
    let mut summary: toml::Table = std::fs::read_to_string(file).unwrap().parse().unwrap();
    summary["program"]["commit"] = "fedcba987654".into();
    for (_, run) in summary["runs"].as_table_mut().unwrap() {
        for (_, error) in run["errors"].as_table_mut().unwrap() {
            *error = (error.as_float().unwrap() * times).into();
        }
    }
    std::fs::write(file, toml::to_string(&summary).unwrap()).unwrap();
}

#[test]
fn results_of_commits_are_kept_and_a_worse_error_is_marked() {
    let dir = tempfile::tempdir().unwrap();
    let text = format!("{BLOCK}reference = {{ method = \"tet4\", size = {{ cells = [4, 4, 2] }} }}\n");
    let (scene, results, history) =
        (write(&dir, "block.toml", &text), inside(&dir, "results"), inside(&dir, "history"));
    assert_fails(&tissuebench(&["history", "show", &history]), 2, "holds no history");
    assert_fails(&tissuebench(&["history", "add", &results, "--to", &history]), 2, "holds no results");
    assert_eq!(tissuebench(&["run", &scene, "--once", "--out", &results]).code, 0);
    let add = || tissuebench(&["history", "add", &results, "--to", &history]).stdout.trim().to_string();
    let (first, second) = (add(), add());
    assert!(first.contains("0001-") && second.contains("0002-"), "{first} {second}");
    assert_eq!(std::fs::read(&first).unwrap(), std::fs::read(&second).unwrap());
    another_commit(Path::new(&second), 2.0);
    let figure = inside(&dir, "history.svg");
    let done = tissuebench(&["history", "show", &history, "--figure", &figure]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stdout.starts_with("block.toml on "), "{}", done.stdout);
    assert!(done.stdout.contains("worse   block tet4") && done.stdout.contains("2.000"), "{}", done.stdout);
    assert!(std::fs::read_to_string(&figure).unwrap().starts_with("<svg"));
    let json = tissuebench(&["history", "show", &history, "--format", "json"]).stdout;
    let trends: serde_json::Value = serde_json::from_str(&json).unwrap();
    let points = trends[0]["points"].as_array().unwrap();
    assert_eq!((points.len(), points[1]["runs"].as_u64()), (2, Some(1)));
    assert!(points[1]["step"]["worse"][0]["quantity"].is_string() && points[0]["step"].is_null());
    let done = tissuebench(&["report", &results, "--history", &history]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let table = Path::new(&results).join("report/tables/over-commits.csv");
    assert!(std::fs::read_to_string(table).unwrap().contains("worse"));
    // A study draws the history too, and reports an unreadable history before its runs.
    let study = write(&dir, "study.toml", "title = \"one block\"\n[[run]]\nscene = \"block.toml\"\n");
    let verified = inside(&dir, "verified");
    let verify = |history: &str| tissuebench(&["verify", &study, "--out", &verified, "--history", history]);
    assert_fails(&verify(&inside(&dir, "none")), 2, "holds no history");
    assert!(!Path::new(&verified).exists());
    assert_eq!(verify(&history).code, 0);
    assert!(Path::new(&verified).join("report/tables/over-commits.csv").is_file());
    let labelled = ["history", "add", &results, "--to", &history, "--label", "a label of many words"];
    assert_eq!(tissuebench(&labelled).code, 0);
    let shown = tissuebench(&["history", "show", &history]).stdout;
    let line = |says: &str| shown.lines().find(|line| line.contains(says)).unwrap().trim_end().len();
    assert_eq!(line("number  commit"), line("a label of many words"), "{shown}");
    std::fs::write(&second, "source = 1").unwrap();
    assert_fails(&tissuebench(&["report", &results, "--history", &history]), 2, "0002-");
    assert_fails(&tissuebench(&["history", "show", &history]), 2, "0002-");
}
