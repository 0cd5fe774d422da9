//! The material of an exact solution.

use catalogue::Problem;

use super::elastic::Elastic;
use super::hyperelastic::Hyperelastic;

/// A material in the form used by the exact solutions.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    /// Moduli at small strain.
    pub elastic: Elastic,
    /// Stored energy, if [`Hyperelastic`] has it.
    pub law: Option<Hyperelastic>,
}

impl Medium {
    /// The law for solutions at large strain; an error if there is none.
    pub(super) fn hyperelastic(&self) -> Result<&Hyperelastic, Problem> {
        let help = "take law = \"neo-hookean\" or another large-strain law";
        self.law.as_ref().ok_or_else(|| {
            Problem::new("is a large-strain solution, but the law is for small strain").help(help)
        })
    }
}

/// A medium at small strain only.
impl From<Elastic> for Medium {
    fn from(elastic: Elastic) -> Medium {
        Medium { elastic, law: None }
    }
}
