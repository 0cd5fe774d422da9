//! Export of a method's problem to files for other solvers. The problem is written, not solved.

use std::path::Path;

use super::group::Group;
use crate::error::Failure;
use crate::measure::check_probes;
use crate::outcome::Counters;
use crate::prepare::prepare;
use crate::procedure::Problem;
use crate::procedure::external::problem;
use crate::scenario::Scenario;

/// Id and size of an exported problem.
pub(crate) struct Exported {
    /// Hash of the contents of all files.
    pub(crate) id: String,
    pub(crate) nodes: usize,
    pub(crate) cells: usize,
}

impl Group<'_> {
    /// Writes the problem of a finite-element method to a folder. Meshes are also written in formats for
    /// programs that read no arrays.
    pub(crate) fn export(&self, scenario: &Scenario, folder: &Path) -> Result<Exported, Failure> {
        scenario.check_files().map_err(|failure| scenario.locate(failure))?;
        let about = scenario.about_elements()?;
        let (method, setup) = (scenario.discretise()?, scenario.setup()?);
        let (plan, _) = self.plan(scenario)?;
        check_probes(method.mesh(), self.probes())?;
        let written = || -> Result<Exported, Failure> {
            let prepared = prepare(&method, &setup, &plan, &mut Counters::default())?;
            let problem = Problem {
                method: &method,
                setup: &setup,
                prepared: &prepared,
                plan: &plan,
                watch: None,
                probes: self.probes(),
            };
            let id = problem::write(&problem, &about, folder, &problem::MESHES.map(String::from))?;
            Ok(Exported { id, nodes: method.nodes().len(), cells: method.mesh().cell_count() })
        };
        written().map_err(|failure| scenario.locate(failure))
    }
}
