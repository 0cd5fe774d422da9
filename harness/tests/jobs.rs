//! Studies executed as jobs (`--on`): the same results as in one process, whatever happens to the jobs.
#![cfg(target_os = "linux")]

mod common;
mod fakes;

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use common::{BLOCK, Done, assert_fails, inside, tissuebench, write};
use records::{Record, read_run};
use serde_json::Value;
use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_tissuebench");

/// Writes scenes of one block each with different stiffnesses, and the study of all of them.
fn study(dir: &TempDir, scenes: usize) -> String {
    let mut text = String::from("title = \"Blocks\"\n");
    for index in 0..scenes {
        let young = format!("young = \"{} kPa\"", 20 + index);
        write(dir, &format!("b{index}.toml"), &BLOCK.replace("young = \"20 kPa\"", &young));
        text += &format!("[[run]]\nscene = \"b{index}.toml\"\n");
    }
    write(dir, "study.toml", &text)
}

/// [`BLOCK`] in explicit dynamics, which takes minutes.
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

/// Results that are bitwise equal in two runs of one study.
fn exact(out: &str) -> impl PartialEq + use<> {
    let set = read_run(Path::new(out)).unwrap();
    let rows: Vec<(Record, u64)> = set
        .records
        .iter()
        .filter(|record| !record.is_measured())
        .map(|record| (record.clone(), record.value.to_bits()))
        .collect();
    (rows, set.checks, set.plans, set.fields)
}

/// Starts the program with further programs in front of the search path, where they have this many places.
fn start(args: &[&str], programs: Option<(&Path, usize)>) -> Child {
    let mut command = Command::new(PROGRAM);
    command.args(args).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    if let Some((programs, room)) = programs {
        command.env("PATH", fakes::path(programs)).env(fakes::ROOM, room.to_string());
    }
    command.spawn().unwrap()
}

fn end(child: Child) -> Done {
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    Done { code: output.status.code().unwrap(), stdout: String::new(), stderr }
}

/// Waits until the condition holds, at most a minute.
fn wait_until(so: impl Fn() -> bool) {
    let began = Instant::now();
    while !so() {
        assert!(began.elapsed() < Duration::from_secs(60), "it never was so");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Ids of the processes of jobs of a folder.
fn workers(dir: &TempDir) -> Vec<String> {
    let folder = format!("{}/out/jobs/", dir.path().display());
    let processes = std::fs::read_dir("/proc").unwrap().flatten();
    let ids = processes.filter_map(|entry| entry.file_name().into_string().ok());
    let line = |id: &String| std::fs::read(format!("/proc/{id}/cmdline")).unwrap_or_default();
    let is_job = |line: &str| line.contains(&folder) && line.contains("\0job\0");
    ids.filter(|id| is_job(&String::from_utf8_lossy(&line(id)))).collect()
}

fn kill(signal: &str, ids: &[String]) {
    assert!(Command::new("kill").arg(signal).args(ids).status().unwrap().success());
}

/// Events of all jobs.
fn events(dir: &TempDir) -> Vec<Value> {
    let jobs = std::fs::read_dir(dir.path().join("out/jobs")).into_iter().flatten().flatten();
    let files = jobs.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|e| e == "events"));
    let text: String = files.map(|path| std::fs::read_to_string(path).unwrap_or_default()).collect();
    text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
}

fn started(dir: &TempDir, case: &str) -> usize {
    events(dir).iter().filter(|event| event["event"] == "start" && event["case"] == case).count()
}

