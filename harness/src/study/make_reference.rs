//! Solves a scene by every method that a reference is made of, and stores what they agree on.

use cases::scene::Scene;
use geometry::Point3;

use crate::Failure;
use crate::outcome::{LoadStep, ToolStep, Watch, provenance};
use crate::run::mirror::Mirror;
use crate::run::stored::{Problem, Source, Stored, StoredStep, StoredTool};
use crate::run::{Group, case_name};

/// A line for those who wait an hour for the end, and all that is left where there is none.
fn waiting(step: &LoadStep) {
    let force = |tool: &ToolStep| format!(", {:.3} mm {:.5} N", 1e3 * tool.closure, tool.pushed);
    let tools: String = step.tools.iter().map(force).collect();
    eprintln!("{:6.2} % of the load in {} iterations{tools}", 100.0 * step.load, step.iterations);
}

/// Runs the named methods of the scene, or all of them. The last one's values are stored, all of them span the bands.
/// `points` below z = 0 are evaluated at their mirror images if the scene has only the half above.
pub fn make(scene: &Scene, text: &str, points: &[Point3], only: &[String]) -> Result<Stored, Failure> {
    let mut all = Vec::new();
    for method in scene.methods.iter().filter(|m| only.is_empty() || only.contains(&m.id)) {
        eprintln!("{}", method.id);
        let solution = by(scene, text, points, &method.id)?;
        eprintln!("{}: {} nodes", solution.source.method, solution.source.nodes);
        all.push(solution);
    }
    let Some(mut stored) = all.pop() else {
        return Err(Failure::Run(format!("{} has no method to make a reference with", scene.file())));
    };
    all.iter().for_each(|other| stored.widen(other));
    Ok(stored)
}

/// The solution by one method, without bands.
fn by(scene: &Scene, text: &str, points: &[Point3], method: &str) -> Result<Stored, Failure> {
    let mirror = Mirror::of(&scene.body);
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
    let (program, machine) = (provenance::program(), provenance::machine());
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
