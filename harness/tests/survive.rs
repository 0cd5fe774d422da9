//! Studies that are killed or interrupted, or that run out of space, time or memory. Finished results are
//! kept, and the rest is reported.
#![cfg(target_os = "linux")]

mod common;

use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use common::{BLOCK, assert_fails, inside, tissuebench, write};
use records::{Record, RunSet, read_run};
use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_tissuebench");

/// Writes scenes of one block each with different stiffnesses, and the study of all of them.
fn study(dir: &TempDir, scenes: usize) -> String {
    let mut text = String::from("title = \"Blocks\"\n");
    for index in 0..scenes {
        write(
            dir,
            &format!("b{index}.toml"),
            &BLOCK.replace("young = \"20 kPa\"", &format!("young = \"{} kPa\"", 20 + index)),
        );
        text += &format!("[[run]]\nscene = \"b{index}.toml\"\n");
    }
    write(dir, "study.toml", &text)
}

/// [`BLOCK`] in explicit dynamics, which takes minutes: millions of steps of 1280 elements.
fn endless() -> String {
    BLOCK
        .replace("poisson = 0.3 }", "poisson = 0.3, density = \"1000 kg/m^3\" }")
        .replace("cells = [2, 2, 1]", "cells = [8, 8, 4]")
        .replace("law = \"linear\"", "law = \"neo-hookean\"")
        .replace(
            "method =",
            "procedure = { kind = \"explicit\", duration = \"3000 s\", steps = 2 }\nmethod =",
        )
}

fn results(out: &str) -> RunSet {
    read_run(Path::new(out)).unwrap()
}

/// Results that are bitwise equal in two runs of one study.
fn exact(out: &str) -> (Vec<(Record, u64)>, Vec<records::Check>, Vec<records::PlanEntry>) {
    let set = results(out);
    let rows = set.records.iter().filter(|r| !r.is_measured());
    (rows.map(|r| (r.clone(), r.value.to_bits())).collect(), set.checks, set.plans)
}

