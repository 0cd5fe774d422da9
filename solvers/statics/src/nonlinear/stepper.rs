//! Lengths of steps: equal output intervals, shorter steps after failures, and longer steps after quick
//! steps.

/// Part of an output interval within which two times are the same.
const NEAR: f64 = 1e-9;

/// State of the stepping from 0 to an end.
pub(crate) struct Stepper {
    intervals: usize,
    /// Output interval, which is the longest step.
    longest: f64,
    /// Shortest step.
    pub smallest: f64,
    /// Times between outputs at which a step ends too: a step across them would not see the points of a curve or the
    /// bends of a path.
    stops: Vec<f64>,
    /// Number of the next output.
    next: usize,
    /// Length of the next step.
    step: f64,
    /// End of the last accepted step.
    pub time: f64,
    /// Number of steps that failed and were cut back.
    pub cut_back: usize,
}

/// A step to try.
#[derive(Clone, Copy)]
pub(crate) struct Attempt {
    /// End of the step.
    pub time: f64,
    /// Length of the step.
    pub length: f64,
    /// Set if the step ends at an output; whether this output is the last.
    pub output: Option<bool>,
}

impl Stepper {
    /// Starts at 0. The end is divided into `intervals`, of which steps are at least the part `smallest`.
    /// Steps also end at the times `stops`, in order.
    pub fn new(end: f64, intervals: usize, smallest: f64, stops: Vec<f64>) -> Stepper {
        let intervals = intervals.max(1);
        let longest = end / intervals as f64;
        let smallest = smallest * longest;
        Stepper { intervals, longest, smallest, stops, next: 1, step: longest, time: 0.0, cut_back: 0 }
    }

    /// Returns the next step to try; `None` at the end.
    pub fn attempt(&self) -> Option<Attempt> {
        if self.next > self.intervals {
            return None;
        }
        let output = self.next as f64 * self.longest;
        let near = NEAR * self.longest;
        let stop = self.stops.iter().copied().find(|stop| *stop > self.time + near && *stop < output - near);
        let target = stop.unwrap_or(output);
        // Avoids a last step shorter than a tenth of the current step.
        let reaches = self.step > 0.9 * (target - self.time);
        let time = if reaches { target } else { self.time + self.step };
        let output = (reaches && stop.is_none()).then_some(self.next == self.intervals);
        Some(Attempt { time, length: time - self.time, output })
    }

    /// Whether the last accepted step ended before a time.
    pub fn is_before(&self, time: f64) -> bool {
        self.time < time - NEAR * self.longest
    }

    /// Time of the next output.
    pub fn next_output(&self) -> f64 {
        self.next as f64 * self.longest
    }

    /// Accepts a step. The next step is longer by the factor `growth`, up to the output interval.
    pub fn accept(&mut self, done: Attempt, growth: f64) {
        self.time = done.time;
        self.next += usize::from(done.output.is_some());
        self.step = (growth * self.step).min(self.longest);
    }

    /// Cuts a failed step to the fraction `part` of its length. Returns whether the cut step is at least
    /// `finest`.
    pub fn cut(&mut self, failed: Attempt, part: f64, finest: f64) -> bool {
        self.cut_back += 1;
        self.step = part * failed.length;
        self.step >= finest
    }
}
