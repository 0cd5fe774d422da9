//! Finds the scene key that caused a failure: its file, line and value.

use algebra::AlgebraError;
use cases::scene::{Cloud, ErrorKind, Family, Functions, Method, Procedure, Scene, SupportRule};
use contact::ContactError;
use efg::EfgError;
use explicit::ExplicitError;
use statics::{SolveError, StaticError, TimeError};

use crate::error::{Failure, Finding, Key};
use crate::scenario::Scenario;

impl Scenario<'_> {
    /// Returns the failure of this run at the scene key it refers to.
    pub fn locate(&self, failure: Failure) -> Failure {
        let finding = match failure {
            Failure::Scene(_) => return failure,
            Failure::Foreign(mut foreign) => {
                let named = self.scene.method(&self.method.id).is_some();
                let key = self.key(&Key::Method(if named { "adapter" } else { "" }));
                let problem = format!("{}: {}", foreign.status.name(), foreign.reason);
                foreign.at.get_or_insert_with(|| {
                    Box::new(self.scene.error(ErrorKind::NotRun, &key, &problem, None))
                });
                return Failure::Foreign(foreign);
            }
            Failure::At(finding) => *finding,
            Failure::Input(problem) => finding(ErrorKind::Invalid, Key::Method(""), problem, ""),
            Failure::Run(problem) => finding(ErrorKind::NotRun, Key::Method(""), problem, ""),
            Failure::Efg(error) => self.of_cloud(&error),
            Failure::Solve(error) => self.of_solve(&error),
            Failure::Static(error) => self.of_static(&error),
            Failure::Explicit(error) => self.of_explicit(&error),
            Failure::InTime(error) => self.of_time(&error),
        };
        let key = self.key(&finding.key);
        let help = finding.help.as_deref();
        Failure::Scene(Box::new(self.scene.error(finding.kind, &key, &finding.problem, help)))
    }

    fn key(&self, key: &Key) -> String {
        let of = |m: &Method| m.id == self.method.id || self.method.is_twin_of(m);
        let index = self.scene.methods.iter().position(of);
        let method = index.map_or("method".into(), |i| format!("method[{i}]"));
        match key {
            Key::Scene(key) => key.clone(),
            Key::Method(below) => joined(&method, below),
            Key::Background(below) => joined(&format!("{method}.background"), below),
            Key::Size(below) => match (&self.size_key, &self.method.family) {
                (Some(key), _) => joined(key, below),
                (None, Family::Efg(efg)) if !matches!(efg.cloud, Cloud::Mesh { .. }) => {
                    format!("{method}.nodes")
                }
                (None, _) => joined(&format!("{method}.size"), below),
            },
        }
    }

    fn of_cloud(&self, error: &EfgError) -> Finding {
        let support = match &self.method.family {
            Family::Efg(efg) => match efg.functions {
                Functions::MovingLeastSquares { support: SupportRule::Scale(_), .. } => {
                    Key::Method("support_scale")
                }
                Functions::MovingLeastSquares { support: SupportRule::Neighbours { .. }, .. } => {
                    Key::Method("neighbours")
                }
                Functions::MaximumEntropy { .. } => Key::Method("basis"),
            },
            Family::Fem(_) | Family::External(_) => Key::Method(""),
        };
        let (kind, key, help) = match error {
            EfgError::TooFewNeighbours { .. } | EfgError::SingularMoment { .. } => {
                (ErrorKind::NotRun, support, "take a larger support, or a finer cloud")
            }
            EfgError::FlatCells { .. } => (
                ErrorKind::NotRun,
                Key::Method("neighbourhood"),
                "take neighbourhood = \"ball\", or another mesh",
            ),
            EfgError::OutsideHull { .. } => (
                ErrorKind::NotRun,
                support,
                "every integration point has to lie inside the convex hull of the nodes: on a convex body, use the \
                 nodes of the background mesh as the cloud, or take basis = \"linear\"",
            ),
            EfgError::BadRadius { .. } => {
                (ErrorKind::NotRun, support, "every node needs another node at a distance")
            }
            EfgError::TooFewNodes { .. } => (ErrorKind::Invalid, Key::Size(""), "give more nodes"),
            EfgError::EmptyGrid { .. } => {
                (ErrorKind::Invalid, Key::Method("integration.spacing"), "take a finer spacing")
            }
            EfgError::HugeGrid { .. } => {
                (ErrorKind::Invalid, Key::Method("integration.spacing"), "take a coarser spacing")
            }
            EfgError::NoRule { .. } => (
                ErrorKind::Invalid,
                Key::Method("integration.points"),
                "a tetrahedron has rules of 1, 4, 8, 14, 15, 24, 35 and 46 points",
            ),
            _ => (ErrorKind::NotRun, Key::Method(""), ""),
        };
        finding(kind, key, error.to_string(), help)
    }

    fn of_static(&self, error: &StaticError) -> Finding {
        match error {
            StaticError::Solve(error) => self.of_solve(error),
            StaticError::Contact { tool, cause } => {
                finding(ErrorKind::NotRun, Key::Scene(format!("tool[{tool}]")), cause.to_string(), "")
            }
            StaticError::Loose { .. } => {
                let help = "let another support or a spring hold the body from then on";
                finding(ErrorKind::NotRun, Key::Scene("support".into()), error.to_string(), help)
            }
            StaticError::Parameter { .. } => {
                finding(ErrorKind::Invalid, Key::Scene("procedure".into()), error.to_string(), "")
            }
            _ => match overlapping(error) {
                Some(tool) => {
                    finding(ErrorKind::NotRun, Key::Scene(format!("tool[{tool}]")), error.to_string(), "")
                }
                None => finding(ErrorKind::NotRun, Key::Method(""), error.to_string(), self.more_steps()),
            },
        }
    }

    /// Returns the help for a static procedure that ended early.
    fn more_steps(&self) -> &'static str {
        match &self.method.family {
            Family::Fem(fem) if fem.hourglass.is_some_and(|control| control.coefficient == 0.0) => {
                "one point without hourglass control leaves motions without energy: leave out hourglass, or take reduced = false"
            }
            Family::Fem(fem) if fem.reduced && fem.hourglass.is_none() => {
                "reduced integration leaves motions without energy, which a single row of elements can follow: take \
                 two or more cells across, or reduced = false"
            }
            _ => {
                "more steps (procedure.steps), a finer mesh, or a dilation that does not lock may reach more of the load"
            }
        }
    }

    fn of_explicit(&self, error: &ExplicitError) -> Finding {
        let given = matches!(&self.scene.procedure, Procedure::Explicit(explicit) if explicit.step.is_some());
        if *error == ExplicitError::NoSinglePrecision {
            let problem =
                format!("single precision is not available for method '{}': {error}", self.method.id);
            let help = "tet4, hex8, tet10 and hex20 have one, with standard dilation, element means (not tet4) or nodal \
                        means (tet4 only), and laws that split for means; or take precision = \"double\"";
            return finding(ErrorKind::NotAvailable, Key::Scene("procedure.precision".into()), problem, help);
        }
        let (key, help) = match error {
            ExplicitError::StepTooLarge { .. } if given => (
                Key::Scene("procedure.step".into()),
                "leave it out: the step is then a fraction of the critical step",
            ),
            ExplicitError::StepTooLarge { .. } => {
                (Key::Method(""), "take a larger safety margin, such as procedure.safety = 0.7")
            }
            ExplicitError::LightTool { .. } => (Key::Scene("procedure".into()), "give a larger tool_mass"),
            ExplicitError::ContactAt { tool, .. } => (Key::Scene(format!("tool[{tool}]")), ""),
            ExplicitError::InvertedAt { .. } => (
                Key::Method(""),
                "a smaller load, a finer mesh, or a dilation that does not lock may complete the run",
            ),
            _ => (Key::Method(""), ""),
        };
        finding(ErrorKind::NotRun, key, error.to_string(), help)
    }

    fn of_time(&self, error: &TimeError) -> Finding {
        let first = match error {
            TimeError::Stalled { cause, .. } => cause,
            error => error,
        };
        let (kind, key, help) = match first {
            TimeError::Parameter { .. } => (ErrorKind::Invalid, Key::Scene("procedure".into()), ""),
            TimeError::Inaccurate { .. } => (
                ErrorKind::NotRun,
                Key::Scene("procedure.accuracy".into()),
                "no step is short enough: allow a larger error",
            ),
            TimeError::Static(error) => match overlapping(error) {
                Some(tool) => (ErrorKind::NotRun, Key::Scene(format!("tool[{tool}]")), ""),
                None => (ErrorKind::NotRun, Key::Method(""), self.more_steps()),
            },
            _ => (ErrorKind::NotRun, Key::Method(""), self.more_steps()),
        };
        finding(kind, key, error.to_string(), help)
    }

    fn of_solve(&self, error: &SolveError) -> Finding {
        let cloud = self.method.is_cloud();
        let essential = Key::Method("essential");
        let text = error.to_string();
        match error {
            SolveError::RigidMotion { .. } => rigid(self.scene, text),
            SolveError::Conflict { .. } => finding(
                ErrorKind::Invalid,
                supports(self.scene),
                text,
                "let the regions of supports overlap only where their values agree",
            ),
            SolveError::NotCoercive { .. } => finding(
                ErrorKind::NotRun,
                essential,
                text,
                "give a larger factor: { method = \"nitsche\", factor = ... }",
            ),
            SolveError::Inconsistent { .. }
            | SolveError::Dependent { .. }
            | SolveError::BadWeak { .. }
            | SolveError::Algebra(AlgebraError::ZeroPivot) => {
                finding(ErrorKind::NotRun, if cloud { essential } else { supports(self.scene) }, text, "")
            }
            SolveError::NotPositiveDefinite | SolveError::OrphanNode { .. } if cloud => finding(
                ErrorKind::NotRun,
                Key::Method("integration"),
                text,
                "take more integration points, or a finer background mesh",
            ),
            SolveError::NotPositiveDefinite => finding(ErrorKind::NotRun, Key::Method("element"), text, ""),
            SolveError::OrphanNode { .. } => {
                let help = "every node of the mesh has to belong to a cell";
                finding(ErrorKind::NotRun, Key::Size(""), text, help)
            }
            SolveError::Algebra(AlgebraError::TooLarge { .. }) => {
                finding(ErrorKind::NotRun, Key::Size(""), text, "take a coarser mesh")
            }
            _ => finding(ErrorKind::NotRun, Key::Method(""), text, ""),
        }
    }
}

