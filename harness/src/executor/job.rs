//! Jobs, their states, and the trait of the systems that run them.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

/// A command with the resources it needs. It runs in the working directory of the program that submits it.
#[derive(Clone, Debug)]
pub struct Job {
    /// Name that the system shows.
    pub name: String,
    /// The program and its arguments.
    pub command: Vec<OsString>,
    /// File for stdout and stderr.
    pub log: PathBuf,
    /// Number of processors.
    pub threads: usize,
    /// Memory, bytes.
    pub memory: u64,
    /// Time after which the program receives the signal TERM.
    pub time: Duration,
    /// Time between the signal TERM and the end of the program by force.
    pub notice: Duration,
}

/// State of a job.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum State {
    /// The job has not started, for this reason.
    Waiting(String),
    /// The job runs.
    Running,
    /// The job and all processes it started have ended.
    Ended(End),
}

/// End of a job.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum End {
    /// The program exited with code 0.
    Done,
    /// The job exceeded its time.
    OutOfTime,
    /// The job failed, crashed or was cancelled; the text says which.
    Failed(String),
}

/// A system that runs jobs.
pub trait Executor: Send {
    /// Hands over a job and returns its id.
    ///
    /// # Errors
    /// The system refuses the job; the text is its reason.
    fn submit(&mut self, job: &Job) -> Result<String, String>;

    /// Returns the state of each job, in the order of `ids`. An ended job is reported as ended again.
    ///
    /// # Errors
    /// The system does not answer, which may be temporary.
    fn poll(&mut self, ids: &[String]) -> Result<Vec<State>, String>;

    /// Ends jobs, with all processes they started. Jobs that have ended are ignored.
    ///
    /// # Errors
    /// The system does not answer.
    fn cancel(&mut self, ids: &[String]) -> Result<(), String>;
}
