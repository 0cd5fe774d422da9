//! Constants of a model, the numbers that are fitted for them, and the data of the fit.

use nalgebra::{DMatrix, DVector};

/// Length of a column of the Jacobian, over that of the data, below which a constant has no influence.
const NO_INFLUENCE: f64 = 1e-5;

/// A constant to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant {
    /// Value at which the fit starts.
    pub start: f64,
    /// Lowest and highest allowed value.
    pub within: Option<[f64; 2]>,
}

/// Measured values with which the model is compared.
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a> {
    /// Values.
    pub values: &'a [f64],
    /// Standard deviations of the values; `None` if they are unknown and equal.
    pub sd: Option<&'a [f64]>,
}

impl Measured<'_> {
    /// `(model - measured) / sd`.
    pub(crate) fn residual(&self, model: &[f64]) -> DVector<f64> {
        let sd = |i: usize| self.sd.map_or(1.0, |sd| sd[i]);
        let each = model.iter().zip(self.values).enumerate();
        DVector::from_iterator(model.len(), each.map(|(i, (model, value))| (model - value) / sd(i)))
    }

    /// Length of the vector of the data over their standard deviations.
    pub(crate) fn length(&self) -> f64 {
        self.residual(&vec![0.0; self.values.len()]).norm()
    }
}

impl Constant {
    /// Whether the logarithm of the constant is fitted: its start is positive, and so are its bounds.
    pub fn is_logarithmic(&self) -> bool {
        self.start > 0.0 && self.within.is_none_or(|[low, _]| low > 0.0)
    }

    /// Unit in which a constant that is not fitted by its logarithm is counted: its range, or else its start.
    fn unit(&self) -> f64 {
        self.within.map_or(self.start.abs(), |[low, high]| high - low)
    }

    /// The number that is fitted for a value of the constant.
    pub(crate) fn forward(&self, value: f64) -> f64 {
        if self.is_logarithmic() { value.ln() } else { value / self.unit() }
    }

    /// The value of the constant for a fitted number.
    pub(crate) fn back(&self, theta: f64) -> f64 {
        if self.is_logarithmic() { theta.exp() } else { theta * self.unit() }
    }

    /// The allowed value of the constant for a fitted number: on a bound the bound itself, without rounding.
    pub(crate) fn value(&self, theta: f64) -> f64 {
        match self.within {
            Some([low, _]) if theta <= self.forward(low) => low,
            Some([_, high]) if theta >= self.forward(high) => high,
            _ => self.back(theta),
        }
    }

    /// Lowest and highest value of the fitted number.
    pub(crate) fn bounds(&self) -> [f64; 2] {
        self.within
            .map_or([f64::NEG_INFINITY, f64::INFINITY], |[low, high]| [self.forward(low), self.forward(high)])
    }
}

/// Those of some constants that have an influence on the data, by the lengths of their columns of the
/// Jacobian over the length of the data.
pub(crate) fn felt(jacobian: &DMatrix<f64>, constants: &[usize], data: f64) -> Vec<usize> {
    constants.iter().copied().filter(|&k| jacobian.column(k).norm() > NO_INFLUENCE * data).collect()
}

/// Columns of some constants, each divided by its length, and the lengths.
pub(crate) fn scaled(jacobian: &DMatrix<f64>, columns: &[usize]) -> (DMatrix<f64>, DVector<f64>) {
    let mut scaled = jacobian.select_columns(columns);
    let lengths: Vec<f64> = scaled.column_iter().map(|column| column.norm()).collect();
    scaled.column_iter_mut().zip(&lengths).for_each(|(mut column, length)| column /= *length);
    (scaled, DVector::from_vec(lengths))
}