/// Undisturbed: each run is executed once, by several jobs, with the results of one process.
#[test]
fn each_system_makes_each_run_once_with_the_same_results() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 30);
    let (out, calm) = (inside(&dir, "out"), inside(&dir, "calm"));
    assert_eq!(tissuebench(&["verify", &study, "--out", &calm]).code, 0);
    let slurm = fakes::slurm(&dir);
    for (system, programs) in [("local:3", None), ("slurm:jobs=3,partition=short", Some((&*slurm, 3)))] {
        let args = ["verify", &study, "--out", &out, "--on", system, "--job-time", "0.05 s"];
        let done = end(start(&args, programs));
        assert_eq!(done.code, 0, "{system}: {}", done.stderr);
        assert!(exact(&out) == exact(&calm), "{system}");
        let made =
            events(&dir).iter().filter(|event| event["event"] == "done" && event["stored"] == false).count();
        assert_eq!(made, 30, "{system}");
        let jobs = std::fs::read_dir(dir.path().join("out/jobs")).unwrap().flatten();
        let jobs = jobs.filter(|entry| entry.path().extension().is_some_and(|e| e == "json")).count();
        assert!((2..=15).contains(&jobs), "{system}: {jobs} jobs for 30 runs");
        let status = tissuebench(&["status", &out]);
        assert_eq!(status.code, 0);
        assert_eq!(status.stdout, "30 of 30 runs done, 0 running, 0 failed; about 0 s left\n");
        // Stored results are kept.
        let again = end(start(&args, programs));
        assert!(again.code == 0 && again.stderr.contains("30 of 30 runs were taken"), "{}", again.stderr);
        std::fs::remove_dir_all(&out).unwrap();
    }
}

/// A killed job costs nothing: the run that it executed is repeated in another job.
#[test]
fn the_runs_of_a_killed_job_are_repeated() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 6);
    let (out, calm) = (inside(&dir, "out"), inside(&dir, "calm"));
    assert_eq!(tissuebench(&["verify", &study, "--out", &calm]).code, 0);
    let slurm = fakes::slurm(&dir);
    for (system, programs) in [("local:1", None), ("slurm:jobs=1", Some((&*slurm, 1)))] {
        let child = start(&["verify", &study, "--out", &out, "--on", system], programs);
        wait_until(|| !workers(&dir).is_empty());
        kill("-9", &workers(&dir));
        let done = end(child);
        assert_eq!(done.code, 0, "{system}: {}", done.stderr);
        assert!(done.stderr.contains("warning: job 1 ended: "), "{system}: {}", done.stderr);
        assert!(exact(&out) == exact(&calm), "{system}");
        std::fs::remove_dir_all(&out).unwrap();
    }
}

/// A run that crashes each time is reported after its last retry, and costs no other run.
#[test]
fn a_run_that_crashes_each_time_is_reported() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 4);
    let out = inside(&dir, "out");
    write(&dir, "b1.toml", &endless());
    let child = start(&["verify", &study, "--out", &out, "--on", "local:2", "--retries", "1"], None);
    for attempt in 1..=2 {
        wait_until(|| started(&dir, "b1") == attempt);
        let status = tissuebench(&["status", &out]);
        assert_eq!(status.code, 5, "{}", status.stderr);
        assert!(
            status.stdout.contains("running:\n") && status.stdout.contains("  b1 tet4\n"),
            "{}",
            status.stdout
        );
        wait_until(|| events(&dir).iter().filter(|event| event["event"] == "done").count() >= 2);
        kill("-9", &workers(&dir));
    }
    let done = end(child);
    assert_eq!(done.code, 3, "{}", done.stderr);
    let why = "could not run: b1 tet4: gave no result in 2 jobs: job ";
    assert!(done.stderr.contains(why) && done.stderr.contains("signal: 9 (SIGKILL)"), "{}", done.stderr);
    let set = read_run(Path::new(&out)).unwrap();
    let cases: std::collections::BTreeSet<_> = set.records.iter().map(|record| &*record.case).collect();
    assert_eq!(cases.into_iter().collect::<Vec<_>>(), ["b0", "b2", "b3"]);
    let status = tissuebench(&["status", &out]);
    assert!(status.stdout.starts_with("4 of 4 runs done, 0 running, 1 failed"), "{}", status.stdout);
    // The failed run is repeated by the same command, and the others are kept.
    write(&dir, "b1.toml", BLOCK);
    let again = tissuebench(&["verify", &study, "--out", &out, "--on", "local:2"]);
    assert!(again.code == 0 && again.stderr.contains("3 of 4 runs were taken"), "{}", again.stderr);
}

#[test]
fn a_job_that_exceeds_its_time_is_ended() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 2);
    let out = inside(&dir, "out");
    write(&dir, "b1.toml", &endless());
    // The estimate of the run is replaced by the stored time of a block.
    let options =
        ["--on", "local:1", "--job-time", "1 s", "--retries", "0", "--isolate", "--time-limit", "2 s"];
    let done = tissuebench(&[&["verify", &study, "--out", &out], &options[..]].concat());
    assert_fails(&done, 3, "could not run: b1 tet4: out of time: ended after 2 s (--time-limit)");
    assert!(workers(&dir).is_empty());
}

