//! By what program, on what machine and from what files the numbers of a run came.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Version of the files in a folder of results. A change that a reader of them would notice raises it.
pub const FORMAT: u32 = 1;

/// A program, as it was built.
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
    /// Machine that it is built for, such as `x86_64-unknown-linux-gnu`.
    pub target: String,
    /// Instruction sets that the compiler may use, such as `fxsr,sse,sse2`.
    pub features: String,
    /// Build profile: `release` or `dev`.
    pub profile: String,
}

impl Program {
    /// The commit, with `+` appended where the source was changed since.
    pub fn revision(&self) -> String {
        format!("{}{}", self.commit, if self.dirty { "+" } else { "" })
    }
}

/// A machine, as it was when a run began.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Machine {
    /// Processor model.
    pub cpu: String,
    /// Its family, model and stepping, as far as the system says: names such as `AMD EPYC` are those of
    /// several generations.
    #[serde(default)]
    pub model: String,
    /// Its clock when the run began, GHz; `None` where it is not known.
    #[serde(default)]
    pub clock: Option<f64>,
    /// Instruction sets that the solvers choose between, such as `avx2,fma`.
    pub instructions: String,
    /// Threads that the solvers use.
    pub threads: u32,
    /// Load at the start: processes that ran or waited to run in the minute before, on average; `None` where it is not known.
    pub load: Option<f64>,
    /// Whether at most a fifth of the processors was busy then: times of a machine that was not quiet are too long.
    pub quiet: Option<bool>,
    /// Runs that were made at once by one process, of which the seconds of the processors are not told apart;
    /// 0 or 1 where each had the process for itself.
    #[serde(default)]
    pub at_once: u32,
}

impl Machine {
    /// The processor in words: its name, model and clock.
    pub fn processor(&self) -> String {
        let model = if self.model.is_empty() { String::new() } else { format!(", {}", self.model) };
        let clock = self.clock.map_or(String::new(), |ghz| format!(", {ghz:.1} GHz"));
        format!("{}{model}{clock}", self.cpu)
    }
}

/// By what, where and from what a run's numbers came. Carries no date.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Provenance {
    /// Version of the files in this folder; 0 in results from before it was written.
    #[serde(default)]
    pub format: u32,
    /// Name of the study's or scene's file that the numbers are of.
    pub source: String,
    /// The program.
    pub program: Program,
    /// The machine.
    pub machine: Machine,
    /// Keys set in place of the scene's file, `KEY=VALUE` each.
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
    /// What the scene is, in its own words.
    #[serde(default)]
    pub title: String,
}
