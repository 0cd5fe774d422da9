//! A solver that misbehaves on request. It is a program of its own: a test that is ignored unless an adapter
//! calls it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use serde_json::{Value, json};

/// Lifetime of a child left behind, s. The number identifies the process.
pub const CHILD: &str = "86387";

/// Writes the description of an adapter NAME that is run by `run`, a list of TOML.
pub fn adapter(dir: &Path, name: &str, run: &str) -> PathBuf {
    let file = dir.join("adapters").join(name).join("adapter.toml");
    let can = "can = [\"linear\", \"static\", \"neo-hookean\", \"neo-hookean-isochoric\"]\nelements = [\"tet4\", \"tet10\", \"hex8\"]";
    std::fs::create_dir_all(file.parent().unwrap()).unwrap();
    std::fs::write(&file, format!("name = \"{name}\"\ntitle = \"a test solver\"\nrun = {run}\n{can}\n"))
        .unwrap();
    file
}

/// Writes the adapter NAME of the dummy.
pub fn dummy(dir: &Path, name: &str) -> PathBuf {
    let program = std::env::current_exe().unwrap();
    let words = "\"dummy::answers\", \"--exact\", \"--ignored\", \"--nocapture\"";
    adapter(
        dir,
        name,
        &format!("[{program:?}, {words}, \"{{tissuebench}}\", \"{{problem}}\", \"{{answer}}\"]"),
    )
}

/// Solves a problem as `tissuebench` does, and then spoils the answer as its setting `mode` says. The
/// arguments behind the options are more names of tests to this program.
#[test]
#[ignore = "a program for adapters"]
fn answers() {
    let words: Vec<String> = std::env::args().skip_while(|word| word != "--nocapture").skip(1).collect();
    let [program, problem, answer, more @ ..] = &words[..] else { return };
    let (problem, answer) = (Path::new(problem), Path::new(answer));
    let text: Value = serde_json::from_slice(&std::fs::read(problem.join("problem.json")).unwrap()).unwrap();
    let asked = text["settings"]["mode"].as_str().unwrap_or("own");
    let mode = more.first().map_or(asked, String::as_str);
    let say = |result: Value| std::fs::write(answer.join("result.json"), result.to_string()).unwrap();
    match mode {
        "silence" => std::process::exit(0),
        "exit" => {
            eprintln!("a last word");
            std::process::exit(7);
        }
        "sleep" => {
            leave_a_child();
            std::thread::sleep(Duration::from_secs(86400));
        }
        "memory" => take_memory(),
        "refused" => {
            say(json!({ "status": "refused", "message": "nothing of this kind", "problem": text["id"] }));
            std::process::exit(0);
        }
        "children" => leave_a_child(),
        _ => {}
    }
    let solved = Command::new(program).arg("solve").args([problem, answer]).status().unwrap();
    assert!(solved.success());
    let (file, result) = (answer.join("displacement.npy"), answer.join("result.json"));
    let mut result: Value = serde_json::from_slice(&std::fs::read(result).unwrap()).unwrap();
    let bytes = std::fs::read(&file).unwrap();
    let (head, numbers) = bytes.split_at(10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]])));
    let numbers = numbers.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).enumerate();
    let save = |head: &[u8], number: &dyn Fn((usize, f64)) -> Option<f64>| {
        let numbers: Vec<u8> = numbers.clone().filter_map(number).flat_map(f64::to_le_bytes).collect();
        std::fs::write(&file, [head, &numbers].concat()).unwrap();
    };
    match mode {
        "own" | "children" => {}
        "zeros" => save(head, &|_| Some(0.0)),
        "scaled" => save(head, &|(_, u)| Some(1.001 * u)),
        "nan" => save(head, &|(at, u)| Some(if at == 7 { f64::NAN } else { u })),
        "shape" => {
            let nodes = numbers.len() / 3;
            let text = String::from_utf8_lossy(&head[10..]);
            let text = text.replace(&format!("({nodes},"), &format!("({},", nodes - 1));
            save(&[&head[..10], text.as_bytes()].concat(), &|(at, u)| (at > 2).then_some(u));
        }
        "garbage" => std::fs::write(&file, [0x5a; 1000]).unwrap(),
        "stalled" => {
            save(head, &|(_, u)| Some(0.5 * u));
            result["status"] = "stalled".into();
            result["message"] = "asked to stop half way".into();
            result["load"] = 0.5.into();
        }
        "stale" => result["problem"] = "another".into(),
        "result" => return std::fs::write(answer.join("result.json"), "{ \"status\": \"ok\"").unwrap(),
        other => result = json!({ "status": "failed", "message": format!("mode '{other}' is not known") }),
    }
    say(result);
}

fn leave_a_child() {
    Command::new("sleep").arg(CHILD).spawn().map(drop).unwrap();
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut Command::new("sleep"), 0)
        .arg(CHILD)
        .spawn()
        .map(drop)
        .unwrap();
}

/// Allocates memory until none is left.
fn take_memory() {
    let mut taken = Vec::new();
    loop {
        taken.push(vec![1_u8; 16 << 20]);
        std::thread::sleep(Duration::from_millis(1));
    }
}
