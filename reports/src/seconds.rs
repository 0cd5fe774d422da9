//! Choice of the time by which runs are compared.
//!
//! Wall time is the time that a user waits for, as long as no other program uses the processors. Otherwise it
//! measures how busy the machine was, and CPU time is closer to the cost of the method. The choice is made
//! here, equally for all runs of a case.

use records::Machine;
use serde::{Deserialize, Serialize};

/// Ratio of wall time to CPU time above which other programs used the processors.
const DISTURBED: f64 = 1.2;
/// Smallest wall time that is assessed, s. In shorter runs, waking threads takes a significant part of the
/// time.
const SHORTEST: f64 = 5e-3;

/// Kind of time by which runs are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Seconds {
    /// Wall time, median of the repeats.
    #[default]
    Wall,
    /// CPU time of all processors, median of the repeats; wall time if the CPU time is unknown.
    Cpu,
    /// Wall time, minimum of the repeats.
    Least,
}

/// Times of one run, as medians of its repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Took {
    /// Wall time, s.
    pub wall: f64,
    /// CPU time of all processors, s; `None` if unknown.
    pub cpu: Option<f64>,
}

impl Took {
    /// Ratio of wall time to CPU time, if it shows that other programs used the processors.
    pub fn disturbed(&self) -> Option<f64> {
        let ratio = self.wall / self.cpu.filter(|cpu| *cpu > 0.0)?;
        (self.wall >= SHORTEST && ratio > DISTURBED).then_some(ratio)
    }
}

impl Seconds {
    /// Chooses the time for runs on a machine. Wall time is used if the machine was quiet and no run was
    /// disturbed, otherwise CPU time. The CPU times of concurrent runs cannot be separated, so their shortest
    /// repeat is used.
    pub fn of(machine: &Machine, took: impl IntoIterator<Item = Took>) -> Seconds {
        let mut took = took.into_iter();
        match machine {
            _ if machine.at_once > 1 => Seconds::Least,
            _ if machine.quiet == Some(false) || took.any(|run| run.disturbed().is_some()) => Seconds::Cpu,
            _ => Seconds::Wall,
        }
    }

    /// Label on an axis and in a table, without the unit.
    pub fn name(self) -> &'static str {
        match self {
            Seconds::Wall => "run time, median",
            Seconds::Cpu => "CPU time, median",
            Seconds::Least => "run time, shortest repeat",
        }
    }

    /// Name in one word.
    pub fn word(self) -> &'static str {
        match self {
            Seconds::Wall => "wall",
            Seconds::Cpu => "CPU",
            Seconds::Least => "least",
        }
    }
}
