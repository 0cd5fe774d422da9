//! Results that are changed, incomplete, empty or not writable, and decks that refer to files elsewhere.

use std::fs;

use crate::world::World;

#[test]
fn a_folder_is_whole_only_with_its_report() {
    let world = World::new();
    world.runs(&["report", "results", "--out", "r"], 0);
    fs::remove_dir_all(world.path("results/report")).unwrap();
    world.write("results/report", "in the way");
    let done = world.tissuebench(&["run", "block.toml", "--once", "--out", "results"]);
    assert_eq!(done.code, 5, "{}", done.stderr);
    let done = world.runs(&["report", "results", "--out", "r"], 5);
    assert!(done.stderr.contains("results is incomplete"), "{}", done.stderr);
    fs::remove_file(world.path("results/report")).unwrap();
    world.runs(&["run", "block.toml", "--once", "--out", "results"], 0);
    world.runs(&["report", "results", "--out", "r"], 0);
}

#[test]
fn a_changed_result_is_not_believed() {
    let world = World::new();
    let numbers = |folder: &str| {
        let text = fs::read_to_string(world.path(&format!("{folder}/records.csv"))).unwrap();
        let of = text.lines().filter(|line| line.contains(",max,"));
        let kept: Vec<String> = of.map(String::from).collect();
        assert!(!kept.is_empty());
        kept
    };
    let right = numbers("kept");
    let task = world.only("kept/tasks", ".json");
    let text = fs::read_to_string(world.path(&task)).unwrap();
    let at = text.find("\"quantity\":\"max\"").unwrap();
    let value = at + text[at..].find("\"value\":").unwrap() + 8;
    let changed = format!("{}9{}", &text[..value], &text[value..]);
    world.write(&task, &changed);
    let done = world.runs(&["merge", "merged", "kept"], 2);
    assert!(done.stderr.contains("the file was changed"), "{}", done.stderr);
    for option in ["--resume", "--join"] {
        world.write(&task, &changed);
        let done = world.runs(&["verify", "study.toml", option, "--out", "kept"], 0);
        assert!(option == "--join" || done.stderr.contains("the file was changed"), "{}", done.stderr);
        assert_eq!(numbers("kept"), right, "{option}");
    }
    world.runs(&["merge", "merged", "kept"], 0);
    // A result of another run is not accepted for this run.
    let other = task.replace("tasks/", "tasks/0");
    fs::rename(world.path(&task), world.path(&other)).unwrap();
    world.runs(&["merge", "merged", "kept"], 5);
}

#[test]
fn nothing_is_no_success() {
    let world = World::new();
    let free = fs::read_to_string(world.path("block.toml")).unwrap();
    let free: String =
        free.lines().filter(|line| !line.starts_with("support")).map(|l| format!("{l}\n")).collect();
    world.write("free.toml", &free);
    world.runs(&["run", "free.toml", "--out", "nothing"], 3);
    for args in [
        "report nothing --out r",
        "compare nothing nothing",
        "baseline nothing --accepted baseline --part --check",
        "baseline nothing --accepted new --accept",
        "history add nothing --to history",
    ] {
        let done = world.runs(&args.split(' ').collect::<Vec<_>>(), 2);
        assert!(done.stderr.contains("holds no records"), "{args}: {}", done.stderr);
    }
    assert!(world.path("nothing/report/report.html").exists(), "the run has its page all the same");
    for args in [
        "verify study.toml -q --out full --events /dev/full",
        "verify study.toml -q --out full --junit /dev/full",
    ] {
        let done = world.tissuebench(&args.split(' ').collect::<Vec<_>>());
        assert!(
            done.code >= 3 && done.stderr.contains("No space left"),
            "{args}: {} {}",
            done.code,
            done.stderr
        );
    }
    assert!(world.path("full/records.csv").exists(), "the results are there all the same");
}

#[test]
fn decks_include_files_of_their_folder_and_not_too_many() {
    let world = World::new();
    world.write("decks/whole.inp", "*INCLUDE, INPUT=part.inp\n");
    world.write("elsewhere.inp", &fs::read_to_string(world.path("deck.inp")).unwrap());
    let link = |to: &str, name: &str| std::os::unix::fs::symlink(world.path(to), world.path(name)).unwrap();
    link("elsewhere.inp", "decks/part.inp");
    let done = world.runs(&["mesh", "info", "decks/whole.inp"], 2);
    assert!(done.stderr.contains("lie in the folder of the deck"), "{}", done.stderr);
    // A link within the folder, and a deck behind a link, can be read.
    fs::remove_file(world.path("decks/part.inp")).unwrap();
    fs::rename(world.path("elsewhere.inp"), world.path("decks/real.inp")).unwrap();
    link("decks/real.inp", "decks/part.inp");
    world.runs(&["mesh", "info", "decks/whole.inp", "--unit", "m"], 0);
    let next = |name: &str| format!("*INCLUDE, INPUT={name}\n").repeat(20);
    for level in 0..8 {
        world.write(&format!("decks/{level}.inp"), &next(&format!("{}.inp", level + 1)));
    }
    world.write("decks/8.inp", "** nothing\n");
    world.write(
        "bomb.toml",
        &fs::read_to_string(world.path("file.toml")).unwrap().replace("body.msh", "decks/0.inp"),
    );
    world.write(
        "bomb-study.toml",
        &fs::read_to_string(world.path("study.toml")).unwrap().replace("block", "bomb"),
    );
    for args in ["mesh info decks/0.inp", "run bomb.toml", "verify bomb-study.toml --out bomb"] {
        let done = world.tissuebench(&args.split(' ').collect::<Vec<_>>());
        assert!(done.code != 0 && done.stderr.contains("a thousand files"), "{args}: {}", done.stderr);
    }
}
