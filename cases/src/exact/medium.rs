//! The material that an exact solution is of.

use super::{Elastic, Hyperelastic};
use catalogue::Problem;

/// A material as the exact solutions take it.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    /// Its moduli at small strain.
    pub elastic: Elastic,
    /// Its stored energy, where that is written out in [`Hyperelastic`].
    pub law: Option<Hyperelastic>,
}

impl Medium {
    /// For solutions at large strain.
    pub(super) fn hyperelastic(&self) -> Result<&Hyperelastic, Problem> {
        let help = "take law = \"neo-hookean\" or another of large strain";
        self.law.as_ref().ok_or_else(|| Problem::new("is at large strain, which the law is not").help(help))
    }
}

/// At small strain alone.
impl From<Elastic> for Medium {
    fn from(elastic: Elastic) -> Medium {
        Medium { elastic, law: None }
    }
}
