//! The hidden command `solve`: solves a problem in files, as a program called by an adapter does. It serves
//! to measure the overhead of the protocol. It can also misbehave on request, to test the calling code.

mod engine;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use cases::scene::Setting;
use clap::Args;
use serde_json::json;

use crate::adapter::{RESULT, npy};
use crate::procedure::external::problem::{SCHEMA, TEXT, Text};
use engine::Solved;

/// Arguments of the hidden command `solve`.
#[derive(Args)]
pub struct SolveArgs {
    /// Folder of the problem
    pub problem: PathBuf,
    /// Folder for the answer
    pub answer: PathBuf,
    /// Kind of misbehaviour, instead of the setting `mode`
    #[arg(long)]
    pub mode: Option<String>,
}

/// Values of the setting `mode`: kinds of misbehaviour.
const MODES: &str = "own, zeros, scaled, garbage, nan, shape, result, silence, exit, sleep, children, memory, refused, stalled, stale";

/// Duration, s, for which a child process left behind would stay. No other process has this number in its
/// command line.
const CHILD: &str = "86387";

/// Solves, answers and returns the exit code.
pub(super) fn solve(args: &SolveArgs) -> u8 {
    match answer(args) {
        Ok(code) => code,
        Err(reason) => {
            eprintln!("tissuebench solve: {reason}");
            let result = json!({ "status": "failed", "message": reason });
            let _ = disk::write(&args.answer.join(RESULT), result.to_string());
            3
        }
    }
}

fn answer(args: &SolveArgs) -> Result<u8, String> {
    let path = args.problem.join(TEXT);
    let text =
        disk::read_text(&path, disk::Kind::MESSAGE).map_err(|bad| format!("{}: {bad}", path.display()))?;
    let text: Text = serde_json::from_str(&text).map_err(|bad| format!("{}: {bad}", path.display()))?;
    if text.schema != SCHEMA {
        return Err(format!(
            "{}: schema {} is not known; the supported schema is {SCHEMA}",
            path.display(),
            text.schema
        ));
    }
    let mode = match (&args.mode, text.settings.get("mode")) {
        (Some(mode), _) => mode,
        (None, None) => "own",
        (None, Some(Setting::Text(mode))) => mode,
        (None, Some(other)) => return Err(format!("mode {other:?}: give one of {MODES}")),
    };
    match mode {
        "silence" => return Ok(0),
        "exit" => {
            eprintln!("a last word");
            return Ok(7);
        }
        "sleep" => {
            leave_a_child()?;
            std::thread::sleep(Duration::from_secs(86400));
            return Ok(0);
        }
        "memory" => take_memory(),
        "refused" => return said(&args.answer, &text, "refused", "nothing of this kind"),
        "result" => {
            write(&args.answer.join(RESULT), b"{ \"status\": \"ok\"")?;
            return Ok(0);
        }
        "children" => leave_a_child()?,
        _ => {}
    }
    let solved = engine::solve(&args.problem, &text)?;
    found(&args.answer, &text, mode, solved)
}

/// Writes the displacement, modified according to the mode.
fn found(folder: &Path, text: &Text, mode: &str, solved: Solved) -> Result<u8, String> {
    let path = folder.join("displacement.npy");
    let nodes = solved.u.len();
    let values = || solved.u.iter().flat_map(|u| [u.x, u.y, u.z]);
    match mode {
        "own" | "children" | "stale" => npy::write_floats(&path, 3, values())?,
        "stalled" => npy::write_floats(&path, 3, values().map(|u| 0.5 * u))?,
        "scaled" => npy::write_floats(&path, 3, values().map(|u| 1.001 * u))?,
        "zeros" => npy::write_floats(&path, 3, std::iter::repeat_n(0.0, 3 * nodes))?,
        "nan" => npy::write_floats(
            &path,
            3,
            values().enumerate().map(|(at, u)| if at == 7 { f64::NAN } else { u }),
        )?,
        "shape" => npy::write_floats(&path, 3, values().skip(3))?,
        "garbage" => write(&path, &[0x5a; 1000])?,
        other => return Err(format!("mode '{other}': give one of {MODES}")),
    }
    let id = if mode == "stale" { "another" } else { &text.id };
    let (status, load) = if mode == "stalled" { ("stalled", Some(0.5)) } else { ("ok", None) };
    let result = json!({
        "status": status,
        "message": if load.is_some() { "asked to stop half way" } else { "" },
        "load": load,
        "version": format!("tissuebench {}", env!("CARGO_PKG_VERSION")),
        "problem": id,
        "phases": solved.phases,
        "counts": solved.counts,
    });
    write(&folder.join(RESULT), result.to_string().as_bytes())?;
    Ok(0)
}

fn said(folder: &Path, text: &Text, status: &str, message: &str) -> Result<u8, String> {
    let result = json!({ "status": status, "message": message, "problem": text.id });
    write(&folder.join(RESULT), result.to_string().as_bytes())?;
    Ok(0)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    disk::write(path, bytes).map_err(|bad| format!("{}: can't be written: {bad}", path.display()))
}

fn leave_a_child() -> Result<(), String> {
    let sleep = |command: &mut Command| {
        let started = command.arg(CHILD).spawn().map(drop);
        started.map_err(|bad| format!("sleep can't be started: {bad}"))
    };
    sleep(&mut Command::new("sleep"))?;
    #[cfg(unix)]
    sleep(std::os::unix::process::CommandExt::process_group(&mut Command::new("sleep"), 0))?;
    Ok(())
}

/// Allocates memory until none is left.
fn take_memory() {
    let mut taken: BTreeMap<usize, Vec<u8>> = BTreeMap::new();
    for block in 0.. {
        taken.insert(block, vec![1; 16 << 20]);
        std::thread::sleep(Duration::from_millis(1));
    }
}
