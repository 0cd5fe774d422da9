//! What moving least squares met: neighbours, conditioning, fallbacks.

/// Report over all points of one call. Every fallback is counted; none is silent.
#[derive(Clone, Debug, PartialEq)]
pub struct MlsInfo {
    /// Points evaluated.
    pub points: usize,
    /// Fewest neighbours at a point.
    pub neighbours_min: usize,
    /// Mean number of neighbours.
    pub neighbours_mean: f64,
    /// Most neighbours at a point.
    pub neighbours_max: usize,
    /// Largest condition number of the moment matrix in shifted and scaled coordinates, in the 1-norm: an upper
    /// bound of the spectral one, at most 4 (linear) or 10 (quadratic) times as large.
    pub condition_max: f64,
    /// Median of the same.
    pub condition_median: f64,
    /// Points at which the supports had to be enlarged.
    pub enlarged: usize,
    /// Points at which the quadratic block of the moment matrix had to be regularised.
    pub regularised: usize,
    /// Points at which the quadratic basis had to give way to the linear one.
    pub reduced: usize,
}

/// One point's share of the report.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) neighbours: u32,
    pub(crate) condition: f64,
    pub(crate) enlarged: bool,
    pub(crate) regularised: bool,
    pub(crate) reduced: bool,
}

impl MlsInfo {
    /// Points that needed any fallback are at most this many: the sum of the three counts.
    pub fn fallbacks(&self) -> usize {
        self.enlarged + self.regularised + self.reduced
    }

    pub(crate) fn new(outcomes: &[Outcome]) -> MlsInfo {
        let count = |what: fn(&Outcome) -> bool| outcomes.iter().filter(|o| what(o)).count();
        let points = outcomes.len();
        let neighbours = || outcomes.iter().map(|o| o.neighbours as usize);
        let total: usize = neighbours().sum();
        let mut conditions: Vec<f64> = outcomes.iter().map(|o| o.condition).collect();
        let condition_median = match points {
            0 => 0.0,
            n => *conditions.select_nth_unstable_by(n / 2, f64::total_cmp).1,
        };
        MlsInfo {
            points,
            neighbours_min: neighbours().min().unwrap_or(0),
            neighbours_mean: total as f64 / points.max(1) as f64,
            neighbours_max: neighbours().max().unwrap_or(0),
            condition_max: conditions.into_iter().fold(0.0, f64::max),
            condition_median,
            enlarged: count(|o| o.enlarged),
            regularised: count(|o| o.regularised),
            reduced: count(|o| o.reduced),
        }
    }
}
