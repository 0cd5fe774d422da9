//! `tissuebench adapter run`: one call of a solver, without a scene.

use std::path::Path;
use std::time::Duration;

use crate::adapter::{self, Answered, Found, Question, npy};
use crate::cli::text::digits;
use crate::error::{Failure, ForeignStatus};
use crate::procedure::external::problem::{TEXT, TOOLS, Text};
use crate::process::Limits;

/// Calls the adapter, prints its answer and returns the exit code.
pub(super) fn call(adapter: &Found, problem: &Path, answer: &Path) -> Result<u8, Failure> {
    let path = problem.join(TEXT);
    let wrong = |bad: String| Failure::Input(format!("{}: {bad}", path.display()));
    let text = disk::read_text(&path, disk::Kind::MESSAGE).map_err(|bad| wrong(bad.to_string()))?;
    let text: Text = serde_json::from_str(&text).map_err(|bad| wrong(bad.to_string()))?;
    if let Some(reason) = adapter.manifest.refusal(&text.element, &asked(&text, problem)) {
        eprintln!("{}: {} {reason}", ForeignStatus::NotOffered.name(), adapter.manifest.name);
        return Ok(3);
    }
    let nodes = npy::read(&problem.join("nodes.npy"), disk::Kind::ARRAY)
        .map_err(Failure::Input)?
        .shape
        .first()
        .copied();
    let folder = |path: &Path| {
        std::fs::create_dir_all(path)
            .and_then(|()| path.canonicalize())
            .map_err(|bad| Failure::Input(format!("{}: {bad}", path.display())))
    };
    let (problem, answer) = (folder(problem)?, folder(answer)?);
    if disk::Identity::of(&problem) == disk::Identity::of(&answer) {
        let problem =
            format!("{}: is the folder of the problem; give another for the answer", answer.display());
        return Err(Failure::Input(problem));
    }
    let work = adapter::Folder::new().map_err(Failure::Run)?;
    let limits = Limits {
        time: Duration::try_from_secs_f64(text.limits.seconds).unwrap_or(Duration::MAX),
        memory: text.limits.bytes,
    };
    let answered = adapter::ask(&Question {
        adapter,
        work: &work,
        problem: &problem,
        answer: &answer,
        id: &text.id,
        nodes: nodes.unwrap_or_default(),
        steps: text.procedure.steps,
        limits,
        threads: text.threads,
    });
    match answered {
        Ok(answered) => say(&answered),
        Err(foreign) => {
            eprintln!("{}: {foreign}", foreign.status.name());
            return Ok(3);
        }
    }
    Ok(0)
}

/// Lists the features that a problem in files requires of a solver, each with its word in `can`.
fn asked<'a>(text: &'a Text, problem: &Path) -> Vec<(&'a str, String)> {
    let kind = text.procedure.kind.as_str();
    let mut asked = vec![(kind, format!("kind = \"{kind}\""))];
    asked.extend(text.materials.iter().map(|m| (m.law.as_str(), format!("the law \"{}\"", m.law))));
    if problem.join(TOOLS).exists() {
        asked.push(("tools", format!("rigid tools ({TOOLS})")));
    }
    asked
}

fn say(answered: &Answered) {
    let Answered { call, answer, fields, stalled } = answered;
    match stalled {
        Some(stalled) => println!("stalled: {stalled}"),
        None => println!("ok"),
    }
    let cpu = call.cpu.map_or(String::new(), |cpu| format!(", {} s of CPU time", digits(cpu)));
    println!("  took        {} s{cpu}, {} MB", digits(call.wall), call.memory >> 20);
    for (phase, seconds) in &answer.phases {
        println!("  own {phase:<9}{} s", digits(*seconds));
    }
    let largest = fields.iter().flatten().map(|u| u.norm()).fold(0.0, f64::max);
    println!("  largest     {} mm", digits(1e3 * largest));
}