fn start(args: &[&str]) -> Child {
    let mut command = Command::new(PROGRAM);
    command.args(args).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until the condition holds, at most five minutes: the machine may be busy.
fn wait_until(so: impl Fn() -> bool) {
    let began = Instant::now();
    while !so() {
        assert!(began.elapsed() < Duration::from_secs(300), "it never was so");
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Stored results of single runs, by file.
fn stored(out: &str) -> BTreeMap<PathBuf, Vec<u8>> {
    let Ok(entries) = std::fs::read_dir(Path::new(out).join("tasks")) else { return BTreeMap::new() };
    let paths = entries.map(|entry| entry.unwrap().path());
    let results = paths.filter(|path| path.extension().is_some_and(|e| e == "json"));
    results.filter_map(|path| Some((path.clone(), std::fs::read(path).ok()?))).collect()
}

/// Exit code of a process, and its stderr.
fn end(child: Child) -> (Option<i32>, String) {
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

fn ends(args: &[&str], stdout: Stdio) -> (Option<i32>, String) {
    let child = Command::new(PROGRAM).args(args).stdout(stdout).stderr(Stdio::piped()).spawn().unwrap();
    end(child)
}

/// Processes whose command line names this folder.
fn processes_of(dir: &TempDir) -> Vec<String> {
    let name = dir.path().to_str().unwrap();
    let of = |entry: std::fs::DirEntry| std::fs::read(entry.path().join("cmdline")).ok();
    let lines = std::fs::read_dir("/proc").unwrap().filter_map(|entry| of(entry.ok()?));
    lines.map(|line| String::from_utf8_lossy(&line).into_owned()).filter(|line| line.contains(name)).collect()
}

/// Ids of the processes that a process has started.
fn experiments_of(parent: &Child) -> Vec<String> {
    let tasks = std::fs::read_dir(format!("/proc/{}/task", parent.id())).unwrap();
    let children = tasks.filter_map(|task| std::fs::read_to_string(task.ok()?.path().join("children")).ok());
    children.flat_map(|ids| ids.split_whitespace().map(String::from).collect::<Vec<_>>()).collect()
}

/// Processor time of a process in hundredths of a second: the 14th field of `/proc/ID/stat`, which counts
/// all its threads. The second field is the name in parentheses.
fn processor_ticks(id: &str) -> u64 {
    let stat = std::fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
    let after_name = stat.rsplit_once(") ").map_or("", |(_, rest)| rest);
    after_name.split(' ').nth(11).map_or(0, |ticks| ticks.parse().unwrap())
}

/// Reproducible pseudo-random numbers in [0, 1).
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Repeatedly kills and restarts one of two workers on a folder. Meanwhile finished results must neither
/// change nor disappear, and at the end all results must equal those of an undisturbed study.
fn survives(scenes: usize, kills: usize, options: &[&str]) {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, scenes);
    let out = inside(&dir, "out");
    let calm = inside(&dir, "calm");
    let began = Instant::now();
    assert_eq!(tissuebench(&[&["verify", &study, "--out", &calm], options].concat()).code, 0);
    let whole = began.elapsed().as_secs_f64();
    let args = [&["verify", &study, "--out", &out, "--join"], options].concat();
    let mut chance = Chance(20);
    let mut known = BTreeMap::new();
    let mut workers = [start(&args), start(&args)];
    let mut killed = 0;
    while killed < kills {
        // A finished study is started again with half of its results, so that there are runs to be killed.
        if let [Some(_), Some(_)] = workers.each_mut().map(|worker| worker.try_wait().unwrap()) {
            for worker in workers {
                assert_eq!(end(worker).0, Some(0));
            }
            known = stored(&out);
            assert_eq!(known.len(), scenes);
            assert!(exact(&out) == exact(&calm), "after {killed} kills");
            for path in known.keys().step_by(2) {
                std::fs::remove_file(path).unwrap();
            }
            known = stored(&out);
            workers = [start(&args), start(&args)];
        }
        std::thread::sleep(Duration::from_secs_f64(chance.next() * whole / 2.0));
        let which = &mut workers[usize::from(chance.next() < 0.5)];
        which.kill().unwrap();
        which.wait().unwrap();
        killed += 1;
        let now = stored(&out);
        for (path, bytes) in &known {
            // A second run would have other times.
            assert!(now.get(path) == Some(bytes), "{} after {killed} kills", path.display());
        }
        known = now;
        *which = start(&args);
    }
    for worker in workers {
        let (code, said) = end(worker);
        assert_eq!(code, Some(0), "{said}");
    }
    let now = stored(&out);
    assert!(known.iter().all(|(path, bytes)| now.get(path) == Some(bytes)) && now.len() == scenes);
    assert!(exact(&out) == exact(&calm));
    assert_eq!(tissuebench(&["report", &out]).code, 0);
    assert_eq!(processes_of(&dir), [""; 0]);
}

/// Two undisturbed workers: each takes from the store the results that the other made.
#[test]
fn two_workers_make_each_run_once() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 40);
    let out = inside(&dir, "out");
    let args = ["verify", &study, "--out", &out, "--join"];
    let workers = [start(&args), start(&args)];
    let made = workers.map(|worker| {
        let (code, said) = end(worker);
        assert_eq!(code, Some(0), "{said}");
        let stored =
            said.lines().find_map(|line| line.strip_suffix(" of 40 runs were taken from stored results"));
        40 - stored.map_or(0, |count| count.parse::<usize>().unwrap())
    });
    assert_eq!(made[0] + made[1], 40, "{made:?}");
}

#[test]
fn two_workers_survive_being_killed() {
    survives(24, 6, &[]);
}

#[test]
#[ignore = "takes minutes; cargo xtask nightly runs it"]
fn two_workers_survive_a_hundred_kills() {
    survives(60, 100, &[]);
    survives(60, 100, &["--isolate"]);
}

#[test]
fn results_of_a_killed_study_are_incomplete() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 3);
    let out = inside(&dir, "out");
    let verify = ["verify", &study, "--out", &out];
    assert_eq!(tissuebench(&verify).code, 0);
    let before = exact(&out);
    // The last scene never ends; the two others finish before.
    write(&dir, "b2.toml", &endless());
    let mut killed = start(&verify);
    let first = stored(&out);
    wait_until(|| stored(&out).iter().filter(|(path, bytes)| first.get(*path) != Some(bytes)).count() == 2);
    // No other process may use the folder in the meantime.
    let (code, said) = end(start(&verify));
    assert_eq!(code, Some(2));
    assert!(said.contains(&format!("{out} is in use by process {};", killed.id())), "{said}");
    killed.kill().unwrap();
    killed.wait().unwrap();
    for args in [vec!["report", &out], vec!["baseline", &out, "--accepted", &inside(&dir, "b"), "--accept"]] {
        let done = tissuebench(&args);
        assert_fails(&done, 5, &format!("{out} is incomplete: some results of study.toml are missing"));
    }
    write(&dir, "b2.toml", &BLOCK.replace("young = \"20 kPa\"", "young = \"22 kPa\""));
    assert_eq!(tissuebench(&[&verify[..], &["--resume"]].concat()).code, 0);
    assert!(exact(&out) == before);
}

