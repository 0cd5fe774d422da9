//! Output of the built program that continuous integration and shells read.

mod common;

use common::{BLOCK, Done, assert_fails, inside, tissuebench, write};
use serde_json::Value;
use tempfile::TempDir;

/// A study of two scenes. In the second run one check holds, one check fails, and one method cannot run.
fn study(dir: &TempDir) -> String {
    let free = BLOCK.replace("support =", "# support =");
    write(dir, "block.toml", BLOCK);
    write(dir, "free.toml", &free);
    let two = BLOCK.replace(
        "method = [",
        "method = [{ id = \"hex8\", family = \"fem\", element = \"hex8\", size = { cells = [2, 2, 1] } }, ",
    );
    write(dir, "two.toml", &two);
    let text = r#"title = "Three scenes"
[[run]]
scene = "block.toml"
levels = [1, 2]
tags = ["nightly"]
[[run]]
scene = "two.toml"
quick = true
check = [{ metric = "max-z", at_least = "1 um" }, { metric = "max-z", method = "hex8", at_most = "1 um" }]
[[run]]
scene = "free.toml"
"#;
    write(dir, "study.toml", text)
}

fn listed(study: &str, options: &[&str]) -> Vec<String> {
    let done = tissuebench(&[&["verify", study, "--list"], options].concat());
    assert_eq!(done.code, 0, "{}", done.stderr);
    done.stdout.lines().map(Into::into).collect()
}

#[test]
fn runs_are_chosen_by_case_method_and_tag() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir);
    let all = ["block tet4 level 1", "block tet4 level 2", "two hex8", "two tet4", "free tet4"];
    assert_eq!(listed(&study, &[]), all);
    assert_eq!(listed(&study, &["--case", "two"]), all[2..4]);
    assert_eq!(listed(&study, &["--case", "two", "--case", "f*"]), all[2..]);
    assert_eq!(listed(&study, &["--method", "hex*"]), all[2..3]);
    assert_eq!(listed(&study, &["--tag", "nightly"]), all[..2]);
    assert_eq!(listed(&study, &["--tag", "quick", "--not", "hex"]), all[3..4]);
    assert_eq!(listed(&study, &["--tag", "linear", "--not", "nightly", "--not", "free"]), all[2..4]);
    assert_fails(&tissuebench(&["verify", &study, "--case", "none"]), 4, "nothing ran");
    let forecast = tissuebench(&["verify", &study, "--dry-run", "--case", "block"]);
    assert_eq!(forecast.code, 0, "{}", forecast.stderr);
    let lines: Vec<&str> = forecast.stdout.lines().collect();
    assert_eq!(lines.len(), 4, "{lines:?}");
    assert!(
        lines[0].contains("nodes") && lines[0].contains("seconds") && lines[3].starts_with("2 runs, about")
    );
    assert!(!dir.path().join("results").exists());
}

#[test]
fn stored_times_are_what_runs_are_foreseen_to_take() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir);
    let out = inside(&dir, "out");
    assert_eq!(tissuebench(&["verify", &study, "--case", "two", "--quiet", "--out", &out]).code, 1);
    // Stores a time that no estimate would give.
    for entry in std::fs::read_dir(dir.path().join("out/tasks")).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let (_, rest) = text.split_once(',').unwrap();
        let (before, after) = rest.split_once("\"seconds\":").unwrap();
        let end = after.find([',', '}']).unwrap();
        let rest = format!("{before}\"seconds\":700.0{}", &after[end..]);
        // The hash must match, and includes the key.
        let mut hasher = blake3::Hasher::new();
        hasher.update(path.file_stem().unwrap().as_encoded_bytes()).update(rest.as_bytes());
        std::fs::write(&path, format!("{{\"hash\":\"{}\",{rest}", hasher.finalize().to_hex())).unwrap();
    }
    let seconds = |options: &[&str]| {
        let done = tissuebench(
            &[&["verify", &study, "--dry-run", "--case", "block", "--case", "two"], options].concat(),
        );
        assert_eq!(done.code, 0, "{}", done.stderr);
        let of_line = |line: &str| line.split_whitespace().rev().nth(3).unwrap().parse::<f64>().unwrap();
        let lines: Vec<&str> = done.stdout.lines().skip(1).take(4).collect();
        (lines.iter().map(|line| of_line(line)).collect::<Vec<_>>(), done.stderr)
    };
    let (estimated, _) = seconds(&[]);
    let (learned, said) = seconds(&["--times", &out]);
    assert!(said.contains("2 of 4 runs have times in "), "{said}");
    assert_eq!(learned[2..], [700.0, 700.0]);
    // The expected times of the other runs are scaled by the same ratio.
    assert!(estimated[0] < 1.0 && learned[0] > 100.0, "{estimated:?} {learned:?}");
    let nothing = tissuebench(&["verify", &study, "--dry-run", "--times", &inside(&dir, "nothing")]);
    assert_fails(&nothing, 2, "has no stored runs");
}