/// Returns the tool that overlaps the body without a force and so ended a solution, if any. Smaller steps do
/// not help.
fn overlapping(error: &StaticError) -> Option<usize> {
    match error {
        StaticError::Stalled { cause, .. } => overlapping(cause),
        StaticError::Contact { tool, cause: ContactError::Overlap { .. } } => Some(*tool),
        _ => None,
    }
}

/// Returns the finding for an unconstrained rigid motion, at the supports, or at the body if there are none.
fn rigid(scene: &Scene, motions: String) -> Finding {
    let help = "add a [[support]] with a region (on or where) and fix = \"xyz\", or the axes that are free";
    let (key, problem) = match scene.supports.len() {
        0 => (Key::Scene("body".into()), format!("has no [[support]]: {motions}")),
        1 => (supports(scene), format!("does not constrain the body: {motions}")),
        count => {
            let lines: Vec<String> = (0..count)
                .map(|i| scene.error(ErrorKind::NotRun, &format!("support[{i}]"), "", None).line.to_string())
                .collect();
            let problem = format!(
                "does not constrain the body, with all {count} supports together (lines {}): {motions}",
                lines.join(", ")
            );
            (Key::Scene("support".into()), problem)
        }
    };
    finding(ErrorKind::NotRun, key, problem, help)
}

/// Returns the key of the list of supports, or of the condition of the only support.
fn supports(scene: &Scene) -> Key {
    let only = ["support[0].fix", "support[0].move"].into_iter().find(|key| scene.has(key));
    let key = if scene.supports.len() == 1 { only.unwrap_or("support[0]") } else { "support" };
    Key::Scene(key.into())
}

fn finding(kind: ErrorKind, key: Key, problem: String, help: &str) -> Finding {
    Finding { kind, key, problem, help: (!help.is_empty()).then(|| help.into()) }
}

fn joined(key: &str, below: &str) -> String {
    if below.is_empty() { key.into() } else { format!("{key}.{below}") }
}
