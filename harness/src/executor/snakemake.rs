//! Jobs of Snakemake. Each job is a workflow of one rule with a process of `snakemake` on this machine. The
//! profile in the folder of the user says where Snakemake runs the rule.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::job::{End, Executor, Job, State};
use super::local::Local;
use super::programs::{LATE, limited, quoted};

/// Longest time of a process of `snakemake`, which waits in the queue of a cluster too.
const WEEK: Duration = Duration::from_secs(7 * 24 * 3600);

/// Processes of `snakemake`.
pub(super) struct Snakemake {
    folder: PathBuf,
    processes: Local,
    /// Files with the exit codes of the jobs' programs.
    codes: BTreeMap<String, PathBuf>,
}

impl Snakemake {
    pub(super) fn new(folder: &Path, jobs: usize) -> Snakemake {
        Snakemake { folder: folder.into(), processes: Local::new(jobs), codes: BTreeMap::new() }
    }
}

/// Workflow with one rule, which writes the exit code of the program to a file.
fn workflow(job: &Job, code: &Path) -> Result<String, String> {
    let folder = std::env::current_dir().map_err(|bad| format!("the working directory: {bad}"))?;
    let words: Vec<String> = limited(job).iter().map(|word| quoted(word)).collect::<Result<_, String>>()?;
    let [folder, log, code] = [&folder, &job.log, code].map(|path| quoted(path.as_os_str()));
    let (folder, log, code) = (folder?, log?, code?);
    // The shell waits for the program and passes on the signals that end a job. `timeout` leads a process
    // group.
    let shell = format!(
        "set +e; cd {folder} || exit; {} > {log} 2>&1 & p=$!; trap 'kill -TERM $p' TERM INT; wait $p; c=$?; trap '' TERM; \
         wait $p; kill -KILL -$p 2> /dev/null; echo $c > {code}; exit $c",
        words.join(" ")
    );
    // Braces are the names of wildcards.
    let shell = serde_json::to_string(&shell.replace('{', "{{").replace('}', "}}"));
    let shell = shell.map_err(|bad| bad.to_string())?;
    let (memory, minutes) = (job.memory.div_ceil(1 << 20), (job.time + job.notice).as_secs().div_ceil(60));
    Ok(format!(
        "rule all:\n    output: touch(\"done\")\n    threads: {}\n    resources: mem_mb={memory}, runtime={minutes}\n    \
         shell: {shell}\n",
        job.threads
    ))
}

impl Executor for Snakemake {
    fn submit(&mut self, job: &Job) -> Result<String, String> {
        let folder = self.folder.join(&job.name);
        let unwritten = |bad: std::io::Error| format!("{}: {bad}", folder.display());
        std::fs::create_dir_all(&folder).map_err(unwritten)?;
        let absolute = |path: &Path| std::path::absolute(path).map_err(unwritten);
        let (folder, log) = (absolute(&folder)?, absolute(&job.log)?);
        let (snakefile, code, said) = (folder.join("Snakefile"), folder.join("code"), folder.join("log"));
        for old in [code.clone(), folder.join("done")] {
            let _ = disk::remove(&old);
        }
        disk::write(&snakefile, workflow(&Job { log, ..job.clone() }, &code)?).map_err(unwritten)?;
        let mut command: Vec<OsString> = vec!["snakemake".into(), "--snakefile".into(), snakefile.into()];
        command.extend(["--directory".into(), folder.into()]);
        command.extend(["--cores", "all", "--nocolor", "--rerun-incomplete"].map(Into::into));
        if self.folder.join("config.yaml").is_file() {
            command.extend(["--profile".into(), absolute(&self.folder)?.into()]);
        }
        let process = Job { command, log: said, time: WEEK, memory: 0, ..job.clone() };
        let id = self.processes.submit(&process)?;
        self.codes.insert(id.clone(), code);
        Ok(id)
    }

    fn poll(&mut self, ids: &[String]) -> Result<Vec<State>, String> {
        let code = |id: &String| disk::read_text(self.codes.get(id)?, disk::Kind::MESSAGE).ok();
        let late = |id: &String| code(id).is_some_and(|code| code.trim() == LATE);
        let states = self.processes.poll(ids)?;
        let of = |(id, state): (&String, State)| match state {
            State::Ended(End::Failed(_)) if late(id) => State::Ended(End::OutOfTime),
            state => state,
        };
        Ok(ids.iter().zip(states).map(of).collect())
    }

    fn cancel(&mut self, ids: &[String]) -> Result<(), String> {
        self.processes.cancel(ids)
    }
}
