//! Provenance of the numbers of a run: program, machine and files.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Version of the files in a folder of results, raised by every change that affects a reader.
pub const FORMAT: u32 = 2;

/// Build of a program.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Program {
    /// Version.
    pub version: String,
    /// Commit of the source, or `unknown`.
    pub commit: String,
    /// Whether the source was changed since that commit.
    pub dirty: bool,
    /// Compiler version.
    pub rustc: String,
    /// Target of the build, such as `x86_64-unknown-linux-gnu`.
    pub target: String,
    /// Instruction sets that the compiler may use, such as `fxsr,sse,sse2`.
    pub features: String,
    /// Build profile: `release` or `dev`.
    pub profile: String,
}

impl Program {
    /// The commit, with `+` appended if the source was changed since.
    pub fn revision(&self) -> String {
        format!("{}{}", self.commit, if self.dirty { "+" } else { "" })
    }
}

/// State of a machine at the start of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Machine {
    /// Processor model.
    pub cpu: String,
    /// Family, model and stepping of the processor, as far as the system reports them; names such as `AMD
    /// EPYC` cover several generations.
    #[serde(default)]
    pub model: String,
    /// Clock of the processor at the start of the run, GHz; `None` if unknown.
    #[serde(default)]
    pub clock: Option<f64>,
    /// Instruction sets that the solvers choose between, such as `avx2,fma`.
    pub instructions: String,
    /// Threads that the solvers use.
    pub threads: u32,
    /// Load at the start: average number of running or waiting processes in the minute before; `None` if
    /// unknown.
    pub load: Option<f64>,
    /// Whether at most a fifth of the processors was busy at the start. Times on a machine that was not quiet
    /// are too long.
    pub quiet: Option<bool>,
    /// Number of concurrent runs in one process, whose CPU times cannot be separated; 0 or 1 for runs one
    /// after another.
    #[serde(default)]
    pub at_once: u32,
}

impl Machine {
    /// Description of the processor: name, model and clock.
    pub fn processor(&self) -> String {
        let model = if self.model.is_empty() { String::new() } else { format!(", {}", self.model) };
        let clock = self.clock.map_or(String::new(), |ghz| format!(", {ghz:.1} GHz"));
        format!("{}{model}{clock}", self.cpu)
    }
}

/// Program, machine and scenes that a run's numbers came from, without a date.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Provenance {
    /// Version of the files in this folder; 0 in results from before the version was recorded.
    #[serde(default)]
    pub format: u32,
    /// File name of the study or scene.
    pub source: String,
    /// Program that computed the numbers.
    pub program: Program,
    /// Machine that ran the program.
    pub machine: Machine,
    /// Keys that replace values of the scene file, each as `KEY=VALUE`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
    /// Content hash (BLAKE3, hexadecimal) of each scene file, by scene name, sorted.
    pub scenes: Vec<SceneHash>,
}

/// The content hash of one scene file.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SceneHash {
    /// Scene (case) name.
    pub case: String,
    /// BLAKE3 hash of the file, hexadecimal.
    pub blake3: String,
    /// Title of the scene.
    #[serde(default)]
    pub title: String,
}
