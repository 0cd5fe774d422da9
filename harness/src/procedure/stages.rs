//! Stages of the plan that depend on the procedure.

/// Stages that depend on the procedure: whether each of them runs, and why.
pub(super) struct Stages {
    pub(super) mass: (bool, String),
    pub(super) stiffness: (bool, String),
    pub(super) time_steps: (bool, String),
    pub(super) factorisation: (bool, String),
    /// Whether tangents are iterated.
    pub(super) iterates: bool,
    pub(super) newton: (bool, String),
    pub(super) relaxation: (bool, String),
    /// Reason why no displacement is transferred to other points, if that is so.
    pub(super) no_transfer: Option<&'static str>,
    /// Reason why there is no contact, if that is so.
    pub(super) no_contact: Option<&'static str>,
}

impl Stages {
    /// Stages of a linear solution. Other procedures state their differences.
    pub(super) fn linear() -> Stages {
        Stages {
            mass: (false, "static".into()),
            stiffness: (true, "linear static".into()),
            time_steps: (false, "static".into()),
            factorisation: (true, "one, for all load levels".into()),
            iterates: false,
            newton: (false, "linear".into()),
            relaxation: (false, "no static path that could stall".into()),
            no_transfer: None,
            no_contact: None,
        }
    }

    /// Stages of a run that only fills the tables.
    pub(super) fn prepare() -> Stages {
        const NOTHING: &str = "nothing is solved (kind = \"prepare\")";
        Stages {
            mass: (false, NOTHING.into()),
            stiffness: (false, NOTHING.into()),
            time_steps: (false, NOTHING.into()),
            factorisation: (false, NOTHING.into()),
            iterates: false,
            newton: (false, NOTHING.into()),
            relaxation: (false, NOTHING.into()),
            no_transfer: Some(NOTHING),
            no_contact: Some(NOTHING),
        }
    }
}