#[test]
fn what_failed_is_in_junit_annotations_and_events() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir);
    let out = inside(&dir, "out");
    let (junit, events) = (inside(&dir, "junit.xml"), inside(&dir, "events.jsonl"));
    let options = ["--junit", &junit, "--annotations", "--events", &events, "--quiet", "--out", &out];
    let done = tissuebench(&[&["verify", &study], &options[..]].concat());
    assert_eq!(done.code, 1, "{}", done.stderr);
    // With `--quiet`, stdout contains only the requested output.
    let annotations: Vec<&str> = done.stdout.lines().collect();
    assert_eq!(annotations.len(), 2, "{annotations:?}");
    assert!(annotations[0].starts_with("::error file=") && annotations[0].contains(",title=two hex8"));
    assert!(annotations[1].contains("free.toml") && annotations[1].contains("support"), "{}", annotations[1]);
    assert!(annotations.iter().all(|line| line.contains(".toml,line=")), "{annotations:?}");
    let text = std::fs::read_to_string(&junit).unwrap();
    assert!(
        text.contains("<testsuites name=") && text.contains("tests=\"5\" failures=\"1\" errors=\"1\""),
        "{text}"
    );
    assert!(text.contains("<failure type=\"max-z\"") && text.contains("<error message="), "{text}");
    let text = std::fs::read_to_string(&events).unwrap();
    let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let named = |name: &str| lines.iter().filter(|line| line["event"] == name).count();
    assert_eq!(
        (named("begin"), named("start"), named("done"), named("failed"), named("end")),
        (1, 5, 4, 1, 1)
    );
    let end = lines.last().unwrap();
    assert_eq!((&end["passed"], &end["failed"], &end["code"]), (&2.into(), &1.into(), &1.into()));
    assert!(lines.iter().all(|line| line["at"].is_number()));
    assert_fails(&tissuebench(&["verify", &study, "--events", &inside(&dir, "no/file")]), 2, "--events");
}

#[test]
fn a_verbose_run_says_what_each_took() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir);
    let out = inside(&dir, "out");
    let done = tissuebench(&["verify", &study, "--case", "block", "--verbose", "--out", &out]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let said =
        done.stderr.lines().filter(|line| line.starts_with("block tet4: ") && line.ends_with(" s")).count();
    assert_eq!(said, 2, "{}", done.stderr);
}

#[test]
fn colours_are_for_terminals_unless_they_are_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir);
    let out = inside(&dir, "out");
    let run = |options: &[&str]| {
        let all = ["verify", &study, "--case", "two", "--out", &out];
        tissuebench(&[&all[..], options].concat())
    };
    let coloured = |done: Done| done.stderr.contains("\u{1b}[");
    assert!(!coloured(run(&[])) && !coloured(run(&["--color", "never"])));
    assert!(coloured(run(&["--color", "always"])));
}

#[test]
fn results_are_compared_with_others_of_the_study() {
    let dir = tempfile::tempdir().unwrap();
    let scene = write(&dir, "block.toml", BLOCK);
    let [a, b, c] = ["a", "b", "c"].map(|name| inside(&dir, name));
    for out in [&a, &b] {
        assert_eq!(tissuebench(&["run", &scene, "--out", out]).code, 0);
    }
    let same = tissuebench(&["compare", &a, &b]);
    assert_eq!(same.code, 0, "{}{}", same.stdout, same.stderr);
    assert!(
        same.stdout.contains("0 changed") && same.stdout.contains("too few to compare"),
        "{}",
        same.stdout
    );
    write(&dir, "block.toml", &BLOCK.replace("1 kPa", "1.01 kPa"));
    assert_eq!(tissuebench(&["run", &scene, "--out", &c]).code, 0);
    let other = tissuebench(&["compare", &a, &c, "--format", "json"]);
    assert_eq!(other.code, 1, "{}", other.stderr);
    let found: Value = serde_json::from_str(&other.stdout).unwrap();
    let changes = found["numbers"]["changes"].as_array().unwrap();
    let named = |change: &&Value| change["quantity"] == "max-z [m]";
    let change = changes.iter().find(named).expect("the displacement has changed");
    assert!((change["relative"].as_f64().unwrap() - 0.01 / 1.01).abs() < 1e-9, "{change}");
    assert_eq!(tissuebench(&["compare", &a, &c, "--tolerance", "0.05", "--no-times"]).code, 0);
    assert_fails(&tissuebench(&["compare", &a, &inside(&dir, "none")]), 2, "none");
    assert_fails(&tissuebench(&["compare", &a, &b, &c]), 2, "before and after in turn");
    assert_fails(&tissuebench(&["compare", &a, &b, "--tolerance", "2"]), 2, "is not a relative difference");
}

#[test]
fn shells_complete_and_man_shows() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let done = tissuebench(&["completions", shell]);
        assert!(done.code == 0 && done.stdout.contains("verify"), "{shell}");
    }
    let page = tissuebench(&["man"]);
    assert!(page.code == 0 && page.stdout.contains(".TH tissuebench") && page.stdout.contains("verify"));
    let page = tissuebench(&["man", "verify"]);
    assert!(page.code == 0 && page.stdout.contains("junit"), "{}", page.stdout);
    assert_fails(&tissuebench(&["man", "verfy"]), 2, "did you mean 'verify'?");
}
