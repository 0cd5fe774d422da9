//! Statistics of moving least squares: neighbours, conditioning, fallbacks.

/// Statistics over all points of a call. Every fallback is counted.
#[derive(Clone, Debug, PartialEq)]
pub struct MlsInfo {
    /// Number of points evaluated.
    pub points: usize,
    /// Smallest number of neighbours at a point.
    pub neighbours_min: usize,
    /// Mean number of neighbours of a point.
    pub neighbours_mean: f64,
    /// Largest number of neighbours at a point.
    pub neighbours_max: usize,
    /// Largest condition number of the moment matrix in shifted and scaled coordinates, in the 1-norm. It is
    /// an upper bound of the spectral condition number, at most 4 (linear) or 10 (quadratic) times as large.
    pub condition_max: f64,
    /// Median of this condition number over the points.
    pub condition_median: f64,
    /// Number of points at which the supports had to be enlarged.
    pub enlarged: usize,
    /// Number of points at which the quadratic block of the moment matrix had to be regularised.
    pub regularised: usize,
    /// Number of points at which the quadratic basis had to be replaced by the linear basis.
    pub reduced: usize,
}

/// Statistics of a single point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) neighbours: u32,
    pub(crate) condition: f64,
    pub(crate) enlarged: bool,
    pub(crate) regularised: bool,
    pub(crate) reduced: bool,
}

impl MlsInfo {
    /// Returns an upper bound of the number of points that needed any fallback: the sum of `enlarged`,
    /// `regularised` and `reduced`.
    pub fn fallbacks(&self) -> usize {
        self.enlarged + self.regularised + self.reduced
    }
}

/// Accumulated statistics. Only the condition of each point is kept, for the median: 8 bytes instead of the
/// 24 of an [`Outcome`].
pub(crate) struct Tally {
    conditions: Vec<f64>,
    fewest: u32,
    most: u32,
    total: usize,
    enlarged: usize,
    regularised: usize,
    reduced: usize,
}

impl Tally {
    pub(crate) fn with_capacity(points: usize) -> Tally {
        let conditions = Vec::with_capacity(points);
        Tally { conditions, fewest: u32::MAX, most: 0, total: 0, enlarged: 0, regularised: 0, reduced: 0 }
    }

    pub(crate) fn add(&mut self, met: &Outcome) {
        self.conditions.push(met.condition);
        self.fewest = self.fewest.min(met.neighbours);
        self.most = self.most.max(met.neighbours);
        self.total += met.neighbours as usize;
        self.enlarged += usize::from(met.enlarged);
        self.regularised += usize::from(met.regularised);
        self.reduced += usize::from(met.reduced);
    }

    pub(crate) fn info(self) -> MlsInfo {
        let Tally { mut conditions, fewest, most, total, enlarged, regularised, reduced } = self;
        let points = conditions.len();
        let condition_median = match points {
            0 => 0.0,
            n => *conditions.select_nth_unstable_by(n / 2, f64::total_cmp).1,
        };
        MlsInfo {
            points,
            neighbours_min: if points > 0 { fewest as usize } else { 0 },
            neighbours_mean: total as f64 / points.max(1) as f64,
            neighbours_max: most as usize,
            condition_max: conditions.into_iter().fold(0.0, f64::max),
            condition_median,
            enlarged,
            regularised,
            reduced,
        }
    }
}
