//! Essential conditions of clouds: how prescribed displacements are imposed.

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::procedure::ProcedureKind;
use crate::scene::report::Report;
use crate::scene::words::words;

/// Method of imposing prescribed displacements
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum EssentialKeys {
    Name(EssentialKind),
    Table(EssentialTable),
}

/// An essential condition with settings
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct EssentialTable {
    method: EssentialKind,
    /// Stabilisation factor of Nitsche's method (4 with smoothed gradients, else 100, unless given), or
    /// penalty factor (1000 unless given); with these two methods only
    factor: Option<f64>,
    /// Displacements prescribed by the eliminated rows; with elimination only
    rows: Option<ConstraintRows>,
}

/// Method of imposing prescribed displacements. A factor of `None` is the default of the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Essential {
    /// Nitsche's method.
    Nitsche {
        /// Stabilisation factor.
        factor: Option<f64>,
    },
    /// Penalty.
    Penalty {
        /// Penalty factor.
        factor: Option<f64>,
    },
    /// Lagrange multipliers.
    Multipliers,
    /// Exact elimination of constraint rows.
    Elimination {
        /// Displacements prescribed by the rows.
        rows: ConstraintRows,
    },
    /// Finite elements along the constrained surface, coupled to the cloud; their nodes are constrained
    /// exactly.
    Coupling,
}

impl EssentialKeys {
    pub fn read(self, report: &Report) -> Essential {
        let (kind, factor, rows) = match self {
            EssentialKeys::Name(kind) => (kind, None, None),
            EssentialKeys::Table(table) => (table.method, table.factor, table.rows),
        };
        let factor = factor.map(|factor| report.positive("factor", factor));
        let weak = matches!(kind, EssentialKind::Nitsche | EssentialKind::Penalty);
        let help = "leave it out";
        report.require(factor.is_none() || weak, "factor", "applies to nitsche and penalty only", help);
        let eliminated = kind == EssentialKind::Elimination;
        report.require(rows.is_none() || eliminated, "rows", "applies to elimination only", help);
        match kind {
            EssentialKind::Nitsche => Essential::Nitsche { factor },
            EssentialKind::Penalty => Essential::Penalty { factor },
            EssentialKind::Multipliers => Essential::Multipliers,
            EssentialKind::Coupling => Essential::Coupling,
            EssentialKind::Elimination => {
                Essential::Elimination { rows: rows.unwrap_or(ConstraintRows::Means) }
            }
        }
    }
}

impl Essential {
    /// Kind of the condition, without its settings.
    pub fn kind(&self) -> EssentialKind {
        match self {
            Essential::Nitsche { .. } => EssentialKind::Nitsche,
            Essential::Penalty { .. } => EssentialKind::Penalty,
            Essential::Multipliers => EssentialKind::Multipliers,
            Essential::Elimination { .. } => EssentialKind::Elimination,
            Essential::Coupling => EssentialKind::Coupling,
        }
    }

    /// The problem if the procedure does not support this condition; `None` if it does.
    pub(crate) fn unsupported(&self, kind: ProcedureKind) -> Option<Problem> {
        let general = matches!(self, Essential::Penalty { .. } | Essential::Coupling);
        let problem =
            format!("is available for linear procedures and modes, not for kind = \"{}\"", kind.name());
        let unsupported = !general && !kind.has_no_steps();
        unsupported.then(|| Problem::new(problem).help("take \"penalty\" or \"coupling\""))
    }
}

words! {
    /// Ways to impose prescribed displacements on a cloud.
    pub enum EssentialKind {
        /// Nitsche's method: consistent and symmetric, with a stabilisation factor.
        Nitsche = "nitsche",
        /// Penalty, with a factor.
        Penalty = "penalty",
        /// Lagrange multipliers.
        Multipliers = "multipliers",
        /// Exact elimination of constraint rows.
        Elimination = "elimination",
        /// Linear finite elements along the constrained surface, coupled consistently to the cloud; their
        /// nodes are constrained exactly.
        Coupling = "coupling",
    }
}

words! {
    /// Displacements prescribed by the eliminated rows of a constrained surface, one row for each of its
    /// nodes.
    pub enum ConstraintRows {
        /// The mean displacement over the tributary area of the node; the default.
        Means = "means",
        /// The displacement at the point of the surface nearest to the node.
        Points = "points",
    }
}