/// Ctrl-C cancels all jobs, also those that have not started.
#[test]
fn an_interrupt_cancels_the_jobs() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 3);
    let out = inside(&dir, "out");
    write(&dir, "b1.toml", &endless());
    write(&dir, "b2.toml", &endless());
    let slurm = fakes::slurm(&dir);
    for (system, programs, room) in [("local:2", None, 2), ("slurm:jobs=2", Some(&*slurm), 1)] {
        let args = ["verify", &study, "--out", &out, "--on", system, "--job-time", "0.1 s"];
        let child = start(&args, programs.map(|programs| (programs, room)));
        wait_until(|| started(&dir, "b1") + started(&dir, "b2") == room);
        kill("-INT", &[child.id().to_string()]);
        let done = end(child);
        assert_fails(&done, 5, "interrupted; 2 jobs are cancelled");
        wait_until(|| workers(&dir).is_empty());
        // A job of the small programs records its end a moment after its processes are gone.
        let is_over = |state: &String| !state.starts_with("RUNNING") && !state.starts_with("PENDING");
        wait_until(|| states(&slurm).iter().all(is_over));
        assert_fails(&tissuebench(&["report", &out]), 5, "is incomplete");
        std::fs::remove_dir_all(&out).unwrap();
    }
}

/// States of the jobs of the small programs.
fn states(programs: &Path) -> Vec<String> {
    let files = std::fs::read_dir(programs).unwrap().flatten().map(|entry| entry.path());
    let states = files.filter(|path: &PathBuf| path.extension().is_some_and(|e| e == "state"));
    states.map(|path| std::fs::read_to_string(path).unwrap()).collect()
}

/// A queue without room: the line of progress names the reason, and an interrupt cancels the job.
#[test]
fn a_job_that_never_starts_is_reported_with_the_reason() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 2);
    let out = inside(&dir, "out");
    let slurm = fakes::slurm(&dir);
    let mut child = start(&["verify", &study, "--out", &out, "--on", "slurm"], Some((&slurm, 0)));
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
    let line = lines.find(|line| line.starts_with("0 of 2 runs in ")).unwrap();
    assert!(line.contains(" s, 0 failed; 0 jobs running, 1 waiting: Resources; about "), "{line}");
    kill("-INT", &[child.id().to_string()]);
    assert!(lines.any(|line| line.contains("interrupted; 1 jobs are cancelled")));
    assert_eq!(child.wait().unwrap().code(), Some(5));
    wait_until(|| states(&slurm) == ["CANCELLED|None"]);
}

#[test]
fn a_refusal_is_reported_and_bad_options_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let study = study(&dir, 1);
    let slurm = fakes::slurm(&dir);
    let verify = |out: &str, on: &str, options: &[&str]| {
        let out = inside(&dir, out);
        let args = [&["verify", &study, "--out", &out, "--on", on], options].concat();
        end(start(&args, Some((&slurm, 1))))
    };
    let refused = verify("out", "slurm:partition=none", &[]);
    assert_fails(&refused, 3, "--on slurm:jobs=16,partition=none: sbatch: ");
    assert!(refused.stderr.contains("invalid partition specified: none"), "{}", refused.stderr);
    for (on, options, says) in [
        ("cloud", &[][..], "no system 'cloud'; write local:8"),
        ("local", &[], "needs a number of jobs"),
        ("slurm:mem=1G", &[], "mem is set for each job"),
        ("local:2", &["--join"], "cannot be used with"),
        ("local:2", &["--job-time", "soon"], "--job-time"),
    ] {
        assert_fails(&verify("bad", on, options), 2, says);
    }
    assert_fails(&tissuebench(&["verify", &study, "--retries", "1"]), 2, "--on");
    let missing = Command::new(PROGRAM)
        .args(["verify", &study, "--out", &inside(&dir, "bad"), "--on", "slurm"])
        .env("PATH", dir.path())
        .output()
        .unwrap();
    let said = String::from_utf8(missing.stderr).unwrap();
    assert!(missing.status.code() == Some(3) && said.contains("sbatch is not on PATH"), "{said}");
    assert!(!Path::new(&inside(&dir, "bad")).exists());
    assert_fails(&tissuebench(&["status", &inside(&dir, "none")]), 2, "study.json");
}
