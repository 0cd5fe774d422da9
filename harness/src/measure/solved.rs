//! A solved run, and its displacement at the points where runs are compared.

use geometry::Vector3;

use crate::discretise::Discretisation;
use crate::prepare::Prepared;
use crate::procedure::Solution;
use crate::scenario::setup::Setup;

/// Solved run, from which all metrics are computed.
#[derive(Clone, Copy)]
pub(crate) struct Solved<'a> {
    pub(crate) method: &'a Discretisation,
    pub(crate) setup: &'a Setup,
    pub(crate) prepared: &'a Prepared,
    pub(crate) solution: &'a Solution,
}

/// Displacement (m) at the points where runs are compared, and the number of points outside the body.
pub(crate) struct Field {
    pub(crate) values: Vec<Vector3>,
    pub(crate) outside: usize,
}