#[test]
fn an_interrupt_ends_with_a_word_and_keeps_what_is_finished() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 2);
    let out = inside(&dir, "out");
    write(&dir, "b1.toml", &endless());
    for options in [&[][..], &["--isolate"]] {
        let child = start(&[&["verify", &study, "--out", &out, "--resume"], options].concat());
        wait_until(|| stored(&out).len() == 1);
        std::thread::sleep(Duration::from_millis(200));
        let id = child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
        let (code, said) = end(child);
        assert_eq!(code, Some(5), "{said}");
        assert!(said.contains("interrupted; ") && said.contains("the same command and --resume"), "{said}");
        wait_until(|| processes_of(&dir).is_empty());
    }
    assert_fails(&tissuebench(&["report", &out]), 5, "is incomplete");
    write(&dir, "b1.toml", BLOCK);
    assert_eq!(tissuebench(&["verify", &study, "--out", &out, "--resume"]).code, 0);
}

#[test]
fn stdout_that_takes_nothing_costs_no_results() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 2);
    let scene = inside(&dir, "b0.toml");
    for (index, args) in [vec!["verify", &study], vec!["run", &scene, "--format", "json"]].iter().enumerate()
    {
        let (full, closed) = (inside(&dir, &format!("full{index}")), inside(&dir, &format!("closed{index}")));
        let device = File::options().write(true).open("/dev/full").unwrap();
        let (code, said) = ends(&[&args[..], &["--out", &full]].concat(), device.into());
        assert_eq!(code, Some(5), "{said}");
        assert!(said.contains("stdout can't be written: No space left on device"), "{said}");
        // A reader that has closed the pipe is not an error.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let (code, said) = ends(&[&args[..], &["--out", &closed]].concat(), writer.into());
        assert_eq!(code, Some(0), "{said}");
        assert!(!said.contains("panicked"), "{said}");
        assert!(!results(&full).records.is_empty() && exact(&full) == exact(&closed));
    }
}

#[test]
fn results_that_cannot_be_written_are_5_and_the_folder_opens_afterwards() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 2);
    let out = inside(&dir, "out");
    assert_eq!(tissuebench(&["verify", &study, "--out", &out]).code, 0);
    let before = exact(&out);
    // A folder blocks the temporary file of the output.
    let partial = format!("{out}/records.csv.partial");
    std::fs::create_dir(&partial).unwrap();
    let done = tissuebench(&["verify", &study, "--out", &out]);
    assert_fails(&done, 5, &format!("{out}/records.csv can't be written: Is a directory"));
    assert_fails(&tissuebench(&["report", &out]), 5, "is incomplete");
    std::fs::remove_dir(&partial).unwrap();
    assert_eq!(tissuebench(&["verify", &study, "--out", &out, "--resume"]).code, 0);
    assert!(exact(&out) == before);
}

