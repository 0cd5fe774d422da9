//! Creation of stored references: a scene is solved by several methods, whose differences become the bands.

use cases::scene::Scene;
use geometry::Point3;

use crate::error::Failure;
use crate::outcome::{LoadStep, ToolStep, Watch, provenance};
use crate::run::stored_reference::{Problem, Source, Stored, StoredStep, StoredTool};
use crate::run::symmetry::Mirror;
use crate::run::{Group, case_name};

/// Prints the state of a load step. A solution may take an hour, and the lines remain if it does not finish.
fn waiting(step: &LoadStep) {
    let force = |tool: &ToolStep| format!(", {:.3} mm {:.5} N", 1e3 * tool.closure, tool.pushed);
    let tools: String = step.tools.iter().map(force).collect();
    eprintln!("{:6.2} % of the load in {} iterations{tools}", 100.0 * step.load, step.iterations);
}

/// Runs the methods named in `only`, or all methods of the scene if `only` is empty. The values of the last
/// method are stored, and all methods span the bands. Points (m) beyond a plane of symmetry of the
/// scene are evaluated at their mirror images.
///
/// # Errors
/// Returns the failure of any method, and an error if no method is left.
pub fn make(scene: &Scene, text: &str, points: &[Point3], only: &[String]) -> Result<Stored, Failure> {
    let mut all = Vec::new();
    for method in scene.methods.iter().filter(|m| only.is_empty() || only.contains(&m.id)) {
        eprintln!("{}", method.id);
        let solution = by(scene, text, points, &method.id)?;
        eprintln!("{}: {} nodes", solution.source.method, solution.source.nodes);
        all.push(solution);
    }
    let Some(mut stored) = all.pop() else {
        return Err(Failure::Run(format!("{} has no method for a reference", scene.file())));
    };
    all.iter().for_each(|other| stored.widen(other));
    Ok(stored)
}

/// Solves the scene by one method, without bands.
fn by(scene: &Scene, text: &str, points: &[Point3], method: &str) -> Result<Stored, Failure> {
    let mirror = Mirror::of(scene);
    let images = points.iter().map(|x| mirror.place(x)).collect();
    let solution = Group::solve_for(scene, method, images, Watch::new(waiting))?;
    for warning in &solution.warnings {
        eprintln!("warning: {method}: {}", warning.text());
    }
    let tool =
        |t: &ToolStep| StoredTool { closure: t.closure, force: t.pushed, low: t.pushed, high: t.pushed };
    let step = |step: &LoadStep| StoredStep {
        load: step.load,
        tools: step.tools.iter().map(tool).collect(),
        probes: step.probes.iter().map(|&u| u.into()).collect(),
        probe_band: 0.0,
    };
    let displacement = points.iter().zip(&solution.targets);
    let program = provenance::program();
    let machine = provenance::machine();
    let Problem { problem, methods } = Problem::of(text);
    Ok(Stored {
        case: case_name(scene),
        problem,
        program: format!("tissuebench {} ({})", program.version, program.revision()),
        made_on: format!("{}; {}", program.rustc, machine.instructions),
        source: Source {
            method: solution.method.clone(),
            nodes: solution.nodes,
            table: methods[method].clone(),
        },
        beside: Vec::new(),
        probes: scene.output.probes.clone(),
        steps: solution.steps.iter().map(step).collect(),
        points: points.iter().map(|x| x.coords.into()).collect(),
        displacement: displacement.map(|(x, &u)| mirror.displacement(x, u).into()).collect(),
        displacement_band: 0.0,
    })
}
