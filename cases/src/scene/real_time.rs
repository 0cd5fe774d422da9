//! A simulator's loop in real time: its keys and values.

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use super::procedure::Procedure;
use super::report::Report;
use super::units::{Q, Time};

/// The loading in real time: frames come at a fixed rate, and each is timed against its deadline
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RealTimeKeys {
    /// Time in which the loading passes; that of the procedure, if it goes on in time
    duration: Option<Q<Time>>,
    /// Numbers of frames per second, such as [30, 60, 1000]: the loading passes once at each
    rates: Vec<u32>,
    /// Computing time of one rate after which no further frame starts; "60 s" unless given
    within: Option<Q<Time>>,
    /// Relative residual of a frame solved by Newton's method; the procedure's tolerance unless given
    tolerance: Option<f64>,
}

/// A simulator's loop in real time.
#[derive(Clone, Debug, PartialEq)]
pub struct RealTime {
    /// Time in which the loading passes, s; 0 if it is that of the procedure.
    pub duration: f64,
    /// Frames per second, at least one rate, ascending.
    pub rates: Vec<usize>,
    /// Computing time of one rate after which no further frame starts, s.
    pub within: f64,
    /// Relative residual of a frame solved by Newton's method; `None` for that of the procedure.
    pub tolerance: Option<f64>,
}

/// Largest number of frames of one rate: their times are stored.
const MOST_FRAMES: f64 = 1e6;
/// Time after which a loop ends unless the scene gives another, s.
const WITHIN: f64 = 60.0;

impl RealTimeKeys {
    pub fn read(self, report: &Report) -> RealTime {
        let rates: Vec<usize> = self.rates.iter().map(|&rate| rate as usize).collect();
        let help = "give frames per second, such as rates = [30, 60, 1000]";
        report.require(!rates.is_empty(), "rates", "is empty", help);
        for (index, rate) in rates.iter().enumerate() {
            let key = format!("rates[{index}]");
            report.require(*rate > 0, &key, "is zero", help);
            let sound = index == 0 || rates[index - 1] < *rate;
            report.require(
                sound,
                &key,
                "is not above the rate before it",
                "give each rate once, the lowest first",
            );
        }
        if let Some(duration) = &self.duration {
            report.positive("duration", duration.0);
        }
        let within = self.within.map_or(WITHIN, |within| within.0);
        report.positive("within", within);
        self.tolerance.map(|tolerance| report.positive("tolerance", tolerance));
        RealTime {
            duration: self.duration.map_or(0.0, |duration| duration.0),
            rates,
            within,
            tolerance: self.tolerance,
        }
    }
}

impl RealTime {
    /// Time in which the loading of a scene passes, s.
    pub fn duration(&self, procedure: &Procedure) -> f64 {
        procedure.duration().unwrap_or(self.duration)
    }

    /// Number of frames in which the loading passes at one of the rates.
    pub fn frames(&self, procedure: &Procedure, rate: usize) -> usize {
        (self.duration(procedure) * rate as f64).round().max(1.0) as usize
    }

    /// Reports contradictions with the procedure, and with a support of a part of the loading at the key `staged`.
    pub(crate) fn demands(&self, procedure: &Procedure, staged: Option<String>, report: &Report) {
        let swept = match procedure {
            Procedure::Static(_) => false,
            Procedure::Vbd(_) | Procedure::Xpbd(_) | Procedure::ImplicitCg(_) => true,
            other => {
                let problem = format!("is not available in a {} procedure", other.kind().name());
                let help = "take kind = \"static\", \"vbd\", \"xpbd\" or \"implicit-cg\", or leave it out";
                return report.add("", Problem::new(problem).help(help));
            }
        };
        if swept {
            let help = "leave it out";
            let sound = self.duration == 0.0;
            report.require(sound, "duration", "is that of the procedure, which has its own", help);
            let problem =
                "is of Newton's method, and the frames of this procedure have a fixed amount of work";
            report.require(self.tolerance.is_none(), "tolerance", problem, help);
        } else if self.duration == 0.0 {
            report.missing("duration", "give the time in which the loading passes, such as \"4 s\"");
        }
        let duration = self.duration(procedure);
        for (index, &rate) in self.rates.iter().enumerate() {
            let count = duration * rate as f64;
            let sound = duration == 0.0 || (1.0..=MOST_FRAMES).contains(&count);
            let problem = format!("gives {count} frames in {duration} s");
            report.require(sound, &format!("rates[{index}]"), &problem, "give 1 to 1000000 frames");
        }
        if let Some(key) = staged {
            let problem = format!("is not available with supports of a part of the loading, as {key}");
            report.add("", Problem::new(problem).help("leave one of them out"));
        }
    }
}
