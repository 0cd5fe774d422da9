//! A pipe, an endless device or a huge file in place of each file that a command reads.

use std::fs;

use crate::world::{World, fifo};

/// Whether the command must refuse the file, or may also run without it or replace it.
#[derive(PartialEq)]
enum Then {
    Refused,
    Any,
}
use Then::{Any, Refused};

/// Files to replace, each with the command that reads it.
fn places(world: &World) -> Vec<(String, Vec<&'static str>, Then)> {
    let task = world.only("kept/tasks", ".json");
    let history = world.only("history", ".toml");
    let place =
        |file: &str, command: &'static str, then| (file.to_string(), command.split(' ').collect(), then);
    vec![
        place("block.toml", "run block.toml", Refused),
        place("block.toml", "pick block.toml --error 5%", Refused),
        place("block.toml", "pick block.toml --error 5% --usual", Refused),
        place("block.toml", "fields block.toml --out fields", Refused),
        place("block.toml", "plan block.toml", Refused),
        place("block.toml", "export block.toml --method tet4 --out exported", Refused),
        place("block.toml", "verify study.toml --out out", Refused),
        place("study.toml", "verify study.toml --out out", Refused),
        place("study.toml", "run study.toml", Refused),
        place("methods.toml", "run shared.toml", Refused),
        place("body.msh", "run file.toml", Refused),
        place("body.msh", "mesh info body.msh", Refused),
        place("body.msh", "mesh convert body.msh other.msh", Refused),
        place("body.msh", "reference block.toml --points body.msh --out r.json", Refused),
        place("organ.obj", "mesh make organ.obj --nodes 100 --out made.msh", Refused),
        place("organ.obj", "init --file organ.obj --yes", Refused),
        place("deck.inp", "mesh info whole.inp", Refused),
        place("points.csv", "run points.toml", Refused),
        place("problem/nodes.npy", "run array.toml", Refused),
        place("record.json", "run recorded.toml", Refused),
        place(
            "record.json",
            "reference block.toml --points body.msh --unit m --from record.json --out r.json",
            Refused,
        ),
        place("problem/problem.json", "adapter run tissuebench problem answer", Refused),
        place("problem/nodes.npy", "adapter run tissuebench problem answer", Refused),
        place("problem/nodes.npy", "solve problem answer", Refused),
        place("adapters/mine/adapter.toml", "adapter list", Refused),
        place("claims.toml", "claims results --file claims.toml", Refused),
        place("baseline/block.toml", "baseline results --accepted baseline --check", Refused),
        (history, vec!["history", "show"], Refused),
        place("results/provenance.json", "report results", Refused),
        place("results/records.csv", "report results", Refused),
        place("results/records.csv", "compare results kept", Refused),
        place("results/checks.json", "history add results", Refused),
        place("results/incomplete.json", "report results", Refused),
        place("results/provenance.json", "run block.toml --once --out results", Any),
        place("results/.lock", "run block.toml --once --out results", Any),
        place("results/records.csv.partial", "run block.toml --once --out results", Any),
        place("results/report/report.html", "report results", Any),
        place("kept/.writing", "verify study.toml --join -q --out kept", Any),
        place("kept/study.json", "merge merged kept", Refused),
        (task.clone(), vec!["merge", "merged", "kept"], Refused),
        (task, vec!["verify", "study.toml", "--resume", "-q", "--out", "kept"], Any),
    ]
}

#[test]
fn what_is_no_file_of_its_kind_is_refused_at_once() {
    let world = World::new();
    let mut tried = 0;
    for (file, args, then) in places(&world) {
        for kind in ["a pipe", "a device", "a huge file"] {
            let (path, aside) = (world.path(&file), world.path("aside"));
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            let there = fs::rename(&path, &aside).is_ok();
            match kind {
                "a pipe" => fifo(&path),
                "a device" => std::os::unix::fs::symlink("/dev/zero", &path).unwrap(),
                _ => fs::File::create(&path).unwrap().set_len(1 << 36).unwrap(),
            }
            let done = world.tissuebench(&args);
            assert!(then == Any || done.code != 0, "{kind} as {file}: {args:?} ends with 0");
            assert!(done.code == 0 || !done.stderr.is_empty(), "{kind} as {file}: {args:?} says nothing");
            tried += 1;
            let _ = fs::remove_file(&path);
            if there {
                fs::rename(&aside, &path).unwrap();
            }
        }
    }
    assert!(tried > 100, "{tried}");
}
