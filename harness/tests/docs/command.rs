//! Execution of a page's commands in a folder with the page's scenes.

use std::path::Path;
use std::process::Command;

use crate::markdown::{Block, Page};
use crate::root;

/// A command of a page with the output that the page shows.
struct Step {
    command: String,
    prints: Vec<String>,
}

/// Runs all commands of a page in sequence, and returns the deviations from the page.
pub fn failures(page: &Page) -> Vec<String> {
    let dir = tempfile::tempdir().expect("a folder");
    copy(&root().join("cases"), &dir.path().join("cases"));
    for block in &page.blocks {
        if let Some(name) = block.file() {
            std::fs::write(dir.path().join(name), &block.text).expect("written");
        }
    }
    let mut wrong = Vec::new();
    for block in page.blocks.iter().filter(|block| block.is_commands()) {
        for failure in run(block, dir.path()) {
            wrong.push(format!("{}:{}: {failure}", page.name(), block.line));
        }
    }
    wrong
}

fn run(block: &Block, dir: &Path) -> Vec<String> {
    let says = block.comment.as_deref().unwrap_or_default();
    let not_run = says.starts_with("not run");
    let exits = says.strip_prefix("exits ").map_or(0, |code| code.parse().expect("an exit code"));
    let steps = steps(block);
    let last = steps.len().saturating_sub(1);
    let results = steps.iter().enumerate().map(|(i, step)| {
        one(step, dir, not_run, if i == last { exits } else { 0 })
            .map_err(|bad| format!("{}: {bad}", step.command))
    });
    results.filter_map(Result::err).collect()
}

/// Commands with the lines that follow them. In a `sh` block every line is a command.
fn steps(block: &Block) -> Vec<Step> {
    let mut steps: Vec<Step> = Vec::new();
    for line in block.text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')) {
        let command = match block.language.as_str() {
            "console" => line.strip_prefix("$ "),
            _ => Some(line),
        };
        match (command, steps.last_mut()) {
            (Some(command), _) => {
                let command = command.split(" #").next().unwrap_or(command).trim().to_string();
                steps.push(Step { command, prints: Vec::new() });
            }
            (None, Some(step)) => step.prints.push(line.to_string()),
            (None, None) => panic!("a console block opens with '$ COMMAND', not with '{line}'"),
        }
    }
    steps
}

fn one(step: &Step, dir: &Path, not_run: bool, exits: i32) -> Result<(), String> {
    let words: Vec<&str> = step.command.split_whitespace().collect();
    match words.as_slice() {
        ["tissuebench", args @ ..] => tissuebench(args, step, dir, not_run, exits),
        ["cp", from, to] => {
            std::fs::copy(root().join(from), dir.join(to)).map(|_| ()).map_err(|bad| bad.to_string())
        }
        ["cargo", "xtask", task, ..] => known_task(task),
        ["cargo", "install", "--path", path, ..] => {
            root().join(path).join("Cargo.toml").exists().then_some(()).ok_or("no such package".into())
        }
        ["cargo", "test" | "bench" | "doc" | "insta" | "package", ..] => Ok(()),
        ["cargo", "install", "mdbook" | "cargo-insta", ..] | ["mdbook", ..] => Ok(()),
        // Python is tested by its own tests, `cargo xtask python`.
        ["pip" | "python", ..] => Ok(()),
        ["git", "clone" | "tag", ..] | ["cd", ..] => Ok(()),
        _ => Err("the test does not know how to check this command".into()),
    }
}

/// Checks that xtask has the task of `cargo xtask TASK`.
pub fn known_task(task: &str) -> Result<(), String> {
    let source = std::fs::read_to_string(root().join("xtask/src/main.rs")).map_err(|bad| bad.to_string())?;
    let (first, rest) = task.split_at(1);
    let variant = format!("    {}{rest}", first.to_uppercase());
    let known = source.lines().any(|line| {
        line.strip_prefix(&variant)
            .is_some_and(|end| matches!(end.trim_end(), "," | " {") || end.starts_with('('))
    });
    known.then_some(()).ok_or("xtask has no such task".into())
}

fn tissuebench(args: &[&str], step: &Step, dir: &Path, not_run: bool, exits: i32) -> Result<(), String> {
    let mut program = Command::new(env!("CARGO_BIN_EXE_tissuebench"));
    program.args(args).current_dir(dir);
    if not_run {
        program.arg("--help"); // parses what is before
    }
    let output = program.output().map_err(|bad| bad.to_string())?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (stdout, stderr) = (text(&output.stdout), text(&output.stderr));
    let wanted = if not_run { 0 } else { exits };
    if output.status.code() != Some(wanted) {
        return Err(format!("ended with {:?}, not {wanted}\n{stderr}", output.status.code()));
    }
    let printed: Vec<String> = stdout.lines().chain(stderr.lines()).map(numberless).collect();
    let missing = step.prints.iter().filter(|line| !not_run && !line.starts_with("..."));
    match missing.map(|line| (line, numberless(line))).find(|(_, wanted)| !printed.contains(wanted)) {
        Some((line, _)) => Err(format!("does not print\n  {line}\nbut\n{stdout}{stderr}")),
        None => Ok(()),
    }
}

/// Replaces every number of a line, because machines and times differ, and normalises spaces. On a busy
/// machine, CPU times are shown.
fn numberless(line: &str) -> String {
    let line = line.replace("[CPU ms]", "[ms]");
    let is_number = |word: &str| {
        let word = word.trim_matches(|c: char| ",;()".contains(c));
        word == "-" || word.parse::<f64>().is_ok()
    };
    let words = line.split_whitespace().map(|word| if is_number(word) { "#" } else { word });
    words.collect::<Vec<_>>().join(" ")
}

/// Copies the scenes and meshes in a folder and its subfolders.
fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).expect("readable") {
        let path = entry.expect("readable").path();
        let target = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy(&path, &target);
        } else if path
            .extension()
            .is_some_and(|e| ["toml", "msh", "json", "csv", "feb", "inp"].iter().any(|k| e == *k))
        {
            std::fs::copy(&path, &target).expect("copied");
        }
    }
}