#[test]
fn memory_and_time_cost_one_run_alone() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 4);
    let out = inside(&dir, "out");
    write(&dir, "b1.toml", &endless());
    write(&dir, "b2.toml", &BLOCK.replace("cells = [2, 2, 1]", "cells = [40, 40, 40]"));
    let done = tissuebench(&[
        "verify",
        &study,
        "--out",
        &out,
        "--isolate",
        "--time-limit",
        "4 s",
        "--memory-limit",
        "60MB",
    ]);
    assert_eq!(done.code, 3, "{}", done.stderr);
    let set = results(&out);
    let failed: Vec<(&str, &str)> = set.failures.iter().map(|f| (&f.case[..], &f.reason[..])).collect();
    let [("b1", time), ("b2", memory)] = failed[..] else { panic!("{failed:?}") };
    assert!(time == "out of time: ended after 4 s (--time-limit)", "{time}");
    assert!(memory.starts_with("out of memory: memory allocation of "), "{memory}");
    assert!(memory.ends_with("within 60000000 bytes (--memory-limit)"), "{memory}");
    let whole = |case: &str| set.records.iter().any(|r| r.case == case && r.name() == "max-z");
    assert!(whole("b0") && whole("b3") && !whole("b1") && !whole("b2"));
    assert_eq!(processes_of(&dir), [""; 0]);
    // The results are the same as in one process.
    write(&dir, "b1.toml", BLOCK);
    write(&dir, "b2.toml", BLOCK);
    let (apart, together) = (inside(&dir, "apart"), inside(&dir, "together"));
    assert_eq!(tissuebench(&["verify", &study, "--out", &apart, "--isolate"]).code, 0);
    assert_eq!(tissuebench(&["verify", &study, "--out", &together]).code, 0);
    assert!(exact(&apart) == exact(&together));
}

#[test]
fn a_crash_costs_one_run_alone() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 3);
    let out = inside(&dir, "out");
    write(&dir, "b1.toml", &endless());
    let child = start(&["verify", &study, "--out", &out, "--isolate"]);
    // Only the second run computes for a second: the others take milliseconds.
    let endless = || experiments_of(&child).into_iter().find(|id| processor_ticks(id) >= 100);
    wait_until(|| endless().is_some());
    assert!(Command::new("kill").args(["-ABRT", &endless().unwrap()]).status().unwrap().success());
    let (code, said) = end(child);
    assert_eq!(code, Some(3), "{said}");
    assert!(said.contains("could not run: b1 tet4: crashed (signal: 6 (SIGABRT)"), "{said}");
    let cases: std::collections::BTreeSet<_> = results(&out).records.iter().map(|r| r.case.clone()).collect();
    assert_eq!(cases.into_iter().collect::<Vec<_>>(), ["b0", "b2"]);
}

#[test]
fn what_nobody_means_to_run_asks_for_force() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 1);
    let huge = |scene: &str| scene.replace("cells = [2, 2, 1]", "cells = [270, 270, 270]");
    let long = BLOCK.replace("method =", "procedure = { kind = \"static\", steps = 100000 }\nmethod =");
    let long = long.replace("\"linear\"", "\"neo-hookean\"").replace("cells = [2, 2, 1]", "level = 4");
    for (scene, place) in [(huge(BLOCK), "6: key 'method[0].size'"), (long, "6: key 'procedure.steps'")] {
        let path = write(&dir, "b0.toml", &scene);
        let out = inside(&dir, "out");
        for args in
            [vec!["run", &path, "--out", &out], vec!["plan", &path], vec!["verify", &study, "--out", &out]]
        {
            let done = tissuebench(&args);
            assert_fails(&done, 2, &format!("b0.toml:{place}"));
            assert!(done.stderr.contains("needs about "), "{}", done.stderr);
            assert!(done.stderr.contains("or give --force"), "{}", done.stderr);
        }
        assert!(!Path::new(&out).exists());
    }
    // With `--force`, the plan of many steps is made. It takes no longer than a plan of a few steps.
    let planned = tissuebench(&["plan", &inside(&dir, "b0.toml"), "--force"]);
    assert_eq!(planned.code, 0, "{}", planned.stderr);
}
