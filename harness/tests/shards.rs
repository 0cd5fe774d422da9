//! Studies in shares: of equal cost, and merged to the results of a single run.

mod common;

use std::collections::BTreeSet;
use std::path::Path;

use common::{assert_fails, cases, inside, tissuebench, write};
use records::{Record, RunSet, read_run};
use tempfile::TempDir;

/// A study with levels whose orders are checked, clouds of many seeds, and runs that two tables request.
fn study(dir: &TempDir) -> String {
    let (bending, first) = (cases("pure-bending.toml"), cases("first.toml"));
    let text = format!(
        r#"title = "Levels and seeds"

[[run]]
scene = '{bending}'
methods = ["tet10", "hex8-mean", "efg-gauss"]
levels = [1, 2]
poisson = [0.3, 0.495]

[[run.check]]
metric = "order-l2"
method = "hex8-mean"
at_least = 0.5

[[run]]
scene = '{bending}'
methods = ["hex8-mean"]
levels = [2]

[[run]]
scene = '{first}'
methods = ["efg"]
seeds = 3

[[run]]
scene = '{first}'
"#
    );
    write(dir, "study.toml", &text)
}

/// Results that are bitwise equal in two runs of one study.
fn exact(set: &RunSet) -> impl PartialEq + use<> {
    let rows = set.records.iter().filter(|r| !r.is_measured());
    let rows: Vec<(Record, u64)> = rows.map(|r| (r.clone(), r.value.to_bits())).collect();
    (rows, set.checks.clone(), set.plans.clone(), set.fields.clone(), set.provenance.scenes.clone())
}

fn results(out: &str) -> RunSet {
    read_run(Path::new(out)).unwrap()
}

fn runs(set: &RunSet) -> BTreeSet<String> {
    set.records.iter().map(|r| r.run.clone()).collect()
}

#[test]
fn shares_are_joined_to_the_results_of_one_run() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir);
    let whole = inside(&dir, "whole");
    let done = tissuebench(&["verify", &study, "--out", &whole]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let whole = results(&whole);
    let mut shares = Vec::new();
    let mut together = BTreeSet::new();
    for k in 1..=3 {
        let out = inside(&dir, &format!("share{k}"));
        // The third share appears to come from another machine, because it has other threads.
        let shard = format!("{k}/3");
        let threads = if k == 3 { "2" } else { "1" };
        let done = tissuebench(&["verify", &study, "--shard", &shard, "--threads", threads, "--out", &out]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let runs = runs(&results(&out));
        assert!(!runs.is_empty() && runs.is_disjoint(&together), "each run is in one share");
        together.extend(runs);
        shares.push(out);
    }
    assert!(together == runs(&whole));
    let out = inside(&dir, "merged");
    let merge = |shares: &[&str]| tissuebench(&[&["merge", &out], shares].concat());
    let [one, two, three] = [&shares[0][..], &shares[1], &shares[2]];
    // Without one of the shares, the result is incomplete and names the missing runs.
    let part = merge(&[one, three]);
    assert_fails(&part, 5, "runs are missing from the shares");
    assert!(part.stderr.contains("missing: "), "{}", part.stderr);
    assert_fails(&tissuebench(&["report", &out]), 5, "is incomplete");
    let done = merge(&[three, one, two]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(done.stderr.contains("the times come from 2 kinds of machines"), "{}", done.stderr);
    assert!(exact(&results(&out)) == exact(&whole));
    // The merged runs are stored like those of a single run.
    assert_eq!(tissuebench(&["verify", &study, "--resume", "--out", &out]).code, 0);
    let (again, joined) = (results(&out), results(&out));
    assert!(again.records == joined.records);
}

/// The most expensive run is assigned first. The others fill the other share, whatever their order in the
/// study.
#[test]
fn the_costliest_run_has_a_share_of_its_own() {
    let dir = tempfile::tempdir().unwrap();
    let scene = cases("pure-bending.toml");
    let run = |method: &str, level: u32| {
        format!("[[run]]\nscene = '{scene}'\nmethods = [\"{method}\"]\nlevels = [{level}]\n")
    };
    let runs = [run("hex8-mean", 1), run("tet4", 2), run("hex8", 4), run("tet10", 1)].concat();
    let study = write(&dir, "study.toml", &format!("title = \"Costs\"\n{runs}"));
    let share = |k: &str| {
        let listed = tissuebench(&["verify", &study, "--shard", k, "--list"]).stdout;
        listed.lines().filter(|line| line.contains("pure-bending")).map(String::from).collect::<Vec<_>>()
    };
    let (one, two) = (share("1/2"), share("2/2"));
    assert!(one.len() == 1 && one[0].contains("hex8 level 4") && two.len() == 3, "{one:?} {two:?}");
}

#[test]
fn what_is_no_share_is_not_joined() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir);
    let out = inside(&dir, "out");
    let share = |name: &str, options: &[&str]| {
        let out = inside(&dir, name);
        assert_eq!(tissuebench(&[&["verify", &study, "--out", &out], options].concat()).code, 0);
        out
    };
    let (tet, hex) = (share("tet", &["--filter", "tet10"]), share("hex", &["--filter", "hex8"]));
    assert_fails(&tissuebench(&["merge", &out, &tet, &hex]), 2, "belong to different studies or selections");
    let nothing = inside(&dir, "nothing");
    assert_fails(&tissuebench(&["merge", &out, &tet, &nothing]), 2, "give folders written by");
    assert!(!Path::new(&out).exists());
}

/// A script of the book, by the name in its first line.
#[cfg(unix)]
fn script(name: &str) -> String {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/src/guide/long-studies.md");
    let text = std::fs::read_to_string(page).unwrap();
    let from = text.find(&format!("# {name}: ")).expect("a script of that name");
    text[from..].split("```").next().unwrap().into()
}

/// Two workers by `xargs -P 2`, as in the book, compared with a single run.
#[cfg(unix)]
#[test]
fn the_scripts_of_the_book_give_the_results_of_one_run() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir);
    let whole = inside(&dir, "whole");
    let done = tissuebench(&["verify", &study, "--out", &whole]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let program = Path::new(env!("CARGO_BIN_EXE_tissuebench")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    for name in ["two-workers.sh", "shards.sh"] {
        let mut bash = std::process::Command::new("bash");
        bash.args(["-e", "-c", &script(name)]).env("PATH", &path).current_dir(dir.path());
        let output = bash.output().unwrap();
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        let results = inside(&dir, "results");
        assert!(exact(&self::results(&results)) == exact(&self::results(&whole)), "{name}");
        std::fs::remove_dir_all(results).unwrap();
    }
}
