//! Conformance of executors: the same list of properties for each system that runs jobs. Clusters are
//! represented by small programs on the search path, and by the real ones if they are installed.
#![cfg(target_os = "linux")]

mod common;
mod fakes;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use tempfile::TempDir;
use tissuebench_harness::executor::{End, Executor, Job, Site, State, open};

/// Environment variable with the system that [`each_property`] tests.
const SYSTEM: &str = "TISSUEBENCH_TESTED_SYSTEM";

/// An executor with a folder for its jobs.
struct Bench {
    executor: Box<dyn Executor>,
    dir: TempDir,
    count: usize,
}

impl Bench {
    fn new() -> Bench {
        let site: Site = std::env::var(SYSTEM).unwrap().parse().unwrap();
        Bench { executor: open(&site).unwrap(), dir: tempfile::tempdir().unwrap(), count: 0 }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    /// A job of a script, with an hour of time.
    fn job(&mut self, script: &str) -> Job {
        self.count += 1;
        Job {
            name: format!("job-{}", self.count),
            command: ["sh", "-c", script].map(Into::into).to_vec(),
            log: self.path(&format!("{}.log", self.count)),
            threads: 1,
            memory: 1 << 20,
            time: Duration::from_secs(3600),
            notice: Duration::from_secs(2),
        }
    }

    fn submit(&mut self, script: &str) -> String {
        let job = self.job(script);
        self.executor.submit(&job).unwrap()
    }

    fn state(&mut self, id: &str) -> State {
        self.executor.poll(&[id.into()]).unwrap().remove(0)
    }

    /// Waits for the end of a job.
    fn end(&mut self, id: &str) -> End {
        let began = Instant::now();
        loop {
            if let State::Ended(end) = self.state(id) {
                return end;
            }
            assert!(began.elapsed() < Duration::from_secs(200), "job {id} never ended");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Waits for a file with a line, and returns the line.
    fn line(&self, name: &str) -> String {
        let began = Instant::now();
        loop {
            let text = std::fs::read_to_string(self.path(name)).unwrap_or_default();
            if let Some((line, _)) = text.split_once('\n') {
                return line.into();
            }
            assert!(began.elapsed() < Duration::from_secs(60), "no {name}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }
}

fn is_failed(end: &End) -> bool {
    matches!(end, End::Failed(_))
}

/// Waits until a process is gone.
fn assert_gone(id: &str) {
    let state = || std::fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
    let began = Instant::now();
    while state().rsplit_once(')').is_some_and(|(_, state)| !state.trim_start().starts_with(['Z', 'X'])) {
        assert!(began.elapsed() < Duration::from_secs(20), "process {id} still runs");
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn ends_are_reported_and_output_is_kept() {
    let mut bench = Bench::new();
    let ids = ["echo said", "echo wrong >&2; exit 3", "kill -9 $$"].map(|script| bench.submit(script));
    let ends = ids.each_ref().map(|id| bench.end(id));
    assert_eq!(ends[0], End::Done);
    assert!(is_failed(&ends[1]) && is_failed(&ends[2]), "{ends:?}");
    assert_eq!([bench.line("1.log"), bench.line("2.log")], ["said", "wrong"]);
    // An end is reported again, and cancelling an ended job changes nothing.
    bench.executor.cancel(&ids).unwrap();
    assert_eq!(bench.executor.poll(&ids).unwrap(), ends.map(State::Ended));
}

fn a_program_gets_its_words_and_its_folder() {
    let mut bench = Bench::new();
    let mut job = bench.job("pwd; printf '%s\\n' \"$@\"");
    let words = ["a b", "it's", "$HOME", "`id`", "\"q\"", "--flag", "%j", "\\n", "*"];
    job.command.push("sh".into());
    job.command.extend(words.map(Into::into));
    job.log = bench.path("with space 100%.log");
    let id = bench.executor.submit(&job).unwrap();
    assert_eq!(bench.end(&id), End::Done);
    let said = std::fs::read_to_string(&job.log).unwrap();
    let here = std::env::current_dir().unwrap();
    let expected: Vec<&str> = std::iter::once(here.to_str().unwrap()).chain(words).collect();
    assert_eq!(said.lines().collect::<Vec<_>>(), expected);
}

fn a_program_that_is_not_there_fails_its_job() {
    let mut bench = Bench::new();
    let mut job = bench.job("");
    job.command = vec!["/no/such/program".into()];
    if let Ok(id) = bench.executor.submit(&job) {
        let end = bench.end(&id);
        assert!(is_failed(&end), "{end:?}");
    }
}

/// The program itself receives the signal TERM, has some time to write its results, and leaves no process.
fn a_late_job_is_warned_and_ended() {
    let mut bench = Bench::new();
    let (own, child) = (bench.path("warned"), bench.path("child"));
    let (own, child) = (own.display(), child.display());
    let waits = format!("trap 'echo TERM > {own}' TERM; sleep 1000 & echo $! > {child}; wait; sleep 1000");
    let job = Job { time: Duration::from_secs(1), ..bench.job(&waits) };
    let id = bench.executor.submit(&job).unwrap();
    // Slurm reports a program that ends by itself at the signal as failed.
    assert_ne!(bench.end(&id), End::Done);
    assert_eq!(bench.line("warned"), "TERM");
    assert_gone(&bench.line("child"));
}

fn a_cancelled_job_ends_with_all_its_processes() {
    let mut bench = Bench::new();
    let child = bench.path("child");
    let script = format!("(trap '' TERM; sleep 1000) & echo $! > {}; wait", child.display());
    let id = bench.submit(&script);
    let child = bench.line("child");
    assert_eq!(bench.state(&id), State::Running);
    bench.executor.cancel(std::slice::from_ref(&id)).unwrap();
    let end = bench.end(&id);
    assert!(is_failed(&end), "{end:?}");
    assert_gone(&child);
}

/// The tested systems have room for two jobs.
fn a_job_without_room_waits_and_can_be_cancelled() {
    let mut bench = Bench::new();
    let marker = bench.path("started");
    let ids: Vec<String> = (0..2).map(|_| bench.submit("exec sleep 1000")).collect();
    let third = bench.submit(&format!("touch {}", marker.display()));
    let fourth = bench.submit("echo after");
    let began = Instant::now();
    while began.elapsed() < Duration::from_millis(500) {
        assert!(matches!(bench.state(&third), State::Waiting(_)), "{:?}", bench.state(&third));
    }
    bench.executor.cancel(&[third.clone(), ids[0].clone()]).unwrap();
    assert!(is_failed(&bench.end(&third)) && is_failed(&bench.end(&ids[0])));
    assert_eq!(bench.end(&fourth), End::Done);
    assert!(!marker.exists(), "a cancelled job has started");
    bench.executor.cancel(&ids[1..]).unwrap();
    assert!(is_failed(&bench.end(&ids[1])));
}

/// Runs in a process of its own, whose environment names the system.
#[test]
#[ignore = "run by the tests of the systems"]
fn each_property() {
    ends_are_reported_and_output_is_kept();
    a_program_gets_its_words_and_its_folder();
    a_program_that_is_not_there_fails_its_job();
    a_cancelled_job_ends_with_all_its_processes();
    a_job_without_room_waits_and_can_be_cancelled();
    a_late_job_is_warned_and_ended();
}

/// Tests all properties of a system, with further programs in front of the search path.
fn conforms(system: &str, programs: Option<&Path>) {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--ignored", "--exact", "each_property"]).env(SYSTEM, system);
    if let Some(programs) = programs {
        command.env("PATH", fakes::path(programs)).env(fakes::ROOM, "2");
    }
    let output = command.output().unwrap();
    let said = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap()).concat();
    assert!(output.status.success() && said.contains("1 passed"), "{system}: {said}");
}

#[test]
fn local_processes_conform() {
    conforms("local:2", None);
}

#[test]
fn slurm_conforms() {
    let dir = tempfile::tempdir().unwrap();
    conforms("slurm", Some(&fakes::slurm(&dir)));
}

#[test]
fn the_real_slurm_conforms() {
    let answers = Command::new("sinfo").output().is_ok_and(|output| output.status.success());
    match answers {
        true => conforms("slurm", None),
        false => common::skipped("slurm", "no Slurm answers `sinfo`"),
    }
}

#[test]
fn hyperqueue_conforms() {
    let dir = tempfile::tempdir().unwrap();
    conforms("hyperqueue", Some(&fakes::hyperqueue(&dir)));
}

#[test]
fn snakemake_conforms() {
    let dir = tempfile::tempdir().unwrap();
    let system = format!("snakemake:jobs=2,{}", dir.path().join("jobs").display());
    conforms(&system, Some(&fakes::snakemake(&dir)));
}

#[test]
fn the_real_hyperqueue_and_snakemake_conform() {
    let answers = |program: &str, args: &[&str]| {
        Command::new(program).args(args).output().is_ok_and(|output| output.status.success())
    };
    match answers("hq", &["server", "info"]) {
        true => conforms("hyperqueue", None),
        false => common::skipped("hyperqueue", "no server of HyperQueue answers `hq server info`"),
    }
    match answers("snakemake", &["--version"]) {
        true => {
            let dir = tempfile::tempdir().unwrap();
            conforms(&format!("snakemake:jobs=2,{}", dir.path().join("jobs").display()), None);
        }
        false => common::skipped("snakemake", "there is no program `snakemake`"),
    }
}
